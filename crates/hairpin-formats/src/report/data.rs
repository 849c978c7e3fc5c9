//! What the report's script draws, as JSON: thinned and rounded to what a screen shows, so that files stay small.

use hairpin::campaign::kind::{Relief, Surface};
use hairpin::campaign::report::{Metric, ReportData, Shown};
use hairpin::trajectory::Track;
use nalgebra::{Point3, Vector3};
use serde_json::{Value, json};

use super::relief::shading;

/// Samples of a flight and of a plan that are kept at most.
const FLOWN: usize = 700;
const PLANNED: usize = 300;
/// Triangles of all obstacles together; a mesh beyond that is drawn as its box.
const TRIANGLES: usize = 20_000;
/// Values of a metric that are kept at most, evenly over the sorted ones.
const VALUES: usize = 2_000;

/// The JSON, safe inside a `<script>` element.
pub(super) fn json(data: &ReportData) -> String {
    let size = data.drawing.size;
    let mut left = TRIANGLES;
    let obstacles: Vec<Value> = data.drawing.obstacles.iter().map(|surface| obstacle(surface, &mut left)).collect();
    let low = data.drawing.low;
    let value = json!({
        "low": [round(low.x, 3), round(low.y, 3), round(low.z, 3)],
        "size": [round(size.x, 3), round(size.y, 3), round(size.z, 3)],
        "relief": data.drawing.relief.as_ref().map(relief),
        "obstacles": obstacles,
        "limit": data.deviation_limit,
        "metrics": data.metrics.iter().map(metric).collect::<Vec<_>>(),
        "cases": data.shown.iter().map(case).collect::<Vec<_>>(),
    });
    value.to_string().replace('<', "\\u003c")
}

/// The ground; holes are null.
fn relief(relief: &Relief) -> Value {
    let row = |row: &Vec<f64>| row.iter().map(|h| h.is_finite().then(|| round(*h, 3))).collect::<Vec<Option<f64>>>();
    let shade: Vec<Vec<f64>> =
        shading(relief).iter().map(|row| row.iter().map(|shade| round(*shade, 2)).collect()).collect();
    json!({
        "low": [round(relief.low[0], 3), round(relief.low[1], 3)],
        "step": round(relief.step, 4),
        "z": relief.heights.iter().map(row).collect::<Vec<_>>(),
        "shade": shade,
    })
}

fn obstacle(surface: &Surface, left: &mut usize) -> Value {
    let boxed;
    let drawn = if surface.triangles.len() <= *left {
        surface
    } else {
        boxed = bounding_box(surface);
        &boxed
    };
    *left -= drawn.triangles.len().min(*left);
    let axis = |i: usize| drawn.vertices.iter().map(|v| round(v[i], 3)).collect::<Vec<_>>();
    let corner = |i: usize| drawn.triangles.iter().map(|t| t[i]).collect::<Vec<_>>();
    json!({
        "name": drawn.name, "x": axis(0), "y": axis(1), "z": axis(2), "i": corner(0), "j": corner(1), "k": corner(2),
    })
}

fn bounding_box(surface: &Surface) -> Surface {
    let corner = |fold: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
        std::array::from_fn(|i| surface.vertices.iter().map(|v| v[i]).fold(start, fold))
    };
    let (low, high) = (corner(f64::min, f64::INFINITY), corner(f64::max, f64::NEG_INFINITY));
    let vertex = |c: usize| Point3::from(std::array::from_fn(|i| if c >> i & 1 == 1 { high[i] } else { low[i] }));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Surface {
        name: format!("{} (its box)", surface.name),
        vertices: (0..8).map(vertex).collect(),
        triangles: faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
    }
}

fn metric(metric: &Metric) -> Value {
    let mut sorted = metric.values.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let kept: Vec<f64> = thin(sorted.len(), VALUES, &[]).into_iter().map(|i| round(sorted[i], 4)).collect();
    json!({
        "name": metric.name, "unit": metric.unit, "limit": metric.limit, "lower": metric.lower_is_worse, "values": kept,
    })
}

fn case(shown: &Shown) -> Value {
    // Balls and boxes: few triangles each, and those of the world do not count here.
    let mut left = TRIANGLES;
    let measures = shown.result.measures.as_ref();
    let waypoints: Vec<_> = shown.waypoints.iter().map(|p| [round(p.x, 2), round(p.y, 2), round(p.z, 2)]).collect();
    json!({
        "id": shown.result.case.to_string(),
        "run": shown.result.run,
        "waypoints": waypoints,
        "planned": positions(&shown.planned, &thin(shown.planned.len(), PLANNED, &[])),
        "flown": shown.flown.as_ref().map(|track| flown(shown, track)),
        "obstacles": shown.obstacles.iter().map(|surface| obstacle(surface, &mut left)).collect::<Vec<_>>(),
        "worst": measures.map(|m| json!({"t": m.t_worst, "leg": m.leg_worst, "d": m.max_deviation})),
    })
}

