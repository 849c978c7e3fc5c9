//! Floor 7: the pipeline. A scenario in; cases generated, executed and judged; one file per job. No files, no arguments.

pub mod case;
pub mod generate;
pub mod mission;
pub mod report;
pub mod scenario;
pub mod setup;
pub mod stop;
pub mod vary;

pub use case::{Case, CaseResult, Evidence, Run, Status};
pub use generate::Tally;
pub use mission::{Mission, Timed};
pub use scenario::{Mistake, Scenario};
pub use setup::Setup;
pub use stop::Stop;
