//! Drives made of others: one waypoint passed in another way, or the beginning of one and the rest of another.
//!
//! Changes are made on a draft ([`DriveDraft`]): a leg is solved again only where one of its ends is passed
//! otherwise, so that each change costs two boundary-value drives at most. Speeds are settled anew over the whole
//! drive.

use std::f64::consts::PI;

use super::solve::{DriveSolver, along};
use crate::campaign::graph::Plan;
use crate::feasibility::reach::drive::{DriveDraft, Manoeuvres};
use crate::math::random::{Stream, unit};
use crate::trajectory::Passing;
use crate::trajectory::drive::Planar;

/// By how much a heading is turned at most: one of these.
/// rad: a little, a sixth of a turn, any.
const TURNS: [f64; 3] = [PI / 12.0, PI / 3.0, PI];

/// What is changed at a waypoint.
///
/// Only what the scenario leaves open is drawn.
///
/// A heading can always be changed; the others where a range is open, or more than one way of driving is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Change {
    Heading,
    Direction,
    Speed,
    Manoeuvre,
}

impl DriveSolver<'_> {
    /// `plan` with one of both ends of leg number `leg` passed in another heading, direction of travel or speed, or one
    /// of the legs beside it driven by other manoeuvres: of what the scenario leaves open one, all alike. How the task
    /// starts stays. Two legs are solved at most.
    ///
    /// `None` where what was drawn is not feasible, and for what has no commands.
    ///
    /// `leg` counts from 0. Headings change by a uniform angle within ± one of three bounds; directions and speeds
    /// are drawn uniformly from what is allowed.
    ///
    /// The waypoint is the leg's begin or its end, each as often, but never the task's start. For another way of
    /// driving the waypoint is turned about first in half of the draws.
    pub(super) fn passed_otherwise(&self, plan: &Plan, leg: usize, random: &mut Stream) -> Option<Plan> {
        let drive = plan.witness.as_ref()?.commands()?;
        let (site, settings) = (self.site(), &self.settings);
        let mut draft = DriveDraft::of(drive, settings);
        let last = draft.waypoints().checked_sub(1).filter(|last| *last > 0)?;
        let index = (leg + (unit(random) * 2.0) as usize).clamp(1, last);
        let changes = self.changes(index == last);
        let passing = draft.passing(index);
        match changes[(unit(random) * changes.len() as f64) as usize] {
            Change::Heading => {
                let most = TURNS[(unit(random) * TURNS.len() as f64) as usize];
                draft.pass(index, turned(passing, most * (2.0 * unit(random) - 1.0)));
            }
            Change::Direction => {
                let [low, high] = settings.directions;
                draft.pass(index, Passing { direction: low + (high - low) * unit(random), ..passing });
            }
            Change::Speed => {
                let [low, high] = settings.pace.wishes(settings.speed);
                draft.wish(index, low + (high - low) * unit(random));
            }
            Change::Manoeuvre => {
                let beside = [Some(index - 1), (index < last).then_some(index)];
                let beside: Vec<usize> = beside.into_iter().flatten().collect();
                let other = beside[(unit(random) * beside.len() as f64) as usize];
                // What comes forward goes back the same way only if it is turned about.
                if unit(random) < 0.5 {
                    draft.pass(index, turned(passing, PI));
                }
                draft.drive_otherwise(&site, settings, other, random)?;
            }
        }
        if !draft.stands(&site, settings, index) {
            return None;
        }
        // A speed that is wished for where the vehicle must stand changes nothing.
        let changed = draft.driven(&site, settings).filter(|changed| changed != drive)?;
        Some(along(plan, plan.waypoints.clone(), changed))
    }

    /// What may be changed at a waypoint; at the `last` one a drive stands.
    fn changes(&self, last: bool) -> Vec<Change> {
        let settings = &self.settings;
        let open = |[low, high]: [f64; 2]| low < high;
        let Manoeuvres { forward, reverse, turn_in_place } = settings.manoeuvres;
        let ways = [forward, reverse, turn_in_place].into_iter().filter(|way| *way).count();
        [
            Some(Change::Heading),
            open(settings.directions).then_some(Change::Direction),
            (!last && open(settings.pace.wishes(settings.speed))).then_some(Change::Speed),
            (ways > 1).then_some(Change::Manoeuvre),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// The beginning of `plan`, up to where its leg number `leg` begins, and the waypoints of `other` after as many,
    /// passed as they were: the leg that joins both is solved, no other one.
    ///
    /// `None` where there is no such leg, or a waypoint would come twice that may not.
    ///
    /// At most one leg is solved; with a step-wise reach set all legs are asked again, which is cheap.
    pub(super) fn joined(&self, plan: &Plan, other: &Plan, leg: usize) -> Option<Plan> {
        let rest = other.waypoints.get(leg + 1..).filter(|rest| !rest.is_empty())?;
        let first = plan.waypoints.get(..=leg)?;
        if !self.search.revisits && rest.iter().any(|place| first.contains(place)) {
            return None;
        }
        let waypoints = [first, rest].concat();
        if let Some(stepwise) = &self.stepwise {
            return stepwise.planned(plan, waypoints);
        }
        let draft = |plan: &Plan| Some(DriveDraft::of(plan.witness.as_ref()?.commands()?, &self.settings));
        let draft = draft(plan)?.spliced(&draft(other)?, leg + 1)?;
        Some(along(plan, waypoints, draft.driven(&self.site(), &self.settings)?))
    }
}

/// In a heading by `angle` (rad) farther left.
///
/// The place and its curvature stay; the heading is wrapped to [−π, π].
fn turned(passing: Passing, angle: f64) -> Passing {
    let yaw = libm::remainder(passing.at.yaw + angle, 2.0 * PI);
    Passing { at: Planar { yaw, ..passing.at }, ..passing }
}
