//! Programs that are drawn, changed and crossed: each is followed again by the equations of the proof, and executes.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Isometry3, Vector3};
use serde_json::{Value, json};

use super::ArmSetup;
use super::program::Met;
use super::solver::ArmSolver;
use super::ways::Ways;
use crate::campaign::generate::{Known, generate};
use crate::campaign::graph::{Executions, Plan, Wanted};
use crate::campaign::kind::Solver;
use crate::campaign::scenario::{KeyPath, SearchMethod, Target};
use crate::campaign::trial::{Sought, Trials};
use crate::campaign::{
    self, Case, CaseResult, Evidence, Executor, Mission, OwnSimulator, Run, Scenario, Setup, Status, Stop, Tally,
    execute_run, judge, verify,
};
use crate::judgement::{LegSource, Stress};
use crate::math::random::stream;
use crate::robot::arm::Joints;
use crate::search::in_loop::Rank;
use crate::trajectory::program::Program;
use crate::trajectory::{Channel, Ended, Flight, Tolerances, Track, bends};

/// A shipped arm before a fixture, and some points.
fn cell() -> Value {
    let path = format!("{}/../../data/robots/arm/irb120.toml", env!("CARGO_MANIFEST_DIR"));
    let robot: Value = toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    json!({
        "hairpin": 1, "robot": robot, "seed": 7,
        "world": {
            "tool": { "name": "tGrip", "declare": true, "tcp_mm": [0, 0, 120], "mass_kg": 0.8, "cog_mm": [0, 0, 50], "radius_mm": 40 },
            "obstacles": [
                { "name": "floor", "half_space": { "normal": [0, 0, 1], "offset_mm": -5 } },
                { "name": "fixture", "box": { "center_mm": [380, 250, 75], "size_mm": [100, 100, 150] } },
            ],
            "keep_out_mm": ["x^2 + y^2 < 190^2 and z < 300"],
        },
        "task": { "points": { "count": 9 } },
        "generate": {
            "moves": { "speeds": ["v200", "v1000", "vmax"], "zones": ["fine", "z10", "z50"], "clearance_mm": 10 },
            "search": { "method": "worst", "programs": 3, "executions": 40, "points": 6 },
        },
        "execute": { "controller": "virtual" },
        "spec": { "path": { "max_mm": 15.0 } },
    })
}

/// With other keys, or what is wrong with them.
fn changed(changes: &[(&str, Value)]) -> Result<Setup, Vec<String>> {
    let mut value = cell();
    for (key, new) in changes {
        KeyPath::parse(key).unwrap().put(&mut value, new.clone()).unwrap();
    }
    let scenario: Scenario = serde_json::from_value(value).unwrap();
    Setup::build(scenario.into()).map_err(|mistakes| mistakes.iter().map(ToString::to_string).collect())
}

fn setup(changes: &[(&str, Value)]) -> Setup {
    changed(changes).unwrap()
}

fn own(setup: &Setup) -> &ArmSetup {
    setup.own().unwrap()
}

fn program(plan: &Plan) -> &Program {
    plan.witness.as_ref().and_then(|witness| witness.program()).unwrap()
}

fn way(setup: &Setup, plan: &Plan) -> Vec<Met> {
    own(setup).way_of(program(plan)).unwrap()
}

fn rows(way: &[Met]) -> Vec<usize> {
    way.iter().map(|met| met.row).collect()
}

/// Follows it by the equations of the proof.
fn hold(setup: &Setup, plan: &Plan, told: &str) {
    let proof = verify(setup, &plan.clone().case(setup.scenario.seed(), 0, 0)).proof.expect("a witness");
    assert!(proof.ok(), "{told}: {:?}", proof.findings);
    assert_eq!(plan.leg_times.len() + 1, plan.waypoints.len(), "{told}");
}

/// The tool level: the wrist can be turned about.
fn sideways() -> Vec<(&'static str, Value)> {
    let level = std::f64::consts::FRAC_1_SQRT_2;
    vec![("task.points_in", json!({ "q1_q4_default": [level, level, 0, 0] }))]
}

/// What scenarios differ in that are drawn and changed below.
fn kinds() -> Vec<(&'static str, Vec<(&'static str, Value)>)> {
    vec![
        ("straight", vec![]),
        ("in joints", [sideways(), vec![("generate.moves.kind", json!("joint"))]].concat()),
        ("wrists", [sideways(), vec![("task.points.count", json!(12)), ("generate.search.points", json!(2))]].concat()),
        ("arcs", vec![("generate.moves.arcs", json!(true))]),
        ("twice", vec![("generate.search.visits", json!(2)), ("generate.search.points", json!(12))]),
        ("sphere", vec![("generate.mode", json!("cartesian"))]),
        ("ends", vec![("generate.search.start", json!(2)), ("generate.search.end", json!(5))]),
    ]
}

/// What is planned is what is written: a program has the digits of its module, and is planned once more as it was.
#[test]
fn programs_have_the_digits_that_they_are_written_with() {
    let turned = json!({ "name": "wRot", "declare": true, "uframe_mm": [30, 20, 10],
        "uframe_q1_q4": [0.9961946980917455, 0, 0, 0.08715574274765817] });
    let setup = setup(&[("world.wobj", turned)]);
    let solver = ArmSolver::new(own(&setup));
    for number in 0..4 {
        let plan = solver.draw(number, &Stop::never()).unwrap();
        let program = program(&plan);
        assert_eq!(program.clone().in_digits(), *program);
        assert!(plan.leg_times == own(&setup).leg_times(&program.clone().in_digits()));
    }
}

