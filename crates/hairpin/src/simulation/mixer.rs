//! Thrust and moments into rotor speeds, and what is given up first when the rotors cannot do it all.

use nalgebra::{Matrix4, Vector3, Vector4};

use crate::robot::quadrotor::Quadrotor;

/// Inverts the rotor allocation within the rotor speed limits.
///
/// Roll and pitch moments are kept first, because they keep the robot upright; then thrust; yaw moment is what is
/// left. If even roll and pitch do not fit, both are scaled alike and the thrust goes where they fit best.
#[derive(Debug, Clone)]
pub(crate) struct Mixer {
    inverse: Matrix4<f64>,
    /// Limits of w², (rad/s)².
    least: f64,
    most: f64,
}

/// Rotor speeds, and how many of the four were held at a limit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mixed {
    /// rad/s.
    pub speeds: Vector4<f64>,
    /// 0 … 4.
    pub at_limit: u32,
}

impl Mixer {
    /// `None` where the rotors cannot give thrust and all three moments independently, or one of them would have to
    /// push down to hover.
    pub(crate) fn new(robot: &Quadrotor) -> Option<Self> {
        let inverse = robot.unmixing()?;
        let usable = inverse.iter().all(|c| c.is_finite()) && inverse.column(0).iter().all(|c| *c > 0.0);
        let (least, most) = (robot.rotor_speed.0.powi(2), robot.rotor_speed.1.powi(2));
        usable.then_some(Self { inverse, least, most })
    }

    /// Rotor speeds for a thrust (N) and moments (N·m).
    #[inline(always)]
    pub(crate) fn mix(&self, thrust: f64, moments: &Vector3<f64>) -> Mixed {
        let row = |i: usize| {
            let m = &self.inverse;
            (m[(i, 0)] * thrust + m[(i, 1)] * moments.x) + (m[(i, 2)] * moments.y + m[(i, 3)] * moments.z)
        };
        let squares = Vector4::new(row(0), row(1), row(2), row(3));
        if squares.min() >= self.least && squares.max() <= self.most {
            return Mixed { speeds: squares.map(f64::sqrt), at_limit: 0 };
        }
        self.saturate(thrust, moments)
    }

    #[cold]
    fn saturate(&self, thrust: f64, moments: &Vector3<f64>) -> Mixed {
        let collective: Vector4<f64> = self.inverse.column(0).into_owned();
        let tilting = self.inverse * Vector4::new(0.0, moments.x, moments.y, 0.0);
        let yawing = self.inverse * Vector4::new(0.0, 0.0, 0.0, moments.z);
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
        Mixed { speeds: squares.map(f64::sqrt), at_limit }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::{named_seed, stream};
    use crate::simulation::tests::flightgoggles;
    use rand::RngExt;

    fn wrench(robot: &Quadrotor, mixed: &Mixed) -> Vector4<f64> {
        robot.wrench(&mixed.speeds)
    }

    #[test]
    fn what_fits_is_given_exactly() {
        let robot = flightgoggles();
        let mixed = Mixer::new(&robot).unwrap().mix(12.0, &Vector3::new(0.1, -0.2, 0.05));
        assert!((wrench(&robot, &mixed) - Vector4::new(12.0, 0.1, -0.2, 0.05)).norm() < 1e-12);
        assert_eq!(mixed.at_limit, 0);
    }

    #[test]
    fn roll_and_pitch_come_before_thrust_and_thrust_before_yaw() {
        let robot = flightgoggles();
        let mixer = Mixer::new(&robot).unwrap();
        let full = mixer.mix(37.0, &Vector3::new(0.4, 0.3, 0.0));
        let got = wrench(&robot, &full);
        assert!((got[1] - 0.4).abs() < 1e-9 && (got[2] - 0.3).abs() < 1e-9 && got[0] < 36.0, "{got}");
        let twisted = mixer.mix(30.0, &Vector3::new(0.2, 0.0, 9.0));
        let got = wrench(&robot, &twisted);
        assert!((got[0] - 30.0).abs() < 1e-9 && (got[1] - 0.2).abs() < 1e-9 && got[3] > 0.1 && got[3] < 5.0, "{got}");
        assert!(twisted.at_limit >= 1);
    }

    #[test]
    fn whatever_is_asked_the_speeds_are_within_limits() {
        let robot = flightgoggles();
        let mixer = Mixer::new(&robot).unwrap();
        let mut rng = stream(named_seed(1, "mixer", 0));
        for case in 0..20_000 {
            let size = 10f64.powf(rng.random_range(-2.0..6.0));
            let moments = Vector3::from([0, 1, 2].map(|_| size * rng.random_range(-1.0..1.0)));
            let thrust = rng.random_range(-50.0..100.0);
            let mixed = mixer.mix(thrust, &moments);
            let (min, max) = robot.rotor_speed;
            assert!(mixed.speeds.iter().all(|w| (min..=max).contains(w)), "case {case}: {}", mixed.speeds);
            let got = wrench(&robot, &mixed);
            // Never a roll or pitch moment of the wrong sign or direction.
            let cross = got[1] * moments.y - got[2] * moments.x;
            assert!(cross.abs() < 1e-6 * moments.norm().max(1.0), "case {case}: {got}");
            assert!(got[1] * moments.x > -1e-9 * size && got[2] * moments.y > -1e-9 * size, "case {case}");
        }
    }
}
