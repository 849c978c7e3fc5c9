//! "Which parameter did it": how the varied keys and the deviation rise and fall together.
//!
//! Association, not cause: draws are independent of each other by construction, so that a rank correlation of one key
//! is not due to another one.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::CaseNumber;
use super::scenario::{KeyPath, Scenario, shapes_the_plan};
use super::vary;
use crate::judgement::moves::Measured;
use crate::judgement::rank_correlation;

/// What one run came to under the values drawn for it.
///
/// Of every run that could be measured, whether it violates or not.
#[derive(Debug, Clone, PartialEq)]
pub struct RunDeviation {
    /// Number of the case.
    pub case: CaseNumber,
    /// 0: nominal.
    pub run: usize,
    /// Largest deviation, m.
    pub max_deviation: f64,
    /// Values drawn for `[vary]`, by key; for run 0 only those of the case's plan.
    pub drawn: Vec<(String, Value)>,
    /// Of arms: what it did on each move.
    pub moves: Option<Measured>,
}

/// A varied number and its rank correlation with the deviation.
///
/// With n runs chance alone comes to |ρ| ≈ 2/√n in one of twenty keys.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Influence {
    /// The key; of an array one element: `world.wind_m_s[1]`.
    pub key: String,
    /// Spearman's ρ with the runs' largest deviation, −1 … 1.
    pub rank_correlation: f64,
    /// Runs that it is over.
    pub runs: usize,
}

/// Of every number under the scenario's `[vary]`, the largest |ρ| first. What was not drawn (for run 0, for the plan of
/// case 0) counts with its nominal value where the scenario has one. Keys that choose between words, or that did not
/// vary, have no rank; nor have those of `spec`, which judge a flight and do not move it.
///
/// Ties have mid-ranks. Equal |ρ| in the order of keys.
pub fn influences(scenario: &Scenario, runs: &[RunDeviation]) -> Vec<Influence> {
    let mut nominal = vary::Tree::new(scenario);
    let mut found = Vec::new();
    for key in scenario.vary().keys().filter(|key| !key.starts_with("spec.")) {
        let Some(path) = KeyPath::parse(key) else { continue };
        let fallback = nominal.get(&path).cloned();
        // As it is written, and as files and reports have it: `world.wind_m_s.1` is `world.wind_m_s[1]`.
        let told = path.to_string();
        let values = |run: &RunDeviation| -> Vec<(String, f64)> {
            let drawn = run.drawn.iter().find(|(name, _)| vary::is_same(name, key)).map(|(_, value)| value);
            let nominal = run.run == 0 || shapes_the_plan(key);
            let value = drawn.or(if nominal { fallback.as_ref() } else { None });
            value.map_or_else(Vec::new, |value| numbers(&told, value))
        };
        let rows: Vec<(Vec<(String, f64)>, f64)> = runs.iter().map(|run| (values(run), run.max_deviation)).collect();
        let Some((names, _)) = rows.iter().max_by_key(|(values, _)| values.len()) else { continue };
        for (place, (name, _)) in names.iter().enumerate() {
            let pairs = rows.iter().filter_map(|(values, deviation)| Some((values.get(place)?.1, *deviation)));
            let (x, y): (Vec<f64>, Vec<f64>) = pairs.unzip();
            if let Some(rank_correlation) = rank_correlation(&x, &y) {
                found.push(Influence { key: name.clone(), rank_correlation, runs: x.len() });
            }
        }
    }
    found.sort_by(|a, b| b.rank_correlation.abs().total_cmp(&a.rank_correlation.abs()).then(a.key.cmp(&b.key)));
    found
}

