//! What would help where a question has no answer, or one that goes a long way round.

use hairpin::campaign::drive::Site;
use hairpin::feasibility::steering::shooting::flat;
use hairpin::feasibility::steering::shooting::nearest::{direct_arc, nearest};
use hairpin::feasibility::steering::shooting::query::{Goal, Query};
use hairpin::feasibility::steering::shooting::rough::Steps;
use hairpin::feasibility::steering::shooting::solve::{Choices, least_length};
use hairpin::feasibility::steering::shooting::{Control, flat::Settings};
use hairpin::trajectory::drive::Planar;
use hairpin_formats::steering::{Asked, Status};

use super::answered::Answered;
use super::pace::{direction, start};
use super::plane::hazards;
use super::question::seen_from;
use super::solver::Solver;
use super::vehicle::{Vehicle, query};

/// What would do it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Remedies {
    /// Metres with changes of direction, where they are not allowed.
    pub with_reversals_m: Option<f64>,
    /// Metres with turns in place, where they are not allowed.
    pub with_turns_m: Option<f64>,
    /// The nearest goal from the start (x, y, yaw, curvature) that one arc leads to without a loop.
    pub nearest: Option<[f64; 4]>,
    /// Where the ground stops it: metres driven before, and the last place of rest, on the map.
    pub standstill: Option<(f64, Planar)>,
    /// The farthest goal that is feasible on the way there.
    pub on_the_way: Option<[f64; 4]>,
    /// How many times longer the drive is than any would have to be.
    pub detour: Option<f64>,
}

/// Share of a drive's length below which another is worth telling of.
const WORTH_IT: f64 = 0.7;
/// A drive longer than any would have to be by this factor goes a long way round.
const LONG: f64 = 1.5;
/// Metres before a standstill at which a goal is tried, in turn.
const BACK: [f64; 6] = [0.02, 0.1, 0.25, 0.5, 1.0, 2.0];
/// Steps in which the way to there is told.
const CLOSELY: Steps = Steps { length: 0.01, angle: 0.01, least: 50 };
/// The search for the nearest goal asks hundreds of times; the precision of what it asks for.
const SHARE: f64 = 0.1;

impl Vehicle {
    /// What would help with `asked`, which was `answered`.
    pub fn remedies(&self, asked: &Asked, answered: &Answered) -> Remedies {
        let mut remedies = Remedies::default();
        let asked = &self.near(asked);
        let bounds = self.bounds(asked);
        let kept = Asked { kf: asked.kf.clamp(-bounds.most, bounds.most), ..*asked };
        let Ok(query) = query(&kept, &bounds) else { return remedies };
        let least = least_length(&query, &bounds);
        let length = answered.drive.as_ref().map(|(_, replay)| replay.length);
        remedies.detour = length.filter(|_| least > 0.0 && self.map.is_none()).map(|length| length / least);
        let short = match answered.status {
            Status::Invalid | Status::TimeLimit => return remedies,
            Status::Infeasible | Status::NotConverged => None,
            Status::Ok => length,
        };
        let tried = |choices: Choices<'_>| {
            if short.is_some_and(|length| least >= WORTH_IT * length) {
                return None;
            }
            let other = self.answer_by(asked, &Solver { choices, ..self.solver() });
            let metres = other.drive.filter(|_| other.status == Status::Ok)?.1.length;
            short.is_none_or(|length| metres < WORTH_IT * length).then_some(metres)
        };
        let choices = self.solver().choices;
        if !choices.reversals {
            remedies.with_reversals_m = tried(Choices { reversals: true, ..choices });
        }
        if !choices.turns && self.rover.limits.turns_in_place && self.pace.control == Control::Quintic {
            remedies.with_turns_m = tried(Choices { turns: true, ..choices });
        }
        if short.is_none_or(|length| length > LONG * least) {
            remedies.nearest = self.nearest(&kept, &query);
        }
        let way = self.way(asked, answered);
        remedies.standstill = way.last().copied();
        remedies.standstill.iter_mut().for_each(|(_, at)| self.move_back(at));
        remedies.on_the_way = self.on_the_way(asked, &way);
        remedies
    }

    /// The way to where the ground stops a drive: places on the map, with the metres driven to them.
    fn way(&self, asked: &Asked, answered: &Answered) -> Vec<(f64, Planar)> {
        let (Some(map), Some((solution, after_m)), Some(speed)) =
            (&self.map, answered.stopped.as_deref(), answered.profile)
        else {
            return Vec::new();
        };
        let site = Site { rover: &self.rover, map, speed, direction: direction(asked) };
        let mut way = site.way(&start(asked), &solution.segments, CLOSELY);
        // The replay looks closer than these steps.
        way.retain(|(s, _)| s <= after_m);
        way
    }

    /// The farthest goal on a way that is answered itself, of a few.
    fn on_the_way(&self, asked: &Asked, way: &[(f64, Planar)]) -> Option<[f64; 4]> {
        let (most, start, (end, _)) = (self.bounds(asked).most, start(asked), way.last()?);
        BACK.into_iter().find_map(|back| {
            let (_, place) = way.iter().rfind(|(s, _)| *s <= end - back)?;
            let [x, y] = seen_from([start.x, start.y, start.yaw], [place.x, place.y]);
            let (yaw, kf) = (place.yaw - start.yaw, place.curvature.clamp(-most, most));
            let there = Asked { goal: [x, y, yaw], kf, ..*asked };
            (self.answer_by(&there, &self.solver()).status == Status::Ok).then_some([x, y, yaw, kf])
        })
    }

    /// The nearest goal that one polynomial leads to and that is answered itself; other families have no quick search.
    fn nearest(&self, asked: &Asked, query: &Query) -> Option<[f64; 4]> {
        let bounds = self.bounds(asked);
        let flat_control = [Control::Cubic, Control::Quintic].into_iter().find(|control| *control == self.pace.control);
        let precision = self.solver().precision(asked).share(SHARE);
        let flat = Settings { precision, control: flat_control?.flat()?, ..self.solver().choices.flat };
        let choices = Choices { flat, ..self.solver().choices };
        let hazards = hazards(&self.rover, &self.keep_outs, asked);
        let reachable = |query: &Query| {
            direct_arc(query, &bounds, &choices).is_some_and(|drive| hazards.intrusion(&drive).is_none())
        };
        let goal = nearest(query, &bounds, reachable, || false)?.goal;
        let Goal { x, y, yaw, curvature } = flat::crab(&Query { goal, ..*query }, -asked.direction).goal;
        let there = Asked { goal: [x, y, yaw], kf: curvature, ..*asked };
        let confirmed = self.answer_by(&there, &self.solver()).status == Status::Ok;
        confirmed.then_some([x, y, yaw, curvature])
    }
}
