//! Floor 7: the pipeline. A scenario in; cases generated, executed and judged; one file per job. No files, no arguments.

pub mod assumptions;
pub mod case;
pub mod execute;
pub mod generate;
pub mod goals;
pub mod ground;
pub mod influence;
pub mod judge;
pub mod mission;
pub mod plan;
pub mod report;
pub mod scenario;
pub mod setup;
pub mod stop;
pub mod vary;
pub mod verify;

pub use assumptions::assumptions;
pub use case::{Case, CaseResult, Evidence, Run, Status};
pub use execute::{execute, execute_run};
pub use generate::{Known, Tally, generate};
pub use influence::{Influence, RunDeviation, influences};
pub use judge::{how_obtained, judge, judge_runs, verdict};
pub use mission::{Mission, Timed, mission};
pub use scenario::{Mistake, Scenario};
pub use setup::Setup;
pub use stop::Stop;
pub use verify::{Verified, verify};
