//! The bounds of every key of a drive.

mod environment;
mod pace;
mod places;
mod varied;

use std::sync::Arc;

use self::pace::{check_limits, check_speed};
use super::DriveSetup;
use crate::campaign::attachments::Attachments;
use crate::campaign::bounds::MOST_OF_A_DRIVE;
use crate::campaign::check::{Findings, check_executed, check_search};
use crate::campaign::kind::{Build, Given};
use crate::campaign::scenario::{
    ControlName, DirectionDeg, DriveExecute, DriveGenerate, DriveScenario, DriveSpec, DriveTask, EXECUTED,
    GeneratorName, GroundReach, GroundSection, Keys, Manoeuvre, Mistake, SearchMethod,
};
use crate::feasibility::reach::drive::GroundScore;
use crate::math::simd::Simd;
use crate::robot::rover::{Rover, Steering};
use crate::world::terrain::{ElevationMap, KeepOuts};

/// Nodes of the roadmap, waypoints × headings: legs are pairs of them, each a boundary-value problem.
///
/// At 5000 nodes a search that asked for all legs would solve 25 million; a beam asks for few of them.
const MOST_NODES: u64 = 5_000;

impl Build for DriveSetup {
    type Keys = DriveScenario;

    fn build(given: Given<'_, Self>) -> Result<Self, Mistake> {
        let Given { keys, files, known } = given;
        let (rovers, map) = (Self::rovers(keys, known)?, Self::map(keys, files, known)?);
        Ok(Self::of(given, rovers, map, Self::keep_out(keys, known)?))
    }

    /// Nothing is made twice: robots, map and keep-outs that are right go into the setup. Checks go on after a mistake,
    /// so that a caller is told of all at once; only ground is made (or read) after all that stands before it is right,
    /// as it is dear.
    fn check(given: Given<'_, Self>) -> Result<Self, Vec<Mistake>> {
        let Given { keys, files, known } = given;
        let mut found = Findings::default();
        found.head(keys.hairpin, keys.seed);
        let rovers = found.take(Self::rovers(keys, known));
        let rover = rovers.as_ref().map(|[rover, _]| &**rover);
        check_ground(&keys.world, &mut found);
        let keep_out = found.take(Self::keep_out(keys, known));
        check_task(&keys.task, rover, &mut found);
        let map = Self::map(keys, files, known);
        let map = match found.0.is_empty() {
            true => found.take(map).inspect(|map| places::check(keys, keep_out.as_deref(), map, &mut found)),
            // What is wrong with the ground is told once all before it is right.
            false => map.ok(),
        };
        check_generate(&keys.generate, rover, &mut found);
        check_score(keys, files, &mut found);
        environment::check(keys, rover, map.as_deref(), &mut found);
        check_execute(&keys.execute, rover, &mut found);
        check_spec(&keys.spec, &mut found);
        varied::check(keys, keys.robot.resolved().ok(), &mut found);
        match (rovers, map, keep_out) {
            (Some(rovers), Some(map), Some(keep_out)) if found.0.is_empty() => {
                Ok(Self::of(given, rovers, map, keep_out))
            }
            _ => Err(found.0),
        }
    }
}

impl DriveSetup {
    /// Kernels and controller stay those of the setup that is known.
    ///
    /// Nothing is checked here.
    fn of(
        given: Given<'_, Self>,
        [rover, planner]: [Arc<Rover>; 2],
        map: Arc<ElevationMap>,
        keep_out: Arc<KeepOuts>,
    ) -> Self {
        let Given { keys, files, known } = given;
        let controller = known.and_then(|known| known.controller.clone());
        let simd = known.map_or_else(Simd::default, |known| known.simd);
        let (scenario, attachments) = (keys.clone(), files.clone());
        let leaves_slopes_out = Self::slopes_left_out(&rover, &map, known);
        Self { scenario, attachments, rover, planner, map, leaves_slopes_out, keep_out, controller, simd }
    }
}

/// A name, a learned model's file made for the same robot, or a program of the user's own.
///
/// A program or a file has its own bounds; a name must be one of the terms of `GroundScore`, or `executed`.
fn check_score(keys: &DriveScenario, files: &Attachments, found: &mut Findings) {
    let (key, search) = ("generate.search.score", &keys.generate.search);
    let score = &search.score;
    found.target_of_file(search.target.as_ref(), files);
    if !found.score_of_file(key, score, files, || keys.subject()) {
        if score == EXECUTED {
            check_executed(&search.section(), key, found);
        } else if let Err(error) = GroundScore::named(score) {
            found.require(false, key, format!("\"{score}\""), &format!("{error}; or {EXECUTED}"));
        }
    }
    let given = files.model(score).map_or(score, |model| &model.given);
    found.rounds(search.method, (key, given), keys.vary.keys());
}

/// No plane of the Earth has coordinates beyond, m.
const MOST_OFFSET: f64 = 1e8;

