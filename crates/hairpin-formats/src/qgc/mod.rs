//! Missions as ground stations keep them: QGroundControl's `.plan` and the text that it shares with Mission Planner and
//! pymavlink, QGC WPL 110.

mod follow;
mod item;
pub mod read_plan;
pub mod read_wpl;
mod words;

pub use follow::{Ending, Open, Station, Uploaded};
pub use item::Wrong;
