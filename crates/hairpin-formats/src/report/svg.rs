//! Drawings without JavaScript: top and side view of a case.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use hairpin::campaign::kind::{Drawing, Surface};
use hairpin::campaign::report::Shown;
use hairpin::trajectory::Track;
use nalgebra::Point3;

use super::column::round;
use super::relief;

/// Drawing area of one view, in the SVG's own units.
const SIDE: f64 = 420.0;
const MARGIN: f64 = 42.0;
const GAP: f64 = 56.0;
/// Points of a path that are drawn at most.
const POINTS: usize = 250;

/// Of what is called `name`: top view (x, y) and side view (x, z) on one scale, with obstacles, waypoints, plan, flight
/// and its worst moment.
pub(super) fn views(shown: &Shown, name: &str, drawing: &Drawing) -> String {
    let Layout { scale, width, top, side, height, full, tall } = Layout::of(drawing);
    let low = drawing.low;
    let mut svg = format!(
        "<svg class=\"views\" viewBox=\"0 0 {full:.0} {tall:.0}\" role=\"img\" aria-label=\"Top and side view of {}\">",
        name
    );
    let at = |x0: f64, across: usize, up: usize, span: f64| View {
        x0,
        y1: MARGIN + height,
        scale,
        low: [low[across], low[up]],
        across,
        up,
        width,
        span,
    };
    view(&mut svg, shown, drawing, &at(MARGIN, 0, 1, top), "top");
    view(&mut svg, shown, drawing, &at(MARGIN + width + GAP, 0, 2, side), "side");
    svg.push_str("</svg>");
    svg
}

/// Where the two views are, in the SVG's own units.
struct Layout {
    scale: f64,
    width: f64,
    top: f64,
    side: f64,
    height: f64,
    full: f64,
    tall: f64,
}

impl Layout {
    fn of(drawing: &Drawing) -> Self {
        let size = drawing.size;
        let scale = SIDE / size.max();
        let (width, top, side) = (size.x * scale, size.y * scale, size.z * scale);
        let height = top.max(side);
        let (full, tall) = (2.0 * width + 2.0 * MARGIN + GAP, height + 2.0 * MARGIN);
        Self { scale, width, top, side, height, full, tall }
    }
}

/// What the page's style says of the views, for a file of their own: ink on paper.
const STYLE: &str = "text{font:12px system-ui,'DejaVu Sans',sans-serif;fill:#1b2733}.tick,.axis{fill:#5b6b7a;font-size:11px}\
    .number{font-size:11px;font-weight:650}.title{font-size:14px;font-weight:650}.cage{fill:#fafbfc;stroke:#c3ced8}\
    .obstacle{fill:#9aa7b3;fill-opacity:.5;stroke:#9aa7b3}.legs{fill:none;stroke:#9aa7b3;stroke-dasharray:2 4}\
    .planned{fill:none;stroke:#0b6ea8;stroke-width:1.6;stroke-dasharray:7 4}\
    .flown{fill:none;stroke:#b5400d;stroke-width:2;stroke-linejoin:round}.worst{fill:none;stroke:#1b2733;stroke-width:2}\
    .waypoint{fill:#1b2733}";
/// Room for the words above and below the views.
const WORDS: f64 = 30.0;

/// A file with both views of what is called `name`, and in words what is seen.
pub(super) fn picture(shown: &Shown, name: &str, told: [&str; 2], drawing: &Drawing) -> String {
    let Layout { full, tall, .. } = Layout::of(drawing);
    let [title, done] = told;
    let height = tall + 2.0 * WORDS;
    let inner = views(shown, name, drawing).replacen(
        "<svg ",
        &format!("<svg x=\"0\" y=\"{WORDS}\" width=\"{full:.0}\" height=\"{tall:.0}\" "),
        1,
    );
    let below = tall + WORDS + 8.0;
    let (left, second, third) = (MARGIN, MARGIN + 110.0, MARGIN + 230.0);
    let y = below - 4.0;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {full:.0} {height:.0}\" width=\"{full:.0}\" height=\"{height:.0}\">\
         <title>{title}</title><style>{STYLE}</style><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>{ground}\
         <text class=\"title\" x=\"{left}\" y=\"24\">{title}</text>{inner}\
         <path class=\"flown\" d=\"M{left} {y}h24\"/><text x=\"{a}\" y=\"{below}\">{done}</text>\
         <path class=\"planned\" d=\"M{second} {y}h24\"/><text x=\"{b}\" y=\"{below}\">planned</text>\
         <circle class=\"worst\" cx=\"{third}\" cy=\"{y}\" r=\"6\"/><text x=\"{c}\" y=\"{below}\">worst moment; not aligned</text></svg>\n",
        a = left + 30.0,
        b = second + 30.0,
        c = third + 14.0,
        ground = ground(drawing),
    )
}

/// Side of the ground's picture, in its own units.
const GROUND: f64 = 100.0;

/// The ground's picture, once for all views; nothing where there is none.
pub(super) fn ground(drawing: &Drawing) -> String {
    let Some(picture) = drawing.relief.as_ref().and_then(relief::picture) else { return String::new() };
    format!(
        "<svg class=\"shared\" width=\"0\" height=\"0\" aria-hidden=\"true\"><defs><image id=\"ground\" width=\"{GROUND}\" \
         height=\"{GROUND}\" preserveAspectRatio=\"none\" href=\"data:image/png;base64,{}\"/></defs></svg>",
        STANDARD.encode(picture)
    )
}

