//! Figures drawn as SVG, in colours that all eyes tell apart.

use plotters::prelude::*;

use super::axis::Ticked;
use super::marks::{Figure, Marks, Point, Scale, Series, Spread};

/// Pixels, without the legend.
const SIZE: (u32, u32) = (820, 500);
/// Height of a row of the legend, which stands below, where it hides nothing, and the room that a letter and a key
/// take.
const ROW: u32 = 20;
const LETTER: f64 = 7.0;
const KEY: i32 = 16;
/// Okabe and Ito's palette, without its yellow, which is too light for lines on white.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    BLACK,
];
/// Share of the room between places that bars and boxes take, all series together.
const FILLED: f64 = 0.8;

type Failure = Box<dyn std::error::Error>;
type Area<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Ticked, Ticked>>;

pub(super) fn svg(figure: &Figure) -> Result<String, Failure> {
    let mut text = String::new();
    draw(&mut text, figure)?;
    Ok(text)
}

fn draw(text: &mut String, figure: &Figure) -> Result<(), Failure> {
    let legend = legend(figure);
    let rows = legend.last().map_or(0, |entry| entry.row + 1);
    let root = SVGBackend::with_string(text, (SIZE.0, SIZE.1 + ROW * rows)).into_drawing_area();
    root.fill(&WHITE)?;
    let (plot, below) = root.split_vertically(SIZE.1);
    let lanes = Lanes::of(figure);
    let bars = figure.series.iter().any(|series| matches!(series.marks, Marks::Bars(_)));
    let (xs, ys): (Vec<f64>, Vec<f64>) = figure.series.iter().flat_map(extremes).unzip();
    // Half a place of room at both ends for what has a width.
    let room = [xs.iter().copied().fold(f64::INFINITY, f64::min), xs.iter().copied().fold(f64::NEG_INFINITY, f64::max)];
    let wide = (lanes.count > 0 && figure.x.scale == Scale::Linear && room[0] <= room[1])
        .then(|| [room[0] - 0.5 * lanes.step, room[1] + 0.5 * lanes.step]);
    let x = Ticked::over(&figure.x.scale, xs.iter().copied().chain(wide.into_iter().flatten()), false);
    let y = Ticked::over(&figure.y.scale, ys.iter().copied(), bars);
    let floor = y.floor();
    let (x_shown, y_shown) = (x.clone(), y.clone());
    let mut chart = ChartBuilder::on(&plot)
        .caption(&figure.title, ("sans-serif", 17))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .x_desc(&figure.x.label)
        .y_desc(&figure.y.label)
        .x_labels(12)
        .y_labels(9)
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12))
        .draw()?;
    let mut lane = 0;
    for (series, colour) in figure.series.iter().zip(COLOURS.iter().cycle()) {
        let shows = |p: &&Point| x_shown.shows(p.x) && y_shown.shows(p.y);
        match &series.marks {
            Marks::Line(points) | Marks::Curve(points) | Marks::Scatter(points) => {
                let points: Vec<Point> = points.iter().filter(shows).copied().collect();
                let (joined, dots) =
                    (!matches!(series.marks, Marks::Scatter(_)), !matches!(series.marks, Marks::Curve(_)));
                line(&mut chart, &points, *colour, joined, dots)?;
                errors(&mut chart, &points, *colour, &y_shown)?;
            }
            Marks::Bars(points) => {
                let places: Vec<Point> = points.iter().filter(shows).copied().collect();
                let moved: Vec<Point> = places.iter().map(|p| Point { x: lanes.middle(p.x, lane), ..*p }).collect();
                let half = 0.46 * lanes.width();
                let rectangle = |p: &Point| Rectangle::new([(p.x - half, floor), (p.x + half, p.y)], colour.filled());
                chart.draw_series(moved.iter().map(rectangle))?;
                errors(&mut chart, &moved, BLACK, &y_shown)?;
                lane += 1;
            }
            Marks::Boxes(spreads) => {
                let shown = spreads.iter().filter(|s| x_shown.shows(s.x) && s.five.iter().all(|v| y_shown.shows(*v)));
                for Spread { x, five } in shown {
                    boxed(&mut chart, lanes.middle(*x, lane), 0.36 * lanes.width(), five, *colour)?;
                }
                lane += 1;
            }
        }
    }
    for Entry { name, colour, x, row } in legend {
        let y = (ROW * row) as i32;
        below.draw(&Rectangle::new([(x, y), (x + 10, y + 10)], colour.filled()))?;
        below.draw(&Text::new(name, (x + KEY, y - 1), ("sans-serif", 13)))?;
    }
    root.present()?;
    drop(chart);
    Ok(())
}

/// A name in the legend and where it stands.
struct Entry<'a> {
    name: &'a str,
    colour: RGBColor,
    x: i32,
    row: u32,
}

