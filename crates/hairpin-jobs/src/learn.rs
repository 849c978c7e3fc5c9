//! A score from executed legs.

use std::path::Path;

use hairpin::campaign::Case;
use hairpin::campaign::learn::ScoreModel;
use hairpin::campaign::samples::{self, learn_moves, leg_samples, move_samples};
use hairpin::judgement::Stress;
use hairpin::math::ridge::NoFit;
use hairpin_formats::atomic;
use rayon::prelude::*;

use crate::Problem;
use crate::work::open_to_read;

/// A score that was learned and written.
#[derive(Debug)]
pub struct Learned {
    /// The score, with its quality on trajectories that took no part.
    pub model: ScoreModel,
    /// The key of a scenario that takes it.
    pub score_key: &'static str,
    /// Whether it is of an arm's moves.
    pub arm: bool,
}

/// Learns `stress` from the campaign in `folder` and writes the score to `out`, however good it is.
///
/// # Errors
/// Nothing to learn from, or too little; a file that cannot be read or written.
pub fn learn(folder: &Path, out: &Path, stress: Stress) -> Result<Learned, Problem> {
    let work = open_to_read(folder)?;
    let cases = work.folder.read_cases()?;
    let table = work.folder.read_runs_table()?;
    let place = folder.display();
    let what = if work.setup.has_programs() { "move" } else { "leg" };
    let found = |samples: usize| {
        let missing = match samples {
            0 if table.is_empty() => format!("nothing was executed: hairpin execute {place}"),
            0 if !work.setup.has_programs() && cases.iter().all(|case| case.seen.is_empty()) => {
                "no search saw the legs of its cases, as of missions made elsewhere".to_owned()
            }
            0 => format!("{} was measured on none of them", stress.word()),
            _ => return Ok(()),
        };
        Err(Problem::input(format!("{place}: no {what} to learn from: {missing}")))
    };
    let runs = |case: &Case| work.folder.read_runs(case.number, &table);
    let learned = if work.setup.has_programs() {
        let of_case = |case: &Case| Ok(move_samples(&work.setup, case, &runs(case)?, stress));
        let samples = cases.par_iter().map(of_case).collect::<Result<Vec<_>, Problem>>()?.concat();
        found(samples.len())?;
        learn_moves(&work.setup, stress, &samples)
    } else {
        let of_case = |case: &Case| Ok(leg_samples(&work.setup, case, &runs(case)?, stress));
        let samples = cases.par_iter().map(of_case).collect::<Result<Vec<_>, Problem>>()?.concat();
        found(samples.len())?;
        samples::learn(&work.setup, stress, &samples)
    };
    let model = learned.map_err(|error| match error {
        NoFit::Groups { groups, needed } => Problem::input(format!(
            "{place}: {groups} trajectories with executed {what}s; {needed} are needed in all: every fifth is held out, and ten folds \
             are made of the others"
        )),
        error => Problem::input(format!("{place}: {error}")),
    })?;
    atomic::write_json(out, &model)?;
    let score_key = work.setup.scenario.score_key();
    Ok(Learned { model, score_key, arm: work.setup.has_programs() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;
    use crate::execute::{ExecuteSettings, execute};
    use crate::generate::generate;
    use crate::testing::{executed, generated, small};

    #[test]
    fn a_score_is_learned_and_written() {
        let place = tempfile::tempdir().unwrap();
        let mut settings = small(&place);
        settings.sets.push(("generate.search.cases".into(), "20".into()));
        let folder = generate(&settings, &Unwatched).unwrap().work.folder.path().to_owned();
        execute(&ExecuteSettings { folder: folder.clone(), ..ExecuteSettings::default() }, &Unwatched).unwrap();
        let out = place.path().join("model.json");
        let learned = learn(&folder, &out, Stress::MaxDeviation).unwrap();
        assert_eq!((learned.model.trajectories, learned.score_key, learned.arm), (20, "generate.score", false));
        assert_eq!(serde_json::from_slice::<ScoreModel>(&std::fs::read(out).unwrap()).unwrap(), learned.model);
    }

    #[test]
    fn what_is_missing_is_told() {
        let refused = |folder: &Path| {
            let learned = learn(folder, &folder.join("model.json"), Stress::MaxDeviation);
            learned.map(|_| ()).unwrap_err().to_string()
        };
        let (_place, folder) = generated();
        assert!(refused(&folder).contains("nothing was executed"));
        let (_place, folder) = executed();
        let too_few = refused(&folder);
        assert!(too_few.contains("2 trajectories with executed legs"), "{too_few}");
    }
}
