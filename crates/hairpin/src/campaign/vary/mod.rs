//! `[vary]`: what is drawn for a case or a run, and the scenario that the draws make.
//!
//! One random stream per parameter and case, so that adding a parameter changes no other's draws. Run 0 and case 0
//! are nominal. Keys under `task` and `generate` shape the plan and are drawn once per case; the others once per run.

mod tree;

use serde_json::Value;

use super::CaseNumber;
use super::scenario::{Distribution, KeyPath, Mistake, Scenario, shapes_the_plan, zip};
use crate::math::random::{Stream, named_seed, standard_normals, stream, unit};

pub(super) use tree::Tree;

/// How often a truncated draw is repeated. [`super::Setup::build`] refuses truncations that keep less than one draw in
/// a hundred, so this many failures in a row have a probability of 10⁻⁴³.
const REDRAWS: usize = 10_000;

/// The values of run number `run` of the case with `case_seed`; none for run 0. Keys in alphabetical order.
///
/// The same scenario, seed and run give the same values, on any machine.
pub fn draw(scenario: &Scenario, case_seed: u64, run: usize) -> Vec<(String, Value)> {
    if run == 0 { Vec::new() } else { draw_keys(scenario, case_seed, run as u64, |key| !shapes_the_plan(key)) }
}

/// The values of `task` and `generate` for case number `case`; none for case 0. Keys in alphabetical order.
pub fn draw_for_case(scenario: &Scenario, case_seed: u64, case: CaseNumber) -> Vec<(String, Value)> {
    if case.0 == 0 { Vec::new() } else { draw_keys(scenario, case_seed, 0, shapes_the_plan) }
}

/// The scenario with the drawn values in place of the nominal ones, and nothing left to vary.
///
/// Bounds are not checked here: the setup that is built of it does.
///
/// # Errors
/// A key that the scenario has not, or a value of another type than the key's.
pub fn apply(scenario: &Scenario, draws: &[(String, Value)]) -> Result<Scenario, Mistake> {
    let mut drawn = scenario.clone();
    put(&mut drawn, draws)?;
    drawn.vary_mut().clear();
    Ok(drawn)
}

/// The scenario of a case's plan: with the values that were drawn for it in place of the nominal ones, and only runs
/// left to vary.
///
/// # Errors
/// As [`apply`].
pub fn settle(scenario: &Scenario, draws: &[(String, Value)]) -> Result<Scenario, Mistake> {
    let of_plan: Vec<(String, Value)> = draws.iter().filter(|(key, _)| shapes_the_plan(key)).cloned().collect();
    let mut settled = apply(scenario, &of_plan)?;
    *settled.vary_mut() = scenario.vary().clone();
    settled.vary_mut().retain(|key, _| !shapes_the_plan(key));
    Ok(settled)
}

/// Whether two keys name the same value, in whichever way they write an index.
pub(super) fn is_same(one: &str, other: &str) -> bool {
    one == other || KeyPath::parse(one).is_some_and(|path| KeyPath::parse(other) == Some(path))
}

/// The stream of a key is seeded by the case's seed, the key, and `index`. Keys that cannot be read are left out.
fn draw_keys(scenario: &Scenario, seed: u64, index: u64, wanted: impl Fn(&str) -> bool) -> Vec<(String, Value)> {
    let keys: Vec<_> = scenario.vary().iter().filter(|(key, _)| wanted(key)).collect();
    let mut nominal = Tree::new(scenario);
    keys.into_iter()
        .filter_map(|(key, distribution)| {
            let mut random = stream(named_seed(seed, key, index));
            let nominal = nominal.get(&KeyPath::parse(key)?);
            Some((key.clone(), sample(distribution, nominal, &mut random)?))
        })
        .collect()
}

