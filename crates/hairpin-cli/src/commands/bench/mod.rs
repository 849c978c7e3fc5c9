//! `hairpin bench`: the speeds that hairpin promises, measured here and now on one core, beside their targets.

mod arm;
mod arm_controller;
pub(super) mod clock;
mod controls;
mod exact;
pub(super) mod ground;
mod max_load;
pub(super) mod memory;
mod reach;
mod search;
mod simulation;
mod steer;
mod witness;
mod worst;

use hairpin::campaign::Setup;
use hairpin::campaign::flight::FlightSetup;
use hairpin::math::simd::Simd;
use hairpin::robot::quadrotor::Quadrotor;
use hairpin_formats::scenario::setup_for;
use serde_json::json;

use crate::args::Bench;
use crate::console;
use crate::problem::Problem;

/// What is measured, and what is promised: at least (rates) or at most (times, errors) so much.
struct Row {
    name: &'static str,
    unit: &'static str,
    target: Option<Target>,
    measure: fn(&Bench) -> Result<f64, Problem>,
}

/// Which side of the number is good.
#[derive(Clone, Copy)]
enum Target {
    /// A rate.
    AtLeast(f64),
    /// A time, an error, a size.
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
    if bench.name.as_deref() == Some(worst::NAME) {
        warn_of_debug_build();
        return worst::run(bench.queries, bench.json);
    }
    if let Some(folder) = &bench.write {
        return max_load::write(bench, folder);
    }
    let rooms = [
        reach::rows(),
        search::rows(),
        exact::rows(),
        witness::rows(),
        simulation::rows(),
        arm_controller::rows(),
        steer::rows(),
        controls::rows(),
        ground::rows(),
        memory::rows(),
        arm::rows(),
        max_load::rows(),
    ];
    let all: Vec<Row> = rooms.into_iter().flatten().collect();
    let wanted = |row: &&Row| bench.name.as_ref().is_none_or(|name| row.name.starts_with(name.as_str()));
    let rows: Vec<&Row> = all.iter().filter(wanted).collect();
    if rows.is_empty() {
        let names: Vec<&str> = all.iter().map(|row| row.name).chain([worst::NAME]).collect();
        return Err(Problem::input(format!("no bench begins with that name; there are {}", names.join(", "))));
    }
    warn_of_debug_build();
    let mut table = vec![["bench", "measured", "unit", "target", "met"].map(str::to_owned).to_vec()];
    let mut objects = Vec::new();
    for row in rows {
        tracing::info!("{}", row.name);
        let value = (row.measure)(bench)?;
        let met = row.target.map(|target| target.met(value));
        let target = row.target.map_or("–".into(), Target::words);
        let shown = if value < 10.0 { format!("{value:.3}") } else { format!("{value:.0}") };
        let word = met.map_or("–", |met| if met { "yes" } else { "NO" });
        objects.push(json!({ "bench": row.name, "measured": value, "unit": row.unit, "target": target, "met": met }));
        table.push(vec![row.name.into(), shown, row.unit.into(), target, word.into()]);
    }
    if bench.json {
        console::say(&json!({ "simd": Simd::Widest.level(), "clock": clock::NAME, "benches": objects }).to_string());
    } else {
        console::say(&console::table(&table));
        console::say(&format!(
            "median of several runs, one core, {}, SIMD level {}",
            clock::NAME,
            Simd::Widest.level()
        ));
    }
    Ok(0)
}

fn warn_of_debug_build() {
    if cfg!(debug_assertions) {
        console::warn("Warning: this is no release build; its speeds mean nothing");
    }
}

fn robot(name: &str) -> Result<Quadrotor, Problem> {
    Ok(flyer(&setup_for(name, &[])?)?.robot.clone())
}

fn flyer(setup: &Setup) -> Result<FlightSetup<'_>, Problem> {
    setup.flight().ok_or_else(|| Problem::input(format!("`{}` does not fly", setup.robot_name())))
}
