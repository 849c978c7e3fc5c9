//! Campaigns: generated, run, kept in few files, chosen from.

use std::hint::black_box;
use std::path::Path;

use hairpin::campaign::{Known, OwnSimulator, Stop, execute_run, generate};
use hairpin_formats::scenario::setup_for;
use hairpin_jobs::Problem;

use super::super::search::long_trajectories;
use super::line::{Line, Measured};
use super::row::{Figure, Row, Seen};
use crate::clock::{Stopwatch, alone};

/// Long trajectories through hulls.
pub(super) const BEAM: &str = "beam.toml";
/// Short flights through hulls, one run each.
pub(super) const CAMPAIGN: &str = "campaign.toml";
/// What `hairpin new quadrotor` wrote once.
pub(super) const QUADROTOR: &str = "quadrotor.toml";

/// Cases of the smallest campaign, beside which larger ones grow.
const FEW: u32 = 1000;

pub(super) fn rows() -> Vec<Row> {
    let mut rows = vec![beam(), walks("uniform"), walks("exact"), stress()];
    rows.extend([campaign(20_000, "flown-20000"), campaign(100_000, "flown-100000").long()]);
    rows.extend([(FEW, "flown-1000"), (8000, "flown-8000"), (20_000, "flown-20000")].map(|(n, at)| select(n, at)));
    rows
}

fn beam() -> Row {
    let line = Line::new("hairpin generate beam.toml --out beam --threads 1 --json").making("beam");
    Row::new("generate-beam", "2 000 trajectories of length 50 through hulls, width 5", vec![line], |seen| {
        let (rate, kernel) = (seen.told("/counts/cases")? / seen.lines[0].cpu_s, long_trajectories()?);
        Ok(vec![Figure::new("distinct trajectories", "1/s", rate).beside(kernel).at_least(0.8 * kernel)])
    })
    .reading([BEAM])
}

fn walks(method: &str) -> Row {
    let line = Line::new(format!(
        "hairpin generate quadrotor.toml --set generate.search.method={method} --set generate.search.cases=4 --out walks \
         --threads 1 --json"
    ));
    let about = format!("{method} on witness, 250 waypoints");
    Row::new(format!("{method}-witness"), about, vec![line.making("walks")], |seen| {
        let graphs = seen.told("/generation/graphs")?;
        Ok(vec![Figure::new("a graph", "s", seen.lines[0].cpu_s / graphs).at_most(0.5)])
    })
    .reading([QUADROTOR])
}

fn stress() -> Row {
    let line = Line::new("hairpin stress quadrotor.toml --out flights --threads 1 --json").making("flights");
    Row::new("stress-quadrotor", "200 cases of 5 runs", vec![line], |seen| {
        let kernel = searched_and_flown(&seen.scratch.path().join(QUADROTOR), None)?;
        let mut figures = vec![time(seen).beside(kernel)];
        figures.extend(room(&seen.lines[0], 40.0, 30.0));
        Ok(figures)
    })
    .reading([QUADROTOR])
}

/// `cases` short flights, in the folder `made`.
pub(super) fn flown(cases: u32, made: &'static str) -> Line {
    Line::new(format!(
        "hairpin stress campaign.toml --set generate.search.cases={cases} --out {made} --threads 1 --json"
    ))
    .making(made)
}

fn campaign(cases: u32, made: &'static str) -> Row {
    let lines = vec![flown(cases, made).looked_at(), flown(FEW, "flown-1000")];
    Row::new(format!("campaign-{cases}"), format!("{cases} cases of 1 run"), lines, move |seen| {
        let kernel = searched_and_flown(&seen.scratch.path().join(CAMPAIGN), Some(cases))?;
        let [all, few] = [0, 1].map(|line| seen.lines[line].cpu_s);
        let exponent = libm::log(all / few) / libm::log(f64::from(cases) / f64::from(FEW));
        let share = f64::from(cases) / 20_000.0;
        let mut figures = vec![time(seen).beside(kernel)];
        figures.extend(room(&seen.lines[0], 200.0 * share, 100.0 * share));
        figures.push(Figure::new("memory", "MB", seen.lines[0].peak_mb.unwrap_or(f64::NAN)).at_most(1000.0));
        figures.push(Figure::new("exponent of growth from 1 000", "", exponent).at_most(1.05));
        Ok(figures)
    })
    .reading([CAMPAIGN])
}

fn select(cases: u32, from: &'static str) -> Row {
    let line = Line::new(format!("hairpin select {from} --cases 100 --out chosen --threads 1 --json"));
    let about = format!("100 cases that differ, of {cases}");
    Row::new(format!("select-{cases}"), about, vec![line.making("chosen")], move |seen| {
        let time = time(seen);
        Ok(vec![if cases == 20_000 { time.at_most(2.0) } else { time }])
    })
    .reading([CAMPAIGN])
    .after(flown(cases, from))
}

/// What the first command takes.
fn time(seen: &Seen<'_>) -> Figure {
    Figure::new("time", "s", seen.lines[0].cpu_s)
}

/// What a command leaves, with the most MB and files that are promised.
fn room(of: &Measured, megabytes: f64, files: f64) -> Vec<Figure> {
    let size = of.size.unwrap_or_default();
    vec![
        Figure::new("kept", "MB", size.megabytes()).at_most(megabytes),
        Figure::new("kept", "files", size.files as f64).at_most(files),
    ]
}

/// What searching and flying the scenario in the file at `path` take alone, in memory, s.
fn searched_and_flown(path: &Path, cases: Option<u32>) -> Result<f64, Problem> {
    let sets: Vec<_> = cases.map(|cases| ("generate.search.cases".to_owned(), cases.to_string())).into_iter().collect();
    let setup = setup_for(&path.display().to_string(), &sets)?;
    let runs = setup.scenario.executor().repeat as usize;
    let watch = Stopwatch::start();
    alone(|| {
        generate(&setup, &Known::default(), &OwnSimulator, &Stop::never(), &mut |cases, _| {
            for case in cases {
                (0..runs).for_each(|run| drop(black_box(execute_run(&setup, case, run))));
            }
        })
    });
    Ok(watch.spent())
}
