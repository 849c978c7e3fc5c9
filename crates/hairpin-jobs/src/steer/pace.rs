//! How fast a drive is driven and what that asks of the vehicle: accelerations, steering rates, wheels.

use hairpin::campaign::states::{Followed, States};
use hairpin::feasibility::steering::shooting::{Control, SPEED_PRECISION};
use hairpin::robot::rover::Rover;
use hairpin::trajectory::drive::{Motion, Planar, Segment};
use hairpin::trajectory::{Direction, SpeedError, SpeedProfile, Timing};
use hairpin_formats::steering::Asked;

/// How fast questions are answered to be driven, by which controls, and how closely their drives are followed.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    /// What curvature is a function of.
    pub control: Control,
    /// Speed at the start, m/s, where the question says none.
    pub v0: Option<f64>,
    /// Speed at the goal, m/s, where the question says none.
    pub vf: Option<f64>,
    /// Speed between, m/s: a trapezoid from v0 over this to vf.
    pub cruise: Option<f64>,
    /// Largest acceleration, m/s², where it is to be less than the vehicle's.
    pub acceleration: Option<f64>,
    /// Steps of a followed drive at most; they are longer where there would be more.
    pub most_steps: usize,
    /// Time between the states of a followed drive, s; a thousandth of the drive's, at least 0.001 s, if not given.
    pub time_step: Option<f64>,
    /// What speeds at both ends may differ by, m/s.
    pub speed_precision: f64,
}

/// Seconds in which vehicles without a limit come to their cruising speed.
const SPEED_UP: f64 = 1.0;
/// The time step that states are computed with, s, and how many rows are written where no time step is asked for.
const TIME_STEP: f64 = 0.001;
const ROWS: f64 = 1000.0;
/// States that bounds and summaries of a drive are taken from.
const FEW: f64 = 1000.0;
/// Share by which sampling may exceed a limit.
const ROUNDING: f64 = 1e-9;

impl Default for Pace {
    /// At the vehicle's own speed, by the usual control.
    fn default() -> Self {
        let (v0, vf, cruise, acceleration, time_step) = (None, None, None, None, None);
        Self {
            control: Control::default(),
            v0,
            vf,
            cruise,
            acceleration,
            most_steps: 10_000,
            time_step,
            speed_precision: SPEED_PRECISION,
        }
    }
}

impl Pace {
    /// Largest acceleration, m/s².
    fn most_acceleration(&self, rover: &Rover) -> f64 {
        self.acceleration.unwrap_or(f64::INFINITY).min(rover.limits.acceleration)
    }

    /// The speeds of a question: constant where one is given or both are the same; a ramp between two; a trapezoid with
    /// a cruising speed, and from rest to rest.
    pub(super) fn profile(&self, asked: &Asked, rover: &Rover) -> Result<SpeedProfile, SpeedError> {
        let (v0, vf) = (asked.v0.or(self.v0), asked.vf.or(self.vf));
        let usual = self.cruise.unwrap_or(rover.default_speed);
        let start = v0.or(vf.filter(|v| *v > 0.0)).unwrap_or(usual);
        let end = vf.or(v0.filter(|v| *v > 0.0)).unwrap_or(usual);
        let profile = if self.cruise.is_some() || start + end == 0.0 {
            let acceleration = self.most_acceleration(rover);
            let acceleration = if acceleration.is_finite() { acceleration } else { usual / SPEED_UP };
            SpeedProfile::Trapezoid { start, cruise: usual, end, acceleration }
        } else if start == end {
            SpeedProfile::Constant { speed: start }
        } else {
            SpeedProfile::Ramp { start, end }
        };
        profile.checked()
    }