/// A file or a generator; the generator's keys only with one; an origin that is on Earth.
///
/// Whether its file can be read, or what the generator makes of its numbers, is not asked here.
fn check_ground(world: &GroundSection, found: &mut Findings) {
    let terrain = &world.terrain;
    let one = terrain.file.is_some() != terrain.generator.is_some();
    found.require(one, "world.terrain", "a table", "exactly one of file and generator");
    for (key, given) in [
        ("size_m", terrain.size_m.is_some()),
        ("seed", terrain.seed.is_some()),
        ("relief_m", terrain.relief_m.is_some()),
        ("rock_cover", terrain.rock_cover.is_some()),
    ] {
        let fine = !given || terrain.generator.is_some();
        found.require(fine, &format!("world.terrain.{key}"), "given", "left out: it is for generated ground");
    }
    for (key, given) in [
        ("epsg", terrain.epsg.is_some()),
        ("unit", terrain.unit.is_some()),
        ("height_unit", terrain.height_unit.is_some()),
        ("unknown_plane", terrain.unknown_plane.is_some()),
        ("offset_m", terrain.offset_m.is_some()),
        ("origin_m", terrain.origin_m.is_some()),
        ("height_m", terrain.height_m.is_some()),
        ("columns", terrain.columns.is_some()),
    ] {
        let fine = !given || terrain.file.is_some();
        found.require(fine, &format!("world.terrain.{key}"), "given", "left out: it is for a map's file");
    }
    let flat = terrain.generator == Some(GeneratorName::Flat);
    for (key, given) in [("relief_m", terrain.relief_m), ("rock_cover", terrain.rock_cover)] {
        if let Some(value) = given.filter(|value| flat && *value != 0.0) {
            let bound = "0 or left out: flat ground has neither heights nor rocks; fractal and craters do";
            found.require(false, &format!("world.terrain.{key}"), value, bound);
        }
    }
    for (axis, part) in terrain.offset_m.iter().flatten().enumerate() {
        found.from(&format!("world.terrain.offset_m[{axis}]"), *part, -MOST_OFFSET, MOST_OFFSET, " m");
    }
    if let Some(origin) = &world.origin {
        found.origin(origin);
    }
}

/// Leg lengths within (0, 1000] m and rising; the start's curvature within the robot's.
///
/// Whether both ends lie on the map is asked by `places::check`, which needs one.
fn check_task(task: &DriveTask, rover: Option<&Rover>, found: &mut Findings) {
    found.count("task.length", task.length, 2, MOST_OF_A_DRIVE as u64);
    let [low, high] = task.leg_m;
    found.above("task.leg_m[0]", low, 0.0, 1000.0, " m");
    found.above("task.leg_m[1]", high, 0.0, 1000.0, " m");
    found.require(low < high, "task.leg_m", format!("[{low}, {high}]"), "rising: [shortest, longest]");
    found.from("task.start.yaw_deg", task.start.yaw_deg, -3600.0, 3600.0, "°");
    if let Some(rover) = rover {
        let most = rover.limits.curvature;
        found.from("task.start.curvature_1_m", task.start.curvature_1_m, -most, most, " 1/m, the robot's");
    }
}

/// Roadmaps have at most 5000 nodes (waypoints × headings), a quarter of that for methods other than the beam.
///
/// The step lies within (0, 1000] s, the solver's precisions within (1e-6, 1] m, rad and 1/m, headings are 1 … 64.
fn check_generate(generate: &DriveGenerate, rover: Option<&Rover>, found: &mut Findings) {
    let search = &generate.search;
    found.count("generate.headings", generate.headings, 1, 64);
    check_controls(generate, rover, found);
    check_speed(generate, rover, found);
    let most = if search.method == SearchMethod::Beam { MOST_NODES } else { MOST_NODES / 4 };
    found.count("generate.search.waypoints", search.waypoints, 1, most);
    let nodes = search.waypoints.saturating_mul(generate.headings);
    if generate.reach == GroundReach::Witness && search.waypoints <= most {
        let bound = format!("at most {most}: waypoints × headings ({}) of the roadmap", generate.headings);
        let value = format!("{} ({nodes} nodes)", search.waypoints);
        found.require(nodes <= most, "generate.search.waypoints", value, &bound);
    }
    check_search(&search.section(), found);
    found.above("generate.step_s", generate.step_s, 0.0, 1000.0, " s");
    let gears = generate.manoeuvres.iter().any(|m| matches!(m, Manoeuvre::Forward | Manoeuvre::Reverse));
    found.require(gears, "generate.manoeuvres", "no gear", "forward or reverse at least");
    check_limits(&generate.limits, rover, found);
    let solver = &generate.solver;
    found.above("generate.solver.position_m", solver.position_m, 1e-6, 1.0, " m");
    found.above("generate.solver.yaw_rad", solver.yaw_rad, 1e-6, 1.0, " rad");
    found.above("generate.solver.curvature_1_m", solver.curvature_1_m, 1e-6, 1.0, " 1/m");
    found.count("generate.solver.iterations", solver.iterations, 1, 100_000);
    found.count("generate.solver.starts", solver.starts, 1, 1_000);
}

