//! Speed and tilt of a flight's polynomials against what is asked, at many places of each leg.
//!
//! Tilt is the angle of the thrust that the path demands from the vertical, z_b = F/|F|,
//! F = m (p̈ + g e₃) + (c₁ + c₂|v|) v. Looked at, not bounded: what is between two places can be larger by a little.

use super::body::Body;
use super::claim::Leg;
use super::demand::drag;
use super::finding::{Collector, Finding};
use super::jet::{Jet, JetVector};

/// What is asked; infinite where nothing is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightLimits {
    /// Largest speed, m/s.
    pub speed: f64,
    /// Largest angle of the thrust from the vertical, rad.
    pub tilt: f64,
}

/// Places of a leg that are looked at, less one.
const PLACES: u32 = 256;
/// Bounds are kept up to this share of them.
const ROUNDING: f64 = 1e-6;

/// The fastest and the most tilted place of each leg where it is beyond `limits`: `legs[k].speed` in m/s,
/// `legs[k].tilt` in rad, at its time since the start.
pub fn verify_flight_limits(body: &Body, legs: &[Leg], limits: &FlightLimits) -> Vec<Finding> {
    let (mut findings, mut began) = (Vec::new(), 0.0);
    for (number, leg) in legs.iter().enumerate() {
        let mut most = [(0.0_f64, 0.0); 2];
        for k in 0..=PLACES {
            let tau = leg.duration * f64::from(k) / f64::from(PLACES);
            for (most, value) in most.iter_mut().zip(speed_and_tilt(body, leg, tau)) {
                // What is no number stays.
                if !(value <= most.0 || most.0.is_nan()) {
                    *most = (value, tau);
                }
            }
        }
        for ((value, tau), (what, bound, unit)) in
            most.into_iter().zip([("speed", limits.speed, "m/s"), ("tilt", limits.tilt, "rad")])
        {
            let kept = value <= bound * (1.0 + ROUNDING);
            Collector::on_leg(&mut findings, number, began + tau).unless(kept, what, value, bound, unit);
        }
        began += leg.duration;
    }
    findings
}

/// |v|, m/s, and the angle of the thrust from the vertical, rad, at `tau` s.
fn speed_and_tilt(body: &Body, leg: &Leg, tau: f64) -> [f64; 2] {
    let taylor = leg.taylor(tau);
    let velocity: JetVector = taylor.map(|p| Jet([p[1], 2.0 * p[2], 3.0 * p[3]]));
    let drag = drag(body, &velocity);
    let mut force: [f64; 3] = std::array::from_fn(|axis| body.mass * 2.0 * taylor[axis][2] + drag[axis].value());
    force[2] += body.mass * body.gravity;
    let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    [norm(taylor.map(|p| p[1])), libm::atan2(libm::hypot(force[0], force[1]), force[2])]
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::verification::RotorPlace;

    #[test]
    fn the_fastest_and_the_most_tilted_place_are_told() {
        let rotor = RotorPlace { x: 0.1, y: 0.1, spin: 1.0 };
        let body = Body {
            mass: 1.0,
            inertia: [0.01; 3],
            rotors: [rotor; 4],
            thrust_coefficient: 1e-6,
            moment_coefficient: 1e-8,
            rotor_speed: (0.0, 1e4),
            rotor_time_constant: 0.0,
            drag_linear: 0.0,
            drag_quadratic: 0.0,
            aerodynamic_moment: 0.0,
            gravity: 10.0,
        };
        // x = 5 t² for 1 s: 10 m/s at its end, and 45° all along.
        let mut coefficients = [[0.0; 8]; 3];
        coefficients[0][2] = 5.0;
        let legs = [Leg { duration: 1.0, coefficients }];
        let found = |speed: f64, tilt: f64| verify_flight_limits(&body, &legs, &FlightLimits { speed, tilt });
        assert!(found(10.0, 0.786).is_empty() && found(f64::INFINITY, f64::INFINITY).is_empty());
        let beyond = found(9.9, 0.785);
        assert_eq!(beyond.iter().map(|one| one.field.as_str()).collect::<Vec<_>>(), ["legs[0].speed", "legs[0].tilt"]);
        assert!((beyond[0].value - 10.0).abs() < 1e-12 && beyond[0].at == 1.0, "{beyond:?}");
        coefficients[0][1] = f64::NAN;
        let lost = [Leg { duration: 1.0, coefficients }];
        assert!(!verify_flight_limits(&body, &lost, &FlightLimits { speed: 1.0, tilt: 1.0 }).is_empty());
    }
}
