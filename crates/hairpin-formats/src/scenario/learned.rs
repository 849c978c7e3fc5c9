//! Models of learned scores: the file that `score = "learned:FILE"` names.

use std::path::Path;

use hairpin::campaign::Scenario;
use hairpin::campaign::learn::{KeptModel, NAME, ScoreModel};
use hairpin::campaign::scenario::CostSection;

use super::Wrong;
use super::resolve::read_file;

/// Reads the model that `scenario` scores by, if it does. A resolved scenario's is [`hairpin::campaign::learn::NAME`].
pub(super) fn read(scenario: &mut Scenario, base: &Path) -> Result<(), Wrong> {
    let (key, score, model) = match scenario {
        Scenario::Flight(scenario) => ("generate.score", &mut scenario.generate.score, &mut scenario.generate.model),
        Scenario::Drive(scenario) => {
            let search = &mut scenario.generate.search;
            ("generate.search.score", &mut search.score, &mut search.model)
        }
        Scenario::Arm(scenario) => match &mut scenario.generate.cost {
            CostSection::Learned(cost) => ("generate.cost", &mut cost.score, &mut cost.model),
            CostSection::Named(_) | CostSection::Table(_) | CostSection::Weighted(_) => return Ok(()),
        },
    };
    let Some(file) = KeptModel::file_of(score) else { return Ok(()) };
    let wrong = |bound: String| (key.to_owned(), score.clone(), bound);
    let bytes = read_file(&base.join(file)).map_err(|why| wrong(format!("`{file}` cannot be read: {why}")))?;
    let read: ScoreModel = serde_json::from_slice(&bytes).map_err(|error| wrong(format!("`{file}`: {error}")))?;
    *model = Some(KeptModel { model: read.into(), bytes: bytes.into(), given: score.clone() });
    *score = KeptModel::score();
    Ok(())
}

/// As [`read`], for a resolved scenario that lies in `folder`, as beside a repro file, or in the folder above.
pub(super) fn attach(scenario: &mut Scenario, folder: &Path) -> Result<(), Wrong> {
    let above = folder.join("..");
    read(scenario, if folder.join(NAME).is_file() { folder } else { &above })
}
