//! Uniform over all feasible trajectories of a graph: the honest random baseline.
//!
//! The number of walks from each node with s legs to go, N_s(v) = Σ over legs v→w of N_{s−1}(w), makes drawing exact:
//! rank r in [0, N) is resolved leg by leg (Nijenhuis and Wilf, "Combinatorial Algorithms", 2nd ed. 1978). Integers up
//! to 2¹²⁸; beyond, floating point in proportion. Trajectories without revisits are the draws that have none: still
//! uniform, by rejection. So are those that are proven among walks over legs that may be ([`uniform_proven`]), where
//! proving all legs to draw a few would be nearly all of the time.

use std::borrow::Cow;
use std::collections::HashSet;

use rand::{Rng, RngExt};

use super::graph::{Count, Counts, Layer, LegGraph};
use super::objective::{Aggregate, LegView, Objective};
use super::task::Found;
use crate::feasibility::reach::Reach;
use crate::math::random::{Stream, stream};

/// What is asked for.
///
/// Where few walks are free of revisits (long ones) `draws` ends the sampling: the outcome then has fewer than wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct UniformSettings {
    /// Waypoints of a trajectory, both ends included; at most the length the graph was built for.
    pub length: usize,
    /// Trajectories wanted, with replacement.
    pub wanted: usize,
    /// Draws at most.
    pub draws: u64,
    /// Whether a waypoint may be used twice. If not, draws that do are rejected.
    pub revisits: bool,
    /// How legs add up.
    pub aggregate: Aggregate,
}

impl Default for UniformSettings {
    fn default() -> Self {
        Self { length: 10, wanted: 1, draws: 1_000_000, revisits: false, aggregate: Aggregate::Sum }
    }
}

/// The sample.
///
/// With `found.len()` of `draws` accepted, walks · found/draws estimates how many trajectories without revisits there
/// are.
#[derive(Debug, Clone, PartialEq)]
pub struct UniformOutcome<N> {
    /// Trajectories in the order drawn: with replacement, so the same may be there twice.
    pub found: Vec<Found<N>>,
    /// How many different ones (by waypoints) are among them.
    pub distinct: usize,
    /// Draws made, those rejected for a revisit or a leg that is none included.
    pub draws: u64,
    /// What was drawn from: with revisits all trajectories, without them all but those that fly straight back; over
    /// legs that may be, more than these. Zero: nothing was drawn, since there is nothing.
    pub walks: Count,
}

/// Walks without revisits that may have a leg that is none before [`uniform_proven`] gives up, and more for each that
/// has none.
const REFUSED: u64 = 64;
const REFUSED_EACH: u64 = 8;

/// Draws walks of one length from the start to the end, each equally likely.
///
/// Built once in O(legs · length), drawn from in O(length · legs of a node).
///
/// Memory: length · nodes counts of 16 bytes (8 where they are doubles).
#[derive(Debug)]
pub struct Sampler<'g, 'a, N> {
    graph: &'g LegGraph<'a, N>,
    counts: Counts,
    length: usize,
}

impl<'g, 'a, N: Copy> Sampler<'g, 'a, N> {
    /// `None` if there is nothing to draw from.
    pub fn new(graph: &'g LegGraph<'a, N>, length: usize) -> Option<Self> {
        let counts = graph.counts(length.max(2));
        let some = length >= 2 && !counts.from_start(length - 1).is_zero();
        some.then_some(Self { graph, counts, length })
    }

    /// Number of walks.
    ///
    /// What one draw is one of.
    pub fn total(&self) -> Count {
        self.counts.from_start(self.length - 1)
    }

    /// Draws one into `legs` (numbers of the graph's legs). A rank below the number of walks is drawn and its
    /// walk looked up by the counts, in integers; where they are too large for that, leg by leg in proportion.
    ///
    /// `legs` is cleared first and has length − 1 entries after. Exact uniformity needs counts below 2¹²⁸; beyond, each
    /// leg is drawn with the relative error of a double.
    pub fn draw(&self, rng: &mut Stream, legs: &mut Vec<u32>) {
        legs.clear();
        let mut node = 0;
        let mut rank = None;
        for steps in (1..self.length).rev() {
            let after = self.counts.layer(steps - 1);
            let leg = match (self.counts.layer(steps).at(node), after) {
                (Count::Exact(total), Layer::Exact(after)) => {
                    let mut left = rank.take().unwrap_or_else(|| below(rng, total));
                    let leg = self.graph.steps(node).find(|&(_, to)| {
                        let count = after[to as usize];
                        let here = left < count;
                        if !here {
                            left -= count;
                        }
                        here
                    });
                    rank = Some(left);
                    leg
                }
                (total, after) => {
                    let weight = |&(_, to): &(usize, u32)| after.at(to).as_f64();
                    let mut left = rng.random::<f64>() * total.as_f64();
                    let live = || self.graph.steps(node).filter(|step| weight(step) > 0.0);
                    let chosen = live().find(|step| {
                        left -= weight(step);
                        left < 0.0
                    });
                    chosen.or_else(|| live().last())
                }
            };
            let (leg, to) = leg.expect("a node's walks are those over its legs");
            legs.push(leg as u32);
            node = to;
        }
    }
}

