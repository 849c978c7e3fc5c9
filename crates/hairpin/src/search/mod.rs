//! Floor 6: scores and the searches over them. Points, a reach set and a score come in; nothing else is known.
//!
//! [`beam`] is algorithms 1 and 2 of the paper on one graph.

pub mod beam;
mod frontier;
pub mod objective;
#[cfg(test)]
mod small;
pub mod task;

pub use beam::{BeamOutcome, BeamSettings, beam};
pub use objective::{Aggregate, LegView, Objective, Score, ScoreMistake};
pub use task::{Found, Task};
