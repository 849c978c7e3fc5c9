//! Where a mission's set point is to go, and how fast: from three waypoints, the last, the next and the one after it.
//!
//! ```text
//! v at the next waypoint   min(√(P a_hor r tan(α/2)), v from which the leg after it can be braked, v_cruise)
//! v now                    min(v from which the way to the waypoint slows down to that, v_cruise)
//! ```
//!
//! α is the angle between both legs, r the acceptance radius, P `MPC_XY_TRAJ_P`. Climb and sink alike, with the
//! acceptance height and the vertical limits; then the velocity towards the waypoint is cut to the less of both.
//! While the set point flies more than 11° off the direction to its waypoint, it steers to a point on the leg 5 m ahead
//! (L1 guidance: Park, Deyst, How, AIAA GNC 2004) and gets no faster.
//!
//! A robot that has passed its waypoint flies straight back to it, one that is off its leg by more than r returns to
//! the leg at its nearest point, one that is behind the last waypoint passes that first.

use nalgebra::{Vector2, Vector3};

use super::parameters::{MPC_XY_TRAJ_P, NAV_MC_ALT_RAD};
use crate::math::jerk_limit::{AxisLimits, JerkLimited, braking_speed, corner_speed};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::controller::Reference;

/// Distance of the point on the leg that a turning set point steers to, m.
const AHEAD: f64 = 5.0;
/// Cosine of the angle from which on it turns, and the speed (m/s) from which on that counts.
///
/// acos 0.98 = 11.5°.
const TURNING: (f64, f64) = (0.98, 0.2);
/// Waypoints closer than this are one, m.
const ONE: f64 = 1e-3;
/// Below this speed (m/s) a direction is cut on its own side alone: both would stop for the other.
const CREEPING: f64 = 0.5;

/// From, to, and on to, m.
///
/// World frame. At the last waypoint `then` is `to`: nothing is turned into, and it is braked to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Triplet {
    from: Vector3<f64>,
    to: Vector3<f64>,
    then: Vector3<f64>,
}

/// Where a robot is on its leg, seen from above.
///
/// By the projection on the leg from above; heights are not looked at. Of a leg without length all is on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    OnLeg,
    /// Beyond its end.
    Past,
    /// Before its start, and out of reach of it.
    Before,
    /// Beside it, out of reach.
    Off,
}

/// The guidance of a mission.
#[derive(Debug, Clone)]
pub(super) struct Guidance {
    /// The next waypoint's number and where the robot was, as the triplet that is flown was made of them.
    ///
    /// `None` before the first turn.
    made_of: Option<(usize, Place)>,
    flown: Triplet,
    /// Horizontal speed before the turn, m/s.
    ///
    /// It bounds the speed while the set point turns, so that a turn is never taken faster than it was begun.
    before_turn: f64,
    /// Acceptance radius, m.
    reach: f64,
}

impl Guidance {
    /// Before its first turn.
    pub(super) fn new() -> Self {
        let nowhere = Triplet { from: Vector3::zeros(), to: Vector3::zeros(), then: Vector3::zeros() };
        Self { made_of: None, flown: nowhere, before_turn: 0.0, reach: 0.0 }
    }

    /// Takes note of where to go and of the robot's `position`, m.
    ///
    /// O(1). A robot that is beside its leg is led anew at each call, as its nearest point moves along.
    pub(super) fn note(&mut self, to: &Reference<Quadrotor>, position: &Vector3<f64>) {
        let last = to.waypoints.len() - 1;
        let at = |number: usize| to.waypoints[number.min(last)].coords;
        let next = to.next.min(last);
        let given = Triplet { from: at(next.saturating_sub(1)), to: at(next), then: at(next + 1) };
        self.reach = to.accept;
        let (place, nearest) = place(&given, position, self.reach);
        // What is flown round stays as it was, until the robot is somewhere else or moves along its leg.
        if self.made_of == Some((next, place)) && place != Place::Off {
            return;
        }
        self.made_of = Some((next, place));
        self.flown = match place {
            Place::OnLeg => given,
            Place::Past => Triplet { from: *position, ..given },
            Place::Before => Triplet { from: *position, to: given.from, then: given.to },
            Place::Off => Triplet { from: *position, to: nearest, then: given.to },
        };
    }

    /// The velocity that the set point `point` is to come to, m/s.
    ///
    /// `horizontal` and `vertical` bound it, with the cruise speed and the speed of climb or sink.
    ///
    /// World frame; 0 where the set point stands at its aim. Its norm is at most √(level² + upright²), both speeds
    /// within their bounds.
    pub(super) fn velocity(
        &mut self,
        point: &JerkLimited,
        horizontal: &AxisLimits,
        vertical: &AxisLimits,
    ) -> Vector3<f64> {
        let Triplet { from, to, then } = self.flown;
        let turning = self.turns(point, &to);
        let aim = if turning { ahead(&from, &to, &point.position, self.reach.max(AHEAD)) } else { to };
        let mut level = self.level_speed(&point.position, &to, &then, horizontal);
        if turning {
            level = level.min(self.before_turn);
        } else {
            self.before_turn = level;
        }
        let upright = climb_speed(&point.position, &to, &then, vertical);
        let way = aim - point.position;
        let direction = way.try_normalize(0.0).unwrap_or(Vector3::zeros());
        let wanted = direction * (level * level + upright * upright).sqrt();
        cut_vertical(&cut_level(&wanted, level), upright)
    }

