//! Which moves between the points of a cloud an arm can make: the reachability graph, proven.

mod cartesian;
mod filter;
mod graph;
pub mod joint;
mod refusal;
mod segment;
mod surface;
mod verdict;

#[cfg(test)]
mod tests;

pub use cartesian::{CartesianSettings, Level, cartesian, micrometres};
pub use graph::ReachabilityGraph;
pub use refusal::{Refusal, Told};
pub use segment::Obstacle;
pub use verdict::Verdict;
