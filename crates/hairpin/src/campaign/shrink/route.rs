//! What candidates are: stops of the case, moved perhaps; and how they are planned anew.

use nalgebra::Point3;

use crate::campaign::kind::Replanner;
use crate::campaign::{Case, Setup};

/// One waypoint of a candidate.
///
/// `index` is what a replanner needs to pass it as the case did (heading, posture).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stop {
    /// Which waypoint of the case it was.
    pub(super) index: usize,
    /// Where it is, m.
    pub(super) at: Point3<f64>,
}

/// The waypoints of a candidate, in order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Route {
    pub(super) stops: Vec<Stop>,
    /// Waypoints at both ends that stay, as an arm's home.
    ///
    /// At each end, 0 or 1.
    ends: usize,
}

impl Route {
    /// That of `case` as it is.
    ///
    /// Of arms both homes stay.
    pub(super) fn of(case: &Case) -> Self {
        let stop = |(index, at): (usize, &Point3<f64>)| Stop { index, at: *at };
        Self {
            stops: case.waypoints.iter().enumerate().map(stop).collect(),
            ends: usize::from(case.program().is_some()),
        }
    }

    /// Places among the stops that may go.
    pub(super) fn free(&self) -> Vec<usize> {
        (self.ends..self.stops.len() - self.ends).collect()
    }

    /// The route over the stops at `places` and those that stay.
    pub(super) fn keep(&self, places: &[usize]) -> Self {
        let last = self.stops.len() - self.ends;
        let stays = |place: usize| place < self.ends || place >= last || places.contains(&place);
        let stops = self.stops.iter().enumerate().filter(|(place, _)| stays(*place)).map(|(_, stop)| *stop);
        Self { stops: stops.collect(), ends: self.ends }
    }

    /// Whether it leads anywhere: two waypoints, and one beside those that stay.
    pub(super) fn is_way(&self) -> bool {
        self.stops.len() >= 2 && self.stops.len() > 2 * self.ends
    }

    /// Whether legs may be made shorter: where waypoints are not the points of a cloud.
    pub(super) fn moves(&self) -> bool {
        self.ends == 0
    }

    fn points(&self) -> Vec<Point3<f64>> {
        self.stops.iter().map(|stop| stop.at).collect()
    }
}

/// Plans candidates by the claim that the case stands on.
pub(super) struct Planner(Box<dyn Replanner>);

impl Planner {
    /// # Errors
    /// Why nothing can be planned, in a sentence's part.
    pub(super) fn new(setup: &Setup, case: &Case) -> Result<Self, String> {
        setup.kind().replanner(case).map(Self)
    }

    /// The case along `route`, if that is feasible; `last` is the smallest so far, which needs no plan of its own.
    ///
    /// `None` where it is not feasible by the claim that the case stands on.
    pub(super) fn plan(&self, setup: &Setup, last: &Case, route: &Route) -> Option<Case> {
        let points = route.points();
        // What is left out of a scenario only makes a plan easier: it stands as it is.
        if points == last.waypoints {
            return Some(last.clone());
        }
        let indices: Vec<usize> = route.stops.iter().map(|stop| stop.index).collect();
        self.0.plan(setup.kind().same(), &indices, &points)
    }
}
