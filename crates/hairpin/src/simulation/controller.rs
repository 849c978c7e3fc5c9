//! The seam for what steers a robot: a controller is told what was measured and where to go, and answers with a
//! command.
//!
//! One trait for all kinds of robots; [`Controlled`] says of a kind what is measured and what can be asked for. Ours
//! implement it as what a stranger brings does, and runs know no other way.
//!
//! ```text
//! plant ── R::State ──▶ Controller<R>::control(dt, state, reference) ── R::Command ──▶ loops, actuators ──▶ plant
//!                             ▲ reset(reference) once         schedule() ──▶ leg that the run is judged by
//! ```

use std::fmt;
use std::sync::Arc;

use nalgebra::{Point3, Vector3};
use thiserror::Error;

/// A kind of robot as its controllers see it.
///
/// A robot's room of `simulation` implements it; controllers are generic over nothing else.
pub trait Controlled: Sized {
    /// What it does, in a sentence's part: `it flies`.
    ///
    /// It names the kind to whom a controller of another kind is offered.
    const DOES: &'static str;
    /// What of ours carries its commands out, in a few words; `None`: actuators alone.
    const LOOPS: Option<&'static str> = None;
    /// What is measured, stamped.
    type State;
    /// The planned motion in time.
    type Plan;
    /// What may be asked of the loops and actuators below the controller.
    type Command: fmt::Debug;
    /// Whether every number of a command is finite.
    fn is_finite(command: &Self::Command) -> bool;
}

/// An outer loop: u = π(x, where to go), asked anew every [`Controller::period`].
///
/// Each run has a controller of its own, so what it remembers is the run's. States and commands of what flies are
/// [`FlightState`](super::FlightState) and [`FlightCommand`](super::FlightCommand), of what drives
/// [`DriveState`](super::ground::DriveState) and [`DriveCommand`](super::ground::DriveCommand).
///
/// # Errors
/// What a controller returns as a [`Fault`], or a command that is not finite, ends the run with a
/// [`SimulationError`](super::SimulationError) that names the controller.
///
/// ```
/// use hairpin::robot::quadrotor::Quadrotor;
/// use hairpin::simulation::{Controller, Fault, FlightCommand, FlightState, Reference};
///
/// struct Towards;
/// impl Controller<Quadrotor> for Towards {
///     fn control(&mut self, _dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
///         Ok(FlightCommand::Velocity((to.target() - now.position) * 0.9))
///     }
/// }
/// ```
pub trait Controller<R: Controlled> {
    /// Time between two turns, s, 0.001 to 1, rounded to whole ticks of the simulation. `None`: that of the built-in
    /// controllers, 0.01 s in flight, and on the ground the time that 0.01 m of the plan take, 0.02 to 0.1 s.
    fn period(&self) -> Option<f64> {
        None
    }

    /// Before the first turn of a run.
    ///
    /// # Errors
    /// Why this course cannot be followed.
    fn reset(&mut self, _reference: &Reference<R>) -> Result<(), Fault> {
        Ok(())
    }

    /// The command until the next turn, `dt` s from now.
    ///
    /// # Errors
    /// Why there is none.
    fn control(&mut self, dt: f64, state: &R::State, reference: &Reference<R>) -> Result<R::Command, Fault>;

    /// Where it stands in a motion that it follows by the clock or along a path; `None`: it goes from waypoint to
    /// waypoint.
    ///
    /// A run is judged leg by leg. Of a controller without a schedule the next waypoint is reached inside the
    /// acceptance radius, and then the leg after it begins; with one the leg is the schedule's.
    fn schedule(&self) -> Option<Schedule> {
        None
    }

    /// Where a waypoint counts as reached, of flights.
    ///
    /// Asked once, before the first turn.
    fn acceptance(&self) -> Acceptance {
        Acceptance::Sphere
    }
}

/// Where a waypoint counts as reached, with the acceptance radius of the run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Acceptance {
    /// No farther than the radius in space.
    #[default]
    Sphere,
    /// No farther than the radius seen from above, and than a height.
    Cylinder {
        /// Above and below, m.
        height: f64,
    },
}

/// Why a controller has no command, in its own words.
///
/// Strings convert by themselves: `Err("no path ahead".into())`.
pub type Fault = Box<dyn std::error::Error + Send + Sync>;

/// Where a run is to go.
///
/// Always at least one waypoint, the start.
pub struct Reference<'a, R: Controlled> {
    /// In order, m, world frame, the start included. Runs that a search flies leg by leg know them as far as they have
    /// come.
    ///
    /// Of drives the ends of legs, z that of the ground.
    pub waypoints: &'a [Point3<f64>],
    /// Index of the next one; their number once all were reached.
    pub next: usize,
    /// A waypoint counts as reached inside this radius, m.
    pub accept: f64,
    /// The planned motion, from t = 0, where the campaign has one.
    pub plan: Option<&'a R::Plan>,
}

impl<R: Controlled> Reference<'_, R> {
    /// The next waypoint, and after the last the last, m.
    pub fn target(&self) -> Vector3<f64> {
        self.waypoints[self.next.min(self.waypoints.len() - 1)].coords
    }

    /// Whether every waypoint was reached: the last is to be held.
    pub fn holds(&self) -> bool {
        self.next >= self.waypoints.len()
    }
}

/// Where a controller stands in what it follows.
///
/// Numbers of legs never fall during a run; `over` stays true.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schedule {
    /// Number of the leg.
    ///
    /// From 0: leg k joins waypoints k and k + 1.
    pub leg: usize,
    /// Whether it has come to the end.
    pub over: bool,
}

/// What was wrong at a controller's turn.
///
/// The run ends there without a flight: an error of the caller's controller, not a crash.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Misbehaviour {
    /// It asked for what is no number.
    #[error("it asked for {command}: must be finite")]
    NotFinite {
        /// The command.
        command: String,
    },
    /// It had no command.
    #[error("{words}")]
    Fault {
        /// Its own words.
        words: String,
    },
}

impl From<Fault> for Misbehaviour {
    fn from(fault: Fault) -> Self {
        Self::Fault { words: fault.to_string() }
    }
}

type Make<R> = dyn Fn(&R) -> Box<dyn Controller<R>> + Send + Sync;

/// A controller of the caller's own: its name in reports, and how one is made for a run.
pub struct OwnController<R: Controlled> {
    name: Arc<str>,
    make: Arc<Make<R>>,
}

impl<R: Controlled> OwnController<R> {
    /// `make` is called once for each run, from any thread, with the robot as it was planned with.
    ///
    /// Runs are made in any order and number; what `make` answers must not depend on it for results to be the same
    /// again.
    pub fn new<C: Controller<R> + 'static>(name: &str, make: impl Fn(&R) -> C + Send + Sync + 'static) -> Self {
        Self { name: name.into(), make: Arc::new(move |robot| Box::new(make(robot))) }
    }

    /// The name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// A fresh one for a run of `robot`.
    pub(super) fn make(&self, robot: &R) -> Box<dyn Controller<R>> {
        (self.make)(robot)
    }
}

impl<R: Controlled> Clone for OwnController<R> {
    fn clone(&self) -> Self {
        Self { name: self.name.clone(), make: self.make.clone() }
    }
}

impl<R: Controlled> fmt::Debug for OwnController<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("OwnController").field(&self.name).finish()
    }
}
