//! A score from executed legs, of one campaign or several.
//!
//! Data flow: folders → `alike` (of one robot, executed and measured alike) → `pooled` (their samples, each trajectory
//! once) → the library's fit → a model's file.

mod alike;
mod pooled;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use hairpin::campaign::learn::ScoreModel;
use hairpin::campaign::samples::{self, learn_moves};
use hairpin::judgement::Stress;
use hairpin::math::ridge::NoFit;
use hairpin_formats::atomic;
use hairpin_formats::folder::refuse_own;

use self::alike::open_alike;
use self::pooled::{pooled, what};
use crate::Problem;

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

/// Learns `stress` from the campaigns in `folders`, as if all were one, and writes the score to `out`, however good it
/// is. Trajectories are numbered on from folder to folder, in the order given; one that is met again, executed anew,
/// keeps its number.
///
/// # Errors
/// Nothing to learn from, or too little; a folder that is given twice, or of another robot or controller than the
/// first, or whose legs were executed or measured otherwise; a trajectory that another folder has as well, executed to
/// the same numbers; a file that cannot be read or written.
pub fn learn(folders: &[PathBuf], out: &Path, stress: Stress) -> Result<Learned, Problem> {
    refuse_own(out)?;
    let works = open_alike(folders)?;
    let Some(first) = works.first() else { return Err(Problem::input("no campaign folder is given")) };
    let arm = first.setup.has_programs();
    let learned = if arm {
        learn_moves(&first.setup, stress, &pooled(&works, stress)?)
    } else {
        samples::learn(&first.setup, stress, &pooled(&works, stress)?)
    };
    let model = learned.map_err(|error| {
        let names: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
        let place = names.join(", ");
        match error {
            NoFit::Groups { groups, needed } => Problem::input(format!(
                "{place}: {groups} trajectories with executed {}s; {needed} are needed in all: every fifth is held out, and ten folds \
                 are made of the others",
                what(arm)
            )),
            error => Problem::input(format!("{place}: {error}")),
        }
    })?;
    atomic::write_json(out, &model)?;
    Ok(Learned { model, score_key: first.setup.scenario.score_key(), arm })
}
