//! The scenario keys of a family: those that can make more feasible, and which way they are turned; and what a run can
//! be freed of.
//!
//! [`explain`](crate::campaign::explain) turns one key at a time by bisection and asks the same graphs again: what
//! helps is found, not inferred.

use serde_json::Value;

use crate::campaign::Scenario;

/// One key.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::campaign) struct Knob {
    /// Dotted key.
    pub(in crate::campaign) key: &'static str,
    /// How it is turned.
    pub(in crate::campaign) turn: Turn,
}

/// How a key is turned.
///
/// From a key's value towards what can only make more feasible; the least turn that helps is told.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::campaign) enum Turn {
    /// From `now` as far as `loosest`, whichever is larger; `unit` for people.
    Number { now: f64, loosest: f64, unit: &'static str },
    /// A whole number, likewise.
    Whole { now: u64, loosest: u64 },
    /// A whole number both ways, `now` less or more, down to `least`.
    Either { now: u64, least: u64 },
    /// Another value, told in words.
    Switch { value: Value, words: String },
}

/// Something that a run meets beside its waypoints, and what the scenario is without it.
///
/// [`shrink`](crate::campaign::shrink) leaves them out one by one, to see what a violation takes.
pub(in crate::campaign) struct Condition {
    /// `no wind`.
    pub(in crate::campaign) words: &'static str,
    /// Leaves it out.
    pub(in crate::campaign) without: fn(&mut Scenario),
}

impl Condition {
    /// Where it is `met`, the words for a run without it, and how a scenario is freed of it.
    pub(in crate::campaign) fn of(met: bool, words: &'static str, without: fn(&mut Scenario)) -> Option<Self> {
        met.then_some(Self { words, without })
    }
}

/// What stands in a world, one beside the other.
///
/// Minimised by delta debugging over the places of the list.
pub(in crate::campaign) struct Standing {
    /// `obstacles`.
    pub(in crate::campaign) words: &'static str,
    /// Its key in scenarios.
    pub(in crate::campaign) key: &'static str,
    /// How many there are.
    pub(in crate::campaign) count: usize,
    /// Leaves only those at some places of the list.
    pub(in crate::campaign) keep: fn(&mut Scenario, &[usize]),
}

/// The keys of a scenario that jobs turn.
///
/// Everything that explain and shrink know of a kind beside its claim.
pub(in crate::campaign) struct Knobs {
    /// Those that can make more feasible, those first that are thought of first.
    pub(in crate::campaign) turned: Vec<Knob>,
    /// What a run meets and can be freed of, in the order in which that is tried.
    pub(in crate::campaign) conditions: Vec<Condition>,
    /// What stands in its way, if anything does.
    pub(in crate::campaign) standing: Option<Standing>,
    /// Keys that say how many graphs and cases there are …
    pub(in crate::campaign) counts: &'static [&'static str],
    /// … and how many of them one graph gives.
    pub(in crate::campaign) per_graph: &'static str,
    /// Keys that are as they are, whether or not they are given, where nothing is executed.
    pub(in crate::campaign) settled: Vec<(String, Value)>,
}

/// Farthest that a number is turned, in multiples of its value, where nothing else bounds it: who mistakes a unit is
/// off by as much.
/// A search to there by bisection of the logarithm takes few steps.
const FARTHEST: f64 = 1000.0;

impl Knob {
    /// Turned from `now` to `loosest`; none where it is there.
    ///
    /// `unit` is told behind the number: `m/s`.
    pub(in crate::campaign) fn number(key: &'static str, now: f64, loosest: f64, unit: &'static str) -> Option<Self> {
        (now != loosest).then_some(Self { key, turn: Turn::Number { now, loosest, unit } })
    }

    /// Turned up, without a bound of its own.
    ///
    /// None where `now` is 0: a thousand times nothing is nothing.
    pub(in crate::campaign) fn up(key: &'static str, now: f64, unit: &'static str) -> Option<Self> {
        Self::number(key, now, FARTHEST * now, unit)
    }

    /// Turned up as far as `most`, where it is below.
    ///
    /// An infinite `most` is as none at all: 1000 times `now`.
    pub(in crate::campaign) fn up_to(key: &'static str, now: f64, most: f64, unit: &'static str) -> Option<Self> {
        let loosest = if most.is_finite() { most } else { FARTHEST * now };
        (now < most).then_some(Self { key, turn: Turn::Number { now, loosest, unit } })
    }

    /// A whole number turned up to so many times itself.
    ///
    /// `times` at least, so that 0 can be turned up too.
    pub(in crate::campaign) fn whole(key: &'static str, now: u64, times: u64) -> Option<Self> {
        Some(Self { key, turn: Turn::Whole { now, loosest: now.saturating_mul(times).max(times) } })
    }

    /// A whole number turned both ways.
    pub(in crate::campaign) fn either(key: &'static str, now: u64, least: u64) -> Option<Self> {
        Some(Self { key, turn: Turn::Either { now, least } })
    }

    /// Another value.
    pub(in crate::campaign) fn switch(key: &'static str, value: Value, words: &str) -> Option<Self> {
        Some(Self { key, turn: Turn::Switch { value, words: words.into() } })
    }
}
