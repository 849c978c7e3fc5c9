//! The smallest single change with which something is feasible: for every key the way to a value that helps, then back
//! by bisection.

use serde::Serialize;
use serde_json::{Value, json};

use crate::campaign::generate::{Known, generate};
use crate::campaign::kind::{Knob, Turn};
use crate::campaign::{OwnSimulator, Setup, Stop, Tally, vary};

/// A number is turned until what helps is known to this share of itself and of the change …
const PRECISION: f64 = 0.05;
/// … or its last step was halved so often.
const HALVINGS: usize = 16;
/// Whole numbers both ways are tried so far from where they are.
const STEPS: u64 = 6;

/// A single change with which something is feasible.
///
/// `to` is what was searched with: typed into the scenario it gives a trajectory in the same graphs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Change {
    /// The scenario's key.
    pub key: &'static str,
    /// Its value.
    pub from: Value,
    /// A value with which something is feasible, the nearest that was found.
    pub to: Value,
    /// As it is told: `length 12`, `max_speed 8.0 → 9.3 m/s`.
    pub words: String,
    /// How large the change is beside the value: |to − from| / from; of a switch 1.
    ///
    /// 1 as well where the value is 0 or no number.
    pub relative: f64,
}

/// Every key's smallest change that helps, the smallest first; switches and keys that are equally far in the order of
/// the list.
///
/// One key after the other, each by up to some dozen searches of the same graphs; a search ends at its first
/// trajectory.
pub(super) fn smallest(setup: &Setup, stop: &Stop) -> Vec<Change> {
    let knobs = setup.kind().knobs().turned;
    let change = |(tried, knob)| {
        (stop.progress)(tried, knobs.len());
        Trial { setup, stop, knob }.change()
    };
    let mut found: Vec<Change> = knobs.iter().enumerate().filter_map(change).collect();
    found.sort_by(|a, b| a.relative.total_cmp(&b.relative));
    found
}

/// One key being turned.
///
/// One search is up to as many graphs as were asked for, and ends with the first trajectory.
struct Trial<'a> {
    setup: &'a Setup,
    stop: &'a Stop<'a>,
    knob: &'a Knob,
}

impl Trial<'_> {
    /// `None` where no value up to the loosest helps, or the search was stopped.
    fn change(&self) -> Option<Change> {
        let (from, to) = match &self.knob.turn {
            Turn::Number { now, loosest, .. } => (json!(now), json!(self.number(*now, *loosest)?)),
            Turn::Whole { now, loosest } => (json!(now), json!(self.whole(*now, *loosest)?)),
            Turn::Either { now, least } => (json!(now), json!(self.either(*now, *least)?)),
            Turn::Switch { value, .. } => (Value::Null, self.helps(value).then(|| value.clone())?),
        };
        let relative = match (from.as_f64(), to.as_f64()) {
            (Some(from), Some(to)) if from != 0.0 => ((to - from) / from).abs(),
            _ => 1.0,
        };
        Some(Change { key: self.knob.key, words: self.words(&from, &to), from, to, relative })
    }

    /// The scenario with `value` at the key; none where no scenario may have it.
    fn with(&self, value: &Value) -> Option<Setup> {
        let draws = [(self.knob.key.to_owned(), value.clone())];
        self.setup.changed(vary::apply(&self.setup.scenario, &draws).ok()?).ok()
    }

    /// Whether something is feasible with `value` at the key.
    fn helps(&self, value: &Value) -> bool {
        if (self.stop.cancelled)() {
            return false;
        }
        let Some(changed) = self.with(value) else { return false };
        searched(&changed, false, self.stop).solved > 0
    }

    /// As far from `now` towards `loosest` as the key's own bounds let it be.
    fn bounded(&self, now: f64, loosest: f64) -> f64 {
        let may_be = |value: f64| self.with(&json!(rounded(now, value))).is_some();
        if may_be(loosest) {
            return loosest;
        }
        let (mut within, mut beyond) = (now, loosest);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (within + beyond);
            if may_be(middle) { within = middle } else { beyond = middle }
        }
        within
    }

    /// The value nearest to `now` that helps: steps that double on the way to `loosest`, then bisection of the last
    /// one.
    ///
    /// The first step is a tenth of the value, at most a quarter of the way. Bisection takes what helps to go on
    /// helping beyond; where it does not, the value found is one that helps, and no longer the nearest.
    fn number(&self, now: f64, loosest: f64) -> Option<f64> {
        let whole_way = self.bounded(now, loosest) - now;
        if whole_way == 0.0 {
            return None;
        }
        let mut share = (0.1 * now / whole_way).abs().clamp(1e-4, 0.25);
        let mut short = 0.0;
        while !self.helps(&json!(rounded(now, now + share * whole_way))) {
            if share >= 1.0 {
                return None;
            }
            (short, share) = (share, (2.0 * share).min(1.0));
        }
        for _ in 0..HALVINGS {
            let to = now + share * whole_way;
            if (share - short) * whole_way.abs() <= PRECISION * to.abs().min((to - now).abs()) {
                break;
            }
            let middle = 0.5 * (short + share);
            if self.helps(&json!(rounded(now, now + middle * whole_way))) { share = middle } else { short = middle }
        }
        (!(self.stop.cancelled)()).then(|| rounded(now, now + share * whole_way))
    }

    /// Upwards only: steps from a quarter of the number, doubled, then bisection to 2 % or 1.
    fn whole(&self, now: u64, loosest: u64) -> Option<u64> {
        let (mut short, mut step) = (now, 1.max(now / 4));
        let mut long = now + step;
        while !self.helps(&json!(long)) {
            if long >= loosest {
                return None;
            }
            step *= 2;
            (short, long) = (long, (now + step).min(loosest));
        }
        while long - short > 1.max(long / 50) {
            let middle = short + (long - short) / 2;
            if self.helps(&json!(middle)) { long = middle } else { short = middle }
        }
        (!(self.stop.cancelled)()).then_some(long)
    }

    /// Nearest first, more before less: what helps need not go on helping.
    fn either(&self, now: u64, least: u64) -> Option<u64> {
        (1..=STEPS)
            .flat_map(|step| [now + step, now.saturating_sub(step)])
            .find(|value| (least..=now + STEPS).contains(value) && self.helps(&json!(value)))
    }

    /// The key's name and both values with their unit, or the switch's own words.
    fn words(&self, from: &Value, to: &Value) -> String {
        let name = name(self.knob.key);
        match &self.knob.turn {
            Turn::Number { now, unit, .. } => {
                let to = to.as_f64().unwrap_or(*now);
                let least = if now.abs() >= 100.0 { 0 } else { 1 };
                format!("{name} {} → {} {unit}", whole_number(*now, least), whole_number(to, least))
                    .trim_end()
                    .to_owned()
            }
            Turn::Either { .. } => format!("{name} {to}"),
            Turn::Whole { .. } => format!("{name} {from} → {to}"),
            Turn::Switch { words, .. } => words.clone(),
        }
    }
}