fn flown(shown: &Shown, track: &Track) -> Value {
    let worst = shown.result.measures.as_ref().map(|m| track.times().partition_point(|t| *t < m.t_worst));
    let peak = (0..track.len()).max_by(|a, b| shown.distances[*a].total_cmp(&shown.distances[*b]));
    let must: Vec<usize> = worst.into_iter().chain(peak).filter(|i| *i < track.len()).collect();
    let kept = thin(track.len(), FLOWN, &must);
    let take = |values: &[f64], digits| kept.iter().map(|&i| round(values[i], digits)).collect::<Vec<_>>();
    let mut value = positions(track, &kept);
    value["t"] = json!(take(track.times(), 3));
    // Arms are measured in hundredths of a millimetre.
    let fine = shown.distances.iter().all(|distance| *distance < 0.1);
    value["d"] = json!(take(&shown.distances, if fine { 6 } else { 3 }));
    value["judged"] = json!(kept.iter().map(|&i| u8::from(shown.judged[i])).collect::<Vec<_>>());
    value["v"] = json!(take(&speeds(track), 2));
    value["leg"] = json!(track.channel("leg").map(|legs| take(legs, 0)));
    value["panels"] = json!(panels(track, &kept));
    value
}

/// Further series under deviation and speed: of flights the rotors, of drives curvature, attitude and joints.
fn panels(track: &Track, kept: &[usize]) -> Vec<Value> {
    let take =
        |values: &[f64], scale: f64, digits| kept.iter().map(|&i| round(scale * values[i], digits)).collect::<Vec<_>>();
    let panel = |title: &str, lines: Vec<Value>| (!lines.is_empty()).then(|| json!({ "title": title, "lines": lines }));
    let line = |name: &str, channel: &str, scale, digits| {
        track.channel(channel).map(|values| json!({ "name": name, "y": take(values, scale, digits) }))
    };
    let rotors = (1..).map_while(|i| line(&format!("rotor {i}"), &format!("rotor{i}_rad_s"), 1.0, 0));
    let curvature = [("commanded", "commanded_curvature_1_m"), ("steered", "curvature_1_m")];
    let curvature = curvature.into_iter().filter_map(|(name, channel)| line(name, channel, 1.0, 3));
    let margin = line("tip-over margin", "tip_over_margin_deg", 1.0, 1);
    let attitude = margin.is_some().then(|| {
        // How far the forward and the left axis point above the horizon.
        let up = |axis: usize| {
            let of = |i: &usize| {
                let z = (track.poses()[*i].rotation * Vector3::ith(axis, 1.0)).z;
                round(z.clamp(-1.0, 1.0).asin().to_degrees(), 1)
            };
            kept.iter().map(of).collect::<Vec<_>>()
        };
        [json!({ "name": "nose up", "y": up(0) }), json!({ "name": "left side up", "y": up(1) })]
    });
    let joints = ["rocker", "left_bogie", "right_bogie"].into_iter();
    let joints = joints.filter_map(|name| {
        line(&name.replace('_', " "), &format!("joint_{name}_rad"), 180.0 / std::f64::consts::PI, 1)
    });
    let slip = line("slip", "slip", 100.0, 1);
    [
        panel("rotors rad/s", rotors.collect()),
        panel("curvature 1/m", curvature.collect()),
        panel("angles °", margin.into_iter().chain(attitude.into_iter().flatten()).collect()),
        panel("joints °", joints.collect()),
        panel("slip %", slip.into_iter().collect()),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn positions(track: &Track, kept: &[usize]) -> Value {
    let axis = |a: usize| kept.iter().map(|&i| round(track.position(i)[a], 3)).collect::<Vec<_>>();
    json!({"x": axis(0), "y": axis(1), "z": axis(2)})
}

/// ‖v‖ from the velocity channels, or from positions where nobody recorded velocities.
fn speeds(track: &Track) -> Vec<f64> {
    let channels: Option<Vec<&[f64]>> = ["vx_m_s", "vy_m_s", "vz_m_s"].iter().map(|name| track.channel(name)).collect();
    if let Some(v) = channels {
        return (0..track.len()).map(|i| (v[0][i].powi(2) + v[1][i].powi(2) + v[2][i].powi(2)).sqrt()).collect();
    }
    let last = track.len() - 1;
    let between = |i: usize| (i.saturating_sub(1), (i + 1).min(last));
    let speed = |(a, b): (usize, usize)| match b > a {
        true => (track.position(b) - track.position(a)).norm() / (track.times()[b] - track.times()[a]),
        false => 0.0,
    };
    (0..=last).map(|i| speed(between(i))).collect()
}

/// At most about `most` indices below `count`, evenly, with both ends and all of `must`.
fn thin(count: usize, most: usize, must: &[usize]) -> Vec<usize> {
    let stride = count.div_ceil(most).max(1);
    let mut kept: Vec<usize> =
        (0..count).step_by(stride).chain(count.checked_sub(1)).chain(must.iter().copied()).collect();
    kept.sort_unstable();
    kept.dedup();
    kept
}

fn round(value: f64, digits: i32) -> f64 {
    let scale = 10_f64.powi(digits);
    let rounded = (value * scale).round() / scale;
    // No minus zeros.
    if rounded == 0.0 { 0.0 } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_ends_and_what_must_stay() {
        let kept = thin(10_000, 700, &[4321]);
        assert!(kept.len() <= 702 && kept[0] == 0 && kept.last() == Some(&9_999) && kept.contains(&4321));
        assert_eq!(thin(5, 700, &[]), [0, 1, 2, 3, 4]);
        assert!(thin(0, 700, &[]).is_empty());
    }

    #[test]
    fn rounding_is_short() {
        assert_eq!(round(0.12345, 3).to_string(), "0.123");
        assert_eq!(round(-0.0001, 3).to_string(), "0");
    }
}
