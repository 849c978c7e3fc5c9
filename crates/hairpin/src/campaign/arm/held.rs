//! What a program says, held to the scenario as it stands now: where cloud, frames, speeds, ends or what moves may be
//! were edited, the programs that are kept are another scenario's.
//!
//! A program is a function of its way through the cloud ([`ArmSetup::program`]): it is made of that once more, and
//! compared. Which moves are possible, and what they cost, is the graph's, made anew; its moves are followed by code of
//! their own ([`ArmSetup::graph_again`]).

use std::collections::HashSet;
use std::mem::discriminant;

use nalgebra::Isometry3;

use super::ArmSetup;
use super::arm_graph::ArmGraph;
use super::graph::graph_of;
use super::program::{Met, slow};
use super::ways::{Place, Standing, Ways};
use crate::campaign::Case;
use crate::campaign::scenario::ProgramMethod;
use crate::trajectory::program::{Motion, Move, Program, Speed, Zone};
use crate::verification::{Collector, Finding};

/// Within these two places and turns are the same, m and rad: a module's numbers have a millionth of a millimetre, and
/// nine decimals of a quaternion.
const PLACE: f64 = 1e-8;
const TURN: f64 = 1e-7;
/// Share within which two speeds, or sums of costs, are the same.
const SHARE: f64 = 1e-6;

/// What does not hold of `program`, which a search of the scenario is said to have found.
pub(super) fn held(setup: &ArmSetup, case: &Case, program: &Program) -> Vec<Finding> {
    let mut findings = Vec::new();
    frames(setup, program, &mut findings);
    let Some(way) = setup.way_of(program) else {
        not_of_the_cloud(setup, program, &mut findings);
        return findings;
    };
    let graph = match graph_of(setup) {
        Ok(graph) => graph,
        Err(reason) => {
            Collector::on_leg(&mut findings, 0, 0.0).refuse(format!("the scenario has no graph: {reason}"));
            return findings;
        }
    };
    if let Some(passed) = way.iter().find(|met| met.passed && graph.arcs.is_none()) {
        let name = setup.point_name(passed.row);
        let what = format!("an arc passes {name}, and generate.moves has none (kind, arcs)");
        Collector::on_leg(&mut findings, 0, 0.0).refuse(what);
        return findings;
    }
    moves_as_made(setup, &graph, (case, program), &way, &mut findings);
    let rows: Vec<usize> = way.iter().map(|met| met.row).collect();
    let ways = Ways::through(setup, graph.clone(), &rows);
    possible(&ways, &way, &mut findings);
    if setup.scenario.generate.search.method == ProgramMethod::Heaviest {
        cost(setup, &graph, case, &way, &mut findings);
    }
    findings
}

/// Tool and work object of every move.
fn frames(setup: &ArmSetup, program: &Program, findings: &mut Vec<Finding>) {
    let (tool, object) = setup.frames();
    let asked = Program::new(&program.name, &program.procedure, tool, object).in_digits();
    let (tool, object) = (&asked.tools[0], &asked.work_objects[0]);
    let mut found = Collector::about(findings, "program");
    for said in used(&program.tools, program.moves.iter().map(|one| one.tool)) {
        if said.name != tool.name {
            found.refuse(format!("tool = {}: the scenario's is {} (world.tool)", said.name, tool.name));
        }
        apart(&mut found, "tool", &said.tcp, &tool.tcp);
        if tool.declare {
            found.above("tool.mass", (said.mass - tool.mass).abs(), PLACE, "kg");
            let off = (said.centre_of_gravity - tool.centre_of_gravity).norm();
            found.above("tool.centre_of_gravity", off, PLACE, "m");
        }
    }
    for said in used(&program.work_objects, program.moves.iter().map(|one| one.work_object)) {
        if said.name != object.name {
            found.refuse(format!("work object = {}: the scenario's is {} (world.wobj)", said.name, object.name));
        }
        apart(&mut found, "work_object", &said.base_from_object(), &object.base_from_object());
    }
    if program.procedure != setup.scenario.generate.moves.procedure {
        let asked = &setup.scenario.generate.moves.procedure;
        found
            .refuse(format!("procedure = {}: the scenario's is {asked} (generate.moves.procedure)", program.procedure));
    }
}

/// Those of `all` that moves refer to, each once.
fn used<T>(all: &[T], indices: impl Iterator<Item = usize>) -> impl Iterator<Item = &T> {
    let indices: HashSet<usize> = indices.collect();
    all.iter().enumerate().filter(move |(index, _)| indices.contains(index)).map(|(_, one)| one)
}

