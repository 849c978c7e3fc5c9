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

/// What makes a template as quick as a demo.
const FEWER: [(&str, &str); 2] = [("generate.search.executions", "12"), ("generate.search.cases", "6")];

/// Runs the command.
pub(crate) fn run(demo: &Demo, watch: &dyn Watch) -> Result<u8, Problem> {
    let scenario = format!("demo-{}", demo.kind);
    // Some have a small scenario of their own; the others are the template, searched for less long.
    let is_there = library::scenarios().any(|shipped| shipped.name == scenario);
    let fewer = FEWER.map(|(key, value)| (key.to_owned(), value.to_owned()));
    let (scenario, sets) = if is_there { (scenario, &[][..]) } else { (demo.kind.clone(), &fewer[..]) };
    settings::take_threads(&demo.threads);
    let setup = setup_for(&scenario, sets)?.with_simd(settings::simd(&demo.kernels));
    let replaceable = demo.force || demo.out == Path::new("hairpin-demo");
    let work = make(&demo.out, setup, settings::if_there(false, replaceable))?;
    Ok(stress::say(&stress_begun(work, &Budget::endless(), Vec::new(), watch)?, None, demo.json))
}
