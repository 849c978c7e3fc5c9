//! `hairpin requirements rover`: the source's test plan, run here and now, as its two tables: requirements and tests.

use hairpin::world::terrain::HoleRule;
use hairpin_jobs::Problem;
use hairpin_lab::requirements::{RequirementsSettings, TerrainSettings, check, write_regression};

use super::findings::tell;
use super::terrain::georeference;
use crate::args::Requirements;
use crate::console;
use crate::exit::DONE;

/// Runs the command: 0 when every requirement is met, 1 when one is not.
pub(crate) fn run(asked: &Requirements) -> Result<u8, Problem> {
    if let Some(folder) = &asked.write_regression {
        write_regression(folder)?.iter().for_each(|line| console::say(line));
        return Ok(DONE);
    }
    let terrain = asked.terrain.as_ref().map(|file| TerrainSettings {
        file: file.clone(),
        georeference: georeference(&asked.map, HoleRule::KeepOut),
        rocks: asked.rocks,
    });
    let found = check(&RequirementsSettings { queries: asked.queries as usize, terrain })?;
    Ok(tell(&found, asked.json))
}