/// The rows that are kept of a planned motion lead to where the joints of the same plan do, and with its velocity.
#[test]
fn planned_rows_agree_with_planned_joints() {
    for (name, changes) in [kinds().swap_remove(0), kinds().swap_remove(1), kinds().swap_remove(3)] {
        let setup = setup(&changes);
        let (arm, solver) = (own(&setup), ArmSolver::new(own(&setup)));
        let case = solver.draw(1, &Stop::never()).unwrap().case(7, 0, 0);
        let planned = campaign::planned(&setup, &case).unwrap();
        let rows = planned.picked(&bends(&planned, &BTreeSet::new(), &Tolerances::default()));
        let (times, joints) = arm.planned_joints(&case, 0.01).unwrap();
        let place = |q: &Joints| (arm.station.arm.forward(q) * arm.station.tool.tcp).translation.vector;
        let last = rows.times()[rows.len() - 1];
        for k in 1..times.len() - 1 {
            if times[k + 1] > last {
                break;
            }
            let (pose, values) = rows.at(times[k]).unwrap();
            let off = (pose.translation.vector - place(&joints[k])).norm();
            assert!(off < 1.2e-4, "{name}: {off} m at {} s", times[k]);
            // Second order in time: 10 m/s² that begin within 10 ms.
            let mean = (place(&joints[k + 1]) - place(&joints[k - 1])) / 0.02;
            let off = (Vector3::new(values[1], values[2], values[3]) - mean).norm();
            assert!(off < 0.06, "{name}: {off} m/s at {} s", times[k]);
        }
    }
}

/// What bounds the reach in Cartesian mode is no part of the cell, and is told for what it is.
#[test]
fn a_sphere_out_of_reach_is_told_so() {
    let points = json!([[300, 0, 400], [3000, 0, 400], [350, 50, 400], [300, 50, 400], [350, 0, 400], [300, -50, 400]]);
    let setup = setup(&[("generate.mode", json!("cartesian")), ("task.points", points)]);
    let graph = super::graph::whole_graph(own(&setup), &Stop::never()).unwrap();
    let told = |from: usize, to: usize| {
        graph.reachability.refusal(from, to).map(|refusal| refusal.in_words(&own(&setup).part_names()).to_string())
    };
    let far = told(0, 1).unwrap();
    assert!(far.starts_with("out of reach: ") && !far.contains('?'), "{far}");
    assert_eq!((told(1, 0), told(0, 2)), (Some(far), None));
}

#[test]
fn programs_are_drawn_by_numbers_and_are_possible() {
    for (name, changes) in kinds() {
        let setup = setup(&changes);
        let solver = ArmSolver::new(own(&setup));
        let points = own(&setup).scenario.generate.search.points.unwrap() as usize;
        let drawn: Vec<Plan> = (0..6).map(|number| solver.draw(number, &Stop::never()).unwrap()).collect();
        let mut told = BTreeSet::new();
        for (number, plan) in drawn.iter().enumerate() {
            hold(&setup, plan, &format!("{name}, draw {number}"));
            let way = way(&setup, plan);
            assert_eq!(way.len(), points, "{name}");
            for row in rows(&way) {
                let often = way.iter().filter(|met| met.row == row).count() as u64;
                assert!(often <= own(&setup).scenario.generate.search.visits, "{name}: {row} comes {often} times");
            }
            told.insert(format!("{way:?}"));
            let evidence = if name == "sphere" { Evidence::ClearToolSphere } else { Evidence::ClearAllLinks };
            assert_eq!((plan.evidence, plan.bound), (evidence, None));
            if name == "ends" {
                assert_eq!((way[0].row, way[points - 1].row), (2, 5));
            }
        }
        assert_eq!(told.len(), drawn.len(), "{name}: draws differ");
        assert!(
            program(&solver.draw(3, &Stop::never()).unwrap()) == program(&drawn[3]),
            "{name}: a number is a program"
        );
        let branch = |plan: &Plan| way(&setup, plan)[0].configuration.map(|configuration| configuration.cfx);
        let branches: BTreeSet<_> = drawn.iter().map(branch).collect();
        assert!(branches.len() > 1 || !matches!(name, "in joints" | "wrists"), "{name}: drawn in {branches:?} alone");
        let arcs = drawn.iter().flat_map(|plan| way(&setup, plan)).filter(|met| met.passed).count();
        assert_eq!(arcs > 0, name == "arcs", "{name}: {arcs} points are passed");
    }
}