    /// Whether the set point flies off the direction to `to`, which it has not reached.
    ///
    /// v·w < 0.98 |v| |w| with v the set point's velocity and w its way to the waypoint, both from above.
    fn turns(&self, point: &JerkLimited, to: &Vector3<f64>) -> bool {
        let (velocity, way) = (point.velocity.xy(), (to - point.position).xy());
        let (aligned, moving) = TURNING;
        let (speed, far) = (velocity.norm(), way.norm());
        speed > moving && far > self.reach && velocity.dot(&way) < aligned * speed * far
    }

    /// Horizontal speed now.
    ///
    /// A waypoint whose next one is within reach is passed at rest: no corner is made of it.
    fn level_speed(&self, at: &Vector3<f64>, to: &Vector3<f64>, then: &Vector3<f64>, limits: &AxisLimits) -> f64 {
        let (arriving, leaving) = ((to - at).xy(), (to - then).xy());
        let on = leaving.norm();
        let mut passing: f64 = 0.0;
        // A waypoint after it that lies in its reach is no leg to turn into.
        if on > ONE && on >= self.reach {
            let rest = braking_speed(on, 0.0, limits.acceleration, limits.jerk);
            let turn = corner_speed(cosine(&arriving, &leaving), MPC_XY_TRAJ_P * limits.acceleration, self.reach);
            passing = turn.min(rest).min(limits.speed);
        }
        braking_speed(arriving.norm(), passing, limits.acceleration, limits.jerk).min(limits.speed)
    }
}

/// Vertical speed now: as the horizontal one, of the path in height over its own length from above.
///
/// Vectors are (distance from above, height), so that the angle is that of both slopes; a climb that goes on is passed
/// at speed, a peak at rest.
fn climb_speed(at: &Vector3<f64>, to: &Vector3<f64>, then: &Vector3<f64>, limits: &AxisLimits) -> f64 {
    let mut passing: f64 = 0.0;
    if (to.z - then.z).abs() > ONE {
        let arriving = Vector2::new((to - at).xy().norm(), to.z - at.z);
        let leaving = Vector2::new(-(to - then).xy().norm(), to.z - then.z);
        let turn = corner_speed(cosine(&arriving, &leaving), limits.acceleration, NAV_MC_ALT_RAD);
        passing = turn.min(limits.speed);
    }
    braking_speed((to.z - at.z).abs(), passing, limits.acceleration, limits.jerk).min(limits.speed)
}

/// Of the angle between two vectors; 0 where one has no direction.
fn cosine(a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
    let lengths = a.norm() * b.norm();
    if lengths > 0.0 { (a.dot(b) / lengths).clamp(-1.0, 1.0) } else { 0.0 }
}

/// The point of the leg's line that is `far` m from `at`, ahead; the nearest one where the line is farther.
///
/// With d the distance of `at` from the line: nearest + û √(max(0, far² − d²)). Of a leg without length its start.
fn ahead(from: &Vector3<f64>, to: &Vector3<f64>, at: &Vector3<f64>, far: f64) -> Vector3<f64> {
    let along = (to - from).try_normalize(0.0).unwrap_or(Vector3::zeros());
    let nearest = from + along * (at - from).dot(&along);
    let aside = (nearest - at).norm_squared();
    nearest + along * (far * far - aside).max(0.0).sqrt()
}

/// Where `position` is on the leg of `given`, and the leg's nearest point, at the height of its end.
///
/// Margins of `reach` (m) at the start and aside, none at the end: who has passed the end is past it at once.
fn place(given: &Triplet, position: &Vector3<f64>, reach: f64) -> (Place, Vector3<f64>) {
    let along = (given.to - given.from).xy().try_normalize(1e-9).unwrap_or(Vector2::zeros());
    let (come, left) = ((position - given.from).xy(), (given.to - position).xy());
    let nearest = given.from.xy() + along * come.dot(&along);
    let place = if along == Vector2::zeros() {
        Place::OnLeg
    } else if along.dot(&left) < 0.0 {
        Place::Past
    } else if along.dot(&come) < 0.0 && come.norm() > reach {
        Place::Before
    } else if (position.xy() - nearest).norm() > reach {
        Place::Off
    } else {
        Place::OnLeg
    };
    (place, Vector3::new(nearest.x, nearest.y, given.to.z))
}

/// `v` no faster than `most` m/s from above, its direction kept unless both creep.
///
/// Below 0.5 m/s, asked and allowed, the vertical part is left alone.
fn cut_level(v: &Vector3<f64>, most: f64) -> Vector3<f64> {
    let speed = v.xy().norm();
    if speed <= most {
        return *v;
    }
    let share = most / speed;
    let vertical = if most < CREEPING && speed < CREEPING { 1.0 } else { share };
    Vector3::new(v.x * share, v.y * share, v.z * vertical)
}

