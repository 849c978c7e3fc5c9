//! Floor 7: the pipeline. A scenario in; cases generated, executed and judged; one file per job. No files, no arguments.

pub mod case;
pub mod scenario;

pub use case::{Case, CaseResult, Evidence, Run, Status};
pub use scenario::{Mistake, Scenario};
