//! How far along its course a run is: which waypoints were reached, which leg is being flown, when it is over.

use nalgebra::{Point3, Vector3};

use super::controller::{Acceptance, Controlled, Reference, Schedule};
use crate::trajectory::Ended;

/// Progress along waypoints, both ends included.
///
/// A controller that flies from waypoint to waypoint has its next one once it is inside the acceptance radius, in
/// order; the leg being flown is the one that ends there. A controller that tracks a timed reference flies the
/// reference's leg, whether or not it came near the waypoint: being late is what it is judged for. A waypoint is then
/// reached if the robot comes inside the radius while one of its two legs is flown, and the run is over once the
/// reference is over and the last waypoint reached; it ends `time` instead of `done` if any waypoint was missed.
///
/// A course that is open has no end yet: at its last waypoint it halts, until there is another one or it is closed.
#[derive(Debug, Clone)]
pub(crate) struct Course {
    waypoints: Vec<Point3<f64>>,
    open: bool,
    accept: f64,
    acceptance: Acceptance,
    next: usize,
    leg: usize,
    reached: Vec<Option<f64>>,
    over: Option<f64>,
}

impl Course {
    /// At the start, the first waypoint reached at t = 0.
    pub(crate) fn new(waypoints: &[Point3<f64>], accept: f64) -> Self {
        let mut reached = vec![None; waypoints.len()];
        reached[0] = Some(0.0);
        let acceptance = Acceptance::Sphere;
        Self { waypoints: waypoints.to_vec(), open: false, accept, acceptance, next: 1, leg: 0, reached, over: None }
    }

    /// At `start`, where to go from there not known yet.
    pub(crate) fn open(start: Point3<f64>, accept: f64) -> Self {
        Self { open: true, ..Self::new(&[start], accept) }
    }

    /// Waypoints count as reached as the controller has it, from now on.
    pub(crate) fn accept_as(&mut self, acceptance: Acceptance) {
        self.acceptance = acceptance;
    }

    /// Goes on to `waypoint`.
    pub(crate) fn extend(&mut self, waypoint: Point3<f64>) {
        self.waypoints.push(waypoint);
        self.reached.push(None);
    }

    /// Number of waypoints.
    pub(crate) fn waypoints(&self) -> usize {
        self.waypoints.len()
    }

    /// Ends at the last waypoint.
    pub(crate) fn close(&mut self) {
        self.open = false;
    }

    /// Whether every waypoint of an open course was reached.
    pub(crate) fn halts(&self) -> bool {
        self.open && self.next == self.waypoints.len()
    }

    /// Takes note of the position at `t`.
    ///
    /// `t` in s and never falling, `position` in m. Without a schedule several waypoints may be reached at one look, in
    /// order.
    pub(crate) fn note(&mut self, t: f64, position: &Vector3<f64>, schedule: Option<Schedule>) {
        let last = self.waypoints.len() - 1;
        match schedule {
            None => {
                while self.next <= last && self.within(self.next, position) {
                    self.reached[self.next] = Some(t);
                    self.next += 1;
                }
                self.leg = (self.next - 1).min(last - 1);
            }
            Some(schedule) => {
                self.leg = schedule.leg.min(last - 1);
                for k in self.leg..=self.leg + 1 {
                    if self.reached[k].is_none() && self.within(k, position) {
                        self.reached[k] = Some(t);
                    }
                }
                self.next = if schedule.over && self.reached[last].is_some() { last + 1 } else { self.leg + 1 };
            }
        }
        if self.next > last && !self.open && self.over.is_none() {
            self.over = Some(t);
        }
    }

    /// Whether waypoint k is no farther than the acceptance radius, in space or from above within a height.
    fn within(&self, k: usize, position: &Vector3<f64>) -> bool {
        let away = self.waypoints[k].coords - position;
        let squared = self.accept * self.accept;
        match self.acceptance {
            Acceptance::Sphere => away.norm_squared() <= squared,
            Acceptance::Cylinder { height } => away.xy().norm_squared() <= squared && away.z.abs() <= height,
        }
    }

    /// The leg being flown; after the last waypoint, the last.
    pub(crate) fn leg(&self) -> usize {
        self.leg
    }

    /// Where to go, by `plan` where there is one.
    pub(crate) fn reference<'a, R: Controlled>(&'a self, plan: Option<&'a R::Plan>) -> Reference<'a, R> {
        Reference { waypoints: &self.waypoints, next: self.next, accept: self.accept, plan }
    }

    /// When the course was over, s.
    pub(crate) fn over(&self) -> Option<f64> {
        self.over
    }

    /// The reason of a run that ends because its course is over.
    pub(crate) fn outcome(&self) -> Ended {
        if self.reached.iter().all(Option::is_some) { Ended::Done } else { Ended::Time }
    }

    /// When each waypoint was reached.
    pub(crate) fn into_reached(self) -> Vec<Option<f64>> {
        self.reached
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_is_wider_than_a_ball_at_its_edge_and_lower_at_its_top() {
        let waypoints = [Point3::origin(), Point3::new(10.0, 0.0, 5.0)];
        let reached = |acceptance, at: [f64; 3]| {
            let mut course = Course::new(&waypoints, 1.0);
            course.accept_as(acceptance);
            course.note(1.0, &Vector3::from(at), None);
            course.over().is_some()
        };
        let cylinder = Acceptance::Cylinder { height: 0.8 };
        for (at, in_ball, in_cylinder) in [
            ([9.05, 0.0, 5.75], false, true),
            ([9.05, 0.0, 4.25], false, true),
            ([10.0, 0.0, 5.9], true, false),
            ([10.0, 1.0, 5.0], true, true),
            ([10.0, 1.01, 5.0], false, false),
        ] {
            assert_eq!((reached(Acceptance::Sphere, at), reached(cylinder, at)), (in_ball, in_cylinder), "{at:?}");
        }
    }
}
