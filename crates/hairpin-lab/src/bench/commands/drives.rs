//! `steer` of files: flat, on rough ground, on a wide map, many.

use super::super::ground::Yard;
use super::super::steer::{feasible, hard, microseconds};
use super::inputs::{ROUGH, rough};
use super::line::{Line, Measured};
use super::row::{Figure, Row, Seen};
use crate::clock::alone;
use hairpin_jobs::Problem;

pub(super) fn rows() -> Vec<Row> {
    vec![one(), curves(), anywhere(), on_rough_ground(), on_a_wide_map(), many()]
}

/// Hardly more than what starting takes, which is in every other row.
fn one() -> Row {
    let line = Line::new("hairpin steer generic --to 4,1,0.5 --json");
    Row::new("start", "one drive: what starting takes", vec![line], |seen| {
        let time = Figure::new("time", "ms", 1e3 * seen.lines[0].cpu_s);
        Ok(vec![time.beside(1e-3 * seen.told("/time_us")?)])
    })
}

/// A batch on the map in `map`.
fn on_ground(queries: &str, map: &str) -> Line {
    Line::new(format!(
        "hairpin steer rocky8 --terrain {map} --terrain-cell-m 0.1 --terrain-origin-m 0.05,0.05 --queries {queries} \
         --out answers.csv --threads 1 --json"
    ))
    .making("answers.csv")
}

/// A flat batch.
fn flat(queries: &str, flags: &str) -> Line {
    let typed = format!("hairpin steer generic --queries {queries}{flags} --out answers.csv --threads 1 --json");
    Line::new(typed).making("answers.csv")
}

fn curves() -> Row {
    let line = flat("curves.csv", "");
    Row::new("steer-curves", "10 000 ends of random curves", vec![line], |seen| {
        let kernel = alone(|| microseconds(&feasible(), false));
        Ok(vec![a_query(seen)?.beside(kernel).at_most(15.0), by_its_own_clock(seen)?])
    })
    .reading(["curves.csv"])
}

fn anywhere() -> Row {
    let line = flat("anywhere.csv", " --reversals");
    Row::new("steer-anywhere", "10 000 goals anywhere around, with reversals", vec![line], as_fast_as_solving)
        .reading(["anywhere.csv"])
}

fn many() -> Row {
    let line = flat("anywhere-100000.csv", " --reversals").looked_at();
    Row::new("steer-100000", "100 000 goals anywhere around", vec![line], |seen| {
        let mut figures = as_fast_as_solving(seen)?;
        figures.push(Figure::new("memory", "MB", seen.lines[0].peak_mb.unwrap_or(f64::NAN)).at_most(100.0));
        Ok(figures)
    })
    .reading(["anywhere-100000.csv"])
    .long()
}

/// 1.4 times what solving takes by the command's own clock, and 5 µs.
fn as_fast_as_solving(seen: &Seen<'_>) -> Result<Vec<Figure>, Problem> {
    let (kernel, own) = (alone(|| microseconds(&hard(), true)), by_its_own_clock(seen)?);
    Ok(vec![a_query(seen)?.beside(kernel).at_most(1.4 * own.value + 5.0), own])
}

fn on_rough_ground() -> Row {
    let line = on_ground(ROUGH, "ground.npy");
    Row::new("steer-rough", "2 000 goals of rocky8 on rough ground", vec![line], |seen| {
        Ok(vec![a_query(seen)?.beside(solving(seen)?).at_most(1200.0), by_its_own_clock(seen)?])
    })
    .reading([ROUGH, "ground.npy"])
}

fn on_a_wide_map() -> Row {
    let lines = vec![on_ground("wide.csv", "wide.npy"), on_ground(ROUGH, "ground.npy")];
    Row::new("steer-wide", "the same goals all over a map of 4000²", lines, |seen| {
        let [wide, small] = [0, 1].map(|line| seen.lines[line].cpu_s);
        let beside_small = Figure::new("time over that on a small map", "×", wide / small).at_most(1.0);
        Ok(vec![a_query(seen)?.beside(solving(seen)?), beside_small])
    })
    .reading(["wide.csv", "wide.npy", ROUGH, "ground.npy"])
}

/// Mean time of solving a query on the small map, µs.
fn solving(seen: &Seen<'_>) -> Result<f64, Problem> {
    let path = seen.scratch.path().join(ROUGH);
    let bytes = std::fs::read(&path).map_err(|error| Problem::of_file(&path, error))?;
    let goals = rough(&bytes)?.iter().map(|query| query.on_the_map()).collect();
    Ok(Yard::with(goals)?.mean())
}

/// What the command takes for a query.
fn a_query(seen: &Seen<'_>) -> Result<Figure, Problem> {
    let Measured { cpu_s, .. } = seen.lines[0];
    Ok(Figure::new("a query", "µs", 1e6 * cpu_s / seen.told("/queries")?))
}

/// What the command says that solving took.
fn by_its_own_clock(seen: &Seen<'_>) -> Result<Figure, Problem> {
    Ok(Figure::new("of it solving, by its own clock", "µs", seen.told("/mean_time_us")?))
}