#[test]
fn where_every_move_is_possible_all_orders_come_alike() {
    let free =
        [("world", json!({})), ("task.points", json!([[300, 0, 300], [350, 50, 250], [320, -60, 280], [380, 0, 320]]))];
    let setup = setup(&[&free[..], &[("generate.search.points", json!(3))]].concat());
    let arm = own(&setup);
    let graph = super::graph_of(arm).unwrap();
    assert_eq!(graph.costs.iter().filter(|cost| cost.is_some()).count(), 12);
    let ways = Ways::new(arm, graph);
    let own = ways.standings(0).next().map(|at| ways.configuration(at)).unwrap();
    let (mut random, mut counts, mut moves) = (stream(5), BTreeMap::<Vec<usize>, u32>::new(), [0, 0]);
    for _ in 0..6000 {
        let way = ways.drawn(3, &mut random).unwrap();
        let branch = way[0].configuration.map(|configuration| configuration.cfx);
        assert!(way.iter().all(|met| met.configuration.map(|of| of.cfx) == branch), "straight moves change no branch");
        if branch == own.map(|configuration| configuration.cfx) {
            *counts.entry(rows(&way)).or_default() += 1;
        }
        let fast = way.iter().filter(|met| met.speed.name.as_deref() == Some("v1000")).count();
        moves = [moves[0] + way.len(), moves[1] + fast];
    }
    // 4 · 3 · 2 orders: χ² of 23 degrees of freedom is below 49.7 in 999 of 1000 cases.
    assert_eq!(counts.len(), 24);
    let drawn: u32 = counts.values().sum();
    let expected = f64::from(drawn) / 24.0;
    let chi: f64 = counts.values().map(|count| (f64::from(*count) - expected).powi(2) / expected).sum();
    assert!(drawn > 1000 && chi < 49.7, "{drawn} draws, χ² {chi}");
    // A third of the moves has each speed: four standard errors.
    let share = moves[1] as f64 / moves[0] as f64;
    assert!((share - 1.0 / 3.0).abs() < 4.0 * (2.0 / 9.0 / moves[0] as f64).sqrt(), "{share}");
}

#[test]
fn changed_programs_are_possible_and_everything_that_may_change_does() {
    for (name, changes) in kinds() {
        let setup = setup(&changes);
        let solver = ArmSolver::new(own(&setup));
        let (mut random, mut found) = (stream(11), 0);
        let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
        let all: &[&str] = match name {
            "in joints" => &["order", "points", "speed", "configuration"],
            "wrists" => &["order", "points", "speed"],
            "arcs" => &["order", "points", "speed", "zone", "arc"],
            _ => &["order", "points", "speed", "zone"],
        };
        let mut plan = solver.draw(0, &Stop::never()).unwrap();
        for turn in 0..70 {
            if found >= 20 && all.iter().all(|what| seen.get(what).is_some_and(|times| *times > 0)) {
                break;
            }
            let leg = turn % (plan.waypoints.len() - 1);
            let Some(child) = solver.altered(&plan, leg, &mut random) else { continue };
            found += 1;
            hold(&setup, &child, &format!("{name}, child {turn}"));
            let [old, new] = [&plan, &child].map(|plan| way(&setup, plan));
            assert_eq!(old.len(), new.len(), "{name}");
            let sorted = |way: &[Met]| {
                let mut rows = rows(way);
                rows.sort_unstable();
                rows
            };
            let differs = |key: &dyn Fn(&Met) -> String| {
                let told = |way: &[Met]| way.iter().map(key).collect::<Vec<_>>();
                told(&old) != told(&new)
            };
            let mut count = |what, it: bool| *seen.entry(what).or_default() += usize::from(it);
            let same_points = sorted(&old) == sorted(&new);
            count("order", same_points && rows(&old) != rows(&new));
            count("points", !same_points);
            let same_order = rows(&old) == rows(&new);
            count("speed", same_order && differs(&|met| format!("{:?}", met.speed)));
            count("zone", same_order && differs(&|met| format!("{:?}", met.zone)));
            count("configuration", same_order && differs(&|met| format!("{:?}", met.configuration)));
            count("arc", same_order && differs(&|met| met.passed.to_string()));
            plan = child;
        }
        println!("{name}: {found}, {seen:?}");
        assert!(found >= 20, "{name}: {found}");
        for what in all {
            assert!(seen[what] > 0, "{name}: {what}");
        }
    }
}

#[test]
fn a_child_of_two_begins_as_one_and_goes_on_in_the_order_of_the_other() {
    for (name, changes) in kinds() {
        let setup = setup(&changes);
        let solver = ArmSolver::new(own(&setup));
        let plans: Vec<Plan> = (0..5).map(|number| solver.draw(number, &Stop::never()).unwrap()).collect();
        let (mut random, mut found) = (stream(2), 0);
        for a in &plans {
            for b in &plans {
                let Some(child) = solver.crossed(0, a, b, 2, &mut random) else { continue };
                found += 1;
                hold(&setup, &child, name);
                let [of_a, of_b, of_child] = [a, b, &child].map(|plan| rows(&way(&setup, plan)));
                let cut = of_a.iter().zip(&of_child).take_while(|(a, child)| a == child).count();
                assert!(cut > 0 && of_child.len() == of_a.len(), "{name}");
                // What comes after the beginning comes in the order of the other.
                let mut rest = of_b.iter();
                let in_order = of_child[cut..].iter().all(|row| rest.any(|other| other == row));
                assert!(in_order, "{name}: {of_a:?} and {of_b:?} gave {of_child:?}");
            }
        }
        println!("{name}: {found} of 25 children");
        assert!(found > 0, "{name}");
    }
}

