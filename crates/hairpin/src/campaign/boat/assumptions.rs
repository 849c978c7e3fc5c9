//! What a boat's claim, execution and limits rest on, said from the run's own settings.
//!
//! Every number in a sentence is read from the setup that ran, with defaults in force.

use super::BoatSetup;
use crate::campaign::kind::reached_within;
use crate::campaign::scenario::DeviationFrom;

/// What stands behind the legs.
///
/// The share of thrust is told only where one is given.
pub(super) fn claim(setup: &BoatSetup, said: &mut Vec<String>) {
    said.push(
        "Reach `witness`: each leg has a surge force, a sway force and a yaw moment within the thrusters' limits all along, for the \
         manoeuvring model in three degrees of freedom; lag of the thrusters, wind and waves are outside the claim."
            .into(),
    );
    let [east, north] = setup.scenario.world.current();
    said.push(format!(
        "The current, ({east}, {north}) m/s, is steady, the same everywhere, and known to the plan. At waypoints the bow points \
         into the boat's motion through the water."
    ));
    let (margin, radius) = (setup.scenario.world.keep_in_margin_m, setup.boat.radius);
    let over = if reaches_over(setup) { ", so that it may reach over them" } else { "" };
    said.push(format!(
        "The middle of the hull's disc, {radius:.3} m in radius, keeps {margin} m from the edges of the waters{over}; all of it keeps out of \
         what is to be kept out of."
    ));
    if let Some(share) = setup.scenario.generate.limits.thrust_share {
        said.push(format!("Plans use {share} of the thrusters' limits."));
    }
}

/// Whether the edges, from which the middle of the hull's disc keeps the margin, may lie within the disc.
pub(super) fn reaches_over(setup: &BoatSetup) -> bool {
    setup.scenario.world.keep_in_margin_m < setup.boat.radius
}

/// Who sailed them.
///
/// Nothing where a program of the user's sails: how that simulates is its own business.
pub(super) fn act(setup: &BoatSetup, said: &mut Vec<String>) {
    let execute = &setup.scenario.execute;
    let who = match (&setup.controller, execute.controller_in_force()) {
        (Some(own), _) => format!("`{}`, the caller's own", own.name()),
        (None, Some(ours)) => format!("`{}` with hairpin's own gains, fixed by step responses", ours.word()),
        (None, None) => return,
    };
    said.push(format!(
        "Simulated: hull in surge, sway and yaw with thrusters that lag ({} s) and end at 0.02 s, no waves, controller {who}; noise {}.",
        setup.boat.thrust_time_constant,
        if execute.noise { "on" } else { "off" }
    ));
}

/// What deviation is.
pub(super) fn verdict(setup: &BoatSetup, said: &mut Vec<String>) {
    said.push(reached_within(setup.scenario.execute.accept_m, setup.scenario.execute.command.is_some()));
    said.push(match setup.scenario.spec.deviation {
        Some(deviation) => {
            let from = match deviation.from {
                DeviationFrom::Leg => "the straight leg being sailed",
                DeviationFrom::NearestLeg => "the nearer of the previous and the current leg",
                DeviationFrom::Path => "the planned path",
            };
            let corner = deviation.corner_m;
            let within = format!("; within {corner} m of the leg's own waypoints overshoot is judged instead");
            let corner = if corner > 0.0 { within } else { String::new() };
            format!("Deviation is the distance from {from}{corner}. Tracks are not aligned.")
        }
        None => "No deviation limit is given: deviations are told, not judged. Tracks are not aligned.".into(),
    });
}
