//! What flies: quadrotors in a cage.
//!
//! ```text
//! FlightScenario ─▶ check ─▶ FlightSetup (robot, world, controller)
//!   Claim:  solve ─▶ stepwise (none, sphere, hull, published) or witness ─▶ Plan; beside it passes, replan
//!   Act:    fly ─▶ simulation::fly ─▶ Flight; surround, place: what is searched beside the plan
//!   proof:  verify ─▶ verification, as plain numbers
//!   Say:    say, assumptions, figure, losses, knobs
//! ```
//!
//! World frame: the cage, origin in a corner, x and y along its edges, z up; m, m/s, rad. Waypoints are passed level,
//! with yaw 0.

mod assumptions;
mod blocking;
mod certificates;
mod check;
mod claim;
mod estimated;
mod figure;
mod fit;
mod fly;
mod graph;
mod idle;
mod knobs;
mod legs;
mod losses;
mod passes;
mod place;
mod plan;
mod replan;
mod say;
mod setup;
mod solve;
mod steered;
mod stepwise;
mod surround;
mod verify;
mod witness;

pub use setup::FlightSetup;
