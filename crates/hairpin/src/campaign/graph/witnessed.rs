//! One graph over a roadmap of waypoint states, whose legs have witnesses.

use std::collections::{HashSet, VecDeque};

use nalgebra::Point3;

use super::losses::{Counter, Stage};
use super::outcome::Outcome;
use super::plan::Plan;
use super::question::{Looped, Question};
use super::search::search;
use crate::campaign::Evidence;
use crate::campaign::learn::AnyScore;
use crate::campaign::scenario::SearchSection;
use crate::feasibility::reach::{Reach, WitnessNode};
use crate::math::random::named_seed;
use crate::search::Found;
use crate::trajectory::Profile;

/// Nodes of a roadmap whose candidates are judged: each has all states of all waypoints.
const NODES: usize = 8;

/// One graph, and how it is searched.
///
/// What flights and boats share: nodes with velocities, and plans whose witness is a profile.
pub(in crate::campaign) struct Witnessed<'a> {
    pub(in crate::campaign) search: &'a SearchSection,
    /// Waypoints of a trajectory, both ends included.
    pub(in crate::campaign) length: u64,
    /// A profile longer than this is no plan, s.
    pub(in crate::campaign) longest: f64,
    /// Seed of the campaign, and number of the graph.
    pub(in crate::campaign) seed: (u64, u64),
    pub(in crate::campaign) points: &'a [Point3<f64>],
    pub(in crate::campaign) score: AnyScore<'a>,
    /// Those beside it.
    pub(in crate::campaign) also: Vec<AnyScore<'a>>,
    pub(in crate::campaign) looped: Looped<'a>,
}

/// A roadmap over the waypoints of one graph, asked three things.
#[derive(Clone, Copy)]
pub(in crate::campaign) struct Roads<'a> {
    pub(in crate::campaign) reach: &'a dyn Reach<WitnessNode>,
    pub(in crate::campaign) start: WitnessNode,
    /// Necessary for the end to be reached in so many legs.
    pub(in crate::campaign) may_arrive: &'a dyn Fn(&WitnessNode, usize) -> bool,
    /// The trajectory over nodes, if each is a leg from the one before.
    pub(in crate::campaign) profile: &'a dyn Fn(&[WitnessNode]) -> Option<Profile>,
}

impl Witnessed<'_> {
    /// Searches the graph over `roads`.
    pub(in crate::campaign) fn solve(self, roads: Roads) -> Outcome {
        let Self { search: section, length, longest, seed: (seed, graph), points, score, also, looped } = self;
        let plan = |found: Found<WitnessNode>| {
            let profile = (roads.profile)(&found.nodes)?;
            let fits = profile.duration() <= longest;
            fits.then(|| Plan { witness: Some(profile.into()), ..Plan::new(&found, points, Evidence::Witnessed) })
        };
        let question = Question {
            search: section,
            length: length as usize,
            points,
            reach: roads.reach,
            start: roads.start,
            score,
            seed: named_seed(seed, "uniform", graph),
            // The roadmap's own test is exact one step from the end, and legs are dear.
            lookahead: 0,
            plan: &plan,
            free_end: false,
            also,
            looped,
        };
        Outcome::of(graph, search(question, roads.may_arrive))
    }
}

/// Every candidate for a leg: its node, or why it is none.
type Fates<W> = Vec<Result<WitnessNode, Option<W>>>;

/// How the candidates for legs of a roadmap are counted.
pub(in crate::campaign) struct Counted<'a, W> {
    pub(in crate::campaign) start: WitnessNode,
    /// Waypoints of a trajectory, both ends included.
    pub(in crate::campaign) length: usize,
    /// Every candidate for a leg from a node, or why it is none.
    pub(in crate::campaign) candidates: &'a dyn Fn(&WitnessNode) -> Fates<W>,
    /// Whether the end may be reached from a node in so many legs.
    pub(in crate::campaign) arrives: &'a dyn Fn(&WitnessNode, usize) -> bool,
    /// The stage, and the scenario's key or the obstacle's name, of why a leg is none.
    pub(in crate::campaign) told: &'a dyn Fn(Option<W>) -> (Stage, String),
}

impl<W> Counted<'_, W> {
    /// Breadth first from the start, over the first 8 nodes and all of their candidates: a sample, not the whole graph.
    pub(in crate::campaign) fn count(&self, counter: &mut Counter) {
        let mut open = VecDeque::from([(self.start, 1)]);
        let mut seen = HashSet::from([self.start]);
        for _ in 0..NODES {
            let Some((node, passed)) = open.pop_front() else { break };
            if passed >= self.length {
                break;
            }
            let left = self.length - passed - 1;
            for fate in (self.candidates)(&node) {
                match fate {
                    Err(why) => {
                        let (stage, limit) = (self.told)(why);
                        counter.lose(stage, &limit);
                    }
                    Ok(next) if !(self.arrives)(&next, left) => counter.lose(Stage::EndPoint, "task.end_m"),
                    Ok(next) => {
                        counter.keep();
                        if seen.insert(next) {
                            open.push_back((next, passed + 1));
                        }
                    }
                }
            }
        }
    }
}
