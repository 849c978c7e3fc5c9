//! Tasks without an end: any waypoint may be the last one.
//!
//! The searches look for trajectories to one end. Here that end is a sink: one more candidate behind the graph's own,
//! to which every node has a leg without duration and without stress. A trajectory of L waypoints with a free end is
//! one of L + 1 to the sink.

use nalgebra::Point3;

use super::objective::{Additive, Aggregate, LegView, Objective};
use super::task::{Found, Task};
use crate::feasibility::reach::{Leg, LegFeatures, Reach};

/// A node of a task without an end.
///
/// `Over` keeps the node that it was entered from apart, since trajectories that end elsewhere are other trajectories.
///
/// `Eq` and `Ord` of the node that it wraps, so that a set's own order decides among the nodes at the graph's own
/// waypoints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum OpenNode<N> {
    /// The reach set's own.
    At(N),
    /// The sink, entered from this node: trajectories that end in different nodes are not compared as if they had the
    /// same future.
    Over(N),
}

/// A reach set with a sink for an end.
///
/// ```text
/// task(start) · score(objective) · settings.length + 1 · may_arrive   →   closed(found)
/// ```
///
/// A wrapper, so that no search has a second way to end: beam, exact, uniform and loop see one more candidate.
///
/// ```
/// use hairpin::feasibility::reach::{Sphere, StepNode, StepReach, StepSettings};
/// use hairpin::search::{Aggregate, BeamSettings, LegView, OpenEnd, beam};
/// use nalgebra::Point3;
///
/// // Legs of at most 5 m; of two legs from the first point on the longest pair ends where it likes.
/// let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 5.0], [0.0, 3.0]].map(|[x, y]| Point3::new(x, y, 1.0));
/// let open = OpenEnd::new(StepReach::new(&Sphere { radius: 5.0 }, &points, StepSettings::default()), &points);
/// let long = |leg: &LegView<'_>| leg.features.length;
/// let score = open.score(&long, Aggregate::Sum);
/// let settings = BeamSettings { length: 3 + 1, per_graph: 9, ..BeamSettings::default() };
/// let task = open.task(StepNode { previous: 0, current: 0 });
/// let found = beam(&task, &score, |node, steps| OpenEnd::<Sphere>::may_arrive(node, steps), &settings).found;
/// assert_eq!(open.closed(found[0].clone()).waypoints, [0, 1, 2]); // 4 + 5 m
/// ```
#[derive(Debug, Clone)]
pub struct OpenEnd<R> {
    inner: R,
    /// The graph, and the sink.
    candidates: Vec<Point3<f64>>,
}

impl<R> OpenEnd<R> {
    /// `inner` over the graph `points`, index 0 the start; all others are ordinary waypoints.
    ///
    /// A copy of `points`; the sink has the place of the first one, which no score or test looks at. Without points
    /// there is no sink either, and no trajectory.
    pub fn new(inner: R, points: &[Point3<f64>]) -> Self {
        let mut candidates = points.to_vec();
        // Where the sink lies is nobody's business.
        candidates.extend(points.first());
        Self { inner, candidates }
    }

    /// The reach set.
    pub fn inner(&self) -> &R {
        &self.inner
    }

    /// The waypoints with the sink behind them: what the search is given.
    ///
    /// One more than the graph's points, m; the last one's place means nothing.
    pub fn candidates(&self) -> &[Point3<f64>] {
        &self.candidates
    }

    /// The task from `start`. Its trajectories have one waypoint more than those asked for.
    pub fn task<N>(&self, start: N) -> Task<'_, OpenNode<N>, Self> {
        Task { start: OpenNode::At(start), candidates: &self.candidates, reach: self }
    }

    /// `objective`, to which the leg to the sink adds nothing under `aggregate`.
    ///
    /// The neutral number of `aggregate` is what the leg to the sink scores: 0 in a sum, −∞ in a maximum.
    pub fn score<'a, O: Objective>(&self, objective: &'a O, aggregate: Aggregate) -> OpenScore<'a, O> {
        OpenScore { objective, aggregate, sink: self.sink() }
    }

    /// The test that the beam asks: every node is one leg from the sink, and the sink leads nowhere.
    ///
    /// `steps` legs from `node` to the sink: from the sink 0, from any other node 1 or more. Necessary, and
    /// sufficient for 1.
    pub fn may_arrive<N>(node: &OpenNode<N>, steps: usize) -> bool {
        matches!(node, OpenNode::At(_)) == (steps > 0)
    }

    /// What was found, without the sink.
    ///
    /// The score stays as it is; what does not end at the sink is only unwrapped.
    pub fn closed<N: Copy>(&self, found: Found<OpenNode<N>>) -> Found<N> {
        let Found { mut waypoints, nodes, mut leg_times, score } = found;
        if waypoints.last() == Some(&self.sink()) {
            waypoints.pop();
            leg_times.pop();
        }
        let own = |node: &OpenNode<N>| match node {
            OpenNode::At(node) => Some(*node),
            OpenNode::Over(_) => None,
        };
        Found { nodes: nodes.iter().filter_map(own).collect(), waypoints, leg_times, score }
    }

    /// Index of the sink: behind the graph's own.
    fn sink(&self) -> u32 {
        self.candidates.len().saturating_sub(1) as u32
    }
}

