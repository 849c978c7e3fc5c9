//! The act: who carries a mission out.

use nalgebra::Point3;

use super::{Fittable, Same};
use crate::campaign::Case;
use crate::campaign::placement::Placement;
use crate::simulation::{Airborne, SimulationError};
use crate::trajectory::{Flight, Track};

/// How a mission is to be carried out.
#[derive(Debug, Clone, Copy)]
pub(in crate::campaign) struct Order<'a> {
    /// Both ends included, m.
    pub(in crate::campaign) waypoints: &'a [Point3<f64>],
    /// A waypoint counts as reached inside this radius, m.
    pub(in crate::campaign) accept: f64,
    /// s.
    pub(in crate::campaign) time_limit: f64,
    /// The run's seed.
    pub(in crate::campaign) seed: u64,
}

/// How missions are carried out in our own simulator.
pub(in crate::campaign) trait Act {
    /// Carries out the plan of `case`, which was made with `nominal`, as this setup has robot and world.
    ///
    /// # Errors
    /// Numbers that the simulator does not take; a case without what is to be carried out.
    fn run(&self, nominal: Same, case: &Case, order: &Order) -> Result<Flight, SimulationError>;

    /// Partial trajectories that go on from where their beginning has led: where controllers know of one waypoint at a
    /// time.
    fn leg_by_leg(&self) -> Option<&dyn LegByLeg> {
        None
    }

    /// What logs may tell of it.
    ///
    /// # Errors
    /// Why nothing is fitted, in a sentence's part.
    fn fittable(&self) -> Result<Fittable, String> {
        Err("no numbers of robots of this kind are fitted to logs".into())
    }

    /// Obstacles that are asked for, placed in the way of an execution of `case` along `track`, clear of its plan.
    /// `None` where there is no room for any, or none are asked for.
    fn place(&self, case: &Case, track: &Track) -> Option<Placement>;
}

/// A flight that is flown on leg by leg.
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