#[test]
fn the_heaviest_program_is_a_seed_and_says_how_many_points_there_are() {
    let setup = setup(&[("generate.search.points", Value::Null)]);
    let solver = ArmSolver::new(own(&setup));
    let seeds = solver.seeds(&Stop::never());
    assert_eq!(seeds.len(), 1);
    hold(&setup, &seeds[0], "the heaviest");
    let nothing = Executions { execute: &|_, _| None, duration: &|_| None, furnish: &|_| None, partial: None };
    let heaviest = solver.solve(0, nothing, Wanted::Cases, &Stop::never());
    let most = heaviest.plans[0].1.score;
    assert!(seeds[0].score > 0.9 * most && seeds[0].score <= most, "{} of {most}", seeds[0].score);
    assert_eq!(way(&setup, &solver.draw(0, &Stop::never()).unwrap()).len(), way(&setup, &seeds[0]).len());
}

#[test]
fn programs_execute_for_the_stresses_of_arms() {
    let slow = json!({ "axis": 1, "slower": 0.4 });
    let setup = setup(&[("execute.faults", slow)]);
    let solver = ArmSolver::new(own(&setup));
    let plan = solver.draw(0, &Stop::never()).unwrap();
    let stresses = [Stress::MaxDeviation, Stress::Time, Stress::Lateness, Stress::JointEffort];
    let trials = Trials { setup: &setup, executor: &OwnSimulator, graph: 0, seed: None };
    let run = || trials.execute_for((&plan, 0), &stresses.map(Sought::Measured), &[f64::INFINITY; 4]).unwrap().trials;
    let trials = run();
    for ((trial, stress), least) in trials.iter().zip(stresses).zip([1e-4, 1.0, 1e-3, 1.0]) {
        let word = stress.word();
        assert!(trial.stress > least && trial.worst_leg + 1 < plan.waypoints.len(), "{word}: {}", trial.stress);
    }
    let again = run();
    assert!(trials.iter().zip(&again).all(|(a, b)| a.stress == b.stress), "an execution repeats");
}

/// Stands where it begins: at nothing it arrives, so that nothing is late.
struct Standing;

impl Executor for Standing {
    fn fly(&self, nominal: &Setup, case: &Case, mission: &Mission) -> Result<Flight, String> {
        let flight = OwnSimulator.fly(nominal, case, mission)?;
        let track = &flight.track;
        let still = |one: &Channel| match one.name.as_str() {
            "leg" => one.clone(),
            _ => Channel { name: one.name.clone(), values: vec![one.values[0]; track.len()] },
        };
        let (poses, channels) = (vec![track.poses()[0]; track.len()], track.channels().iter().map(still).collect());
        let track = Track::new(track.times().to_vec(), poses, channels).map_err(|error| error.to_string())?;
        Ok(Flight { track, ..flight })
    }
}

#[test]
fn what_fails_without_the_stress_that_is_sought_is_worse_than_all_that_has_it() {
    let limit = ("spec", json!({ "arrival": { "max_late_ms": 100_000.0 } }));
    let sought = ("generate.search.target", json!("lateness"));
    let setup = setup(&[limit, sought, ("generate.search.executions", json!(4))]);
    let plan = ArmSolver::new(own(&setup)).draw(0, &Stop::never()).unwrap();
    let trials = Trials { setup: &setup, executor: &Standing, graph: 0, seed: None };
    let lateness = [Sought::Measured(Stress::Lateness)];
    let trial = trials.execute_for((&plan, 0), &lateness, &[f64::INFINITY]).unwrap().trials[0];
    assert!(trial.fails && trial.stress == f64::NEG_INFINITY, "{trial:?}");
    assert!(trial.reaches(Rank::of(false, Some(1e9))), "{trial:?}");
    let (known, mut cases) = (Known::default(), Vec::new());
    let tally =
        generate(&setup, &known, &Standing, &Stop::never(), &mut |new: &[Case], _| cases.extend_from_slice(new));
    assert_eq!((cases.len(), &tally.nothing), (3, &None));
    assert!(cases.iter().all(|case| case.score.is_finite()), "{:?}", tally.curves);
}

/// The schedule goes on whatever the arm does, and home is where a program ends as well as where it begins.
#[test]
fn an_arm_that_does_not_go_its_programs_way_violates() {
    let slow = json!({ "axis": 1, "slower": 0.3 });
    let late = ("spec", json!({ "arrival": { "max_late_ms": 100_000.0 } }));
    let setup = setup(&[("execute.faults", slow), late]);
    let case = ArmSolver::new(own(&setup)).draw(0, &Stop::never()).unwrap().case(7, 0, 0);
    let run = execute_run(&setup, &case, 0);
    let flight = run.outcome.clone().unwrap();
    let result = judge(&setup, &case, std::slice::from_ref(&run)).unwrap();
    assert!(result.status == Status::Pass && flight.ended == Ended::Done, "{result:?}");
    let Flight { track, .. } = &flight;
    let poses = vec![track.poses()[0]; track.len()];
    let still = Track::new(track.times().to_vec(), poses, track.channels().to_vec()).unwrap();
    let standing = Run { outcome: Ok(Flight { track: still, ..flight }), ..run };
    let result = judge(&setup, &case, &[standing]).unwrap();
    assert!(result.status == Status::Fail && result.violations[0].is_unfinished(), "{result:?}");
}

