//! What a drive's claim, execution and limits rest on, said from the run's own settings.
//!
//! Every number in a sentence is read from the setup that ran, with defaults in force. Sentences are
//! appended in the order in which a report has them.

use super::DriveSetup;
use crate::campaign::scenario::GroundReach;
use crate::feasibility::reach::drive::{Pace, Slopes};
use crate::robot::rover::{Kinematics, Response, Suspension};

/// What stands behind the legs.
///
/// Sentences of the reach set, the bounds of plans, and what the map may hide: cells coarser than half the wheelbase,
/// and cells without data.
///
/// Then kinematics, torque, directions of travel and latency, each only where it plays a part.
pub(super) fn claim(setup: &DriveSetup, said: &mut Vec<String>) {
    let generate = &setup.scenario.generate;
    said.push(match generate.reach {
        GroundReach::None => "Reach `none`: every waypoint counts as reachable; nothing is claimed.".into(),
        GroundReach::Sphere => "Reach `sphere`: a disc of radius top speed times step; nothing is claimed.".into(),
        GroundReach::Hull => "Reach `hull`: `hull-feasible` is a geometric filter, neither sound nor complete: a convex hull \
                              of the end points of constant-input runs is not a set of reachable points."
            .into(),
        GroundReach::Witness => format!(
            "Reach `witness`: each leg's commands lead to the next waypoint's pose within {} m, {} rad, {} 1/m on the map as \
             it is given, for the model: wheels that stay on the ground, quasi-static, slip as the robot's file has it.",
            generate.solver.position_m, generate.solver.yaw_rad, generate.solver.curvature_1_m
        ),
    });
    if generate.reach != GroundReach::Witness {
        said.push(format!(
            "Reach `{}` plans straight legs of {} s without commands; its scores and the runs are those of straight lines with \
             turns in place, in which curvature and gear do not change.",
            generate.reach.word(),
            generate.step_s
        ));
    }
    let bounds = setup.bounds();
    let tilt = match setup.tilt().to_degrees() {
        most if most.is_finite() => format!("a tilt of at most {most:.1}°"),
        _ => "any tilt".into(),
    };
    said.push(format!(
        "Plans keep |κ| ≤ {} 1/m, |κ′| ≤ {} 1/m², {tilt}, and go at {}.",
        bounds.most,
        bounds.most_rate,
        pace(setup)
    ));
    if setup.rover.kinematics == Kinematics::Exact && setup.rover.suspension != Suspension::Level {
        said.push(
            "Kinematics `exact`: plans, runs and proofs have what the suspension adds to the body's velocity (vz, ωx, ωy).".into(),
        );
    }
    if setup.rover.wheels.torque.is_finite() {
        said.push(format!(
            "No wheel needs more than {} N·m while driving: quasi-static, all wheels driven and sharing evenly, without what scrubbing and \
             turning in place take.",
            setup.rover.wheels.torque
        ));
    }
    wheels(setup, said);
    match generate.direction_deg.bounds() {
        [low, high] if low < high => said.push(format!(
            "Waypoints are passed in directions of travel between {low}° and {high}° of the body, each with its own; along a leg the \
             direction turns evenly, by its command and without a lag."
        )),
        [direction, _] if direction != 0.0 => {
            said.push(format!("The vehicle travels at {direction}° to its body, left positive."));
        }
        _ => {}
    }
    if setup.rover.response.latency > 0.0 {
        said.push(format!(
            "The latency of {} s is not planned for: legs follow each other.",
            setup.rover.response.latency
        ));
    }
    let grid = setup.map.grid();
    let coarse = grid.cell[0].max(grid.cell[1]);
    if setup.rover.suspension.wheelbase().is_some_and(|base| coarse > 0.5 * base) {
        said.push(format!(
            "The map's cells of {coarse:.2} m are coarser than half the wheelbase: attitudes are optimistic."
        ));
    }
    if setup.leaves_slopes_out {
        said.push(format!(
            "Slopes of the map are not modelled for `{}`, which has no suspension: its legs, proofs and runs are those of level \
             ground below it, and nothing is known of its tilt.",
            setup.rover.name
        ));
    }
    if setup.map.holes() > 0 {
        said.push(format!("{} cells of the map came without data.", setup.map.holes()));
    }
}

