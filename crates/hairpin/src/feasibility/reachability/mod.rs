//! Which moves between the points of a cloud an arm can make: the reachability graph, proven.
//!
//! Two modes with one answer, [`ReachabilityGraph`]: [`cartesian()`], the tool's sphere on straight segments, each pair
//! proven in about the time of a float test; and [`mod@joint`], the whole arm followed in one configuration. Costs are
//! whole numbers, so that the search over the graph is exact.
//!
//! Data flow of a Cartesian pair: float filter with derived error bounds (`filter`) → separating direction in intervals
//! (`segment`) → bisection in t (`segment`) → clear, hit, or undecided, which is refused. Derivations: docs/arms.md.
//!
//! What is claimed: `Certified` answers are true of the real numbers given; joint mode is proven between samples and up
//! to rounding. What is refused may still be possible: within rounding of contact, in another configuration, or along
//! another way than the one move asked about.

mod cartesian;
mod filter;
mod graph;
pub mod joint;
mod refusal;
mod segment;
mod surface;
mod verdict;

#[cfg(feature = "unit-tests")]
mod tests;

pub use cartesian::{CartesianSettings, Level, cartesian, micrometres};
pub use graph::ReachabilityGraph;
pub use refusal::{InWords, Refusal};
pub use segment::Obstacle;
pub use verdict::Verdict;
