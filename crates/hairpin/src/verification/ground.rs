//! Replay of a drive on the ground: what was written, integrated again with suspension, slip and lag.

use nalgebra::Vector3;

use super::drive::DrivePiece;
use super::stand::{NoRest, Rest, Stand, turn};
use super::twist::{Place, carry};
use crate::world::terrain::{NoGround, Terrain};

/// The vehicle, as plain numbers.
///
/// Units in the names, as in files: what is compared here is a file with a file.
///
/// Slip: progress = ±1 − s₁ sin(rise along)/sin 20°, drift = −s₂ sin(rise across)/sin 20°, shares of the commanded
/// speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundVehicle {
    /// How it stands.
    pub stand: Stand,
    /// Share of the speed lost climbing 20°.
    pub slip_at_20_deg: f64,
    /// Drift downhill across a slope of 20°, as a share of the speed.
    pub side_slip_at_20_deg: f64,
    /// Delay of every command, s.
    pub latency_s: f64,
    /// First-order lag of the steering, s; 0: none.
    pub steering_time_constant_s: f64,
    /// Largest rate of the steering angle, rad/s.
    pub steering_rate_rad_s: f64,
    /// κ = tan δ / it, m.
    pub steered_axle_m: f64,
    /// Whether the body moves as a rigid one that keeps its wheels on the ground; else vz, ωx and ωy are left out.
    pub exact: bool,
    /// What the wheels carry and overcome, where torques are asked for.
    pub haul: Option<Haul>,
}

#[cfg(test)]
impl GroundVehicle {
    /// It stands level, does all at once and never slips.
    pub(super) const LEVEL: Self = Self {
        stand: Stand::Level,
        slip_at_20_deg: 0.0,
        side_slip_at_20_deg: 0.0,
        latency_s: 0.0,
        steering_time_constant_s: 0.0,
        steering_rate_rad_s: f64::INFINITY,
        steered_axle_m: 1.0,
        exact: false,
        haul: None,
    };
}

/// What wheels carry and overcome, sharing it evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Haul {
    /// With the load, kg.
    pub mass_kg: f64,
    /// m/s².
    pub gravity_m_s2: f64,
    /// Share of the load that rolling takes.
    pub rolling_resistance: f64,
    /// Driven wheels.
    pub wheels: usize,
    /// Of each, m.
    pub radius_m: f64,
}

/// What a drive on the ground was asked to do; world frame.
///
/// κ and pieces are in the body's plane, poses in the world; z, roll and pitch are the ground's.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundClaim {
    /// x, y (m), ψ (rad) of the start.
    pub start: [f64; 3],
    /// κ at the start, 1/m.
    pub start_curvature: f64,
    /// Direction of travel in the body where the drive begins, rad.
    pub crab: f64,
    /// Its change along the drive, rad/m.
    pub crab_rate: f64,
    /// Metres of the drive, rising from 0, with the commanded speed there, m/s; v² is linear between, and as at the
    /// ends beyond.
    pub speed: Vec<[f64; 2]>,
    /// x, y (m), ψ (rad) to end in.
    pub end: [f64; 3],
    /// κ to end with, 1/m.
    pub end_curvature: f64,
}

/// What the drive does on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundReplay {
    /// Where it ends less where it should, in the world: x, y (m), yaw (rad, in (−π, π]).
    pub error: [f64; 3],
    /// Curvature of the steering at the end less what it should be, 1/m.
    pub error_curvature: f64,
    /// Largest angle of the body's z axis from the vertical, rad.
    ///
    /// acos(cos φ cos θ).
    pub max_tilt: f64,
    /// Largest |torque| of each wheel while driving, N·m; 0 without a haul.
    pub max_torque: f64,
    /// Steps of the integrator.
    pub steps: usize,
}

/// Why a drive cannot be replayed to its end, and after how many metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stopped {
    /// Metres driven before.
    pub after_m: f64,
    /// The place without ground; `None` where the body finds no rest.
    pub no_ground: Option<NoGround>,
}

/// Steps of a replay at least.
const LEAST_STEPS: usize = 2000;
/// sin 20°.
const SIN_20: f64 = 0.342_020_143_325_668_7;
/// Longest step of a turn in place, rad.
const TURN_STEP: f64 = 0.005;

