//! The bounds of every key of an arm's scenario.

use super::ArmSetup;
use super::idle::check_varied;
use super::points::count;
use crate::campaign::attachments::Attachments;
use crate::campaign::bounds::MOST_POINTS;
use crate::campaign::check::Findings;
use crate::campaign::scenario::{
    ArmExecute, ArmGenerate, ArmMode, ArmScenario, ArmSpec, ArmTask, CONTROLLER_KEY, CostName, CostSection, Keys,
    LogClock, Mistake, MoveName, PointsSource, ProgramMethod, ProgramSearch, SearchSection, Steering, Target,
};
use crate::search::heaviest::{MOST_TRIPLE_POINTS, MOST_VISITS};
use crate::trajectory::program::{Speed, Zone};

/// Looks at all keys, and builds what they describe once nothing is wrong with them.
///
/// # Errors
/// Every nominal value that is out of bounds, in the order of the file.
pub(super) fn check(
    keys: &ArmScenario,
    files: &Attachments,
    build: impl FnOnce() -> Result<ArmSetup, Mistake>,
) -> Result<ArmSetup, Vec<Mistake>> {
    let mut found = Findings::default();
    found.head(keys.hairpin, keys.seed);
    let points = count(&keys.task, files);
    check_task(&keys.task, points, &mut found);
    check_generate(&keys.generate, points, files, &mut found);
    found.target_of_file(keys.generate.search.target.as_ref(), files);
    if let CostSection::Learned(cost) = &keys.generate.cost {
        found.score_of_file("generate.cost", &cost.score, files, || keys.subject());
    }
    check_execute(&keys.execute, &mut found);
    let drawn = keys.execute.logs.is_some() && !keys.vary.is_empty();
    let bound = "left out where runs are recorded elsewhere: nothing can be drawn for them";
    found.require(!drawn, "vary", "given", bound);
    check_varied(keys, &mut found);
    check_spec(&keys.spec, &mut found);
    let built = if found.0.is_empty() { found.take(build().and_then(with_fitting_costs)) } else { None };
    built.ok_or(found.0)
}

/// Costs of another number of points than the cloud's say nothing about it. Drawn points are counted once they are
/// there; where none is, that is told, not the table.
fn with_fitting_costs(setup: ArmSetup) -> Result<ArmSetup, Mistake> {
    let CostSection::Table(table) = &setup.scenario.generate.cost else { return Ok(setup) };
    let points = setup.station.points.len();
    match setup.attachments.costs(table) {
        Some(costs) if costs.points != points && points > 0 => Err(Mistake {
            key: "generate.cost.table".into(),
            value: format!("\"{}\", which has {} lines", table.table, costs.points),
            bound: format!("of {points} lines of {points} numbers, one for each point of the cloud"),
        }),
        _ => Ok(setup),
    }
}

fn check_task(task: &ArmTask, points: u64, found: &mut Findings) {
    let key = match &task.points {
        PointsSource::Drawn(_) => "task.points.count",
        PointsSource::File(_) | PointsSource::List(_) => "task.points",
    };
    found.count(key, points, 1, MOST_POINTS as u64);
    for (axis, angle) in task.home_deg.iter().enumerate() {
        found.from(&format!("task.home_deg[{axis}]"), *angle, -3600.0, 3600.0, "°");
    }
}

