//! The best that is still to come: the dynamic program over legs, last leg first.

use super::super::objective::Aggregate;
use super::LegGraph;

/// Best aggregated score of the walks of exactly s legs from a node to the end, for every s and node.
#[derive(Debug, Clone)]
pub struct Values {
    aggregate: Aggregate,
    layers: Vec<Vec<f64>>,
}

/// No walk. Not −∞: a trajectory of worthless legs still is one.
const NO_WALK: f64 = f64::NAN;

impl Values {
    /// Best score from `node` to the end in `legs` legs; `None` if there is no such walk.
    pub fn best(&self, node: u32, legs: usize) -> Option<f64> {
        let value = self.layers[legs][node as usize];
        (!value.is_nan()).then_some(value)
    }

    /// How legs add up.
    pub fn aggregate(&self) -> Aggregate {
        self.aggregate
    }
}

impl<N: Copy> LegGraph<'_, N> {
    /// The dynamic program for trajectories of up to `length` waypoints, `scores` per leg:
    /// V₀ = neutral at the end, V_s(v) = max over legs v→w of score ⊕ V_{s−1}(w).
    pub(in crate::search) fn values(&self, length: usize, scores: &[f64], aggregate: Aggregate) -> Values {
        let at_end = |node| if self.at_end(node) { aggregate.neutral() } else { NO_WALK };
        let mut layers: Vec<Vec<f64>> = vec![(0..self.nodes() as u32).map(at_end).collect()];
        while layers.len() < length {
            let after = &layers[layers.len() - 1];
            let best = |node| {
                let mut best = NO_WALK;
                for leg in self.legs_from(node) {
                    let rest = after[self.to[leg] as usize];
                    let value = aggregate.add(rest, scores[leg]);
                    if !rest.is_nan() && (best.is_nan() || value > best) {
                        best = value;
                    }
                }
                best
            };
            layers.push((0..self.nodes() as u32).map(best).collect());
        }
        Values { aggregate, layers }
    }
}
