//! `witness` for ground vehicles: a roadmap of headed waypoints, whose legs are solved boundary-value drives.

mod judge;
mod looks;
mod pace;
mod roadmap;
mod sample;
mod settings;
mod straight;
mod stress;
mod tally;
mod watch;
mod ways;

pub use looks::DriveLooks;
pub use pace::{Pace, Slopes};
pub use roadmap::{DriveLegs, DriveNode, DriveRoadmap};
pub use sample::{GroundSampling, TooFewPlaces, sample_ground};
pub use settings::{DriveLimits, DriveSettings, DriveSite, Manoeuvres};
pub use straight::StraightLegs;
pub use stress::{GroundScore, UnknownTerms};
pub use tally::{DriveTally, LegRefusal};
