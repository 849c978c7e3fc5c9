//! A good trajectory without revisits where the best cannot be proven: a beam over lengths in the order of the bound.
//!
//! Layer by layer, the `width` best labels of each by bound; dominance by the set of visited waypoints, as a 64-bit
//! hash. What it finds is a trajectory; only the gap to the bound is told of its quality.

use std::collections::HashMap;

use rustc_hash::FxBuildHasher;

use super::super::graph::{LegGraph, Values};
use super::super::task::Found;
use super::settings::ExactSettings;
use super::worth::Worth;
use crate::math::random::hashed_unit;

/// A partial trajectory without revisits.
///
/// 48 bytes; the set itself is kept beside, one bit a waypoint, only for the layer that is extended.
#[derive(Debug, Clone, Copy)]
struct Label {
    bound: f64,
    score: f64,
    /// What its last leg leaves to the next.
    left: f64,
    node: u32,
    /// The label it continues, in the layer before, and the leg.
    parent: u32,
    leg: u32,
    /// Hash of the set of waypoints visited.
    set: u64,
}

/// Best first, distinct; and the labels expanded. Of two labels at one node with the same waypoints visited the one of
/// the lower bound is left out: whatever completes it completes the other one as well.
///
/// O(length · width · legs of a node) time, O(length · width) memory. Not a proof of anything: a label that was cut off
/// for width may have led to the best.
pub(super) fn descent<N: Copy>(
    graph: &LegGraph<'_, N>,
    scores: &Worth<'_>,
    values: &Values,
    settings: &ExactSettings,
) -> (Vec<Found<N>>, u64) {
    let width = settings.width.max(settings.best).max(1);
    let words = graph.candidates().len().div_ceil(64);
    let keys: Vec<u64> = (0..graph.candidates().len() as u64).map(key).collect();
    let neutral = settings.aggregate.neutral();
    let start = Label { bound: 0.0, score: neutral, left: 0.0, node: 0, parent: 0, leg: 0, set: keys[0] };
    let mut layers = vec![vec![start]];
    let mut visited = vec![0u64; words];
    visited[0] = 1;
    let mut expansions = 0;
    for steps_after in (0..settings.length - 1).rev() {
        let layer = &layers[layers.len() - 1];
        let mut next: Vec<Label> = Vec::new();
        let mut seen: HashMap<(u32, u64), u32, FxBuildHasher> = HashMap::default();
        for (parent, label) in layer.iter().enumerate() {
            expansions += 1;
            let visited = &visited[parent * words..(parent + 1) * words];
            for (leg, to) in graph.steps(label.node) {
                let waypoint = graph.waypoint(to) as usize;
                if visited[waypoint / 64] >> (waypoint % 64) & 1 == 1 {
                    continue;
                }
                let score = settings.aggregate.add(label.score, scores.own(graph, (label.node, leg)) + label.left);
                let left = scores.left(leg, steps_after);
                let Some(bound) = values.best((score, left), to, steps_after) else { continue };
                let set = label.set ^ keys[waypoint];
                let new = Label { bound, score, left, node: to, parent: parent as u32, leg: leg as u32, set };
                let place = *seen.entry((to, set)).or_insert(next.len() as u32) as usize;
                match next.get_mut(place) {
                    Some(old) if (old.bound, old.score) >= (bound, score) => {}
                    Some(old) => *old = new,
                    None => next.push(new),
                }
            }
        }
        keep_best(&mut next, width);
        visited = sets(&next, &visited, words, |label| graph.waypoint(label.node));
        layers.push(next);
    }
    let last = layers.len() - 1;
    let all = (0..layers[last].len()).map(|label| trace(graph, &layers, label)).collect();
    (distinct(all), expansions)
}

/// The best `width` in order, the others gone. Beside the search, which is compiled for each kind of node: a sort is as
/// large as it is.
///
/// Ties by the aggregated score, then by parent and leg: the order is total, so that the layer is the same in every
/// run. O(n + width log width).
fn keep_best(labels: &mut Vec<Label>, width: usize) {
    let best = |a: &Label, b: &Label| {
        b.bound.total_cmp(&a.bound).then(b.score.total_cmp(&a.score)).then((a.parent, a.leg).cmp(&(b.parent, b.leg)))
    };
    if labels.len() > width {
        labels.select_nth_unstable_by(width, best);
        labels.truncate(width);
    }
    labels.sort_unstable_by(best);
}

/// A random word per waypoint: sets are equal where the words' exclusive or is, up to 2⁻⁶⁴.
///
/// Zobrist's hash: a set grows by one exclusive or. A collision merges two labels that differ, which loses one
/// candidate of a heuristic and cannot give a wrong trajectory, because revisits are tested on the exact sets.
fn key(waypoint: u64) -> u64 {
    let half = |salt| (hashed_unit(salt, &[waypoint]) * 4_294_967_296.0) as u64;
    half(1) << 32 | half(2)
}

/// The visited sets of `labels`, from those of their parents.
///
/// One row of `words` 64-bit words a label, rows in the order of the labels: bit w is set where waypoint w was
/// visited.
fn sets(labels: &[Label], parents: &[u64], words: usize, waypoint: impl Fn(&Label) -> u32) -> Vec<u64> {
    let mut sets = Vec::with_capacity(labels.len() * words);
    for label in labels {
        let parent = label.parent as usize;
        sets.extend_from_slice(&parents[parent * words..(parent + 1) * words]);
        let at = sets.len() - words + waypoint(label) as usize / 64;
        sets[at] |= 1 << (waypoint(label) % 64);
    }
    sets
}

/// Follows the labels' parents back through the layers, one leg a layer.
fn trace<N: Copy>(graph: &LegGraph<'_, N>, layers: &[Vec<Label>], label: usize) -> Found<N> {
    let last = layers.len() - 1;
    let mut legs = vec![0; last];
    let mut at = label;
    for number in (1..=last).rev() {
        legs[number - 1] = layers[number][at].leg;
        at = layers[number][at].parent as usize;
    }
    graph.found(&legs, layers[last][label].score)
}

/// Best first, each list of waypoints once.
fn distinct<N>(mut all: Vec<Found<N>>) -> Vec<Found<N>> {
    Found::sort(&mut all);
    let mut known = std::collections::HashSet::new();
    all.retain(|found| known.insert(found.waypoints.clone()));
    all
}
