//! Drives a mission in our own simulator.

use super::DriveSetup;
use super::plan::drive_of;
use crate::campaign::Case;
use crate::feasibility::steering::shooting::families::Problem;
use crate::feasibility::steering::shooting::solve::{Choices, Outcome};
use crate::feasibility::steering::shooting::{Control, Query, generate, rough};
use crate::simulation::SimulationError;
use crate::simulation::ground::{
    self, DriveSettings, GroundConditions, GroundController, GroundControllerKind, GroundSortie,
};
use crate::trajectory::drive::{Gear, Planar, SegmentList};
use crate::trajectory::{Direction, Flight};

/// How a mission is to be driven.
#[derive(Debug, Clone, Copy)]
pub(in crate::campaign) struct Order {
    /// A waypoint counts as reached inside this radius, m.
    pub(in crate::campaign) accept: f64,
    /// s.
    pub(in crate::campaign) time_limit: f64,
    /// The run's seed.
    pub(in crate::campaign) seed: u64,
}

/// Drives the plan of `case`, which was made with `nominal`, as `own` has it: its vehicle and its latency.
pub(in crate::campaign) fn drive(
    nominal: &DriveSetup,
    own: &DriveSetup,
    case: &Case,
    order: &Order,
) -> Result<Flight, SimulationError> {
    let execute = &own.scenario.execute;
    let plan = drive_of(nominal, case);
    // The scenario's latency takes the place of the robot's.
    let vehicle = if execute.latency_s.is_some() { own.planner } else { own.rover };
    let sortie = GroundSortie {
        vehicle,
        nominal: nominal.rover,
        terrain: own.map,
        keep_outs: own.keep_out,
        clearance_radius: own.radius(),
        drive: &plan,
    };
    let conditions = GroundConditions {
        latency: execute.latency_s.unwrap_or(0.0),
        noise: execute.noise,
        external_force: execute.external_force_n.unwrap_or_default(),
        ..GroundConditions::default()
    };
    let settings =
        DriveSettings { accept: order.accept, time_limit: Some(order.time_limit), ..DriveSettings::default() };
    if let Some(controller) = own.controller {
        return ground::drive_with(&sortie, controller, &conditions, &settings, order.seed);
    }
    let resolve = |from: &Planar, to: &Planar, gear: Gear, direction| solve(nominal, from, to, gear, direction);
    let controller = match execute.controller_in_force().unwrap_or(GroundControllerKind::Predictive) {
        GroundControllerKind::PurePursuit => GroundController::PurePursuit,
        GroundControllerKind::Stanley => GroundController::Stanley,
        GroundControllerKind::Predictive => GroundController::Predictive(&resolve),
    };
    ground::drive(&sortie, &controller, &conditions, &settings, order.seed)
}

/// Commands in one gear from `from` to `to` on the ground, travelling in `direction`, as far as the nominal vehicle
/// goes; `None` where there are none.
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
