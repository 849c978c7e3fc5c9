//! `rover-worst`: the worst of many queries, each written so that it can be asked again.

use std::time::Instant;

use hairpin::campaign::goals::{anywhere, flat_goal};
use hairpin::feasibility::steering::shooting::Query;
use hairpin::feasibility::steering::shooting::rough::Status;
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, solve};
use hairpin::math::random::{Stream, stream};
use hairpin::trajectory::drive::Planar;
use hairpin_jobs::{Problem, Watch};
use serde_json::{Value, json};

use super::ground::Yard;
use crate::clock::warn_of_debug_build;
use crate::drives::{BOUNDS, CRATERS};
use crate::findings::{Findings, Words};

/// The bench's name.
pub const WORST: &str = "rover-worst";

/// Flat queries for one on the ground.
const ON_THE_GROUND: u64 = 100;
/// A query's time is the least of this many looks: what the machine does besides is not the solver's.
const LOOKS: usize = 3;
/// Shares whose bound is told, %.
const SHARES: [f64; 4] = [50.0, 99.0, 99.9, 99.99];

/// What one query cost.
#[derive(Clone, Copy)]
struct Cost {
    solved: bool,
    /// µs.
    time: f64,
    /// Steps of all descents in the plane, predictions on the ground.
    iterations: f64,
    /// Segments of the answer in the plane, settled poses of the last prediction on the ground.
    steps: f64,
}

/// A number of a query's cost, and its name.
type Column = (&'static str, fn(&Cost) -> f64);

/// The queries of a family: what each cost, and how to ask it again.
struct Family {
    name: &'static str,
    /// Name of what `iterations` and `steps` count.
    counted: [&'static str; 2],
    costs: Vec<Cost>,
    command: Box<dyn Fn(usize) -> String>,
}

/// Asks `queries` flat queries of each family, and a hundredth of it on the ground.
///
/// # Errors
/// Ground without goals.
pub fn measure_worst(queries: u64, watch: &dyn Watch) -> Result<Findings, Problem> {
    warn_of_debug_build(watch);
    let families = [
        flat("feasible", queries, 1, false, |random| flat_goal(random, &BOUNDS)),
        flat("hard, reversals", queries, 2, true, |random| anywhere(random, &BOUNDS, 0.0)),
        on_the_ground(queries.div_ceil(ON_THE_GROUND))?,
    ];
    let mut table = vec![header()];
    let (mut objects, mut commands) = (Vec::new(), Vec::new());
    for family in &families {
        let [iterations, steps] = family.counted;
        let columns: [Column; 3] =
            [("µs", |cost| cost.time), (iterations, |cost| cost.iterations), (steps, |cost| cost.steps)];
        for (what, value) in columns {
            let (percentiles, (index, most)) = spread(&family.costs, value);
            let solved = family.costs.iter().filter(|cost| cost.solved).count();
            let mut row = vec![family.name.into(), format!("{solved}/{}", family.costs.len()), what.into()];
            row.extend(percentiles.iter().chain([&most]).map(|value| format!("{value:.1}")));
            row.push(index.to_string());
            table.push(row);
            commands.push(format!("{}, most {what}: {}", family.name, (family.command)(index)));
            objects.push(object(family, what, &percentiles, most, index));
        }
    }
    let words = [Words::Table(table)].into_iter().chain(Words::lines(commands)).collect();
    Ok(Findings::new(words, json!({ "percentiles": SHARES, "worst": objects, "exit_code": 0 })))
}

fn header() -> Vec<String> {
    let shares = SHARES.map(|share| format!("{share} %"));
    let words = ["family", "solved", "what"].map(str::to_owned).into_iter();
    words.chain(shares).chain(["worst", "query"].map(str::to_owned)).collect()
}

fn object(family: &Family, what: &str, percentiles: &[f64], most: f64, index: usize) -> Value {
    json!({
        "family": family.name,
        "queries": family.costs.len(),
        "solved": family.costs.iter().filter(|cost| cost.solved).count(),
        "what": what,
        "percentiles": percentiles,
        "worst": most,
        "query": index,
        "command": (family.command)(index),
    })
}

/// Percentiles of a cost, and the index and value of its worst.
fn spread(costs: &[Cost], value: fn(&Cost) -> f64) -> (Vec<f64>, (usize, f64)) {
    let mut order: Vec<usize> = (0..costs.len()).collect();
    order.sort_by(|a, b| value(&costs[*a]).total_cmp(&value(&costs[*b])));
    let at = |share: f64| order[((share / 100.0 * order.len() as f64).ceil() as usize).clamp(1, order.len()) - 1];
    let last = at(100.0);
    (SHARES.iter().map(|share| value(&costs[at(*share)])).collect(), (last, value(&costs[last])))
}

fn timed<T>(mut look: impl FnMut() -> T) -> (f64, T) {
    let mut once = || {
        let begun = Instant::now();
        let answer = look();
        (begun.elapsed().as_secs_f64() * 1e6, answer)
    };
    let (mut least, mut answer) = once();
    for _ in 1..LOOKS {
        let (time, again) = once();
        (least, answer) = (least.min(time), again);
    }
    (least, answer)
}

fn flat(name: &'static str, count: u64, seed: u64, reversals: bool, draw: fn(&mut Stream) -> Query) -> Family {
    let mut random = stream(seed);
    let choices = Choices { reversals, ..Choices::default() };
    let costs = (0..count).map(|_| {
        let query = draw(&mut random);
        let (time, solution) = timed(|| solve(&query, &BOUNDS, &choices, || false));
        Cost {
            solved: solution.outcome == Outcome::Solved,
            time,
            iterations: solution.iterations.into(),
            steps: solution.segments.len() as f64,
        }
    });
    let command = move |index: usize| {
        let mut random = stream(seed);
        let query = (0..=index).map(|_| draw(&mut random)).last();
        query.map_or(String::new(), |Query { start_curvature, goal }| {
            format!(
                "hairpin steer generic --from 0,0,0,{start_curvature:?} --to {:?},{:?},{:?},{:?}{}",
                goal.x,
                goal.y,
                goal.yaw,
                goal.curvature,
                if reversals { " --reversals" } else { "" }
            )
        })
    };
    Family { name, counted: ["iterations", "segments"], costs: costs.collect(), command: Box::new(command) }
}

fn on_the_ground(count: u64) -> Result<Family, Problem> {
    let yard = Yard::new(usize::try_from(count).unwrap_or(usize::MAX))?;
    if yard.goals.is_empty() {
        return Err(Problem::input("the bench's ground has no goal"));
    }
    let costs = yard.goals.iter().map(|goal| {
        let (time, answer) = timed(|| yard.solve(goal));
        let poses = answer.prediction.map_or(0, |prediction| prediction.steps);
        Cost { solved: answer.status == Status::Ok, time, iterations: answer.iterations.into(), steps: poses.into() }
    });
    let costs = costs.collect();
    let goals = yard.goals;
    let command = move |index: usize| {
        let pose = |at: &Planar| format!("{:?},{:?},{:?},{:?}", at.x, at.y, at.yaw, at.curvature);
        let (start, goal) = &goals[index];
        format!("rocky8 --from {} --to {} on the generator's ground {CRATERS:?}", pose(start), pose(goal))
    };
    Ok(Family { name: "rough ground", counted: ["predictions", "poses"], costs, command: Box::new(command) })
}
