//! Flat boundary-value drives of `generic`: solving alone, success by replay, length over that of closed forms.

use std::f64::consts::PI;
use std::hint::black_box;
use std::sync::OnceLock;
use std::time::Instant;

use hairpin::campaign::drive::replay_flat;
use hairpin::campaign::goals::{anywhere, flat_goal};
use hairpin::feasibility::steering::shooting::cc::{self, Gears};
use hairpin::feasibility::steering::shooting::flat;
use hairpin::feasibility::steering::shooting::query::Query;
use hairpin::feasibility::steering::shooting::solve::{Choices, solve};
use hairpin::math::random::{Stream, stream, unit};
use hairpin::trajectory::drive::Segment;
use hairpin::trajectory::start_table::StartTable;
use hairpin::verification::DriveReplay;
use hairpin_jobs::Problem;
use rayon::prelude::*;

use super::row::Row;
use crate::clock::median_time;
use crate::drives::{BOUNDS, keeps, met};

const QUERIES: usize = 10_000;
/// Of the other families.
pub(super) const FEW: usize = 1000;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::at_most("steer-feasible", "µs", 5.0, |_| Ok(microseconds(&feasible(), false))),
        Row::at_least("steer-feasible-success", "%", 100.0, |_| Ok(success(&feasible(), false))),
        Row::unbound("steer-feasible-steps", "steps", |_| Ok(steps(&feasible(), None))),
        Row::unbound("steer-feasible-table", "µs", |_| {
            Ok(micros_by(&feasible(), &Choices { flat: with_table(), ..choices(false) }))
        }),
        Row::unbound("steer-feasible-table-steps", "steps", |_| Ok(steps(&feasible(), Some(table())))),
        Row::at_most("steer-hard", "µs", 60.0, |_| Ok(microseconds(&hard(), true))),
        Row::at_least("steer-hard-success", "%", 100.0, |_| Ok(success(&hard(), true))),
        Row::at_most("steer-hard-length-median", "× CC", 1.3, |_| Ok(lengths(&hard()).0)),
        Row::at_most("steer-hard-length-worst", "× CC", 2.0, |_| Ok(lengths(&hard()).1)),
        Row::unbound("steer-cc-reeds-shepp", "µs", |_| Ok(closed_form())),
        Row::at_most("steer-bent", "µs", 60.0, |_| Ok(microseconds(&bent(), true))),
        Row::at_least("steer-bent-success", "%", 100.0, |_| Ok(success(&bent(), true))),
        Row::at_most("steer-crab", "µs", 60.0, |_| {
            Ok(microseconds(&crabs().iter().map(turned).collect::<Vec<_>>(), true))
        }),
        Row::at_least("steer-crab-success", "%", 100.0, |_| Ok(crab_success())),
        Row::unbound("steer-batch-1-thread", "1/s", |_| batch(1)),
        Row::at_least("steer-batch-2-threads", "× 1 thread", 1.8, |_| Ok(batch(2)? / batch(1)?)),
    ]
}

/// The table of start values of `generic`, made once.
fn table() -> &'static StartTable {
    static TABLE: OnceLock<StartTable> = OnceLock::new();
    TABLE.get_or_init(|| StartTable::generate(&BOUNDS).unwrap_or_else(|error| unreachable!("generic steers: {error}")))
}

fn with_table() -> flat::Settings<'static> {
    flat::Settings { table: Some(table()), ..flat::Settings::default() }
}

/// Steps of a query in the mean.
fn steps(queries: &[Query], table: Option<&StartTable>) -> f64 {
    let settings = flat::Settings { table, ..flat::Settings::default() };
    let all: u32 = queries.iter().map(|query| flat::forward(query, &BOUNDS, &settings).iterations).sum();
    f64::from(all) / queries.len() as f64
}

fn choices(reversals: bool) -> Choices<'static> {
    Choices { reversals, ..Choices::default() }
}

/// `count` queries of one stream.
fn drawn(seed: u64, count: usize, draw: impl Fn(&mut Stream) -> Query) -> Vec<Query> {
    let mut random = stream(seed);
    (0..count).map(|_| draw(&mut random)).collect()
}

