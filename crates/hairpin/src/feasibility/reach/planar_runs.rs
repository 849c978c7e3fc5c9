//! Runs of constant input of a vehicle on wheels in the plane: what its hulls are sampled from.

use super::body_hull::{BodyGrid, BodyHull, NoBodyHull};
use crate::feasibility::steering::shooting::Curvatures;
use crate::robot::rover::Rover;

/// A vehicle by what it may do: ẋ = v cos ψ, ẏ = v sin ψ, ψ̇ = κ v.
///
/// Its two inputs are the speed and the curvature that it is asked for; v and κ follow within |v̇| ≤ acceleration and
/// |κ′| ≤ most_rate and stay within their bounds.
///
/// Rovers, cars and differential drives by the same numbers that generator and certifier take.
///
/// Latency and lags are left out, slip and slopes too: a filter for searches, never a claim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarVehicle {
    /// Least (negative: in reverse) and largest speed, m/s.
    pub speeds: [f64; 2],
    /// Largest |v̇|, m/s²; infinite: at once.
    pub acceleration: f64,
    /// Of the path.
    pub bounds: Curvatures,
}

/// Steps of a run.
const STEPS: u32 = 64;
/// Speeds and curvatures at which hulls are sampled.
const LEVELS: u32 = 7;
/// Constant inputs tried of each kind.
const INPUTS: usize = 9;
/// Headings told apart: 3°.
const HEADINGS: u32 = 120;

impl PlanarVehicle {
    /// `rover` at no more than `speed` (m/s), as fast in reverse if it may.
    ///
    /// Curvatures are the rover's limits; without `reverse` the least speed is 0.
    pub fn of(rover: &Rover, speed: f64, reverse: bool) -> Self {
        let limits = &rover.limits;
        let speed = speed.min(limits.speed);
        Self {
            speeds: [if reverse { -speed } else { 0.0 }, speed],
            acceleration: limits.acceleration,
            bounds: Curvatures { most: limits.curvature, most_rate: limits.curvature_rate },
        }
    }

    /// Its hulls for legs of `step` s.
    ///
    /// 7 speeds × 7 curvatures, 81 runs each, 120 headings.
    ///
    /// # Errors
    /// [`NoBodyHull`]: numbers that are not finite, runs that span no area.
    pub fn hull(&self, step: f64) -> Result<BodyHull, NoBodyHull> {
        let share = |i: u32| f64::from(i) / f64::from(LEVELS - 1);
        let levels = |low: f64, high: f64| (0..LEVELS).map(|i| low + (high - low) * share(i)).collect();
        let grid = BodyGrid {
            speeds: levels(self.speeds[0], self.speeds[1]),
            steerings: levels(-self.bounds.most, self.bounds.most),
            inputs: INPUTS,
            headings: HEADINGS,
            step,
            max_speed: f64::INFINITY,
        };
        BodyHull::sampled(&grid, |state, shares| self.run(step, state, shares))
    }