/// `value` with all of its decimals, and at least so many: what is told is what was tried, and may be typed.
fn whole_number(value: f64, least: usize) -> String {
    let told = format!("{value}");
    let decimals = told.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    format!("{value:.*}", decimals.max(least))
}

/// `value` with three digits, away from `from`.
///
/// The change is never made smaller by it.
fn rounded(from: f64, value: f64) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let digits = 2 - libm::floor(libm::log10(value.abs())) as i32;
    let unit = crate::math::power::power(10.0, digits.unsigned_abs() as usize);
    let scaled = if digits >= 0 { value * unit } else { value / unit };
    let scaled = if value > from { scaled.ceil() } else { scaled.floor() };
    if digits >= 0 { scaled / unit } else { scaled * unit }
}

/// `max_speed` of `generate.limits.max_speed_m_s`: the last part of a key without its unit, and what a range's end or a
/// bound is called.
fn name(key: &str) -> String {
    let (key, end) = match key.split_once('[') {
        Some((key, "0]")) => (key, "least "),
        Some((key, _)) => (key, "greatest "),
        None => (key, ""),
    };
    let mut parts = key.rsplit('.');
    let last = parts.next().unwrap_or(key);
    // As `count` says nothing without what is counted.
    let last = if last == "count" { "points" } else { last };
    let units = ["_m_s", "_1_m2", "_1_m", "_mm", "_deg", "_s", "_m"];
    let bare = units.iter().find_map(|unit| last.strip_suffix(unit)).unwrap_or(last);
    // As little as `max` says without what is bounded.
    match (bare, parts.next()) {
        ("max", Some(bounded)) => format!("greatest {bounded}"),
        _ => format!("{end}{bare}"),
    }
}

/// What a search of `setup` finds: all of its graphs, or until the first trajectory.
///
/// The progress of a search to its end is told, that until the first trajectory to nobody.
///
/// Carried out by our own simulator, should the method execute.
pub(super) fn searched(setup: &Setup, all: bool, stop: &Stop) -> Tally {
    let found = std::sync::atomic::AtomicBool::new(false);
    let cancelled = || (stop.cancelled)() || (!all && found.load(std::sync::atomic::Ordering::Relaxed));
    let progress = |done, of| {
        if all {
            (stop.progress)(done, of)
        }
    };
    let first = Stop { cancelled: &cancelled, progress: &progress, clock: stop.clock };
    generate(setup, &Known::default(), &OwnSimulator, &first, &mut |cases, _| {
        if !cases.is_empty() {
            found.store(true, std::sync::atomic::Ordering::Relaxed);
        }
    })
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn keys_are_told_without_their_units() {
        for (key, told) in [
            ("generate.limits.max_speed_m_s", "max_speed"),
            ("task.length", "length"),
            ("spec.path.max_mm", "greatest path"),
            ("task.leg_m[1]", "greatest leg"),
            ("generate.timing.leg_time_s[1]", "greatest leg_time"),
            ("generate.limits.curvature_rate_1_m2", "curvature_rate"),
            ("task.points.count", "points"),
        ] {
            assert_eq!(name(key), told);
        }
    }

    #[test]
    fn what_is_told_is_what_was_tried() {
        for (value, least, told) in
            [(3.93, 1, "3.93"), (1.0, 1, "1.0"), (0.22, 1, "0.22"), (1240.0, 0, "1240"), (0.00123, 1, "0.00123")]
        {
            assert_eq!(whole_number(value, least), told);
        }
    }

    #[test]
    fn rounding_goes_on_the_way_that_the_key_is_turned() {
        assert_eq!(rounded(8.0, 9.2613), 9.27);
        assert_eq!(rounded(2.0, 0.12345), 0.123);
        assert_eq!(rounded(100.0, 1234.0), 1240.0);
        assert_eq!(rounded(1.0, 0.0), 0.0);
    }
}
