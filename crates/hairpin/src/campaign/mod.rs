//! Floor 7: the pipeline. A scenario in; cases generated, executed and judged; one file per job. No files, no arguments.

pub mod arm;
pub mod assumptions;
pub mod case;
pub mod drive;
pub mod execute;
pub mod experiment;
pub mod flight;
pub mod generate;
pub mod goals;
mod graph;
pub mod influence;
pub mod judge;
pub mod mission;
pub mod planned;
pub mod report;
pub mod scenario;
pub mod setup;
pub mod start_table;
pub mod states;
pub mod stop;
mod terms;
pub mod vary;
pub mod verify;

pub use assumptions::assumptions;
pub use case::{Case, CaseResult, Evidence, Run, Status, Timed};
pub use execute::{execute, execute_run};
pub use generate::{Known, Tally, generate};
pub use influence::{Influence, RunDeviation, influences};
pub use judge::{how_obtained, judge, judge_runs, verdict};
pub use mission::{Mission, mission};
pub use planned::{PlanError, planned};
pub use scenario::{Mistake, Scenario};
pub use setup::{Kind, Setup};
pub use stop::Stop;
pub use verify::{Verified, verify};
