//! How a verdict tells its lengths, so that all of a report has one unit and one number of digits.

use crate::campaign::Setup;
use crate::judgement::{Violation, told};

/// The unit that lengths of a verdict are told in, and the limit that gives them their digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Length {
    /// `m`, or `mm` of arms.
    pub unit: &'static str,
    /// How many of it a metre has.
    pub in_metre: f64,
    /// The limit of the deviation, in [`Self::unit`].
    pub limit: Option<f64>,
}

impl Length {
    /// `metres` as a number of [`Self::unit`], with the digits of [`Self::limit`]: `0.018`.
    pub fn number(&self, metres: f64) -> String {
        told(self.in_metre * metres, self.limit, self.unit)
    }

    /// The same with the unit: `0.018 m`.
    pub fn told(&self, metres: f64) -> String {
        format!("{} {}", self.number(metres), self.unit)
    }

    /// The limit beside `metres`, with its unit and as many digits as show on which side of it they are; `None` where
    /// there is none.
    pub fn limit_beside(&self, metres: f64) -> Option<String> {
        let value = self.in_metre * metres;
        let what = "deviation".into();
        let beside = Violation { what, value, limit: self.limit?, unit: self.unit.into(), at: 0.0, leg: 0 };
        Some(beside.printed().1)
    }
}

/// What lengths are told in of the robot of `setup`.
///
/// Asked of the kind itself, by what it makes of a deviation of 1 m.
pub fn length(setup: &Setup) -> Length {
    let metre = Violation { what: "deviation".into(), value: 1.0, limit: 1.0, unit: "m".into(), at: 0.0, leg: 0 };
    let (unit, in_metre) = match setup.kind().programs().map(|programs| programs.in_their_units(metre)) {
        Some(told) if told.unit == "mm" => ("mm", told.value),
        _ => ("m", 1.0),
    };
    Length { unit, in_metre, limit: setup.scenario.deviation_limit().map(|metres| in_metre * metres) }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn a_limit_shows_on_which_side_a_length_is() {
        let metres = |limit| Length { unit: "m", in_metre: 1.0, limit: Some(limit) };
        let told = |limit: f64, value: f64| (metres(limit).told(value), metres(limit).limit_beside(value).unwrap());
        assert_eq!(told(2.28765, 2.2876503), ("2.2876503 m".into(), "2.2876500 m".into()));
        assert_eq!(told(0.125, 1.5), ("1.500 m".into(), "0.125 m".into()));
        assert_eq!(Length { limit: None, ..metres(1.0) }.limit_beside(1.0), None);
        let arm = Length { unit: "mm", in_metre: 1e3, limit: Some(15.0) };
        assert_eq!((arm.told(0.015_001), arm.limit_beside(0.015_001)), ("15.001 mm".into(), Some("15.000 mm".into())));
    }
}