impl<R> OpenEnd<R> {
    /// The legs of the reach set by `inner`, and the one to the sink.
    fn and_over<N: Copy>(
        &self,
        from: &OpenNode<N>,
        inner: impl FnOnce(&N, &mut Vec<Leg<N>>),
        out: &mut Vec<Leg<OpenNode<N>>>,
    ) {
        let OpenNode::At(from) = from else { return };
        let mut legs = Vec::new();
        inner(from, &mut legs);
        out.extend(legs.into_iter().map(|Leg { to, waypoint, duration, features }| Leg {
            to: OpenNode::At(to),
            waypoint,
            duration,
            features,
        }));
        let (to, features) = (OpenNode::Over(*from), LegFeatures::default());
        out.push(Leg { to, waypoint: self.sink(), duration: 0.0, features });
    }
}

impl<N: Copy, R: Reach<N>> Reach<OpenNode<N>> for OpenEnd<R> {
    fn legs(&self, from: &OpenNode<N>, candidates: &[Point3<f64>], out: &mut Vec<Leg<OpenNode<N>>>) {
        let inner = |from: &N, out: &mut Vec<Leg<N>>| self.inner.legs(from, &candidates[..self.sink() as usize], out);
        self.and_over(from, inner, out);
    }

    fn possible(&self, from: &OpenNode<N>, candidates: &[Point3<f64>], out: &mut Vec<Leg<OpenNode<N>>>) {
        let inner =
            |from: &N, out: &mut Vec<Leg<N>>| self.inner.possible(from, &candidates[..self.sink() as usize], out);
        self.and_over(from, inner, out);
    }

    fn proven(&self, from: &OpenNode<N>, to: &OpenNode<N>, duration: f64) -> Option<f64> {
        match (from, to) {
            (OpenNode::At(from), OpenNode::At(to)) => self.inner.proven(from, to, duration),
            _ => Some(duration),
        }
    }

    fn is_known_at_once(&self) -> bool {
        self.inner.is_known_at_once()
    }
}

/// A score that leaves the leg to the sink out.
///
/// Made by [`OpenEnd::score`]. The score beneath never sees the sink: its views have the graph's own candidates.
#[derive(Debug, Clone, Copy)]
pub struct OpenScore<'a, O> {
    objective: &'a O,
    aggregate: Aggregate,
    sink: u32,
}

impl<O: Objective> Objective for OpenScore<'_, O> {
    type Memory = O::Memory;

    fn start(&self) -> O::Memory {
        self.objective.start()
    }

    fn extend(&self, memory: &O::Memory, leg: &LegView<'_>) -> (f64, O::Memory) {
        if leg.to == self.sink {
            return (self.aggregate.neutral(), memory.clone());
        }
        self.objective.extend(memory, &self.inner(leg))
    }
}

impl<O: Additive> Additive for OpenScore<'_, O> {
    fn own(&self, leg: &LegView<'_>) -> f64 {
        if leg.to == self.sink { self.aggregate.neutral() } else { self.objective.own(&self.inner(leg)) }
    }

    fn left(&self, leg: &LegView<'_>) -> f64 {
        if leg.to == self.sink { 0.0 } else { self.objective.left(&self.inner(leg)) }
    }

    fn own_and_left(&self, legs: &[LegView<'_>]) -> Vec<[f64; 2]> {
        let to_sink = [self.aggregate.neutral(), 0.0];
        let inner: Vec<LegView<'_>> =
            legs.iter().filter(|leg| leg.to != self.sink).map(|leg| self.inner(leg)).collect();
        let mut parts = self.objective.own_and_left(&inner).into_iter();
        let part = |leg: &LegView<'_>| if leg.to == self.sink { None } else { parts.next() };
        legs.iter().map(part).map(|part| part.unwrap_or(to_sink)).collect()
    }

    fn is_timeless(&self) -> bool {
        self.objective.is_timeless()
    }

    fn has_sink(&self) -> bool {
        true
    }
}

