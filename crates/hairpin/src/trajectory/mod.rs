//! Floor 4: motions as data. A [`Track`] is poses in time with named channels; a [`Profile`] is the polynomial
//! witness of a quadrotor's motion. Neither knows the world nor how it was found.
//!
//! | what | planned as | judged as |
//! | --- | --- | --- |
//! | a flight | [`Profile`]: polynomials of degree 7, leg by leg | [`Track`] in a [`Flight`] |
//! | a drive | [`Drive`]: segments of commanded curvature, speeds, directions | the same |
//! | an arm's motion | [`program::Program`]: moves with speeds and zones | the same, beside a [`PlannedPath`] |
//!
//! The left column is what a claim rests on and what a proof reads back: plain numbers that serialise and mean the same
//! to whoever reads them. The right one is all that the judge and the files know of motion: where something was, when,
//! and what it was called. Between them stands the simulator, or a real robot's log.
//!
//! Everything is in SI and rad, poses are `world_from_body` (of arms `base_from_tcp`), waypoints and legs are numbered
//! from 0 = start, leg k joins waypoints k and k + 1.

pub mod bends;
pub mod between;
pub mod direction;
pub mod drive;
pub mod flight;
pub mod legs;
pub mod planned_path;
pub mod profile;
pub mod program;
pub mod route;
pub mod speed;
pub mod start_table;
pub mod timing;
pub mod track;

pub use bends::{Tolerances, bends};
pub use direction::Direction;
pub use flight::{Ended, Flight};
pub use legs::{Drive, DriveLeg, Passing};
pub use planned_path::{PlannedMove, PlannedPath};
pub use profile::{Profile, ProfileLeg};
pub use route::Route;
pub use speed::{SpeedError, SpeedProfile, Speeds};
pub use timing::Timing;
pub use track::{ATTITUDE_UNKNOWN, Channel, END_UNSAID, HEIGHTS_BY_MAP, ROWS_LEFT_OUT, Track, TrackError};
