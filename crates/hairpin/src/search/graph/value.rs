//! The best that is still to come: the dynamic program over legs, last leg first.

use super::super::objective::Aggregate;
use super::LegGraph;

/// Best aggregated score of the walks of exactly s legs from a node to the end, for every s and every node that a walk of the whole length
/// meets with s legs to go.
#[derive(Debug, Clone)]
pub(in crate::search) struct Values {
    layers: Vec<Vec<f64>>,
}

/// No walk. Not −∞: a trajectory of worthless legs still is one.
const NO_WALK: f64 = f64::NAN;
/// Legs that are looked at together: comparing one after the other waits for the one before.
const LANES: usize = 4;
/// The nodes near the start are those whose rows make up at most one in so many legs.
const FEW: usize = 16;

impl Values {
    /// Best score from `node` to the end in `legs` legs; `None` if there is no such walk.
    pub(in crate::search) fn best(&self, node: u32, legs: usize) -> Option<f64> {
        let value = self.layers[legs][node as usize];
        (!value.is_nan()).then_some(value)
    }
}

impl<N: Copy> LegGraph<'_, N> {
    /// The nodes that walks of 0, 1, 2 … legs from the start lead to, as long as these are few and the walks have no more than `length` waypoints.
    pub(in crate::search) fn near_start(&self, length: usize) -> Vec<Vec<u32>> {
        let mut layers = vec![vec![0]];
        let legs = |nodes: &[u32]| nodes.iter().map(|&node| self.legs_from(node).len()).sum::<usize>();
        while layers.len() < length && legs(&layers[layers.len() - 1]) <= self.legs() / FEW {
            let here = &layers[layers.len() - 1];
            let mut next: Vec<u32> = here.iter().flat_map(|&node| &self.to[self.legs_from(node)]).copied().collect();
            next.sort_unstable();
            next.dedup();
            layers.push(next);
        }
        layers
    }

    /// The dynamic program for trajectories of `length` waypoints, `scores` per leg:
    /// V₀ = neutral at the end, V_s(v) = max over legs v→w of score ⊕ V_{s−1}(w). `near_start` is [`Self::near_start`].
    pub(in crate::search) fn values(
        &self,
        length: usize,
        scores: &[f64],
        aggregate: Aggregate,
        near_start: &[Vec<u32>],
    ) -> Values {
        let at_end = |node| if self.at_end(node) { aggregate.neutral() } else { NO_WALK };
        let mut layers: Vec<Vec<f64>> = vec![(0..self.nodes() as u32).map(at_end).collect()];
        while layers.len() < length {
            let near = near_start.get(length - 1 - layers.len()).map(Vec::as_slice);
            layers.push(match aggregate {
                Aggregate::Sum => {
                    self.layer_of_values(&layers, scores, near, |rest, leg| Aggregate::Sum.add(rest, leg))
                }
                Aggregate::Max => {
                    self.layer_of_values(&layers, scores, near, |rest, leg| Aggregate::Max.add(rest, leg))
                }
            });
        }
        Values { layers }
    }

    /// The layer before `layers`, of the `nodes` given or of all; `add` is compiled into the loop.
    fn layer_of_values(
        &self,
        layers: &[Vec<f64>],
        scores: &[f64],
        nodes: Option<&[u32]>,
        add: impl Fn(f64, f64) -> f64,
    ) -> Vec<f64> {
        let after = &layers[layers.len() - 1];
        let best = |node| {
            let mut row = self.legs_from(node);
            if layers.len() == 1 {
                // The end is the last waypoint: no leg before those to it ends a walk.
                row.start = row.clone().rev().take_while(|&leg| self.at_end(self.to[leg])).last().unwrap_or(row.end);
            }
            let value = |(&to, &score): (&u32, &f64)| {
                let rest = after[to as usize];
                if rest.is_nan() { NO_WALK } else { add(rest, score) }
            };
            let (to, scores) = (self.to[row.clone()].chunks_exact(LANES), scores[row].chunks_exact(LANES));
            let left = to.remainder().iter().zip(scores.remainder()).map(value).fold(NO_WALK, f64::max);
            let mut lanes = [NO_WALK; LANES];
            for (to, scores) in to.zip(scores) {
                for (lane, leg) in lanes.iter_mut().zip(to.iter().zip(scores)) {
                    // No walk is no number, which a maximum passes over.
                    *lane = lane.max(value(leg));
                }
            }
            lanes.into_iter().fold(left, f64::max)
        };
        match nodes {
            Some(nodes) => {
                let mut layer = vec![NO_WALK; self.nodes()];
                nodes.iter().for_each(|&node| layer[node as usize] = best(node));
                layer
            }
            None => (0..self.nodes() as u32).map(best).collect(),
        }
    }
}
