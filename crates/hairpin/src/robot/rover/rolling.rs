//! How the body's motion becomes that of its wheels: v_w = v + ω × r_w gives steer angles and rolling speeds.
//!
//! One formula for every steering: the wheel at r_w moves by v + ω × r_w in the plane of the body, and what it cannot
//! roll it scrubs. From it come the bounds on κ that steer joints allow, and the speeds and accelerations that motors
//! must give.

use nalgebra::Vector3;

use super::{Rover, Steering, Suspension};

/// The body's motion in the plane of its wheels, per second, per metre of travel or per radian, in body axes.
///
/// Scale is free: what [`Rover::wheel_motions`] answers is in the same measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twist {
    /// Along x.
    pub ahead: f64,
    /// Along y, to the left.
    pub left: f64,
    /// About z, to the left.
    pub turn: f64,
}

impl Twist {
    /// A metre of travel with `sign` (±1) along the direction δ in the body, with curvature κ (1/m).
    ///
    /// `direction` in rad, δ > 0 to the left.
    pub fn along(direction: f64, curvature: f64, sign: f64) -> Self {
        let (sin, cos) = libm::sincos(direction);
        Self { ahead: sign * cos, left: sign * sin, turn: sign * curvature }
    }

    /// A radian in place, to the left.
    pub const IN_PLACE: Self = Self { ahead: 0.0, left: 0.0, turn: 1.0 };
}

/// What one wheel does for a [`Twist`].
///
/// Rolling speed in rad/s is `rolls` times the body's speed over the wheel's radius.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelMotion {
    /// Steer angle, rad, left positive.
    pub steer: f64,
    /// Metres that it rolls, forward positive, in the unit of the twist.
    pub rolls: f64,
    /// Metres that it is dragged across, to its left.
    pub scrubs: f64,
}

/// Wheels of one axle differ in x by less, m.
const AXLE: f64 = 1e-3;

impl Rover {
    /// What each wheel does when the body moves by `twist` with its joints at `joints`, and how many wheels there are.
    ///
    /// v_w = (ahead − turn · y_w, left + turn · x_w), r_w = (x_w, y_w) from the commanded point of the body; the
    /// articulation's own rates are left out. A wheel that steers points along v_w, forwards or backwards: whichever is
    /// nearer to its angle `before`, as far as its joint goes, or to straight ahead. One that does not steer rolls by
    /// the part of v_w ahead and scrubs by the rest. With [`Steering::Skid`] |y_w| is half of the effective track.
    /// (Howard & Kelly 2007, eq. 7)
    ///
    /// Left turn centre at 1/κ: a wheel at (x, y) stands at δ = atan2(κ x, 1 − κ y) and rolls √((1 − κ y)² + κ² x²)
    /// metres a metre, for travel straight ahead.
    ///
    /// Entries beyond the count are zeros. Radii play no part: `rolls` is of the wheel's centre in the body's plane.
    pub fn wheel_motions(
        &self,
        twist: &Twist,
        joints: &[f64; 3],
        before: Option<&[WheelMotion; 6]>,
    ) -> ([WheelMotion; 6], usize) {
        let (nominal, count, _) = self.suspension.wheels(&[0.0; 3]);
        let (places, ..) = self.suspension.wheels(joints);
        let mut motions = [WheelMotion::default(); 6];
        let steers = self.steers(&nominal[..count]);
        let point = self.commanded_x(&nominal[..count], &steers);
        for (i, motion) in motions[..count].iter_mut().enumerate() {
            let place = places[i];
            let y = self.aside(place.y);
            let ahead = twist.ahead - twist.turn * y;
            let left = twist.left + twist.turn * (place.x - point);
            *motion = if steers[i] {
                self.steered(ahead, left, before.map_or(0.0, |before| before[i].steer))
            } else {
                WheelMotion { steer: 0.0, rolls: ahead, scrubs: left }
            };
        }
        (motions, count)
    }