/// What is judged of a run of the first drawn program with `changes`, and of the same motion as a log of its joints, as
/// `change` makes them of axis, time and angle; from `rests` m before its end on it goes on no more.
fn run_and_log(changes: &[(&str, Value)], rests: f64, change: impl Fn(usize, f64, f64) -> f64) -> [CaseResult; 2] {
    let setup = setup(changes);
    let arm = own(&setup);
    let case = ArmSolver::new(arm).draw(0, &Stop::never()).unwrap().case(7, 0, 0);
    let run = execute_run(&setup, &case, 0);
    let flight = run.outcome.clone().unwrap();
    let (times, poses, end) =
        (flight.track.times(), flight.track.poses(), flight.track.position(flight.track.len() - 1));
    let far = (0..times.len()).rposition(|i| (flight.track.position(i) - end).norm() > rests);
    let stays = |i: usize| if rests > 0.0 { i.min(far.unwrap()) } else { i };
    let channel = |axis: usize| {
        let name = format!("q{axis}_rad");
        let angles = flight.track.channel(&name).unwrap();
        let values = (0..times.len()).map(|i| change(axis, times[i], angles[stays(i)])).collect();
        Channel { name, values }
    };
    let channels: Vec<Channel> = (1..=6).map(channel).collect();
    let told = [flight.track.channels().iter().find(|one| one.name == "leg").unwrap().clone()];
    let track = |more: &[Channel]| {
        let poses = (0..times.len()).map(|i| poses[stays(i)]).collect();
        Track::new(times.to_vec(), poses, [&channels[..], more].concat()).unwrap()
    };
    let logged = changed(&[changes, &[("execute", json!({ "logs": "*" }))]].concat()).unwrap();
    let (recorded, _) = own(&logged).recorded(&case, track(&[]), true).unwrap();
    let of =
        |setup: &Setup, flight: Flight| judge(setup, &case, &[Run { outcome: Ok(flight), ..run.clone() }]).unwrap();
    [of(&setup, Flight { track: track(&told), ..flight.clone() }), of(&logged, recorded)]
}

/// An arrival that is none has no lateness, and is within no limit of it.
#[test]
fn an_arm_that_rests_before_its_end_or_is_turned_wrong_at_targets_is_no_pass() {
    let spec = |limits: Value| ("spec", limits);
    let arrival = json!({ "max_late_ms": 1000.0 });
    let both = spec(json!({ "path": { "max_mm": 15.0 }, "arrival": arrival }));
    let alone = spec(json!({ "arrival": arrival }));
    let play = ("execute.faults", json!({ "axis": 6, "backlash_deg": 20.0 }));
    let same = |_: usize, _: f64, q: f64| q;
    for result in run_and_log(std::slice::from_ref(&both), 0.0, same) {
        assert_eq!(result.status, Status::Pass, "{result:?}");
    }
    for result in [&both, &alone].into_iter().flat_map(|spec| run_and_log(std::slice::from_ref(spec), 0.005, same)) {
        let why = result.message.unwrap_or_default();
        assert!(result.status == Status::Inconclusive && why.contains("→pHome) was never arrived at: "), "{why}");
    }
    let path = spec(json!({ "path": { "max_mm": 15.0 } }));
    for result in [&path, &alone].into_iter().flat_map(|spec| run_and_log(&[spec.clone(), play.clone()], 0.0, same)) {
        let why = result.message.unwrap_or_default();
        assert!(result.status == Status::Inconclusive && why.contains("° at the nearest, "), "{why}");
    }
}

/// A tool may be where it should be with joints where none can be.
#[test]
fn joints_beyond_what_they_can_do_are_no_pass() {
    let limits = ("spec", json!({ "path": { "max_mm": 15.0 }, "arrival": { "max_late_ms": 1000.0 } }));
    let shifted = |which: usize, by: f64| {
        let turn = move |axis: usize, t: f64, q: f64| if axis == which && t > 2.0 { q + by } else { q };
        run_and_log(std::slice::from_ref(&limits), 0.0, turn)
    };
    for (axis, range) in [(1, "-165.0° to 165.0°"), (6, "-400.0° to 400.0°")] {
        for result in shifted(axis, 10.0) {
            let why = result.message.unwrap_or_default();
            assert!(result.status == Status::Inconclusive, "{why}");
            assert!(why.contains(&format!("axis {axis} stands at ")) && why.contains("° at t = "), "{why}");
            assert!(why.contains(&format!("its range is {range} (0.5° beyond are allowed")), "{why}");
        }
    }
    assert!(shifted(1, 0.0).iter().all(|result| result.status == Status::Pass));
    let setup = setup(&[]);
    let (arm, times) = (own(&setup), vec![0.0, 0.1]);
    let stands = |degrees: f64| {
        let channel = Channel { name: "q1_rad".into(), values: vec![0.0, f64::to_radians(degrees)] };
        let track = Track::new(times.clone(), vec![Isometry3::identity(); 2], vec![channel]).unwrap();
        arm.beyond_bounds(&track).map(|beyond| beyond.refused("joint_1"))
    };
    assert_eq!([165.4, -165.4, 165.6, -520.0].map(stands), [None, None, Some(None), Some(None)]);
    let refused = stands(526.0).unwrap().unwrap();
    assert!(refused.starts_with("joint_1 is at 9.18 rad, 526°, and its range is -165° to 165°"), "{refused}");
}

