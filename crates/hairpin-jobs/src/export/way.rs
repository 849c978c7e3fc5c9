//! How a vehicle comes to the first waypoint of a case and back from the last one: what a campaign does not fly, and an
//! autopilot does.

use hairpin::campaign::kind::{Returning, Room};
use hairpin::campaign::{Case, Setup};
use nalgebra::Point3;

use crate::Problem;

/// Nearer than this to an obstacle a way is not clear, m.
const LEAST: f64 = 0.01;

/// Where a case begins and ends on the ground, and what lies between that and its waypoints.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Way {
    /// On the ground below the first waypoint; of what does not fly the waypoint itself.
    pub(super) home: Point3<f64>,
    /// Waypoints after the last one; none of what does not fly.
    pub(super) back: Vec<Point3<f64>>,
    /// Where it lands, on the ground; `None` of what does not fly.
    pub(super) land: Option<Point3<f64>>,
    /// What stands in the way, in a sentence's part.
    pub(super) blocked: Option<&'static str>,
}

impl Way {
    /// That of `case`: back over home at the least of a few heights at which nothing stands in the way, else down
    /// from the last waypoint.
    pub(super) fn of(setup: &Setup, room: &Room, case: &Case) -> Result<Self, Problem> {
        let (Some(start), Some(end)) = (case.waypoints.first(), case.waypoints.last()) else {
            return Err(Problem::input(format!("case {} has no waypoints", case.id())));
        };
        if !room.flies {
            return Ok(Self { home: *start, back: Vec::new(), land: None, blocked: None });
        }
        let around = setup.around(case)?;
        let is_clear = |chain: &[Point3<f64>]| chain.windows(2).all(|pair| is_clear(&around, &pair[0], &pair[1]));
        let ground = |place: &Point3<f64>| Point3::new(place.x, place.y, room.low.z);
        let home = ground(start);
        if !is_clear(&[home, *start]) {
            let way = Self { home, back: Vec::new(), land: Some(ground(end)), blocked: None };
            return Ok(Self { blocked: Some("an obstacle stands in the way of take-off"), ..way });
        }
        let most = case.waypoints.iter().map(|place| place.z).fold(room.low.z, f64::max);
        let highest = (room.high.z - room.margin).max(most);
        for height in [end.z, start.z, most, highest] {
            let over = |place: &Point3<f64>| Point3::new(place.x, place.y, height);
            let back = if height == end.z { vec![over(&home)] } else { vec![over(end), over(&home)] };
            let chain: Vec<Point3<f64>> = std::iter::once(*end).chain(back.clone()).chain([home]).collect();
            if is_clear(&chain) {
                return Ok(Self { home, back, land: Some(home), blocked: None });
            }
        }
        let below = ground(end);
        let blocked =
            (!is_clear(&[*end, below])).then_some("obstacles stand in every way home, and below the last waypoint");
        Ok(Self { home, back: Vec::new(), land: Some(below), blocked })
    }

    /// At which height (m, world frame) a return that begins anywhere from take-off to landing clears all obstacles, or
    /// why at none; `None` of what does not fly.
    pub(super) fn return_height(
        &self,
        setup: &Setup,
        room: &Room,
        case: &Case,
    ) -> Result<Option<Result<f64, &'static str>>, Problem> {
        let way: Vec<Point3<f64>> = case.waypoints.iter().chain(&self.back).copied().collect();
        let most = (room.high.z - room.margin).max(self.home.z);
        let highest = way.iter().map(|place| place.z).fold(self.home.z, f64::max);
        let heights = [highest.min(most), most];
        Ok(setup.around(case)?.homeward(&Returning { way: &way, home: self.home, heights, apart: LEAST }))
    }

    /// The places of take-off and of the way home, in words.
    pub(super) fn places(&self) -> impl Iterator<Item = (&'static str, Point3<f64>)> {
        let back = self.back.iter().map(|place| ("the way home", *place));
        std::iter::once(("take-off", self.home)).chain(back).chain(self.land.map(|place| ("the landing", place)))
    }
}

/// Whether the robot touches nothing on a straight way: from each place it goes as far as nothing is near.
fn is_clear(setup: &Setup, from: &Point3<f64>, to: &Point3<f64>) -> bool {
    let way = to - from;
    let length = way.norm();
    let mut gone = 0.0;
    while gone < length {
        let clearance = setup.clearance_at(&(from + way * (gone / length)));
        if clearance <= LEAST || clearance.is_nan() {
            return false;
        }
        gone += clearance;
    }
    setup.clearance_at(to) > LEAST
}