/// A projection: world axes `across` and `up` onto the page.
struct View {
    x0: f64,
    y1: f64,
    scale: f64,
    /// Coordinates of the lower left corner.
    low: [f64; 2],
    across: usize,
    up: usize,
    width: f64,
    span: f64,
}

impl View {
    fn place(&self, p: &Point3<f64>) -> (f64, f64) {
        (self.x0 + (p[self.across] - self.low[0]) * self.scale, self.y1 - (p[self.up] - self.low[1]) * self.scale)
    }
}

fn view(svg: &mut String, shown: &Shown, drawing: &Drawing, view: &View, name: &str) {
    let names = ["x", "y", "z"];
    let (x0, y0) = (view.x0, view.y1 - view.span);
    let mut add = |part: String| svg.push_str(&part);
    add(format!(
        "<rect class=\"cage\" x=\"{x0:.1}\" y=\"{y0:.1}\" width=\"{:.1}\" height=\"{:.1}\"/>",
        view.width, view.span
    ));
    if drawing.relief.is_some() && view.up == 1 {
        let (across, up) = (view.width / GROUND, view.span / GROUND);
        add(format!("<use href=\"#ground\" transform=\"translate({x0:.1} {y0:.1}) scale({across:.5} {up:.5})\"/>"));
    }
    let ticks = |low: f64, extent: f64| {
        let most = (extent * view.scale / 22.0).min(6.5);
        let steps = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];
        let step = steps.into_iter().find(|step| extent / step <= most).unwrap_or(extent);
        let first = (low / step).ceil() as i64;
        (first..=((low + extent) / step).floor() as i64).map(move |i| round(i as f64 * step, 3))
    };
    for tick in ticks(view.low[0], drawing.size[view.across]) {
        let x = view.x0 + (tick - view.low[0]) * view.scale;
        add(format!(
            "<text class=\"tick\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{tick}</text>",
            view.y1 + 15.0
        ));
    }
    for tick in ticks(view.low[1], drawing.size[view.up]) {
        let y = view.y1 - (tick - view.low[1]) * view.scale + 3.5;
        add(format!("<text class=\"tick\" x=\"{:.1}\" y=\"{y:.1}\" text-anchor=\"end\">{tick}</text>", view.x0 - 6.0));
    }
    let label = format!("{name} view: {} across, {} up, m", names[view.across], names[view.up]);
    add(format!("<text class=\"axis\" x=\"{x0:.1}\" y=\"{:.1}\">{label}</text>", y0 - 10.0));
    for obstacle in drawing.obstacles.iter().chain(&shown.obstacles) {
        add(format!("<path class=\"obstacle\" d=\"{}\"/>", outline(obstacle, view)));
    }
    add(format!("<polyline class=\"legs\" points=\"{}\"/>", points(shown.waypoints.iter().copied(), view)));
    add(format!("<polyline class=\"planned\" points=\"{}\"/>", track(&shown.planned, view)));
    if let Some(flown) = &shown.flown {
        add(format!("<polyline class=\"flown\" points=\"{}\"/>", track(flown, view)));
        if let Some(moment) = &shown.moment {
            let index = flown.times().partition_point(|t| *t < moment.at).min(flown.len() - 1);
            let (x, y) = view.place(&flown.position(index));
            add(format!("<circle class=\"worst\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"8\"/>"));
        }
    }
    for (number, waypoint) in shown.waypoints.iter().enumerate() {
        let (x, y) = view.place(waypoint);
        add(format!("<circle class=\"waypoint\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.2\"/>"));
        add(format!("<text class=\"number\" x=\"{:.1}\" y=\"{:.1}\">{number}</text>", x + 6.0, y - 5.0));
    }
}

/// The shadow of an obstacle: the hull of its projected corners (Andrew's monotone chain).
fn outline(obstacle: &Surface, view: &View) -> String {
    let mut corners: Vec<(f64, f64)> = obstacle.vertices.iter().map(|v| view.place(v)).collect();
    corners.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    corners.dedup();
    let mut hull: Vec<(f64, f64)> = Vec::new();
    let (there, back) = (corners.clone(), corners.into_iter().rev());
    for half in [there, back.collect()] {
        let start = hull.len();
        for c in half {
            while hull.len() >= start + 2 && turns_right(hull[hull.len() - 2], hull[hull.len() - 1], c) {
                hull.pop();
            }
            hull.push(c);
        }
        hull.pop();
    }
    let mut path = String::new();
    for (i, (x, y)) in hull.iter().enumerate() {
        let _ = write!(path, "{}{x:.1} {y:.1}", if i == 0 { 'M' } else { 'L' });
    }
    path + "Z"
}

fn turns_right(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> bool {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0) <= 0.0
}

fn track(track: &Track, view: &View) -> String {
    let stride = track.len().div_ceil(POINTS).max(1);
    let kept = (0..track.len()).filter(|i| i % stride == 0 || i + 1 == track.len());
    points(kept.map(|i| track.position(i)), view)
}

fn points(positions: impl Iterator<Item = Point3<f64>>, view: &View) -> String {
    let mut text = String::new();
    for p in positions {
        let (x, y) = view.place(&p);
        let _ = write!(text, "{x:.1},{y:.1} ");
    }
    text.trim_end().to_owned()
}