    /// (x, y, ψ) and (v, κ) after `step` s from the origin with (v, κ) = `state`; `shares` (0 … 1) of the inputs
    /// between their bounds.
    ///
    /// By the midpoint rule in 64 steps.
    pub fn run(&self, step: f64, state: [f64; 2], shares: [f64; 2]) -> ([f64; 3], [f64; 2]) {
        let [low, high] = self.speeds;
        let wanted = low + shares[0] * (high - low);
        let bend = (2.0 * shares[1] - 1.0) * self.bounds.most;
        let h = step / f64::from(STEPS);
        // Not clamp: without a bound of the rate, `most` of no way at all is no number, and binds nothing.
        let towards = |from: f64, to: f64, most: f64| from + (to - from).max(-most).min(most);
        let ([mut v, mut curvature], [mut x, mut y, mut yaw]) = (state, [0.0; 3]);
        for _ in 0..STEPS {
            let next = towards(v, wanted, self.acceleration * h);
            let metres = 0.5 * (v + next) * h;
            let bent = towards(curvature, bend, self.bounds.most_rate * metres.abs());
            let turn = 0.5 * (curvature + bent) * metres;
            let (sin, cos) = libm::sincos(yaw + 0.5 * turn);
            (x, y, yaw) = (x + metres * cos, y + metres * sin, yaw + turn);
            (v, curvature) = (next, bent);
        }
        ([x, y, yaw], [v, curvature])
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::feasibility::reach::{Everywhere, Reach, Sphere, StepNode, StepReach, StepSettings};
    use crate::math::fresnel::clothoid;
    use crate::math::random::hashed_unit;

    const CAR: PlanarVehicle = PlanarVehicle {
        speeds: [0.0, 2.0],
        acceleration: f64::INFINITY,
        bounds: Curvatures { most: 0.5, most_rate: f64::INFINITY },
    };

    #[test]
    fn runs_end_where_closed_forms_do() {
        // At once: an arc. The first step still turns by half of the curvature.
        let ([x, y, yaw], state) = CAR.run(2.0, [2.0, 0.5], [1.0, 1.0]);
        let (sin, cos) = 2.0_f64.sin_cos();
        assert!((x - 2.0 * sin).abs() < 2e-3 && (y - 2.0 * (1.0 - cos)).abs() < 2e-3 && (yaw - 2.0).abs() < 1e-9);
        assert_eq!(state, [2.0, 0.5]);
        // Steered over: a clothoid. In reverse: its mirror image.
        let slow = PlanarVehicle { speeds: [-2.0, 2.0], bounds: Curvatures { most: 0.5, most_rate: 0.125 }, ..CAR };
        let (expected_x, expected_y) = clothoid(0.0, 0.5, 0.125);
        for (start, share, sign) in [(2.0, 1.0, 1.0), (-2.0, 0.0, -1.0)] {
            let ([x, y, yaw], state) = slow.run(2.0, [start, 0.0], [share, 1.0]);
            assert!((x - sign * expected_x).abs() < 1e-3 && (y - expected_y).abs() < 1e-3, "{x} {y}");
            assert!((yaw - sign).abs() < 1e-9 && state == [sign * 2.0, 0.5], "{yaw} {state:?}");
        }
        // Speeding up: v²/2a, straight on.
        let heavy = PlanarVehicle { acceleration: 0.5, ..CAR };
        let ([x, y, _], [v, _]) = heavy.run(2.0, [0.0, 0.0], [1.0, 0.5]);
        assert!((x - 1.0).abs() < 1e-9 && y == 0.0 && (v - 1.0).abs() < 1e-9, "{x} {v}");
    }

    #[test]
    fn the_sets_of_a_vehicle_lie_in_one_another() {
        let at = |i: u64, k: u64| 12.0 * (hashed_unit(1, &[i, k]) - 0.5);
        let mut points = vec![Point3::origin()];
        points.extend((0..300).map(|i| Point3::new(at(i, 0), at(i, 1), 0.0)));
        let step = 2.0;
        let settings = StepSettings { step, ..StepSettings::default() };
        let successors = |legs: &dyn Fn(&mut Vec<u32>)| {
            let mut out = Vec::new();
            legs(&mut out);
            out
        };
        let (all, ball) = (Everywhere, Sphere { radius: CAR.speeds[1] * step });
        let none = successors(&|out| StepReach::new(&all, &points, settings).successors(0, 0, out));
        let sphere = successors(&|out| StepReach::new(&ball, &points, settings).successors(0, 0, out));
        let car = CAR.hull(step).unwrap();
        let mut legs = Vec::new();
        car.legs(&car.start(0.0, [2.0, 0.0]), &points, &mut legs);
        let hull: Vec<u32> = legs.iter().map(|leg| leg.waypoint).collect();
        assert!(hull.iter().all(|w| sphere.contains(w)) && sphere.iter().all(|w| none.contains(w)));
        assert!(hull.len() > 10 && 2 * hull.len() < sphere.len() && 2 * sphere.len() < none.len());
        assert!(legs.iter().all(|leg| points[leg.waypoint as usize].x >= 0.0), "nothing behind a car without reverse");
        // The sets that know no heading take the same nodes as a flyer's.
        let start = StepNode { previous: 0, current: 0 };
        let mut flown = Vec::new();
        StepReach::new(&ball, &points, settings).legs(&start, &points, &mut flown);
        assert_eq!(flown.iter().map(|leg| leg.waypoint).collect::<Vec<_>>(), sphere);
    }
}
