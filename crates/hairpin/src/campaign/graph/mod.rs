//! One sampled graph: what is asked of it, and what it gives.
//!
//! ```text
//! Question (graph, reach set, score, method) ─ search ─▶ Answer ─▶ Outcome (plans by number of graph, counts, curves)
//!    method:  beam · exact · uniform   search::{beam, exact, uniform}
//!             in-loop                  in_loop: optima and draws ─▶ evolve ─▶ shift ─▶ climb
//!             executed (partial)       partial: the beam, scored by executions
//!             a round, several optima  rounds, optima
//! ```
//!
//! Generic in the node of a reach set alone, since searches are compiled once for each; scores, reach sets and
//! executions come in as trait objects.

mod answer;
mod executions;
mod explore;
mod in_loop;
mod in_order;
mod losses;
mod optima;
mod outcome;
mod partial;
mod plan;
mod question;
mod remembered;
mod rounds;
mod scores;
mod search;
mod witnessed;

pub(super) use executions::{Executions, Partials, Surroundings, into_unit_ball};
pub(super) use explore::{Explored, GRAPHS};
pub(super) use in_order::in_order;
pub(super) use losses::Counter;
pub use losses::{Losses, Lost, Stage};
pub(super) use optima::AGGREGATES;
pub(super) use outcome::Outcome;
pub(super) use plan::{Plan, between, fingerprint, met};
pub(super) use question::{Looped, Question, Round, Wanted};
pub(super) use remembered::Remembered;
pub(super) use scores::{Named, learned};
pub(super) use search::search;
pub(super) use witnessed::{Counted, Roads, Witnessed};
