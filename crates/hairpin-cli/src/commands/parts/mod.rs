//! The four parts of `stress`, each on what the one before left in the campaign folder.

mod answer;
mod execute;
mod generate;
mod graph;
mod judge;
mod keep;
pub(crate) mod optimum;
mod programs;
mod recorded;
mod repro;
mod saved;

pub(crate) use answer::{Answer, point_to_explain};
pub(crate) use execute::{Flown, attitude_unknown, execute, fly_one};
pub(crate) use generate::{adopt, generate};
pub(crate) use judge::{Judgement, judge, report, with_moves};
pub(crate) use programs::keep_programs;
pub(crate) use recorded::check_recordings;
pub(crate) use repro::{Repro, ShrunkFrom};
pub(crate) use saved::{Replayed, replay_saved, with_saved};
