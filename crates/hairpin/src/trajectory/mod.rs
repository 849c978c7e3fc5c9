//! Floor 4: motions as data. A [`Track`] is poses in time with named channels; a [`Profile`] is the polynomial
//! witness of a quadrotor's motion. Neither knows the world nor how it was found.

pub mod direction;
pub mod drive;
pub mod flight;
pub mod legs;
pub mod planned_path;
pub mod profile;
pub mod program;
pub mod speed;
pub mod timing;
pub mod track;

pub use direction::Direction;
pub use flight::{Ended, Flight};
pub use legs::{Drive, DriveLeg, Passing};
pub use planned_path::{PlannedMove, PlannedPath};
pub use profile::{Profile, ProfileLeg};
pub use speed::{SpeedError, SpeedProfile, Speeds};
pub use timing::Timing;
pub use track::{ATTITUDE_UNKNOWN, Channel, Track, TrackError};
