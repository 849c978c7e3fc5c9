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
//!
//! The model of the claim is a rigid body with four rotors and, for witnesses, drag: flat in x, y, z and yaw, so that a
//! polynomial of position fixes thrust, attitude, rates and rotor speeds. Left out of plans, and met by runs: rotor
//! lag, latency, wind, gusts and noise.
//!
//! | reach | a leg is | evidence |
//! | --- | --- | --- |
//! | `none`, `sphere` | any, or one within top speed · step | unchecked |
//! | `hull`, `published` | one whose end lies in the hull of sampled runs of one step | hull-feasible |
//! | `witness` | a polynomial of degree 7 an axis, proven between samples | witnessed |

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
mod homeward;
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
