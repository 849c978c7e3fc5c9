//! Bounds of `[vary]`: every key exists, and the ends of its range make a scenario that can be run.

use serde_json::Value;

use crate::campaign::scenario::{Distribution, KeyPath, Mistake, Scenario, shapes_the_plan, zip};
use crate::campaign::vary::{Tree, apply, is_same};

/// Keys that say what the campaign is, not what happens in a case.
///
/// Each with why, which is told after the key. A key is compared whole; parts of it are refused only where
/// [`FIXED_WITHIN`] says so.
const FIXED: &[(&str, &str)] = &[
    ("hairpin", "it is the format of the whole file"),
    ("seed", "all draws come from it"),
    ("vary", "it says what varies"),
    ("robot", "its numbers may, such as \"robot.mass_kg\""),
    ("robot.kind", "it is a word, which no run reads"),
    ("robot.name", "it is a word, which no run reads"),
    ("robot.source", "it is a word, which no run reads"),
    ("robot.caveat", "it is a word, which no run reads"),
    ("robot.estimated", "it is a list of words, which no run reads"),
    ("world.base", "it is merged before anything is drawn"),
    ("world.origin", "it is where all cases lie on Earth"),
    ("generate.search.cases", "it is the number of cases"),
    ("generate.search.graphs", "it is a budget of the whole search"),
    ("generate.search.per_graph", "it is the number of cases of a graph"),
    ("execute.command", "one program flies all runs"),
    ("execute.logs", "it belongs to the whole campaign"),
    ("execute.log_clock", "it belongs to the whole campaign"),
    ("spec.regression", "it judges all cases together"),
    ("execute.repeat", "it is the number of runs"),
    ("execute.baseline", "it is the number of cases to compare with"),
    ("execute.record", "it belongs to the whole campaign"),
    ("execute.flaky", "it is how often violations are run again"),
    ("execute.timeout_s", "one program flies all runs"),
    ("execute.processes", "one program flies all runs"),
    ("execute.workers", "one program flies all runs"),
    ("spec", "its limits may, such as \"spec.deviation.max_m\""),
    ("spec.violation_share", "it judges all cases together"),
    ("spec.confidence", "it judges all cases together"),
    ("spec.limits.violation_share", "it judges all cases together"),
    ("spec.limits.confidence", "it judges all cases together"),
    ("world.frame", "it is the frame of the whole file"),
    ("world.terrain.file", "one map is read for all cases"),
    ("world.terrain.checksum", "one map is read for all cases"),
    ("world.terrain.epsg", "it is where all cases lie on Earth"),
];
/// Those of which nothing may that is within them.
const FIXED_WITHIN: [&str; 4] = ["vary", "world.origin", "execute.flaky", "robot.estimated"];
/// What anything is called, wherever it stands.
const NAME: &str = "name";
/// Each is tried before anything flies.
const MOST_CHOICES: usize = 1000;
/// Smallest share of draws that a truncation may keep.
///
/// Draws outside are drawn again: at a share of 1 % a hundred draws are made for one.
const LEAST_SHARE: f64 = 0.01;

/// All mistakes of `[vary]` in a scenario whose nominal values have none; `built` gives those of a scenario that was
/// drawn.
///
/// Each key is tried alone, the others nominal, and with another one that is drawn where only that is wrong then: two
/// that are fine by themselves may make a scenario that is not.
///
/// Costs two builds a key, or as many as it has choices.
///
/// Necessary, not sufficient: a bound that is broken between the ends of a range, or by two keys together, is found
/// when a run is drawn.
pub(in crate::campaign) fn check_vary(scenario: &Scenario, built: &dyn Fn(&Scenario) -> Vec<Mistake>) -> Vec<Mistake> {
    let mut nominal = Tree::new(scenario);
    let entries = scenario.vary().iter();
    let wrong: Vec<Mistake> =
        entries.filter_map(|entry| check_entry(scenario, &mut nominal, entry, built).err()).collect();
    if wrong.is_empty() { drawn_twice(scenario) } else { wrong }
}