/// A path that is flown along in half the time is none that the arm moved along, whatever the path says.
#[test]
fn joints_faster_than_they_can_are_no_pass() {
    let limits = ("spec", json!({ "path": { "max_mm": 15.0 } }));
    let jump = |axis: usize, t: f64, q: f64| if axis == 6 && (1.996..2.004).contains(&t) { q + 0.1 } else { q };
    for result in run_and_log(std::slice::from_ref(&limits), 0.0, jump) {
        let why = result.message.unwrap_or_default();
        assert!(result.status == Status::Inconclusive && why.contains("axis 6 turns by "), "{why}");
        assert!(why.contains("°/s (10 % and 0.5° more are allowed): no joint of this arm is that fast"), "{why}");
    }
    let setup = setup(&[]);
    let arm = own(&setup);
    let limit = arm.station.arm.limits[1].speed;
    // Samples every `step` s for a second, all turned at a share of the largest speed, with 0.2° of noise.
    let turned = |share: f64, step: f64, skipped: usize| {
        let times: Vec<f64> = (0..=(1.0 / step) as usize).map(|i| i as f64 * step).collect();
        let noise = |i: usize| if i.is_multiple_of(2) { 0.2_f64.to_radians() } else { 0.0 };
        let at = |(i, t): (usize, &f64)| share * limit * (t + f64::from(i > 5) * skipped as f64 * step) + noise(i);
        let channel = Channel { name: "q2_rad".into(), values: times.iter().enumerate().map(at).collect() };
        let poses = vec![Isometry3::identity(); times.len()];
        arm.too_fast(&Track::new(times, poses, vec![channel]).unwrap())
    };
    for step in [0.002, 0.01, 0.25] {
        assert_eq!(turned(1.0, step, 0), None, "{step}");
        let fast = turned(1.2, step, 0).expect("too fast");
        assert!(fast.axis == 2 && fast.over >= 0.1 && (fast.speed / limit - 1.2).abs() < 0.05, "{step}: {fast:?}");
    }
    // Of one of whose samples some are left out between two.
    let jump = turned(1.0, 0.02, 3).expect("a jump");
    assert!((jump.at - 0.1).abs() < 1e-9 && (jump.over - 0.02).abs() < 1e-9, "{jump:?}");
}

/// Moves in joints bulge away from the straight lines between their ends.
#[test]
fn legs_of_a_log_are_those_along_the_planned_path() {
    let joint = [
        ("generate.moves.kind", json!("joint")),
        ("generate.moves.zones", json!(["fine"])),
        ("world", json!({ "tool": { "tcp_mm": [0, 0, 300], "radius_mm": 20 } })),
    ];
    let [run, log] = run_and_log(&joint, 0.0, |_, _, q| q);
    let [run, log] = [run, log].map(|result| result.measures.unwrap());
    assert_eq!((run.leg_source, log.leg_source), (LegSource::Executor, LegSource::Assigned));
    let far: Vec<[f64; 2]> = run.legs.iter().zip(&log.legs).map(|(a, b)| [a, b].map(|leg| leg.max_deviation)).collect();
    // Where one leg ends a sample may count for the next.
    let times = run.legs.iter().zip(&log.legs).map(|(a, b)| (a.time - b.time).abs());
    assert!(times.fold(0.0, f64::max) < 0.1, "{:?} {:?}", run.legs, log.legs);
    assert!(run.leg_worst == log.leg_worst && (run.t_worst - log.t_worst).abs() < 0.02, "{far:?}");
}

const OWN_LAGS: &str = "the arm has lags of its own (robot.joints.lag_s)";

#[test]
fn what_no_run_reads_is_told() {
    let told = |changes: &[(&str, Value)]| -> Vec<String> {
        let found = setup(changes).passed_over();
        found.into_iter().map(|one| format!("{} = {}: {}", one.key, one.value, one.why)).collect()
    };
    let lag = ("execute.servo_lag_s", json!(0.05));
    let own = ("robot.joints.lag_s", json!([0.01, 0.01, 0.01, 0.01, 0.01, 0.01]));
    assert_eq!(told(std::slice::from_ref(&lag)), Vec::<String>::new());
    assert_eq!(told(std::slice::from_ref(&own)), Vec::<String>::new());
    assert_eq!(told(&[own, lag]), [format!("execute.servo_lag_s = 0.05: {OWN_LAGS}")]);
}

