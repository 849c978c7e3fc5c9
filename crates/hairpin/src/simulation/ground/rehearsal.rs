//! A plan that is driven again and again, by vehicles and in conditions that differ: it is laid out once.
//!
//! ```text
//! sortie ─▶ Rehearsal (plan) ─┬─▶ drive: a run, as [`super::drive`] makes it
//!                             └─▶ commands_along: what the controller would say along a motion
//! ```

use super::close_loop::{Checked, usual_period};
use super::command::{DriveCommand, DriveState};
use super::controllers::{Driver, GroundController, Guided};
use super::guide::{Guide, wrap};
use super::plan::Plan;
use super::sortie::{DriveSettings, GroundConditions, GroundSortie};
use crate::simulation::SimulationError;
use crate::trajectory::Flight;
use crate::trajectory::drive::Planar;

/// The plan of a sortie.
///
/// Of its nominal vehicle, terrain and drive; other vehicles than its own may be driven along it.
pub struct Rehearsal(Plan);

/// Where a vehicle is, and how fast: of a motion that a controller is led along.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// x and y of the body's origin, m, and ψ, rad.
    pub place: [f64; 3],
    /// Along its heading, m/s.
    pub speed: f64,
    /// ψ̇, rad/s.
    pub turn_rate: f64,
}

/// Slower than this a vehicle of a log stands, m/s.
const STANDS: f64 = 0.02;

impl Rehearsal {
    /// Lays the plan of `sortie` out.
    ///
    /// # Errors
    /// As [`super::planned_track`].
    pub fn new(sortie: &GroundSortie) -> Result<Self, SimulationError> {
        Plan::new(sortie.nominal, sortie.terrain, sortie.drive).map(Self)
    }

    /// [`super::drive`] of `sortie`, whose plan this is.
    ///
    /// # Errors
    /// As of that.
    pub fn drive(
        &self,
        sortie: &GroundSortie,
        controller: &GroundController,
        conditions: &GroundConditions,
        settings: &DriveSettings,
        seed: u64,
    ) -> Result<Flight, SimulationError> {
        Checked::new(sortie, &self.0, conditions, settings, seed)?.by_ours(controller)
    }

    /// What the controller would say of `motion` from its begin until `end` (s), each turn: when (s), and what.
    ///
    /// The controller knows the nominal vehicle and counts with no latency; its wheels are steered as it said last.
    /// Nothing moves: the motion is what it is, whatever is said.
    pub fn commands_along(
        &self,
        sortie: &GroundSortie,
        controller: &GroundController,
        motion: impl Fn(f64) -> Moment,
        end: f64,
    ) -> Vec<(f64, DriveCommand)> {
        let GroundSortie { nominal, drive, .. } = sortie;
        let mut guided = Guided {
            guide: Guide::new(&self.0, nominal, 0.0, [drive.speed, drive.turn_rate]),
            driver: Driver::new(controller, nominal, 0.0),
        };
        let (first, period) = (&drive.legs[0], usual_period(drive));
        let mut yaw = first.from.yaw;
        let mut said = DriveCommand {
            curvature: first.from.curvature,
            direction: first.direction.start,
            ..DriveCommand::default()
        };
        let turn = |tick: usize| {
            let t = tick as f64 * period;
            let Moment { place: [x, y, heading], speed, turn_rate } = motion(t);
            yaw += wrap(heading - yaw);
            let stands = speed.abs() < STANDS;
            let state = DriveState {
                t,
                at: Planar { x, y, yaw, curvature: said.curvature },
                height: 0.0,
                speed: if stands { 0.0 } else { speed },
                turn_rate: if stands { turn_rate } else { 0.0 },
                lean: [0.0; 2],
                direction: said.direction,
            };
            said = guided.command(period, &state);
            (t, said)
        };
        (0..(end / period).floor() as usize).map(turn).collect()
    }
}
