//! Drives a mission in our own simulator.

use super::DriveSetup;
use super::fit;
use super::imitate::DriveImitator;
use super::place::place;
use super::plan::drive_of;
use crate::campaign::Case;
use crate::campaign::kind::{Act, Fittable, Imitator, Order, Same};
use crate::campaign::placement::Placement;
use crate::feasibility::steering::shooting::families::Problem;
use crate::feasibility::steering::shooting::solve::{Choices, Outcome};
use crate::feasibility::steering::shooting::{Control, Query, generate, rough};
use crate::robot::rover::{Response, Rover};
use crate::simulation::SimulationError;
use crate::simulation::ground::{
    self, DriveSettings, GroundConditions, GroundController, GroundControllerKind, GroundSortie,
};
use crate::trajectory::drive::{Gear, Planar, SegmentList};
use crate::trajectory::{Direction, Flight, Track};

impl Act for DriveSetup {
    /// Drives the plan, which was made with `nominal`, as this setup has vehicle and latency.
    fn run(&self, nominal: Same, case: &Case, order: &Order) -> Result<Flight, SimulationError> {
        let settings = Self::settings(order);
        self.on_its_way(nominal.setup(), case, |sortie, conditions, ours| match &self.controller {
            Some(controller) => ground::drive_with(sortie, controller, conditions, &settings, order.seed),
            None => ground::drive(sortie, ours, conditions, &settings, order.seed),
        })
    }

    fn fittable(&self) -> Result<Fittable, String> {
        fit::fittable(self)
    }

    fn imitator<'a>(&'a self, cases: &[&'a Case]) -> Result<Option<Box<dyn Imitator + 'a>>, SimulationError> {
        Ok(Some(Box::new(DriveImitator::new(self, cases)?)))
    }

    fn place(&self, case: &Case, track: &Track) -> Option<Placement> {
        place(self, case, track, self.scenario.generate.environment?.obstacles?)
    }
}

impl DriveSetup {
    /// How a run of `order` is simulated.
    pub(super) fn settings(order: &Order) -> DriveSettings {
        DriveSettings {
            accept: order.accept,
            time_limit: Some(order.time_limit),
            keep_outs: order.obstacles,
            ..DriveSettings::default()
        }
    }

    /// What drives where under which conditions, and which of our controllers drives.
    ///
    /// Latency is the plant's or the conditions', never both: a scenario's own takes the place of the robot's, which is
    /// then set to 0. Noise is a factor, 0 or 1. Where no controller of ours is in force `predictive` is made ready.
    pub(super) fn on_its_way<T>(
        &self,
        nominal: &Self,
        case: &Case,
        drives: impl FnOnce(&GroundSortie, &GroundConditions, &GroundController) -> T,
    ) -> T {
        let (execute, plan) = (&self.scenario.execute, drive_of(nominal, case));
        // The scenario's latency takes the place of the robot's.
        let own = if execute.latency_s.is_some() { 0.0 } else { self.rover.response.latency };
        let vehicle =
            Rover { response: Response { latency: own, ..self.rover.response }, ..self.rover.as_ref().clone() };
        let sortie = GroundSortie {
            vehicle: &vehicle,
            nominal: &nominal.rover,
            terrain: &self.map,
            keep_outs: &self.keep_out,
            clearance_radius: self.radius(),
            drive: &plan,
        };
        let conditions = GroundConditions {
            latency: execute.latency_s.unwrap_or(0.0),
            noise: f64::from(execute.noise),
            external_force: execute.external_force_n.unwrap_or_default(),
            ..GroundConditions::default()
        };
        let resolve = |from: &Planar, to: &Planar, gear: Gear, direction| solve(nominal, from, to, gear, direction);
        let controller = match execute.controller_in_force().unwrap_or(GroundControllerKind::Predictive) {
            GroundControllerKind::PurePursuit => GroundController::PurePursuit,
            GroundControllerKind::Stanley => GroundController::Stanley,
            GroundControllerKind::Predictive => GroundController::Predictive(&resolve),
        };
        drives(&sortie, &conditions, &controller)
    }
}

/// Commands in one gear from `from` to `to` on the ground, travelling in `direction`, as far as the nominal vehicle
/// goes; `None` where there are none.
///
/// Curvatures at both ends are clamped to the plan's bounds: an executed drive may have strayed beyond them.
///
/// What the predictive controller asks at each cycle: the same flat solver and ground as the plan's, for the nominal
/// vehicle.
///
/// The end is not free, and no time limit is set. Outside of the bounds a query is none, and nothing is found.
fn solve(setup: &DriveSetup, from: &Planar, to: &Planar, gear: Gear, direction: Direction) -> Option<SegmentList> {
    let bounds = setup.bounds();
    let within = |at: &Planar| Planar { curvature: at.curvature.clamp(-bounds.most, bounds.most), ..*at };
    let settings = setup.leg_solver();
    let choices = Choices { gear, flat: setup.flat_solver(), ..Choices::default() };
    let mut shape = |query: &Query| {
        let query = Query::new(query.start_curvature, query.goal, &bounds).ok()?;
        let problem = Problem { query, speed: setup.speed().into(), swing: direction.swing(), free_end: false };
        let solution = generate(&problem, Control::Quintic, &bounds, &choices, || false, |_| {}).solution;
        (solution.outcome == Outcome::Solved).then_some(solution.segments)
    };
    let answer = setup.site(direction).solve(&within(from), &within(to), &bounds, &settings, &mut shape);
    (answer.status == rough::Status::Ok).then_some(answer.segments)
}
