//! What a figure shows: axes, and marks over them.

/// A figure: marks over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What it shows.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// What is drawn, each in a colour of its own, named in the legend. Bars and boxes stand beside each other.
    pub series: Vec<Series>,
}

/// What an axis shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// How values become places.
    pub scale: Scale,
}

/// How values become places.
#[derive(Debug, Clone, PartialEq)]
pub enum Scale {
    /// In proportion, over all that is drawn, from 0 if bars are.
    Linear,
    /// In proportion, over this range.
    Range(f64, f64),
    /// By the logarithm; what is not above 0 is left out.
    Logarithmic,
    /// Names at 0, 1, 2 ….
    Names(Vec<String>),
}

/// One kind of marks.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// In the legend; empty: not there.
    pub name: String,
    /// What is drawn.
    pub marks: Marks,
}

/// What is drawn of a series. Numbers that are not finite are left out.
#[derive(Debug, Clone, PartialEq)]
pub enum Marks {
    /// Points joined by a line, each with a dot.
    Line(Vec<Point>),
    /// A line without dots: curves of many points.
    Curve(Vec<Point>),
    /// Dots.
    Scatter(Vec<Point>),
    /// Bars from 0 (on a logarithmic axis from its lower end).
    Bars(Vec<Point>),
    /// Median, quartiles and whiskers.
    Boxes(Vec<Spread>),
}

/// A value, with its error bar if it has one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Where to the right.
    pub x: f64,
    /// How high.
    pub y: f64,
    /// Lower and upper end of the error bar.
    pub error: Option<[f64; 2]>,
}

impl Point {
    /// Without an error bar.
    pub fn new(x: f64, y: f64) -> Self {
        Self { x, y, error: None }
    }

    /// With an error bar from `low` to `high`.
    pub fn between(x: f64, y: f64, low: f64, high: f64) -> Self {
        Self { x, y, error: Some([low, high]) }
    }
}

/// How values at one place are spread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Where to the right.
    pub x: f64,
    /// Smallest, lower quartile, median, upper quartile, largest.
    pub five: [f64; 5],
}

impl Spread {
    /// Quartiles by linear interpolation between order statistics (Hyndman and Fan's type 7); `None` of no values.
    pub fn of(x: f64, values: &[f64]) -> Option<Self> {
        let mut values: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let quantile = |quarter: usize| {
            let (whole, rest) = (last * quarter / 4, (last * quarter % 4) as f64 / 4.0);
            values[whole] + rest * (values[(whole + 1).min(last)] - values[whole])
        };
        Some(Self { x, five: [0, 1, 2, 3, 4].map(quantile) })
    }
}
