//! `hairpin bench`: the speeds that hairpin promises, measured here and now on one core, beside their targets.

use hairpin_jobs::{Problem, Watch};
use hairpin_lab::bench::{BenchSettings, WORST, measure, measure_worst, write_questions};

use super::findings::tell;
use crate::args::Bench;

/// Runs the command: 0 when it has measured, whatever came out (a busy machine is no violation).
pub(crate) fn run(bench: &Bench, watch: &dyn Watch) -> Result<u8, Problem> {
    let name = bench.name.as_deref();
    let found = match &bench.write {
        _ if name == Some(WORST) => measure_worst(bench.queries, watch),
        Some(folder) => write_questions(name, bench.questions, folder),
        None => measure(&BenchSettings { name: bench.name.clone(), minutes: bench.minutes }, watch),
    }?;
    Ok(tell(&found, bench.json))
}
