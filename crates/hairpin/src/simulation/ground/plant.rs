//! The vehicle as it drives: a body that settles on its wheels at every step, slips, and steers and speeds up with
//! lags.
//!
//! The body is settled on its wheels at every step (4 mm, 0.02 rad at most), by the robot's own suspension: what
//! differs from the claim is what the vehicle does, not what the ground is.

use nalgebra::{Isometry3, Translation3, Vector3};

use super::command::DriveCommand;
use crate::math::rotation::{quaternion_from_euler, unit_quaternion};
use crate::robot::rover::{Effort, Gradient, Rates, Response, Rover, Settled, Suspension, Unsettled, slip_share};
use crate::trajectory::drive::Planar;
use crate::world::terrain::{ElevationMap, NoGround, Terrain};

/// Why a vehicle cannot go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lost {
    /// No ground below it: the map's edge, or cells without data.
    NoGround,
    /// Its wheels find no rest.
    NoRest,
}

impl From<NoGround> for Lost {
    fn from(_: NoGround) -> Self {
        Lost::NoGround
    }
}

impl From<Unsettled> for Lost {
    fn from(why: Unsettled) -> Self {
        match why {
            Unsettled::NoGround(_) => Self::NoGround,
            _ => Self::NoRest,
        }
    }
}

/// Longest step, m of travel and rad of a turn in place.
const STEP: f64 = 0.004;
const TURN_STEP: f64 = 0.02;
/// Longest step of a speed that lags, in its time constants.
const LAG_STEP: f64 = 0.1;
/// A wheel that is told to stand and turns slower than this does stand: static friction holds it, m/s.
const HELD: f64 = 1e-3;
/// Newton's last step of the suspension is taken from gaps of at most this, m: it leaves its square.
const GAP: f64 = 1e-4;
/// Speeds below this are none, m/s and rad/s.
const STILL: f64 = 1e-9;

/// State of a driving vehicle:
/// ẋ, ẏ, ψ̇ by [`Rover::rates`] of the wheels' speed v and κ = tan(δ)/L;
/// T δ̇ = atan(κ_c L) − δ with |δ̇| and |κ| bounded; the direction of travel is what is commanded, as in plans; v and
/// the rate ω of turns in place follow their commands with a lag and the bounded acceleration, and v with no more than
/// the wheels' torque leaves of it; z, φ, θ and the joints by the suspension on the ground. A steady force at the
/// centre of mass is a tilt of gravity to slip, torque and tip-over margin.
#[derive(Debug, Clone)]
pub(super) struct Plant<'a> {
    /// The true one: its slip, lags and bounds act.
    pub(super) vehicle: &'a Rover,
    terrain: &'a ElevationMap,
    /// Of travel in the body, rad.
    pub(super) direction: f64,
    /// Its sine and cosine.
    travels: (f64, f64),
    /// Steady force at the centre of mass, world axes, as a share of the weight.
    pub(super) pull: Vector3<f64>,
    /// Of the last step, along the way, m/s².
    gained: f64,
    /// East, m.
    pub(super) x: f64,
    /// North, m.
    pub(super) y: f64,
    /// ψ, rad, not wrapped.
    pub(super) yaw: f64,
    /// Of the wheels, m/s.
    pub(super) speed: f64,
    /// Of a turn in place, rad/s.
    pub(super) turn_rate: f64,
    /// δ, rad.
    steering: f64,
    /// tan(δ)/L, 1/m.
    bend: f64,
    /// How the body stands.
    pub(super) pose: Settled,
    gradient: Gradient,
}

impl<'a> Plant<'a> {
    /// At rest on the ground at `start`, its wheels steered for the curvature there, travelling along `direction` (rad)
    /// of its body.
    pub(super) fn new(
        vehicle: &'a Rover,
        terrain: &'a ElevationMap,
        direction: f64,
        start: &Planar,
    ) -> Result<Self, Lost> {
        let mut plant = Self {
            vehicle,
            terrain,
            direction,
            travels: libm::sincos(direction),
            pull: Vector3::zeros(),
            gained: 0.0,
            x: start.x,
            y: start.y,
            yaw: start.yaw,
            speed: 0.0,
            turn_rate: 0.0,
            steering: 0.0,
            bend: 0.0,
            pose: Settled::default(),
            gradient: Gradient::default(),
        };
        plant.steer_at_once(start.curvature);
        (plant.pose, plant.gradient) = plant.rest_from_nothing()?;
        Ok(plant)
    }

    /// x, y (m), ψ (rad).
    fn place(&self) -> [f64; 3] {
        [self.x, self.y, self.yaw]
    }

