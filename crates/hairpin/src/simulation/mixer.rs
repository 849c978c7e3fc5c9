//! Thrust and moments into rotor speeds, and what is given up first when the rotors cannot do it all.
//!
//! w² = M⁻¹ (m a, τ), clipped by priority and not component by component: a clipped roll moment is a crash, a clipped
//! yaw moment a turn that comes late. The same order of priorities as in Faessler, Falanga and Scaramuzza, IEEE RA-L
//! 2(2), 2017.
//!
//! ```text
//! s = thrust · c + share (roll · r + pitch · p) + share_y · yaw · y,   w_i = √s_i,   least ≤ s_i ≤ most
//! share    largest for which some thrust fits:  share · need_ij ≤ room_ij for all i, j
//! thrust   nearest to what is asked within that;   share_y   largest that is left
//! ```

use nalgebra::{Matrix4, Vector4};
use wide::f64x4;

use super::lanes::{lanes4, transform};
use crate::math::power::square;
use crate::robot::quadrotor::Quadrotor;

/// Inverts the rotor allocation within the rotor speed limits.
///
/// Roll and pitch moments are kept first, because they keep the robot upright; then thrust; yaw moment is what is
/// left. If even roll and pitch do not fit, both are scaled alike and the thrust goes where they fit best.
///
/// In four lanes, one a rotor. Made once for a robot, copied with it.
#[derive(Debug, Clone)]
pub(crate) struct Mixer {
    /// Columns: w² per angular acceleration about body x, y, z and per acceleration by thrust.
    inverse: [f64x4; 4],
    /// Limits of w², (rad/s)².
    least: f64,
    most: f64,
}

/// Rotor speeds, and how many of the four were held at a limit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mixed {
    /// rad/s.
    pub speeds: f64x4,
    /// 0 … 4.
    pub at_limit: u32,
}

impl Mixer {
    /// `None` where the rotors cannot give thrust and all three moments independently, or one of them would have to
    /// push down to hover.
    ///
    /// Inertia and mass are put into the columns, so that accelerations are asked for and not moments.
    pub(crate) fn new(robot: &Quadrotor) -> Option<Self> {
        let inverse: Matrix4<f64> = robot.unmixing()?;
        let usable = inverse.iter().all(|c| c.is_finite()) && inverse.column(0).iter().all(|c| *c > 0.0);
        let (least, most) = (square(robot.rotor_speed.0), square(robot.rotor_speed.1));
        let i = robot.inertia;
        let columns = [(1, i.x), (2, i.y), (3, i.z), (0, robot.mass)];
        let inverse = columns.map(|(k, scale)| lanes4(&(inverse.column(k) * scale)));
        usable.then_some(Self { inverse, least, most })
    }

    /// Rotor speeds for angular accelerations about body x, y and z (rad/s²) and an acceleration by thrust (m/s²).
    ///
    /// Lanes: roll, pitch, yaw acceleration, thrust per mass. O(1): nothing is searched, also where limits bind.
    #[inline(always)]
    pub(crate) fn mix(&self, wanted: f64x4) -> Mixed {
        let squares = transform(&self.inverse, wanted);
        let within = squares.simd_ge(f64x4::splat(self.least)) & squares.simd_le(f64x4::splat(self.most));
        if within.all() {
            return Mixed { speeds: squares.sqrt(), at_limit: 0 };
        }
        self.saturate(wanted.to_array())
    }