/// Nothing is proven anew of what is drawn for runs: drawn there, it would be told of runs that never saw it.
#[test]
fn what_runs_do_not_read_is_not_drawn() {
    let drawn = |key: &str| changed(&[("vary", json!({ (key): { "uniform": [0.0, 0.5] } }))]).map(|_| ());
    for key in [
        "world.tool.radius_mm",
        "world.tool.mass_kg",
        "world",
        "task.home_deg[0]",
        "generate.moves.clearance_mm",
        "robot.capsules[0].radius_mm",
    ] {
        let [one] = &drawn(key).unwrap_err()[..] else { panic!("{key}") };
        assert!(one.starts_with("vary.") && one.contains(key), "{one}");
        assert!(one.contains("a key that runs of an arm read"), "{one}");
    }
    assert_eq!(drawn("execute.noise_mm"), Ok(()));
    assert_eq!(drawn("execute.servo_lag_s"), Ok(()));
    // Beside lags of the arm's own, given or drawn, nobody reads the one of the scenario.
    let own = ("robot.joints.lag_s", json!([0.01, 0.01, 0.01, 0.01, 0.01, 0.01]));
    let drawn = json!({ "execute.servo_lag_s": { "uniform": [0.0, 0.1] } });
    let both = json!({
        "execute.servo_lag_s": { "uniform": [0.0, 0.1] },
        "robot.joints.lag_s": { "uniform": [own.1, own.1] },
    });
    for changes in [&[("vary", drawn), own.clone()][..], &[("vary", both), own.clone()][..]] {
        let told = changed(changes).map(|_| ()).unwrap_err();
        let refused = |one: &String| one.starts_with("vary.\"execute.servo_lag_s\"") && one.contains(OWN_LAGS);
        assert!(told.len() == 1 && refused(&told[0]), "{told:?}");
    }
}

/// What only a program's text has, and an axis at which nothing is wrong, no run reads.
#[test]
fn what_no_run_reads_is_drawn_of_no_arm() {
    let of = |vary: Value| changed(&[("vary", vary)]).map(|setup| setup.passed_over().len());
    let axis = json!({ "choice": [1, 6] });
    let play = json!({ "uniform": [0.0, 2.0] });
    for (vary, words) in [
        (json!({ "robot.joints.j23_coupled": { "choice": [true, false] } }), "it is how controllers tell programs"),
        (json!({ "execute.faults.axis": axis }), "neither execute.faults.backlash_deg nor execute.faults.slower"),
    ] {
        let told = of(vary).unwrap_err();
        assert!(told.len() == 1 && told[0].contains(words), "{told:?}");
    }
    assert_eq!(of(json!({ "execute.faults.axis": axis, "execute.faults.backlash_deg": play })), Ok(0));
    let told = of(json!({ "execute.faults.backlash_deg": play })).unwrap_err();
    assert!(told[0].contains("execute.faults.axis = not given"), "{told:?}");
    let alone = setup(&[("execute.faults", json!({ "axis": 2 }))]).passed_over();
    assert!(alone.len() == 1 && alone[0].key == "execute.faults.axis" && alone[0].value == "2", "{alone:?}");
    assert!(setup(&[("execute.faults", json!({ "axis": 2, "slower": 0.5 }))]).passed_over().is_empty());
}

/// A limit that is drawn lets runs be as far off as its largest draw.
#[test]
fn moves_are_proven_clear_for_the_widest_limit_that_is_drawn() {
    let within = |key: &str, drawn: Value| setup(&[("vary", json!({ (key): drawn }))]).scenario.clear_within_mm();
    assert_eq!(setup(&[]).scenario.clear_within_mm(), Some(15.0));
    for (key, drawn, most) in [
        ("spec.path.max_mm", json!({ "uniform": [10.0, 30.0] }), 30.0),
        ("spec.path.max_mm", json!({ "uniform": [5.0, 8.0] }), 15.0),
        ("spec.path.max_mm", json!({ "normal": [20.0, 1.0] }), 26.0),
        ("spec.path.max_mm", json!({ "choice": [15.0, 40.0] }), 40.0),
        ("spec.path", json!({ "choice": [{ "max_mm": 45.0 }] }), 45.0),
    ] {
        assert_eq!(within(key, drawn.clone()), Some(most), "{key}: {drawn}");
    }
    let drawn = setup(&[("vary", json!({ "spec.path.max_mm": { "uniform": [10.0, 30.0] } }))]);
    let arm: &ArmSetup = drawn.own().unwrap();
    assert!((super::graph::allowed(&arm.scenario) - 0.03).abs() < 1e-15);
}

#[test]
fn keys_of_the_search_for_the_worst_have_bounds() {
    let asked = setup(&[("generate.search.target", json!("lateness"))]).scenario.search();
    assert_eq!((asked.method, asked.executions, &asked.target), (SearchMethod::Worst, 40, &Some(Target::Lateness)));
    assert_eq!((asked.cases, asked.confirm, asked.pooled_executions()), (3, 0, 120));
    for (key, value, words) in [
        ("generate.search.executions", json!(0), "generate.search.executions = 0: must be 1 … 1 000 000"),
        ("generate.search.confirm", json!(40), "generate.search.confirm = 40: must be 0 … 39"),
        (
            "generate.search.target",
            json!("tip-over"),
            "generate.search.target = \"tip-over\": must be one of deviation",
        ),
        ("generate.search.seconds", json!(0.0), "generate.search.seconds = 0: must be > 0"),
        ("generate.search.points", json!(10), "generate.search.points = 10: must be 1 … 9"),
        ("generate.search.min_cost", json!(1.0), "generate.search.min_cost = 1: must be left out"),
        ("generate.search.method", json!("heaviest"), "generate.search.executions = 40: must be left out"),
    ] {
        let found = changed(&[(key, value)]).err().unwrap_or_default();
        assert!(found.iter().any(|mistake| mistake.contains(words)), "{key}: {found:?} should say {words:?}");
    }
}

