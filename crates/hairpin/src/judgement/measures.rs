//! What is measured on one executed track against its reference; larger is worse, but for the
//! clearance and the tip-over margin.

use super::resolution::{AccelerationSource, Unresolved};

/// Where the leg being flown is known from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LegSource {
    /// The executor told it (channel `leg`).
    #[default]
    Executor,
    /// Monotone assignment of the samples along the path.
    Assigned,
}

/// Metrics of one leg.
///
/// Over the samples of that leg alone; a waypoint's overshoot belongs to the leg that leads to it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LegMeasures {
    /// Largest distance from the actual position to the leg's segment, m.
    pub max_deviation: f64,
    /// Mean over time of that distance, m.
    pub mean_deviation: f64,
    /// Largest ‖dv/dt‖, m/s².
    pub max_acceleration: f64,
    /// Time spent on the leg, s.
    pub time: f64,
    /// Overshoot at the leg's last waypoint, m.
    pub overshoot: f64,
    /// Smallest distance to an obstacle, m; `None` without obstacles.
    pub min_clearance: Option<f64>,
    /// Smallest angle by which the body would have had to lean further to tip over, degrees; `None` where it was not
    /// told.
    pub min_tip_over_margin: Option<f64>,
    /// Largest angle of the body's upward axis from the world's, degrees; `None` of arms and where no attitude was
    /// told.
    pub max_tilt: Option<f64>,
    /// Share of rotor-time at a rotor limit, 0 … 1; `None` where the executor did not tell.
    pub saturation_share: Option<f64>,
    /// ∫ Σ q̈² dt over the joints of an arm, rad²/s³; `None` where their angles were not told.
    pub joint_effort: Option<f64>,
    /// How late the leg's last waypoint was arrived at by its planned time, s; negative is early. `None` where arrivals
    /// have no planned times, where it was not arrived at, and in what is read back from results.
    pub lateness: Option<f64>,
}

/// The latest arrival at a waypoint, by its planned time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Late {
    /// How late, s; negative where every arrival was early.
    pub by: f64,
    /// When it arrived, s.
    pub at: f64,
    /// The leg that led there.
    pub leg: usize,
}

/// What no sample of a run could be measured by, so that it reads 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Missing {
    /// Deviations: all samples lie within the corner of a waypoint.
    pub deviation: bool,
    /// Accelerations: there are too few samples, or a break lies between all of them.
    pub acceleration: bool,
}

/// Metrics of one run.
///
/// `None` and [`Missing`] are "not measured", never 0: a limit on what was not measured is not judged, and the report
/// says so.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measures {
    /// Largest deviation over all legs, m.
    pub max_deviation: f64,
    /// When it was reached, s.
    pub t_worst: f64,
    /// The leg it belongs to, numbered by its first waypoint.
    pub leg_worst: usize,
    /// Largest deviation that may hide between two samples, m, as [`super::look_closely`] bounds it; `None` where the
    /// samples are all there is to know.
    pub most_between: Option<f64>,
    /// Largest overshoot that may hide between two samples, m; `None` as of [`Self::most_between`].
    pub overshoot_between: Option<f64>,
    /// Smallest clearance that may hide between two samples, m; `None` as of [`Self::most_between`], and without
    /// obstacles.
    pub clearance_between: Option<f64>,
    /// Smallest distance to the world's edge that may hide between two samples, m, below 0 outside; `None` as of
    /// [`Self::most_between`], and where that edge is farther than a motion between two samples.
    pub edge_between: Option<f64>,
    /// How far the step in which they were recorded has moved places at most, m; `None` where they are told exactly.
    pub place_unresolved: Option<f64>,
    /// Longest time that an acceleration, or two intervals between samples of what nothing bounds, is a mean over, s;
    /// `None` where nobody asks for it.
    pub acceleration_over: Option<f64>,
    /// The least radius for each waypoint within which the run was at it and at all before it, m; empty where nobody
    /// asks for it.
    pub waypoints_within: Vec<f64>,
    /// Mean deviation over time, m.
    pub mean_deviation: f64,
    /// Largest ‖dv/dt‖, m/s².
    pub max_acceleration: f64,
    /// When it was reached, s.
    pub t_acceleration: f64,
    /// What the step in which it was recorded leaves open of it; `None` where it was told exactly.
    pub acceleration_unresolved: Option<Unresolved>,
    /// Largest |d‖v‖/dt|, m/s²: the paper's authors' formula Δ|v|/Δt.
    pub max_speed_rate: f64,
    /// Duration of the run, s.
    pub total_time: f64,
    /// Overshoot at each waypoint 1…n−1, m.
    pub overshoots: Vec<f64>,
    /// When the largest overshoot was reached, s.
    pub t_overshoot: f64,
    /// Smallest distance to an obstacle, m, the robot's radius subtracted; `None` without obstacles.
    pub min_clearance: Option<f64>,
    /// When it was reached, s.
    pub t_clearance: f64,
    /// Smallest angle by which the body would have had to lean further to tip over, degrees; `None` where it was not
    /// told.
    pub min_tip_over_margin: Option<f64>,
    /// When it was reached, s.
    pub t_tip_over_margin: f64,
    /// Largest angle of the body's upward axis from the world's, degrees; `None` of arms and where no attitude was
    /// told.
    pub max_tilt: Option<f64>,
    /// When it was reached, s.
    pub t_tilt: f64,
    /// Share of rotor-time spent at a rotor limit, 0 … 1; `None` where the executor did not tell.
    pub saturation_share: Option<f64>,
    /// ∫ Σ q̈² dt over the joints of an arm, rad²/s³; `None` where their angles were not told.
    pub joint_effort: Option<f64>,
    /// The latest arrival at a waypoint; `None` where arrivals have no planned times.
    pub latest: Option<Late>,
    /// What reads 0 and was not measured.
    pub missing: Missing,
    /// Where the leg being flown is known from.
    pub leg_source: LegSource,
    /// What the accelerations are differences of.
    pub acceleration_source: AccelerationSource,
    /// Per leg.
    pub legs: Vec<LegMeasures>,
}

impl Measures {
    /// Largest deviation, m; `None` where no sample counts.
    pub fn deviation(&self) -> Option<f64> {
        (!self.missing.deviation).then_some(self.max_deviation)
    }

    /// Largest acceleration, m/s²; `None` where there were too few samples for one.
    pub fn acceleration(&self) -> Option<f64> {
        (!self.missing.acceleration).then_some(self.max_acceleration)
    }

    /// Largest overshoot at any waypoint, m; 0 if none was measured.
    pub fn max_overshoot(&self) -> f64 {
        self.overshoots.iter().copied().fold(0.0, f64::max)
    }

    /// What tells one execution from another, each measure in its own unit. What a robot has no measure of counts as 0,
    /// of all its executions alike.
    pub fn behaviour(&self) -> Vec<f64> {
        vec![
            self.max_deviation,
            self.mean_deviation,
            self.max_overshoot(),
            self.max_acceleration,
            self.total_time,
            self.min_clearance.unwrap_or(0.0),
            self.saturation_share.unwrap_or(0.0),
        ]
    }
}