    /// The rest at the plant's place, without one nearby to begin from.
    fn rest_from_nothing(&self) -> Result<(Settled, Gradient), Lost> {
        if self.vehicle.suspension == Suspension::Level {
            // A point needs no wheels to stand, but it does need ground.
            let z = self.terrain.height(self.x, self.y)?;
            return Ok((Settled { z, ..Settled::default() }, Gradient::default()));
        }
        self.vehicle.suspension.settle_cold(self.terrain, self.place()).map_err(Lost::from)
    }

    /// κ of the wheels as they are steered, 1/m.
    pub(super) fn curvature(&self) -> f64 {
        self.bend
    }

    /// Swings the wheels, as a standing vehicle can, 1/m.
    pub(super) fn steer_at_once(&mut self, curvature: f64) {
        self.put_wheels(libm::atan(curvature * self.vehicle.response.steered_axle));
    }

    fn put_wheels(&mut self, steering: f64) {
        self.steering = steering;
        self.bend = libm::tan(steering) / self.vehicle.response.steered_axle;
    }

    /// Goes on for `time` s under `command`.
    ///
    /// In steps of at most 4 mm of travel and 0.02 rad in place; none is taken for a vehicle that neither moves nor
    /// turns.
    pub(super) fn advance(&mut self, command: &DriveCommand, time: f64) -> Result<(), Lost> {
        let lag = self.vehicle.response.speed_time_constant;
        let finest = if lag > 0.0 { LAG_STEP * lag } else { f64::INFINITY };
        let mut left = time;
        while left > 1e-12 {
            let fastest = self.speed.abs().max(self.bounded_speed(command).abs());
            let turning = self.turn_rate.abs().max(command.turn_rate.abs());
            let h = left.min(STEP / fastest.max(STILL)).min(TURN_STEP / turning.max(STILL)).min(finest);
            self.step(command, h)?;
            left -= h;
        }
        Ok(())
    }

    /// The commanded speed within the vehicle's largest, m/s; of driven rims what the outer one can on the bend that is
    /// commanded, |v| (1 + |κ| b/2) ≤ v_wheel: both wheels are slowed alike, so that the bend stays.
    fn bounded_speed(&self, command: &DriveCommand) -> f64 {
        let limits = &self.vehicle.limits;
        let bend = command.curvature.abs().min(limits.curvature);
        let most = self.vehicle.rims.map_or(limits.speed, |rims| limits.speed.min(rims.most_speed(bend)));
        command.speed.clamp(-most, most)
    }

    /// One step by the midpoint rule; the pose at its middle is extrapolated by the suspension's gradient, the one at
    /// its end settled.
    fn step(&mut self, command: &DriveCommand, h: f64) -> Result<(), Lost> {
        let bend_before = self.curvature();
        self.steer(command.curvature, h);
        if command.direction != self.direction {
            (self.direction, self.travels) = (command.direction, libm::sincos(command.direction));
        }
        let bend = if self.vehicle.response.lags() { 0.5 * (bend_before + self.curvature()) } else { self.curvature() };
        let (way, turn) = self.accelerate(command, h);
        if way == 0.0 && turn == 0.0 {
            return Ok(());
        }
        let from = self.place();
        let first = self.motion((&self.pose, &self.gradient), from[2], way, bend, turn);
        let halfway = from[2] + 0.5 * first[2];
        if matches!(self.vehicle.suspension, Suspension::Level) {
            // It stands as it did, and has no gradient: only its height goes with the ground.
            let moved = self.motion((&self.pose, &self.gradient), halfway, way, bend, turn);
            self.go_on_from(from, moved);
            self.pose.z = self.terrain.height(self.x, self.y)?;
            return Ok(());
        }
        let half = self.pose.moved(&self.gradient.over(first.map(|d| 0.5 * d)));
        let moved = self.motion((&half, &self.gradient), halfway, way, bend, turn);
        self.go_on_from(from, moved);
        let guess = self.pose.moved(&self.gradient.over(moved));
        (self.pose, self.gradient) =
            self.vehicle.suspension.carry_on(self.terrain, self.place(), &guess, GAP).map_err(Lost::from)?;
        Ok(())
    }

    fn go_on_from(&mut self, from: [f64; 3], moved: [f64; 3]) {
        (self.x, self.y, self.yaw) = (from[0] + moved[0], from[1] + moved[1], from[2] + moved[2]);
    }

