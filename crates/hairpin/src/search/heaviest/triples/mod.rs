//! Moves that pass a point on their way: the heaviest path where a triple may stand for two arcs.
//!
//! A path p₁ … p_m is cut into arcs (p_k, p_{k+1}) and triples (p_k, p_{k+1}, p_{k+2}), each point on the way being one
//! of the path's; no point comes twice. Of few points it is exact, by dynamic programming over subsets; of more it is
//! annealed under a bound from walks with prices.
//!
//! For programs with arcs (MoveC): a triple passes its middle point, which then counts as met. Bounds for paths of
//! pairs do not carry over, since a triple may cost more than its two arcs.

mod anneal;
mod problem;
mod solve;
mod subsets;
mod walks;

#[cfg(feature = "unit-tests")]
mod tests;

pub use problem::{MOST_TRIPLE_POINTS, Triples, TriplesMistake};
pub use solve::{MOST_EXACT_POINTS, heaviest_with_triples};
