//! Floor 7: the pipeline. A scenario in; cases generated, executed and judged; one file per job. No files, no
//! arguments.
//!
//! ```text
//! scenario ─▶ Setup ─▶ generate ─▶ Case ─▶ execute ─▶ Run ─▶ judge ─▶ CaseResult ─▶ verdict, report
//!             │                    └─▶ verify ─▶ Verified, by the verification room
//!             └─ Kind: flight, drive, arm or boat; all of these ask it, and never which one it is
//! ```
//!
//! | room or file | job |
//! | --- | --- |
//! | `scenario`, `setup`, `attachments` | keys, their bounds, and what they describe |
//! | `kind`; `flight`, `drive`, `arm`, `boat` | the seam between jobs and robots, and what answers behind it |
//! | `generate`, `graph`, `learn` | cases from searches, with and without executions |
//! | `execute`, `executor`, `mission`, `trial` | runs of cases, here or wherever a caller carries them out |
//! | `judge`, `landed`, `flown`, `fit` | what runs and logs come to |
//! | `verify`, `passage` | witnesses, written or asked for, held to the proof |
//! | `compare`, `explain`, `shrink`, `select`, `influence`, `coverage`, `calibrate` | jobs over what is there |
//! | `verdict`, `report`, `assumptions` | what is told of it |
//!
//! Every job is a function of plain data: a [`Setup`], cases, runs; a [`Stop`] brings
//! clock, progress and interruption from outside. Results depend on the scenario and its seed alone, on any number of
//! threads, unless a time ends a job.

pub mod answers;
pub mod arm;
pub mod assumptions;
pub mod attachments;
mod attitude;
pub mod baseline;
pub mod boat;
pub mod bounds;
pub mod calibrate;
pub mod callers_code;
pub mod case;
pub mod case_number;
pub mod chance;
mod check;
mod clock;
pub mod compare;
pub mod convoy;
mod counted;
pub mod coverage;
pub mod curve;
pub mod digits;
pub mod drive;
pub mod execute;
pub mod executor;
pub mod explain;
pub mod failures;
pub mod fit;
pub mod flight;
pub mod flown;
pub mod full_rate;
pub mod generate;
pub mod goals;
mod graph;
mod gravity;
mod hidden;
pub mod implausible;
mod impossible;
pub mod influence;
pub mod judge;
pub mod kind;
pub mod landed;
pub mod learn;
pub mod missed;
pub mod mission;
pub mod own_controller;
pub mod passage;
pub mod passes;
mod placement;
pub mod rank;
pub mod report;
pub mod samples;
pub mod scenario;
pub mod select;
pub mod setup;
pub mod shrink;
pub mod states;
pub mod stop;
pub mod tally;
#[cfg(feature = "unit-tests")]
mod testing;
mod trial;
mod user_code;
pub mod user_controller;
pub mod user_score;
pub mod user_target;
pub mod vary;
pub mod verdict;
pub mod verify;

pub use assumptions::assumptions;
pub use attachments::{Attached, Attachments, Resolved};
pub use callers_code::CallersCode;
pub use case::{Case, CaseResult, Draws, Evidence, Reruns, Run, SeenLeg, Status, Timed, Undone, Witness};
pub use case_number::CaseNumber;
pub use chance::Baseline;
pub use compare::{Comparison, compare};
pub use coverage::{Coverage, Grid};
pub use curve::Curve;
pub use execute::{execute, execute_again, execute_run};
pub use executor::{Batch, Executor, OwnSimulator};
pub use failures::Failures;
pub use flown::{Doubt, Exceeded, Flown, FlownError, Log, Why, judge_flown, plan_followed};
pub use full_rate::FullRate;
pub use generate::{Known, Optimum, generate, optima};
pub use graph::{Losses, Lost, Stage};
pub use influence::{Influence, RunDeviation, influences};
pub use judge::{contradiction, judge, judge_runs, unlike};
pub use kind::{Footing, OnGround, PassedOver, PlanError, PlannedRows, Verified};
pub use landed::at_full_rate;
pub use mission::{Mission, mission, mission_again, planned, planned_rows};
pub use own_controller::AnyController;
pub use passage::{Broken, Certainty, Demands, Passage, Passed, PassedLeg};
pub use passes::passes;
pub use rank::{Rank, stresses};
pub use scenario::{Distribution, Environment, Mistake, Scenario};
pub use setup::Setup;
pub use shrink::{ShrinkError, Shrunk, shrink};
pub use stop::Stop;
pub use tally::{RoundTally, Tally};
pub use trial::foreign_seed;
pub use user_code::UserCode;
pub use user_controller::UserController;
pub use user_score::LegScorer;
pub use user_target::RunMeter;
pub use verdict::{how_obtained, verdict, verdict_on};
pub use verify::{verify, verify_mission, verify_planned};
