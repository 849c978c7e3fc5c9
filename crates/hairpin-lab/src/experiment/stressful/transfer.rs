//! Transfer: a score that was learned in our plant under our controller, and what its trajectories come to in another
//! simulator with a controller of its own. Either answer is one.

use hairpin::campaign::learn::ScoreModel;
use hairpin::campaign::{Case, Run};
use hairpin::judgement::{Stress, rank_correlation};
use hairpin::math::random::named_seed;
use hairpin_formats::figure::{Axis, Cell, Figure, Marks, Point, Scale, Series, Table};
use hairpin_jobs::execute::fly_each;
use hairpin_jobs::{Problem, Watch, sets};
use serde::Deserialize;

use super::cell::{self, Set, text, with};
use super::lift::{Flown, lift};
use crate::experiment::outcome::Outcome;
use crate::experiment::sheet::Sheet;
use crate::experiment::watched::go_on;

/// The shipped scenario whose robot and world are flown: its legs are witnessed, so that any controller is asked for
/// what the robot can.
const WITNESSED: &str = "demo-quadrotor";

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Size {
    /// Trajectories a way, each from a graph of its own.
    cases: u64,
    /// Executions of other graphs' trajectories that the score is learned from.
    training: u64,
    length: u64,
    /// Waypoints sampled for each graph.
    waypoints: u64,
    /// Ours.
    controller: String,
    seed: u64,
    /// The command that starts the other simulator.
    executor: String,
    /// What tables call it.
    simulator: String,
    /// What it may take for a flight, s.
    timeout_s: f64,
}

/// A simulator, and the largest deviations in it.
struct Simulator {
    name: String,
    /// By way: those of the uniform trajectories, then those of the learned score's.
    flown: [Flown; 2],
}

const WAYS: [&str; 2] = ["uniform", "learned"];

/// The lift of a learned score here and there, and how both order the same trajectories.
pub(in super::super) fn transfer(sheet: &Sheet, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let size: Size = sheet.size()?;
    if size.executor.trim().is_empty() {
        return Err(Problem::input(
            "`executor` = \"\": must be the command of a simulator that speaks the executor protocol, such as --set \
             'executor=\"python3 my_simulator.py\"' (examples/executors has one; experiments/with-rotorpy installs rotorpy and does so)",
        ));
    }
    let base = [
        ("seed", size.seed.to_string()),
        ("task.length", size.length.to_string()),
        ("generate.search.waypoints", size.waypoints.to_string()),
        ("execute.repeat", "1".into()),
        ("execute.timeout_s", format!("{:?}", size.timeout_s)),
    ];
    // A scenario has a controller of ours or a program of the user's, not both.
    let here = with(&base, &[("execute.controller", text(&size.controller))]);
    let there = with(&base, &[("execute.command", sets::executor(&size.executor).1)]);
    let model = cell::learned(WITNESSED, &here, size.training, size.seed, watch)?;
    let ways = ways(&size, &here, &model, watch)?;
    let simulators = [
        flown(format!("hairpin, {}", size.controller), &here, &ways, watch)?,
        flown(size.simulator.clone(), &there, &ways, watch)?,
    ];
    let (trajectories, scatter) = trajectories(&ways, &simulators);
    let notes = notes(&size, &model, &scatter);
    Ok(Outcome {
        tables: vec![("transfer", lifts(&size, &simulators)), ("trajectories", trajectories)],
        figures: vec![("transfer".into(), drawn(&simulators, scatter))],
        notes,
    })
}

/// The trajectories of [`WAYS`].
fn ways(size: &Size, here: &[Set], model: &ScoreModel, watch: &dyn Watch) -> Result<Vec<Vec<Case>>, Problem> {
    let cases = ("generate.search.cases", size.cases.to_string());
    let method = |name: &str| ("generate.search.method", text(name));
    let worst_leg = ("generate.search.aggregate", text("max"));
    let asked: [Vec<Set>; 2] = [vec![cases.clone(), method("uniform")], vec![cases, method("exact"), worst_leg]];
    let mut ways = Vec::new();
    for (way, sets) in WAYS.into_iter().zip(asked) {
        go_on(watch)?;
        let setup = cell::setup(WITNESSED, &with(here, &sets), (way == "learned").then_some(model))?;
        ways.push(cell::cases(&setup, watch)?);
    }
    Ok(ways)
}

