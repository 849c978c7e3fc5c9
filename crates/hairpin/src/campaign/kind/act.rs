//! The act: who carries a mission out.
//!
//! Nothing is claimed here and nothing is judged: a plan goes in, a recorded motion comes out.

use nalgebra::Point3;

use super::{Fittable, GroundLog, Same};
use crate::campaign::Case;
use crate::campaign::placement::Placement;
use crate::simulation::{Airborne, SimulationError};
use crate::trajectory::{Flight, Track};

/// How a mission is to be carried out.
///
/// Of one run: everything that is not in the setup or in the case.
#[derive(Debug, Clone, Copy)]
pub(in crate::campaign) struct Order<'a> {
    /// Both ends included, m.
    pub(in crate::campaign) waypoints: &'a [Point3<f64>],
    /// A waypoint counts as reached inside this radius, m.
    pub(in crate::campaign) accept: f64,
    /// s.
    /// From the release at t = 0; the run then ends as `time`.
    pub(in crate::campaign) time_limit: f64,
    /// The run's seed.
    /// Of noise, and of what else is drawn in the simulator; equal seeds give equal bits.
    pub(in crate::campaign) seed: u64,
    /// Whether what stands in the way, walls among it, ends the run.
    /// It does not where a motion that has come to its end is simulated again with other numbers: what is looked for
    /// is how the robot moves.
    pub(in crate::campaign) obstacles: bool,
}

/// A key that is given, and that nobody reads.
///
/// Told before anything runs: who gave it believes that it acts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PassedOver {
    /// The key.
    pub key: String,
    /// The value that stands there, as JSON.
    pub value: String,
    /// Why nobody reads it, a sentence's part.
    pub why: String,
}

/// How missions are carried out in our own simulator.
///
/// Run on the setup as it was drawn for the run; the plan stays that of `nominal`, so that a controller meets what
/// the planner did not know.
pub(in crate::campaign) trait Act {
    /// Carries out the plan of `case`, which was made with `nominal`, as this setup has robot and world.
    ///
    /// # Errors
    /// Numbers that the simulator does not take; a case without what is to be carried out.
    ///
    /// A crash, a time-out or a way out of the world is a [`Flight`] that says so, not an error. Deterministic in all
    /// arguments.
    fn run(&self, nominal: Same, case: &Case, order: &Order) -> Result<Flight, SimulationError>;

    /// The longest (s) that a sound run over `waypoints` may take, of a trajectory of `length` of them that is planned
    /// to take `planned` s: of a controller that has a pace of its own, whatever the robot could do, and of long ways;
    /// 0 where nothing is known of it.
    fn slowest(&self, _waypoints: &[Point3<f64>], _length: usize, _planned: f64) -> f64 {
        0.0
    }

    /// Partial trajectories that go on from where their beginning has led: where controllers know of one waypoint at a
    /// time.
    ///
    /// `None` of controllers that get the whole plan at once: what they do on a first leg depends on the last.
    fn leg_by_leg(&self) -> Option<&dyn LegByLeg> {
        None
    }

    /// Why runs of other seeds are the same run, a sentence's part; `None` where they may differ.
    fn repeats(&self) -> Option<&'static str> {
        None
    }

    /// Keys under `execute` that are given, and that no run reads.
    fn passed_over(&self) -> Vec<PassedOver> {
        Vec::new()
    }

    /// Why no run feels what `[vary]` draws for the number `key`, a sentence's part; `None` where one may.
    ///
    /// Draws of such keys alone try nothing, and are not counted.
    fn unfelt(&self, _key: &str) -> Option<&'static str> {
        None
    }

    /// What logs may tell of it.
    ///
    /// # Errors
    /// Why nothing is fitted, in a sentence's part.
    fn fittable(&self) -> Result<Fittable, String> {
        Err("no numbers of robots of this kind are fitted to logs".into())
    }

    /// Who imitates logs of `cases` where loops swing, so that no sample of a run can be held against a log's; `None`
    /// where they can.
    ///
    /// # Errors
    /// A plan of a case that nobody can follow.
    fn imitator<'a>(&'a self, _cases: &[&'a Case]) -> Result<Option<Box<dyn Imitator + 'a>>, SimulationError> {
        Ok(None)
    }

    /// Obstacles that are asked for, placed in the way of an execution of `case` along `track`, clear of its plan.
    /// `None` where there is no room for any, or none are asked for.
    ///
    /// Obstacles stand where `track` came and the plan does not: they prove that the deviation matters.
    fn place(&self, case: &Case, track: &Track) -> Option<Placement>;
}

/// A flight that is flown on leg by leg.
///
/// States are cloned where a beam branches, so that each leg is flown once. A whole flight made of parts is bit for
/// bit the one that [`Act::run`] flies.
pub(in crate::campaign) trait LegByLeg {
    /// Ready at the first waypoint of `order`.
    ///
    /// # Errors
    /// Numbers that the simulator does not take.
    fn at_start(&self, order: &Order) -> Result<Airborne, SimulationError>;

    /// Flown on to the next waypoint.
    ///
    /// # Errors
    /// As [`at_start`](Self::at_start).
    fn fly_to(&self, airborne: &mut Airborne, waypoint: Point3<f64>) -> Result<(), SimulationError>;

    /// Flown to its end.
    ///
    /// # Errors
    /// As [`at_start`](Self::at_start).
    fn finish(&self, airborne: &mut Airborne) -> Result<(), SimulationError>;
}

/// What a kind gives for fits by imitation: one nominal vehicle, and the missions of all logs.
pub(in crate::campaign) trait Imitator: Sync {
    /// Carries out mission number `at` as [`Act::run`] does, by `vehicle`, with so many times the usual noise in
    /// the controller's eyes.
    ///
    /// # Errors
    /// As of that.
    fn run(&self, vehicle: Same, at: usize, order: &Order, noise: f64) -> Result<Flight, SimulationError>;

    /// Numbers that tell of a vehicle, of logs of all missions in their order: always as many, in one order. `None` of
    /// logs that are too short for that.
    fn signs(&self, logs: &[GroundLog]) -> Option<Vec<f64>>;

    /// Where to begin, for logs that have these signs: values of all numbers of [`Fittable`], in their order,
    /// which are `given` as the robot has them.
    fn starts(&self, signs: &[f64], given: &[f64]) -> Vec<Vec<f64>>;

    /// Variances of what is independent from sample to sample in logs that have these signs: of x or y, m², and of ψ,
    /// rad².
    fn scatter(&self, signs: &[f64]) -> [f64; 2];
}
