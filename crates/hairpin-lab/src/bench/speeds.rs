//! All benches, or those whose name begins as asked, beside their targets.

use hairpin::math::simd::Simd;
use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use super::row::{BenchSettings, Row, Target};
use super::worst::WORST;
use super::{
    arm, arm_controller, controls, exact, ground, max_load, memory, reach, search, simulation, steer, witness,
};
use crate::clock;
use crate::findings::{Findings, Words};

/// Every bench, in the order of the table.
fn all() -> Vec<Row> {
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
    rooms.into_iter().flatten().collect()
}

/// Measures what `settings` ask for. Whatever comes out is no violation: the machine may be busy.
///
/// # Errors
/// No bench whose name begins so; a length of the campaign that is none; a bench whose question has no answer.
pub fn measure(settings: &BenchSettings, watch: &dyn Watch) -> Result<Findings, Problem> {
    let all = all();
    let wanted = |row: &&Row| settings.name.as_ref().is_none_or(|name| row.name.starts_with(name.as_str()));
    let rows: Vec<&Row> = all.iter().filter(wanted).collect();
    if rows.is_empty() {
        let names: Vec<&str> = all.iter().map(|row| row.name).chain([WORST]).collect();
        return Err(Problem::input(format!("no bench begins with that name; there are {}", names.join(", "))));
    }
    clock::warn_of_debug_build(watch);
    let mut table = vec![["bench", "measured", "unit", "target", "met"].map(str::to_owned).to_vec()];
    let mut objects = Vec::new();
    for row in rows {
        tracing::info!("{}", row.name);
        let value = (row.measure)(settings)?;
        let met = row.target.map(|target| target.met(value));
        let target = row.target.map_or("–".into(), Target::words);
        let shown = if value < 10.0 { format!("{value:.3}") } else { format!("{value:.0}") };
        let word = met.map_or("–", |met| if met { "yes" } else { "NO" });
        objects.push(json!({ "bench": row.name, "measured": value, "unit": row.unit, "target": target, "met": met }));
        table.push(vec![row.name.into(), shown, row.unit.into(), target, word.into()]);
    }
    let (clock, level) = (clock::NAME, Simd::Widest.level());
    let conditions = format!("median of several runs, one core, {clock}, SIMD level {level}");
    let object = json!({ "simd": level, "clock": clock, "benches": objects });
    Ok(Findings::new(vec![Words::Table(table), Words::Text(conditions)], object))
}
