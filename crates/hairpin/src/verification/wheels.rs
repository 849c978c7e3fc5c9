//! What the wheels of a drive do, asked of its commands and of how the body rests: steer angles, their rates, rolling
//! speeds and how fast these change.
//!
//! A wheel at (x, y) from the commanded point of the body moves by (a, l) for a metre in the direction γ with the
//! curvature κ, and its motion changes by (a′, l′) with the metre:
//!
//! ```text
//! a = cos γ − κ y                          l = sin γ + κ x
//! a′ = −sin γ γ′ − κ′ y − κ y′             l′ = cos γ γ′ + κ′ x + κ x′
//! δ = atan2(l, a) (mod π)                  δ̇ = v (a l′ − l a′)/n²,   n² = a² + l²
//! ω = v n/r                                ω̇ = (v² (a a′ + l l′)/n + v̇ n)/r
//! ```
//!
//! Of a wheel that does not steer n is a. γ, κ and their slopes are the commands', x′ and y′ follow from how the joints
//! change from look to look, v and v̇ from the commanded speeds. Claims take differences of angles from step to step;
//! here there are none.

use std::f64::consts::PI;

use super::course::Course;
use super::drive::DrivePiece;
use super::held_wheels::SteeredWheels;
use super::peak::largest;
use super::posed::Stand;
use super::stand::Rest;

/// The largest that wheels come to along a drive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelExtremes {
    /// |steer angle|, rad.
    pub steer: f64,
    /// Its rate, rad/s.
    pub steer_rate: f64,
    /// |rolling speed|, rad/s.
    pub speed: f64,
    /// Its change, rad/s².
    pub acceleration: f64,
    /// Radians that a wheel rolls for each that the body turns in place.
    pub spin: f64,
    /// Of each wheel the steer angle of the last place of this stretch, and the least and the largest of the stretch,
    /// rad, as they go on from the first.
    swept: [[f64; 3]; 6],
    /// Gear of the stretch; 0: a turn in place, or none yet.
    gear: f64,
}

/// Wheels of one axle differ in x by less, m.
const AXLE: f64 = 1e-3;
/// Slopes of what is steered are taken over so many metres to either side.
const SLOPE: f64 = 1e-4;