/// Integrates ẋ, ẏ, ψ̇ and the steering angle by the midpoint rule, 2000 steps or more, the body at rest on
/// its wheels at each; an exact vehicle is carried from rest to rest by the twist between them. With latency τ the
/// vehicle first goes on for τ as it was, and the last τ of the commands never act; before a drive that begins in
/// reverse or in place it stands, and all of them act. Where the speed is none and the direction changes, or after a
/// turn in place, the wheels swing to what comes.
///
/// ẋ, ẏ, ψ̇ are Howard and Kelly's (IJRR 26(2), 2007) of the commanded twist after slip; with `exact` they are not
/// rates at all, but the rest whose screw from the last one has that twist.
///
/// Without `exact`, with body rates (vx, vy, ωz) per metre commanded, roll φ and pitch θ of the rest there:
///
/// ```text
/// ẋ = cos ψ (cos θ vx + sin θ sin φ vy) − sin ψ cos φ vy
/// ẏ = sin ψ (cos θ vx + sin θ sin φ vy) + cos ψ cos φ vy
/// ψ̇ = cos φ / cos θ · ωz,          δ̇ = clamp((atan(κ L) − δ)/T, ±δ̇_max)
/// ```
///
/// # Errors
/// [`Stopped`] where the ground ends or the body finds no rest.
pub fn replay_ground<T: Terrain>(
    pieces: &[DrivePiece],
    vehicle: &GroundVehicle,
    terrain: &T,
    claim: &GroundClaim,
) -> Result<GroundReplay, Stopped> {
    follow_ground(pieces, vehicle, terrain, claim, |_| {})
}

