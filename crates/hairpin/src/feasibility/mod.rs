//! Floor 5, the claim: limits, collision, reach sets, steering. Nothing of objectives, controllers or the judge.
//!
//! What a claim rests on, and nothing of how well it is flown. One room for each question:
//!
//! | room | question | answer |
//! | --- | --- | --- |
//! | [`limits`], [`collision`] | does a leg keep its bounds everywhere? | proven, or [`Infeasible`] |
//! | [`steering`] | which controls lead from state to state? | a leg, or why there is none |
//! | [`reach`] | which waypoints follow a node? | legs, for any search |
//! | [`mod@certify`] | could anything fly these waypoints? | yes with a witness, no with a reason, unknown |
//! | [`mod@hold`] | at speeds that somebody demands? | a witness, or the legs that are refused |
//! | [`reachability`] | which moves can an arm make between points? | a graph with costs and refusals |
//! | [`program`] | can an arm execute this program? | findings, move by move |
//!
//! Words of evidence are kept apart: a hull is a filter ("hull-feasible"), a witness integrates ("witnessed"), a proof
//! between samples says so, and floating point with a stated room is not called interval arithmetic. A negative answer
//! is an answer: cheap, `Copy` where it can be, with numbers.
//!
//! The act (`simulation`) shares the robots' equations with this room and none of its checks; the proof
//! (`verification`) shares nothing.

pub mod boat;
pub mod certify;
pub mod collision;
pub mod hold;
pub mod limits;
pub mod program;
pub mod reach;
pub mod reachability;
pub mod steering;

pub use certify::{Certificate, Impossible, certify};
pub use collision::FreeSpace;
pub use limits::{Infeasible, Limit, Limits};
