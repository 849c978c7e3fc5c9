//! What is commanded along a piece of a drive on the ground, and what the vehicle makes of it where it stands.

use nalgebra::Vector3;

use super::drive::DrivePiece;
use super::ground_claim::{GroundClaim, GroundVehicle};
use super::posed::turn;
use super::stand::Rest;
use super::twist::Place;

/// A piece as it acts.
///
/// s counts from the piece's start: metres, or radians of a turn in place.
pub(super) struct Course<'a> {
    pub(super) piece: &'a DrivePiece,
    pub(super) vehicle: &'a GroundVehicle,
    pub(super) claim: &'a GroundClaim,
    /// Metres of the drive before it; less than 0 while no command acts yet.
    pub(super) begun: f64,
    /// Metres of the whole drive.
    pub(super) drive: f64,
    /// What the wheels steer, of vehicles that lag.
    pub(super) angles: Option<Angles>,
}

/// sin 20°.
const SIN_20: f64 = 0.342_020_143_325_668_7;

impl Course<'_> {
    /// Metres of the drive at `s`; a turn in place adds none.
    fn metres(&self, s: f64) -> f64 {
        match self.piece {
            DrivePiece::Arc { .. } => self.begun + s,
            DrivePiece::Turn { .. } => self.begun,
        }
    }

    /// Direction of travel in the body at `s`, rad.
    pub(super) fn crab(&self, s: f64) -> f64 {
        self.claim.crab + self.claim.crab_rate * self.metres(s).clamp(0.0, self.drive)
    }

    /// Commanded speed at `s` (m/s), and what it changes by (m/s²).
    pub(super) fn speed(&self, s: f64) -> [f64; 2] {
        let metres = self.metres(s);
        [self.claim.speed_at(metres), self.claim.gains(metres)]
    }

    /// κ that is commanded at `s`, 1/m.
    fn commanded(&self, s: f64) -> f64 {
        match self.piece {
            DrivePiece::Arc { curvature, .. } => curvature.iter().rev().fold(0.0, |sum, a| sum * s + a),
            DrivePiece::Turn { .. } => 0.0,
        }
    }

    /// κ that is steered at `s`, 1/m.
    pub(super) fn steered(&self, s: f64) -> f64 {
        match &self.angles {
            Some(angles) => libm::tan(angles.at(s)) / self.vehicle.steered_axle_m,
            None => self.commanded(s),
        }
    }

    /// Rates at `rest` per metre commanded, or per radian of a turn in place: ahead and to the left in the level frame
    /// of the heading, and of the heading.
    ///
    /// ```text
    /// a = cos θ vx + sin θ sin φ vy,   b = cos φ vy
    /// x′ = cos ψ a − sin ψ b,   y′ = sin ψ a + cos ψ b,   ψ′ = (cos φ/cos θ) ωz
    /// ```
    ///
    /// Roll φ, pitch θ, yaw ψ (z-y-x Euler angles); vx, vy, ωz are those in the body. What keeps the wheels on the
    /// ground (vz, ωx, ωy) is left out of it: that is the difference from `carry`.
    pub(super) fn rates(&self, rest: &Rest, s: f64) -> [f64; 3] {
        let place = Place::new(rest.roll(), rest.pitch());
        let [vx, vy, turn] = self.body_rates(&place, s);
        let [(sf, cf), (st, ct)] = [place.roll, place.pitch];
        [ct * vx + st * sf * vy, cf * vy, cf / ct * turn]
    }

    /// vx, vy (per metre commanded) and ωz (1/m) in the body, or 0, 0, 1 of a turn in place.
    ///
    /// ```text
    /// progress = direction − slip · rise(along)/sin 20°,   drift = −side slip · rise(across)/sin 20°
    /// vx, vy = progress · along + drift · across,   ωz = κ progress
    /// ```
    ///
    /// `rise` is the sine of the slope along a direction in the body; slips are the shares lost on a slope of 20°, and
    /// linear in the sine: uphill it goes slower, downhill faster, across it slides down.
    pub(super) fn body_rates(&self, place: &Place, s: f64) -> [f64; 3] {
        let DrivePiece::Arc { direction, .. } = self.piece else { return [0.0, 0.0, 1.0] };
        let ([(sf, _), (st, ct)], (sd, cd)) = ([place.roll, place.pitch], libm::sincos(self.crab(s)));
        // Unit vectors of the way and across it in the body, and how steeply each rises.
        let (along, across) = ([cd, sd], [-sd, cd]);
        let rises = [-st, ct * sf];
        let rise = |v: [f64; 2]| v[0] * rises[0] + v[1] * rises[1];
        let progress = direction - self.vehicle.slip_at_20_deg * rise(along) / SIN_20;
        let drift = -self.vehicle.side_slip_at_20_deg * rise(across) / SIN_20;
        let ahead = [progress * along[0] + drift * across[0], progress * along[1] + drift * across[1]];
        [ahead[0], ahead[1], self.steered(s) * progress]
    }

    /// |torque| of each wheel at a rest of `roll` and `pitch`, N·m: m g times rise along the way and rolling
    /// resistance, and m a, shared by the wheels; 0 in place.
    pub(super) fn torque(&self, [roll, pitch]: [f64; 2], s: f64) -> f64 {
        let (Some(haul), DrivePiece::Arc { direction, .. }) = (&self.vehicle.haul, self.piece) else { return 0.0 };
        let body = turn(1, pitch) * turn(0, roll);
        let (sin, cos) = libm::sincos(self.crab(s));
        let travel = *direction * (body * Vector3::new(cos, sin, 0.0));
        let upright = (body * Vector3::z()).z.max(0.0);
        let weight = haul.mass_kg * haul.gravity_m_s2;
        let gains = self.claim.gains(self.metres(s));
        let force = weight * (travel.z + haul.rolling_resistance * upright) + haul.mass_kg * gains;
        (force * haul.radius_m / haul.wheels as f64).abs()
    }
}

