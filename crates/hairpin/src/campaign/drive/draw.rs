//! Feasible drives drawn at random, one at a time: nobody builds a graph for them.

use nalgebra::Point3;

use super::solve::DriveSolver;
use super::walking::Walking;
use crate::campaign::graph::Plan;
use crate::campaign::{Evidence, SeenLeg, Stop};
use crate::feasibility::reach::DriveNode;
use crate::math::random::{Stream, named_seed, stream, unit};
use crate::search::{NoWalk, stroll};

/// Sets of waypoints that are tried for one drive.
/// Drive k asks for sets 6k … 6k + 5, so that no two drives share waypoints.
///
/// Numbers wrap at 2⁶⁴, so that every number has a drive to ask for.
const SETS: u64 = 6;
/// Stream of the waypoints of a drive.
const WAYPOINTS: &str = "drawn waypoints";

impl DriveSolver<'_> {
    /// Feasible drive number `number`: waypoints spread as those of a graph are, by streams of its own, and a random
    /// walk over them. Where it stands every headed waypoint that a leg leads to, and that has not come yet unless
    /// waypoints may come twice, is the next one alike; where that leads no further the walk takes it back.
    ///
    /// So drives are not alike, as those of the method `uniform` are within a graph: those through waypoints with few
    /// ways on come more often. At most 40 legs for each of a drive's are solved before other waypoints are drawn, six
    /// times.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part.
    ///
    /// Deterministic in the number and the scenario's seed, on any thread. The reason that is told is that of the last
    /// set.
    pub(super) fn drawn(&self, number: u64, stop: &Stop) -> Result<Plan, String> {
        let (task, root) = (&self.setup.scenario.task, self.setup.scenario.seed);
        let mut reason = String::new();
        for set in number.wrapping_mul(SETS)..number.wrapping_mul(SETS).wrapping_add(SETS) {
            if (stop.cancelled)() {
                return Err("the drawing was stopped".into());
            }
            let seed = |label| named_seed(root, label, set);
            let points = self.sample(seed(WAYPOINTS), stop.cancelled)?;
            let walking = Walking {
                length: task.length as usize,
                end: task.end_m.map(|_| points.len() as u32 - 1),
                revisits: self.search.revisits,
            };
            let mut random = stream(seed("drawn drive"));
            let found = match &self.stepwise {
                Some(stepwise) => stepwise.drawn(&points, &walking, &mut random),
                None => self.driven(seed("drawn headings"), &points, &walking, &mut random, stop),
            };
            match found {
                Ok(plan) => return Ok(plan),
                Err(why) => reason = why,
            }
        }
        Err(format!("none in {SETS} draws of {} waypoints: {reason}", self.search.waypoints))
    }

    /// A waypoint of those that drive number `number` was drawn from, all free ones alike.
    ///
    /// m, on the ground. `None` where there is none.
    pub(super) fn place_of(&self, number: u64, random: &mut Stream) -> Option<Point3<f64>> {
        let seed = named_seed(self.setup.scenario.seed, WAYPOINTS, number.wrapping_mul(SETS));
        let points = self.sample(seed, &|| false).ok()?;
        let end = usize::from(self.setup.scenario.task.end_m.is_some());
        let free = points.get(1..points.len() - end)?;
        free.get((unit(random) * free.len() as f64) as usize).copied()
    }

    /// A walk over the headed waypoints at `points`; of its legs only those that it asks for are solved.
    ///
    /// Nodes are waypoints with headings; each leg that the walk asks for is a boundary-value drive on the map, and
    /// refusals are counted by reason.
    ///
    /// A leg once solved is kept by the roadmap, so that a walk that comes back asks for nothing twice. Once it is
    /// stopped every further leg counts as none.
    fn driven(
        &self,
        seed: u64,
        points: &[Point3<f64>],
        walking: &Walking,
        random: &mut Stream,
        stop: &Stop,
    ) -> Result<Plan, String> {
        let roadmap = self.roadmap(seed, points);
        let next = |walk: &[DriveNode]| {
            let Some(here) = walk.last() else { return Vec::new() };
            let left = walking.length - walk.len() - 1;
            let may_follow = |to: &DriveNode| {
                walking.may_follow(walk.iter().map(|node| node.waypoint), to.waypoint)
                    && (walking.end.is_none() || roadmap.may_arrive(to, left))
            };
            roadmap.near(here).into_iter().filter(may_follow).collect()
        };
        let step = |from: &DriveNode, to: &DriveNode| !(stop.cancelled)() && roadmap.leg(from, to).is_some();
        let why = |none| match none {
            NoWalk::None => format!("every walk ends too early, {}", roadmap.tally()),
            NoWalk::Asked(most) => format!("{most} legs asked for, {}", roadmap.tally()),
        };
        let nodes = stroll(roadmap.start(), walking.length, next, step, walking.most(), random).map_err(why)?;
        let leg = |pair: &[DriveNode]| {
            let leg = roadmap.leg(&pair[0], &pair[1])?;
            Some(SeenLeg { features: leg.features, duration: leg.duration })
        };
        let drive = roadmap.drive(&nodes).ok_or("its commands fit no speeds")?;
        Ok(Plan {
            waypoints: nodes.iter().map(|node| points[node.waypoint as usize]).collect(),
            leg_times: (0..drive.legs.len()).map(|leg| drive.leg_time(leg)).collect(),
            seen: nodes.windows(2).filter_map(leg).collect(),
            score: 0.0,
            bound: None,
            evidence: Evidence::Witnessed,
            certified: None,
            witness: Some(drive.into()),
            environment: None,
        })
    }
}
