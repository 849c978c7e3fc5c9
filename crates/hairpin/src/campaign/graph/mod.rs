//! One sampled graph: what is asked of it, and what it gives.

mod deaths;
mod explore;
mod in_loop;
mod in_order;
mod optima;
mod outcome;
mod partial;
mod rounds;
mod search;

pub(super) use deaths::Counter;
pub use deaths::{Deaths, Lost, Stage};
pub(super) use explore::{Explored, GRAPHS};
pub(super) use in_order::in_order;
pub(super) use optima::AGGREGATES;
pub(super) use outcome::{Outcome, Plan, fingerprint};
pub(super) use partial::Partials;
pub(super) use rounds::Round;
pub(super) use search::{Executions, Looped, Question, Surroundings, Wanted, search};
