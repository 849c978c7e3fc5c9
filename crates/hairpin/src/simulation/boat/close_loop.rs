//! Closes the loop over plant and controller, and sails a run to its end.

use nalgebra::{Vector2, Vector3};

use super::command::{BoatState, turned};
use super::controllers::{BoatController, Helmsman};
use super::plant::BoatPlant;
use super::recorder::Recorder;
use super::sortie::{BoatConditions, BoatSortie, SailSettings};
use super::watch::Watch;
use crate::math::random::{Stream, named_seed, standard_normals, stream};
use crate::robot::boat::Boat;
use crate::simulation::SimulationError;
use crate::simulation::controller::{Controlled, Controller, Misbehaviour, OwnController};
use crate::simulation::course::Course;
use crate::trajectory::{Flight, ProfileLeg};

/// Time between two turns of a controller that has no period of its own, s.
const PERIOD: f64 = 0.1;
/// Standard deviations of what is measured: position, m; heading, rad; speeds, m/s; rate of turn, rad/s.
///
/// White, anew at each turn of the controller; the log has the plant's own numbers.
const NOISE: [f64; 4] = [0.01, 0.2 * std::f64::consts::PI / 180.0, 0.005, 0.2 * std::f64::consts::PI / 180.0];

/// Sails one run by one of our controllers: the same bytes for the same arguments.
///
/// The run ends `linger` seconds after its course is over (`done`, or `time` if a waypoint was missed), at the time
/// limit, where the hull's disc meets a place to keep out of (`obstacle`), outside the waters with `walls` (`wall`), or
/// where numbers are lost (`off-map`). The log has the channels of [`Flight`], and `surge_m_s`, `sway_m_s`, `r_rad_s`
/// through the water, `surge_n`, `sway_n`, `yaw_n_m` as the thrusters give them, and `thrust_at_limit`, the share of
/// the forces asked for since the sample before that were beyond their limits.
///
/// # Errors
/// Settings or conditions out of bounds; fewer than two waypoints or one that is not finite; a profile with another
/// number of legs; a controller that needs a plan where there is none.
pub fn sail(
    sortie: &BoatSortie,
    controller: &BoatController,
    conditions: &BoatConditions,
    settings: &SailSettings,
    seed: u64,
) -> Result<Flight, SimulationError> {
    let mut helmsman = Helmsman::new(controller, sortie.nominal)?;
    Run::new(sortie, conditions, settings, seed)?.carry_out(controller.kind.word(), &mut helmsman)
}

/// [`sail`] by a controller of the caller's own, made afresh for the run; as reproducible as that is.
///
/// # Errors
/// As [`sail`]; a period out of bounds; [`SimulationError::Controller`].
pub fn sail_with(
    sortie: &BoatSortie,
    controller: &OwnController<Boat>,
    conditions: &BoatConditions,
    settings: &SailSettings,
    seed: u64,
) -> Result<Flight, SimulationError> {
    Run::new(sortie, conditions, settings, seed)?.carry_out(controller.name(), &mut *controller.make(sortie.nominal))
}

/// Plant, course and log of a run.
///
/// Nothing is shared between runs; all that is drawn comes from the stream `boat pose` of the run's seed.
struct Run<'a> {
    sortie: &'a BoatSortie<'a>,
    settings: &'a SailSettings,
    plant: BoatPlant,
    course: Course,
    watch: Watch<'a>,
    noise: Option<Stream>,
}

impl<'a> Run<'a> {
    fn new(
        sortie: &'a BoatSortie,
        conditions: &BoatConditions,
        settings: &'a SailSettings,
        seed: u64,
    ) -> Result<Self, SimulationError> {
        settings.check()?;
        conditions.check()?;
        check_course(sortie)?;
        let start = sortie.waypoints[0];
        let current = Vector2::from(conditions.current);
        let mut plant = BoatPlant::new(sortie.boat, Vector2::new(start.x, start.y), sortie.heading(), current);
        plant.push = Vector2::from(conditions.external_force);
        Ok(Self {
            sortie,
            settings,
            plant: plant.held(),
            course: Course::new(sortie.waypoints, settings.accept),
            watch: Watch::new(sortie, settings),
            noise: conditions.noise.then(|| stream(named_seed(seed, "boat pose", 0))),
        })
    }

