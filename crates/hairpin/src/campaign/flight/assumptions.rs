//! What a flight's claim, execution and limits rest on, said from the run's own settings.
//!
//! Every sentence is written from the setup that ran, with defaults in force: reach set, estimates, limits, who flew,
//! and what a deviation is measured from.

use super::fly::makes_own_curve;
use super::{FlightSetup, idle};
use crate::campaign::Case;
use crate::campaign::scenario::{DeviationFrom, EstimatedAttitude, EstimatedVelocity, ReachName, Timing};

/// What stands behind the legs.
///
/// The first sentence is the reach set's. Certificates are counted over all cases of the campaign.
pub(super) fn claim(setup: &FlightSetup, cases: &[Case], said: &mut Vec<String>) {
    let generate = &setup.scenario.generate;
    said.push(match generate.reach {
        ReachName::None => "Reach `none`: every waypoint counts as reachable; nothing is claimed.".into(),
        ReachName::Sphere => format!(
            "Reach `sphere`: a ball of radius top speed ({} m/s) times step; a necessary condition at best, nothing is \
             claimed.",
            setup.robot.max_speed
        ),
        ReachName::Hull => "Reach `hull`: `hull-feasible` is a geometric filter, neither sound nor complete: a convex \
                            hull of sampled end points is not a set of reachable points; drag and rotor lag are off in it."
            .into(),
        ReachName::Published => "Reach `published`: one Euler step, as the paper's program has it, for comparison only; \
                                 its angles alias."
            .into(),
        ReachName::Witness => "Reach `witness`: each leg starts and ends level and has rotor speeds within limits all \
                               along, with drag, for the model; rotor lag and wind are outside the claim; no flips are \
                               found."
            .into(),
    });
    if !matches!(generate.reach, ReachName::Witness) {
        let velocity = match generate.estimate.velocity {
            EstimatedVelocity::Average => "leg over step",
            EstimatedVelocity::Zero => "zero",
        };
        let attitude = match generate.estimate.attitude {
            EstimatedAttitude::Level => "level",
            EstimatedAttitude::Keep => "kept from the nearest sample",
        };
        said.push(format!("State assumed at a waypoint: velocity {velocity}, attitude {attitude}."));
        if generate.limits.max_tilt_deg.is_some() {
            said.push(format!("`max_tilt_deg` is not checked by reach `{}`.", generate.reach.word()));
        }
    }
    if let Some([radius, margin]) = reaches_through(setup) {
        said.push(format!(
            "The middle of the body, {radius} m in radius (`clearance_radius_m`), keeps {margin} m (`keep_in_margin_m`) from the \
             world's edges, so that it may reach through them."
        ));
    }
    if let Some(Timing { step_s: Some(step), .. }) = generate.timing {
        said.push(format!("Every leg is planned to take {step} s."));
    }
    let certified: Vec<_> = cases.iter().filter_map(|case| case.certified).collect();
    if !certified.is_empty() {
        let count = |answer: &str| certified.iter().filter(|found| **found == answer).count();
        said.push(format!(
            "Certified afterwards: {} yes, with leg times of the witness, {} no, {} unknown of {}.",
            count("yes"),
            count("no"),
            count("unknown"),
            certified.len()
        ));
    }
}

/// Radius of the body and margin of the world's edges, m, where the edges, from which the body's middle keeps the
/// margin, may lie within it.
pub(super) fn reaches_through(setup: &FlightSetup) -> Option<[f64; 2]> {
    let (radius, margin) = (setup.robot.clearance_radius, setup.scenario.world.keep_in_margin_m.unwrap_or(0.0));
    (radius > margin).then_some([radius, margin])
}

/// What `execute.noise` comes to.
fn noise_word(setup: &FlightSetup) -> &'static str {
    match (setup.scenario.execute.noise, idle::is_noiseless(&setup.robot)) {
        (false, _) => "off",
        (true, false) => "on",
        (true, true) => "on, of which the robot has none",
    }
}

/// Who flew them.
///
/// Nothing where a program of the user's flies.
pub(super) fn act(setup: &FlightSetup, said: &mut Vec<String>) {
    let execute = &setup.scenario.execute;
    let who = match (&setup.controller, execute.controller_in_force()) {
        (Some(own), _) => format!("`{}`, the caller's own, on hairpin's inner loops", own.name()),
        (None, Some(ours)) => format!("`{}` with {}", ours.word(), ours.gains()),
        (None, None) => return,
    };
    let faster = execute.bandwidth.map_or(String::new(), |b| format!(", its loops {b} times as fast"));
    let late = execute.latency_s.map_or(String::new(), |latency| format!("; commands act {latency} s late"));
    said.push(format!(
        "Simulated: rigid body with rotor lag and drag at {} s, controller {who}{faster}{late}; noise {}.",
        execute.step_s,
        noise_word(setup)
    ));
}

/// What deviation is.
pub(super) fn verdict(setup: &FlightSetup, said: &mut Vec<String>) {
    match setup.scenario.spec.deviation {
        Some(deviation) => {
            let from = match deviation.from {
                DeviationFrom::Leg => "the straight leg being flown",
                DeviationFrom::NearestLeg => "the nearer of the previous and the current leg",
                DeviationFrom::Path if makes_own_curve(setup) => "the curve that the controller makes of the waypoints",
                DeviationFrom::Path => "the programmed path",
            };
            let corner = if deviation.corner_m > 0.0 {
                format!("; within {} m of the leg's own waypoints overshoot is judged instead", deviation.corner_m)
            } else {
                String::new()
            };
            said.push(format!("Deviation is the distance from {from}{corner}. Tracks are not aligned."));
        }
        None => {
            said.push("No deviation limit is given: deviations are told, not judged. Tracks are not aligned.".into())
        }
    }
}

/// What was searched beside the waypoints.
///
/// `None` where nothing was searched. Bounds are those asked for, m/s.
pub(super) fn searched_beside(setup: &FlightSetup) -> Option<String> {
    let environment = setup.scenario.generate.environment?;
    let mut searched = Vec::new();
    searched.extend(environment.wind_m_s.map(|wind| format!("a constant wind of up to {wind} m/s")));
    searched.extend(environment.gust_m_s.map(|gust| format!("a gust of up to {gust} m/s")));
    searched.extend(environment.obstacles.map(|placed| format!("{} obstacles clear of the plan", placed.count)));
    Some(format!(
        "Searched beside the waypoints, and part of each case: {}. The claim knows nothing of moving air.",
        searched.join(", ")
    ))
}
