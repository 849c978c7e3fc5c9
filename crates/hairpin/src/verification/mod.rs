//! Floor 6, the proof: equations and an integrator of its own, fed with what a campaign wrote.
//!
//! A witness claims: under the rotor speeds that its polynomials imply, the robot flies from waypoint to waypoint,
//! level and at rest in its rates at each. Here that is checked by other means than those that found it: rotor speeds
//! from truncated Taylor series of the thrust vector (`demand`), the rigid body with a rotation matrix
//! (`body`), implicit Gauss collocation of order 12 (`gauss`). Nothing is shared with feasibility, search,
//! simulation, the robot's own equations or the integrators of `math`. Drives of ground vehicles have replays of their
//! own, in the plane (`drive`) and on the ground (`ground`); moves of arms are followed by their own equations ([`verify_arm_moves`]). That no path through a graph is heavier is checked bound by
//! bound ([`verify_heaviest`]; [`verify_walk`] where points may come several times, [`verify_triples`] where moves may pass points).
//!
//! | what was claimed | checked by | how |
//! | --- | --- | --- |
//! | a flight ([`Claim`]) | [`verify`] | rotor speeds by Taylor series, collocation of order 12 |
//! | a drive in the plane | [`replay_drive`] | Runge-Kutta on a grid of its own, 2000 steps or more |
//! | a drive on the ground | [`replay_ground`], [`verify_drives`] | midpoint rule, rests by differences |
//! | a distance kept | [`verify_clear`], [`verify_clear_ground`] | Taylor sums; chords of a replay |
//! | an arm's moves, a graph of them | [`verify_arm_moves`], [`verify_arm_graph`] | dense samples, Gauss-Newton |
//! | no path is heavier | [`verify_heaviest`], [`verify_walk`], [`verify_triples`] | every bound or the search again |
//!
//! Claims are plain numbers, as a campaign's files hold them, and may hold anything: nothing here panics on a file, and
//! what is no number is a finding. An empty list of findings is the proof; each finding says what, how much, against
//! which bound, and where. Proofs of drives, arms and distances on the ground are numerical: they hold to the
//! tolerances and steps that are stated with them, and what narrower things do between samples they do not see. Bounds
//! of paths are exact.

mod arm;
mod body;
mod claim;
mod clear;
mod clear_ground;
mod demand;
mod drive;
mod drives;
mod finding;
mod gauss;
mod ground;
mod heaviest;
mod heaviest_bound;
mod heaviest_choices;
mod heaviest_triples;
mod jet;
mod knots;
mod pace;
mod proof;
mod replay;
mod rotors;
mod stand;
mod twist;
mod walk;

#[cfg(test)]
mod tests;

pub use arm::{
    ArmBodyClaim, ArmJointClaim, ArmMoveClaim, ArmMoveFinding, ArmMovesClaim, ArmSolidClaim, ArmSolidForm, ArmWay,
    ArmWayClaim, verify_arm_graph, verify_arm_moves,
};
pub use body::{Body, RotorPlace};
pub use claim::{Claim, Leg};
pub use clear::{ClearClaim, ClearSolid, verify_clear};
pub use clear_ground::{ClearDisc, ClearDrive, ClearGroundClaim, verify_clear_ground};
pub use drive::{DriveClaim, DrivePiece, DriveReplay, LEAST_STEPS, replay_drive, trace_drive};
pub use drives::{DriveLegClaim, DriveTolerances, DrivesClaim, verify_drives};
pub use finding::{EndError, Finding, Proof, Tolerances, Worst};
pub use ground::{GroundClaim, GroundReplay, GroundVehicle, Haul, Stopped, replay_ground};
pub use heaviest::{HeaviestClaim, MOST_SEARCHED_AGAIN, NextClaim, PathFinding, StepClaim, TreeClaim, verify_heaviest};
pub use heaviest_triples::{MOST_TRIPLES_AGAIN, TriplesClaim, verify_triples};
pub use proof::{open_loop_with_lag, verify};
pub use stand::Stand;
pub use walk::{SplitClaim, WalkClaim, WalkStepClaim, verify_walk};