/// [`replay_ground`]; `pass` is shown x, y (m) and ψ (rad) after each step.
///
/// With `exact` once for each step's end; else after each midpoint step.
///
/// # Errors
/// As [`replay_ground`].
pub(super) fn follow_ground<T: Terrain>(
    pieces: &[DrivePiece],
    vehicle: &GroundVehicle,
    terrain: &T,
    claim: &GroundClaim,
    mut pass: impl FnMut([f64; 3]),
) -> Result<GroundReplay, Stopped> {
    let under_way = matches!(pieces.first(), Some(DrivePiece::Arc { direction, .. }) if *direction > 0.0);
    let [wait, held] = if under_way { claim.metres_of(vehicle.latency_s) } else { [0.0; 2] };
    let mut commands = Vec::with_capacity(pieces.len() + 1);
    if wait > 0.0 {
        let mut curvature = [0.0; 6];
        curvature[0] = claim.start_curvature;
        commands.push(DrivePiece::Arc { length_m: wait, curvature, direction: 1.0 });
    }
    commands.extend_from_slice(pieces);
    let written: f64 = pieces.iter().map(DrivePiece::length).sum();
    // The drive without what is only held while its last commands come to act; driven is that and the wait.
    let drive = (written - held).max(0.0);
    let total = wait + drive;
    let stopped = |after_m: f64, no_rest: NoRest| Stopped {
        after_m,
        no_ground: match no_rest {
            NoRest::Ground(place) => Some(place),
            NoRest::NotFound => None,
        },
    };
    let mut state =
        [claim.start[0], claim.start[1], claim.start[2], libm::atan(claim.start_curvature * vehicle.steered_axle_m)];
    let mut rest = Rest::find(&vehicle.stand, terrain, claim.start).map_err(|no| stopped(0.0, no))?;
    let mut max_torque = 0.0_f64;
    let (mut driven, mut max_tilt, mut steps, mut last_curvature) = (0.0, 0.0_f64, 0, claim.start_curvature);
    // The direction of the piece before; a turn in place leaves none.
    let mut last: Option<Option<f64>> = None;
    for piece in &commands {
        let own = match piece {
            DrivePiece::Arc { direction, .. } => Some(*direction),
            DrivePiece::Turn { .. } => None,
        };
        if let DrivePiece::Arc { curvature, .. } = piece
            && last.is_some_and(|last| last != own)
            && claim.stands_at(driven - wait)
        {
            state[3] = libm::atan(curvature[0] * vehicle.steered_axle_m);
        }
        last = Some(own);
        let (length, count) = match piece {
            DrivePiece::Arc { length_m, .. } => {
                // What would act after the end is not driven.
                let length = length_m.min((total - driven).max(0.0));
                (length, (LEAST_STEPS as f64 * length / total.max(f64::MIN_POSITIVE)).ceil().max(16.0) as usize)
            }
            DrivePiece::Turn { angle_rad } => (*angle_rad, (angle_rad.abs() / TURN_STEP).ceil().max(16.0) as usize),
        };
        let h = length / count as f64;
        let metres = if own.is_some() { 1.0 } else { 0.0 };
        for i in 0..count {
            let begun = length * i as f64 / count as f64;
            let stopped = |no| stopped(driven + metres * begun, no);
            let parts = vehicle.substeps(claim.pace(driven - wait + begun, h) * h);
            let h = h / parts as f64;
            for part in 0..parts {
                let s = begun + h * part as f64;
                let at = driven - wait + s;
                let way = Way {
                    piece,
                    crab: claim.crab + claim.crab_rate * (at + 0.5 * h).clamp(0.0, drive),
                    pace: claim.pace(at, h),
                    gains: claim.gains(at + 0.5 * h),
                };
                let steered = vehicle.steered(&way, state[3], s, h);
                if let Some(end) = steered {
                    state[3] = 0.5 * (state[3] + end);
                }
                if vehicle.exact {
                    let angle = vehicle.angle_after(&way, state[3], s, h);
                    let bend = libm::tan(0.5 * (state[3] + angle)) / vehicle.steered_axle_m;
                    let body = |place: &Place| vehicle.body_rates(&way, place, s + 0.5 * h, bend);
                    let carried = carry(&vehicle.stand, terrain, &mut rest, [state[0], state[1], state[2]], h, body);
                    let place = carried.map_err(stopped)?;
                    state = [place[0], place[1], place[2], steered.unwrap_or(angle)];
                    pass(place);
                    max_tilt = max_tilt.max(tilt(&rest));
                    max_torque = max_torque.max(vehicle.torque(&way, &rest));
                    steps += 1;
                    continue;
                }
                let mut rates = |state: &[f64; 4], s: f64| -> Result<[f64; 4], NoRest> {
                    let place = [state[0], state[1], state[2]];
                    rest.carry_on(&vehicle.stand, terrain, place)?;
                    max_tilt = max_tilt.max(tilt(&rest));
                    Ok(vehicle.rates(&way, &rest, state, s))
                };
                let middle = rates(&state, s).and_then(|k1| rates(&moved(&state, &k1, 0.5 * h), s + 0.5 * h));
                let k2 = middle.map_err(stopped)?;
                state = moved(&state, &k2, h);
                pass([state[0], state[1], state[2]]);
                state[3] = steered.unwrap_or(state[3]);
                max_torque = max_torque.max(vehicle.torque(&way, &rest));
                steps += 1;
            }
        }
        if let DrivePiece::Arc { curvature, .. } = piece {
            driven += length;
            last_curvature = curvature.iter().rev().fold(0.0, |sum, a| sum * length + a);
        } else {
            last_curvature = 0.0;
        }
    }
    if vehicle.lags() {
        last_curvature = libm::tan(state[3]) / vehicle.steered_axle_m;
    }
    let yaw = state[2] - claim.end[2];
    Ok(GroundReplay {
        error: [state[0] - claim.end[0], state[1] - claim.end[1], libm::atan2(libm::sin(yaw), libm::cos(yaw))],
        error_curvature: last_curvature - claim.end_curvature,
        max_tilt,
        max_torque,
        steps,
    })
}

/// What a step of the integrator follows.
struct Way<'a> {
    piece: &'a DrivePiece,
    /// Direction of travel in the body at the step's middle, rad.
    crab: f64,
    /// Seconds a metre, in the mean over the step.
    pace: f64,
    /// Change of the speed along it, m/s².
    gains: f64,
}

/// Speeds below this are none, m/s, and places as near as this are one, m.
const STILL: f64 = 1e-4;
const SAME_PLACE: f64 = 1e-6;

