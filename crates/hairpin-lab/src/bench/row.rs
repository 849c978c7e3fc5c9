//! A row of the table of benches: what is measured, and what is promised of it.

use hairpin_jobs::Problem;

/// What is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchSettings {
    /// Only those benches whose name begins so.
    pub name: Option<String>,
    /// Length of the campaign whose memory is measured, min.
    pub minutes: f64,
}

/// Measures a row.
pub(super) type Measure = fn(&BenchSettings) -> Result<f64, Problem>;

/// What is measured, and what is promised: at least (rates) or at most (times, errors) so much.
pub(super) struct Row {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) target: Option<Target>,
    pub(super) measure: Measure,
}

/// Which side of the number is good.
#[derive(Clone, Copy)]
pub(super) enum Target {
    /// A rate.
    AtLeast(f64),
    /// A time, an error, a size.
    AtMost(f64),
}

impl Row {
    /// With a promise of at least `bound`.
    pub(super) fn at_least(name: &'static str, unit: &'static str, bound: f64, measure: Measure) -> Self {
        Self { name, unit, target: Some(Target::AtLeast(bound)), measure }
    }

    /// With a promise of at most `bound`.
    pub(super) fn at_most(name: &'static str, unit: &'static str, bound: f64, measure: Measure) -> Self {
        Self { name, unit, target: Some(Target::AtMost(bound)), measure }
    }

    /// Without a promise.
    pub(super) fn unbound(name: &'static str, unit: &'static str, measure: Measure) -> Self {
        Self { name, unit, target: None, measure }
    }
}

impl Target {
    pub(super) fn met(self, value: f64) -> bool {
        match self {
            Self::AtLeast(bound) => value >= bound,
            Self::AtMost(bound) => value <= bound,
        }
    }

    pub(super) fn words(self) -> String {
        match self {
            Self::AtLeast(bound) => format!("≥ {bound}"),
            Self::AtMost(bound) => format!("≤ {bound}"),
        }
    }
}