/// Keys of which another is the whole, or the same in other letters.
///
/// Asked only where each key is right by itself. O(keys²).
fn drawn_twice(scenario: &Scenario) -> Vec<Mistake> {
    let paths: Vec<(&String, KeyPath)> =
        scenario.vary().keys().filter_map(|key| Some((key, KeyPath::parse(key)?))).collect();
    let whole_of = |(at, (key, path)): (usize, &(&String, KeyPath))| {
        let holds = |(other_at, (_, other)): &(usize, &(&String, KeyPath))| {
            let (part, whole) = (path.segments(), other.segments());
            *other_at != at && part.starts_with(whole) && (part.len() > whole.len() || *other_at < at)
        };
        let (_, (_, whole)) = paths.iter().enumerate().find(holds)?;
        let bound = format!("a key that is drawn once: `{whole}` is drawn too");
        Some(Mistake { key: KeyPath::of(&["vary", key]).to_string(), value: format!("\"{key}\""), bound })
    };
    paths.iter().enumerate().filter_map(whole_of).collect()
}

/// A scenario is built for both ends of the range or every choice, up to 1000.
///
/// Values are put into the scenario as a draw would put them; mistakes at the score's own key do not count for keys
/// that do not shape the plan.
fn check_entry(
    scenario: &Scenario,
    nominal: &mut Tree,
    (key, distribution): (&String, &Distribution),
    built: &dyn Fn(&Scenario) -> Vec<Mistake>,
) -> Result<(), Mistake> {
    let refuse =
        |value: String, bound: String| Err(Mistake { key: KeyPath::of(&["vary", key]).to_string(), value, bound });
    let Some(path) = KeyPath::parse(key) else {
        return refuse(format!("\"{key}\""), "a dotted key of the scenario, such as \"world.wind_m_s\"".into());
    };
    let whole_key = path.to_string();
    let is_within = |fixed: &str| {
        FIXED_WITHIN.contains(&fixed) && whole_key.strip_prefix(fixed).is_some_and(|rest| rest.starts_with(['.', '[']))
    };
    let fixed = FIXED.iter().find(|(fixed, _)| *fixed == whole_key || is_within(fixed)).map(|(_, why)| *why);
    let is_name = path.segments().last().is_some_and(|last| last == NAME);
    if let Some(why) = fixed.or(is_name.then_some("it is a word, which no run reads")) {
        return refuse(
            format!("\"{key}\""),
            format!("a key that may differ between cases or runs; this one may not: {why}"),
        );
    }
    let ends = match ends(distribution, nominal.get(&path)) {
        Ok(ends) => ends,
        Err((value, bound)) => return refuse(value, bound),
    };
    // What is drawn for a run is not what was searched: a model's legs are those of the nominal robot.
    let of_search = |mistake: &Mistake| !shapes_the_plan(key) && mistake.key.starts_with(scenario.score_key());
    let wrong = |draws: &[(String, Value)]| -> Result<Option<Mistake>, Mistake> {
        Ok(built(&apply(scenario, draws)?).into_iter().find(|mistake| !of_search(mistake)))
    };
    for end in ends {
        let own = (key.to_owned(), end.clone());
        let Some(first) = wrong(std::slice::from_ref(&own))? else { continue };
        // What is wrong beside it may be drawn too: the axis of a fault, which has none where there is no fault.
        let beside = scenario.vary().iter().find(|(other, _)| *other != key && is_same(other, &first.key));
        let others = beside.and_then(|(other, drawn)| {
            let others = self::ends(drawn, nominal.get(&KeyPath::parse(other)?)).ok()?;
            Some(others.into_iter().map(|value| (other.to_owned(), value)).collect::<Vec<_>>())
        });
        let mut is_fine = others.is_some();
        for other in others.into_iter().flatten() {
            is_fine &= wrong(&[own.clone(), other])?.is_none();
        }
        if !is_fine {
            return refuse(end.to_string(), format!("within bounds: {first}"));
        }
    }
    Ok(())
}