/// Ends of random curvatures of fifth order within the bounds, over 1 … 12 m.
pub(super) fn feasible() -> Vec<Query> {
    drawn(1, QUERIES, |random| flat_goal(random, &BOUNDS))
}

/// Anywhere around within 6 m, with any heading, wheels straight at both ends.
pub(super) fn hard() -> Vec<Query> {
    many_hard(QUERIES)
}

/// The first `count` of these; [`hard`] begins them.
pub(super) fn many_hard(count: usize) -> Vec<Query> {
    drawn(2, count, |random| anywhere(random, &BOUNDS, 0.0))
}

/// The same with any curvature at both ends.
fn bent() -> Vec<Query> {
    drawn(3, FEW, |random| anywhere(random, &BOUNDS, 1.0))
}

/// The same for vehicles that travel up to 90° to either side of their heading.
fn crabs() -> Vec<(Query, f64)> {
    let mut random = stream(4);
    let mut direction = || PI * (unit(&mut random) - 0.5);
    bent().into_iter().map(|query| (query, direction())).collect()
}

/// Mean time of solving a query, µs.
pub(super) fn microseconds(queries: &[Query], reversals: bool) -> f64 {
    micros_by(queries, &choices(reversals))
}

fn micros_by(queries: &[Query], choices: &Choices) -> f64 {
    let all = median_time(5, || {
        queries.iter().map(|query| solve(query, &BOUNDS, choices, || false).segments.len()).sum::<usize>()
    });
    all / queries.len() as f64 * 1e6
}

/// Whether a replay meets its goal and keeps both bounds.
pub(super) fn good(found: &DriveReplay) -> bool {
    met(found.error, found.error_curvature) && keeps(found, &BOUNDS)
}

/// Share (%) whose replay is good.
fn success(queries: &[Query], reversals: bool) -> f64 {
    let met =
        |query: &&Query| good(&replay_flat(query, 0.0, &solve(query, &BOUNDS, &choices(reversals), || false).segments));
    queries.iter().filter(met).count() as f64 / queries.len() as f64 * 100.0
}

/// A crab's query in the frame of its way.
fn turned((query, direction): &(Query, f64)) -> Query {
    flat::crab(query, *direction)
}

fn crab_success() -> f64 {
    let crabs = crabs();
    let met = |case: &&(Query, f64)| {
        good(&replay_flat(&case.0, case.1, &solve(&turned(case), &BOUNDS, &choices(true), || false).segments))
    };
    crabs.iter().filter(met).count() as f64 / crabs.len() as f64 * 100.0
}

/// Hard queries per second of wall-clock time on this many threads: the best of five runs.
fn batch(threads: usize) -> Result<f64, Problem> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(Problem::input)?;
    let (queries, choices) = (hard(), choices(true));
    let run = || {
        let begun = Instant::now();
        let all = || queries.par_iter().map(|query| solve(query, &BOUNDS, &choices, || false).iterations).sum::<u32>();
        black_box(pool.install(all));
        queries.len() as f64 / begun.elapsed().as_secs_f64()
    };
    Ok((0..5).map(|_| run()).fold(0.0, f64::max))
}

/// Median and largest length over that of the closed form with cusps.
fn lengths(queries: &[Query]) -> (f64, f64) {
    let mut ratios: Vec<f64> = queries
        .iter()
        .filter_map(|query| {
            let metres = cc::steer(query, &BOUNDS, Gears::Both)?.length_m();
            let found: f64 =
                solve(query, &BOUNDS, &choices(true), || false).segments.iter().map(Segment::length_m).sum();
            Some(found / metres)
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    (ratios[ratios.len() / 2], ratios[ratios.len() - 1])
}

/// The closed form alone.
fn closed_form() -> f64 {
    let queries = hard();
    let length = |query| cc::steer(query, &BOUNDS, Gears::Both).map_or(0.0, |path| path.length_m());
    median_time(5, || queries.iter().map(length).sum::<f64>()) / queries.len() as f64 * 1e6
}
