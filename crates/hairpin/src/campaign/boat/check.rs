//! The bounds of every key of a boat's scenario.

use super::BoatSetup;
use super::keys::{ACROSS_CURRENT, BoatExecute, BoatGenerate, BoatScenario, WatersSection};
use super::varied::check_varied;
use crate::campaign::attachments::Attachments;
use crate::campaign::bounds::{LARGEST_WATERS_M, LONGEST_PASSAGE_S, LONGEST_TRIP_S, MOST_WAYPOINTS};
use crate::campaign::check::{Findings, check_executed, check_places_within, check_search, check_spec};
use crate::campaign::kind::{Build, Given};
use crate::campaign::scenario::{EXECUTED, Keys, Mistake, SearchMethod};
use crate::judgement::Stress;
use crate::robot::boat::Boat;
use crate::search::Score;
use crate::world::Sampling;
use crate::world::terrain::KeepOuts;

/// Nodes of the roadmap, waypoints × velocities: legs are pairs of them, judged once and kept; and of the dynamic
/// programs, which judge every leg before they start.
///
/// The second is that of methods that judge all pairs, ~ nodes² of them; `generate.search.waypoints` may be that many
/// divided by `generate.velocities`.
const MOST_NODES: u64 = 50_000;
const MOST_NODES_IN_PAIRS: u64 = 16_000;

impl Build for BoatSetup {
    type Keys = BoatScenario;

    fn build(given: Given<'_, Self>) -> Result<Self, Mistake> {
        let (boat, keep_out) = (Self::boat(given.keys, given.known)?, Self::keep_out(given.keys, given.known)?);
        Ok(Self::of(given, boat, keep_out))
    }

    /// All mistakes are told, in the order of the file's sections. A setup is made only without any; what was built on
    /// the way goes into it.
    fn check(given: Given<'_, Self>) -> Result<Self, Vec<Mistake>> {
        let Given { keys, files, known } = given;
        let mut found = Findings::default();
        found.head(keys.hairpin, keys.seed);
        let boat = found.take(Self::boat(keys, known));
        check_world(&keys.world, &mut found);
        let keep_out = found.take(Self::keep_out(keys, known));
        if let Some(places) = &keep_out {
            check_places_within(places, [[0.0; 2], keys.world.size_m], "inside the waters", &mut found);
        }
        check_task(keys, boat.as_deref(), keep_out.as_deref(), &mut found);
        check_generate(&keys.generate, &mut found);
        check_score(keys, files, &mut found);
        check_execute(&keys.execute, boat.as_deref(), &mut found);
        check_spec(&keys.spec, LONGEST_TRIP_S, &mut found);
        check_varied(keys, keys.robot.resolved().ok(), &mut found);
        match (boat, keep_out) {
            (Some(boat), Some(keep_out)) if found.0.is_empty() => Ok(Self::of(given, boat, keep_out)),
            _ => Err(found.0),
        }
    }
}

/// Sides within (0, [`LARGEST_WATERS_M`]] m; the margin less than half the smaller side; each part of the current
/// within ±100 m/s.
fn check_world(world: &WatersSection, found: &mut Findings) {
    for (axis, size) in world.size_m.into_iter().enumerate() {
        found.above(&format!("world.size_m[{axis}]"), size, 0.0, LARGEST_WATERS_M, " m");
    }
    let most = 0.5 * world.size_m[0].min(world.size_m[1]);
    let (margin, bound) = (world.keep_in_margin_m, format!("≥ 0 and < {most} m, half the smallest side"));
    found.require(margin >= 0.0 && (margin < most || most <= 0.0), "world.keep_in_margin_m", margin, &bound);
    for (axis, part) in world.current().into_iter().enumerate() {
        found.from(&format!("world.current_m_s[{axis}]"), part, -100.0, 100.0, " m/s");
    }
    if let Some(origin) = &world.origin {
        found.origin(origin);
    }
}

/// It must be possible to lie at both ends.
///
/// Ends lie within the margins, and their distance from every keep-out is at least the hull's radius. A boat or
/// keep-outs that are wrong themselves are told by their own keys.
fn check_task(keys: &BoatScenario, boat: Option<&Boat>, keep_out: Option<&KeepOuts>, found: &mut Findings) {
    let (task, world) = (&keys.task, &keys.world);
    found.count("task.length", task.length, 2, MOST_WAYPOINTS as u64);
    for (key, place) in [("task.start_m", task.start_m), ("task.end_m", task.end_m)] {
        for (axis, x) in place.into_iter().enumerate() {
            let (least, most) = (world.keep_in_margin_m, world.size_m[axis] - world.keep_in_margin_m);
            let bound = format!("inside the waters: {least} … {most} m");
            found.require(x >= least && x <= most, &format!("{key}[{axis}]"), x, &bound);
        }
        let (Some(boat), Some(keep_out)) = (boat, keep_out) else { continue };
        if let Some(near) = keep_out.nearest(place[0], place[1]).filter(|near| near.distance < boat.radius) {
            let bound = format!("at least {:.3} m, the hull's radius, from `{}`", boat.radius, near.keep_out.name);
            found.require(false, key, format!("{place:?}"), &bound);
        }
    }
}