    /// Change of (x, y, ψ) on `way` m (signed) and `turn` rad in place of the wheels, which the vehicle follows on its
    /// scales, standing as `pose` and its gradient say with `yaw`.
    fn motion(&self, stands: (&Settled, &Gradient), yaw: f64, way: f64, bend: f64, turn: f64) -> [f64; 3] {
        let (sin, cos) = libm::sincos(yaw);
        let sign = if way < 0.0 { -1.0 } else { 1.0 };
        let Response { speed_scale, turn_scale, .. } = self.vehicle.response;
        let (way, bend, turn) = (speed_scale * way, turn_scale * bend, speed_scale * turn_scale * turn);
        let pull = self.pulled(stands.0, yaw);
        let driven = self.vehicle.rates_under(stands, yaw, self.travels, (sign, bend), [pull.x, pull.y]);
        let turned = match turn == 0.0 {
            true => Rates::default(),
            false => self.vehicle.turning(stands, yaw),
        };
        let way = way.abs();
        let (ahead, left) = (way * driven.ahead + turn * turned.ahead, way * driven.left + turn * turned.left);
        [cos * ahead - sin * left, sin * ahead + cos * left, way * driven.yaw + turn * turned.yaw]
    }

    /// Turns the wheels for `h` s towards `curvature`.
    ///
    /// δ ← δ + clamp((1 − e^(−h/T)) (δ* − δ), ±δ̇_max h), δ* = atan(clamp(κ*, ±κ_max) L): the lag exactly. Of driven
    /// rims κ_max is what the outer one can at the speed that there is.
    fn steer(&mut self, curvature: f64, h: f64) {
        let response = &self.vehicle.response;
        let most = self.vehicle.limits.curvature;
        let most = self.vehicle.rims.map_or(most, |rims| most.min(rims.curvature(self.speed.abs())));
        let wanted = libm::atan(curvature.clamp(-most, most) * response.steered_axle);
        let lag = response.steering_time_constant;
        let share = if lag > 0.0 { -libm::expm1(-h / lag) } else { 1.0 };
        let fastest = response.steering_rate * h;
        let steering = self.steering + (share * (wanted - self.steering)).clamp(-fastest, fastest);
        // On a straight and on an arc they stay as they are.
        if steering != self.steering {
            self.put_wheels(steering);
        }
    }

    /// Brings the speeds towards their commands; the way and the angle gone meanwhile.
    ///
    /// m (signed) and rad. A vehicle whose acceleration is bounded covers the mean of both speeds, one that takes any
    /// speed at once the new one.
    fn accelerate(&mut self, command: &DriveCommand, h: f64) -> (f64, f64) {
        let most = self.vehicle.limits.acceleration * h;
        let lag = self.vehicle.response.speed_time_constant;
        let share = if lag > 0.0 { -libm::expm1(-h / lag) } else { 1.0 };
        let stands = |wanted: f64, now: f64| lag > 0.0 && wanted == 0.0 && now.abs() < HELD;
        let wanted = if command.turn_rate == 0.0 { self.bounded_speed(command) } else { 0.0 };
        let before = self.speed;
        self.speed += (share * (wanted - before)).clamp(-most, most);
        if stands(wanted, self.speed) {
            self.speed = 0.0;
        }
        self.hold_to_torque(before, h);
        self.gained = (self.speed.abs() - before.abs()) / h;
        let standing = before.abs() < STILL && self.speed.abs() < STILL && self.vehicle.limits.turns_in_place;
        let wanted = if standing { command.turn_rate } else { 0.0 };
        // What the steered wheels may do on their circle about the middle.
        let most = most / self.vehicle.response.steered_axle;
        let turning = self.turn_rate;
        self.turn_rate += (share * (wanted - turning)).clamp(-most, most);
        if stands(wanted, self.turn_rate * self.vehicle.response.steered_axle) {
            self.turn_rate = 0.0;
        }
        let limits = &self.vehicle.limits;
        let bounded = limits.acceleration.is_finite() || self.vehicle.wheels.torque.is_finite() || lag > 0.0;
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        if bounded {
            (h * mean(before, self.speed), h * mean(turning, self.turn_rate))
        } else {
            (h * self.speed, h * self.turn_rate)
        }
    }

    /// The speed that the wheels' torque leaves after a step of `h` s from `before`: what they have over what climbing
    /// and rolling take speeds up, what they lack slows down. Those that cannot go on stand; their gears hold.
    fn hold_to_torque(&mut self, before: f64, h: f64) {
        let most = self.vehicle.most_traction();
        if most.is_infinite() || self.speed == 0.0 {
            return;
        }
        let sign = self.speed.signum();
        let Some(effort) = self.effort(sign, 0.0) else { return };
        let Some(mass) = self.vehicle.weight.map(|weight| weight.mass) else { return };
        // Of a speed that changes its sign the part up to rest is braking.
        let begun = (sign * before).max(0.0);
        let spare = (most - effort.traction) / mass;
        self.speed = sign * (sign * self.speed).min(begun + spare * h).max(0.0);
    }