    /// Squared rotor speeds s = thrust · c + roll · r + pitch · p + yaw · y, each kept within [least, most]: roll and
    /// pitch first, both by the largest common share that some thrust still allows; then thrust as near to what is
    /// asked as that leaves; then the yaw that is left room for.
    ///
    /// O(16) divisions. Roll and pitch are scaled by one share, so that their direction stays; no moment changes its
    /// sign. `at_limit` counts what is within 1e-9 of a bound.
    #[cold]
    fn saturate(&self, [roll, pitch, yaw, thrust]: [f64; 4]) -> Mixed {
        let [per_roll, per_pitch, per_yaw, collective] = self.inverse.map(|c| Vector4::from(c.to_array()));
        let tilting = per_roll * roll + per_pitch * pitch;
        let yawing = per_yaw * yaw;
        // least ≤ c_i T + s·r_i ≤ most must leave a T: for each pair, (least − s r_i)/c_i ≤ (most − s r_j)/c_j.
        let mut share: f64 = 1.0;
        for i in 0..4 {
            for j in 0..4 {
                let room = self.most / collective[j] - self.least / collective[i];
                let need = tilting[j] / collective[j] - tilting[i] / collective[i];
                if need > 0.0 {
                    share = share.min(room / need);
                }
            }
        }
        // A layout so lopsided that not even the thrust limits meet leaves nothing for the moments.
        let tilting = tilting * share.max(0.0);
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for i in 0..4 {
            low = low.max((self.least - tilting[i]) / collective[i]);
            high = high.min((self.most - tilting[i]) / collective[i]);
        }
        let base = tilting + collective * thrust.min(high).max(low);
        let mut share: f64 = 1.0;
        for i in 0..4 {
            if yawing[i] > 0.0 {
                share = share.min((self.most - base[i]).max(0.0) / yawing[i]);
            } else if yawing[i] < 0.0 {
                share = share.min((self.least - base[i]).min(0.0) / yawing[i]);
            }
        }
        let squares = (base + yawing * share).map(|s| s.min(self.most).max(self.least));
        let slack = 1e-9 * self.most;
        let at_limit = squares.iter().filter(|s| **s >= self.most - slack || **s <= self.least + slack).count() as u32;
        Mixed { speeds: lanes4(&squares.map(f64::sqrt)), at_limit }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{named_seed, stream};
    use crate::simulation::tests::{flightgoggles, shipped};
    use nalgebra::Vector3;
    use rand::RngExt;

    /// Thrust (N) and moments (N·m) of what the mixer makes of a thrust and moments.
    fn mixed(robot: &Quadrotor, thrust: f64, moments: &Vector3<f64>) -> (Vector4<f64>, Vector4<f64>, u32) {
        let angular = moments.component_div(&robot.inertia);
        let wanted = f64x4::new([angular.x, angular.y, angular.z, thrust / robot.mass]);
        let mixed = Mixer::new(robot).unwrap().mix(wanted);
        let speeds = Vector4::from(mixed.speeds.to_array());
        (robot.wrench(&speeds), speeds, mixed.at_limit)
    }

    #[test]
    fn what_fits_is_given_exactly() {
        let mut rng = stream(named_seed(2, "mixer", 0));
        for robot in shipped() {
            let squares = robot.hover_speed().powi(2);
            for case in 0..1000 {
                // Rotor by rotor ±30 % of hover: what they make is a wrench that fits.
                let speeds = Vector4::from_fn(|_, _| (squares * rng.random_range(0.7..1.3)).sqrt());
                let wanted = robot.wrench(&speeds);
                let moments = Vector3::new(wanted[1], wanted[2], wanted[3]);
                let (_, got, at_limit) = mixed(&robot, wanted[0], &moments);
                assert!((got - speeds).norm() < 1e-9 * speeds.norm(), "{} case {case}: {got}", robot.name);
                assert_eq!(at_limit, 0, "{} case {case}", robot.name);
            }
        }
    }

    #[test]
    fn roll_and_pitch_come_before_thrust_and_thrust_before_yaw() {
        let robot = flightgoggles();
        let (got, ..) = mixed(&robot, 37.0, &Vector3::new(0.4, 0.3, 0.0));
        assert!((got[1] - 0.4).abs() < 1e-9 && (got[2] - 0.3).abs() < 1e-9 && got[0] < 36.0, "{got}");
        let (got, _, at_limit) = mixed(&robot, 30.0, &Vector3::new(0.2, 0.0, 9.0));
        assert!((got[0] - 30.0).abs() < 1e-9 && (got[1] - 0.2).abs() < 1e-9 && got[3] > 0.1 && got[3] < 5.0, "{got}");
        assert!(at_limit >= 1);
    }

    #[test]
    fn whatever_is_asked_the_speeds_are_within_limits() {
        let mut rng = stream(named_seed(1, "mixer", 0));
        for robot in shipped() {
            let (min, max) = robot.rotor_speed;
            // In shares of what the robot can: all thrust, and all thrust at the longest arm.
            let arm = robot.rotors.iter().map(|rotor| rotor.x.hypot(rotor.y)).fold(0.0, f64::max);
            let (most, turning) = (robot.max_thrust(), robot.max_thrust() * arm);
            for case in 0..5_000 {
                let size = turning * 10f64.powf(rng.random_range(-2.0..6.0));
                let moments = Vector3::from([0, 1, 2].map(|_| size * rng.random_range(-1.0..1.0)));
                let (got, speeds, _) = mixed(&robot, most * rng.random_range(-1.5..3.0), &moments);
                let told = format!("{} case {case}: {speeds} makes {got}", robot.name);
                assert!(speeds.iter().all(|w| (min..=max).contains(w)), "{told}");
                // Never a roll or pitch moment of the wrong sign or direction.
                let cross = got[1] * moments.y - got[2] * moments.x;
                assert!(cross.abs() < 1e-9 * turning * moments.norm().max(turning), "{told}");
                assert!(
                    got[1] * moments.x > -1e-9 * turning * size && got[2] * moments.y > -1e-9 * turning * size,
                    "{told}"
                );
            }
        }
    }
}