/// The lift of the learned score in each simulator.
fn lifts(size: &Size, simulators: &[Simulator; 2]) -> Table {
    let mut table = Table::new(&[
        "simulator",
        "uniform_m",
        "learned_m",
        "trajectories",
        "lift_percent",
        "low_percent",
        "high_percent",
    ]);
    for (number, Simulator { name, flown: [uniform, learned] }) in simulators.iter().enumerate() {
        let lift = lift(&learned.stresses, &uniform.stresses, named_seed(size.seed, "bootstrap", number as u64));
        let own = [
            name.as_str().into(),
            uniform.mean().into(),
            learned.mean().into(),
            (uniform.stresses.len() + learned.stresses.len()).into(),
        ];
        table.push(own.into_iter().chain(lift.percent().map(Cell::from)).collect());
    }
    table
}

fn notes(size: &Size, model: &ScoreModel, scatter: &[Vec<Point>]) -> Vec<String> {
    let side = |of: fn(&Point) -> f64| scatter.iter().flatten().map(of).collect::<Vec<_>>();
    let (here, there) = (side(|point| point.x), side(|point| point.y));
    vec![
        format!(
            "Mean largest deviation from the leg being flown; {} trajectories a way, witnessed, one per sampled graph, each flown once without \
             noise; 95 % bootstrap intervals.",
            size.cases
        ),
        format!(
            "Learned from {} executions in other graphs under `{}`: R² {:.2} on trajectories held out.",
            size.training, size.controller, model.held_out.r2
        ),
        format!(
            "Rank correlation (Spearman) of {} trajectories between the simulators: {}.",
            here.len(),
            rank_correlation(&here, &there).map_or("none".into(), |rank| format!("{rank:.2}"))
        ),
    ]
}

/// Each trajectory by what it comes to in the one and in the other.
fn drawn(simulators: &[Simulator; 2], scatter: Vec<Vec<Point>>) -> Figure {
    let axis = |simulator: &Simulator| Axis { label: format!("{}, m", simulator.name), scale: Scale::Linear };
    let series = |(way, points): (&str, _)| Series { name: way.into(), marks: Marks::Scatter(points) };
    Figure {
        title: "Largest deviation of the same trajectories in two simulators".into(),
        x: axis(&simulators[0]),
        y: axis(&simulators[1]),
        series: WAYS.into_iter().zip(scatter).map(series).collect(),
    }
}

/// What `ways` come to by the executor that `sets` name, or in hairpin's own plant where they name none.
fn flown(name: String, sets: &[Set], ways: &[Vec<Case>], watch: &dyn Watch) -> Result<Simulator, Problem> {
    let setup = cell::setup(WITNESSED, sets, None)?;
    let mut flown = [Flown::default(), Flown::default()];
    for (flown, cases) in flown.iter_mut().zip(ways) {
        go_on(watch)?;
        let runs = fly_each(&setup, cases, 0, watch)?;
        let failed = |run: &Run| Some((run.case, run.outcome.as_ref().err()?.to_string()));
        if let Some((case, why)) = runs.iter().find_map(failed) {
            return Err(Problem::Executor(format!("{name}, case {case}: {why}")));
        }
        let runs: Vec<Vec<Run>> = runs.into_iter().map(|run| vec![run]).collect();
        let [own] = Flown::by_runs(&setup, cases, runs, [Stress::MaxDeviation]);
        *flown = own;
    }
    Ok(Simulator { name, flown })
}

/// A row for every trajectory that both measured, and by way its place in the one and in the other.
fn trajectories(ways: &[Vec<Case>], simulators: &[Simulator; 2]) -> (Table, Vec<Vec<Point>>) {
    let mut table = Table::new(&["way", "case", "hairpin_m", "other_m"]);
    let mut scatter = Vec::new();
    for (number, (way, cases)) in WAYS.into_iter().zip(ways).enumerate() {
        let mut points = Vec::new();
        for (place, case) in cases.iter().enumerate() {
            let of = |simulator: &Simulator| {
                let flown = &simulator.flown[number];
                flown.places.iter().position(|other| *other == place).map(|index| flown.stresses[index])
            };
            let [Some(here), Some(there)] = [&simulators[0], &simulators[1]].map(of) else { continue };
            table.push(vec![way.into(), case.id().into(), here.into(), there.into()]);
            points.push(Point::new(here, there));
        }
        scatter.push(points);
    }
    (table, scatter)
}
