//! Missions made elsewhere, whichever program wrote them, in one shape: waypoints in metres of the world, what is asked
//! of the legs between them, and what of the file is not followed.

mod demands;
mod error;
mod mission;
mod place;
mod read;
#[cfg(test)]
mod tests;

pub use demands::{Demands, FenceTold, Fences};
pub use error::MissionError;
pub use mission::{Fence, Frame, Mission, Outline, Stop, Uncertain, Whose};
pub use read::{environment_path, read, read_all};
