//! `max-load`: heaviest paths under a time limit, through narrow clusters, and proven.

use hairpin_jobs::Problem;

use super::super::max_load::proven;
use super::super::questions::FAMILIES;
use super::line::{Line, Measured};
use super::row::{Figure, Row, Seen};
use crate::clock::median;

pub(super) fn rows() -> Vec<Row> {
    vec![
        dense(2000),
        dense(3000),
        clusters(50, 9.0),
        clusters(100, 7.0),
        proof(100, 11, 4, 25.0),
        proof(200, 9, 5, 300.0),
    ]
}

/// A question of the table in the file `costs`.
fn question(costs: &str, flags: &str) -> Line {
    Line::new(format!("hairpin max-load --graph {costs}{flags} --threads 1 --json"))
}

fn dense(points: usize) -> Row {
    let costs = format!("dense-{points}-0.csv");
    let lines = vec![question(&costs, " --time-limit 3")];
    let about = format!("{points} points, three arcs of four, 3 s");
    Row::new(format!("max-load-{points}"), about, lines, |seen| {
        let gap = Figure::new("gap", "%", seen.told("/gap_percent").unwrap_or(f64::NAN));
        // The limit is one on the wall, and so is what is waited for.
        Ok(vec![Figure::new("time on the wall", "s", seen.lines[0].wall_s).at_most(3.5), gap])
    })
    .reading([costs.as_str()])
}

/// Nine questions.
fn clusters(points: usize, promised: f64) -> Row {
    let files: Vec<String> = (0..9).map(|index| format!("clusters-{points}-{index}.csv")).collect();
    let lines = files.iter().map(|costs| question(costs, " --time-limit 2")).collect();
    let about = format!("{points} points in four clusters of 10 mm, 2 s, nine times");
    let row = Row::new(format!("max-load-clusters-{points}"), about, lines, move |seen| {
        Ok(vec![Figure::new("proven of 9", "", proofs(seen)?).at_least(promised), a_question(seen)])
    });
    Row { inputs: files, ..row }
}

fn proof(points: usize, count: u64, family: usize, most_ms: f64) -> Row {
    let files: Vec<String> = (0..count).map(|index| format!("proof-{points}-{index}.csv")).collect();
    let lines = files.iter().map(|costs| question(costs, "")).collect();
    let about = format!("{points} points until proven, {count} times");
    let row = Row::new(format!("max-load-proof-{points}"), about, lines, move |seen| {
        let kernel = proven(count, FAMILIES[family].draw)?;
        Ok(vec![a_question(seen).beside(kernel).at_most(most_ms), Figure::new("proven", "", proofs(seen)?)])
    });
    Row { inputs: files, ..row }
}

/// How many of the answers are proven.
fn proofs(seen: &Seen<'_>) -> Result<f64, Problem> {
    let proven = |line: &Measured| line.told["proven"].as_bool().map(u32::from);
    let all: Option<u32> = seen.lines.iter().map(proven).sum();
    all.map(f64::from).ok_or_else(|| Problem::input("an answer does not say whether it is proven"))
}

/// What the commands take in the median.
fn a_question(seen: &Seen<'_>) -> Figure {
    Figure::new("a question in the median", "ms", 1e3 * median(seen.lines.iter().map(|line| line.cpu_s)))
}
