//! What the report's script draws, as JSON: thinned and rounded to what a screen shows, so that files stay small.

use std::collections::BTreeMap;

use hairpin::campaign::Status;
use hairpin::campaign::kind::Relief;
use hairpin::campaign::report::{Length, Metric, OtherRun, ReportData, Shown};
use hairpin::judgement::decimals_of;
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Track};
use serde_json::{Value, json};

use super::column::{column, counts, round};
use super::panels::panels;
use super::relief::shading;
use super::solids::{Meshes, meshes, robot};

/// Samples of all flights together, of one at most, and of one at least.
const FLOWN: [usize; 3] = [80_000, 700, 150];
/// Samples of a plan, as a share of a flight's.
const PLANNED: usize = 2;
/// Samples of another run of a case, and such runs at most: of the worst cases first.
const OTHER: usize = 200;
const OTHERS: usize = 300;

/// The JSON, safe inside a `<script>` element.
pub(super) fn json(data: &ReportData) -> String {
    let size = data.drawing.size;
    let Meshes { drawn: obstacles, told } = meshes(&data.drawing.obstacles);
    let low = data.drawing.low;
    let samples = (FLOWN[0] / data.shown.len().max(1)).clamp(FLOWN[2], FLOWN[1]);
    let mut others = OTHERS;
    let value = json!({
        "low": [round(low.x, 3), round(low.y, 3), round(low.z, 3)],
        "size": [round(size.x, 3), round(size.y, 3), round(size.z, 3)],
        "relief": data.drawing.relief.as_ref().map(relief),
        "obstacles": obstacles,
        "obstaclesTold": told,
        "robot": data.drawing.figure.as_ref().map(robot),
        "beside": data.beside.runs,
        "shown": data.beside.shown,
        "folder": data.folder,
        "unit": data.length.unit,
        "done": data.drawing.done,
        "digits": decimals_of(data.length.limit.unwrap_or_default(), 2),
        "limit": data.length.limit.map(tidy),
        "open": data.shown.iter().position(|shown| Some(shown.result.case) == data.opens).unwrap_or_default(),
        "ids": data.results.iter().map(|result| data.name(result.case)).collect::<Vec<_>>(),
        "status": data.results.iter().map(|result| result.status.word()).collect::<Vec<_>>(),
        "metrics": data.metrics.iter().map(metric).collect::<Vec<_>>(),
        "draws": draws(data),
        "cases": data.shown.iter().map(|shown| case(data, shown, samples, &mut others)).collect::<Vec<_>>(),
    });
    value.to_string().replace('<', "\\u003c")
}

/// The ground; holes are nothing.
fn relief(relief: &Relief) -> Value {
    let shade = shading(relief);
    json!({
        "low": [round(relief.low[0], 3), round(relief.low[1], 3)],
        "step": round(relief.step, 4),
        "rows": relief.heights.len(),
        "columns": relief.heights.first().map_or(0, Vec::len),
        "z": column(relief.heights.iter().flatten().copied()),
        "shade": column(shade.iter().flatten().copied()),
    })
}

fn metric(metric: &Metric) -> Value {
    json!({
        "name": metric.name,
        "unit": metric.unit,
        "limit": metric.limit.map(tidy),
        "lower": metric.lower_is_worse,
        "values": column(metric.values.iter().map(|value| value.unwrap_or(f64::NAN))),
        "random": (!metric.random.is_empty()).then(|| column(metric.random.iter().copied())),
    })
}

/// What was drawn for the worst run of every case: numbers, and the parts of what has several.
fn draws(data: &ReportData) -> Vec<Value> {
    let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    let count = data.results.len();
    for (row, result) in data.results.iter().enumerate() {
        let mut note = |name: String, value: Option<f64>| {
            if let Some(value) = value {
                columns.entry(name).or_insert_with(|| vec![f64::NAN; count])[row] = value;
            }
        };
        for (key, value) in &result.drawn {
            note(key.clone(), value.as_f64());
            for (i, part) in value.as_array().into_iter().flatten().enumerate() {
                note(format!("{key}[{i}]"), part.as_f64());
            }
        }
    }
    columns.into_iter().map(|(name, values)| json!({ "name": name, "values": column(values) })).collect()
}