/// One name after the other, in as many rows as they take.
fn legend(figure: &Figure) -> Vec<Entry<'_>> {
    let (mut x, mut row) = (KEY, 0);
    let mut entries = Vec::new();
    for (series, colour) in figure.series.iter().zip(COLOURS.iter().cycle()) {
        if series.name.is_empty() {
            continue;
        }
        let width = 2 * KEY + (LETTER * series.name.chars().count() as f64) as i32;
        if x > KEY && x + width > SIZE.0 as i32 {
            (x, row) = (KEY, row + 1);
        }
        entries.push(Entry { name: &series.name, colour: *colour, x, row });
        x += width;
    }
    entries
}

fn line(chart: &mut Area, points: &[Point], colour: RGBColor, joined: bool, dots: bool) -> Result<(), Failure> {
    if joined {
        chart.draw_series(LineSeries::new(points.iter().map(|p| (p.x, p.y)), colour.stroke_width(2)))?;
    }
    if dots {
        chart.draw_series(points.iter().map(|p| Circle::new((p.x, p.y), 3, colour.filled())))?;
    }
    Ok(())
}

/// Error bars with feet of four pixels to each side.
fn errors(chart: &mut Area, points: &[Point], colour: RGBColor, y: &Ticked) -> Result<(), Failure> {
    for point in points {
        let Some([low, high]) = point.error else { continue };
        let [low, high] = [if y.shows(low) { low } else { y.floor() }, high];
        if !y.shows(high) {
            continue;
        }
        chart.draw_series([PathElement::new(vec![(point.x, low), (point.x, high)], colour.stroke_width(1))])?;
        for end in [low, high] {
            let foot =
                EmptyElement::at((point.x, end)) + PathElement::new(vec![(-4, 0), (4, 0)], colour.stroke_width(1));
            chart.draw_series([foot])?;
        }
    }
    Ok(())
}

fn boxed(chart: &mut Area, x: f64, half: f64, five: &[f64; 5], colour: RGBColor) -> Result<(), Failure> {
    let [least, lower, median, upper, most] = *five;
    let path = |from: (f64, f64), to: (f64, f64), width| PathElement::new(vec![from, to], colour.stroke_width(width));
    chart.draw_series([Rectangle::new([(x - half, lower), (x + half, upper)], colour.mix(0.25).filled())])?;
    chart.draw_series([Rectangle::new([(x - half, lower), (x + half, upper)], colour.stroke_width(1))])?;
    chart.draw_series([
        path((x, least), (x, lower), 1),
        path((x, upper), (x, most), 1),
        path((x - 0.5 * half, least), (x + 0.5 * half, least), 1),
        path((x - 0.5 * half, most), (x + 0.5 * half, most), 1),
        path((x - half, median), (x + half, median), 3),
    ])?;
    Ok(())
}

/// x and y of everything that an axis must show.
fn extremes(series: &Series) -> Vec<(f64, f64)> {
    match &series.marks {
        Marks::Line(points) | Marks::Curve(points) | Marks::Scatter(points) | Marks::Bars(points) => {
            let ends = |p: &Point| {
                let [low, high] = p.error.unwrap_or([p.y; 2]);
                [(p.x, p.y), (p.x, low), (p.x, high)]
            };
            points.iter().flat_map(ends).collect()
        }
        Marks::Boxes(spreads) => spreads.iter().flat_map(|s| [(s.x, s.five[0]), (s.x, s.five[4])]).collect(),
    }
}

/// Bars and boxes of several series beside each other at each place.
struct Lanes {
    count: usize,
    /// Least distance of two places.
    step: f64,
}

impl Lanes {
    fn of(figure: &Figure) -> Self {
        let places = |series: &Series| -> Option<Vec<f64>> {
            match &series.marks {
                Marks::Bars(points) => Some(points.iter().map(|p| p.x).collect()),
                Marks::Boxes(spreads) => Some(spreads.iter().map(|s| s.x).collect()),
                _ => None,
            }
        };
        let lanes: Vec<Vec<f64>> = figure.series.iter().filter_map(places).collect();
        let mut all: Vec<f64> = lanes.iter().flatten().copied().filter(|x| x.is_finite()).collect();
        all.sort_by(f64::total_cmp);
        let steps = all.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0);
        let step = steps.fold(f64::INFINITY, f64::min);
        Self { count: lanes.len(), step: if step.is_finite() { step } else { 1.0 } }
    }

    /// Room of one series at a place.
    fn width(&self) -> f64 {
        FILLED * self.step / self.count.max(1) as f64
    }

    fn middle(&self, x: f64, lane: usize) -> f64 {
        x + (lane as f64 + 0.5 - 0.5 * self.count as f64) * self.width()
    }
}
