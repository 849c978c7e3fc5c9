//! Best-first search in the order of an exact bound: what comes off the queue complete is the best of what is left.
//!
//! Bounds never rise along a trajectory: rounding is clipped at the parent's bound, so that the order in which entries
//! come off is the order of their truth.

use std::cmp::Ordering;
use std::collections::HashSet;

use super::super::frontier::{IntervalHeap, Tree};
use super::super::graph::{LegGraph, Values};
use super::super::task::Found;
use super::settings::ExactSettings;
use super::worth::Worth;

/// What is known of a leg, by its nodes and the duration that the graph has, s: its duration, s; `None` where it is
/// none.
pub(super) type Prove<'p> = dyn FnMut(u32, u32, f64) -> Option<f64> + 'p;

/// A partial trajectory and the best it can become.
#[derive(Debug, Clone, Copy)]
struct Entry {
    bound: f64,
    length: u32,
    id: u32,
}

/// By bound, then the longer (so that equal bounds are followed to their end), then by waypoint index.
///
/// Its type knows nothing of graphs: the heap is compiled once for all of them.
fn order(tree: &Tree<f64>) -> impl Fn(&Entry, &Entry) -> Ordering {
    |a, b| {
        let by_bound = a.bound.total_cmp(&b.bound).then(a.length.cmp(&b.length));
        by_bound.then_with(|| tree.lexicographic(b.id, a.id))
    }
}

/// What the search found, and what it left open.
pub(super) struct BestFirst<N> {
    /// Distinct, in the order of their scores.
    pub(super) found: Vec<Found<N>>,
    /// The best that what was not expanded can become; `None` if nothing is left.
    pub(super) open_bound: Option<f64>,
    /// Partial trajectories extended, at most the settings' `expansions`.
    pub(super) expansions: u64,
}

/// A*: the partial trajectory of the greatest bound is extended first, the bound being its score with the best that
/// could follow ([`Values`]). As no bound grows along a trajectory, the first complete one popped is the best, and so
/// on to the `best`-th. Where the budget of expansions ends first, the bound at the top is what nothing left can
/// exceed.
///
/// f(p) = g(p) ⊕ (what p's last leg leaves) ⊕ V_s(node of p): admissible, as V is over walks and a walk may do more
/// than a trajectory without revisits; consistent up to rounding, which the parent's bound clips. An expansion costs
/// one lookup and a push of O(log n) for each leg; memory grows by as many entries.
///
/// Legs of the graph need not be all legs: V of more legs is no less admissible. `prove` is asked for the last leg of
/// what comes off the queue, and what has one that is none is dropped there (lazily evaluated edges; Cohen, Phillips,
/// Likhachev 2014).
pub(super) fn best_first<N: Copy>(
    graph: &LegGraph<'_, N>,
    scores: &Worth<'_>,
    values: &Values,
    settings: &ExactSettings,
    prove: &mut Prove<'_>,
) -> BestFirst<N> {
    let aggregate = settings.aggregate;
    // What the last leg leaves to the next is remembered.
    let mut tree = Tree::new(0, 0, aggregate.neutral(), 0.0);
    let mut queue = IntervalHeap::new();
    let mut result = BestFirst { found: Vec::new(), open_bound: None, expansions: 0 };
    if let Some(bound) = values.best((aggregate.neutral(), 0.0), 0, settings.length - 1) {
        queue.push(Entry { bound, length: 1, id: 0 }, order(&tree));
    }
    let mut known = HashSet::new();
    let mut visited = vec![false; graph.candidates().len()];
    while let Some(entry) = queue.pop_best(order(&tree)) {
        let partial = *tree.get(entry.id);
        let before = tree.backwards(entry.id).nth(1).map(|before| before.node);
        if before.is_some_and(|before| prove(before, partial.node, partial.duration).is_none()) {
            tree.release(entry.id);
            continue;
        }
        if entry.length as usize == settings.length {
            if known.insert(tree.waypoints(entry.id)) {
                result.found.push(trajectory(graph, &tree, entry.id, prove));
            }
            tree.release(entry.id);
            if result.found.len() == settings.best.max(1) {
                break;
            }
            continue;
        }
        if result.expansions == settings.expansions {
            result.open_bound = Some(entry.bound);
            break;
        }
        result.expansions += 1;
        if !settings.revisits {
            tree.backwards(entry.id).for_each(|p| visited[p.waypoint as usize] = true);
        }
        let (mut grown, before) = (false, *tree.memory(entry.id));
        for (leg, to) in graph.steps(partial.node) {
            if visited[graph.waypoint(to) as usize] {
                continue;
            }
            let legs = settings.length - 1 - entry.length as usize;
            let score = aggregate.add(partial.score, scores.own(graph, (partial.node, leg)) + before);
            let left = scores.left(leg, legs);
            let Some(bound) = values.best((score, left), to, legs) else { continue };
            // Rounding must not lift a bound above that of what it continues.
            let bound = bound.min(entry.bound);
            let place = (to, graph.waypoint(to));
            let id = tree.grow(entry.id, place, graph.duration(partial.node, leg), score, left);
            queue.push(Entry { bound, length: entry.length + 1, id }, order(&tree));
            grown = true;
        }
        if !settings.revisits {
            tree.backwards(entry.id).for_each(|p| visited[p.waypoint as usize] = false);
        }
        if !grown {
            tree.release(entry.id);
        }
    }
    Found::sort(&mut result.found);
    result
}

/// Nodes and waypoints have one entry a waypoint, leg times (s) one less.
fn trajectory<N: Copy>(graph: &LegGraph<'_, N>, tree: &Tree<f64>, id: u32, prove: &mut Prove<'_>) -> Found<N> {
    let (mut nodes, durations): (Vec<u32>, Vec<f64>) =
        tree.backwards(id).map(|partial| (partial.node, partial.duration)).unzip();
    nodes.reverse();
    let durations = durations.into_iter().rev().skip(1); // the start has no leg
    let legs = nodes.windows(2).zip(durations);
    let leg_times = legs.map(|(ends, time)| prove(ends[0], ends[1], time).unwrap_or(time)).collect();
    Found {
        waypoints: tree.waypoints(id),
        nodes: nodes.into_iter().map(|node| graph.node(node)).collect(),
        leg_times,
        score: tree.get(id).score,
    }
}
