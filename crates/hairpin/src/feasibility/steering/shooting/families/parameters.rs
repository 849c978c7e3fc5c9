//! A family's own parameters, as its textbook has them.
//!
//! For logs, files and other solvers: what is driven are the segments, and these numbers say which member of the family
//! they came from. Powers are of the plain argument (metres or seconds), not of its share.

use super::basis::{Basis, MOST, Row};
use super::clock::Clock;
use super::pieces::{monomials, quintic, scaled};
use crate::math::power::power;

/// What was solved for, in the family's own terms; SI.
///
/// What other software integrates again: commands that are fitted to it differ by
/// [`Answer::fit_error`](super::Answer::fit_error) at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Parameters {
    /// κ(s) = Σ aᵢ sⁱ over `length` metres.
    ArcLength {
        /// a₀ … a₅, 1/m^(i+1).
        curvature: [f64; 6],
        /// m.
        length: f64,
    },
    /// κ(t) = Σ cᵢ tⁱ over `duration` seconds.
    Time {
        /// c₀ … c₇, 1/(m sⁱ).
        curvature: [f64; MOST],
        /// s.
        duration: f64,
    },
    /// The natural cubic spline through these curvatures at even places of `length` metres.
    Knots {
        /// 1/m.
        curvature: [f64; MOST],
        /// m.
        length: f64,
    },
    /// v(t) = Σ vᵢ tⁱ and ω(t) = Σ ωᵢ tⁱ over `duration` seconds.
    Velocity {
        /// v₀ … v₂, m/s^(i+1).
        linear: [f64; 3],
        /// ω₀ … ω₉, rad/s^(i+1).
        angular: [f64; MOST + 2],
        /// s.
        duration: f64,
    },
}

impl Parameters {
    /// Those of the mirrored drive.
    ///
    /// Curvatures and angular velocities change their signs; lengths, times and v do not.
    pub(super) fn mirrored(mut self) -> Self {
        let turned: &mut [f64] = match &mut self {
            Self::ArcLength { curvature, .. } => curvature,
            Self::Time { curvature, .. } | Self::Knots { curvature, .. } => curvature,
            Self::Velocity { angular, .. } => angular,
        };
        turned.iter_mut().for_each(|value| *value = -*value);
        self
    }
}

/// The parameters of `basis` on `clock`, for a drive of `length` metres and `duration` seconds.
///
/// `row` in 1/m, of the family's own functions.
///
/// κ = ω/v, so that ω is the family's polynomial times the factors u and 1 − u that were divided out of v, times v's
/// scale: its mean speed is length/duration. Powers of a share become powers of seconds by 1/durationᵏ.
pub(super) fn named(basis: &Basis, clock: &Clock, row: &Row, length: f64, duration: f64) -> Parameters {
    match (basis, clock) {
        (Basis::Knots, _) => Parameters::Knots { curvature: *row, length },
        (Basis::Polynomial(order), Clock::Metres) => {
            Parameters::ArcLength { curvature: scaled(&quintic(*order, row), length), length }
        }
        (Basis::Polynomial(order), _) => {
            Parameters::Time { curvature: scaled(&monomials(*order, row), duration), duration }
        }
        (Basis::Ratio(order, _), clock) => {
            let Clock::Polynomial(speed) = clock else {
                return Parameters::ArcLength { curvature: [0.0; 6], length };
            };
            // Of the shape a + bu + cu² to v: its mean is length / duration.
            let unit = length / (duration * (speed[0] + speed[1] / 2.0 + speed[2] / 3.0));
            let linear = std::array::from_fn(|k| speed[k] * unit / power(duration, k));
            // ω = κ v: the polynomial times what was left out of the ratio.
            let [start, end] = clock.rests();
            let mut angular = [0.0; MOST + 2];
            angular[..MOST].copy_from_slice(&monomials(*order, row));
            if start {
                angular.copy_within(0..MOST + 1, 1);
                angular[0] = 0.0;
            }
            if end {
                for k in (1..MOST + 2).rev() {
                    angular[k] -= angular[k - 1];
                }
            }
            for (k, value) in angular.iter_mut().enumerate() {
                *value *= unit / power(duration, k);
            }
            Parameters::Velocity { linear, angular, duration }
        }
    }
}
