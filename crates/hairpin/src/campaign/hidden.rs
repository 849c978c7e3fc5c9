//! What may hide between the samples of a program's flight: who flies it samples as he likes, and five poses of a
//! flight keep any limit.
//!
//! Bounded as what hides in a log is ([`look_closely`]). Our own simulators sample as their integration goes, and
//! nothing is asked of them.

use nalgebra::Point3;

use super::Setup;
use super::digits::number;
use crate::judgement::{JudgementError, Measures, Settings, Swiftness, look_closely, measure, told};
use crate::trajectory::Track;

/// Measures a track and, where a program of the user's told it, the largest deviation that may hide between its
/// samples.
///
/// Of what nothing bounds how suddenly it turns (drives, boats) the samples are all there is. A model's top speed is no
/// bound of another simulator's.
pub(super) fn sampled(
    setup: &Setup,
    track: &Track,
    waypoints: &[Point3<f64>],
    settings: &Settings,
) -> Result<Measures, JudgementError> {
    let mut measures = measure(track, waypoints, settings)?;
    let swiftness = Swiftness { speed: None, ..setup.swiftness() };
    if setup.program().is_some() && swiftness.acceleration.is_some() {
        let close = look_closely(track, waypoints, settings, &swiftness, 0.0)?;
        let most = close.iter().filter_map(|close| close.until_next).reduce(f64::max);
        measures.most_between = most.filter(|most| most.is_finite());
    }
    Ok(measures)
}

/// Why the samples do not decide that a deviation is within `limit`, m: what may hide between them, and how many would.
///
/// A motion bulges by a Δt²/8 out of the line between samples: f = √(a / 8 m), m the margin that the samples leave.
pub(super) fn hidden(setup: &Setup, measures: &Measures, limit: Option<f64>) -> Option<String> {
    let limit = limit.filter(|limit| measures.max_deviation <= *limit)?;
    let most = measures.most_between.filter(|most| *most > limit)?;
    let margin = limit - measures.max_deviation;
    let rate = setup.swiftness().acceleration.map(|a| (a / (8.0 * margin)).sqrt()).filter(|rate| rate.is_finite());
    let rate = rate.map_or(String::new(), |rate| format!("; {} poses a second decide", rate.ceil()));
    let seen = told(measures.max_deviation, Some(limit), "m");
    Some(format!("{seen} m at its poses, but {} m may hide between two of them{rate}", number(Some(most))))
}

#[cfg(test)]
mod tests {
    use nalgebra::Isometry3;
    use serde_json::json;

    use super::*;
    use crate::campaign::Scenario;
    use crate::campaign::testing::quadrotor;
    use crate::trajectory::Channel;

    fn setup(command: Option<&str>) -> Setup {
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0] },
            "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [23.0, 3.0, 3.0], "length": 2 },
            "execute": command.map_or_else(|| json!({}), |command| json!({ "command": command })),
        }))
        .unwrap();
        Setup::new(scenario).unwrap()
    }

    /// Along a leg of 20 m in 10 s, a pose every `step` s: as good as it gets, where one looks.
    fn judged(setup: &Setup, step: f64, limit: f64) -> (Measures, Option<String>) {
        let count = (10.0 / step).round() as usize;
        let times: Vec<f64> = (0..=count).map(|i| i as f64 * step).collect();
        let poses = times.iter().map(|t| Isometry3::translation(3.0 + 2.0 * t, 3.0, 3.0)).collect();
        let leg = Channel { name: "leg".into(), values: vec![0.0; times.len()] };
        let track = Track::new(times, poses, vec![leg]).unwrap();
        let way = [Point3::new(3.0, 3.0, 3.0), Point3::new(23.0, 3.0, 3.0)];
        let measures = sampled(setup, &track, &way, &Settings::default()).unwrap();
        let hidden = hidden(setup, &measures, Some(limit));
        (measures, hidden)
    }

    #[test]
    fn what_is_not_looked_at_is_no_pass() {
        let program = setup(Some("sim"));
        let most = program.swiftness().acceleration.unwrap();
        let (sparse, why) = judged(&program, 2.5, 0.5);
        assert!((sparse.most_between.unwrap() - most * 2.5 * 2.5 / 8.0).abs() < 1e-9, "{sparse:?}");
        let why = why.unwrap();
        let rate = (most / 4.0).sqrt().ceil();
        assert!(why.starts_with("0.00 m at its poses, but ") && why.contains(" m may hide between two"), "{why}");
        assert!(why.ends_with(&format!("; {rate} poses a second decide")), "{why}");
        // As many as it says, and fifty a second.
        assert_eq!(judged(&program, 1.0 / rate, 0.5).1, None);
        let (dense, why) = judged(&program, 0.02, 0.5);
        assert!(dense.most_between.unwrap() < 0.01 && why.is_none(), "{dense:?}");
        // A violation is one however it is sampled, and our own simulator is not asked.
        assert_eq!(hidden(&program, &Measures { max_deviation: 0.6, ..sparse }, Some(0.5)), None);
        assert_eq!(judged(&setup(None), 2.5, 0.5).0.most_between, None);
    }
}
