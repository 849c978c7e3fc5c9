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

    /// The worst of each measure of both, each by itself: what several runs of one case come to, whichever of them is
    /// called its worst.
    ///
    /// max over runs of each, min of clearance and tip-over margin. Of times and legs those of the deviation and of the
    /// latest arrival are told; of single legs and waypoints, and of what may hide between samples, nothing is.
    pub fn worst_of_each(&self, other: &Self) -> Self {
        let one = |is_other: bool| if is_other { other } else { self };
        let largest = |of: fn(&Self) -> Option<f64>| one(of(other) > of(self));
        let least = |of: fn(&Self) -> Option<f64>| {
            let less = of(other).is_some_and(|value| of(self).is_none_or(|so_far| value < so_far));
            of(one(less))
        };
        let deviates = largest(Self::deviation);
        let accelerates = largest(Self::acceleration);
        Self {
            max_deviation: deviates.max_deviation,
            t_worst: deviates.t_worst,
            leg_worst: deviates.leg_worst,
            mean_deviation: largest(|of| of.deviation().map(|_| of.mean_deviation)).mean_deviation,
            max_acceleration: accelerates.max_acceleration,
            max_speed_rate: self.max_speed_rate.max(other.max_speed_rate),
            total_time: self.total_time.max(other.total_time),
            overshoots: vec![self.max_overshoot().max(other.max_overshoot())],
            min_clearance: least(|of| of.min_clearance),
            min_tip_over_margin: least(|of| of.min_tip_over_margin),
            max_tilt: largest(|of| of.max_tilt).max_tilt,
            saturation_share: largest(|of| of.saturation_share).saturation_share,
            joint_effort: largest(|of| of.joint_effort).joint_effort,
            latest: largest(|of| of.latest.map(|late| late.by)).latest,
            missing: Missing {
                deviation: self.missing.deviation && other.missing.deviation,
                acceleration: self.missing.acceleration && other.missing.acceleration,
            },
            ..Self::default()
        }
    }

    /// The leg that a motion is on `elapsed` (s) after it began; `None` behind the last.
    pub fn leg_after(&self, elapsed: f64) -> Option<usize> {
        let mut past = 0.0;
        self.legs.iter().position(|leg| {
            past += leg.time;
            past > elapsed
        })
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

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn each_measure_has_a_worst_run_of_its_own() {
        let one = Measures {
            max_deviation: 1.0,
            t_worst: 3.0,
            leg_worst: 2,
            mean_deviation: 0.4,
            max_acceleration: 9.0,
            total_time: 20.0,
            overshoots: vec![0.1, 0.7],
            min_clearance: Some(0.5),
            latest: Some(Late { by: 0.2, at: 4.0, leg: 1 }),
            ..Measures::default()
        };
        let other = Measures {
            max_deviation: 1.5,
            t_worst: 7.0,
            leg_worst: 4,
            mean_deviation: 0.3,
            max_acceleration: 4.0,
            total_time: 22.0,
            overshoots: vec![0.2],
            min_clearance: Some(0.3),
            saturation_share: Some(0.1),
            ..Measures::default()
        };
        let worst = one.worst_of_each(&other);
        assert_eq!((worst.max_deviation, worst.t_worst, worst.leg_worst, worst.mean_deviation), (1.5, 7.0, 4, 0.4));
        assert_eq!((worst.max_acceleration, worst.total_time, worst.max_overshoot()), (9.0, 22.0, 0.7));
        assert_eq!((worst.min_clearance, worst.saturation_share, worst.latest), (Some(0.3), Some(0.1), one.latest));
        assert_eq!(other.worst_of_each(&one), worst);
        // What was not measured is not small, and not large.
        let missing = Missing { deviation: true, acceleration: false };
        let unmeasured = Measures { missing, max_acceleration: 10.0, ..Measures::default() };
        let worst = unmeasured.worst_of_each(&one);
        assert_eq!((worst.deviation(), worst.max_acceleration, worst.min_clearance), (Some(1.0), 10.0, Some(0.5)));
        assert_eq!(unmeasured.worst_of_each(&unmeasured).deviation(), None);
    }
}
