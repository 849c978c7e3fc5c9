//! A score from executed legs, of one campaign or several.

use std::path::{Path, PathBuf};

use hairpin::campaign::learn::{LegSample, MoveSample, ScoreModel};
use hairpin::campaign::samples::{self, learn_moves, leg_samples, move_samples};
use hairpin::campaign::scenario::SearchMethod;
use hairpin::campaign::{Case, Run, Setup};
use hairpin::judgement::Stress;
use hairpin::math::ridge::NoFit;
use hairpin_formats::atomic;
use hairpin_formats::folder::refuse_own;
use rayon::prelude::*;

use crate::Problem;
use crate::execute::runs_to_judge;
use crate::work::{Work, open_as_made};

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
/// is. Trajectories are numbered on from folder to folder, in the order given.
///
/// # Errors
/// Nothing to learn from, or too little; a folder that is given twice, or of another robot or controller than the
/// first; a file that cannot be read or written.
pub fn learn(folders: &[PathBuf], out: &Path, stress: Stress) -> Result<Learned, Problem> {
    refuse_own(out)?;
    let works = open_alike(folders)?;
    let Some(first) = works.first() else { return Err(Problem::input("no campaign folder is given")) };
    let arm = first.setup.has_programs();
    let learned = if arm {
        learn_moves(&first.setup, stress, &pooled(&works, stress, moves_of)?)
    } else {
        samples::learn(&first.setup, stress, &pooled(&works, stress, legs_of)?)
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

/// The campaigns in `folders`, which are of one robot and were executed by one controller or program.
fn open_alike(folders: &[PathBuf]) -> Result<Vec<Work>, Problem> {
    let works = folders.iter().map(|folder| open_as_made(folder)).collect::<Result<Vec<_>, Problem>>()?;
    let real = |folder: &Path| folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    for (place, work) in works.iter().enumerate().skip(1) {
        if folders[..place].iter().any(|before| real(before) == real(&folders[place])) {
            return Err(Problem::of_file(&folders[place], "is given twice: what it says would count twice"));
        }
        let (ours, theirs) = (of_whom(&works[0]), of_whom(work));
        if let Some(((what, theirs), (_, ours))) = theirs.into_iter().zip(ours).find(|((_, a), (_, b))| a != b) {
            let why =
                format!("its {what} is {theirs}, and that of {} is {ours}: one model is of one", folders[0].display());
            return Err(Problem::of_file(&folders[place], why));
        }
    }
    Ok(works)
}

/// Whose legs a campaign has, and who executed them.
fn of_whom(work: &Work) -> [(&'static str, String); 5] {
    let subject = work.setup.scenario.subject();
    let command = work.setup.scenario.executor().command.map_or("none".into(), |command| format!("`{command}`"));
    [
        ("robot", format!("`{}`", subject.robot)),
        ("robot's numbers (BLAKE3)", subject.robot_hash),
        ("meaning of speeds", format!("`{}`", subject.speeds)),
        ("controller", format!("`{}`", subject.controller)),
        ("`execute.command`", command),
    ]
}

/// What is learned of, in a word.
fn what(arm: bool) -> &'static str {
    if arm { "move" } else { "leg" }
}

/// The samples of all of `works`, their trajectories numbered on. `of` gives those of one case; every folder has some.
fn pooled<S: Send>(
    works: &[Work],
    stress: Stress,
    of: fn(&Setup, &Case, &[Run], usize, Stress) -> Vec<S>,
) -> Result<Vec<S>, Problem> {
    let (mut all, mut before) = (Vec::new(), 0);
    for work in works {
        let cases = work.folder.read_cases()?;
        let of_case = |case: &Case| {
            let runs = runs_to_judge(work, case)?.runs;
            Ok(of(&work.setup, case, &runs, before + case.number.0, stress))
        };
        let samples = cases.par_iter().map(of_case).collect::<Result<Vec<Vec<S>>, Problem>>()?;
        let samples: Vec<S> = samples.into_iter().flatten().collect();
        if samples.is_empty() {
            return Err(nothing(work, &cases, !work.folder.has_runs(), stress));
        }
        all.extend(samples);
        before += cases.iter().map(|case| case.number.0 + 1).max().unwrap_or_default();
    }
    Ok(all)
}

fn legs_of(setup: &Setup, case: &Case, runs: &[Run], trajectory: usize, stress: Stress) -> Vec<LegSample> {
    let samples = leg_samples(setup, case, runs, stress);
    samples.into_iter().map(|sample| LegSample { trajectory, ..sample }).collect()
}

fn moves_of(setup: &Setup, case: &Case, runs: &[Run], program: usize, stress: Stress) -> Vec<MoveSample> {
    let samples = move_samples(setup, case, runs, stress);
    samples.into_iter().map(|sample| MoveSample { program, ..sample }).collect()
}

/// Why a campaign has nothing to learn from.
fn nothing(work: &Work, cases: &[Case], unflown: bool, stress: Stress) -> Problem {
    let (place, arm) = (work.folder.path().display(), work.setup.has_programs());
    let missing = if unflown {
        format!("nothing was executed: hairpin execute {place}")
    } else if !arm && cases.iter().all(|case| case.seen.is_empty()) {
        unseen(work)
    } else {
        format!("{} was measured on none of them", stress.word())
    };
    Problem::input(format!("{place}: no {} to learn from: {missing}", what(arm)))
}

/// Why no search saw the legs of its cases, and what helps.
fn unseen(work: &Work) -> String {
    let scenario = &work.setup.scenario;
    let helps = "give `learn` a campaign whose trajectories are draws of graphs: hairpin stress SCENARIO --out flown --set \
                 generate.search.method=uniform";
    if work.folder.read_tally().is_ok_and(|tally| !tally.missions.is_empty()) {
        format!("its missions were made elsewhere, and no search saw their legs; {helps}")
    } else if scenario.search().method == SearchMethod::Worst {
        format!("the method `worst` proves their legs one by one, and `learn` knows those of graphs; {helps}")
    } else {
        format!("no search saw the legs of its cases; {helps}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;
    use crate::execute::{ExecuteSettings, execute};
    use crate::generate::generate;
    use crate::testing::{executed, generated, small};
    use crate::work::CampaignSettings;

    /// An executed campaign of `cases` of the seed `seed`, with one more key set.
    fn flown(place: &tempfile::TempDir, name: &str, (seed, cases): (u64, u64), more: (&str, &str)) -> PathBuf {
        let mut settings = CampaignSettings { out: Some(place.path().join(name)), ..small(place) };
        for (key, value) in [("generate.search.cases", &*cases.to_string()), ("seed", &*seed.to_string()), more] {
            settings.sets.push((key.into(), value.into()));
        }
        let folder = generate(&settings, &Unwatched).unwrap().work.folder.path().to_owned();
        execute(&ExecuteSettings { folder: folder.clone(), ..ExecuteSettings::default() }, &Unwatched).unwrap();
        folder
    }

    const PLAIN: (&str, &str) = ("execute.repeat", "1");

    #[test]
    fn a_score_is_learned_and_written() {
        let place = tempfile::tempdir().unwrap();
        let folder = flown(&place, "out", (1, 20), PLAIN);
        let out = place.path().join("model.json");
        let learned = learn(&[folder], &out, Stress::MaxDeviation).unwrap();
        assert_eq!((learned.model.trajectories, learned.score_key, learned.arm), (20, "generate.score", false));
        assert_eq!(serde_json::from_slice::<ScoreModel>(&std::fs::read(out).unwrap()).unwrap(), learned.model);
    }

    #[test]
    fn several_campaigns_are_learned_from_as_one() {
        let place = tempfile::tempdir().unwrap();
        let folders = [flown(&place, "a", (1, 7), PLAIN), flown(&place, "b", (2, 8), PLAIN)];
        let works: Vec<Work> = folders.iter().map(|folder| open_as_made(folder).unwrap()).collect();
        // The union: the cases of one, then those of the other as number 7 and so on.
        let mut union = Vec::new();
        for (work, before) in works.iter().zip([0, 7]) {
            for mut case in work.folder.read_cases().unwrap() {
                let runs = runs_to_judge(work, &case).unwrap().runs;
                case.number.0 += before;
                union.extend(leg_samples(&work.setup, &case, &runs, Stress::MaxDeviation));
            }
        }
        assert_eq!(pooled(&works, Stress::MaxDeviation, legs_of).unwrap(), union);
        let out = place.path().join("model.json");
        let learned = learn(&folders, &out, Stress::MaxDeviation).unwrap();
        assert_eq!(learned.model.trajectories, 15);
        assert_eq!(learned.model, samples::learn(&works[0].setup, Stress::MaxDeviation, &union).unwrap());
        let refused = |other: &Path| {
            let learned = learn(&[folders[0].clone(), other.to_owned()], &out, Stress::MaxDeviation);
            learned.map(|_| ()).unwrap_err().to_string()
        };
        let twice = refused(&folders[0].join("../a"));
        assert!(twice.contains("is given twice"), "{twice}");
        let controller = refused(&flown(&place, "c", (1, 1), ("execute.controller", "\"fixed-velocity\"")));
        assert!(controller.contains("its controller is `fixed-velocity`, and that of "), "{controller}");
        let heavy = refused(&flown(&place, "d", (1, 1), ("robot.mass_kg", "1.01")));
        assert!(heavy.contains("its robot's numbers"), "{heavy}");
    }

    #[test]
    fn what_is_missing_is_told() {
        let refused = |folder: &Path| {
            let learned = learn(&[folder.to_owned()], &folder.join("model.json"), Stress::MaxDeviation);
            learned.map(|_| ()).unwrap_err().to_string()
        };
        let (_place, folder) = generated();
        assert!(refused(&folder).contains("nothing was executed"));
        let (_place, folder) = executed();
        let too_few = refused(&folder);
        assert!(too_few.contains("2 trajectories with executed legs"), "{too_few}");
        // The default search has witnesses beside its graphs; draws are what helps.
        let place = tempfile::tempdir().unwrap();
        let mut settings = small(&place);
        let search = "{ method = \"worst\", waypoints = 60, cases = 2, executions = 4 }";
        settings.sets[0] = ("generate.search".into(), search.into());
        let folder = generate(&settings, &Unwatched).unwrap().work.folder.path().to_owned();
        execute(&ExecuteSettings { folder: folder.clone(), ..ExecuteSettings::default() }, &Unwatched).unwrap();
        let unseen = refused(&folder);
        let words = ["the method `worst` proves their legs one by one", "--set generate.search.method=uniform"];
        assert!(words.iter().all(|word| unseen.contains(word)) && !unseen.contains("elsewhere"), "{unseen}");
    }
}