/// Units are those of the keys: mm, °, s. Arcs exclude joint moves, Cartesian graphs, repeated visits and costs that
/// come from a table or a model; with home's two points their cloud must stay within what triples are searched for.
fn check_generate(generate: &ArmGenerate, points: u64, files: &Attachments, found: &mut Findings) {
    if let CostSection::Weighted(weights) = &generate.cost {
        let all = [
            ("distance", weights.distance),
            ("time", weights.time),
            ("controller-load", weights.controller_load),
            ("joint-effort", weights.joint_effort),
        ];
        for (name, weight) in all {
            found.from(&format!("generate.cost.{name}"), weight, 0.0, 1e9, "");
        }
        let some = all.iter().any(|(_, weight)| *weight > 0.0);
        found.require(some, "generate.cost", "no weight", "one weight > 0 at least");
    }
    let placed = matches!(generate.cost, CostSection::Named(CostName::Distance) | CostSection::Table(_));
    let bound = "distance or a table where generate.mode = \"cartesian\": all others need joints, which that mode does not plan";
    found.require(placed || generate.mode == ArmMode::Joint, "generate.cost", told_cost(&generate.cost, files), bound);
    let moves = &generate.moves;
    found.require(!moves.speeds.is_empty(), "generate.moves.speeds", "[]", "one name at least, such as v1000");
    for (index, name) in moves.speeds.iter().enumerate() {
        let known = Speed::predefined(name).is_some();
        let bound = "one of the predefined speeds v5 … v7000, vmax";
        found.require(known, &format!("generate.moves.speeds[{index}]"), format!("\"{name}\""), bound);
    }
    found.require(!moves.zones.is_empty(), "generate.moves.zones", "[]", "one name at least, such as fine");
    for (index, name) in moves.zones.iter().enumerate() {
        let known = Zone::predefined(name).is_some();
        let bound = "one of the predefined zones fine, z0 … z200";
        found.require(known, &format!("generate.moves.zones[{index}]"), format!("\"{name}\""), bound);
    }
    found.from("generate.moves.clearance_mm", moves.clearance_mm, 0.0, 1e4, " mm");
    found.from("generate.moves.singularity_margin_deg", moves.singularity_margin_deg, 0.0, 45.0, "°");
    let measured = matches!(generate.cost, CostSection::Table(_) | CostSection::Learned(_));
    let bound = "false where moves go in joints, or cost what a table or a model says, or are planned without joints, or points come several times: none of these knows arcs";
    let joined = moves.kind == MoveName::Linear && generate.mode == ArmMode::Joint && generate.search.visits == 1;
    found.require(!moves.arcs || (joined && !measured), "generate.moves.arcs", "true", bound);
    let bound =
        format!("false, or a cloud of {MOST_TRIPLE_POINTS} points at most: every ordered triple of them is an arc");
    found.require(!moves.arcs || points <= MOST_TRIPLE_POINTS as u64 - 2, "generate.moves.arcs", "true", &bound);
    let search = &generate.search;
    found.count("generate.search.programs", search.programs, 1, 1_000);
    found.count("generate.search.visits", search.visits, 1, MOST_VISITS as u64);
    if let Some(limit) = search.time_limit_s {
        found.above("generate.search.time_limit_s", limit, 0.0, 1e6, " s");
    }
    if let Some(least) = search.min_cost {
        found.from("generate.search.min_cost", least, 0.0, 1e15, "");
    }
    check_search(search, points, found);
    for (key, row) in [("start", search.start), ("end", search.end)] {
        if let Some(row) = row {
            let bound = format!("a row of the cloud, 0 … {}", points.saturating_sub(1));
            found.require(row < points, &format!("generate.search.{key}"), row, &bound);
        }
    }
}

/// Keys of one method, and their bounds.
fn check_search(search: &ProgramSearch, points: u64, found: &mut Findings) {
    if search.method == ProgramMethod::Heaviest {
        let bound = "left out: only the method `worst` executes what it searches";
        let given = [
            ("executions", search.executions.map(|count| count.to_string())),
            ("confirm", search.confirm.map(|count| count.to_string())),
            ("seconds", search.seconds.map(|seconds| seconds.to_string())),
            ("target", search.target.as_ref().map(|target| format!("\"{}\"", target.word()))),
            ("points", search.points.map(|count| count.to_string())),
        ];
        for (key, value) in given.into_iter().filter_map(|(key, value)| Some((key, value?))) {
            found.require(false, &format!("generate.search.{key}"), value, bound);
        }
        return;
    }
    if let Some(executions) = search.executions {
        found.count("generate.search.executions", executions, 1, 1_000_000);
    }
    if let Some(confirm) = search.confirm {
        let executions = search.executions.unwrap_or(SearchSection::default().executions);
        found.count("generate.search.confirm", confirm, 0, executions.saturating_sub(1).min(1_000));
    }
    if let Some(seconds) = search.seconds {
        found.above("generate.search.seconds", seconds, 0.0, 1e6, " s");
    }
    if let Some(target) = &search.target {
        let bound = "one of deviation, acceleration, time, overshoot, lateness: a program's runs have no other measure";
        let measured = !matches!(target, Target::Clearance | Target::TipOver);
        found.require(measured, "generate.search.target", format!("\"{}\"", target.word()), bound);
    }
    if let Some(count) = search.points {
        let visits = search.visits.min(MOST_VISITS as u64);
        found.count("generate.search.points", count, 1, points.saturating_mul(visits).max(1));
    }
    if let Some(least) = search.min_cost {
        let bound = "left out: the method `worst` asks how programs are executed, not what they cost";
        found.require(false, "generate.search.min_cost", least, bound);
    }
}