fn case(data: &ReportData, shown: &Shown, samples: usize, others: &mut usize) -> Value {
    let length = &data.length;
    let waypoints: Vec<_> = shown.waypoints.iter().map(|p| [round(p.x, 3), round(p.y, 3), round(p.z, 3)]).collect();
    let kept = thin(shown.planned.len(), samples / PLANNED, &[]);
    // What the figure is posed by: of arms the joints.
    let joints = (1..=6).map(|axis| format!("q{axis}_rad")).filter(|name| shown.planned.channel(name).is_some());
    let joints: Vec<String> = joints.collect();
    let joints: Vec<&str> = joints.iter().map(String::as_str).collect();
    let planned = motion(&shown.planned, &kept, turns(&shown.planned), &joints);
    let runs: Vec<&OtherRun> = shown.others.iter().take(*others).collect();
    *others -= runs.len();
    let moment = shown.moment.as_ref();
    json!({
        "id": data.name(shown.result.case),
        "status": shown.result.status.word(),
        "fails": shown.result.status == Status::Fail,
        "run": shown.result.run,
        "at": moment.map_or(0.0, |moment| moment.at),
        "told": moment.map_or(shown.result.message.as_deref().unwrap_or_default(), |moment| moment.told.as_str()),
        "mark": moment.map(|moment| moment.mark.as_str()),
        "waypoints": waypoints,
        "planned": planned,
        "flown": shown.flown.as_ref().map(|track| flown(shown, track, samples, length)),
        "runs": runs.into_iter().map(|run| other(run, length)).collect::<Vec<_>>(),
        "obstacles": meshes(&shown.obstacles).drawn,
    })
}

fn flown(shown: &Shown, track: &Track, samples: usize, length: &Length) -> Value {
    let at = shown.moment.as_ref().map(|moment| track.times().partition_point(|t| *t < moment.at));
    let peak = (0..track.len()).max_by(|a, b| shown.distances[*a].total_cmp(&shown.distances[*b]));
    let must: Vec<usize> = at.into_iter().chain(peak).filter(|i| *i < track.len()).collect();
    let kept = thin(track.len(), samples, &must);
    let take = |values: &[f64]| column(kept.iter().map(|&i| values[i]));
    let (panels, channels) = panels(track);
    let channels: Vec<&str> = channels.iter().map(String::as_str).collect();
    let known = track.channel(ATTITUDE_UNKNOWN).is_none();
    let mut value = motion(track, &kept, known, &channels);
    value["d"] = column(kept.iter().map(|&i| length.in_metre * shown.distances[i]));
    value["judged"] = counts(kept.iter().map(|&i| u32::from(shown.judged[i])));
    value["v"] = take(&speeds(track));
    value["leg"] = json!(track.channel("leg").map(|legs| counts(kept.iter().map(|&i| legs[i] as u32))));
    value["panels"] = json!(panels);
    value
}

fn other(run: &OtherRun, length: &Length) -> Value {
    let peak = (0..run.distances.len()).max_by(|a, b| run.distances[*a].total_cmp(&run.distances[*b]));
    let kept = thin(run.flown.len(), OTHER, peak.as_slice());
    let axis = |a: usize| column(kept.iter().map(|&i| run.flown.position(i)[a]));
    json!({
        "run": run.run,
        "t": column(kept.iter().map(|&i| run.flown.times()[i])),
        "d": column(kept.iter().map(|&i| length.in_metre * run.distances[i])),
        "x": axis(0), "y": axis(1), "z": axis(2),
    })
}

/// Whether a plan says how the robot is turned.
fn turns(track: &Track) -> bool {
    track.poses().iter().any(|pose| pose.rotation.angle() > 1e-6)
}

/// Places, stamps, attitudes where they are known, and channels.
fn motion(track: &Track, kept: &[usize], turns: bool, channels: &[&str]) -> Value {
    let axis = |a: usize| column(kept.iter().map(|&i| track.position(i)[a]));
    let turned = |part: usize| {
        column(kept.iter().map(|&i| {
            let q = track.poses()[i].rotation;
            [q.w, q.i, q.j, q.k][part]
        }))
    };
    let named = |name: &&str| Some(((*name).to_owned(), column(kept.iter().map(|&i| channel(track, name, i)))));
    let channels: serde_json::Map<String, Value> = channels.iter().filter_map(named).collect();
    json!({
        "t": column(kept.iter().map(|&i| track.times()[i])),
        "x": axis(0), "y": axis(1), "z": axis(2),
        "q": turns.then(|| (0..4).map(turned).collect::<Vec<_>>()),
        "channels": channels,
    })
}

/// A recorded channel, or one of two that attitudes tell: how far forward and left axis point above the horizon, °.
fn channel(track: &Track, name: &str, i: usize) -> f64 {
    let axis = match name {
        "nose_up_deg" => nalgebra::Vector3::x(),
        "left_up_deg" => nalgebra::Vector3::y(),
        _ => return track.channel(name).map_or(f64::NAN, |values| values[i]),
    };
    (track.poses()[i].rotation * axis).z.clamp(-1.0, 1.0).asin().to_degrees()
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

/// Without the last digits that a change of unit leaves: 10 mm is not 10.000000000000002.
fn tidy(value: f64) -> f64 {
    round(value, 9)
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
        assert_eq!(tidy(1e3 * 0.0101), 10.1);
    }
}