    /// The steer angle, modulo half a turn, that is within the joint's limit and nearest to `before`.
    ///
    /// Within ±π. Standing still (below 10⁻¹²) the wheel keeps its angle.
    fn steered(&self, ahead: f64, left: f64, before: f64) -> WheelMotion {
        let size = libm::hypot(ahead, left);
        if size <= 1e-12 {
            return WheelMotion { steer: before, ..WheelMotion::default() };
        }
        let angle = libm::atan2(left, ahead);
        let half = std::f64::consts::PI;
        let mut best: Option<f64> = None;
        for steer in [angle, angle - half, angle + half] {
            let nearer = |other: f64| (steer - before).abs() < (other - before).abs();
            if steer.abs() <= self.wheels.steer.min(half) && best.is_none_or(nearer) {
                best = Some(steer);
            }
        }
        // Out of reach both ways: the smaller angle says by how much.
        let steer = best.unwrap_or(if angle.abs() <= 0.5 * half { angle } else { angle - half.copysign(angle) });
        let rolls = if libm::cos(angle - steer) >= 0.0 { size } else { -size };
        WheelMotion { steer, rolls, scrubs: 0.0 }
    }

    /// By x of the nominal wheels, within a millimetre of the foremost or the rearmost.
    fn steers(&self, wheels: &[Vector3<f64>]) -> [bool; 6] {
        let front = wheels.iter().map(|w| w.x).fold(f64::MIN, f64::max) - AXLE;
        let rear = wheels.iter().map(|w| w.x).fold(f64::MAX, f64::min) + AXLE;
        let mut steers = [false; 6];
        for (steers, wheel) in steers.iter_mut().zip(wheels) {
            *steers = match self.wheels.steering {
                Steering::Corner => wheel.x >= front || wheel.x <= rear,
                Steering::Front => wheel.x >= front,
                Steering::AllWheel => true,
                Steering::Skid => false,
            };
        }
        steers
    }

    /// x of the point whose motion is commanded, m: with [`Steering::Front`] that between the wheels that do not steer.
    fn commanded_x(&self, wheels: &[Vector3<f64>], steers: &[bool; 6]) -> f64 {
        let fixed = || wheels.iter().zip(steers).filter(|(_, steers)| !**steers).map(|(wheel, _)| wheel.x);
        match self.wheels.steering {
            Steering::Front if fixed().count() > 0 => fixed().sum::<f64>() / fixed().count() as f64,
            _ => 0.0,
        }
    }

    /// The largest |dδ/dκ| of a steered wheel for |κ| ≤ `most`, m: |x| / ((1 − κy)² + κ²x²); 0 where none steers.
    ///
    /// dδ/dκ of δ = atan(κ x/(1 − κ y)); times |κ̇| it bounds the steer joints' rates.
    ///
    /// `most` in 1/m, ≥ 0. Exact: the denominator is least at κ = y/(x² + y²), or at the end of the range.
    pub fn steering_gain(&self, most: f64) -> f64 {
        let (wheels, count, _) = self.suspension.wheels(&[0.0; 3]);
        let steers = self.steers(&wheels[..count]);
        let point = self.commanded_x(&wheels[..count], &steers);
        let mut gain = 0.0_f64;
        for (wheel, _) in wheels[..count].iter().zip(&steers).filter(|(_, steers)| **steers) {
            let (x, y) = (wheel.x - point, wheel.y);
            // Least where the turning centre comes nearest to the wheel.
            let nearest = (y / (x * x + y * y).max(1e-12)).clamp(-most, most);
            gain = gain.max(x.abs() / ((1.0 - nearest * y) * (1.0 - nearest * y) + nearest * nearest * x * x));
        }
        gain
    }

    /// The largest |κ| straight ahead at `speed` (m/s), 1/m, at which no wheel turns faster than `most` (rad/s); 0
    /// where they do so on a straight line.
    ///
    /// A wheel that steers rolls √((1 + |κ||y|)² + κ²x²) metres a metre on the outside of a bend, another 1 + |κ||y|,
    /// and may roll R = `most` r/v.
    ///
    /// ```text
    /// |κ| = (√(y² + (x² + y²)(R² − 1)) − |y|) / (x² + y²)      x = 0 for a wheel that does not steer
    /// ```
    pub fn rollable_curvature(&self, speed: f64, most: f64) -> f64 {
        let (wheels, count, radius) = self.suspension.wheels(&[0.0; 3]);
        let ratio = most * radius / speed;
        if ratio.is_infinite() || count == 0 {
            return f64::INFINITY;
        }
        let steers = self.steers(&wheels[..count]);
        let point = self.commanded_x(&wheels[..count], &steers);
        let more = (ratio * ratio - 1.0).max(0.0);
        let of = |(wheel, steers): (&Vector3<f64>, &bool)| {
            let (x, y) = (if *steers { wheel.x - point } else { 0.0 }, self.aside(wheel.y).abs());
            let square = x * x + y * y;
            if square > 0.0 { (libm::sqrt(y * y + square * more) - y) / square } else { f64::INFINITY }
        };
        wheels[..count].iter().zip(&steers).map(of).fold(f64::INFINITY, f64::min)
    }