/// Findings where two frames are not one.
fn apart(found: &mut Collector, what: &str, said: &Isometry3<f64>, asked: &Isometry3<f64>) {
    let place = (said.translation.vector - asked.translation.vector).norm();
    found.above(format_args!("{what}.place"), place, PLACE, "m");
    let between = said.rotation.inverse() * asked.rotation;
    let turn = 2.0 * libm::atan2(between.imag().norm(), between.w.abs());
    found.above(format_args!("{what}.turn"), turn, TURN, "rad");
}

/// The first target that is no point of the cloud.
fn not_of_the_cloud(setup: &ArmSetup, program: &Program, findings: &mut Vec<Finding>) {
    let between = program.moves.get(1..program.moves.len().saturating_sub(1)).unwrap_or_default();
    let mut names = between.iter().enumerate().flat_map(|(k, one)| {
        one.motion.poses().map(move |pose| (k, pose.name.as_deref().unwrap_or("a target without a name")))
    });
    let points = setup.station.points.len();
    let last = setup.point_name(points.saturating_sub(1));
    let foreign = names.find(|(_, name)| setup.row_of(name).is_none());
    let (leg, what) = match foreign {
        Some((k, name)) => (k, format!("{name} is no point of the scenario, which has {points}, the last one {last}")),
        None => (0, "the program is no way from home through the scenario's points and back".into()),
    };
    Collector::on_leg(findings, leg, 0.0).refuse(what);
}

/// Every move against that of the program which is made of the same way.
fn moves_as_made(
    setup: &ArmSetup,
    graph: &ArmGraph,
    (case, program): (&Case, &Program),
    way: &[Met],
    findings: &mut Vec<Finding>,
) {
    let asked = &setup.scenario.generate.moves;
    let rows: Vec<usize> = way.iter().map(|met| met.row).collect();
    let made = setup.program(way, case.number.0, |k, zone| graph.blends(setup, &rows, k, zone));
    let speeds: Vec<Speed> = asked.speeds.iter().filter_map(|name| Speed::predefined(name)).collect();
    let zones: Vec<Zone> = asked.zones.iter().filter_map(|name| Zone::predefined(name)).collect();
    let last = made.moves.len().saturating_sub(1);
    for (k, (said, made)) in program.moves.iter().zip(&made.moves).enumerate() {
        let mut found = Collector::on_leg(findings, k.saturating_sub(1), 0.0);
        let name = said.motion.name().unwrap_or("home");
        as_made(&mut found, name, said, made);
        let home = [slow()];
        let (speeds, keys) =
            if k == 0 || k == last { (&home[..], "home's") } else { (&speeds[..], "generate.moves.speeds") };
        if !speeds.iter().any(|one| alike(one, &said.speed)) {
            found.refuse(format!("the move to {name} at {} m/s is none of {keys}", said.speed.tcp));
        }
        if !said.zone.fine && !zones.iter().any(|one| one.same_as(&said.zone)) {
            found
                .refuse(format!("the zone of {:.1} mm at {name} is none of generate.moves.zones", 1e3 * said.zone.tcp));
        } else if said.zone.fine != made.zone.fine {
            found.refuse(format!("the corner that a zone cuts at {name} is not proven clear"));
        }
    }
}

/// Where a move leads to, and how.
fn as_made(found: &mut Collector, name: &str, said: &Move, made: &Move) {
    if discriminant(&said.motion) != discriminant(&made.motion) {
        found.refuse(format!("the move to {name} is of another kind than generate.moves.kind has"));
        return;
    }
    if let (Motion::AbsoluteJoint(said), Motion::AbsoluteJoint(made)) = (&said.motion, &made.motion) {
        let off = said.joints.iter().zip(&made.joints).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        found.above("home", off, TURN, "rad");
    }
    for (said, made) in said.motion.poses().zip(made.motion.poses()) {
        let name = said.name.as_deref().unwrap_or(name);
        apart(found, name, &said.pose, &made.pose);
    }
}

fn alike(a: &Speed, b: &Speed) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= SHARE * a.abs().max(b.abs());
    near(a.tcp, b.tcp) && near(a.orientation, b.orientation)
}

