//! How drives are looked for, and how long.

use std::f64::consts::TAU;

use hairpin::feasibility::steering::shooting::rough;
use hairpin::feasibility::steering::shooting::solve::Choices;
use hairpin::feasibility::steering::shooting::{Control, Precision, flat};
use hairpin::trajectory::Direction;

use crate::refusal::{HAIRPIN_INVALID, Refused};

/// How drives are looked for. hairpin_steer_defaults and hairpin_steer_fixed_budget fill it in.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SteerSettings {
    /// Distance from the goal that counts as there, m, > 0.
    pub tolerance_m: f64,
    /// The same of the heading, rad, > 0.
    pub tolerance_yaw_rad: f64,
    /// The same of the curvature, 1/m, > 0.
    pub tolerance_curvature_1_m: f64,
    /// Speed along the drive, m/s; 0: the vehicle's own. It matters where commands act late.
    pub speed_m_s: f64,
    /// Not 0: the gear may change on the way.
    pub reversals: i32,
    /// Not 0: the vehicle may turn in place.
    pub turns: i32,
    /// Steps of each descent in the plane at most.
    pub iterations: u32,
    /// Steps of all descents for one goal in the plane at most; 0: no bound.
    pub most_steps: u32,
    /// Predictions for goals in the plane that are learned on a map, at most.
    pub predictions: u32,
    /// Looks at a map at most, of which a settled pose takes some dozen; 0: no bound.
    pub most_looks: u64,
    /// What curvature is a function of, one of HAIRPIN_CONTROL_...; the budgets are the usual one's.
    pub control: i32,
    /// Direction of travel in the body where the drive begins, rad, left positive: not 0, it crabs.
    pub direction_rad: f64,
    /// By how much that changes until the drive ends, rad, left positive.
    pub swing_rad: f64,
}

/// Of fifth order in the way: the usual one, with chains of clothoids where it keeps no bound.
pub const HAIRPIN_CONTROL_QUINTIC: i32 = 0;
/// Constant: heading and curvature at the goal are as they come.
pub const HAIRPIN_CONTROL_ARC: i32 = 1;
/// Of third order in the way.
pub const HAIRPIN_CONTROL_CUBIC: i32 = 2;
/// A turn in place, a straight, a turn in place.
pub const HAIRPIN_CONTROL_TURN_DRIVE_TURN: i32 = 3;
/// Of fifth order in time.
pub const HAIRPIN_CONTROL_TIME_POLYNOMIAL: i32 = 4;
/// The natural cubic spline through eight even knots of the way.
pub const HAIRPIN_CONTROL_KNOTS: i32 = 5;
/// Turn rate over speed, both polynomials of time.
pub const HAIRPIN_CONTROL_VELOCITY_POLYNOMIAL: i32 = 6;

/// Controls by their numbers.
const CONTROLS: [Control; 7] = [
    Control::Quintic,
    Control::Arc,
    Control::Cubic,
    Control::TurnDriveTurn,
    Control::TimePolynomial,
    Control::Knots,
    Control::VelocityPolynomial,
];

/// Steps for one goal of the fixed budget.
pub const HAIRPIN_FIXED_STEPS: u32 = 60;
/// Looks at a map of the fixed budget.
pub const HAIRPIN_FIXED_LOOKS: u64 = 100_000;

/// What the command `hairpin steer` looks with: 0.01 m, rad and 1/m; forward arcs; as long as it takes.
#[unsafe(no_mangle)]
pub extern "C" fn hairpin_steer_defaults() -> SteerSettings {
    let (flat, ground, precision) = (flat::Settings::default(), rough::Settings::default(), Precision::default());
    SteerSettings {
        tolerance_m: precision.position,
        tolerance_yaw_rad: precision.yaw,
        tolerance_curvature_1_m: precision.curvature,
        speed_m_s: 0.0,
        reversals: 0,
        turns: 0,
        iterations: flat.iterations,
        most_steps: 0,
        predictions: ground.iterations,
        most_looks: 0,
        control: HAIRPIN_CONTROL_QUINTIC,
        direction_rad: 0.0,
        swing_rad: 0.0,
    }
}

/// The same with a bound on the work of a call, in counts, which are the same on every machine: docs/c.md has what it
/// costs in time, and how many goals it loses.
#[unsafe(no_mangle)]
pub extern "C" fn hairpin_steer_fixed_budget() -> SteerSettings {
    let (most_steps, most_looks) = (HAIRPIN_FIXED_STEPS, HAIRPIN_FIXED_LOOKS);
    SteerSettings { most_steps, most_looks, ..hairpin_steer_defaults() }
}

/// The largest of a tolerance: more is no answer to where the goal is.
const MOST_TOLERANCE: f64 = 1e3;

impl SteerSettings {
    /// Checks every number.
    pub(crate) fn check(&self) -> Result<(), Refused> {
        let tolerances = [
            ("tolerance_m", self.tolerance_m),
            ("tolerance_yaw_rad", self.tolerance_yaw_rad),
            ("tolerance_curvature_1_m", self.tolerance_curvature_1_m),
        ];
        for (field, value) in tolerances {
            if !(value > 0.0 && value <= MOST_TOLERANCE) {
                let sentence = format_args!("`{field}` = {value}: must be > 0 and at most {MOST_TOLERANCE}");
                return Err(Refused::new(HAIRPIN_INVALID, sentence));
            }
        }
        for (field, value) in [("direction_rad", self.direction_rad), ("swing_rad", self.swing_rad)] {
            if value.is_nan() || value.abs() > TAU {
                return Err(Refused::new(HAIRPIN_INVALID, format_args!("`{field}` = {value}: must be within a turn")));
            }
        }
        if !(self.speed_m_s >= 0.0 && self.speed_m_s.is_finite()) {
            let sentence = format_args!("`speed_m_s` = {}: must be finite and >= 0", self.speed_m_s);
            return Err(Refused::new(HAIRPIN_INVALID, sentence));
        }
        Ok(())
    }

    pub(crate) fn control(&self) -> Result<Control, Refused> {
        let found = usize::try_from(self.control).ok().and_then(|number| CONTROLS.get(number)).copied();
        let sentence = format_args!("`control` = {}: must be one of HAIRPIN_CONTROL_..., 0 to 6", self.control);
        found.ok_or_else(|| Refused::new(HAIRPIN_INVALID, sentence))
    }

    /// Direction of travel in the body.
    pub(crate) fn direction(&self) -> Direction {
        Direction { start: self.direction_rad, end: self.direction_rad + self.swing_rad }
    }

    pub(crate) fn precision(&self) -> Precision {
        let Self { tolerance_m, tolerance_yaw_rad, tolerance_curvature_1_m, .. } = *self;
        Precision { position: tolerance_m, yaw: tolerance_yaw_rad, curvature: tolerance_curvature_1_m }
    }

    /// In the plane, to `precision`.
    pub(crate) fn choices(&self, precision: Precision) -> Choices<'static> {
        let most_steps = if self.most_steps == 0 { u32::MAX } else { self.most_steps };
        let flat = flat::Settings { precision, iterations: self.iterations, most_steps, ..flat::Settings::default() };
        Choices { reversals: self.reversals != 0, turns: self.turns != 0, flat, ..Choices::default() }
    }

    /// On a map.
    pub(crate) fn ground(&self) -> rough::Settings {
        rough::Settings { iterations: self.predictions, precision: self.precision(), ..rough::Settings::default() }
    }
}
