//! Floor 6: scores and the searches over them. Points, a reach set and a score come in; nothing else is known.
//!
//! [`beam()`] is algorithms 1 and 2 of the paper on one graph; [`exact()`] is dynamic programming over the legs of a
//! [`graph`]: best, k best, counts, the proof that none exists; [`uniform()`] draws evenly from all that is feasible.
//! [`heaviest`] is the path of maximal cost through a graph of arcs that visits no point twice. [`ddmin()`] finds the
//! part of a list that it takes to fail.
//!
//! | asked | room | answer |
//! | --- | --- | --- |
//! | good trajectories of a large graph, soon | [`mod@beam`] | found, and why it ended |
//! | the best, proven | [`mod@exact`] | k best, an upper bound, how many there are |
//! | what is typical | [`mod@uniform`] | draws, each trajectory equally likely |
//! | what is typical, of few legs | [`mod@stroll`] | one draw, step by step |
//! | the worst as executed, of all graphs | [`worst`] | the worst that differ, by their executed stress |
//! | the same in one graph | [`in_loop`] | trajectories by their executed stress |
//! | the heaviest tour of an arm's points | [`heaviest`] | paths, a bound, a certificate |
//! | the shortest part that still fails | [`mod@ddmin`] | that part |
//!
//! Data flow of the first four: points + [`crate::feasibility::reach::Reach`] + a start's node make a [`Task`]; the
//! beam asks legs as it goes, the others build a [`LegGraph`] once; a score ([`Score`], any closure, anything that is
//! [`Objective`] or [`Additive`]) says what a leg is worth, [`Aggregate`] what legs come to; a [`Found`] says which
//! waypoints, nodes and times. What executes or simulates comes in as a closure or trait: no search knows a robot, a
//! world or a file.
//!
//! Every search is deterministic: ties by waypoint index, draws from named seeds, the same answer on any number of
//! threads. Limits are counts; who has a clock passes a closure.

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
#[cfg(feature = "unit-tests")]
mod small;
pub mod stroll;
pub mod task;
pub mod uniform;
pub mod worst;

pub use beam::{BeamOutcome, BeamSettings, beam, beam_grown};
pub use ddmin::ddmin;
pub use exact::{ExactOutcome, ExactSearch, ExactSettings, Ranking, Scored, exact, exact_proven};
pub use graph::{Count, LegGraph};
pub use growth::{ByLegs, Growth, Parent};
pub use objective::{Additive, Aggregate, ByTurn, LegView, Objective};
pub use open_end::{OpenEnd, OpenNode, OpenScore};
pub use score::{Score, ScoreMistake};
pub use stroll::{NoWalk, stroll};
pub use task::{Found, Task};
pub use uniform::{UniformOutcome, UniformSettings, uniform, uniform_proven};
