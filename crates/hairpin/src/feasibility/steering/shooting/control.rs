//! The controls by name: what the curvature, or the angular velocity, is a function of, and with which parameters.
//!
//! Curves are functions of one share u, of the metres or of the seconds, and linear in their parameters but for the
//! length. Which solver answers: `arc`, `cubic` and `quintic` the flat one where the direction of travel is constant,
//! `turn-drive-turn` its closed form, everything else the families' one shooting.

use super::flat;

/// A family of controls.
///
/// Parameters beyond the conditions ([`Control::parameters`] − [`Control::conditions`]) are free to keep bounds, lower
/// a cost or go around places.
///
/// | name | κ | parameters | conditions |
/// | --- | --- | --- | --- |
/// | `arc` | constant | 2 | 2 |
/// | `turn-drive-turn` | 0, and two angles | 3 | 3 |
/// | `cubic` | Σ aᵢ sⁱ, i ≤ 3 | 5 | 5 |
/// | `quintic` | Σ aᵢ sⁱ, i ≤ 5 | 7 | 5 |
/// | `time-polynomial` | Σ aᵢ tⁱ, i ≤ 5 | 7 | 5 |
/// | `knots` | natural cubic spline | 9 | 5 |
/// | `velocity-polynomial` | ω(t)/v(t) | 7 | 5 |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Control {
    /// Constant curvature: (κ, L). Heading and curvature at the end are as they come.
    Arc,
    /// Turn in place, drive straight, turn in place: (α, L, β).
    TurnDriveTurn,
    /// κ(s) of third order: four coefficients and L, as many as there are conditions.
    Cubic,
    /// κ(s) of fifth order: six coefficients and L; where none keeps the bounds, a chain of clothoids.
    #[default]
    Quintic,
    /// κ(t) of fifth order: six coefficients and the length that the speed profile makes a time of.
    TimePolynomial,
    /// The natural cubic spline κ(s) through eight even knots, and L.
    Knots,
    /// v(t) of second order, given by the speed profile, and ω(t): six coefficients beyond the common zeros of both,
    /// and L.
    VelocityPolynomial,
}

impl Control {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Arc,
        Self::TurnDriveTurn,
        Self::Cubic,
        Self::Quintic,
        Self::TimePolynomial,
        Self::Knots,
        Self::VelocityPolynomial,
    ];

    /// As it is written: `turn-drive-turn`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Arc => "arc",
            Self::TurnDriveTurn => "turn-drive-turn",
            Self::Cubic => "cubic",
            Self::Quintic => "quintic",
            Self::TimePolynomial => "time-polynomial",
            Self::Knots => "knots",
            Self::VelocityPolynomial => "velocity-polynomial",
        }
    }

    /// The control of this name.
    ///
    /// `None` for any other word.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|control| control.name() == name)
    }

    /// Numbers that a family's curves have, the length among them; of turn-drive-turn two angles and a length.
    ///
    /// One more than the degree of the curvature's function, and the length.
    ///
    /// Ends at rest add parameters of their own to velocity polynomials (one for each, against κ̇ = 0 there), which are
    /// not counted here, nor are the conditions that they meet.
    pub fn parameters(self) -> usize {
        match self {
            Self::Arc => 2,
            Self::TurnDriveTurn => 3,
            Self::Cubic => 5,
            Self::Quintic | Self::TimePolynomial | Self::VelocityPolynomial => 7,
            Self::Knots => 9,
        }
    }

    /// Conditions that they meet: the end's place, heading, and the curvature at both ends; of an arc the place alone.
    ///
    /// Of turn–drive–turn the place and the heading. A drive is generically there where parameters are no fewer than
    /// conditions; whether it keeps the bounds is another question.
    pub fn conditions(self) -> usize {
        match self {
            Self::Arc => 2,
            Self::TurnDriveTurn => 3,
            Self::Cubic | Self::Quintic | Self::TimePolynomial | Self::Knots | Self::VelocityPolynomial => 5,
        }
    }

    /// What the flat solver calls it, if it is one of its own.
    pub fn flat(self) -> Option<flat::Control> {
        match self {
            Self::Arc => Some(flat::Control::Arc),
            Self::Cubic => Some(flat::Control::Cubic),
            Self::Quintic => Some(flat::Control::Quintic),
            Self::TurnDriveTurn | Self::TimePolynomial | Self::Knots | Self::VelocityPolynomial => None,
        }
    }
}
