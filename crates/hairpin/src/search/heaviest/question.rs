//! What may be asked of a graph, and what is answered.

use thiserror::Error;

use super::problem::{ArcsMistake, Ends};
use super::record::Proof;

/// How a path is searched.
///
/// `Local` gives a bound as well, that of the root; `Dfs` is there to be compared with.
///
/// All but `Local` end with a proof, given time and memory; `Dfs` in factorial time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// Subsets for few points, else branch and bound; between the two, subsets where that is not proven at once.
    #[default]
    Auto,
    /// Dynamic programming over subsets.
    Subsets,
    /// Branch and bound.
    Branch,
    /// Local search under a bound, without branching.
    Local,
    /// Depth-first search over all paths, cut only by the number of arcs left: the published baseline.
    Dfs,
}

impl Method {
    /// As it is typed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Subsets => "subsets",
            Self::Branch => "branch",
            Self::Local => "local",
            Self::Dfs => "dfs",
        }
    }
}

/// What is wanted.
///
/// Limits are counts (`most_nodes`, `kicks`, `most_bytes`); a clock comes in as `stop`.
#[derive(Debug, Clone)]
pub struct HeaviestSettings {
    /// Fixed ends.
    pub ends: Ends,
    /// Paths below this cost are not wanted.
    ///
    /// Bounds close whatever cannot come to it, so that a high one makes a no quick.
    pub min_cost: Option<i64>,
    /// How to search.
    pub method: Method,
    /// How many pairwise different paths are wanted, the heaviest first.
    ///
    /// 0 is taken as 1. Where costs are symmetric and no end is fixed, a path and its reverse are one.
    pub programs: usize,
    /// Root seed of the local search.
    pub seed: u64,
    /// Kicks of the local search in each round; as many as points if not given.
    pub kicks: Option<u64>,
    /// Problems that each part of branch and bound looks at, at most: a limit that gives the same answer on any
    /// machine.
    ///
    /// There are about 32 parts, so that the whole may look at that many times as many.
    pub most_nodes: Option<u64>,
    /// Bytes that the table of subsets may take.
    ///
    /// 2ⁿ · n cells, which [`HeaviestMistake::Memory`] tells where it is too little. 1 GiB if not given.
    pub most_bytes: u64,
    /// Whether to keep the proof.
    pub proof: bool,
}

impl Default for HeaviestSettings {
    fn default() -> Self {
        Self {
            ends: Ends::default(),
            min_cost: None,
            method: Method::Auto,
            programs: 1,
            seed: 0,
            kicks: None,
            most_nodes: None,
            most_bytes: 1 << 30,
            proof: false,
        }
    }
}

/// Why a question has no answer.
///
/// Found before anything is searched.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum HeaviestMistake {
    /// The table or the ends.
    #[error(transparent)]
    Arcs(#[from] ArcsMistake),
    /// The table of subsets would not fit.
    #[error("dynamic programming over subsets of {points} points takes {bytes} bytes, must be at most {bound}")]
    Memory {
        /// Points.
        points: usize,
        /// Bytes that it takes.
        bytes: u128,
        /// Bytes allowed.
        bound: u64,
    },
    /// Only branch and bound ranks paths.
    #[error("{programs} different paths by method {method}, must be 1: only branch gives more")]
    Programs {
        /// Paths asked for.
        programs: usize,
        /// The method asked for.
        method: &'static str,
    },
}

/// What came of it.
///
/// `Infeasible` and `BelowMinCost` are proven; `NotFound` is not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// A path.
    Found,
    /// The fixed end cannot be reached from the fixed start.
    Infeasible,
    /// No path costs as much as was asked for: proven, and the bound says what is possible.
    BelowMinCost,
    /// None of the wanted cost was found yet.
    NotFound,
}

/// The heaviest path.
///
/// `bound` ≥ the heaviest path's cost, always; equal to `paths[0]`'s where proven. Costs and bound are in the table's
/// unit.
#[derive(Debug, Clone)]
pub struct Heaviest {
    /// What came of it.
    pub outcome: Outcome,
    /// Paths with their costs, the heaviest first: pairwise different.
    pub paths: Vec<(i64, Vec<usize>)>,
    /// Of each path the points that its triples pass, in order; nothing where there are no triples.
    pub passed: Vec<Vec<usize>>,
    /// No path costs more; `None` if there is no path.
    pub bound: Option<i64>,
    /// Whether the first path is proven the heaviest (all paths the heaviest ones, where more were asked for).
    pub proven: bool,
    /// The method that was used.
    pub method: Method,
    /// Problems that branch and bound looked at.
    pub nodes: u64,
    /// The proof by branch and bound, if it was to be kept and is complete.
    pub proof: Option<Proof>,
}

impl Heaviest {
    /// Of paths of arcs, found without branching.
    pub(super) fn found(paths: Vec<(i64, Vec<usize>)>, bound: Option<i64>, proven: bool, method: Method) -> Self {
        let passed = Vec::new();
        Self { outcome: Outcome::Found, paths, passed, bound, proven, method, nodes: 0, proof: None }
    }

    /// 100 (bound − cost) / cost; 0 where both are 0, infinite where only the cost is.
    ///
    /// `None` without a path or a bound. Not of the optimum, which may lie anywhere between.
    pub fn gap_percent(&self) -> Option<f64> {
        let (cost, bound) = (self.paths.first()?.0, self.bound?);
        Some(if bound == cost { 0.0 } else { 100.0 * (bound - cost) as f64 / cost as f64 })
    }
}

/// Holds the answer to the cost that was asked for.
///
/// Paths below `min_cost` go; if that was the first, the outcome is `BelowMinCost` where it is proven or the bound says
/// so, else `NotFound`.
pub(super) fn wanted(mut found: Heaviest, settings: &HeaviestSettings) -> Heaviest {
    let least = settings.min_cost.unwrap_or(0);
    if found.outcome == Outcome::Found && found.paths.first().is_none_or(|(cost, _)| *cost < least) {
        let impossible = found.proven || found.bound.is_some_and(|bound| bound < least);
        found.outcome = if impossible { Outcome::BelowMinCost } else { Outcome::NotFound };
        found.paths.clear();
    }
    found.paths.retain(|(cost, _)| *cost >= least);
    found
}
