//! Arms: a cell and a cloud of points, the reachability graph between them, and the programs that load the arm most.

mod assumptions;
mod cell;
mod claim;
mod clock;
mod deaths;
mod execute;
mod graph;
mod judge;
mod moves;
mod plan;
mod points;
mod program;
mod recorded;
mod regression;
mod replan;
mod solve;
mod station;
mod verify;

pub(super) use assumptions::{act, claim, search, verdict};
pub use claim::GraphAgain;
pub use clock::ArcClock;
pub(super) use deaths::deaths;
pub(super) use execute::run;
pub use graph::{ArmGraph, graph_of};
pub(super) use judge::{in_small_units, latest, measured};
pub use moves::{Baseline, BaselineError, CaseMoves, Moves, ReleaseMoves, RunMoves};
pub(super) use plan::track;
pub use points::CellPoint;
pub use recorded::Shorter;
pub use regression::RegressionError;
pub(super) use replan::Replanner;
pub use solve::Question;
pub(super) use solve::Solver;
pub(super) use station::station_of;
pub use station::{ArmSetup, Station};
pub(super) use verify::verify;
