//! What flies: quadrotors in a cage.

mod assumptions;
mod blocking;
mod certificates;
mod check;
mod claim;
mod figure;
mod fit;
mod fly;
mod graph;
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
