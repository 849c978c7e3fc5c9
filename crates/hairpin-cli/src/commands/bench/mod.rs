//! `hairpin bench`: the speeds that hairpin promises, measured here and now on one core, beside their targets.

mod reach;
mod search;
mod simulation;

use std::hint::black_box;
use std::time::Instant;

use hairpin::campaign::Setup;
use hairpin::robot::quadrotor::Quadrotor;
use hairpin_formats::scenario::scenario_for;
use serde_json::json;

use crate::args::Bench;
use crate::problem::Problem;
use crate::{console, simd};

/// What is measured, and what is promised: at least (rates) or at most (times, errors) so much.
struct Row {
    name: &'static str,
    unit: &'static str,
    target: Option<Target>,
    measure: fn() -> Result<f64, Problem>,
}

/// Which side of the number is good.
#[derive(Clone, Copy)]
enum Target {
    /// A rate.
    AtLeast(f64),
    /// A time or an error.
    AtMost(f64),
}

impl Target {
    fn met(self, value: f64) -> bool {
        match self {
            Self::AtLeast(bound) => value >= bound,
            Self::AtMost(bound) => value <= bound,
        }
    }

    fn words(self) -> String {
        match self {
            Self::AtLeast(bound) => format!("≥ {bound}"),
            Self::AtMost(bound) => format!("≤ {bound}"),
        }
    }
}

/// Runs the command: 0 when it has measured, whatever came out (a busy machine is no violation).
pub(crate) fn run(bench: &Bench) -> Result<u8, Problem> {
    let all: Vec<Row> = reach::rows().into_iter().chain(search::rows()).chain(simulation::rows()).collect();
    let wanted = |row: &&Row| bench.name.as_ref().is_none_or(|name| row.name.starts_with(name.as_str()));
    let rows: Vec<&Row> = all.iter().filter(wanted).collect();
    if rows.is_empty() {
        let names: Vec<&str> = all.iter().map(|row| row.name).collect();
        return Err(Problem::input(format!("no bench begins with that name; there are {}", names.join(", "))));
    }
    if cfg!(debug_assertions) {
        console::warn("Warning: this is no release build; its speeds mean nothing");
    }
    let mut table = vec![["bench", "measured", "unit", "target", "met"].map(str::to_owned).to_vec()];
    let mut objects = Vec::new();
    for row in rows {
        tracing::info!("{}", row.name);
        let value = (row.measure)()?;
        let met = row.target.map(|target| target.met(value));
        let target = row.target.map_or("–".into(), Target::words);
        let shown = if value < 10.0 { format!("{value:.3}") } else { format!("{value:.0}") };
        let word = met.map_or("–", |met| if met { "yes" } else { "NO" });
        objects.push(json!({ "bench": row.name, "measured": value, "unit": row.unit, "target": target, "met": met }));
        table.push(vec![row.name.into(), shown, row.unit.into(), target, word.into()]);
    }
    if bench.json {
        console::say(&json!({ "simd": simd::level(), "benches": objects }).to_string());
    } else {
        console::say(&console::table(&table));
        console::say(&format!("best of several runs, one core, SIMD level {}", simd::level()));
    }
    Ok(0)
}

/// Best of `times` runs of `work`, s: what the machine can do when nothing else disturbs it.
fn best<T>(times: usize, mut work: impl FnMut() -> T) -> f64 {
    let run = |_| {
        let begun = Instant::now();
        black_box(work());
        begun.elapsed().as_secs_f64()
    };
    (0..times).map(run).fold(f64::INFINITY, f64::min)
}

/// Items per second, best of `times` runs of `work`, which returns how many items it made.
fn rate(times: usize, mut work: impl FnMut() -> u64) -> f64 {
    let run = |_| {
        let begun = Instant::now();
        let items = black_box(work());
        items as f64 / begun.elapsed().as_secs_f64()
    };
    (0..times).map(run).fold(0.0, f64::max)
}

fn robot(name: &str) -> Result<Quadrotor, Problem> {
    Ok(Setup::new(scenario_for(name, &[])?)?.robot)
}