/// The numbers in a value: itself, or those of an array, each with its own key.
fn numbers(key: &str, value: &Value) -> Vec<(String, f64)> {
    match value {
        Value::Array(items) => {
            items.iter().enumerate().flat_map(|(i, item)| numbers(&format!("{key}[{i}]"), item)).collect()
        }
        _ => value.as_f64().map(|number| (key.to_owned(), number)).into_iter().collect(),
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use serde_json::json;

    /// However the scenario has the key, and whatever files made of it.
    #[test]
    fn an_element_that_is_drawn_alone_has_its_rank() {
        for written in ["world.wind_m_s.1", "world.wind_m_s[1]"] {
            let scenario: Scenario = serde_json::from_value(json!({
                "hairpin": 1, "robot": { "kind": "quadrotor", "name": "test", "mass_kg": 1.0, "rotors": [] },
                "world": { "size_m": [30.0, 30.0, 30.0], "wind_m_s": [0.0, 0.0, 0.0] },
                "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [15.0, 15.0, 15.0], "length": 10 },
                "execute": { "controller": "geometric", "repeat": 4 },
                "vary": { written: { "uniform": [-2.0, 2.0] } },
            }))
            .unwrap();
            for read in ["world.wind_m_s.1", "world.wind_m_s[1]"] {
                let run = |run: usize| RunDeviation {
                    case: CaseNumber(0),
                    run,
                    max_deviation: run as f64,
                    drawn: if run == 0 { vec![] } else { vec![(read.into(), json!(0.5 * run as f64))] },
                    moves: None,
                };
                let found = influences(&scenario, &(0..4).map(run).collect::<Vec<_>>());
                let told: Vec<_> = found.iter().map(|one| (one.key.as_str(), one.rank_correlation, one.runs)).collect();
                assert_eq!(told, [("world.wind_m_s[1]", 1.0, 4)], "{written} {read}");
            }
        }
    }

    #[test]
    fn the_parameter_that_did_it_comes_first() {
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "robot": { "kind": "quadrotor", "name": "test", "mass_kg": 1.0, "rotors": [] },
            "world": { "size_m": [30.0, 30.0, 30.0], "wind_m_s": [0.0, 0.0, 0.0] },
            "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [15.0, 15.0, 15.0], "length": 10 },
            "execute": { "controller": "geometric", "repeat": 9 },
            "vary": {
                "world.wind_m_s": { "uniform": [[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]] },
                "robot.mass_kg": { "normal": [1.0, 0.1] },
                "execute.controller": { "choice": ["geometric", "minimum-snap"] },
                "task.length": { "uniform": [5, 6] },
                "spec.deviation.max_m": { "uniform": [0.5, 0.9] },
            },
        }))
        .unwrap();
        let run = |run: usize| {
            // The deviation follows the wind along y downwards without exception; the mass goes up and down.
            let (wind, mass) = ([0.3, -0.1 * run as f64, 0.0], [1.0, 1.1, 0.9][run % 3]);
            let drawn = [
                ("execute.controller", json!("geometric")),
                ("robot.mass_kg", json!(mass)),
                ("spec.deviation.max_m", json!(0.5 + 0.01 * run as f64)),
                ("world.wind_m_s", json!(wind)),
            ];
            let drawn = drawn.map(|(key, value)| (key.to_owned(), value)).to_vec();
            RunDeviation {
                case: CaseNumber(0),
                run,
                max_deviation: (run * run) as f64,
                drawn: if run == 0 { vec![] } else { drawn },
                moves: None,
            }
        };
        let found = influences(&scenario, &(0..9).map(run).collect::<Vec<_>>());
        let keys: Vec<&str> = found.iter().map(|influence| influence.key.as_str()).collect();
        assert_eq!(keys[0], "world.wind_m_s[1]");
        assert_eq!((found[0].rank_correlation, found[0].runs), (-1.0, 9));
        assert!(keys.contains(&"robot.mass_kg") && found.iter().all(|i| i.rank_correlation.abs() <= 1.0));
        assert!(found.windows(2).all(|w| w[0].rank_correlation.abs() >= w[1].rank_correlation.abs()));
        // z never varied; words and plans have no rank.
        assert!(!keys.iter().any(|key| key.ends_with("[2]") || key.contains("controller") || key.contains("length")));
        assert!(!keys.contains(&"spec.deviation.max_m"));
        assert!(influences(&scenario, &[]).is_empty());
    }
}
