//! A drive beside one that was logged: put where the log is, again and again, and left to itself in between.
//!
//! ```text
//! each place of the log ─▶ plant there, wheels and commands under way as they were ─▶ the loop until the next one
//! ```
//!
//! A loop with much latency swings, and two that differ little end in other swings. For so short a time they do not,
//! and neither does what pushed the vehicle aside before add up.

use super::close_loop::{Checked, Run};
use super::controllers::GroundController;
use super::guide::wrap;
use super::sortie::{DriveSettings, GroundConditions, GroundSortie};
use crate::simulation::SimulationError;
use crate::trajectory::Track;

/// Where the vehicle is put.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// When, s after the run's begin.
    pub t: f64,
    /// East and north, m.
    pub at: [f64; 2],
    /// ψ, rad; as it is where it is not known.
    pub yaw: Option<f64>,
}

impl Place {
    /// Moved by `by`, m or rad: east, north, or turned counter-clockwise.
    pub fn aside(self, axis: usize, by: f64) -> Self {
        let [x, y] = self.at;
        match axis {
            0 => Self { at: [x + by, y], ..self },
            1 => Self { at: [x, y + by], ..self },
            _ => Self { yaw: self.yaw.map(|yaw| yaw + by), ..self },
        }
    }
}

/// Between how a run stood before it was put elsewhere and after it, s.
const JUMP: f64 = 1e-6;

/// Drives from place to place, by one of our controllers, until `end` s: poses alone, two at each place, 1 µs apart.
///
/// Nothing ends the run: what loses the ground waits for the next place. Places are in the order of their times; what
/// lies within a turn of the controller is put at its begin.
///
/// # Errors
/// As [`super::drive`].
pub fn drive_beside(
    sortie: &GroundSortie,
    controller: &GroundController,
    conditions: &GroundConditions,
    places: &[Place],
    end: f64,
) -> Result<Track, SimulationError> {
    let checked = Checked::new(sortie, conditions, &DriveSettings::default(), 0)?;
    let mut guided = checked.guided(controller);
    let mut run = Run::new(&checked, controller.word(), &mut guided)?;
    let (mut times, mut poses) = (Vec::new(), Vec::new());
    let mut coming = places.iter().peekable();
    for tick in 0.. {
        let t = tick as f64 * run.period;
        times.push(t);
        poses.push(run.plant.world_from_body());
        if let Some(place) = coming.next_if(|place| place.t <= t + 0.5 * run.period) {
            let yaw = place.yaw.map(|yaw| run.plant.yaw + wrap(yaw - run.plant.yaw));
            run.lost = run.plant.put(place.at, yaw).err();
            times.push(t + JUMP);
            poses.push(run.plant.world_from_body());
        }
        if t >= end {
            break;
        }
        run.turn(t)?;
    }
    Ok(Track::new(times, poses, vec![]).expect("our own samples are finite and in order"))
}
