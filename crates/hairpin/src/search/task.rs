//! What every search is given and what it gives back.

use nalgebra::Point3;

use crate::feasibility::reach::Reach;

/// One graph to search: every waypoint may follow every other, as far as the reach set lets it.
///
/// A trajectory of length L is a list of L waypoints, both ends included, from `candidates[0]` to the last candidate.
/// No waypoint follows itself. With revisits any other repetition is allowed, that of start and end included; without,
/// every waypoint of the trajectory is used once.
#[derive(Debug)]
pub struct Task<'a, N, R: ?Sized> {
    /// The node at rest at the start: waypoint 0.
    pub start: N,
    /// Waypoints, m: index 0 the start, the last the end.
    pub candidates: &'a [Point3<f64>],
    /// Which legs there are.
    pub reach: &'a R,
}

impl<N, R: Reach<N> + ?Sized> Task<'_, N, R> {
    /// Index of the end.
    pub fn end(&self) -> u32 {
        self.candidates.len().saturating_sub(1) as u32
    }
}

/// A trajectory that a search returns.
#[derive(Debug, Clone, PartialEq)]
pub struct Found<N> {
    /// Indices into the graph, both ends included.
    pub waypoints: Vec<u32>,
    /// The reach set's node at every waypoint.
    pub nodes: Vec<N>,
    /// Planned duration of every leg, s.
    pub leg_times: Vec<f64>,
    /// Aggregated score.
    pub score: f64,
}