impl GroundClaim {
    /// Whether the vehicle stands after `s` metres.
    fn stands_at(&self, s: f64) -> bool {
        self.speed.iter().any(|[place, speed]| (place - s).abs() < SAME_PLACE && *speed < STILL)
    }

    /// Metres that the vehicle goes on for in `time` seconds before the drive, and after it.
    ///
    /// time · v at the first and at the last knot; 0 without knots.
    fn metres_of(&self, time: f64) -> [f64; 2] {
        let speed = |knot: Option<&[f64; 2]>| knot.map_or(0.0, |[_, v]| *v);
        [time * speed(self.speed.first()), time * speed(self.speed.last())]
    }

    /// dv/dt after `s` metres, m/s²: half of what v² changes by per metre.
    fn gains(&self, s: f64) -> f64 {
        let around = self.speed.windows(2).find(|pair| pair[0][0] < s && s <= pair[1][0]);
        around.map_or(0.0, |pair| {
            let [[s0, v0], [s1, v1]] = [pair[0], pair[1]];
            0.5 * (v1 * v1 - v0 * v0) / (s1 - s0)
        })
    }

    /// Seconds a metre from `s` on for `h` metres: ds/dv² is constant between knots, and so the time is 2 Δs/(v + v′).
    fn pace(&self, s: f64, h: f64) -> f64 {
        if h <= 0.0 {
            return 0.0;
        }
        let end = s + h;
        let speed = |pair: &[[f64; 2]], at: f64| {
            let [[s0, v0], [s1, v1]] = [pair[0], pair[1]];
            (v0 * v0 + (v1 * v1 - v0 * v0) * (at - s0) / (s1 - s0)).max(0.0).sqrt()
        };
        let mut seconds = 0.0;
        for pair in self.speed.windows(2) {
            let (from, to) = (s.max(pair[0][0]), end.min(pair[1][0]));
            if to > from {
                seconds += 2.0 * (to - from) / (speed(pair, from) + speed(pair, to));
            }
        }
        let [first, last] = [self.speed.first(), self.speed.last()].map(|knot| knot.copied().unwrap_or_default());
        // Beyond a stop there are only rounding errors.
        let beyond = |metres: f64, speed: f64| if speed > 0.0 { metres.max(0.0) / speed } else { 0.0 };
        seconds += beyond(end.min(first[0]) - s, first[1]) + beyond(end - s.max(last[0]), last[1]);
        seconds / h
    }
}

/// Angle of the body's z axis from the vertical, rad.
fn tilt(rest: &Rest) -> f64 {
    libm::acos((libm::cos(rest.roll()) * libm::cos(rest.pitch())).clamp(-1.0, 1.0))
}

/// state + h · rates.
fn moved(state: &[f64; 4], rates: &[f64; 4], h: f64) -> [f64; 4] {
    [state[0] + h * rates[0], state[1] + h * rates[1], state[2] + h * rates[2], state[3] + h * rates[3]]
}

impl GroundVehicle {
    /// Whether the steering follows its command with a delay of its own; else κ is the command's.
    fn lags(&self) -> bool {
        self.steering_time_constant_s > 0.0 || self.steering_rate_rad_s.is_finite()
    }

    /// Parts of a step that takes `time` seconds: near rest steps are long, and the lag of each must stay small. Of n
    /// equal lengths from rest the first takes the share 1/√n.
    fn substeps(&self, time: f64) -> usize {
        if self.steering_time_constant_s <= 0.0 {
            return 1;
        }
        let ratio = 8.0 * time.abs() / self.steering_time_constant_s;
        (ratio * ratio).ceil().clamp(1.0, 400.0) as usize
    }

    /// The steering angle after a step from `s` of steering without a time constant: the command's, as far as the rate
    /// allows. Such steering is no differential equation that small steps would solve: it would swing about its
    /// command.
    fn steered(&self, way: &Way<'_>, angle: f64, s: f64, h: f64) -> Option<f64> {
        let DrivePiece::Arc { curvature, .. } = way.piece else { return None };
        if self.steering_time_constant_s > 0.0 || self.steering_rate_rad_s.is_infinite() {
            return None;
        }
        let commanded: f64 = curvature.iter().rev().fold(0.0, |sum, a| sum * (s + h) + a);
        let most = self.steering_rate_rad_s * way.pace * h;
        Some(angle + (libm::atan(commanded * self.steered_axle_m) - angle).clamp(-most, most))
    }

