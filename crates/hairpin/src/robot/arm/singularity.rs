//! How far from losing a direction of motion an arm stands, and which one.

use std::fmt;

/// The singularities by name.
///
/// Near one, joint rates grow as the reciprocal of the margin for the same motion of the tool: a margin of 0.05 is
/// twenty times the rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Singularity {
    /// Axes 4 and 6 are in line: margin |sin θ5|.
    Wrist,
    /// The arm is stretched or folded: margin |sin| of the elbow's angle.
    Elbow,
    /// The wrist centre lies on axis 1: margin its distance from it over the arm's length.
    Shoulder,
    /// Of a chain without a closed form: margin 1/‖J⁻¹‖, lengths as shares of the reach.
    Chain,
}

impl fmt::Display for Singularity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Wrist => "wrist",
            Self::Elbow => "elbow",
            Self::Shoulder => "shoulder",
            Self::Chain => "chain",
        })
    }
}

/// The nearest singularity with its margin, a pure number; 0 is singular.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// Which.
    pub of: Singularity,
    /// How far.
    pub value: f64,
}

impl Margin {
    /// The least of several.
    ///
    /// A margin that is no number is passed over, and of none the margin is infinite: postures that are none are told
    /// by their bounds (`Arm::outside_limits`), not here.
    pub(super) fn least(margins: impl IntoIterator<Item = Self>) -> Self {
        let none = Self { of: Singularity::Chain, value: f64::INFINITY };
        margins.into_iter().fold(none, |least, margin| if margin.value < least.value { margin } else { least })
    }
}