    /// Distance of the farthest wheel from the point that is commanded, m: |d rolls/dκ| is at most that.
    pub fn wheel_reach(&self) -> f64 {
        let (wheels, count, _) = self.suspension.wheels(&[0.0; 3]);
        let point = self.commanded_x(&wheels[..count], &self.steers(&wheels[..count]));
        wheels[..count].iter().map(|wheel| libm::hypot(wheel.x - point, self.aside(wheel.y))).fold(0.0, f64::max)
    }

    /// y that a wheel turns about, m: of skidding vehicles half of the effective track.
    fn aside(&self, y: f64) -> f64 {
        match self.wheels.steering {
            Steering::Skid => y.signum() * 0.5 * self.wheels.effective_track,
            Steering::Corner | Steering::Front | Steering::AllWheel => y,
        }
    }

    /// Names of the wheels in the order of [`Suspension::wheels`].
    pub fn wheel_names(&self) -> &'static [&'static str] {
        match self.suspension {
            Suspension::Level => &[],
            Suspension::FourWheel(_) => &["front_left", "front_right", "rear_left", "rear_right"],
            Suspension::RockerBogie(_) => {
                &["left_rocker", "left_bogie_1", "left_bogie_2", "right_rocker", "right_bogie_1", "right_bogie_2"]
            }
        }
    }

    /// Whether it can travel aside of where it looks: it steers all wheels, or is a point without any.
    pub fn may_crab(&self) -> bool {
        let (_, wheels, _) = self.suspension.wheels(&[0.0; 3]);
        let point = wheels == 0 && self.rims.is_none() && self.response.steering_rate.is_infinite();
        self.wheels.steering == Steering::AllWheel || point
    }

    /// The largest |κ| straight ahead, 1/m, that the steer joints can reach: infinite without a limit below a right
    /// angle.
    ///
    /// A wheel at (x, y) stands at atan(κx/(1 − κy)); the inner one of those farthest off goes farthest.
    ///
    /// From tan δ = |κ| |x|/(1 − |κ| |y|): |κ| = tan δ/(|x| + |y| tan δ), the least over the steered wheels.
    pub fn steerable_curvature(&self) -> f64 {
        let (wheels, count, _) = self.suspension.wheels(&[0.0; 3]);
        let steers = self.steers(&wheels[..count]);
        let point = self.commanded_x(&wheels[..count], &steers);
        if self.wheels.steer >= std::f64::consts::FRAC_PI_2 {
            return f64::INFINITY;
        }
        let tan = libm::tan(self.wheels.steer);
        let steered = wheels[..count].iter().zip(&steers).filter(|(_, steers)| **steers);
        steered.map(|(wheel, _)| tan / ((wheel.x - point).abs() + wheel.y.abs() * tan)).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::super::RoverDescription;
    use super::*;

    fn rover(steering: &str, more: &str) -> Rover {
        let text = format!(
            "kind = \"rover\"\nname = \"test\"\nsteering = \"{steering}\"\n\
             suspension = {{ kind = \"four-wheel\", wheel_radius_m = 0.1, front_m = [0.4, 0.3, 0.0], rear_m = [-0.4, 0.3, 0.0] }}\n\
             limits = {{ curvature_1_m = 1.0 }}\n[wheels]\n{more}"
        );
        toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers")
    }

    fn motions(rover: &Rover, twist: Twist) -> Vec<WheelMotion> {
        let (motions, count) = rover.wheel_motions(&twist, &[0.0; 3], None);
        motions[..count].to_vec()
    }

    #[test]
    fn turning_in_place_all_wheels_are_tangent_to_circles() {
        for wheel in motions(&rover("all-wheel", ""), Twist::IN_PLACE).iter().zip([
            [0.4, 0.3],
            [0.4, -0.3],
            [-0.4, 0.3],
            [-0.4, -0.3],
        ]) {
            let (motion, [x, y]) = wheel;
            let heading = [motion.steer.cos(), motion.steer.sin()];
            assert!((heading[0] * x + heading[1] * y).abs() < 1e-12 && motion.steer.abs() <= FRAC_PI_2, "{motion:?}");
            // Counter-clockwise: r × heading has the sign of the roll; all roll as far as they are out.
            let way = x * heading[1] - y * heading[0];
            assert!((motion.rolls - 0.5 * way.signum()).abs() < 1e-12, "{motion:?}");
        }
    }

    #[test]
    fn corner_and_front_steering_are_ackermanns() {
        let kappa: f64 = 0.8;
        let corner = motions(&rover("corner", ""), Twist::along(0.0, kappa, 1.0));
        for (motion, [x, y]) in corner.iter().zip([[0.4, 0.3], [0.4, -0.3], [-0.4, 0.3], [-0.4, -0.3]]) {
            let radius: f64 = 1.0 / kappa - y;
            assert!((motion.steer - (x / radius).atan()).abs() < 1e-12, "{motion:?}");
            assert!((motion.rolls - kappa * radius.hypot(x)).abs() < 1e-12 && motion.scrubs == 0.0);
        }
        // Front: the turning centre lies on the rear axle, 1/κ beside its middle; cot δ_outer − cot δ_inner = track /
        // wheelbase.
        let front = motions(&rover("front", ""), Twist::along(0.0, kappa, 1.0));
        let cot = |wheel: &WheelMotion| 1.0 / wheel.steer.tan();
        assert!((cot(&front[1]) - cot(&front[0]) - 0.6 / 0.8).abs() < 1e-12);
        assert!((0.5 * (cot(&front[1]) + cot(&front[0])) - 1.0 / (kappa * 0.8)).abs() < 1e-12);
        assert!(
            front[2].steer == 0.0
                && front[2].scrubs.abs() < 1e-15
                && (front[2].rolls - (1.0 - kappa * 0.3)).abs() < 1e-15
        );
    }

    #[test]
    fn crabbing_all_wheels_are_parallel_and_each_axis_has_its_sign() {
        let all = rover("all-wheel", "");
        for motion in motions(&all, Twist::along(0.5, 0.0, 1.0)) {
            assert_eq!((motion.steer, motion.rolls, motion.scrubs), (0.5, 1.0, 0.0));
        }
        // Ahead: forward; left: the wheels stand to the left; to the left about z: the right side goes ahead.
        assert!(
            motions(&all, Twist { ahead: 1.0, left: 0.0, turn: 0.0 }).iter().all(|m| m.rolls == 1.0 && m.steer == 0.0)
        );
        assert!(
            motions(&all, Twist { ahead: 0.0, left: 1.0, turn: 0.0 }).iter().all(|m| m.steer * m.rolls == FRAC_PI_2)
        );
        let skid = motions(&rover("skid", ""), Twist::IN_PLACE);
        assert!(skid[0].rolls == -0.3 && skid[1].rolls == 0.3 && skid.iter().all(|m| m.steer == 0.0));
        assert!(skid[0].scrubs == 0.4 && skid[2].scrubs == -0.4);
        // Backwards the same wheels roll the other way.
        let (there, back) = (motions(&all, Twist::along(0.0, 0.5, 1.0)), motions(&all, Twist::along(0.0, 0.5, -1.0)));
        assert!(
            there
                .iter()
                .zip(&back)
                .all(|(a, b)| (a.steer - b.steer).abs() < 1e-12 && (a.rolls + b.rolls).abs() < 1e-12)
        );
        let wide = motions(&rover("skid", "effective_track_m = 1.0"), Twist::along(0.0, 0.5, 1.0));
        assert!((wide[0].rolls, wide[1].rolls) == (0.75, 1.25));
    }

    #[test]
    fn joints_bound_what_can_be_turned() {
        let car = rover("front", "steer_limit_deg = 30");
        let most = car.steerable_curvature();
        let steers =
            |kappa: f64| motions(&car, Twist::along(0.0, kappa, 1.0)).iter().map(|m| m.steer.abs()).fold(0.0, f64::max);
        assert!((steers(most).to_degrees() - 30.0).abs() < 1e-9 && steers(-most).to_degrees() < 30.0 + 1e-9);
        let spin = motions(&car, Twist::IN_PLACE).iter().map(|m| m.steer.abs()).fold(0.0, f64::max);
        assert!(spin.to_degrees() > 60.0);
        // dδ/dκ by differences never exceeds the gain, and comes to it.
        let steep = (0..400).map(|i| {
            let kappa = most * (f64::from(i) / 200.0 - 1.0);
            let at = |kappa: f64| motions(&car, Twist::along(0.0, kappa, 1.0))[0].steer;
            ((at(kappa + 1e-6) - at(kappa - 1e-6)) / 2e-6).abs()
        });
        let steepest = steep.fold(0.0, f64::max);
        assert!(steepest <= car.steering_gain(most) * (1.0 + 1e-6) && steepest > 0.99 * car.steering_gain(most));
        assert_eq!(rover("corner", "").steerable_curvature(), f64::INFINITY);
        // Beyond a right angle the wheel goes on rather than swing about, as far as its joint does.
        let free = rover("all-wheel", "");
        let before = [WheelMotion { steer: 1.5, ..WheelMotion::default() }; 6];
        let (on, _) = free.wheel_motions(&Twist::along(1.7, 0.0, 1.0), &[0.0; 3], Some(&before));
        assert!((on[0].steer - 1.7).abs() < 1e-12 && on[0].rolls > 0.0);
        let tight = rover("all-wheel", "steer_limit_deg = 95");
        let (swung, _) = tight.wheel_motions(&Twist::along(1.7, 0.0, 1.0), &[0.0; 3], Some(&before));
        assert!((swung[0].steer - 1.7 + PI).abs() < 1e-12 && swung[0].rolls < 0.0);
    }

    /// Against the wheels' own motions: on the bend that is told the fastest wheel turns as fast as it may.
    #[test]
    fn the_fastest_wheel_of_a_bend_is_known() {
        for steering in ["corner", "front", "all-wheel", "skid"] {
            let rover = rover(steering, "effective_track_m = 0.9");
            let bend = rover.rollable_curvature(0.5, 8.0);
            let fastest = |kappa: f64| {
                let rolls = motions(&rover, Twist::along(0.0, kappa, 1.0));
                rolls.iter().map(|motion| motion.rolls.abs() * 0.5 / 0.1).fold(0.0, f64::max)
            };
            assert!((fastest(bend) - 8.0).abs() < 1e-9 && (fastest(-bend) - 8.0).abs() < 1e-9, "{steering}: {bend}");
            assert!(rover.rollable_curvature(0.5, 5.0) < 1e-12 && rover.rollable_curvature(0.5, 4.0) < 1e-12);
            assert_eq!(rover.rollable_curvature(0.5, f64::INFINITY), f64::INFINITY);
            // What rolling changes by with the bend.
            let steepest = (fastest(bend + 1e-6) - fastest(bend)) / 1e-6 * 0.1 / 0.5;
            assert!(steepest > 0.0 && steepest <= rover.wheel_reach() + 1e-6, "{steering}: {steepest}");
        }
    }

    #[test]
    fn wheels_ride_on_the_joints() {
        let path = format!("{}/../../data/robots/rover/rocky8.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("a shipped rover");
        let rocky = toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers");
        let joints = [0.3, -0.2, 0.1];
        let (motions, count) = rocky.wheel_motions(&Twist::IN_PLACE, &joints, None);
        let (places, ..) = rocky.suspension.wheels(&joints);
        assert_eq!(count, 6);
        for (motion, place) in motions.iter().zip(&places) {
            assert!((motion.rolls.abs() - place.x.hypot(place.y)).abs() < 1e-12, "{motion:?}");
        }
    }
}
