//! One sampled graph: what is asked of it, and what it gives.

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
