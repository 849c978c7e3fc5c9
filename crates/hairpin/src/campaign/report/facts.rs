//! What a report says in words and numbers beside its pictures.

use serde::Serialize;

use super::data::{Metric, Pieces};
use super::text::{cells, leg};
use crate::campaign::arm::ArmSetup;
use crate::campaign::digits::number;
use crate::campaign::drive::DriveSetup;
use crate::campaign::flight::FlightSetup;
use crate::campaign::setup::Kind;
use crate::campaign::{CaseResult, Status};
use crate::judgement::{Measures, share};

pub(super) fn key_numbers(pieces: &Pieces) -> Vec<[String; 3]> {
    let of = |a: &str, b: String, c: String| [a.to_owned(), b, c];
    let judged = pieces.results.iter().filter(|r| matches!(r.status, Status::Pass | Status::Fail)).count();
    let failed = pieces.results.iter().filter(|r| r.status == Status::Fail).count();
    let mut numbers = Vec::new();
    if let Some((worst, measures)) = largest_deviation(pieces.results) {
        let limit = pieces.setup.scenario.deviation_limit();
        let limit = limit.map_or("no limit set".into(), |limit| format!("limit {} m", number(Some(limit))));
        numbers.push(of("largest deviation", format!("{} m", number(Some(measures.max_deviation))), limit));
        let place = format!("t = {} s, leg {}", number(Some(measures.t_worst)), leg(measures.leg_worst));
        numbers.push(of("in case", cells(worst)[0].clone(), place));
    }
    let confidence = pieces.setup.scenario.confidence().unwrap_or(0.95);
    let interval = share(failed, judged, confidence).map_or("none judged".into(), |share| {
        format!("{:.1} % [{:.1}, {:.1}]", 100.0 * share.value, 100.0 * share.low, 100.0 * share.high)
    });
    numbers.push(of("violations", format!("{failed} of {judged}"), interval));
    let tally = pieces.tally;
    let asked = pieces.setup.scenario.search().cases;
    let origin = if tally.missions.is_empty() {
        format!("{asked} asked for; {} of {} graphs had one", tally.solved, tally.graphs)
    } else {
        "missions made elsewhere".into()
    };
    numbers.push(of("cases", pieces.cases.len().to_string(), origin));
    numbers
}

fn largest_deviation(results: &[CaseResult]) -> Option<(&CaseResult, &Measures)> {
    let measured = results.iter().filter_map(|result| result.measures.as_ref().map(|m| (result, m)));
    measured.max_by(|a, b| a.1.max_deviation.total_cmp(&b.1.max_deviation).then(b.0.case.cmp(&a.0.case)))
}

pub(super) fn facts(pieces: &Pieces) -> Vec<[String; 2]> {
    let setup = pieces.setup;
    let scenario = &setup.scenario;
    let caveat = if setup.caveat().is_empty() { String::new() } else { format!(" ({})", setup.caveat()) };
    let executor = match (setup.controller(), scenario.executor().command) {
        (Some(controller), _) => format!("{controller}, simulated"),
        (None, Some(command)) => format!("`{command}`"),
        (None, None) => setup.recordings().map_or("none".into(), |logs| format!("logs `{logs}`, hardware")),
    };
    let (world, task) = match setup.kind() {
        Kind::Flight(setup) => (cage(&setup), flight_task(&setup)),
        Kind::Drive(setup) => (ground(&setup), drive_task(&setup)),
        Kind::Arm(setup) => (cell(&setup), arm_task(&setup)),
    };
    let search = scenario.search();
    let search = if let Some(arm) = setup.arm() {
        format!("heaviest path through {} points, cost {}", arm.asked_points(), scenario.score())
    } else {
        format!(
            "{}, width {}, {} waypoints per graph, score {}",
            word(&search.method),
            search.width,
            search.waypoints,
            scenario.score()
        )
    };
    let fact = |label: &str, value: String| [label.to_owned(), value];
    vec![
        fact("robot", format!("{}{caveat}", setup.robot_name())),
        fact("world", world),
        fact("task", task),
        fact(if setup.arm().is_some() { "proven clear" } else { "reach set" }, scenario.reach().into()),
        fact("search", search),
        fact("executor", executor),
        fact("runs", format!("{} per case, the worst counts", scenario.executor().repeat)),
        fact("root seed", scenario.seed().to_string()),
    ]
}