/// One draw; `nominal` says where whole numbers are wanted. `None` for what [`super::Setup::build`] refuses.
///
/// Uniform: low + u (high − low), of whole numbers ⌊low + u (high − low + 1)⌋. Normal: redrawn until it lies within the
/// truncation. Lists are drawn number by number.
fn sample(distribution: &Distribution, nominal: Option<&Value>, random: &mut Stream) -> Option<Value> {
    if let Some([low, high]) = &distribution.uniform {
        return zip(low, high, nominal, &mut |low, high, whole| {
            // Every whole number of the range is equally likely, both ends included.
            if whole { (low + unit(random) * (high - low + 1.0)).floor() } else { low + unit(random) * (high - low) }
        });
    }
    if let Some([mean, deviation]) = &distribution.normal {
        return zip(mean, deviation, nominal, &mut |mean, deviation, _| {
            let (low, high) = distribution.interval(mean, deviation);
            let mut draws = (0..REDRAWS).map(|_| mean + deviation * standard_normals::<1>(random)[0]);
            draws.find(|x| (low..=high).contains(x)).unwrap_or(mean.clamp(low, high.max(low)))
        });
    }
    let choice = distribution.choice.as_ref()?;
    choice.get((unit(random) * choice.len() as f64) as usize).cloned()
}

