//! What every search is given and what it gives back.
//!
//! Length counts waypoints, both ends included: L waypoints are L − 1 legs.

use nalgebra::Point3;

use crate::feasibility::reach::Reach;

/// One graph to search: every waypoint may follow every other, as far as the reach set lets it.
///
/// A trajectory of length L is a list of L waypoints, both ends included, from `candidates[0]` to the last candidate.
/// No waypoint follows itself. With revisits any other repetition is allowed, that of start and end included; without,
/// every waypoint of the trajectory is used once.
///
/// ```
/// use hairpin::feasibility::reach::{Sphere, StepNode, StepReach, StepSettings};
/// use hairpin::search::{BeamSettings, LegView, Task, beam};
/// use nalgebra::Point3;
///
/// // Legs of at most 6 m in 1 s; what is long is stressful.
/// let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 3.0], [8.0, 4.0]].map(|[x, y]| Point3::new(x, y, 1.0));
/// let reach = StepReach::new(&Sphere { radius: 6.0 }, &points, StepSettings::default());
/// let task = Task { start: StepNode { previous: 0, current: 0 }, candidates: &points, reach: &reach };
/// let settings = BeamSettings { length: 4, ..BeamSettings::default() };
/// let outcome = beam(&task, &|leg: &LegView<'_>| leg.features.v_out, |_, _| true, &settings);
/// assert_eq!(outcome.found[0].waypoints, [0, 2, 1, 4]); // 4√2 + 4 + 4√2 m
/// ```
#[derive(Debug)]
pub struct Task<'a, N, R: ?Sized> {
    /// The node at rest at the start: waypoint 0.
    /// Its waypoint is index 0 of `candidates`, whatever the node itself holds.
    pub start: N,
    /// Waypoints, m: index 0 the start, the last the end.
    /// In the world's frame. At least two for a trajectory to exist.
    pub candidates: &'a [Point3<f64>],
    /// Which legs there are.
    /// Asked node by node: a search sees as much of the graph as it asks for.
    pub reach: &'a R,
}

impl<N, R: Reach<N> + ?Sized> Task<'_, N, R> {
    /// Index of the end.
    ///
    /// The last candidate; 0 for a task without candidates.
    ///
    /// Every trajectory of the task ends there; for a free end see [`super::OpenEnd`].
    pub fn end(&self) -> u32 {
        self.candidates.len().saturating_sub(1) as u32
    }
}

/// A trajectory that a search returns.
///
/// `leg_times` has one entry fewer than `waypoints`; index k belongs to the leg from waypoint k to k + 1.
///
/// Everything that a campaign needs to plan it: nodes carry what the reach set knows of a waypoint (velocity,
/// heading, posture). Under `no revisits` all `waypoints` differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Found<N> {
    /// Indices into the graph, both ends included.
    pub waypoints: Vec<u32>,
    /// The reach set's node at every waypoint.
    pub nodes: Vec<N>,
    /// Planned duration of every leg, s.
    /// All above 0, but that to the sink of a free end.
    pub leg_times: Vec<f64>,
    /// Aggregated score.
    /// By the search's [`super::Aggregate`]; the stress where trajectories were executed.
    pub score: f64,
}

impl<N> Found<N> {
    /// Best score first, ties by waypoint index.
    pub(super) fn sort(found: &mut [Self]) {
        found.sort_by(|a, b| b.score.total_cmp(&a.score).then_with(|| a.waypoints.cmp(&b.waypoints)));
    }
}