/// A place of a piece, and how the body rests there.
pub(super) struct At<'a> {
    /// Metres or radians of the piece.
    pub(super) s: f64,
    pub(super) rest: &'a Rest,
    /// Rests before and behind, with their places: the joints' slopes.
    pub(super) around: [(f64, &'a Rest); 2],
}

impl WheelExtremes {
    /// Adds a place of `course`.
    pub(super) fn add(&mut self, course: &Course<'_>, at: &At<'_>) {
        let Some(held) = &course.vehicle.wheels else { return };
        let stand = &course.vehicle.stand;
        let Some(body) = Placed::new(stand, &held.steered) else { return };
        let places = at.rest.wheels(stand);
        let gear = match course.piece {
            DrivePiece::Arc { direction, .. } => *direction,
            DrivePiece::Turn { .. } => 0.0,
        };
        let begins = gear == 0.0 || gear != self.gear;
        self.gear = gear;
        let [(from, first), (to, last)] = at.around;
        let (before, behind) = (first.wheels(stand), last.wheels(stand));
        for i in 0..body.count {
            let place = body.seen(&held.steered, places[i]);
            let [x, y] = place;
            let moved = [before[i], behind[i]].map(|place| body.seen(&held.steered, place));
            let slope = |axis: usize| if to == from { 0.0 } else { (moved[1][axis] - moved[0][axis]) / (to - from) };
            let steers = body.steers[i];
            let (motion, change) = match course.piece {
                DrivePiece::Turn { .. } => ([-y, x], [0.0; 2]),
                DrivePiece::Arc { .. } => {
                    let [(k0, g0), (k, g), (k1, g1)] =
                        [at.s - SLOPE, at.s, at.s + SLOPE].map(|s| (course.steered(s), course.crab(s)));
                    let [bends, turns] = [(k1 - k0) / (2.0 * SLOPE), (g1 - g0) / (2.0 * SLOPE)];
                    let (sin, cos) = libm::sincos(g);
                    let motion = [cos - k * y, sin + k * x];
                    let ahead = -sin * turns - bends * y - k * slope(1);
                    (motion, [ahead, cos * turns + bends * x + k * slope(0)])
                }
            };
            self.wheel(i, (motion, change), (steers, begins), course, at.s);
        }
    }

    /// Adds what wheel `i` does, of which `begins` tells whether its angle goes on from nothing.
    fn wheel(
        &mut self,
        i: usize,
        ([a, l], [da, dl]): ([f64; 2], [f64; 2]),
        (steers, begins): (bool, bool),
        course: &Course<'_>,
        s: f64,
    ) {
        let rolls = if steers { libm::hypot(a, l) } else { a.abs() };
        if steers && rolls > 1e-12 {
            let angle = libm::atan2(l, a);
            let [last, least, most] = self.swept[i];
            // An axle has no front: of all angles the one nearest to where the wheel stood, or to straight ahead.
            let from = if begins { 0.0 } else { last };
            let steer = angle - PI * ((angle - from) / PI).round();
            let [least, most] = if begins { [steer; 2] } else { [least.min(steer), most.max(steer)] };
            self.swept[i] = [steer, least, most];
            let turned = [-PI, 0.0, PI].map(|by| (least + by).abs().max((most + by).abs()));
            self.steer = largest(self.steer, turned.into_iter().fold(f64::INFINITY, f64::min));
        } else if rolls.is_nan() {
            self.steer = f64::NAN;
        }
        let radius = course.vehicle.stand.radius();
        if matches!(course.piece, DrivePiece::Turn { .. }) {
            self.spin = largest(self.spin, rolls / radius);
            return;
        }
        let [v, gains] = course.speed(s);
        self.speed = largest(self.speed, rolls * v / radius);
        let slope = if !steers {
            da
        } else if rolls > 0.0 {
            self.steer_rate = largest(self.steer_rate, ((a * dl - l * da) / (rolls * rolls) * v).abs());
            (a * da + l * dl) / rolls
        } else {
            0.0
        };
        self.acceleration = largest(self.acceleration, ((slope * v * v + rolls * gains) / radius).abs());
    }
}

/// The wheels as they are built.
struct Placed {
    count: usize,
    steers: [bool; 6],
    /// x of the point that is commanded, m.
    point: f64,
}

impl Placed {
    /// `None` of what has no wheels.
    fn new(stand: &Stand, steered: &SteeredWheels) -> Option<Self> {
        let (places, count) = stand.wheels();
        let places = &places[..count];
        let front = places.iter().map(|place| place[0]).reduce(f64::max)? - AXLE;
        let rear = places.iter().map(|place| place[0]).reduce(f64::min)? + AXLE;
        let mut steers = [false; 6];
        for (steers, [x, _]) in steers.iter_mut().zip(places) {
            *steers = match steered {
                SteeredWheels::Corners => *x >= front || *x <= rear,
                SteeredWheels::Front => *x >= front,
                SteeredWheels::All => true,
                SteeredWheels::Skid(_) => false,
            };
        }
        let fixed: Vec<f64> = places.iter().zip(&steers).filter(|(_, steers)| !**steers).map(|(p, _)| p[0]).collect();
        let point = match steered {
            SteeredWheels::Front if !fixed.is_empty() => fixed.iter().sum::<f64>() / fixed.len() as f64,
            _ => 0.0,
        };
        Some(Self { count, steers, point })
    }

    /// Where a wheel seems to be from the point that is commanded.
    fn seen(&self, steered: &SteeredWheels, [x, y]: [f64; 2]) -> [f64; 2] {
        let y = match steered {
            SteeredWheels::Skid(track) => (0.5 * track).copysign(y),
            _ => y,
        };
        [x - self.point, y]
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::verification::{GroundClaim, GroundVehicle, HeldWheels, replay_ground};
    use crate::world::terrain::Flat;

    const FREE: HeldWheels = HeldWheels {
        steered: SteeredWheels::Corners,
        steer_rad: 1.0,
        steer_rate_rad_s: 1.0,
        speed_rad_s: 10.0,
        acceleration_rad_s2: 1.0,
    };
    /// Places of the wheels, and their radius, m.
    const PLACES: [[f64; 2]; 4] = [[0.3, 0.25], [0.3, -0.25], [-0.3, 0.25], [-0.3, -0.25]];
    const RADIUS: f64 = 0.1;

    /// What the wheels of a level vehicle come to along `pieces`, by v² linear between `speed`.
    fn extremes(
        pieces: &[DrivePiece],
        steered: SteeredWheels,
        speed: &[[f64; 2]],
        (start_curvature, [crab, crab_rate]): (f64, [f64; 2]),
    ) -> WheelExtremes {
        let wheels = PLACES.map(|[x, y]| Vector3::new(x, y, 0.0));
        let stand = Stand::FourWheel { wheels, radius: RADIUS };
        let vehicle = GroundVehicle { stand, wheels: Some(HeldWheels { steered, ..FREE }), ..GroundVehicle::LEVEL };
        let claim = GroundClaim {
            start: [0.0; 3],
            start_curvature,
            crab,
            crab_rate,
            speed: speed.to_vec(),
            end: [0.0; 3],
            end_curvature: 0.0,
        };
        replay_ground(pieces, &vehicle, &Flat, &claim).expect("level ground").wheels
    }

    fn near(found: f64, wanted: f64) {
        assert!((found - wanted).abs() < 1e-6 * wanted.abs().max(1.0), "{found}, not {wanted}");
    }

    #[test]
    fn wheels_of_a_circle_are_ackermanns() {
        let circle = [DrivePiece::Arc { length_m: 2.0, curvature: [0.5, 0.0, 0.0, 0.0, 0.0, 0.0], direction: 1.0 }];
        let found = extremes(&circle, SteeredWheels::Corners, &[[0.0, 0.4]], (0.5, [0.0; 2]));
        // The inner wheel by atan(κ x/(1 − κ y)), the outer one by √((1 + κ y)² + κ² x²) v/r.
        near(found.steer, libm::atan(0.15 / 0.875));
        near(found.speed, libm::hypot(1.125, 0.15) * 4.0);
        assert!(found.steer_rate < 1e-6 && found.acceleration < 1e-6, "{found:?}");
        // About the rear axle the front wheels stand twice as far ahead; those of skidding vehicles do not steer.
        near(extremes(&circle, SteeredWheels::Front, &[[0.0, 0.4]], (0.5, [0.0; 2])).steer, libm::atan(0.3 / 0.875));
        let skid = extremes(&circle, SteeredWheels::Skid(0.8), &[[0.0, 0.4]], (0.5, [0.0; 2]));
        assert!(skid.steer == 0.0 && (skid.speed - 1.2 * 4.0).abs() < 1e-6, "{skid:?}");
        // In reverse the same, at as much.
        let back = [DrivePiece::Arc { length_m: 2.0, curvature: [0.5, 0.0, 0.0, 0.0, 0.0, 0.0], direction: -1.0 }];
        near(extremes(&back, SteeredWheels::Corners, &[[0.0, 0.4]], (0.5, [0.0; 2])).steer, found.steer);
    }

    /// Of a clothoid that is sped up along, by differences in time that are as fine as can be.
    #[test]
    fn rates_are_those_of_differences() {
        let clothoid = [DrivePiece::Arc { length_m: 1.5, curvature: [0.1, 0.6, 0.0, 0.0, 0.0, 0.0], direction: 1.0 }];
        let speed = [[0.0, 0.2], [1.5, 0.8]];
        for (steered, crab) in [(SteeredWheels::Corners, [0.0; 2]), (SteeredWheels::All, [0.2, 0.3])] {
            let found = extremes(&clothoid, steered, &speed, (0.1, crab));
            let v = |s: f64| (0.04 + (0.64 - 0.04) * s / 1.5).sqrt();
            let state = |s: f64, [x, y]: [f64; 2]| {
                let (kappa, (sin, cos)) = (0.1 + 0.6 * s, libm::sincos(crab[0] + crab[1] * s));
                let (a, l) = (cos - kappa * y, sin + kappa * x);
                [libm::atan2(l, a), libm::hypot(a, l) * v(s) / RADIUS]
            };
            let (mut rate, mut change) = (0.0_f64, 0.0_f64);
            for place in PLACES {
                for i in 0..3000 {
                    let (s, h) = (1.5 * (f64::from(i) + 0.5) / 3000.0, 1e-6);
                    let [before, behind] = [state(s - h, place), state(s + h, place)];
                    rate = rate.max((behind[0] - before[0]).abs() / (2.0 * h) * v(s));
                    change = change.max((behind[1] - before[1]).abs() / (2.0 * h) * v(s));
                }
            }
            assert!((found.steer_rate / rate - 1.0).abs() < 2e-3, "{found:?}: {rate}");
            assert!((found.acceleration / change - 1.0).abs() < 2e-3, "{found:?}: {change}");
        }
    }

    #[test]
    fn turned_in_place_wheels_are_tangent_and_what_is_no_number_is_told() {
        let turn = [DrivePiece::Turn { angle_rad: 1.0 }];
        let found = extremes(&turn, SteeredWheels::All, &[[0.0, 0.4]], (0.0, [0.0; 2]));
        near(found.steer, libm::atan2(0.3, 0.25));
        near(found.spin, libm::hypot(0.3, 0.25) / RADIUS);
        assert_eq!((found.speed, found.steer_rate), (0.0, 0.0));
        let line = [DrivePiece::Arc { length_m: 1.0, curvature: [0.0; 6], direction: 1.0 }];
        let still = extremes(&line, SteeredWheels::All, &[], (0.0, [0.0; 2]));
        assert!(still.speed.is_nan(), "{still:?}");
        // Crabbing beyond a right angle the wheels go on, by more than a quarter.
        let swing = extremes(&line, SteeredWheels::All, &[[0.0, 0.4]], (0.0, [1.2, 0.6]));
        near(swing.steer, 1.8);
    }
}