/// What the controls need of manoeuvres and robot.
///
/// An arc alone cannot come to the next waypoint's heading, nor can turn-drive-turn without turns: both need
/// `turn-in-place`. What the robot can do is asked only where there is one.
fn check_controls(generate: &DriveGenerate, rover: Option<&Rover>, found: &mut Findings) {
    let turns = generate.manoeuvres.contains(&Manoeuvre::TurnInPlace);
    let word = format!("\"{}\"", generate.control.word());
    let bound = match generate.control {
        ControlName::Arc => {
            "joined by turns in place, with `turn-in-place` among generate.manoeuvres: an arc ends in the heading that it comes to"
        }
        _ => "driven with `turn-in-place` among generate.manoeuvres",
    };
    let needed = matches!(generate.control, ControlName::Arc | ControlName::TurnDriveTurn);
    found.require(turns || !needed, "generate.control", word, bound);
    let Some(rover) = rover else { return };
    let able = !turns || rover.limits.turns_in_place;
    found.require(able, "generate.manoeuvres", "\"turn-in-place\"", "what the robot can do: it does not turn in place");
    check_direction(generate, rover, found);
}

/// A direction of travel, and the vehicle and reach set it is for.
///
/// One number, or a range of them that drives turn through on the way. Other directions than 0 need a vehicle that
/// steers all of its wheels.
fn check_direction(generate: &DriveGenerate, rover: &Rover, found: &mut Findings) {
    let key = "generate.direction_deg";
    let value = match generate.direction_deg {
        DirectionDeg::All(direction) => {
            found.from(key, direction, -180.0, 180.0, "°");
            direction.to_string()
        }
        DirectionDeg::Between([low, high]) => {
            found.from(&format!("{key}[0]"), low, -180.0, 180.0, "°");
            found.from(&format!("{key}[1]"), high, -180.0, 180.0, "°");
            let given = format!("[{low}, {high}]");
            found.require(low <= high, key, &given, "rising: [least, greatest]");
            let drives = generate.reach == GroundReach::Witness;
            found.require(drives, key, &given, "one number: only drives of reach \"witness\" turn it along the way");
            given
        }
    };
    let crabs = generate.direction_deg.bounds() == [0.0; 2] || rover.wheels.steering == Steering::AllWheel;
    found.require(crabs, key, value, "0: the robot does not steer all wheels (steering = \"all-wheel\")");
}

/// Hairpin's own controller or a command, not both.
///
/// accept ≤ 1000 m, time limits ≤ 1e6 s, latency ≤ 60 s, each part of the force ≤ 1e6 N in size; a force needs a
/// vehicle with a weight.
fn check_execute(execute: &DriveExecute, rover: Option<&Rover>, found: &mut Findings) {
    found.who(execute.controller.as_ref(), execute.control_rate_hz, execute.command.as_deref());
    found.repeat(execute.repeat);
    found.flaky(execute.flaky);
    found.baseline(execute.baseline);
    found.above("execute.accept_m", execute.accept_m, 0.0, 1000.0, " m");
    if let Some(limit) = execute.time_limit_s {
        found.above("execute.time_limit_s", limit, 0.0, 1e6, " s");
    }
    if let Some(latency) = execute.latency_s {
        found.from("execute.latency_s", latency, 0.0, 60.0, " s");
    }
    if let Some(force) = execute.external_force_n {
        for (axis, part) in force.into_iter().enumerate() {
            found.from(&format!("execute.external_force_n[{axis}]"), part, -1e6, 1e6, " N");
        }
        let weighs = rover.is_none_or(|rover| rover.weight.is_some());
        let bound = "left out, or robot.mass_kg and robot.forces given: it acts against a weight";
        found.require(weighs, "execute.external_force_n", format!("{force:?}"), bound);
    }
    found.above("execute.timeout_s", execute.timeout_s, 0.0, 1e6, " s");
    found.processes(execute.processes, execute.workers);
}

/// Limits are finite; shares lie in [0, 1), confidence in [0.5, 1).
fn check_spec(spec: &DriveSpec, found: &mut Findings) {
    let limits = &spec.limits;
    if let Some(most) = limits.path_deviation_m {
        found.above("spec.limits.path_deviation_m", most, 0.0, 1e6, " m");
    }
    if let Some(least) = limits.tip_over_margin_deg {
        found.from("spec.limits.tip_over_margin_deg", least, 0.0, 90.0, "°");
    }
    if let Some(least) = limits.clearance_m {
        found.from("spec.limits.clearance_m", least, 0.0, 1e6, " m");
    }
    if let Some(most) = limits.total_time_s {
        found.above("spec.limits.total_time_s", most, 0.0, 1e9, " s");
    }
    found.share("spec.limits", limits.violation_share, limits.confidence);
}
