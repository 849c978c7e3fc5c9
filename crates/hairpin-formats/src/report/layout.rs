//! The robot from above, forward up: its wheels, or its rotors with their spins.

use std::fmt::Write;

use hairpin::campaign::kind::Drawing;

/// The robot seen from above, forward up: its rotors or its wheels.
pub(super) fn robot(drawing: &Drawing) -> String {
    if drawing.rotors.is_empty() { wheels(drawing) } else { rotors(drawing) }
}

fn wheels(drawing: &Drawing) -> String {
    let reach = drawing.wheels.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max).max(1e-6);
    let unit = 84.0 / reach;
    // As long as the next one behind it leaves room for.
    let behind = |x: f64| drawing.wheels.iter().map(move |other| (other[0] - x).abs()).filter(|apart| *apart > 1e-3);
    let nearest = drawing.wheels.iter().flat_map(|[x, _]| behind(*x)).fold(f64::INFINITY, f64::min);
    let long = (0.8 * unit * nearest).clamp(8.0, 30.0);
    let mut svg = String::from(
        "<svg class=\"rotors\" viewBox=\"-120 -120 240 240\" role=\"img\" aria-label=\"Wheels seen from above\">\
         <path class=\"forward\" d=\"M0 -14 L7 4 L0 0 L-7 4 Z\"/>\
         <text class=\"axis\" x=\"0\" y=\"-104\" text-anchor=\"middle\">forward ↑</text>",
    );
    for [x, y] in &drawing.wheels {
        let (x, y) = (-y * unit, -x * unit);
        let _ = write!(
            svg,
            "<line class=\"arm\" x1=\"0\" y1=\"0\" x2=\"{x:.1}\" y2=\"{y:.1}\"/>\
             <rect class=\"wheel\" x=\"{:.1}\" y=\"{:.1}\" width=\"14\" height=\"{long:.1}\" rx=\"4\"/>",
            x - 7.0,
            y - 0.5 * long
        );
    }
    svg + "</svg>"
}

/// The rotors: numbers, spins, and the ball that holds the robot.
fn rotors(drawing: &Drawing) -> String {
    let reach = drawing.rotors.iter().map(|r| r.x.hypot(r.y)).fold(0.0, f64::max).max(1e-6);
    let unit = 62.0 / reach;
    let mut svg = String::from(
        "<svg class=\"rotors\" viewBox=\"-120 -120 240 240\" role=\"img\" aria-label=\"Rotor layout seen from above\">",
    );
    let mut add = |part: String| svg.push_str(&part);
    add(String::from(
        "<path class=\"forward\" d=\"M0 -14 L7 4 L0 0 L-7 4 Z\"/><text class=\"axis\" x=\"0\" y=\"-104\" text-anchor=\"middle\">forward ↑</text>",
    ));
    for (number, rotor) in drawing.rotors.iter().enumerate() {
        // Body x is up on the page, body y (left) is left.
        let (x, y) = (-rotor.y * unit, -rotor.x * unit);
        let class = if rotor.clockwise { "cw" } else { "ccw" };
        let (r, sweep) = (27.0, if rotor.clockwise { 1.0 } else { -1.0 });
        let point = |angle: f64| (x + r * angle.cos(), y + r * angle.sin());
        let (from, to) = (point(-2.6 * sweep - 1.57), point(1.3 * sweep - 1.57));
        let large =
            format!("M{:.1} {:.1} A{r} {r} 0 1 {} {:.1} {:.1}", from.0, from.1, u8::from(rotor.clockwise), to.0, to.1);
        // The arrow head: a triangle at the arc's end, along its tangent.
        let end = 1.3 * sweep - 1.57;
        let (tangent, normal) = ((-end.sin() * sweep, end.cos() * sweep), (end.cos(), end.sin()));
        let tip = (to.0 + 10.0 * tangent.0, to.1 + 10.0 * tangent.1);
        let wing = |side: f64| (to.0 + side * 6.0 * normal.0, to.1 + side * 6.0 * normal.1);
        let (a, b) = (wing(1.0), wing(-1.0));
        add(format!("<line class=\"arm\" x1=\"0\" y1=\"0\" x2=\"{x:.1}\" y2=\"{y:.1}\"/>"));
        add(format!(
            "<circle class=\"disc {class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{r}\"/><path class=\"arc {class}\" d=\"{large}\"/>"
        ));
        add(format!(
            "<path class=\"head {class}\" d=\"M{:.1} {:.1} L{:.1} {:.1} L{:.1} {:.1} Z\"/>",
            tip.0, tip.1, a.0, a.1, b.0, b.1
        ));
        add(format!(
            "<text class=\"rotor\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            y + 5.0,
            number + 1
        ));
    }
    svg.push_str("</svg>");
    svg
}