/// A cost as the scenario gives it.
fn told_cost(cost: &CostSection, files: &Attachments) -> String {
    match cost {
        CostSection::Learned(cost) => {
            format!("\"{}\"", files.model(&cost.score).map_or(&cost.score, |model| &model.given))
        }
        CostSection::Named(_) | CostSection::Table(_) | CostSection::Weighted(_) => format!("\"{}\"", cost.word()),
    }
}

fn check_execute(execute: &ArmExecute, found: &mut Findings) {
    if let Some(logs) = &execute.logs {
        let name = logs.rsplit('/').next().unwrap_or_default();
        let bound = "files named by one `*` that stands for CASE-RUN or CASE, such as nightly/*.csv";
        let fine = name.matches('*').count() == 1 && logs.matches('*').count() == 1;
        found.require(fine, "execute.logs", format!("\"{logs}\""), bound);
        let both = "left out where there are logs: runs come from one of the two";
        let who = serde_json::to_string(&execute.controller).unwrap_or_default();
        found.require(execute.controller.is_none(), CONTROLLER_KEY, who, both);
        found.require(execute.faults.is_none(), "execute.faults", "given", both);
        let kept = "\"all\" where there are logs: a recording cannot be made again";
        let word = format!("\"{}\"", execute.record.word());
        found.require(execute.record.is_all(), "execute.record", word, kept);
    }
    found.who(execute.controller.as_ref(), execute.control_rate_hz, None);
    if let Some(limit) = execute.timeout_s {
        let bound = "left out where no controller of yours steers";
        found.require(Steering::users(execute.controller.as_ref()).is_some(), "execute.timeout_s", limit, bound);
        found.above("execute.timeout_s", limit, 0.0, 1e6, " s");
    }
    let bound = "left out: the virtual controller's clock is the program's";
    let shared = execute.logs.is_some() || execute.log_clock == LogClock::AsRecorded;
    found.require(shared, "execute.log_clock", "\"offset-removed\"", bound);
    found.repeat(execute.repeat);
    found.flaky(execute.flaky);
    found.baseline(execute.baseline);
    found.from("execute.servo_lag_s", execute.servo_lag_s, 0.0, 10.0, " s");
    found.from("execute.noise_mm", execute.noise_mm, 0.0, 100.0, " mm");
    let faults = &execute.faults;
    if let Some(axis) = faults.axis {
        found.count("execute.faults.axis", axis, 1, 6);
    }
    let of_axis = faults.backlash_deg != 0.0 || faults.slower != 0.0;
    found.require(
        !of_axis || faults.axis.is_some(),
        "execute.faults.axis",
        "not given",
        "the axis that is at fault, 1 … 6",
    );
    found.from("execute.faults.backlash_deg", faults.backlash_deg, 0.0, 90.0, "°");
    found.from("execute.faults.slower", faults.slower, 0.0, 0.99, "");
    for (axis, offset) in faults.tool_offset_mm.iter().enumerate() {
        found.from(&format!("execute.faults.tool_offset_mm[{axis}]"), *offset, -1e4, 1e4, " mm");
    }
    found.from("execute.faults.start_delay_s", faults.start_delay_s, 0.0, 3600.0, " s");
}

fn check_spec(spec: &ArmSpec, found: &mut Findings) {
    if let Some(path) = &spec.path {
        found.above("spec.path.max_mm", path.max_mm, 0.0, 1e6, " mm");
    }
    if let Some(arrival) = &spec.arrival {
        found.above("spec.arrival.max_late_ms", arrival.max_late_ms, 0.0, 1e9, " ms");
    }
    if let Some(regression) = &spec.regression {
        found.above("spec.regression.band_sigma", regression.band_sigma, 0.0, 100.0, "");
    }
    found.share("spec", spec.violation_share, spec.confidence);
}
