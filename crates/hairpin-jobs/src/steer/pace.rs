//! How fast a drive is driven and what that asks of the vehicle: accelerations, steering rates, wheels.

use hairpin::campaign::drive::{drive_piece, wheel_rims};
use hairpin::campaign::states::{Followed, States};
use hairpin::feasibility::steering::shooting::{Control, Curvatures, SPEED_PRECISION};
use hairpin::robot::rover::{Rims, Rover};
use hairpin::trajectory::drive::{Motion, Planar, Segment};
use hairpin::trajectory::{Direction, SpeedError, SpeedProfile, Timing};
use hairpin::verification::{DrivePiece, rim_breaches};
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

    /// How hard trapezoids change a speed of `speed` m/s at most, m/s²; infinite where nothing bounds it.
    fn slope(&self, rover: &Rover, speed: f64) -> f64 {
        self.most_acceleration(rover).min(rover.planned_acceleration(speed))
    }

    /// The speeds of a question: constant where one is given or both are the same; a ramp between two; a trapezoid
    /// with a cruising speed, and from rest to rest. Where the drive may stop on its way (`stops`) and the vehicle
    /// takes time for that, a constant speed is a trapezoid that rests there.
    pub(super) fn profile(&self, asked: &Asked, rover: &Rover, stops: bool) -> Result<SpeedProfile, SpeedError> {
        let (v0, vf) = (asked.v0.or(self.v0), asked.vf.or(self.vf));
        let usual = self.cruise.unwrap_or(rover.default_speed);
        let start = v0.or(vf.filter(|v| *v > 0.0)).unwrap_or(usual);
        let end = vf.or(v0.filter(|v| *v > 0.0)).unwrap_or(usual);
        let profile = if self.cruise.is_some() || start + end == 0.0 {
            let acceleration = self.slope(rover, usual);
            let acceleration = if acceleration.is_finite() { acceleration } else { usual / SPEED_UP };
            SpeedProfile::Trapezoid { start, cruise: usual, end, acceleration }
        } else if start == end {
            match self.slope(rover, start) {
                acceleration if stops && acceleration.is_finite() => {
                    SpeedProfile::Trapezoid { start, cruise: start, end, acceleration }
                }
                _ => SpeedProfile::Constant { speed: start },
            }
        } else {
            SpeedProfile::Ramp { start, end }
        };
        profile.checked()
    }

    /// `profile` as `segments` are driven by it: constant where nothing stops them, and from rest where they begin (or
    /// end) with a turn in place and no speed was asked for there.
    pub(super) fn settled(&self, asked: &Asked, profile: SpeedProfile, segments: &[Segment]) -> SpeedProfile {
        let SpeedProfile::Trapezoid { start, cruise, end, acceleration } = profile else { return profile };
        let turns =
            |segment: Option<&Segment>| segment.is_some_and(|segment| matches!(segment.motion, Motion::Turn { .. }));
        if self.cruise.is_none() && profile.is_constant() && Timing::new(&profile, segments).is_constant() {
            return cruise.into();
        }
        let free = asked.v0.or(self.v0).is_none() && asked.vf.or(self.vf).is_none();
        let rests = |segment, speed| if free && turns(segment) { 0.0 } else { speed };
        let (start, end) = (rests(segments.first(), start), rests(segments.last(), end));
        SpeedProfile::Trapezoid { start, cruise, end, acceleration }
    }

    /// What `rover` may bend at the speeds of a question; of two driven wheels what they leave at the highest one.
    ///
    /// Those at their limit would leave nothing to look for a drive with; what is found is held to them all the same.
    pub(super) fn bounds(&self, asked: &Asked, rover: &Rover, stops: bool) -> Curvatures {
        let limits = match (&rover.rims, self.profile(asked, rover, stops)) {
            (Some(rims), Ok(profile)) => {
                let top = profile.top().min(Rims::MOST_SHARE * rims.speed);
                let even = matches!(profile, SpeedProfile::Constant { .. });
                rover.limits_at(top, if even { 0.0 } else { rover.planned_acceleration(top) })
            }
            _ => rover.limits,
        };
        Curvatures { most: limits.curvature, most_rate: limits.curvature_rate }
    }

    /// The first limit of two driven wheels that `segments` break, and by how much.
    pub(super) fn rims_broken(
        &self,
        rover: &Rover,
        profile: &SpeedProfile,
        segments: &[Segment],
    ) -> Option<(&'static str, Option<f64>)> {
        let rims = wheel_rims(rover.rims.as_ref()?);
        let pieces: Vec<DrivePiece> = segments.iter().map(drive_piece).collect();
        let knots = Timing::new(profile, segments).knots();
        let breaches = rim_breaches(&pieces, &knots, turn_rate(rover, profile), &rims);
        let names = ["wheel_speed_m_s", "wheel_acceleration_m_s2"];
        let mut found = names.into_iter().zip(breaches);
        found.find_map(|(name, breach)| breach.map(|breach| (name, Some(breach.value - breach.bound))))
    }

    /// The first limit that the speeds break along `segments`, and by how much.
    pub(super) fn broken(
        &self,
        rover: &Rover,
        profile: &SpeedProfile,
        segments: &[Segment],
    ) -> Option<(&'static str, Option<f64>)> {
        let timing = Timing::new(profile, segments);
        if timing.is_constant() {
            return None;
        }
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
        let turn_rate = turn_rate(rover, &profile);
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

/// Rate of turns in place, rad/s: the outermost wheel goes no faster than the vehicle would ahead.
fn turn_rate(rover: &Rover, profile: &SpeedProfile) -> f64 {
    let (arm, aside) = (rover.suspension.outer_radius(), rover.rims.map_or(0.0, |rims| 0.5 * rims.track));
    profile.top() / if arm > 0.0 { arm } else { aside.max(1.0) }
}

/// The direction of travel that was asked for.
pub(super) fn direction(asked: &Asked) -> Direction {
    Direction { start: asked.direction, end: asked.direction_end.unwrap_or(asked.direction) }
}

/// The first bound of the wheels that the states exceed.
pub(super) fn wheels_broken(rover: &Rover, states: &States) -> Option<(&'static str, Option<f64>)> {
    states.peaks.broken(rover).map(|(name, excess)| (name, Some(excess)))
}