    /// The first limit that the speeds break along `segments`, and by how much.
    pub(super) fn broken(
        &self,
        rover: &Rover,
        profile: &SpeedProfile,
        segments: &[Segment],
    ) -> Option<(&'static str, Option<f64>)> {
        if profile.is_constant() {
            return None;
        }
        let timing = Timing::new(profile, segments);
        let over = timing.hardest() - self.most_acceleration(rover);
        if over > ROUNDING * timing.hardest() {
            return Some(("acceleration", over.is_finite().then_some(over)));
        }
        let ends = [
            ("start_speed_m_s", timing.speed_at(0.0) - profile.start()),
            ("end_speed_m_s", timing.end_speed() - profile.end()),
        ];
        let missed = ends.into_iter().find(|(_, miss)| miss.abs() > self.speed_precision);
        missed.map(|(name, miss)| (name, Some(miss.abs() - self.speed_precision)))
    }

    /// By how much the steered axle is asked to turn faster than it can, rad/s: δ̇ = axle κ′ v / (1 + (κ axle)²).
    pub(super) fn steering_excess(&self, rover: &Rover, profile: &SpeedProfile, segments: &[Segment]) -> Option<f64> {
        let most = rover.response.steering_rate;
        if most.is_infinite() {
            return None;
        }
        let (timing, axle) = (Timing::new(profile, segments), rover.response.steered_axle);
        let mut worst = 0.0_f64;
        let mut driven = 0.0;
        for segment in segments {
            let Motion::Arc { length_m, curvature } = segment.motion else { continue };
            for i in 0..=200 {
                let s = length_m * f64::from(i) / 200.0;
                let slope = (1..6).rev().fold(0.0, |sum, k| sum * s + k as f64 * curvature[k]);
                let bent = segment.curvature_at(s) * axle;
                worst = worst.max((axle * slope * timing.speed_at(driven + s) / (1.0 + bent * bent)).abs());
            }
            driven += length_m;
        }
        (worst > most * (1.0 + 1e-6)).then_some(worst - most)
    }

    /// How states are followed: every `time_step` seconds, or as asked for output.
    pub(super) fn followed<'a>(
        &self,
        rover: &'a Rover,
        profile: SpeedProfile,
        direction: Direction,
        segments: &[Segment],
        rows: Rows,
    ) -> Followed<'a> {
        // In place the outermost wheel goes as fast as the vehicle would ahead.
        let arm = rover.suspension.outer_radius();
        let turn_rate = profile.top() / if arm > 0.0 { arm } else { 1.0 };
        let driving = Timing::new(&profile, segments);
        let turns: f64 = segments.iter().map(|segment| segment.turn_rad().abs()).sum();
        let duration = driving.time_at(driving.length()) + turns / turn_rate;
        let time_step = match (rows, self.time_step) {
            (Rows::Few, _) => duration / FEW,
            (Rows::AsAsked, Some(step)) => step,
            (Rows::AsAsked, None) => duration / ROWS,
        };
        let (time_step, most_steps) =
            (time_step.max(TIME_STEP.min(self.time_step.unwrap_or(TIME_STEP))), self.most_steps);
        Followed { rover, speed: profile, turn_rate, direction, time_step, most_steps }
    }
}

/// How many states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rows {
    /// As many as bounds and summaries need.
    Few,
    /// As many as [`Pace`] asks for.
    AsAsked,
}

/// Where a drive starts in the map: its origin if nothing is said.
pub(super) fn start(asked: &Asked) -> Planar {
    let [x, y, yaw] = asked.start.unwrap_or([0.0; 3]);
    Planar { x, y, yaw, curvature: asked.k0 }
}

/// The direction of travel that was asked for.
pub(super) fn direction(asked: &Asked) -> Direction {
    Direction { start: asked.direction, end: asked.direction_end.unwrap_or(asked.direction) }
}

/// The first bound of the wheels that the states exceed.
pub(super) fn wheels_broken(rover: &Rover, states: &States) -> Option<(&'static str, Option<f64>)> {
    states.peaks.broken(rover).map(|(name, excess)| (name, Some(excess)))
}