    /// Sails to the end.
    ///
    /// Once a period: the course and what ends the run are noted, a sample is logged where it is due, the controller is
    /// asked, and the plant goes on with its answer held. The last sample is that of the end.
    fn carry_out(mut self, name: &str, controller: &mut dyn Controller<Boat>) -> Result<Flight, SimulationError> {
        let failed = |t: f64, why: Misbehaviour| Err(SimulationError::Controller { name: name.into(), t, why });
        let period = controller.period().unwrap_or(PERIOD);
        if !(0.001..=1.0).contains(&period) {
            let value = format!("{period} ({name})");
            return Err(SimulationError::new("controller.period", value, "from 0.001 to 1 s"));
        }
        if let Err(fault) = controller.reset(&self.course.reference(self.sortie.profile)) {
            return failed(0.0, fault.into());
        }
        let log_every = ((self.settings.log_period / period).round() as u64).max(1);
        let mut recorder = Recorder::default();
        for tick in 0_u64.. {
            let t = tick as f64 * period;
            let at = self.plant.position();
            self.course.note(t, &Vector3::new(at.x, at.y, 0.0), controller.schedule());
            let ended = self.watch.note(t, &at, &self.course);
            if ended.is_some() || tick % log_every == 0 {
                recorder.push(t, &mut self.plant, self.course.leg());
            }
            if let Some(ended) = ended {
                let reached = self.course.into_reached();
                return Ok(Flight { track: recorder.into_track(), ended, left_world: self.watch.left, reached });
            }
            let command =
                match controller.control(period, &self.measure(t), &self.course.reference(self.sortie.profile)) {
                    Err(fault) => return failed(t, fault.into()),
                    Ok(command) if !Boat::is_finite(&command) => {
                        return failed(t, Misbehaviour::NotFinite { command: format!("{command:?}") });
                    }
                    Ok(command) => command,
                };
            self.plant.advance(&command, period);
        }
        unreachable!("the time limit ends every run")
    }

    /// Velocities over ground in the body's frame, ahead and to port. Ground and water share the noise of the rate of
    /// turn, not that of the speeds. Without noise the plant's own numbers.
    fn measure(&mut self, t: f64) -> BoatState {
        let plant = &self.plant;
        let over_ground = turned(&plant.over_ground(), -plant.heading());
        let mut position = plant.position();
        let mut heading = plant.heading();
        let mut through_water = plant.through_water();
        let mut velocity = Vector3::new(over_ground.x, over_ground.y, through_water.z);
        if let Some(noise) = &mut self.noise {
            let [x, y, psi, u, v, r, ahead, aside] = standard_normals(noise);
            position += Vector2::new(x, y) * NOISE[0];
            heading += psi * NOISE[1];
            velocity += Vector3::new(u * NOISE[2], v * NOISE[2], r * NOISE[3]);
            through_water += Vector3::new(ahead * NOISE[2], aside * NOISE[2], r * NOISE[3]);
        }
        BoatState { t, position, heading, velocity, through_water }
    }
}

/// # Errors
/// Fewer than two waypoints, numbers that are not finite, or another number of legs than the waypoints ask
/// for.
fn check_course(sortie: &BoatSortie) -> Result<(), SimulationError> {
    let points = sortie.waypoints;
    if points.len() < 2 {
        return Err(SimulationError::new("waypoints", points.len().to_string(), "at least two"));
    }
    if let Some(point) = points.iter().find(|point| !point.iter().all(|c| c.is_finite())) {
        return Err(SimulationError::new("waypoints", format!("{:?}", point.coords.as_slice()), "finite"));
    }
    let Some(profile) = sortie.profile else { return Ok(()) };
    let finite = |leg: &ProfileLeg| {
        leg.duration > 0.0 && leg.duration.is_finite() && leg.coefficients.iter().flatten().all(|c| c.is_finite())
    };
    if profile.legs.len() + 1 != points.len() || !profile.legs.iter().all(finite) {
        let found = format!("{} legs for {} waypoints", profile.legs.len(), points.len());
        return Err(SimulationError::new("profile", found, "one finite leg between each two waypoints"));
    }
    Ok(())
}
