//! What drives: rovers on elevation maps, cars and differential drives.
//!
//! ```text
//! DriveScenario ─▶ check ─▶ DriveSetup (vehicle, planner's vehicle, map, keep-outs)
//!   Claim:  solve ─▶ roadmap of headed waypoints (witness) or stepwise ─▶ Plan; passes, replan, alter, draw
//!   fit:    signs of logs, imitate ─▶ simulation::ground ─▶ campaign::fit
//!   Act:    execute ─▶ simulation::ground ─▶ Flight; surround, place: what is searched beside the plan
//!   proof:  verify, site ─▶ verification, as plain numbers
//!   Say:    say, assumptions, drawing, figure, losses, knobs
//! ```
//!
//! Frame: the map's, x east, y north, z up, m; headings in rad from x towards y; curvatures in 1/m, positive to the
//! left. θ > 0 is nose down, φ > 0 is left side up.
//!
//! The model of the claim is quasi-static: the body rests on its wheels at every step, speed is along the way, and what
//! a leg keeps is bounded by κ, κ′, tilt, joints, torque and the height of the underside. Left out of plans, and met by
//! runs: latency, lags of steering and speed, scales of speed and turn, noise and a steady force.
//!
//! Two vehicles go through the room: `rover`, as it is driven, and `planner`, the same with the answers that plans
//! count with. Claim and proof ask the planner, runs the rover.

mod alter;
mod ask;
mod assumptions;
mod backwards;
mod check;
mod claim;
mod draw;
mod drawing;
mod execute;
mod figure;
mod fit;
mod footing;
mod held;
mod imitate;
mod knobs;
mod legs;
mod losses;
mod passes;
mod place;
mod plan;
mod replan;
mod say;
mod setup;
mod signs;
mod site;
mod solve;
mod steered;
mod stepwise;
mod surround;
#[cfg(feature = "unit-tests")]
mod tests;
mod verify;
mod walking;

pub use held::{broken, steerable};
pub use setup::{DriveSetup, LEVEL_GROUND};
pub use site::{Site, drive_piece, flat_claim, replay_flat, replay_pieces, wheel_rims};