/// The same of climb and sink.
fn cut_vertical(v: &Vector3<f64>, most: f64) -> Vector3<f64> {
    let speed = v.z.abs();
    if speed <= most {
        return *v;
    }
    let share = most / speed;
    let level = if most < CREEPING && speed < CREEPING { 1.0 } else { share };
    Vector3::new(v.x * level, v.y * level, v.z * share)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use nalgebra::Point3;

    fn leg() -> Triplet {
        let then = Vector3::new(10.0, 10.0, 5.0);
        Triplet { from: Vector3::new(0.0, 0.0, 5.0), to: Vector3::new(10.0, 0.0, 5.0), then }
    }

    #[test]
    fn a_robot_is_on_its_leg_or_beside_it_or_beyond_its_ends() {
        for (at, expected, nearest) in [
            ([4.0, 0.9, 2.0], Place::OnLeg, 4.0),
            ([4.0, -1.1, 5.0], Place::Off, 4.0),
            ([10.5, 0.0, 5.0], Place::Past, 10.5),
            ([-0.5, 0.0, 5.0], Place::OnLeg, -0.5),
            ([-1.5, 0.0, 5.0], Place::Before, -1.5),
        ] {
            let (place, point) = place(&leg(), &Vector3::from(at), 1.0);
            assert_eq!((place, point), (expected, Vector3::new(nearest, 0.0, 5.0)), "{at:?}");
        }
    }

    #[test]
    fn who_left_the_leg_goes_back_to_it_and_who_passed_the_waypoint_to_that() {
        let waypoints = [[0.0, 0.0, 5.0], [10.0, 0.0, 5.0], [10.0, 10.0, 5.0]].map(Point3::from);
        let to = Reference { waypoints: &waypoints, next: 1, accept: 1.0, plan: None };
        let mut guidance = Guidance::new();
        let mut flown = |at: [f64; 3]| {
            guidance.note(&to, &Vector3::from(at));
            guidance.flown
        };
        assert_eq!(flown([3.0, 0.2, 5.0]), leg());
        let off = flown([4.0, 2.0, 4.0]);
        assert_eq!((off.to, off.then), (Vector3::new(4.0, 0.0, 5.0), leg().to));
        let past = flown([11.5, 0.5, 5.0]);
        assert_eq!((past.from, past.to, past.then), (Vector3::new(11.5, 0.5, 5.0), leg().to, leg().then));
        // What is flown round is kept while it is flown.
        assert_eq!(flown([12.0, 0.5, 5.0]).from, past.from);
        let before = flown([-2.0, 0.0, 5.0]);
        assert_eq!((before.to, before.then), (leg().from, leg().to));
    }

    #[test]
    fn a_turning_set_point_aims_at_its_leg_5_m_ahead() {
        let aim = ahead(&leg().from, &leg().to, &Vector3::new(2.0, 3.0, 5.0), 5.0);
        assert!((aim - Vector3::new(6.0, 0.0, 5.0)).norm() < 1e-12, "{aim}");
        // Farther off than that it takes the shortest way.
        let aim = ahead(&leg().from, &leg().to, &Vector3::new(2.0, 7.0, 5.0), 5.0);
        assert!((aim - Vector3::new(2.0, 0.0, 5.0)).norm() < 1e-12, "{aim}");
    }

    /// Level flight climbs nowhere, a straight climb passes its waypoint, a peak is passed at rest in height.
    #[test]
    fn climbing_through_a_waypoint_depends_on_the_slope_after_it() {
        let limits = AxisLimits { speed: 3.0, acceleration: 4.0, jerk: 4.0 };
        let (at, to) = (Vector3::new(0.0, 0.0, 0.0), Vector3::new(6.0, 0.0, 3.0));
        let speed = |then: [f64; 3], at: Vector3<f64>| climb_speed(&at, &to, &Vector3::from(then), &limits);
        let close = to - Vector3::new(0.2, 0.0, 0.1);
        let on = speed([12.0, 0.0, 6.0], close);
        let level = speed([12.0, 0.0, 3.0], close);
        let back = speed([0.0, 0.0, 0.0], close);
        assert!(on > 2.2 && level < 0.1 && back < on, "{on} {level} {back}");
        assert!((level - braking_speed(0.1, 0.0, 4.0, 4.0)).abs() < 1e-12);
        assert!(speed([12.0, 0.0, 6.0], at) <= 3.0);
    }

    #[test]
    fn a_velocity_is_cut_along_itself_unless_it_creeps() {
        let v = Vector3::new(3.0, 4.0, 2.0);
        assert_eq!(cut_level(&v, 2.5), v * 0.5);
        assert_eq!(cut_vertical(&v, 1.0), v * 0.5);
        assert_eq!(cut_level(&v, 6.0), v);
        assert_eq!(cut_level(&Vector3::new(0.4, 0.0, 2.0), 0.1), Vector3::new(0.1, 0.0, 2.0));
    }
}
