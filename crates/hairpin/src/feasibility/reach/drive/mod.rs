//! `witness` for ground vehicles: a roadmap of headed waypoints, whose legs are solved boundary-value drives.
//!
//! Data flow: [`sample_ground`] places where a body can stand → headings and directions of each waypoint, by its number
//! → a leg when a search first asks for it: Dubins' length refuses what must be a long way round, then the manoeuvres
//! in turn (forward, reverse, turns in place), each solved on the map and looked along for limits, keep-outs and torque
//! → kept with its score. What was refused is counted by its one reason ([`DriveTally`]), which is what an empty
//! campaign tells.
//!
//! | file | does |
//! | --- | --- |
//! | `sample` | places on the map where a body can stand |
//! | `settings` | what legs may do, and how hard they are looked for |
//! | `roadmap` | nodes, legs solved lazily, whole drives |
//! | `draft` | drives of which waypoints are changed, and only the legs beside them solved again |
//! | `ways`, `judge` | manoeuvres in turn, each solved by [`steering`](crate::feasibility::steering) |
//! | `watch`, `wheels` | limits, keep-outs, torque and what wheels may do along the predicted motion |
//! | `pace` | speeds of whole drives |
//! | `stress`, `straight` | scores of legs, and of straight lines where there are no commands |
//! | `through` | drives through places that somebody else chose |
//! | `tally` | reasons of refused legs, counted |

mod clearance;
mod draft;
mod headings;
mod judge;
mod pace;
mod roadmap;
mod sample;
mod settings;
mod straight;
mod stress;
mod tally;
mod through;
mod watch;
mod ways;
mod wheels;

pub use clearance::ClearanceSamples;
pub use draft::DriveDraft;
pub use pace::{Pace, Slopes};
pub use roadmap::{DriveLegs, DriveNode, DriveRoadmap};
pub use sample::{GroundSampling, TooFewPlaces, sample_ground};
pub use settings::{DriveLimits, DriveSettings, DriveSite, Manoeuvres};
pub use straight::StraightLegs;
pub use stress::{GroundScore, UnknownTerms};
pub use tally::{DriveTally, LegRefusal};
pub use through::{Through, ThroughLeg, through};
pub use watch::stands;