/// The values at the ends of the range, or every choice; what is wrong with the distribution as (value, bound).
///
/// Of a normal distribution the ends of its interval, where at least 1 % of the draws lie within the truncation.
///
/// Arrays are taken entry by entry, with the shape of the nominal value; whole numbers keep whole ends. A range is
/// rising, low = high allowed; a deviation of 0 is one value.
fn ends(distribution: &Distribution, nominal: Option<&Value>) -> Result<Vec<Value>, (String, String)> {
    let refuse = |value: String, bound: &str| Err((value, bound.to_owned()));
    match (&distribution.uniform, &distribution.normal, &distribution.choice) {
        (Some([low, high]), None, None) => {
            if distribution.min.is_some() || distribution.max.is_some() {
                return refuse(
                    "uniform with min or max".into(),
                    "without them: uniform has its ends; they cut `normal`",
                );
            }
            let (mut rising, mut whole_ends) = (true, true);
            let bounds = zip(low, high, nominal, &mut |low, high, whole| {
                rising &= low <= high;
                whole_ends &= !whole || (low.fract() == 0.0 && high.fract() == 0.0);
                low
            });
            let (Some(low), true) = (bounds, rising) else {
                return refuse(format!("[{low}, {high}]"), "[low, high]: numbers or arrays of one shape, low ≤ high");
            };
            if !whole_ends {
                return refuse(format!("[{low}, {high}]"), "between whole numbers: this key takes no others");
            }
            let high = zip(high, high, nominal, &mut |high, _, _| high);
            Ok(std::iter::once(low).chain(high).collect())
        }
        (None, Some([mean, deviation]), None) => {
            let (mut positive, mut share) = (true, 1.0_f64);
            let mut end = |high: bool| {
                zip(mean, deviation, nominal, &mut |mean, deviation, _| {
                    positive &= deviation >= 0.0;
                    share = share.min(share_kept(distribution, mean, deviation));
                    let interval = distribution.interval(mean, deviation);
                    if high { interval.1 } else { interval.0 }
                })
            };
            let (Some(low), Some(high)) = (end(false), end(true)) else {
                return refuse(format!("[{mean}, {deviation}]"), "[mean, deviation]: numbers or arrays of one shape");
            };
            if !positive {
                return refuse(format!("[{mean}, {deviation}]"), "[mean, deviation] with deviation ≥ 0");
            }
            if share < LEAST_SHARE {
                let kept = format!("min and max that keep {share:.1e} of all draws");
                return refuse(kept, "such that at least 1 % of the draws lie between them");
            }
            Ok(vec![low, high])
        }
        (None, None, Some(choice)) => {
            if distribution.min.is_some() || distribution.max.is_some() {
                return refuse("choice with min or max".into(), "without them: they cut `normal`");
            }
            if choice.is_empty() || choice.len() > MOST_CHOICES {
                return refuse(format!("{} values", choice.len()), "1 … 1000 values to choose from");
            }
            Ok(choice.clone())
        }
        _ => refuse("a distribution".into(), "exactly one of uniform, normal, choice"),
    }
}

/// The probability that a draw lies between `min` and `max`.
///
/// Φ((high − μ)/σ) − Φ((low − μ)/σ) with Φ(x) = erfc(−x/√2)/2; 1 or 0 where σ = 0.
///
/// Accurate to rounding, but in the far tails, where both terms are near 1 and their difference loses digits; so far
/// out it is refused anyway.
fn share_kept(distribution: &Distribution, mean: f64, deviation: f64) -> f64 {
    let (low, high) = distribution.interval(mean, deviation);
    if deviation <= 0.0 {
        return if low <= high { 1.0 } else { 0.0 };
    }
    let below = |x: f64| 0.5 * libm::erfc((mean - x) / (std::f64::consts::SQRT_2 * deviation));
    (below(high) - below(low)).max(0.0)
}
