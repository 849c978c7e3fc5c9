//! Floor 6: scores and the searches over them. Points, a reach set and a score come in; nothing else is known.
//!
//! [`beam()`] is algorithms 1 and 2 of the paper on one graph; [`exact()`] is dynamic programming over the legs of a
//! [`graph`]: best, k best, counts, the proof that none exists; [`uniform()`] draws evenly from all that is feasible. [`heaviest`] is the
//! path of maximal cost through a graph of arcs that visits no point twice. [`ddmin()`] finds the part of a list that it takes to fail.

pub mod beam;
pub mod ddmin;
pub mod exact;
mod frontier;
pub mod graph;
pub mod growth;
pub mod heaviest;
pub mod in_loop;
pub mod objective;
pub mod open_end;
pub mod score;
#[cfg(test)]
mod small;
pub mod task;
pub mod uniform;

pub use beam::{BeamOutcome, BeamSettings, beam, beam_grown};
pub use ddmin::ddmin;
pub use exact::{ExactOutcome, ExactSearch, ExactSettings, Ranking, Scored, exact};
pub use graph::{Count, LegGraph};
pub use growth::{ByLegs, Growth, Parent};
pub use objective::{Additive, Aggregate, LegView, Objective};
pub use open_end::{OpenEnd, OpenNode, OpenScore};
pub use score::{Score, ScoreMistake};
pub use task::{Found, Task};
pub use uniform::{UniformOutcome, UniformSettings, uniform};