fn cage(setup: &FlightSetup) -> String {
    let size = setup.world.size();
    format!("{} × {} × {} m, {} obstacles", size.x, size.y, size.z, setup.scenario.world.obstacles.len())
}

fn flight_task(setup: &FlightSetup) -> String {
    let point = |p: [f64; 3]| format!("({}, {}, {})", p[0], p[1], p[2]);
    let task = &setup.scenario.task;
    format!("{} waypoints from {} to {} m", task.length, point(task.start_m), point(task.end_m))
}

fn ground(setup: &DriveSetup) -> String {
    let (low, high) = setup.map.extent();
    let cell = setup.map.grid().cell;
    let terrain = &setup.scenario.world.terrain;
    let name = terrain.file.clone().or_else(|| terrain.generator.map(|name| format!("generator {}", word(&name))));
    format!(
        "{}: {:.1} × {:.1} m in cells of {:.3} m, {} keep-outs",
        name.unwrap_or_default(),
        high[0] - low[0],
        high[1] - low[1],
        cell[0],
        setup.keep_out.list().len()
    )
}

fn drive_task(setup: &DriveSetup) -> String {
    let task = &setup.scenario.task;
    let end = task.end_m.map_or("anywhere".into(), |[x, y]| format!("({x}, {y}) m"));
    let [low, high] = task.leg_m;
    let start = &task.start;
    format!("{} waypoints from ({}, {}) m to {end}, legs of {low} … {high} m", task.length, start.x_m, start.y_m)
}

fn cell(setup: &ArmSetup) -> String {
    let tool = &setup.station.tool;
    format!(
        "{} obstacles and keep-outs, tool `{}` of radius {} mm",
        setup.station.cell.parts.len(),
        tool.name,
        number(Some(1e3 * tool.radius))
    )
}

fn arm_task(setup: &ArmSetup) -> String {
    let moves = &setup.scenario.generate.moves;
    format!(
        "{} points, speeds {}, zones {}",
        setup.station.points.len(),
        moves.speeds.join(", "),
        moves.zones.join(", ")
    )
}

/// A key's word, as it stands in scenario files.
fn word(value: &impl Serialize) -> String {
    serde_json::to_value(value).ok().and_then(|value| value.as_str().map(str::to_owned)).unwrap_or_default()
}

pub(super) fn metrics(pieces: &Pieces) -> Vec<Metric> {
    let limits = pieces.setup.scenario.head().terms.limits;
    let metric = |name, unit, limit, of: fn(&Measures) -> Option<f64>| Metric {
        name,
        unit,
        limit,
        lower_is_worse: matches!(name, "clearance" | "tip-over margin"),
        values: pieces.results.iter().filter_map(|result| result.measures.as_ref().and_then(of)).collect(),
    };
    let all = vec![
        metric("max deviation", "m", limits.deviation, |m| Some(m.max_deviation)),
        metric("mean deviation", "m", None, |m| Some(m.mean_deviation)),
        metric("overshoot", "m", limits.overshoot, |m| Some(m.max_overshoot())),
        metric("acceleration", "m/s²", limits.acceleration, |m| Some(m.max_acceleration)),
        metric("total time", "s", limits.total_time, |m| Some(m.total_time)),
        metric("clearance", "m", limits.clearance, |m| m.min_clearance),
        metric("tip-over margin", "°", limits.tip_over_margin, |m| m.min_tip_over_margin),
        metric("tilt", "°", None, |m| m.max_tilt),
        metric("latest arrival", "ms", limits.late.map(|late| 1e3 * late), |m| m.latest.map(|late| 1e3 * late.by)),
        metric("saturation", "%", None, |m| m.saturation_share.map(|share| 100.0 * share)),
        metric("joint effort", "rad²/s³", None, |m| m.joint_effort),
    ];
    all.into_iter().filter(|metric| !metric.values.is_empty()).collect()
}
