//! What sails: boats in a stretch of water with a current.
//!
//! ```text
//! BoatScenario ─▶ check ─▶ BoatSetup (boat, waters: size, current, keep-outs)
//!   Claim:  solve ─▶ feasibility::boat (BoatJudge, BoatRoadmap) ─▶ search ─▶ Plan; beside it through, passes
//!   Act:    execute ─▶ simulation::sail ─▶ Flight
//!   proof:  verify ─▶ verification, as plain numbers
//!   Say:    say, assumptions, drawing, losses, knobs
//! ```
//!
//! World frame: the map, x east, y north, z = 0 throughout; m, m/s, rad (heading from x, anticlockwise), N, N·m.
//! Plans are witnesses: polynomials of (x, y, heading) over time whose forces lie within the thrusters' bounds in the
//! known current, the bow into the motion at every waypoint.
//!
//! The model is a hull in surge, sway and yaw: what acts is a surge force, a sway force and a yaw moment, and what it
//! costs to move is felt through the water, v_ground − v_current. Position and heading fix all three, so that a
//! polynomial of degree 7 in each of x, y and ψ is a leg, proven between samples. Left out of plans, and met by runs:
//! lag of the thrusters, noise and a steady force. Waves there are none.

mod assumptions;
mod check;
mod claim;
mod drawing;
mod execute;
pub mod keys;
mod knobs;
mod legs;
mod losses;
mod passes;
mod plan;
mod say;
mod setup;
mod solve;
mod steered;
#[cfg(feature = "unit-tests")]
mod tests;
mod through;
mod varied;
mod verify;

pub use keys::BoatScenario;
pub use setup::BoatSetup;