/// 0 < shortest < longest leg time; 1 … 64 velocities a waypoint; `thrust_share` in (0, 1].
fn check_generate(generate: &BoatGenerate, found: &mut Findings) {
    let [shortest, longest] = generate.leg_time_s;
    found.above("generate.leg_time_s[0]", shortest, 0.0, LONGEST_PASSAGE_S, " s");
    found.above("generate.leg_time_s[1]", longest, 0.0, LONGEST_PASSAGE_S, " s");
    let key = "generate.leg_time_s";
    found.require(shortest < longest, key, format!("[{shortest}, {longest}]"), "rising: [shortest, longest]");
    found.count("generate.velocities", generate.velocities, 1, 64);
    let search = &generate.search;
    let in_pairs = search.method != SearchMethod::Beam;
    let most = if in_pairs { MOST_NODES_IN_PAIRS } else { MOST_NODES };
    found.count("generate.search.waypoints", search.waypoints, 1, most / generate.velocities.clamp(1, 64));
    let bound = "\"uniform\": waypoints of boats are drawn no other way";
    found.require(search.sampling == Sampling::Uniform, "generate.search.sampling", "another", bound);
    check_search(search, found);
    let limits = &generate.limits;
    if let Some(speed) = limits.max_speed_m_s {
        found.above("generate.limits.max_speed_m_s", speed, 0.0, 1000.0, " m/s; leave it out for no cap");
    }
    if let Some(share) = limits.thrust_share {
        found.above("generate.limits.thrust_share", share, 0.0, 1.0, "");
    }
    if let Some(time) = limits.max_time_s {
        found.above("generate.limits.max_time_s", time, 0.0, LONGEST_TRIP_S, " s");
    }
}

/// A file's score is read as one of the caller's; `executed` scores have bounds of their own.
///
/// No stress of joints, tilt, saturation or lateness is measured on trips. Beside the scores of all kinds boats have
/// `across-current`.
fn check_score(keys: &BoatScenario, files: &Attachments, found: &mut Findings) {
    let (generate, key) = (&keys.generate, "generate.score");
    let (search, score) = (&generate.search, generate.score.as_str());
    let named = files.model(score).map_or(score, |model| &model.given);
    found.rounds(search.method, (key, named), keys.vary.keys());
    let unmeasured = [Stress::JointEffort, Stress::Tilt, Stress::Saturation, Stress::Lateness];
    let near = !keys.world.keep_out.is_empty();
    found.sought(&keys.head(), &|stress| !unmeasured.contains(&stress), ("trip", "world.keep_out", near));
    found.target_of_file(search.target.as_ref(), files);
    if found.score_of_file(key, score, files, || keys.subject()) {
        return;
    }
    if score == EXECUTED {
        return check_executed(search, key, found);
    }
    let names = Score::NAMES.join(", ");
    let bound = format!("one of {ACROSS_CURRENT}, {names}, {EXECUTED}, learned:MODEL, or python:FILE");
    let known = score == ACROSS_CURRENT || Score::NAMES.contains(&score);
    found.require(known, key, format!("\"{score}\""), &bound);
}

/// `speed_m_s` is at most the boat's top speed, 100 m/s where the boat is wrong itself. Forces within ± 1e6 N a
/// component.
fn check_execute(execute: &BoatExecute, boat: Option<&Boat>, found: &mut Findings) {
    found.who(execute.controller.as_ref(), execute.control_rate_hz, execute.command.as_deref());
    found.repeat(execute.repeat);
    found.flaky(execute.flaky);
    found.baseline(execute.baseline);
    found.above("execute.accept_m", execute.accept_m, 0.0, 10_000.0, " m");
    if let Some(limit) = execute.time_limit_s {
        found.above("execute.time_limit_s", limit, 0.0, 1e6, " s");
    }
    if let Some(speed) = execute.speed_m_s {
        let most = boat.map_or(100.0, |boat| boat.top_speed);
        found.above("execute.speed_m_s", speed, 0.0, most, " m/s, the boat's top speed");
    }
    for (axis, part) in execute.external_force_n.unwrap_or_default().into_iter().enumerate() {
        found.from(&format!("execute.external_force_n[{axis}]"), part, -1e6, 1e6, " N");
    }
    found.above("execute.timeout_s", execute.timeout_s, 0.0, 1e6, " s");
    found.processes(execute.processes, execute.workers);
}
