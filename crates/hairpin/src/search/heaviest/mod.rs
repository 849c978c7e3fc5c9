//! The path of maximal total cost through a graph in which no point comes twice; points may be left out, ends be fixed.
//!
//! [`heaviest`] proves it: by dynamic programming over subsets of few points, else by branch and bound on Lagrangian
//! bounds that hold where points may be left out, under a path from local search. [`heaviest_walk`] lets points come
//! several times. `docs/heaviest-paths.md` has the equations.
//!
//! ```text
//! max Σ c(i, j) over paths          each point at most once (or at most K times; or passed by a move on its way)
//! ```
//!
//! | points | method | file |
//! | --- | --- | --- |
//! | to 14 | subsets, O(2ⁿ n²) | `subsets` |
//! | to 16 | branch and bound first, subsets if it has to split much | `one` |
//! | more | branch and bound under Lagrangian bounds | `prove`, `root`, `branch` |
//! | several parts, no way between them | each by itself, the largest bound first | `parts` |
//! | any, points K times | branch and bound on circulations | `walk` |
//! | any, moves that pass points | subsets to 20, else annealing under walks with prices | `triples` |
//!
//! Costs are whole numbers (µm, µs, counts): every sum and bound is exact, and a certificate can be checked by
//! addition. Data flow of branch and bound: a path by local search (`local`) → first multipliers → subgradient steps
//! (`ascent`, means of solutions in `volume`, the paths they are close to in `rounded`) on a relaxation (`forest` where
//! costs are symmetric, `arborescence` where they are not) → what the bound decides under a guessed cost (`choices`,
//! `prove`) → splits (`branch`) → a tree of steps (`record`), which [`crate::verification::verify_heaviest`]
//! recomputes.

mod arborescence;
mod ascent;
mod best;
mod branch;
mod choices;
mod circulation;
mod cut;
mod cuts;
mod dfs;
mod first_multipliers;
mod forest;
mod local;
mod one;
mod parts;
mod problem;
mod prove;
mod question;
mod record;
mod relaxation;
mod root;
mod rounded;
mod several;
mod solve;
mod subsets;
mod tour;
mod triples;
mod volume;
mod walk;
mod walks;
mod whole;
mod workspace;

#[cfg(feature = "unit-tests")]
mod tests;

pub use problem::{Arcs, ArcsMistake, Ends, MOST_POINTS};
pub use question::{Heaviest, HeaviestMistake, HeaviestSettings, Method, Outcome};
pub use record::{Next, PricedCut, Proof, Step};
pub use solve::heaviest;
pub use subsets::{MOST_SUBSET_POINTS, subset_bytes};
pub use triples::{MOST_EXACT_POINTS, MOST_TRIPLE_POINTS, Triples, TriplesMistake, heaviest_with_triples};
pub use walk::{Split, WalkProof, WalkStep};
pub use walks::{MOST_VISITS, WalkMistake, WalkSettings, heaviest_walk};
pub use workspace::Workspace;