/// Uniform in 0 .. `bound`, without bias.
///
/// Rejection from the next power of two: less than two draws on the average.
fn below(rng: &mut Stream, bound: u128) -> u128 {
    if bound <= 1 {
        return 0;
    }
    let bits = 128 - (bound - 1).leading_zeros();
    loop {
        let draw = if bits <= 64 {
            u128::from(rng.next_u64() >> (64 - bits))
        } else {
            (u128::from(rng.next_u64()) << 64 | u128::from(rng.next_u64())) >> (128 - bits)
        };
        if draw < bound {
            return draw;
        }
    }
}

/// Draws `wanted` trajectories of `graph`, each equally likely, scored under `objective`.
///
/// Without revisits the walks drawn from are those of [`LegGraph::without_returns`], of which far fewer are rejected.
/// An empty outcome with `walks` zero proves that there is no trajectory.
///
/// ```
/// use hairpin::feasibility::reach::{Everywhere, StepNode, StepReach, StepSettings};
/// use hairpin::search::{Count, LegGraph, LegView, UniformSettings, uniform};
/// use nalgebra::Point3;
///
/// // Five points, all legs: 3 · 2 ways from the first over two others to the last.
/// let points: Vec<Point3<f64>> = (0..5).map(|i| Point3::new(f64::from(i), 0.0, 1.0)).collect();
/// let reach = StepReach::new(&Everywhere, &points, StepSettings::default());
/// let graph = LegGraph::explore(StepNode { previous: 0, current: 0 }, &points, &reach, 4);
/// let settings = UniformSettings { length: 4, wanted: 200, ..UniformSettings::default() };
/// let drawn = uniform(&graph, &|leg: &LegView<'_>| leg.features.length, 1, &settings);
/// assert_eq!((drawn.found.len(), drawn.distinct), (200, 6));
/// assert_eq!(drawn.walks, Count::Exact(6)); // no way back over a leg is left among them
/// ```
///
/// Draw k depends on `seed`, the graph, the length and `revisits` alone: asking for more gives the same first ones.
/// Scores are added up for what is returned, not for what is rejected.
pub fn uniform<N, O>(graph: &LegGraph<'_, N>, objective: &O, seed: u64, settings: &UniformSettings) -> UniformOutcome<N>
where
    N: Copy,
    O: Objective,
{
    let all = drawn(graph, |_| true, objective, seed, settings);
    all.expect("nothing is refused")
}

/// The same of a graph of legs that may be ([`LegGraph::explore_possible`]) by `reach`, which is asked for the legs of
/// what is drawn alone: a walk of which one is none is drawn again, so that those that are left are equally likely.
///
/// `None` where so few walks are left that the legs of the graph are better proven first.
pub fn uniform_proven<N, O, R>(
    possible: &LegGraph<'_, N>,
    reach: &R,
    objective: &O,
    seed: u64,
    settings: &UniformSettings,
) -> Option<UniformOutcome<N>>
where
    N: Copy,
    O: Objective,
    R: Reach<N> + ?Sized,
{
    let prove = |found: &mut Found<N>| {
        found.nodes.windows(2).zip(&mut found.leg_times).all(|(nodes, time)| {
            let proven = reach.proven(&nodes[0], &nodes[1], *time);
            *time = proven.unwrap_or(*time);
            proven.is_some()
        })
    };
    drawn(possible, prove, objective, seed, settings)
}

/// `prove` says whether what was found is a trajectory, and puts its leg times right.
fn drawn<N, O>(
    graph: &LegGraph<'_, N>,
    prove: impl Fn(&mut Found<N>) -> bool,
    objective: &O,
    seed: u64,
    settings: &UniformSettings,
) -> Option<UniformOutcome<N>>
where
    N: Copy,
    O: Objective,
{
    let graph = if settings.revisits { Cow::Borrowed(graph) } else { graph.without_returns(settings.length) };
    let graph = &*graph;
    let mut outcome = UniformOutcome { found: Vec::new(), distinct: 0, draws: 0, walks: Count::Exact(0) };
    let Some(sampler) = Sampler::new(graph, settings.length) else { return Some(outcome) };
    let mut refused = 0;
    outcome.walks = sampler.total();
    let (mut rng, mut legs, mut known) = (stream(seed), Vec::new(), HashSet::new());
    let mut used = vec![u64::MAX; graph.candidates().len()];
    while outcome.found.len() < settings.wanted && outcome.draws < settings.draws {
        sampler.draw(&mut rng, &mut legs);
        let draw = outcome.draws;
        outcome.draws += 1;
        used[0] = draw;
        let once = |&leg: &u32| {
            let waypoint = graph.waypoint(graph.target(leg as usize)) as usize;
            std::mem::replace(&mut used[waypoint], draw) != draw
        };
        if !(settings.revisits || legs.iter().all(once)) {
            continue;
        }
        let mut found = graph.found(&legs, 0.0);
        if !prove(&mut found) {
            refused += 1;
            if refused > REFUSED + REFUSED_EACH * outcome.found.len() as u64 {
                return None;
            }
            continue;
        }
        found.score = score(graph, objective, (&legs, &found.leg_times), settings.aggregate);
        known.insert(found.waypoints.clone());
        outcome.found.push(found);
    }
    outcome.distinct = known.len();
    Some(outcome)
}

/// A trajectory's score, added up from its start over legs that take `times` (s), as a search would have.
fn score<N: Copy, O: Objective>(
    graph: &LegGraph<'_, N>,
    objective: &O,
    (legs, times): (&[u32], &[f64]),
    aggregate: Aggregate,
) -> f64 {
    let (mut total, mut memory, mut node) = (aggregate.neutral(), objective.start(), 0);
    for (&leg, &duration) in legs.iter().zip(times) {
        let view = LegView { duration, ..graph.view(node, leg as usize) };
        let (score, after) = objective.extend(&memory, &view);
        (total, memory) = (aggregate.add(total, score), after);
        node = graph.target(leg as usize);
    }
    total
}

#[cfg(feature = "unit-tests")]
mod tests {
    use std::collections::HashMap;

    use super::super::score::Score;
    use super::super::small::{Loose, Octahedron, START, enumerate, points};
    use super::super::task::Task;
    use super::*;

    const SMALL: Octahedron = Octahedron::WIDE;

    /// What is left of walks over more legs than there are is drawn as evenly as where all are known, with what legs
    /// take and are worth; where hardly any is left it is said.
    #[test]
    fn what_is_proven_of_what_may_be_is_equally_likely() {
        let (mut tested, mut given_up) = (0, 0);
        for seed in 0..100 {
            let points = points(seed, 8, 11.0);
            let loose = |share: f64| Loose::of(share, &points);
            let task = Task { start: START, candidates: &points, reach: &SMALL };
            let objective = |leg: &LegView<'_>| leg.duration * leg.features.length;
            let all = enumerate(&task, &objective, (6, false, Aggregate::Sum));
            if !(10..2_000).contains(&all.len()) {
                continue;
            }
            let wanted = 50 * all.len();
            let settings = UniformSettings { length: 6, wanted, ..Default::default() };
            let more = loose(1.1);
            let possible = LegGraph::explore_possible(START, &points, &more, 6);
            assert!(possible.legs() > LegGraph::explore(START, &points, &more, 6).legs());
            let Some(outcome) = uniform_proven(&possible, &more, &objective, seed, &settings) else {
                given_up += 1;
                continue;
            };
            assert_eq!(outcome.found.len(), wanted, "seed {seed}");
            let mut times: HashMap<&[u32], (f64, f64)> =
                all.iter().map(|(w, score)| (w.as_slice(), (0.0, *score))).collect();
            for found in &outcome.found {
                let (times, score) = times.get_mut(found.waypoints.as_slice()).expect("feasible");
                assert_eq!((found.score, found.leg_times.iter().sum::<f64>()), (*score, 5.0));
                *times += 1.0;
            }
            let chi: f64 = times.values().map(|(n, _)| (n - 50.0).powi(2) / 50.0).sum();
            let freedom = all.len() as f64 - 1.0;
            assert!((chi - freedom).abs() < 5.0 * (2.0 * freedom).sqrt(), "seed {seed}: χ² {chi} of {freedom}");
            tested += 1;
            let everything = loose(100.0);
            let possible = LegGraph::explore_possible(START, &points, &everything, 6);
            given_up += usize::from(uniform_proven(&possible, &everything, &objective, seed, &settings).is_none());
        }
        assert!(tested > 10 && given_up > 3, "{tested}, {given_up}");
    }

    #[test]
    fn every_trajectory_is_equally_likely() {
        let mut tested = 0;
        for seed in 0..40 {
            let points = points(seed, 8, 11.0);
            let task = Task { start: START, candidates: &points, reach: &SMALL };
            let graph = LegGraph::explore(START, &points, task.reach, 6);
            let objective = Score::Random { seed };
            for revisits in [false, true] {
                let all = enumerate(&task, &objective, (6, revisits, Aggregate::Sum));
                if !(10..2_000).contains(&all.len()) {
                    continue;
                }
                let wanted = 50 * all.len();
                let settings = UniformSettings { length: 6, wanted, revisits, ..Default::default() };
                let outcome = uniform(&graph, &objective, seed, &settings);
                assert_eq!(outcome.found.len(), wanted, "seed {seed}");
                assert!(if revisits { outcome.draws == wanted as u64 } else { outcome.draws >= wanted as u64 });
                let mut times: HashMap<&[u32], f64> = all.iter().map(|(w, _)| (w.as_slice(), 0.0)).collect();
                for found in &outcome.found {
                    *times.get_mut(found.waypoints.as_slice()).expect("feasible") += 1.0;
                }
                assert_eq!(outcome.distinct, times.values().filter(|&&n| n > 0.0).count());
                let chi: f64 = times.values().map(|n| (n - 50.0).powi(2) / 50.0).sum();
                let freedom = all.len() as f64 - 1.0;
                assert!((chi - freedom).abs() < 5.0 * (2.0 * freedom).sqrt(), "seed {seed}: χ² {chi} of {freedom}");
                let (waypoints, score) = &all[all.len() / 2];
                let same = outcome.found.iter().find(|found| found.waypoints == *waypoints).expect("drawn 50 times");
                assert_eq!(same.score, *score);
                tested += 1;
            }
        }
        assert!(tested > 10, "{tested}");
    }

    #[test]
    fn counts_too_large_for_integers_are_sampled_in_proportion() {
        let everything = Octahedron { centre: nalgebra::Vector3::zeros(), half: nalgebra::Vector3::repeat(1e9) };
        let points = points(0, 20, 1.0);
        let task = Task { start: START, candidates: &points, reach: &everything };
        let graph = LegGraph::explore(START, &points, task.reach, 50);
        let sampler = Sampler::new(&graph, 50).expect("a complete graph");
        assert!(matches!(sampler.total(), Count::About(_)));
        let (mut rng, mut legs) = (stream(1), Vec::new());
        let mut times = [0.0; 22];
        let draws = 20_000;
        for _ in 0..draws {
            sampler.draw(&mut rng, &mut legs);
            assert_eq!(legs.len(), 49);
            assert!(graph.at_end(graph.target(legs[48] as usize)));
            times[graph.waypoint(graph.target(legs[0] as usize)) as usize] += 1.0;
        }
        // By symmetry the first leg goes to each of the 21 others with equal odds, up to 21⁻⁴⁸.
        assert_eq!(times[0], 0.0);
        let expected = f64::from(draws) / 21.0;
        let chi: f64 = times[1..].iter().map(|n| (n - expected).powi(2) / expected).sum();
        assert!(chi < 20.0 + 5.0 * 40f64.sqrt(), "{chi}");
    }

    #[test]
    fn ranks_are_unbiased_at_any_size() {
        let mut rng = stream(3);
        for bound in [1, 2, 3, 5, 1 << 64, (1 << 64) + 1, u128::MAX] {
            assert!((0..100).all(|_| below(&mut rng, bound) < bound));
        }
        let mut times = [0; 3];
        (0..30_000).for_each(|_| times[below(&mut rng, 3) as usize] += 1);
        assert!(times.iter().all(|&n: &i32| (n - 10_000).abs() < 400), "{times:?}");
    }
}
