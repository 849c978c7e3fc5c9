//! Arms: a cell and a cloud of points, the reachability graph between them, and the programs that load the arm most.

mod alter;
mod assumptions;
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
mod hidden;
mod judge;
mod knobs;
mod losses;
mod moves;
mod obstructions;
mod plan;
mod points;
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
#[cfg(test)]
mod tests;
mod verify;
mod ways;
mod written;

pub use clock::ArcClock;
pub use graph::{ArmGraph, graph_of};
pub use points::CellPoint;
pub use recorded::Shorter;
pub use regression::RegressionError;
pub use retrace::GraphAgain;
pub use solve::Question;
pub use station::{ArmSetup, Station};