#[test]
fn meshes_in_metres_and_scales_of_nothing_are_refused() {
    let mesh = |edge: f64, scale: Option<f64>| {
        json!({ "mesh": { "vertices_mm": [[300, 0, 0], [300.0 + edge, 0, 0], [300, edge, 0], [300, 0, edge]],
            "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], "scale_mm": scale } })
    };
    assert!(changed(&[("world.obstacles[1]", mesh(40.0, None))]).is_ok());
    for (obstacle, words) in [
        (mesh(0.4, None), "world.obstacles[1].mesh = 0.40 mm long: must be from 5 to 50000 mm long"),
        (mesh(0.4, None), "m? `scale_mm = 1000` beside its file"),
        (mesh(1e6, None), "mm? `scale_mm = 1` beside its file"),
        (mesh(40.0, Some(1000.0)), "mesh.scale_mm = 1000: must be left out where vertices are given"),
    ] {
        let found = changed(&[("world.obstacles[1]", obstacle)]).err().unwrap_or_default();
        assert!(found.iter().any(|mistake| mistake.contains(words)), "{found:?} should say {words:?}");
    }
}

/// What was proven clear within 15 mm is not said to hold within the 500 that the limit lets runs stray by now.
#[test]
fn what_clear_holds_of_is_said_once() {
    let said = |max_mm: Option<f64>| {
        let spec = max_mm.map_or_else(|| json!({}), |max_mm| json!({ "path": { "max_mm": max_mm } }));
        let setup = setup(&[("spec", spec)]);
        let tally = Tally { clear_within_mm: Some(15.0), ..Tally::default() };
        let said = campaign::assumptions(&setup, &[], &tally);
        said.into_iter().filter(|said| said.contains("`clear")).collect::<Vec<_>>().join(" ")
    };
    let as_proven = "It holds as far as runs stay within the 15 mm of `spec.path.max_mm` of their path.";
    assert!(said(Some(15.0)).ends_with(as_proven), "{}", said(Some(15.0)));
    let short =
        "It holds of runs within 15 mm of their path, which is less than `spec.path.max_mm` by now, and of no others.";
    assert!(said(Some(500.0)).ends_with(short), "{}", said(Some(500.0)));
    assert!(said(None).contains("It holds of runs on their path alone, "), "{}", said(None));
}

/// Each as one edit of the scenario beside programs that were found before it: what they are, they are no more.
#[test]
fn programs_are_held_to_the_scenario_as_it_stands_now() {
    let level = std::f64::consts::FRAC_1_SQRT_2;
    let points = json!([[300, 100, 400], [350, -100, 300], [400, 50, 350], [250, 200, 450], [300, -200, 400]]);
    let heaviest = json!({ "programs": 1 });
    let cases = |more: &[(&'static str, Value)]| {
        let given = [
            ("task.points", points.clone()),
            ("generate.search", heaviest.clone()),
            ("generate.moves.speeds", json!(["v500", "v1000"])),
        ];
        [&given[..], more].concat()
    };
    for arcs in [false, true] {
        let base = cases(&[("generate.moves.arcs", json!(arcs))]);
        let made = setup(&base);
        let nothing = Executions { execute: &|_, _| None, duration: &|_| None, furnish: &|_| None, partial: None };
        let plan = ArmSolver::new(own(&made)).solve(0, nothing, Wanted::Cases, &Stop::never()).plans.remove(0).1;
        let case = plan.clone().case(made.scenario.seed(), 0, 0);
        let told = |edit: &[(&'static str, Value)]| {
            let now = setup(&[&base[..], edit].concat());
            let proof = verify(&now, &case).proof.expect("a program");
            proof.findings.iter().map(|finding| finding.field.clone()).collect::<Vec<_>>().join("; ")
        };
        assert_eq!(told(&[]), "", "arcs = {arcs}");
        let higher = json!([[300, 100, 410], [350, -100, 310], [400, 50, 360], [250, 200, 460], [300, -200, 410]]);
        let another = (way(&made, &plan)[0].row + 1) % 5;
        for (key, value, words) in [
            ("task.points", higher, "p0"),
            ("task.points", json!([[300, 100, 400], [350, -100, 300]]), "no point of the scenario"),
            ("task.points_in", json!({ "q1_q4_default": [level, level, 0, 0] }), ".turn"),
            ("world.wobj", json!({ "name": "wT", "declare": true, "uframe_mm": [10, 0, 0] }), "work_object.place"),
            ("world.tool.tcp_mm", json!([0, 0, 130]), "tool.place"),
            ("generate.moves.speeds", json!(["v300"]), "is none of generate.moves.speeds"),
            ("generate.search", json!({ "start": another }), "generate.search.start"),
            ("generate.search", json!({ "min_cost": 99_999.0 }), "generate.search.min_cost"),
            ("generate.cost", json!("time"), "generate.cost = time"),
        ] {
            let said = told(&[(key, value.clone())]);
            assert!(said.contains(words), "{key} = {value}, arcs = {arcs}: {said}");
        }
        let edit = if arcs { ("generate.moves.arcs", json!(false)) } else { ("generate.moves.kind", json!("joint")) };
        let has_arc = way(&made, &plan).iter().any(|met| met.passed);
        assert_eq!(told(&[edit]).contains("generate.moves"), has_arc || !arcs, "arcs = {arcs}");
    }
}
