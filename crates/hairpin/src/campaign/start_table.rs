//! Tables of start values of drives, as files hold them.

pub use crate::feasibility::steering::shooting::flat::StartTable;
pub use crate::feasibility::steering::shooting::flat::start_table::{ENTRIES, Entry, NODES, NONE, StartTableError};
