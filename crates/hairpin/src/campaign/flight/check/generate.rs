//! Bounds of `[generate]`.

use crate::campaign::attachments::Attachments;
use crate::campaign::check::{Findings, check_executed, check_search as check_common};
use crate::campaign::scenario::{
    EXECUTED, FlightScenario, GenerateSection, Keys, LimitsSection, ReachName, SearchMethod, SearchSection, Timing,
};
use crate::search::Score;

/// The frontier search looks at every waypoint in every expansion.
const MOST_WAYPOINTS: u64 = 100_000;
/// The dynamic programs keep every pair of waypoints, and visit every triple that is feasible.
const MOST_WAYPOINTS_IN_PAIRS: u64 = 2_000;
/// Nodes of the `witness` roadmap, waypoints × velocities: legs are pairs of them, judged once and kept.
///
/// Legs are judged when they are first asked for.
const MOST_NODES: u64 = 50_000;
/// The same for the dynamic programs, which judge every leg before they start.
const MOST_NODES_IN_PAIRS: u64 = 16_000;

/// The hull's resolution lies in 2 … 12, velocities per waypoint in 1 … 64.
pub(super) fn check(scenario: &FlightScenario, files: &Attachments, found: &mut Findings) {
    let generate = &scenario.generate;
    check_timing(generate, found);
    // Resolution to the fourth power is the number of simulated runs: 20 736 at 12.
    found.count("generate.resolution", generate.resolution, 2, 12);
    found.count("generate.velocities", generate.velocities, 1, 64);
    check_search(&generate.search, generate, found);
    check_score(scenario, files, found);
    found.target_of_file(generate.search.target.as_ref(), files);
    check_limits(&generate.limits, found);
}

/// A range of leg times is for the reach set `witness` alone; a step is at most 60 s there and 10 s elsewhere.
fn check_timing(generate: &GenerateSection, found: &mut Findings) {
    let key = "generate.timing";
    let bound = "exactly one of leg_time_s and step_s";
    match generate.timing {
        None => {}
        Some(Timing { leg_time_s: Some([shortest, longest]), step_s: None }) => {
            found.above("generate.timing.leg_time_s[0]", shortest, 0.0, 60.0, " s");
            found.above("generate.timing.leg_time_s[1]", longest, 0.0, 60.0, " s");
            let key = "generate.timing.leg_time_s";
            found.require(shortest < longest, key, format!("[{shortest}, {longest}]"), "rising: [shortest, longest]");
            let fits = generate.reach == ReachName::Witness;
            let bound = "step_s = …: only the reach `witness` chooses a time per leg";
            found.require(fits, key, format!("[{shortest}, {longest}]"), bound);
        }
        Some(Timing { leg_time_s: None, step_s: Some(step) }) => {
            // Constant rotor speeds held for longer have tumbled out of any cage.
            let longest = if generate.reach == ReachName::Witness { 60.0 } else { 10.0 };
            found.above("generate.timing.step_s", step, 0.0, longest, " s");
        }
        Some(Timing { leg_time_s: Some(_), step_s: Some(_) }) => found.require(false, key, "both", bound),
        Some(Timing { leg_time_s: None, step_s: None }) => found.require(false, key, "{}", bound),
    }
}

/// Bounds of waypoints by method, and for `witness` of nodes: waypoints × velocities.
///
/// Where the number of waypoints is out of bounds itself nothing is said of nodes.
fn check_search(search: &SearchSection, generate: &GenerateSection, found: &mut Findings) {
    let in_pairs = search.method != SearchMethod::Beam;
    let most = if in_pairs { MOST_WAYPOINTS_IN_PAIRS } else { MOST_WAYPOINTS };
    found.count("generate.search.waypoints", search.waypoints, 1, most);
    if generate.reach == ReachName::Witness && search.waypoints <= most && generate.velocities <= 64 {
        let nodes = search.waypoints * generate.velocities;
        let most = if in_pairs { MOST_NODES_IN_PAIRS } else { MOST_NODES };
        let bound = format!("at most {most}: waypoints × velocities ({}) of the witness roadmap", generate.velocities);
        found.require(
            nodes <= most,
            "generate.search.waypoints",
            format!("{} ({nodes} nodes)", search.waypoints),
            &bound,
        );
    }
    check_common(search, found);
}

/// A file's score brings its own checks; else one of the named ones, or `executed`, which goes with few methods.
fn check_score(scenario: &FlightScenario, files: &Attachments, found: &mut Findings) {
    let (key, score) = ("generate.score", scenario.generate.score.as_str());
    if found.score_of_file(key, score, files, || scenario.subject()) {
        return;
    }
    if score == EXECUTED {
        return check_executed(&scenario.generate.search, key, found);
    }
    let bound = format!("one of {}, {EXECUTED}, learned:MODEL, or python:FILE", Score::NAMES.join(", "));
    found.require(Score::NAMES.contains(&score), key, format!("\"{score}\""), &bound);
}

/// Speed (m/s) and flight time (s) above 0, tilt in (0, 180]°.
fn check_limits(limits: &LimitsSection, found: &mut Findings) {
    if let Some(speed) = limits.max_speed_m_s {
        found.above("generate.limits.max_speed_m_s", speed, 0.0, 1000.0, " m/s; leave it out for no cap");
    }
    if let Some(tilt) = limits.max_tilt_deg {
        found.above("generate.limits.max_tilt_deg", tilt, 0.0, 180.0, "°");
    }
    if let Some(time) = limits.max_flight_time_s {
        found.above("generate.limits.max_flight_time_s", time, 0.0, 1e6, " s");
    }
}
