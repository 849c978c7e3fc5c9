//! Bounds that both what is written and what is read is held to. Each stands here once: what one command writes, every
//! other one reads.
//!
//! Bounds of what makes sense, not of what a robot can: beyond lies another unit, a slip, or a size that takes days.
//! SI units, unless the name says otherwise.

use crate::robot::rover::MOST_SPEED;

/// Waypoints of a trajectory: longer ones take days.
pub const MOST_WAYPOINTS: usize = 10_000;
/// The same of drives, whose legs are boundary-value problems.
pub const MOST_OF_A_DRIVE: usize = 1_000;
/// Points of an arm's cloud: more take graphs of more than a hundred million moves.
pub const MOST_POINTS: usize = 10_000;
/// Edges of a cage or field, m; also keeps squares of distances far from rounding trouble.
pub const LARGEST_M: f64 = 10_000.0;
/// Edges of the waters, m: farther than any harbour.
pub const LARGEST_WATERS_M: f64 = 100_000.0;
/// Farther, m, than anything in a cage or field may lie: beyond is another unit or a slip.
pub const FARTHEST_M: f64 = 2.0 * LARGEST_M;
/// Farther, m, than the coordinates of any map: half of the equator, as the widest projections have it.
pub const FARTHEST_ON_EARTH_M: f64 = 2.1e7;
/// Legs of flights, s: ten times the longest that a scenario can ask for.
pub const LONGEST_LEG_S: f64 = 600.0;
/// Legs of drives, s: ten kilometres at the least speed that a scenario can ask for.
pub const LONGEST_DRIVE_S: f64 = 1e7;
/// The longest leg time that a boat's scenario can ask for, s.
pub const LONGEST_PASSAGE_S: f64 = 1e5;
/// Moves of arms, s: metres at less than a millimetre a second.
pub const LONGEST_MOVE_S: f64 = 1e5;
/// Runs of boats, which are slow, s.
pub const LONGEST_TRIP_S: f64 = 1e7;
/// The least radius, m, that turns in place count the speed of the outermost wheel at.
pub const LEAST_RADIUS_M: f64 = 0.1;
/// Turns in place, rad/s: what the fastest vehicle comes to at the least radius.
pub const MOST_TURN_RATE: f64 = MOST_SPEED / LEAST_RADIUS_M;
/// Between two samples, s: stamps of whole nanoseconds lie farther apart however they were rounded, and what is divided
/// by less is no number in the end.
pub const SHORTEST_STEP_S: f64 = 5e-10;