impl<O> OpenScore<'_, O> {
    /// `leg` without the sink behind the graph's own candidates.
    ///
    /// Whoever looks at all candidates, as a score of the user's may, sees the graph's own.
    fn inner<'l>(&self, leg: &LegView<'l>) -> LegView<'l> {
        LegView { candidates: &leg.candidates[..self.sink as usize], ..*leg }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::super::graph::LegGraph;
    use super::super::score::Score;
    use super::super::small::{Octahedron, START, enumerate_open, points};
    use super::super::{BeamSettings, Count, ExactSettings, UniformSettings, beam, exact, uniform};
    use super::*;

    const SMALL: Octahedron = Octahedron::WIDE;
    const LENGTH: usize = 4;

    /// Every graph of the family with all its trajectories of a free end, best first.
    fn graphs(revisits: bool, aggregate: Aggregate) -> impl Iterator<Item = Instance> {
        (0..30).map(move |seed| {
            let points = points(seed, 7, 11.0);
            let score = Score::Random { seed };
            let task = Task { start: START, candidates: &points, reach: &SMALL };
            let all = enumerate_open(&task, &score, (LENGTH, revisits, aggregate));
            Instance { seed, score, all, open: OpenEnd::new(SMALL, &points) }
        })
    }

    struct Instance {
        seed: u64,
        score: Score,
        all: Vec<(Vec<u32>, f64)>,
        open: OpenEnd<Octahedron>,
    }

    fn every_kind() -> impl Iterator<Item = (bool, Aggregate)> {
        [false, true].into_iter().flat_map(|revisits| [Aggregate::Sum, Aggregate::Max].map(|a| (revisits, a)))
    }

    #[test]
    fn the_beam_finds_what_enumeration_finds() {
        let mut total = 0;
        for (revisits, aggregate) in every_kind() {
            for Instance { seed, score, all, open } in graphs(revisits, aggregate) {
                let settings = BeamSettings {
                    length: LENGTH + 1,
                    per_graph: usize::MAX,
                    revisits,
                    aggregate,
                    keep: None,
                    lookahead: 0,
                    ..BeamSettings::default()
                };
                let score = open.score(&score, aggregate);
                let outcome = beam(&open.task(START), &score, OpenEnd::<Octahedron>::may_arrive, &settings);
                let found: Vec<_> = outcome.found.into_iter().map(|found| open.closed(found)).collect();
                for found in &found {
                    assert_eq!((found.waypoints.len(), found.nodes.len(), found.leg_times.len()), (4, 4, 3));
                    let last = (found.waypoints[2], found.waypoints[3]);
                    assert_eq!((found.nodes[3].previous, found.nodes[3].current), last);
                }
                let found: Vec<_> = found.into_iter().map(|f| (f.waypoints, f.score)).collect();
                assert_eq!(found, all, "seed {seed} revisits {revisits} {aggregate:?}");
                total += all.len();
            }
        }
        assert!(total > 1_000, "{total}");
    }

    #[test]
    fn the_exact_search_proves_the_best_of_all_ends() {
        for (revisits, aggregate) in every_kind() {
            for Instance { seed, score, all, open } in graphs(revisits, aggregate) {
                let graph = LegGraph::explore(OpenNode::At(START), open.candidates(), &open, LENGTH + 1);
                let settings =
                    ExactSettings { length: LENGTH + 1, best: 3, revisits, aggregate, ..ExactSettings::default() };
                let outcome = exact(&graph, &open.score(&score, aggregate), &settings);
                let told = format!("seed {seed} revisits {revisits} {aggregate:?}");
                assert_eq!(outcome.found.len(), all.len().min(3), "{told}");
                assert_eq!(outcome.proven, outcome.found.len(), "{told}");
                for (found, (_, expected)) in outcome.found.into_iter().zip(&all) {
                    let found = open.closed(found);
                    assert!((found.score - expected).abs() < 1e-12, "{told}: {} {expected}", found.score);
                    assert!(all.iter().any(|(waypoints, _)| *waypoints == found.waypoints), "{told}");
                }
            }
        }
    }

    #[test]
    fn uniform_draws_have_every_end() {
        let mut tested = 0;
        for (revisits, aggregate) in every_kind() {
            for Instance { seed, score, all, open } in graphs(revisits, aggregate) {
                let graph = LegGraph::explore(OpenNode::At(START), open.candidates(), &open, LENGTH + 1);
                let wanted = 20 * all.len();
                let settings =
                    UniformSettings { length: LENGTH + 1, wanted, revisits, aggregate, ..UniformSettings::default() };
                let outcome = uniform(&graph, &open.score(&score, aggregate), seed, &settings);
                if revisits {
                    assert_eq!(outcome.walks, Count::Exact(all.len() as u128), "seed {seed}");
                }
                assert_eq!(outcome.found.len(), wanted, "seed {seed}");
                for found in outcome.found {
                    let found = open.closed(found);
                    let known = all.iter().find(|(waypoints, _)| *waypoints == found.waypoints);
                    assert!(known.is_some_and(|(_, score)| (score - found.score).abs() < 1e-12), "seed {seed}");
                }
                // A trajectory is missed with odds of e⁻²⁰.
                assert_eq!(outcome.distinct, all.len(), "seed {seed}");
                tested += usize::from(all.len() > 10);
            }
        }
        assert!(tested > 20, "{tested}");
    }
}
