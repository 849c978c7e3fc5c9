//! Boundary-value drives of ground vehicles: one question, or many from a file. Every answer is replayed by an
//! integration of its own.

mod answered;
mod batch;
mod ground;
mod holes;
mod level;
mod pace;
mod plane;
mod queries;
mod question;
mod remedy;
mod run;
mod settings;
mod solver;
mod start_table;
mod states;
mod summary;
#[cfg(test)]
mod tests;
mod tolerance;
mod trace;
mod vehicle;

pub use answered::{Answered, Near};
pub use batch::Batch;
pub use pace::{Pace, Rows};
pub use queries::Answers;
pub use question::{Question, goal_in_the_map, in_frame, pieces, seen_from, stretches};
pub use remedy::Remedies;
pub use settings::{Effort, SteerSettings};
pub use start_table::{MadeTable, make_start_table};
pub use summary::{Body, ControlParameters, CostOf, Directions, Forces, Moment, Speeds, Summary, Wheels};
pub use vehicle::Vehicle;
