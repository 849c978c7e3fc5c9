//! The one seam between jobs and kinds of robots: what a kind answers, and nothing else that tells kinds apart.
//!
//! A job (generate, execute, judge, verify, shrink, explain, the report) asks a `Kind` and never which one it is. A
//! kind answers in a room of its own (`flight`, `drive`, `arm`), and is chosen once, where a resolved scenario becomes
//! a [`Setup`](super::Setup). Its questions come in three groups, so that what is proven, what is carried out and what
//! is told stay apart:
//!
//! | trait | asks |
//! | --- | --- |
//! | `Claim` | what is searched, planned and proven; what was lost, and what would help |
//! | `Act` | who carries a mission out, for how long, and what may stand in its way |
//! | `Say` | names, words and pictures, and what a run is measured against |
//!
//! What one kind alone has (an arm's graph, a quadrotor's rotors) is asked of its own setup, by the verbs that are
//! about nothing else: [`Setup::own`](super::Setup::own).
//!
//! | trait, type | asked by |
//! | --- | --- |
//! | `Solver` (of `Claim`) | generate, explain, compare: graphs, draws, changes of plans |
//! | `Replanner` (of `Claim`) | shrink: a case over fewer waypoints |
//! | `LegByLeg` (of `Act`) | searches that execute partial trajectories |
//! | `Fittable` (of `Act`) | fit: numbers, outputs and sampling |
//! | `Imitator` (of `Act`) | fit: runs with noise, and the signs that logs are compared by |
//! | `Programs` (of `Say`) | judge: runs move by move |
//!
//! A default answer stands for "this kind has none"; jobs then leave the step out or say so. Lengths are m, times s,
//! angles rad, in the world frame of the scenario, whatever the kind.

mod act;
mod axis;
mod build;
mod claim;
mod drawing;
mod figure;
mod fittable;
mod footing;
mod ground_log;
mod keep_out;
mod knob;
mod of_robot;
mod programs;
mod returning;
mod room;
mod rows;
mod same;
mod say;
mod solid;
mod task;

pub use act::PassedOver;
pub(super) use act::{Act, Imitator, LegByLeg, Order};
pub use axis::Axis;
pub(super) use build::{Build, Given};
pub(super) use claim::{Claim, Replanner, Solver};
pub use claim::{PlanError, Verified};
pub use drawing::{Drawing, Relief, Rotor};
pub use figure::{FigureLink, Look, RobotFigure, Turned};
pub(super) use figure::{block, capsule, prism, rod, wheel};
pub use fittable::Adjustable;
pub(super) use fittable::{Fittable, Output, Sampling};
pub use footing::{Footing, OnGround};
pub(super) use ground_log::GroundLog;
pub(super) use keep_out::flat_places;
pub(super) use knob::{Condition, Knob, Knobs, Standing, Turn};
pub(super) use of_robot::Kind;
pub(super) use programs::Programs;
pub use returning::Returning;
pub use room::{Room, Wall};
pub use rows::PlannedRows;
pub(super) use same::Same;
pub(super) use say::{Assumptions, BEYOND, Facts, Motion, RobotWords, Say, reached_within, word};
pub use say::{FrameWords, Handed};
pub use solid::{Surface, surface};
pub(super) use task::{Made, Task, verify_task, verify_times};
