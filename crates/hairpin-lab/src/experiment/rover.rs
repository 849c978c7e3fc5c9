//! The requirement table of rovers' trajectory generator and the 19 tests of its results document, measured.
//!
//! Source: T. M. Howard, "Rough terrain trajectory generator" (requirements 2006, test results August 2007).

use hairpin_formats::figure::{Axis, Figure, Marks, Point, Scale, Series, Table};
use hairpin_jobs::Problem;
use serde::Deserialize;

use super::outcome::Outcome;
use super::sheet::Sheet;
use crate::requirements::{Check, MEAN_MS, Measured, RequirementsSettings, Times};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Size {
    /// Queries of each large family.
    queries: u32,
}

#[derive(Debug, Deserialize)]
struct Printed {
    /// What the results document says of each of its tests: it gives no values.
    every_test: String,
}

/// Least number of queries that a share of 99 % can be told of.
const LEAST_QUERIES: u32 = 20;
/// Points of a curve of times.
const MARKS: usize = 200;

/// Both tables, and how long queries take.
pub(super) fn requirements(sheet: &Sheet) -> Result<Outcome, Problem> {
    let (size, printed): (Size, Printed) = (sheet.size()?, sheet.printed()?);
    if size.queries < LEAST_QUERIES {
        return Err(Problem::input(format!("`queries` = {}: must be ≥ {LEAST_QUERIES}", size.queries)));
    }
    let settings = RequirementsSettings { queries: size.queries as usize, terrain: None };
    let measured = Measured::now(&settings)?;
    let judged = |check: &Check| {
        let word = if check.passed { "met" } else { "not met" };
        [check.measured.as_str().into(), check.bound.as_str().into(), word.into()]
    };
    let mut requirements = Table::new(&["id", "requirement", "tests", "measured", "must_be", "result"]);
    for ((id, text, tests), check) in &measured.requirements {
        let own = [(*id).into(), (*text).into(), tests.join(" ").into()];
        requirements.push(own.into_iter().chain(judged(check)).collect());
    }
    let mut tests = Table::new(&["id", "requirement", "test", "measured", "must_be", "result", "source"]);
    for test in &measured.tests {
        let own = [test.id.into(), test.requirement.into(), test.what.as_str().into()];
        let paper = [printed.every_test.as_str().into()];
        tests.push(own.into_iter().chain(judged(&test.check)).chain(paper).collect());
    }
    let figures = vec![("times".into(), times(&measured.times))];
    let notes = measured.notes.iter().cloned().chain([measured.counted()]).collect();
    Ok(Outcome { tables: vec![("requirements", requirements), ("tests", tests)], figures, notes })
}

/// The share of queries that are answered in a time, and the mean that the source allows.
fn times(families: &[Times]) -> Figure {
    let share = |family: &Times| {
        let mut seconds = family.seconds.clone();
        seconds.sort_by(f64::total_cmp);
        let marks = MARKS.min(seconds.len());
        let at = |mark: usize| {
            let rank = mark * seconds.len() / marks;
            Point::new(1e3 * seconds[rank - 1], 100.0 * rank as f64 / seconds.len() as f64)
        };
        (1..=marks).map(at).collect()
    };
    let mut series: Vec<Series> =
        families.iter().map(|family| Series { name: family.of.into(), marks: Marks::Curve(share(family)) }).collect();
    let allowed = vec![Point::new(MEAN_MS, 0.0), Point::new(MEAN_MS, 100.0)];
    series.push(Series { name: "R-5: the mean that is allowed".into(), marks: Marks::Curve(allowed) });
    Figure {
        title: "Time of a boundary-value query".into(),
        x: Axis { label: "time on the wall's clock, ms".into(), scale: Scale::Logarithmic },
        y: Axis { label: "answered by then, % of the queries".into(), scale: Scale::Range(0.0, 100.0) },
        series,
    }
}