/// Puts the draws into the sections that they name; all others stay as they are.
fn put(scenario: &mut Scenario, draws: &[(String, Value)]) -> Result<(), Mistake> {
    let mistake = |(key, value): &(String, Value), bound: String| Mistake {
        key: KeyPath::of(&["vary", key]).to_string(),
        value: value.to_string(),
        bound,
    };
    let mut tree = Tree::new(scenario);
    for draw in draws {
        let path = KeyPath::parse(&draw.0).ok_or_else(|| mistake(draw, "a dotted key of the scenario".into()))?;
        tree.put(&path, draw.1.clone())
            .map_err(|part| mistake(draw, format!("a key that the scenario has; it has no {part}")))?;
    }
    for (name, section) in tree.sections() {
        scenario
            .put_section(&name, section)
            .map_err(|error| mistake(&draws[0], format!("a key of the scenario, of its type: {error}")))?;
    }
    Ok(())
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::campaign::scenario::FlightScenario;
    use serde_json::json;

    fn scenario() -> Scenario {
        serde_json::from_value(json!({
            "hairpin": 1, "robot": { "kind": "quadrotor", "name": "test", "mass_kg": 1.0, "rotors": [] },
            "world": { "size_m": [30.0, 30.0, 30.0], "obstacles": [
                { "box": { "center_m": [12.0, 8.0, 5.0], "size_m": [2.0, 2.0, 10.0] } }] },
            "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [15.0, 15.0, 15.0], "length": 10 },
            "vary": {
                "world.wind_m_s": { "uniform": [[-3, -3, 0], [3, 3, 0]] },
                "world.obstacles[0].box.center_m": { "uniform": [[10, 6, 5], [14, 10, 5]] },
                "robot.mass_kg": { "normal": [1.0, 0.1], "min": 0.95, "max": 1.5 },
                "execute.controller": { "choice": ["stable-waypoint", "geometric"] },
                "task.length": { "uniform": [5, 8] },
            },
        }))
        .unwrap()
    }

    #[test]
    fn nominal_first_then_every_key_where_it_belongs() {
        let scenario = scenario();
        assert!(draw(&scenario, 7, 0).is_empty() && draw_for_case(&scenario, 7, CaseNumber(0)).is_empty());
        assert_eq!(apply(&scenario, &[]).unwrap(), {
            let mut constant = scenario.clone();
            constant.vary_mut().clear();
            constant
        });
        let keys: Vec<_> = draw(&scenario, 7, 1).into_iter().map(|(key, _)| key).collect();
        let per_run = ["execute.controller", "robot.mass_kg", "world.obstacles[0].box.center_m", "world.wind_m_s"];
        assert_eq!(keys, per_run);
        let of_case = draw_for_case(&scenario, 7, CaseNumber(3));
        assert_eq!(of_case[0].0, "task.length");
        // The plan is as it was drawn; what is drawn for its runs is the same as before.
        let settled = settle(&scenario, &[of_case.clone(), draw(&scenario, 7, 1)].concat()).unwrap();
        assert_eq!(
            (settled.length().map(Value::from), &settled.own::<FlightScenario>().unwrap().robot),
            (Some(of_case[0].1.clone()), &scenario.own::<FlightScenario>().unwrap().robot)
        );
        assert_eq!(
            (draw(&settled, 7, 1), draw_for_case(&settled, 7, CaseNumber(3))),
            (draw(&scenario, 7, 1), Vec::new())
        );
    }

    #[test]
    fn draws_lie_in_their_ranges_and_fill_them() {
        let scenario = scenario();
        let (mut lengths, mut masses, mut winds) = (Vec::new(), Vec::new(), Vec::new());
        for seed in 0..2000 {
            let planned = apply(&scenario, &draw_for_case(&scenario, seed, CaseNumber(1))).unwrap();
            lengths.push(planned.length().unwrap());
            let drawn = apply(&scenario, &draw(&scenario, seed, 1)).unwrap();
            let drawn = drawn.own::<FlightScenario>().unwrap();
            let crate::campaign::scenario::RobotSource::Inline(robot) = &drawn.robot else { panic!("robot lost") };
            masses.push(robot.mass_kg);
            winds.push(drawn.world.wind_m_s.unwrap());
            assert_eq!(drawn.world.obstacles[0].cuboid.unwrap().center_m[2], 5.0);
        }
        for length in 5..=8 {
            let share = lengths.iter().filter(|&&l| l == length).count() as f64 / 2000.0;
            assert!((share - 0.25).abs() < 0.05, "length {length}: {share}");
        }
        assert!(masses.iter().all(|m| (0.95..=1.5).contains(m)));
        // Truncated normal on [-σ/2, 5σ]: mean = μ + σ φ(-1/2)/(1 − Φ(-1/2)) = 1 + 0.1 · 0.35207/0.69146.
        let mean = masses.iter().sum::<f64>() / 2000.0;
        assert!((mean - 1.05092).abs() < 0.006, "{mean}");
        assert!(winds.iter().all(|w| w[0].abs() <= 3.0 && w[2] == 0.0));
        assert!(winds.iter().any(|w| w[0] > 2.9) && winds.iter().any(|w| w[0] < -2.9));
    }

    #[test]
    fn another_parameter_changes_no_draw() {
        let all = scenario();
        let mut few = scenario();
        few.vary_mut().retain(|key, _| key == "robot.mass_kg");
        let mass = |s: &Scenario| draw(s, 3, 2).into_iter().find(|(key, _)| key == "robot.mass_kg").unwrap();
        assert_eq!(mass(&all), mass(&few));
        assert_ne!(mass(&all), draw(&few, 3, 1)[0]);
        assert_ne!(mass(&all), draw(&few, 4, 2)[0]);
    }

    #[test]
    fn refuses_keys_and_types_that_are_not_the_scenarios() {
        let scenario = scenario();
        let refuse = |key: &str, value: Value| apply(&scenario, &[(key.into(), value)]).unwrap_err();
        assert!(refuse("robot.mas_kg", json!(1.0)).bound.contains("unknown field `mas_kg`"));
        assert_eq!(refuse("robot.mass_kg", json!("heavy")).key, "vary.\"robot.mass_kg\"");
        let bound = |key: &str, value: Value| refuse(key, value).bound;
        let beyond = "it has no `world.obstacles[4]`: `world.obstacles` has 1 element, counted from 0";
        assert!(bound("world.obstacles[4].name", json!("x")).contains(beyond));
        let none = "it has no `world.wind_m_s[0]`: there is no `world.wind_m_s` to take an element of";
        assert!(bound("world.wind_m_s[0]", json!(1.0)).contains(none));
        assert!(refuse("..", json!(1)).bound.contains("dotted key"));
    }
}
