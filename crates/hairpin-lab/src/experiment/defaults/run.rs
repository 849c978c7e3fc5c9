//! One independent run of a cell: every way, and as many random trajectories.

use hairpin::campaign::generate::Space;
use hairpin::campaign::{Case, Known, OwnSimulator, Setup, execute_run, generate};
use hairpin::math::random::named_seed;
use hairpin_formats::scenario::setup_for;
use hairpin_jobs::{Problem, Watch};
use rayon::prelude::*;
use serde_json::json;

use super::cmaes::candidates;
use super::evolve::{Free, evolve};
use super::field::{Field, setup};
use super::record::{Cost, Kept, RunRecord, WayRecord};
use super::size::{Cell, Size};
use super::ways::Way;
use crate::clock::process_time;
use crate::experiment::watched::{go_on, watched};

/// Graphs that the first generation of a case is drawn from.
const GRAPHS_OF_A_CASE: u64 = 1 << 20;
/// Trajectories that the time of executions is told by; more executions repeat them.
const TIMED: usize = 200;

/// What a way found, before it is executed afresh.
#[derive(Default)]
pub(super) struct Found {
    pub(super) cases: Vec<Case>,
    pub(super) executions: u64,
    pub(super) rises: Vec<(u64, f64)>,
    refused: Option<String>,
    /// Processor time, s.
    spent: f64,
}

/// A run under `seed`; with how its random trajectories were drawn.
pub(super) fn run(
    cell: &Cell,
    size: &Size,
    seed: u64,
    watch: &dyn Watch,
) -> Result<(RunRecord, &'static str), Problem> {
    let drawn_from = if cell.same_graphs { seed } else { named_seed(seed, "uniform", 0) };
    let base = setup(cell, drawn_from, &keys(cell, size, Way::WorstInGraph)?)?;
    let space = Space::of(&base).map_err(Problem::input)?;
    let field = Field { setup: &base, stress: cell.stress, fresh: size.fresh };

    let mut ways = Vec::new();
    let mut costed = None;
    for &way in &size.ways {
        let found = match found(cell, size, seed, way, watch) {
            Ok(found) => found,
            Err(stopped @ Problem::Interrupted(_)) => return Err(stopped),
            Err(problem) => Found { refused: Some(problem.to_string()), ..Found::default() },
        };
        let Found { cases, executions, rises, refused, spent } = found;
        let kept = field.all_kept(&cases, watch)?;
        if way == Way::Worst && !cases.is_empty() {
            costed = Some((cases, executions, spent));
        }
        ways.push(WayRecord { way, executions, kept, rises, refused });
    }

    let most = ways.iter().map(|way| way.executions.div_ceil(size.cases.max(1) as u64)).max().unwrap_or(0);
    let best_of = most.max(size.executions) as usize;
    let drawn = field.drawn(&space, 0, best_of * size.cases, watch)?;
    let again = |place: usize, number: usize| space.draw(drawn.graphs[place], number).map_err(Problem::input);
    let chunks = (0..size.cases).filter_map(|case| Some((drawn.most(case * best_of, best_of)?, case)));
    let best: Vec<Case> = chunks.map(|(place, case)| again(place, case)).collect::<Result<_, _>>()?;
    let singles = size.singles.min(drawn.graphs.len());
    let single: Vec<Case> = (0..singles).map(|place| again(place, place)).collect::<Result<_, _>>()?;
    let cost = match costed {
        Some((cases, executions, search)) => {
            let timed = drawn.graphs.len().min(TIMED);
            let random: Vec<Case> = (0..timed).map(|place| again(place, place)).collect::<Result<_, _>>()?;
            go_on(watch)?;
            let [uniform, kept] = [&random, &cases].map(|cases| time_of(&base, cases, executions));
            Some(Cost { search, uniform, kept })
        }
        None => None,
    };
    let (best, single) = (field.all_kept(&best, watch)?, field.all_kept(&single, watch)?);
    Ok((RunRecord { uniform: drawn.stresses, best_of, single, best, ways, cost }, space.drawn_how()))
}

/// What `way` finds under `seed`.
fn found(cell: &Cell, size: &Size, seed: u64, way: Way, watch: &dyn Watch) -> Result<Found, Problem> {
    go_on(watch)?;
    match way {
        Way::Cmaes => evolved(cell, size, seed, watch),
        _ => searched(cell, size, seed, way, watch),
    }
}

