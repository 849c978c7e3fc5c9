//! Floor 6, the proof: equations and an integrator of its own, fed with what a campaign wrote.
//!
//! A witness claims: under the rotor speeds that its polynomials imply, the robot flies from waypoint to waypoint,
//! level and at rest in its rates at each. Here that is checked by other means than those that found it: rotor speeds
//! from truncated Taylor series of the thrust vector (`demand`), the rigid body with a rotation matrix
//! (`body`), implicit Gauss collocation of order 12 (`gauss`). Nothing is shared with feasibility, search,
//! simulation, the robot's own equations or the integrators of `math`. Drives of ground vehicles have replays of their
//! own, in the plane (`drive`) and on the ground (`ground`); programs and graphs of arms are followed by equations of
//! their own (`arm`). That no path through a graph is heavier is checked bound by bound ([`verify_heaviest`];
//! [`verify_walk`] where points may come several times, [`verify_triples`] where moves may pass points).
//!
//! | claimed | proven by | asked of |
//! | --- | --- | --- |
//! | a flight's polynomials are flyable | [`verify`], [`open_loop_with_lag`] | knots, rotor speeds, end states, path |
//! | a flight keeps off solids | [`verify_clear`], [`verify_clear_of_surface`] | distances, Taylor sums |
//! | a flight keeps speed and tilt | [`verify_flight_limits`] | places of each leg |
//! | a drive ends where it should | [`replay_drive`], [`replay_ground`], [`verify_drives`] | pose, κ, v, tilt, places |
//! | wheels steer and roll as they may | [`replay_ground`], [`verify_drives`] | angles, speeds and their rates |
//! | two driven wheels keep up | [`rim_breaches`], [`verify_drives`] | speed and acceleration of each rim |
//! | a drive keeps off discs | [`verify_clear_ground`] | chords and what leaves them |
//! | an arm's program or graph holds | [`verify_arm_program`], [`verify_arm_graph`] | bounds, margins, cell, targets |
//! | rows of a table are the witness's motion | [`verify_rows`], [`verify_flight_rows`] | place, attitude, velocity |
//! | no path is heavier | [`verify_heaviest`], [`verify_walk`], [`verify_triples`] | every bound, or its own search |
//!
//! Each takes plain numbers, as files hold them, and gives findings; none panics on what a file may hold unless it says
//! so, and an empty list of findings is the proof.

mod arm;
pub mod boat;
mod body;
mod claim;
mod clear;
mod clear_ground;
mod clear_solid;
mod course;
mod crest;
mod demand;
mod drive;
mod drives;
mod finding;
mod flight_limits;
mod gauss;
mod ground;
mod ground_claim;
mod heaviest;
mod heaviest_bound;
mod heaviest_choices;
mod heaviest_claim;
mod heaviest_triples;
mod held_wheels;
mod jet;
mod knots;
mod pace;
mod panel;
mod peak;
mod place;
mod posed;
mod proof;
mod quadrature;
mod replay;
mod rims;
mod rotors;
mod rows;
mod stand;
mod stretch;
mod stride;
mod twist;
mod walk;
mod way;
mod wheels;

#[cfg(feature = "unit-tests")]
mod midpoint;
#[cfg(feature = "unit-tests")]
mod tests;

pub use arm::{
    ArmBodyClaim, ArmBuild, ArmClaim, ArmJointClaim, ArmMotion, ArmMoveFinding, ArmPath, ArmPiece, ArmProgramClaim,
    ArmProgramMove, ArmProgramReplay, ArmSolidClaim, ArmSolidForm, ArmTarget, ArmWay, ArmWayClaim, verify_arm_graph,
    verify_arm_program,
};
pub use body::{Body, RotorPlace};
pub use claim::{Claim, Leg};
pub use clear::{ClearClaim, verify_clear, verify_clear_of_surface};
pub use clear_ground::{ClearDisc, ClearDrive, ClearGroundClaim, verify_clear_ground};
pub use clear_solid::ClearSolid;
pub use drive::{DriveClaim, DrivePiece, DriveReplay, replay_drive, trace_drive};
pub use drives::{DriveLegClaim, DriveManoeuvres, DriveTolerances, DrivesClaim, verify_drives};
pub use finding::{Collector, EndError, Finding, Proof, Tolerances, Worst};
pub use flight_limits::{FlightLimits, verify_flight_limits};
pub use ground::{GroundReplay, Stopped, replay_ground};
pub use ground_claim::{GroundClaim, GroundVehicle, Haul};
pub use heaviest::{MOST_SEARCHED_AGAIN, PathFinding, verify_heaviest};
pub use heaviest_claim::{CutClaim, HeaviestClaim, NextClaim, StepClaim, TreeClaim};
pub use heaviest_triples::{MOST_TRIPLES_AGAIN, TriplesClaim, verify_triples};
pub use held_wheels::{HeldWheels, SteeredWheels};
pub use place::FlatPlace;
pub use posed::Stand;
pub use proof::{open_loop_with_lag, verify};
pub use rims::{RimBreach, WheelRims, rim_breaches};
pub use rows::{PlannedRow, PlannedState, RowTolerances, verify_flight_rows, verify_rows};
pub use walk::{SplitClaim, WalkClaim, WalkStepClaim, verify_walk};
pub use wheels::WheelExtremes;
