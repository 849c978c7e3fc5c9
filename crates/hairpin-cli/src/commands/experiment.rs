//! `hairpin experiment NAME`: the papers' experiments and those that they left open; tables as CSV, figures as SVG.

use std::path::Path;

use hairpin_jobs::{Problem, Watch};
use hairpin_lab::experiment::{ExperimentSettings, conduct};

use super::findings::tell;
use crate::args::Experiment;

/// Runs the command: 0 when it has measured, whatever came out.
pub(crate) fn run(asked: &Experiment, watch: &dyn Watch) -> Result<u8, Problem> {
    let name = asked.name.sheet();
    let settings = ExperimentSettings {
        full: asked.full,
        sets: asked.sets.iter().cloned().chain(asked.sizes.sets()).collect(),
        out: asked.out.clone().unwrap_or_else(|| Path::new("out").join(&name)),
        name,
    };
    Ok(tell(&conduct(&settings, watch)?, asked.json))
}
