//! Continuous-curvature steering on flat ground, in closed form: the reference for lengths, and an answer to every
//! query.
//!
//! Every query has an answer here, however long; the shortest of its words, not of all paths. What the iterative
//! solvers find is held against it: 1.04 times its length in the median over far goals (docs/rover-generator.md).
//!
//! `turn` is what a turn of clothoid, arc, clothoid does, `words` spell turns and straights between two states, `path`
//! tries words of two circles from every state that a clothoid makes of both ends and keeps the shortest. Nothing
//! iterates; one question costs some hundred words, most of which a bound of their length refuses.

mod path;
mod turn;
mod words;

#[cfg(feature = "unit-tests")]
mod tests;

pub use path::{Gears, Path, every, steer};