/// What plans and proofs keep of what the wheels may do, and who does not.
fn wheels(setup: &DriveSetup, said: &mut Vec<String>) {
    let wheels = &setup.rover.wheels;
    let all = [
        ("steer angles within", wheels.steer.to_degrees(), "°"),
        ("their rates within", wheels.steer_rate.to_degrees(), "°/s"),
        ("rolling speeds within", wheels.speed, "rad/s"),
        ("their changes within", wheels.acceleration, "rad/s²"),
    ];
    let held = all.iter().filter(|(_, bound, _)| bound.is_finite());
    let held: Vec<String> = held.map(|(what, bound, unit)| format!("{what} {bound} {unit}")).collect();
    if held.is_empty() {
        return;
    }
    let held = held.join(", ");
    said.push(match setup.scenario.generate.reach {
        GroundReach::Witness => format!(
            "Plans keep the wheels' {held}: as commanded, without slip, at the commanded speed; where the vehicle stands its wheels \
             may swing. The simulated vehicle knows no such limits."
        ),
        _ => format!("The wheels' limits ({held}) are not held: straight legs have no commands."),
    });
}

/// How fast plans are, and what they know of stops.
///
/// Waypoints' speeds are told as they are used: cut to the commanded speed.
fn pace(setup: &DriveSetup) -> String {
    let speed = setup.speed();
    let slopes = |slopes: Slopes, how: &str| {
        let [low, high] = slopes.waypoints.map(|bound| bound.min(speed));
        format!(
            "up to {speed} m/s, {how}, with {} m/s²: at rest at both ends, where the gear changes and around turns in place, \
             through other waypoints at {low} to {high} m/s as far as that allows",
            slopes.acceleration
        )
    };
    match setup.pace() {
        Pace::Constant => {
            format!("{speed} m/s, without time to stop where the gear changes and the vehicle turns in place")
        }
        Pace::Ramp(given) => slopes(given, "evenly from waypoint to waypoint"),
        Pace::Trapezoid(given) => slopes(given, "as trapezoids"),
    }
}

/// Who drove them.
///
/// Nothing where a program of the user's drives: how that simulates is its own business.
pub(super) fn act(setup: &DriveSetup, said: &mut Vec<String>) {
    let execute = &setup.scenario.execute;
    let who = match (&setup.controller, execute.controller_in_force()) {
        (Some(own), _) => format!("`{}`, the caller's own, knows the nominal vehicle and the plan", own.name()),
        (None, Some(ours)) => {
            format!("`{}` with hairpin's own gains knows the nominal vehicle and the map", ours.word())
        }
        (None, None) => return,
    };
    let latency = execute.latency_s.unwrap_or(setup.rover.response.latency);
    said.push(format!(
        "Simulated: suspension at rest at every step, slip by slope, latency {latency} s, steering lag and rate; \
         controller {who}, and its pose exactly."
    ));
    let Response { speed_time_constant, speed_scale, turn_scale, .. } = setup.rover.response;
    if (speed_time_constant, speed_scale, turn_scale) != (0.0, 1.0, 1.0) {
        said.push(format!(
            "Speeds lag by {speed_time_constant} s, and over the ground the vehicle goes by {speed_scale} of the wheels' way on \
             {turn_scale} of their curvature. The plan does not know it."
        ));
    }
    if let Some([east, north, up]) = execute.external_force_n {
        said.push(format!(
            "A steady force of ({east}, {north}, {up}) N, east, north, up, pulls at the centre of mass: to slip, torque and tip-over \
             margin it is a tilt of gravity. The plan does not know it."
        ));
    }
}

/// What deviation is.
///
/// The margin of tipping over is told only where it is judged.
pub(super) fn verdict(setup: &DriveSetup, said: &mut Vec<String>) {
    let limits = &setup.scenario.spec.limits;
    said.push(match limits.path_deviation_m {
        Some(_) => "Deviation is the distance from the planned path, along it. Tracks are not aligned.".into(),
        None => "No deviation limit is given: deviations from the planned path are told, not judged.".into(),
    });
    if limits.tip_over_margin_deg.is_some() {
        said.push(
            "The tip-over margin is the angle by which the standing body could lean further before its weight leaves the \
             wheels' outline: quasi-static, without the forces of driving."
                .into(),
        );
    }
}

/// What was searched beside the waypoints.
pub(super) fn searched_beside(setup: &DriveSetup) -> Option<String> {
    let environment = setup.scenario.generate.environment?;
    let mut searched = Vec::new();
    searched.extend(environment.external_force_n.map(|force| format!("a steady horizontal force of up to {force} N")));
    searched.extend(environment.obstacles.map(|placed| {
        format!("up to {} round keep-outs of {} m radius clear of the plan", placed.count, placed.radius_m)
    }));
    Some(format!(
        "Searched beside the waypoints, and part of each case: {}. Controllers see no keep-outs, and the claim knows of no force.",
        searched.join(", ")
    ))
}