    /// d(x, y, ψ, δ) per metre commanded, or per radian of a turn in place.
    fn rates(&self, way: &Way<'_>, rest: &Rest, state: &[f64; 4], s: f64) -> [f64; 4] {
        let [(sf, cf), (st, ct), (sp, cp)] = [rest.roll(), rest.pitch(), state[2]].map(libm::sincos);
        let place = Place { roll: rest.roll(), pitch: rest.pitch() };
        let bend = libm::tan(state[3]) / self.steered_axle_m;
        let [vx, vy, turn] = self.body_rates(way, &place, s, bend);
        let ahead = ct * vx + st * sf * vy;
        let left = cf * vy;
        [cp * ahead - sp * left, sp * ahead + cp * left, cf / ct * turn, self.turned(way, state[3], s)]
    }

    /// |torque| of each wheel, N·m: m g times rise along the way and rolling resistance, and m a, shared by the wheels;
    /// 0 in place.
    fn torque(&self, way: &Way<'_>, rest: &Rest) -> f64 {
        let (Some(haul), DrivePiece::Arc { direction, .. }) = (&self.haul, way.piece) else { return 0.0 };
        let body = turn(1, rest.pitch()) * turn(0, rest.roll());
        let travel = *direction * (body * Vector3::new(libm::cos(way.crab), libm::sin(way.crab), 0.0));
        let upright = (body * Vector3::z()).z.max(0.0);
        let weight = haul.mass_kg * haul.gravity_m_s2;
        let force = weight * (travel.z + haul.rolling_resistance * upright) + haul.mass_kg * way.gains;
        (force * haul.radius_m / haul.wheels as f64).abs()
    }

    /// dδ per metre of steering with a time constant; without one the step's angle is known before: `steered`.
    fn turned(&self, way: &Way<'_>, angle: f64, s: f64) -> f64 {
        let DrivePiece::Arc { curvature, .. } = way.piece else { return 0.0 };
        if self.steering_time_constant_s <= 0.0 {
            return 0.0;
        }
        let commanded: f64 = curvature.iter().rev().fold(0.0, |sum, a| sum * s + a);
        let wanted = libm::atan(commanded * self.steered_axle_m) - angle;
        let rate = wanted / self.steering_time_constant_s;
        rate.clamp(-self.steering_rate_rad_s, self.steering_rate_rad_s) * way.pace
    }

    /// The steering angle after a step from `s` on, which does not depend on where the vehicle is: by the midpoint
    /// rule.
    fn angle_after(&self, way: &Way<'_>, angle: f64, s: f64, h: f64) -> f64 {
        let half = angle + 0.5 * h * self.turned(way, angle, s);
        angle + h * self.turned(way, half, s + 0.5 * h)
    }

    /// vx, vy (per metre commanded) and ωz (1/m) in the body, or 0, 0, 1 of a turn in place; `bend` is what lagging
    /// wheels steer.
    fn body_rates(&self, way: &Way<'_>, place: &Place, s: f64, bend: f64) -> [f64; 3] {
        let DrivePiece::Arc { curvature, direction, .. } = way.piece else { return [0.0, 0.0, 1.0] };
        let commanded: f64 = curvature.iter().rev().fold(0.0, |sum, a| sum * s + a);
        let bend = if self.lags() { bend } else { commanded };
        let [(sf, _), (st, ct), (sd, cd)] = [place.roll, place.pitch, way.crab].map(libm::sincos);
        // Unit vectors of the way and across it in the body, and how steeply each rises.
        let (along, across) = ([cd, sd], [-sd, cd]);
        let rises = [-st, ct * sf];
        let rise = |v: [f64; 2]| v[0] * rises[0] + v[1] * rises[1];
        let progress = direction - self.slip_at_20_deg * rise(along) / SIN_20;
        let drift = -self.side_slip_at_20_deg * rise(across) / SIN_20;
        [progress * along[0] + drift * across[0], progress * along[1] + drift * across[1], bend * progress]
    }
}
