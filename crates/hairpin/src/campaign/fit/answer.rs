//! What a fit says: each number with its interval, and how far simulations are from the logs before and after.

use serde_json::Value;

use super::gap::Gap;
use crate::campaign::kind::Adjustable;

/// What the logs say of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reading {
    /// It, `estimated`.
    Told,
    /// Not identifiable: nothing that was flown depends on it.
    NoEffect,
    /// Not identifiable: an end of its interval is a bound, not where the logs contradict.
    Open,
    /// Not identifiable: the interval is wider than a quarter on either side.
    Wide,
    /// Not identifiable: simulations do not show what the logs do, whatever it is.
    Unlike,
    /// Not identifiable: such intervals are not believed, for the reason that the number has.
    Doubted,
}

/// A number after a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Which.
    pub number: Adjustable,
    /// Nearest to the logs with all numbers free; of one without effect, as given.
    pub best: f64,
    /// What is written: [`best`](Self::best) of one that is told, else as given.
    pub value: f64,
    /// 95 % profile interval; an end that is a bound is open.
    pub interval: Option<[f64; 2]>,
    /// Whether it can be told.
    pub reading: Reading,
}

impl Estimate {
    /// Whether the number is told.
    pub fn is_told(&self) -> bool {
        self.reading == Reading::Told
    }
}

/// What the logs say least about: a direction in which numbers move together and the logs hardly contradict.
#[derive(Debug, Clone, PartialEq)]
pub struct Confounded {
    /// Fields, and the relative change of each, of norm 1; the large ones alone.
    pub direction: Vec<(&'static str, f64)>,
    /// Standard deviation along it, relative.
    pub deviation: f64,
}

/// A fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Numbers, in their order.
    pub estimates: Vec<Estimate>,
    /// Told where some number is not identifiable by itself though something depends on it.
    pub confounded: Option<Confounded>,
    /// Log by log.
    pub gaps: Vec<Gap>,
    /// Root of the mean square of the residuals of the logs that were fitted to, m.
    /// Each log counts alike, however long.
    pub residual_m: f64,
    /// How far the places of these logs scatter from sample to sample, m, root of the mean square: what noise alone
    /// would leave. What is left beyond it is told by no interval: [`undescribed`](Self::undescribed). `None` of logs
    /// that are imitated, which have a bound of their own for it.
    pub scatter_m: Option<f64>,
    /// How much more a residual's sum scatters than if samples were independent: n over the effective number. Of logs
    /// that are imitated: how far their signs are off, over what chance makes them (D over its degrees of freedom).
    pub inflation: f64,
    /// Stretches, samples.
    /// The unit that independence is claimed of.
    pub stretches: usize,
    /// Compared samples.
    pub samples: usize,
    /// Root of the mean square over the logs that were not seen, before and after, m; `None` where none was.
    pub unseen: Option<[f64; 2]>,
    /// Keys of the scenario with what is told.
    pub keys: Vec<(String, f64)>,
    /// Keys of the robot that are written out, so that single numbers of them can be told.
    pub spelt: Vec<(String, Value)>,
    /// Whether what the robot leaves out is derived from its other numbers.
    pub derives: bool,
    /// Drawn robots, and who steered them, on which intervals were found to hold: of others it is not shown.
    pub tried: &'static str,
    /// Who steered these logs, where that is a controller that intervals were never tried with: whether they hold is
    /// not known then.
    pub untried: Option<&'static str>,
    /// What may be between the logs' scatter and what the fit leaves.
    pub undescribed: &'static str,
    /// Unit that gaps are told in, and so many of it in a metre.
    pub unit: (&'static str, f64),
}
