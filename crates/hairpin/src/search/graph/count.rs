//! How many trajectories a graph has: exactly, of every length.
//!
//! Counting is the dynamic program over (+, ×) in place of (max, +). Zero is a proof that the graph has none; a count
//! is what a share of found trajectories is held against.
//!
//! ```text
//! N_0(v) = 1 if v is at the end, else 0          N_s(v) = Σ over legs v→w of N_{s−1}(w)
//! ```

use std::fmt;

use super::LegGraph;

/// A number of trajectories.
///
/// `About` once a sum left 128 bits; from there on sums of doubles.
///
/// Equal only within a kind; compare by [`Count::as_f64`] where both may occur.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Count {
    /// To the last one.
    Exact(u128),
    /// More than 2¹²⁸ − 1; printed with a `~`.
    About(f64),
}

impl Count {
    /// Whether there is none: a proof.
    ///
    /// Among doubles as well: a sum of counts, none below 1, is 0 where it has no summand.
    pub fn is_zero(self) -> bool {
        self.as_f64() == 0.0
    }

    /// The number, rounded.
    ///
    /// The relative error of an exact one is at most 2⁻⁵³.
    pub fn as_f64(self) -> f64 {
        match self {
            Count::Exact(count) => count as f64,
            Count::About(count) => count,
        }
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Count::Exact(count) => write!(f, "{count}"),
            Count::About(count) => write!(f, "~{count:.3e}"),
        }
    }
}

/// Walks to the end per node, for one number of legs.
#[derive(Debug, Clone)]
pub(in crate::search) enum Layer {
    Exact(Vec<u128>),
    About(Vec<f64>),
}

/// Which of the two all of a layer's counts are: a layer turns to doubles as a whole, as soon as one sum does not fit.
impl Layer {
    pub(in crate::search) fn at(&self, node: u32) -> Count {
        match self {
            Layer::Exact(counts) => Count::Exact(counts[node as usize]),
            Layer::About(counts) => Count::About(counts[node as usize]),
        }
    }
}

/// Walks from every node to the end, for every number of legs up to a length: the backward pass, kept.
#[derive(Debug, Clone)]
pub struct Counts {
    layers: Vec<Layer>,
}

impl Counts {
    /// Walks of `legs` legs from the start to the end, that is trajectories of `legs` + 1 waypoints.
    ///
    /// `legs` below the length that the pass was made for.
    ///
    /// # Panics
    /// If the pass has no layer of as many legs.
    pub fn from_start(&self, legs: usize) -> Count {
        self.layers[legs].at(0)
    }

    pub(in crate::search) fn layer(&self, legs: usize) -> &Layer {
        &self.layers[legs]
    }
}

impl<N: Copy> LegGraph<'_, N> {
    /// Whether there is a trajectory of `length` waypoints, revisits allowed: a no is the proof that there is none.
    ///
    /// The pass over (∨, ∧): O(nodes · length) where most nodes lead on, O(legs · length) at most.
    pub fn has_walk(&self, length: usize) -> bool {
        let nodes = 0..self.nodes() as u32;
        let mut layer: Vec<bool> = nodes.clone().map(|node| self.at_end(node)).collect();
        for _ in 1..length {
            layer = nodes.clone().map(|node| self.rows.targets(node).any(|to| layer[to as usize])).collect();
        }
        length > 1 && layer[0]
    }

    /// Number of trajectories of every length: item ℓ counts those of ℓ waypoints, for ℓ = 0 ..= `length`. With
    /// revisits; without them it is an upper bound. Lengths beyond the one the graph was built for are undercounted.
    ///
    /// O(legs · length) additions, one layer in memory.
    ///
    /// Items 0 and 1 are zero, as trajectories have two ends. `length` + 1 items.
    pub fn counts_by_length(&self, length: usize) -> Vec<Count> {
        let mut counts = vec![Count::Exact(0), Count::Exact(0)];
        let mut layer = self.last_layer();
        while counts.len() <= length {
            layer = self.layer_before(&layer);
            counts.push(layer.at(0));
        }
        counts.truncate(length + 1);
        counts
    }

    /// The whole backward pass for trajectories of up to `length` waypoints.
    ///
    /// All layers: nodes · length numbers of 16 bytes.
    pub fn counts(&self, length: usize) -> Counts {
        let mut layers = vec![self.last_layer()];
        while layers.len() < length {
            layers.push(self.layer_before(&layers[layers.len() - 1]));
        }
        Counts { layers }
    }

    /// N₀: one walk of no legs from each node at the end.
    fn last_layer(&self) -> Layer {
        Layer::Exact((0..self.nodes() as u32).map(|node| u128::from(self.at_end(node))).collect())
    }

    /// Walks that are one leg longer than those of `after`.
    ///
    /// Of a row that nodes share one sum is taken, in integers: of a node's it is all but what its gap has.
    fn layer_before(&self, after: &Layer) -> Layer {
        let nodes = 0..self.nodes() as u32;
        match after {
            Layer::Exact(after) => {
                let sum = |to: &[u32]| to.iter().try_fold(0u128, |sum, &to| sum.checked_add(after[to as usize]));
                let rows = &self.rows;
                let all: Vec<Option<u128>> = (0..rows.count()).map(|row| sum(&rows.to[rows.kept(row)])).collect();
                let of_node = |node| match all[rows.number(node) as usize] {
                    Some(all) => Some(all - sum(&rows.to[rows.gap(node)])?),
                    None => rows.targets(node).try_fold(0u128, |sum, to| sum.checked_add(after[to as usize])),
                };
                match nodes.map(of_node).collect() {
                    Some(counts) => Layer::Exact(counts),
                    None => self.layer_before(&Layer::About(after.iter().map(|&count| count as f64).collect())),
                }
            }
            Layer::About(after) => {
                Layer::About(nodes.map(|node| self.rows.targets(node).map(|to| after[to as usize]).sum()).collect())
            }
        }
    }
}