/// The steering angle along a piece: s and rad, linear between. It does not depend on where the vehicle is.
pub(super) struct Angles(Vec<[f64; 2]>);

impl Angles {
    /// From `angle` on over `length` of `course` in `steps`.
    ///
    /// Steering with a time constant by the midpoint rule, in parts where the vehicle is slow. Steering without one is
    /// no differential equation that small steps would solve, it would swing about its command: each step ends at the
    /// command, as far as the rate allows.
    pub(super) fn new(course: &Course<'_>, angle: f64, length: f64, steps: usize) -> Self {
        let mut knots = vec![[0.0, angle]];
        let vehicle = course.vehicle;
        let wanted = |s: f64| libm::atan(course.commanded(s) * vehicle.steered_axle_m);
        let mut angle = angle;
        if !matches!(course.piece, DrivePiece::Arc { .. }) {
            knots.push([length, angle]);
            return Self(knots);
        }
        let whole = length / steps as f64;
        for i in 0..steps {
            let begun = length * i as f64 / steps as f64;
            let parts = vehicle.substeps(course.claim.pace(course.metres(begun), whole) * whole);
            let h = whole / parts as f64;
            for part in 0..parts {
                let s = begun + h * part as f64;
                let pace = course.claim.pace(course.metres(s), h);
                let most = vehicle.steering_rate_rad_s * pace;
                angle += if vehicle.steering_time_constant_s > 0.0 {
                    let rate = |s: f64, angle: f64| {
                        let rate = (wanted(s) - angle) / vehicle.steering_time_constant_s;
                        rate.clamp(-vehicle.steering_rate_rad_s, vehicle.steering_rate_rad_s) * pace
                    };
                    h * rate(s + 0.5 * h, angle + 0.5 * h * rate(s, angle))
                } else {
                    (wanted(s + h) - angle).clamp(-most * h, most * h)
                };
                knots.push([s + h, angle]);
            }
        }
        Self(knots)
    }

    /// δ(s), rad.
    fn at(&self, s: f64) -> f64 {
        let next = self.0.partition_point(|knot| knot[0] < s).clamp(1, self.0.len() - 1);
        let [[from, first], [to, last]] = [self.0[next - 1], self.0[next]];
        if to > from { first + ((s - from) / (to - from)).clamp(0.0, 1.0) * (last - first) } else { last }
    }

    /// δ at the end, rad.
    pub(super) fn last(&self) -> f64 {
        self.0[self.0.len() - 1][1]
    }
}

impl GroundVehicle {
    /// Whether the steering follows its command with a delay of its own; else κ is the command's.
    pub(super) fn lags(&self) -> bool {
        self.steering_time_constant_s > 0.0 || self.steering_rate_rad_s.is_finite()
    }

    /// Parts of a step that takes `time` seconds: near rest steps are long, and the lag of each must stay small. Of n
    /// equal lengths from rest the first takes the share 1/√n.
    ///
    /// n = (8 t/τ)², 1 to 400 parts, t being the time of the whole step and τ the time constant: the first part of a
    /// step from rest then takes an eighth of τ.
    fn substeps(&self, time: f64) -> usize {
        if self.steering_time_constant_s <= 0.0 {
            return 1;
        }
        let ratio = 8.0 * time.abs() / self.steering_time_constant_s;
        (ratio * ratio).ceil().clamp(1.0, 400.0) as usize
    }
}
