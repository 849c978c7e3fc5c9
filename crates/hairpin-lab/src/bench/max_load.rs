//! Heaviest paths: the time until the optimum is proven, and the gap that is left when time is up.
//!
//! Each row is the median over some questions, from seeds that follow each other.

use hairpin::search::heaviest::heaviest;
use hairpin_jobs::Problem;

use super::questions::{FAMILIES, Question, published, questions};
use super::row::Row;
use crate::clock::{Stopwatch, alone, median, median_time};

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::at_most(FAMILIES[0].name, "ms", 1.0, |_| proven(11, FAMILIES[0].draw)),
        Row::at_most(FAMILIES[1].name, "ms", 1.0, |_| proven(11, FAMILIES[1].draw)),
        Row::at_most(FAMILIES[2].name, "ms", 10.0, |_| proven(11, FAMILIES[2].draw)),
        Row::at_most(FAMILIES[3].name, "ms", 50.0, |_| proven(11, FAMILIES[3].draw)),
        Row::at_most(FAMILIES[4].name, "ms", 120.0, |_| proven(11, FAMILIES[4].draw)),
        Row::at_most(FAMILIES[5].name, "ms", 2000.0, |_| proven(9, FAMILIES[5].draw)),
        Row::at_most("max-load-200-gap", "%", 0.03, |_| gap(3, 1.0, |seed| published(200, seed))),
        Row::at_most("max-load-1000-gap", "%", 0.15, |_| gap(3, 5.0, |seed| published(1000, seed))),
        Row::at_most(FAMILIES[6].name, "ms", 1000.0, |_| proven(11, FAMILIES[6].draw)),
        Row::at_most(FAMILIES[7].name, "ms", 1000.0, |_| proven(11, FAMILIES[7].draw)),
        Row::at_most(FAMILIES[8].name, "ms", 1000.0, |_| proven(11, FAMILIES[8].draw)),
        Row::at_most(FAMILIES[9].name, "ms", 1000.0, |_| proven(11, FAMILIES[9].draw)),
    ]
}

/// Median time until the optimum is proven, ms.
pub(super) fn proven(count: u64, draw: impl Fn(u64) -> Result<Question, Problem>) -> Result<f64, Problem> {
    let questions = questions(count, draw)?;
    let (mut times, mut all) = (Vec::new(), true);
    for Question { arcs, settings } in &questions {
        let search = || all &= heaviest(arcs, settings, &|| false).is_ok_and(|found| found.proven);
        times.push(1e3 * alone(|| median_time(1, search)));
    }
    if !all {
        return Err(Problem::input("an instance of the bench is not proven"));
    }
    Ok(median(times.into_iter()))
}

/// Median gap between bound and path after `limit` seconds on a processor, %; a search that ends before has none.
fn gap(count: u64, limit: f64, draw: impl Fn(u64) -> Result<Question, Problem>) -> Result<f64, Problem> {
    let mut gaps = Vec::new();
    for Question { arcs, settings } in &questions(count, draw)? {
        let watch = Stopwatch::start();
        let found = alone(|| heaviest(arcs, settings, &|| watch.passed(limit))).map_err(Problem::input)?;
        gaps.push(found.gap_percent().ok_or_else(|| Problem::input("an instance of the bench has no path"))?);
    }
    Ok(median(gaps.into_iter()))
}
