//! What a leg must keep to, and the evidence when it does not.
//!
//! There is no trait for limits: one that is a function of a moment alone cannot be bounded between moments, so limits
//! are a fixed list, each with its enclosure (`steering::proof`) or its convex hull (`collision`).

use std::f64::consts::FRAC_PI_2;

/// Limits that a task adds to those of the robot and the world.
///
/// Tighter than the robot's own where they are given; the rotors' limits hold anyway.
///
/// Default: no cap of the speed, and tilts that only keep the singularity away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest speed, m/s; infinite: no cap.
    pub max_speed: f64,
    /// Largest angle between body z and world z, rad; π/2 and above: only the singularity is kept away from.
    pub max_tilt: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_speed: f64::INFINITY, max_tilt: FRAC_PI_2 }
    }
}

/// What can be violated; `margin` of [`Infeasible`] has the unit given here.
///
/// Signed margins: ≥ 0 is feasible. Names in reports are [`Limit::name_and_unit`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// The speed, m/s.
    Speed,
    /// Vertical thrust against free fall and body x vertical, where the attitude is undefined: share of the weight.
    Thrust,
    /// The tilt, rad.
    Tilt,
    /// The smallest rotor speed, rad/s; `part` is the rotor.
    RotorMin,
    /// The largest rotor speed, rad/s; `part` is the rotor.
    RotorMax,
    /// The keep-in margin of the world, m; `part` is the axis.
    World,
    /// The clearance to an obstacle, m; `part` is the obstacle.
    Obstacle,
    /// The duration of a leg or of a whole flight, s.
    Duration,
}

impl Limit {
    /// The name in reports, and the unit of its margin.
    pub fn name_and_unit(self) -> (&'static str, &'static str) {
        match self {
            Limit::Speed => ("speed", "m/s"),
            Limit::Thrust => ("vertical thrust", "of the weight"),
            Limit::Tilt => ("tilt", "rad"),
            Limit::RotorMin => ("smallest rotor speed", "rad/s"),
            Limit::RotorMax => ("largest rotor speed", "rad/s"),
            Limit::World => ("keep-in margin", "m"),
            Limit::Obstacle => ("obstacle clearance", "m"),
            Limit::Duration => ("duration", "s"),
        }
    }
}

/// Why a leg is refused.
///
/// `Violates` is a fact about the leg; `Unproven` is one about the effort: the leg may be feasible, and is refused.
///
/// 32 bytes and no allocation: legs are refused by the million, and names of parts are looked up where they are told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Infeasible {
    /// A limit is violated at `at`, s since the leg began, by `-margin` (signed margin < 0 in the limit's unit).
    Violates {
        /// Which limit.
        limit: Limit,
        /// Which of its parts.
        part: u16,
        /// When, s.
        at: f64,
        /// How far inside, < 0.
        margin: f64,
    },
    /// The bound between samples did not decide within its budget: at `at` the limit holds with `margin`, but so little
    /// that it could not be shown to hold beside it.
    Unproven {
        /// The limit that came nearest.
        limit: Limit,
        /// Which of its parts.
        part: u16,
        /// When, s.
        at: f64,
        /// Margin there, ≥ 0.
        margin: f64,
    },
}

impl Infeasible {
    /// The evidence for a limit with signed margin `margin` at `at`.
    ///
    /// A margin below 0 is a violation, any other (NaN among them) what could not be proven.
    pub(crate) fn at(limit: Limit, part: usize, at: f64, margin: f64) -> Self {
        let part = part as u16;
        if margin < 0.0 {
            Infeasible::Violates { limit, part, at, margin }
        } else {
            Infeasible::Unproven { limit, part, at, margin }
        }
    }

    /// The limit in question.
    pub fn limit(&self) -> Limit {
        match *self {
            Infeasible::Violates { limit, .. } | Infeasible::Unproven { limit, .. } => limit,
        }
    }
}

/// `largest rotor speed (part 2) violated by 31 rad/s at 0.412 s`.
impl std::fmt::Display for Infeasible {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (name, unit) = self.limit().name_and_unit();
        match *self {
            Infeasible::Violates { part, at, margin, .. } => {
                write!(f, "{name} (part {part}) violated by {:.4} {unit} at {at:.3} s", -margin)
            }
            Infeasible::Unproven { part, at, margin, .. } => {
                write!(f, "{name} (part {part}) within {margin:.2e} {unit} of its limit at {at:.3} s, not proven")
            }
        }
    }
}
