//! What a drive on the ground claims: the vehicle, its commands' speeds, and where they are to lead.

use super::held_wheels::HeldWheels;
use super::posed::Stand;

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
    /// What the wheels may do, where anything binds.
    pub wheels: Option<HeldWheels>,
}

#[cfg(feature = "unit-tests")]
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
        wheels: None,
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

/// Speeds below this are none, m/s, and places as near as this are one, m.
const STILL: f64 = 1e-4;
const SAME_PLACE: f64 = 1e-6;

impl GroundClaim {
    /// Whether the vehicle stands after `s` metres.
    pub(super) fn stands_at(&self, s: f64) -> bool {
        self.speed.iter().any(|[place, speed]| (place - s).abs() < SAME_PLACE && *speed < STILL)
    }

    /// Metres that the vehicle goes on for in `time` seconds before the drive, and after it.
    ///
    /// time · v at the first and at the last knot; 0 without knots.
    pub(super) fn metres_of(&self, time: f64) -> [f64; 2] {
        let speed = |knot: Option<&[f64; 2]>| knot.map_or(0.0, |[_, v]| *v);
        [time * speed(self.speed.first()), time * speed(self.speed.last())]
    }

    /// Commanded speed after `s` metres, m/s: v² is linear between knots; no number without any.
    pub(super) fn speed_at(&self, s: f64) -> f64 {
        let (Some([first, start]), Some([last, end])) = (self.speed.first(), self.speed.last()) else {
            return f64::NAN;
        };
        if s <= *first {
            return *start;
        }
        let around = self.speed.windows(2).find(|pair| pair[0][0] < s && s <= pair[1][0]);
        around.filter(|_| s < *last).map_or(*end, |pair| {
            let [[s0, v0], [s1, v1]] = [pair[0], pair[1]];
            (v0 * v0 + (v1 * v1 - v0 * v0) * (s - s0) / (s1 - s0)).max(0.0).sqrt()
        })
    }

    /// dv/dt after `s` metres, m/s²: half of what v² changes by per metre.
    pub(super) fn gains(&self, s: f64) -> f64 {
        let around = self.speed.windows(2).find(|pair| pair[0][0] < s && s <= pair[1][0]);
        around.map_or(0.0, |pair| {
            let [[s0, v0], [s1, v1]] = [pair[0], pair[1]];
            0.5 * (v1 * v1 - v0 * v0) / (s1 - s0)
        })
    }

    /// Seconds a metre from `s` on for `h` metres: ds/dv² is constant between knots, and so the time is 2 Δs/(v + v′).
    pub(super) fn pace(&self, s: f64, h: f64) -> f64 {
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
