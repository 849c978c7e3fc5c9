//! The unit of a verdict's lengths, so that all of a report has one.

use crate::campaign::Setup;
use crate::judgement::Violation;

/// The unit that lengths of a verdict are told in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Length {
    /// `m`, or `mm` of arms.
    pub unit: &'static str,
    /// How many of it a metre has.
    pub in_metre: f64,
}

/// What lengths are told in of the robot of `setup`.
///
/// Asked of the kind itself, by what it makes of a deviation of 1 m.
pub fn length(setup: &Setup) -> Length {
    let metre = Violation { what: "deviation".into(), value: 1.0, limit: 1.0, unit: "m".into(), at: 0.0, leg: 0 };
    match setup.kind().programs().map(|programs| programs.in_their_units(metre)) {
        Some(told) if told.unit == "mm" => Length { unit: "mm", in_metre: told.value },
        _ => Length { unit: "m", in_metre: 1.0 },
    }
}