    /// What the wheels do while they drive with `sign` and gain `acceleration` (m/s²) along their way; `None` without a
    /// weight.
    ///
    /// As [`Rover::effort`] has it, with the steady force as a lean of gravity.
    fn effort(&self, sign: f64, acceleration: f64) -> Option<Effort> {
        self.vehicle.effort(&self.pose, self.travels, sign, acceleration, &self.pulled(&self.pose, self.yaw))
    }

    /// Torque of each wheel, N·m; 0 where the vehicle stands, and `None` without a weight.
    pub(super) fn torque(&self) -> Option<f64> {
        let effort = self.effort(self.speed.signum(), self.gained)?;
        Some(if self.speed.abs() < STILL { 0.0 } else { effort.torque })
    }

    /// The steady force in the axes of a body that stands as `pose`, as a share of the weight.
    fn pulled(&self, pose: &Settled, yaw: f64) -> Vector3<f64> {
        if self.pull == Vector3::zeros() {
            return self.pull;
        }
        let attitude = unit_quaternion(&quaternion_from_euler(pose.roll, pose.pitch, yaw));
        attitude.inverse() * self.pull
    }

    /// Share of the wheels' way that is lost along it; negative where more is gained.
    pub(super) fn slip(&self) -> f64 {
        if self.speed.abs() < STILL {
            return 0.0;
        }
        let pull = self.pulled(&self.pose, self.yaw);
        let share = slip_share(&self.pose, self.travels, self.speed.signum(), &self.vehicle.slip, [pull.x, pull.y]);
        share + (1.0 - self.vehicle.response.speed_scale) * (1.0 - share)
    }

    /// Velocity of the body's origin, m/s, world frame.
    pub(super) fn velocity(&self) -> Vector3<f64> {
        self.velocity_at([self.speed, self.turn_rate])
    }

    /// The same where its wheels went at `speed` (m/s, signed) and it turned in place at `turn` (rad/s).
    ///
    /// ż from the suspension's gradient, for a point from the slope of the ground.
    pub(super) fn velocity_at(&self, [speed, turn]: [f64; 2]) -> Vector3<f64> {
        let stands = (&self.pose, &self.gradient);
        let moved = self.motion(stands, self.yaw, speed, self.curvature(), turn);
        let climb = match self.terrain.patch(self.x, self.y) {
            Ok(ground) if self.vehicle.suspension == Suspension::Level => {
                ground.slope[0] * moved[0] + ground.slope[1] * moved[1]
            }
            _ => self.gradient.over(moved)[0],
        };
        Vector3::new(moved[0], moved[1], climb)
    }

    /// `world_from_body`. A point without wheels lies on the ground.
    pub(super) fn world_from_body(&self) -> Isometry3<f64> {
        let z = match self.vehicle.suspension {
            Suspension::Level => self.terrain.height(self.x, self.y).unwrap_or(0.0),
            _ => self.pose.z,
        };
        let attitude = unit_quaternion(&quaternion_from_euler(self.pose.roll, self.pose.pitch, self.yaw));
        Isometry3::from_parts(Translation3::new(self.x, self.y, z), attitude)
    }

    /// How safely it stands; see [`Rover::tip_over_margin`] and [`Rover::belly_clearance`]. A point without wheels
    /// stands freely.
    pub(super) fn stands(&self) -> Result<Stands, Lost> {
        if self.vehicle.suspension == Suspension::Level {
            return Ok(Stands::FREE);
        }
        Ok(Stands {
            margin: self.vehicle.tip_over_margin_under(self.terrain, self.place(), &self.pose, &self.pull)?,
            clearance: self.vehicle.belly_clearance(self.terrain, self.place(), &self.pose)?,
        })
    }
}

/// How safely a vehicle stands; infinite where nothing is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stands {
    /// Angle by which the body must lean further to tip over, rad.
    pub(super) margin: f64,
    /// Height of the underside over the ground, m.
    pub(super) clearance: f64,
}

impl Stands {
    /// As freely as can be.
    pub(super) const FREE: Self = Self { margin: f64::INFINITY, clearance: f64::INFINITY };

    /// The worse of both, number by number.
    pub(super) fn least(&self, other: &Self) -> Self {
        Self { margin: self.margin.min(other.margin), clearance: self.clearance.min(other.clearance) }
    }
}