/// Ends, how often points come, and every move by the graph.
fn possible(ways: &Ways, way: &[Met], findings: &mut Vec<Finding>) {
    let (setup, graph) = (ways.setup, &ways.graph);
    let search = &setup.scenario.generate.search;
    let name = |row: usize| setup.point_name(row);
    for (key, wanted, met) in [("start", search.start, way.first()), ("end", search.end, way.last())] {
        if let (Some(wanted), Some(met)) = (wanted, met)
            && wanted as usize != met.row
        {
            let what =
                format!("generate.search.{key} = {wanted}, and the program's is {} ({})", met.row, name(met.row));
            Collector::on_leg(findings, 0, 0.0).refuse(what);
        }
    }
    let often = |met: &&Met| way.iter().filter(|other| other.row == met.row).count() as u64 > search.visits;
    if let Some(met) = way.iter().find(often) {
        let what = format!("{} comes more often than generate.search.visits = {}", name(met.row), search.visits);
        Collector::on_leg(findings, 0, 0.0).refuse(what);
    }
    let standings: Vec<Option<Standing>> = way.iter().map(|met| ways.standing(met)).collect();
    // Points that arcs pass end no move.
    let leg = |k: usize| way[..k].iter().filter(|met| !met.passed).count();
    for (k, at) in standings.iter().enumerate() {
        if at.is_none() {
            let what = format!("{} cannot be met as the program says (its configuration)", name(way[k].row));
            Collector::on_leg(findings, leg(k), 0.0).refuse(what);
        }
    }
    let names = setup.part_names();
    for k in 1..way.len() {
        let (from, to) = (way[k - 1].row, way[k].row);
        if way[k - 1].passed {
            continue;
        }
        let (what, leads) = if way[k].passed {
            let Some(after) = way.get(k + 1) else { continue };
            let triple = || Some([standings[k - 1]?, standings[k]?, standings[k + 1]?]);
            (format!("{}→{}→{}", name(from), name(to), name(after.row)), triple().map(|triple| ways.has_arc(triple)))
        } else {
            let pair = || Some((standings[k - 1]?, standings[k]?));
            let leads = pair().map(|(a, b)| ways.leads(Place::At(a), Place::At(b)));
            (format!("{}→{}", name(from), name(to)), leads)
        };
        if leads == Some(false) {
            let why = graph.reachability.refusal(from, to).filter(|_| !way[k].passed);
            let why = why.map_or(String::new(), |why| format!(": {}", why.in_words(&names)));
            let what = format!("{what} is no move of the scenario's graph{why}");
            Collector::on_leg(findings, leg(k), 0.0).refuse(what);
        }
    }
    let ends = [
        (standings.first().copied().flatten().map(|at| (Place::Home, Place::At(at))), way.first(), 0, "from home to"),
        (
            standings.last().copied().flatten().map(|at| (Place::At(at), Place::Home)),
            way.last(),
            leg(way.len()),
            "home from",
        ),
    ];
    for (pair, met, leg, how) in ends {
        if let (Some((from, to)), Some(met)) = (pair, met)
            && !ways.leads(from, to)
        {
            let what = format!("the move {how} {} is none of the scenario's graph", name(met.row));
            Collector::on_leg(findings, leg, 0.0).refuse(what);
        }
    }
}

/// What the way costs by the graph, against what the case says and what is wanted.
fn cost(setup: &ArmSetup, graph: &ArmGraph, case: &Case, way: &[Met], findings: &mut Vec<Finding>) {
    let mut found = Collector::about(findings, "program");
    if let Some(least) = setup.scenario.generate.search.min_cost
        && case.score < least - graph.unit
    {
        found.refuse(format!("costs {} {}: generate.search.min_cost = {least}", case.score, graph.unit_name));
    }
    let of_leg = |k: usize| match (way[k - 1].passed, way[k].passed) {
        (true, _) => Some(0),
        (false, true) => {
            let triple = [way[k - 1].row, way[k].row, way.get(k + 1)?.row];
            let free = &graph.arcs.as_ref()?.free;
            free.binary_search_by(|(points, _)| points.cmp(&triple)).ok().map(|place| free[place].1)
        }
        (false, false) => graph.costs[way[k - 1].row * graph.points() + way[k].row],
    };
    // A move that the graph has not is told already.
    let Some(sum) = (1..way.len()).map(of_leg).sum::<Option<i64>>() else { return };
    let told = sum as f64 * graph.unit;
    if (told - case.score).abs() > SHARE * told.abs().max(1.0) {
        let (unit, word) = (&graph.unit_name, setup.scenario.generate.cost.word());
        found.refuse(format!("its moves cost {told} {unit} (generate.cost = {word}), the case says {}", case.score));
    }
}
