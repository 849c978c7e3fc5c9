//! Arms: a cell and a cloud of points, the reachability graph between them, and the programs that load the arm most.
//!
//! ```text
//! ArmScenario ─▶ build, check ─▶ ArmSetup (Station: arm, tool, work object, cell, points)
//!   Claim:  graph (feasibility::reachability) ─▶ question ─▶ search::heaviest ─▶ solve ─▶ program ─▶ Plan
//!           drawn and bred instead: ways ─▶ draw, alter ─▶ program
//!   Act:    execute ─▶ simulation::arm, or recorded: a log of the real arm
//!   judge:  plan (path with its zones) ─▶ judgement::moves; hidden: what a log does not show; beyond: where no
//!           joint stands; regression: two releases
//!   told:   idle: keys that no run reads
//!   out:    handed: as controllers take programs
//!   proof:  verify, retrace ─▶ verification, as plain numbers (written); held: to the scenario as it stands now
//!   Say:    say, assumptions, figure, losses, obstructions, doubt, knobs
//! ```
//!
//! Base frame: that of the arm's chain. Everything inside is in m, rad, s; mm, deg and ms are those of the scenario's
//! keys and of what is told. A *row* is a point's place in the cloud, from 0. Programs begin and end at home, which
//! is no point of the cloud.

mod alter;
mod arm_graph;
mod assumptions;
mod beyond;
mod build;
mod cell;
mod check;
mod claim;
mod clock;
mod doubt;
mod draw;
mod execute;
mod figure;
mod fit;
mod graph;
mod handed;
mod held;
mod hidden;
mod idle;
mod judge;
mod knobs;
mod losses;
mod moves;
mod obstructions;
mod plan;
mod points;
mod posture;
mod program;
mod recorded;
mod regression;
mod replan;
mod retrace;
mod say;
mod seen;
mod solve;
mod solver;
mod station;
mod steered;
#[cfg(feature = "unit-tests")]
mod tests;
mod verify;
mod ways;
mod written;

pub use arm_graph::ArmGraph;
pub use beyond::{Beyond, TooFast};
pub use clock::ArcClock;
pub use graph::{graph_of, graph_until};
pub use points::CellPoint;
pub use recorded::Shorter;
pub use regression::RegressionError;
pub use retrace::GraphAgain;
pub use solve::Question;
pub use station::{ArmSetup, Station};
