//! `hairpin demo`: a small campaign that needs nothing but the binary.

use std::path::Path;

use hairpin_formats::library;
use hairpin_formats::scenario::setup_for;
use hairpin_jobs::stress::stress_begun;
use hairpin_jobs::work::make;
use hairpin_jobs::{Budget, Problem, Watch};

use super::stress;
use crate::args::Demo;
use crate::settings;

/// Runs the command.
pub(crate) fn run(demo: &Demo, watch: &dyn Watch) -> Result<u8, Problem> {
    let scenario = format!("demo-{}", demo.kind);
    if !library::scenarios().any(|shipped| shipped.name == scenario) {
        return Err(Problem::input(format!("{0} has no demo of its own: hairpin stress {0}", demo.kind)));
    }
    settings::take_threads(&demo.threads);
    let setup = setup_for(&scenario, &[])?.with_simd(settings::simd(&demo.kernels));
    let replaceable = demo.force || demo.out == Path::new("hairpin-demo");
    let work = make(&demo.out, setup, settings::if_there(false, replaceable))?;
    Ok(stress::say(&stress_begun(work, &Budget::endless(), Vec::new(), watch)?, None, demo.json))
}