/// What a method of hairpin's finds.
pub(super) fn searched(cell: &Cell, size: &Size, seed: u64, way: Way, watch: &dyn Watch) -> Result<Found, Problem> {
    let setup = setup(cell, seed, &keys(cell, size, way)?)?;
    let mut cases = Vec::new();
    let begun = process_time();
    let tally = watched(watch, |stop| {
        generate(&setup, &Known::default(), &OwnSimulator, stop, &mut |new, _| cases.extend_from_slice(new))
    })?;
    let spent = process_time() - begun;
    let executions = tally.curves.iter().map(|curve| curve.executions).sum();
    let one_pool = tally.curves.len() == 1 && way != Way::InLoop && way != Way::InLoopMoves;
    let rises = if one_pool { tally.curves[0].rises.clone() } else { Vec::new() };
    let nothing = || tally.nothing.clone().unwrap_or_else(|| "nothing was found".into());
    let refused = cases.is_empty().then(nothing);
    Ok(Found { cases, executions, rises, refused, spent })
}

/// The keys of `way`; random trajectories need those that tell graphs.
fn keys(cell: &Cell, size: &Size, way: Way) -> Result<Vec<(&'static str, String)>, Problem> {
    let cases_key = setup_for(&cell.scenario, &cell.sets)?.scenario.head().cases_key;
    let (method, moves) = way.method().unwrap_or(("worst", true));
    let mut keys = vec![
        ("generate.search.method", format!("\"{method}\"")),
        (cases_key, size.cases.to_string()),
        ("generate.search.executions", size.executions.to_string()),
    ];
    if cell.coordinates > 0 {
        keys.push(("generate.search.move_waypoints", moves.to_string()));
    }
    // Words in JSON are words in TOML.
    match method {
        "worst" => keys.push(("generate.search.target", json!(cell.target).to_string())),
        _ => keys.push(("generate.search.stress", json!(cell.stress).to_string())),
    }
    Ok(keys)
}

/// What the evolution strategy finds, a start for each case.
fn evolved(cell: &Cell, size: &Size, seed: u64, watch: &dyn Watch) -> Result<Found, Problem> {
    let setup = setup(cell, named_seed(seed, "cmaes", 0), &keys(cell, size, Way::Cmaes)?)?;
    let space = Space::of(&setup).map_err(Problem::input)?;
    let field = Field { setup: &setup, stress: cell.stress, fresh: 0 };
    let drawn = |case: usize, count: usize| -> Result<Vec<Case>, String> {
        let first = case as u64 * GRAPHS_OF_A_CASE;
        let (mut starts, mut why) = (Vec::new(), String::new());
        for graph in first..first + 50 * count as u64 {
            match space.draw(graph, case) {
                Ok(start) => starts.push(start),
                Err(reason) => why = reason,
            }
            if starts.len() == count {
                break;
            }
        }
        if starts.is_empty() { Err(why) } else { Ok(starts) }
    };
    let two = drawn(0, 2).map_err(Problem::input)?;
    let ends: Vec<_> = two.iter().map(|case| case.waypoints[case.waypoints.len() - 1]).collect();
    let free = Free { coordinates: cell.coordinates, end: ends.windows(2).any(|pair| pair[0] != pair[1]) };
    let waypoints = two[0].waypoints.len() - if free.end { 1 } else { 2 };
    let first = candidates(waypoints * free.coordinates).min(size.executions as usize);
    let stopped = || watch.stopped();
    let evolved: Vec<(Option<Case>, u64)> = (0..size.cases)
        .into_par_iter()
        .map(|case| {
            let Ok(starts) = drawn(case, first) else { return (None, 0) };
            let own = named_seed(seed, "strategy", case as u64);
            evolve(&space, starts, free, (size.executions, own), &|case| field.nominal(case), &stopped)
        })
        .collect();
    go_on(watch)?;
    let executions = evolved.iter().map(|(_, made)| made).sum();
    let cases: Vec<Case> = evolved.into_iter().filter_map(|(case, _)| case).collect();
    let refused = cases.is_empty().then(|| "nothing was found".into());
    Ok(Found { cases, executions, refused, ..Found::default() })
}

/// Processor time of `executions` nominal executions of `cases`, in turn, s.
fn time_of(setup: &Setup, cases: &[Case], executions: u64) -> f64 {
    let begun = process_time();
    (0..executions as usize).into_par_iter().for_each(|place| {
        std::hint::black_box(execute_run(setup, &cases[place % cases.len()], 0));
    });
    process_time() - begun
}

/// The one that came to most nominally.
pub(super) fn worst_of(kept: &[Kept]) -> Option<&Kept> {
    let measured = kept.iter().filter_map(|kept| Some((kept.found?, kept)));
    measured.reduce(|most, one| if one.0 > most.0 { one } else { most }).map(|(_, kept)| kept)
}
