//! Execution: the flights of a campaign whose trajectories are there, or of waypoint files made elsewhere.

mod beside;
mod by_case;
mod fly;
mod in_loop;
mod job;
mod kept;
mod missing;
mod recorded;
mod to_judge;
mod worst;

use std::path::{Path, PathBuf};

use hairpin::campaign::{Case, CaseResult, Failures, Status, Tally};
use hairpin::judgement::Chosen;
use hairpin::math::simd::Simd;
use hairpin_formats::folder::CampaignFolder;

use crate::baseline::fly_baseline;
use crate::consent::{Consent, Wish};
use crate::missions::{self, adopt};
use crate::program::fingerprint;
use crate::saved::{Replayed, replay_saved};
use crate::sets::Set;
use crate::work::{
    IfThere, Work, changed, changed_by, check_tables, keep_changes, open_to_change, open_to_read, same_as_executed,
    tell_share, try_out,
};
use crate::{Deadline, Problem, Watch};
use beside::beside;
pub(crate) use by_case::fly_by_case;
use fly::first_trouble;
pub use fly::fly_each;
pub(crate) use fly::{command_of, fly_one, fly_together, fly_told};
pub(crate) use in_loop::{Asked, in_the_loop};
pub(crate) use job::comes_again;
pub(crate) use kept::{run_with_motion, runs_with_motion, why_lost};
pub use missing::Flown;
use missing::{all_flown, count_reruns};
pub(crate) use missing::{attitude_unknown, count_flown, fly_missing};
pub(crate) use recorded::check_recordings;
pub(crate) use to_judge::{ToJudge, measured_runs, reruns_to_judge, runs_to_judge};
pub(crate) use worst::WORST;

/// Tables of a scenario that may change once there are trajectories.
const CHANGED: &[&str] = &["execute", "vary", "spec"];

/// What is executed, and how.
#[derive(Debug, Clone, Default)]
pub struct ExecuteSettings {
    /// Campaign folder.
    pub folder: PathBuf,
    /// Folder of a campaign of its own with the same cases, where the runs land; where not given they land in the
    /// campaign's.
    pub out: Option<PathBuf>,
    /// Whether a campaign that is in `out` makes room.
    pub replaces: bool,
    /// Keys of `execute`, `vary` and `spec` with other values.
    pub sets: Vec<Set>,
    /// A mission made elsewhere or a folder of them, which take the place of the folder's cases.
    pub missions: Option<PathBuf>,
    /// Folder of repro files that are run first; those of the campaign folder if not given.
    pub repro: Option<PathBuf>,
    /// Whether the runs that are there stay.
    pub resume: bool,
    /// Version of the kernels.
    pub simd: Simd,
    /// What of the folder may run.
    pub consent: Consent,
}

/// An executed campaign.
#[derive(Debug)]
pub struct Executed {
    /// Its folder.
    pub folder: PathBuf,
    /// How many cases it has.
    pub cases: usize,
    /// Their runs.
    pub flown: Flown,
    /// The case of the first run that was not flown, why it was not, and by which program.
    pub trouble: Option<String>,
    /// Names of the missions that were made elsewhere.
    pub missions: Vec<String>,
    /// Saved cases that were run first.
    pub replayed: Vec<Replayed>,
}

/// Executes a campaign; runs that fail are told in numbers.
///
/// # Errors
/// Settings that do not fit the folder, or a folder that asks to run what its user has not allowed; missions,
/// recordings or saved cases that cannot be used; a file that cannot be written; it was asked to stop.
pub fn execute(settings: &ExecuteSettings, watch: &dyn Watch) -> Result<Executed, Problem> {
    let ExecuteSettings { folder, sets, .. } = settings;
    let path = settings.out.as_ref().unwrap_or(folder);
    // What the cases of another folder are flown by is told as of this one's.
    let mut edited_there = Vec::new();
    // Who resumes goes on where the cases are already.
    if settings.out.is_some() && !(settings.resume && CampaignFolder::open(path).is_ok()) {
        let if_there = if settings.replaces { IfThere::Replace } else { IfThere::Refuse };
        check_tables(sets, CHANGED)?;
        if let Some(missions) = &settings.missions {
            // What is in `out` makes room only for what can take its place.
            missions::of_files(&open_to_read(folder)?.setup, missions)?;
        }
        if !sets.is_empty() {
            let setup = changed(&CampaignFolder::open(folder)?, sets)?.answered_by(&settings.consent.code)?;
            // What is typed runs anyway: what does not load makes no room.
            if Wish::of_execution(&setup).iter().all(|wish| wish.is_typed(sets)) {
                try_out(setup.steering_code(), Deadline::after(None), watch)?;
            }
        }
        edited_there = beside((folder, sets), path, if_there, &settings.consent)?;
    }
    if settings.resume && !sets.is_empty() {
        unchanged(path, sets)?;
    }
    let work = open_to_change(path, sets, CHANGED, Some(settings.simd))?.answered_by(&settings.consent.code)?;
    if settings.resume {
        same_as_executed(&work.folder, &work.setup)?;
    }
    let wishes = Wish::of_execution(&work.setup);
    settings.consent.ask_of_scenario((&path.to_string_lossy(), Some(path)), &wishes, sets, watch)?;
    let read = |path: &Path| missions::read(&work.setup, path, watch);
    let missions = settings.missions.as_deref().map(read).transpose()?;
    if missions.is_none() && !work.folder.has_cases() {
        let path = path.display();
        return Err(Problem::input(format!("{path} has no cases yet: hairpin generate, or --missions DIR")));
    }
    let kept = missions.is_none().then(|| work.folder.read_cases()).transpose()?;
    let cases = missions.as_ref().map_or(kept.as_ref().map_or(0, Vec::len), Vec::len);
    let mut tally =
        if missions.is_none() && work.folder.has_tally() { work.folder.read_tally()? } else { Tally::default() };
    let chosen = if missions.is_some() { Chosen::Given } else { tally.chosen(&work.setup.scenario.search()) };
    tell_share(&work.setup.scenario, (cases as u64, chosen), watch);
    // Whatever can be refused is refused before anything is lost.
    try_out(work.setup.steering_code(), Deadline::after(None), watch)?;
    let replayed = replay_saved(&work.setup, work.folder.path(), (settings.repro.as_deref(), &[]), watch)?;
    check_recordings(&work, kept.as_deref().unwrap_or_default())?;
    // What the user wrote into the scenario is what is flown from here on.
    let edited = work.folder.edited(&work.setup)?;
    edited_there.extend(edited.iter().cloned());
    tell_edited(&edited_there, missions.is_none(), watch);
    if !sets.is_empty() || !edited.is_empty() {
        keep_changes(&work)?;
        let typed: Vec<Wish> = wishes.into_iter().filter(|wish| wish.is_typed(sets)).collect();
        settings.consent.mark(path, &typed);
    }
    let searched = if missions.is_some() { searched_before(&work)? } else { None };
    let cases = match (&missions, kept) {
        (None, Some(cases)) => cases,
        (missions, _) => {
            adopt(&work, missions.as_deref().unwrap_or_default())?;
            work.folder.read_cases()?
        }
    };
    let before = if settings.resume { count_flown(&work, &cases).ok() } else { None };
    let all_there = settings.resume && missions.is_none() && all_flown(&work, &cases);
    let reruns = if all_there { count_reruns(&work, &cases)? } else { 0 };
    let judged = if before.is_some() { work.folder.read_results()? } else { Vec::new() };
    // What was judged was judged on other runs, or on fewer. Where this cannot be written, the runs stay with it.
    work.folder.write_results(&cases, &[])?;
    if !settings.resume {
        work.folder.forget_runs()?;
        if !sets.is_empty() || work.setup.scenario.executor().command.is_some() {
            // Of a search that was stopped: who flies now may be another than who flew then.
            work.folder.write_executed(None)?;
        }
    }
    if let Some((cases, results)) = searched {
        work.folder.write_searched(&cases, &results)?;
    }
    let flown = fly_missing(&work, &cases, watch).inspect_err(|_| {
        // Where nothing has landed, what was judged is what it was; where that cannot be written it is judged anew.
        if before.is_some() && before == count_flown(&work, &cases).ok() {
            drop(work.folder.write_results(&cases, &judged));
        }
    })?;
    if !settings.resume && missions.is_none() {
        tally = failed_before(&work, tally)?;
    }
    tell_failed(&tally, flown, watch);
    if all_there && !judged.is_empty() && reruns == count_reruns(&work, &cases)? {
        // Nothing was executed: what was judged is what it was.
        work.folder.write_results(&cases, &judged)?;
    }
    let tally = if work.folder.has_tally() { work.folder.read_tally()? } else { tally };
    fly_baseline(&work, &tally, flown, watch)?;
    let missions = missions.into_iter().flatten().map(|mission| mission.name).collect();
    let trouble = if flown.failed > 0 { first_trouble(&work, &cases)? } else { None };
    Ok(Executed { folder: work.folder.path().to_owned(), cases: cases.len(), flown, trouble, missions, replayed })
}

/// `tally` of cases that were all executed anew: where another has executed the search, what failed then is past.
fn failed_before(work: &Work, tally: Tally) -> Result<Tally, Problem> {
    if tally.failures.is_none() {
        return Ok(tally);
    }
    let now = fingerprint(&work.setup, work.folder.read_executor()?.as_ref());
    let is_past = tally.failures.by.as_ref().is_some_and(|by| *by != now);
    let tally = Tally { failures: Failures { is_past, ..tally.failures.clone() }, ..tally };
    work.folder.write_tally(&tally)?;
    Ok(tally)
}

/// Tells that what failed in the search stays a failure, though all cases were flown, and how it would not.
fn tell_failed(tally: &Tally, flown: Flown, watch: &dyn Watch) {
    if let Some(failed) = tally.failures_in_words().filter(|_| flown.failed == 0 && !tally.failures.is_past) {
        watch.warn(&format!(
            "{failed}, and who executes is the same since, by its command, its files and what it says of itself: the verdict stays EXECUTOR FAILED. \
             One that was repaired elsewhere says another `version` in its `ready`; hairpin stress … --force searches anew"
        ));
    }
}

/// Tells that cases are flown by what they were not made with: once it is flown so, nothing in the folder tells it.
fn tell_edited(edited: &[String], are_of_the_folder: bool, watch: &dyn Watch) {
    let of_the_cases = |key: &&String| {
        let table = key.trim_matches('`').split('.').next().unwrap_or_default();
        key.starts_with('`') && !CHANGED.contains(&table)
    };
    let keys: Vec<&str> = edited.iter().filter(of_the_cases).map(String::as_str).collect();
    if !keys.is_empty() && are_of_the_folder {
        watch.warn(&format!(
            "{} of the folder's scenario.toml {} changed by hand: its trajectories were made with what stood there before, and are flown by what stands \
             there now",
            keys.join(", "),
            if keys.len() == 1 { "was" } else { "were" }
        ));
    }
}

/// The cases of a search, and what was measured of them.
type Searched = (Vec<Case>, Vec<CaseResult>);

/// What the folder's own search found and was judged, for missions to be compared with; of missions before them, what
/// those were compared with.
fn searched_before(work: &Work) -> Result<Option<Searched>, Problem> {
    if !work.folder.has_cases() || !work.folder.has_tally() {
        return Ok(None);
    }
    let (cases, tally) = (work.folder.read_cases()?, work.folder.read_tally()?);
    let own = tally.missions.is_empty();
    let results = if own { Some(work.folder.read_results()?) } else { work.folder.read_searched()? };
    let Some(mut results) = results.filter(|results| !results.is_empty()) else { return Ok(None) };
    for result in &mut results {
        // Measured, not judged: nothing of them is counted.
        (result.violations, result.draws) = (Vec::new(), None);
        if result.status != Status::ExecutorFailed {
            result.status = Status::Unjudged;
        }
    }
    let cases = if own { cases } else { results.iter().map(|one| Case::bare(one.case, 0, Vec::new())).collect() };
    Ok(Some((cases, results)))
}

/// Who resumes goes on with the same settings, or runs of two kinds would stand side by side.
fn unchanged(folder: &Path, sets: &[Set]) -> Result<(), Problem> {
    let before = CampaignFolder::open(folder)?;
    match changed_by(&before, sets)? {
        None => Ok(()),
        Some(key) => {
            Err(Problem::input(format!("--resume: `{key}` is not what it was; without --resume all is flown anew")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;
    use crate::export::{Export, ExportSettings, Format};
    use crate::judge_log::{Against, FrameSettings, LogSettings, judge_log};
    use crate::testing::{Told, generated, program};

    #[test]
    fn runs_are_flown_once_and_resumed() {
        let (_place, folder) = generated();
        let settings = ExecuteSettings { folder, ..ExecuteSettings::default() };
        let executed = execute(&settings, &Unwatched).map(|executed| (executed.cases, executed.flown)).unwrap();
        assert_eq!(executed, (2, Flown { runs: 2, failed: 0, attitude_unknown: 0, end_unsaid: 0, heights_by_map: 0 }));
        let other = ExecuteSettings { sets: vec![("execute.repeat".into(), "3".into())], resume: true, ..settings };
        let refused = execute(&other, &Unwatched).map(|_| ()).unwrap_err().to_string();
        assert!(refused.starts_with("--resume: `execute.repeat`"), "{refused}");
    }

    fn set(key: &str, value: &str) -> Set {
        (key.to_owned(), format!("\"{value}\""))
    }

    fn refusal(settings: &ExecuteSettings) -> String {
        execute(settings, &Unwatched).map(drop).unwrap_err().to_string()
    }

    /// A controller's file of the same name that says something else is another controller; what does not load makes no
    /// room for itself.
    #[test]
    fn files_of_one_name_are_told_apart_and_loaded_before_anything_goes() {
        let (place, folder) = generated();
        let file = |name: &str, text: &str| {
            let file = place.path().join(name);
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(&file, text).unwrap();
            vec![
                set("execute.controller", &format!("python:{}", file.display())),
                ("execute.time_limit_s".to_owned(), "1.0".to_owned()),
            ]
        };
        let steers = |speed: &str| format!("def control(t, s, r):\n    return {{'v_m_s': [0.0, 0.0, {speed}]}}\n");
        let of = |sets| ExecuteSettings { folder: folder.clone(), sets, ..ExecuteSettings::default() };
        let own = file("own/fly.py", &steers("0.1"));
        assert_eq!(execute(&of(own), &Unwatched).unwrap().flown.failed, 0);
        let other = ExecuteSettings { resume: true, ..of(file("new/fly.py", &steers("-0.5"))) };
        let refused = refusal(&other);
        assert!(refused.starts_with("--resume: `fly.py` is not what it was"), "{refused}");
        assert_eq!(std::fs::read_to_string(folder.join("fly.py")).unwrap(), steers("0.1"), "it is not overwritten");
        let copy = ExecuteSettings { resume: true, ..of(file("copy/fly.py", &steers("0.1"))) };
        assert_eq!(execute(&copy, &Unwatched).unwrap().flown.runs, 2);
        let broken = of(file("broken/fly.py", "def control(t, s, r) return {}\n"));
        let out = place.path().join("beside");
        let beside = ExecuteSettings { out: Some(out.clone()), ..of(file("own/fly.py", &steers("0.1"))) };
        execute(&beside, &Unwatched).unwrap();
        let over = ExecuteSettings { out: Some(out.clone()), replaces: true, ..broken.clone() };
        for settings in [broken, over] {
            let refused = refusal(&settings);
            assert!(refused.contains("`execute.controller` = ") && refused.contains("SyntaxError"), "{refused}");
        }
        for kept in [folder, out] {
            let kept = CampaignFolder::open(&kept).unwrap();
            assert!(kept.read_cases().unwrap().iter().all(|case| kept.has_valid_run(case.number, 0)));
        }
    }

    /// Of runs that were executed by one scenario nothing is said in the name of another, that stands there now.
    #[test]
    fn a_scenario_that_was_edited_has_no_runs() {
        let (_place, folder) = crate::testing::executed();
        let (file, judged) = (folder.join("scenario.toml"), || crate::judge::judge(&folder, &[]).map(drop));
        judged().unwrap();
        let as_written = std::fs::read_to_string(&file).unwrap();
        assert!(as_written.contains("accept_m = 1.0"), "{as_written}");
        let edited = as_written.replace("accept_m = 1.0", "accept_m = 2.0");
        std::fs::write(&file, &edited).unwrap();
        let resumed = ExecuteSettings { folder: folder.clone(), resume: true, ..ExecuteSettings::default() };
        let told = [judged().unwrap_err().to_string(), refusal(&resumed)];
        let reported = crate::report::report(&folder, &[], None).unwrap_err().to_string();
        let consent = crate::consent::Consent::default();
        let replayed =
            crate::replay::replay_case((&folder, hairpin::campaign::CaseNumber(0)), Simd::Widest, &consent, &Unwatched);
        let exporting = crate::export::ExportSettings { folder: folder.clone(), ..Default::default() };
        let exported = || crate::export::Export::open(&exporting).map(drop);
        let shrinking = crate::shrink::ShrinkSettings { folder: folder.clone(), ..Default::default() };
        let shrunk = crate::shrink::Shrinking::open(shrinking).map(drop).unwrap_err().to_string();
        let log = LogSettings {
            path: folder.join("0000-0.csv"),
            against: Against::Campaign(folder.clone()),
            world: None,
            sets: Vec::new(),
            case: None,
            frame: FrameSettings::default(),
            source: None,
            from_s: None,
            to_s: None,
            page: None,
        };
        let log = judge_log(&log, &Unwatched).map(drop).unwrap_err().to_string();
        let others = [reported, replayed.unwrap_err().to_string(), exported().unwrap_err().to_string(), shrunk, log];
        for told in told.iter().chain(&others) {
            assert!(
                told.contains("scenario.toml: was changed beside `spec`") && told.contains("hairpin execute"),
                "{told}"
            );
            assert!(told.contains(": `execute.accept_m`. The runs are of what it was"), "{told}");
        }
        assert_eq!(crate::verify::verify(&folder).unwrap().edited, ["`execute.accept_m`"], "what is proven is told of");
        // Where on Earth it is, an export may need to know afterwards.
        let placed = as_written.replace("alt_amsl_m = 180.0", "alt_amsl_m = 181.0");
        assert_ne!(placed, as_written);
        std::fs::write(&file, &placed).unwrap();
        exported().unwrap();
        // A folder of before has nothing to tell it by.
        let made = edited.find("settings = ").unwrap();
        let rest = edited[made..].find("clear_within_mm").or_else(|| edited[made..].find("simd")).unwrap();
        std::fs::write(&file, format!("{}{}", &edited[..made], &edited[made + rest..])).unwrap();
        exported().unwrap();
        judged().unwrap();
        // Layout is no change, nor are limits.
        std::fs::write(&file, format!("# mine\n\n{as_written}")).unwrap();
        judged().unwrap();
        // What is flown anew is flown by what was written.
        std::fs::write(&file, edited).unwrap();
        execute(&ExecuteSettings { resume: false, ..resumed.clone() }, &Unwatched).unwrap();
        judged().unwrap();
        execute(&resumed, &Unwatched).unwrap();
    }

    /// Nor are cases of an edited scenario made into another campaign's, or gone on with, as if they were of what
    /// stands there now.
    #[test]
    fn a_scenario_that_was_edited_has_no_cases() {
        let (place, folder) = generated();
        let file = folder.join("scenario.toml");
        let as_written = std::fs::read_to_string(&file).unwrap();
        std::fs::write(&file, as_written.replace("alt_amsl_m = 180.0", "alt_amsl_m = 181.0")).unwrap();
        let key = "`world.origin.alt_amsl_m`";
        let out = place.path().join("beside");
        let choice = crate::select::SelectSettings {
            folder: folder.clone(),
            out: out.clone(),
            cases: 1,
            by: hairpin::campaign::select::By::Diverse,
            if_there: IfThere::Refuse,
            consent: crate::consent::Consent::default(),
        };
        let chosen = crate::select::select(&choice, &Unwatched).map(drop).unwrap_err().to_string();
        let mut again = crate::testing::small(&place);
        again.if_there = IfThere::Resume;
        again.sets.push(("world.origin.alt_amsl_m".into(), "181.0".into()));
        let resumed = crate::generate::generate(&again, &Unwatched).map(drop).unwrap_err().to_string();
        for refused in [&chosen, &resumed] {
            assert!(refused.contains("since its cases were made") && refused.contains(key), "{refused}");
        }
        let told = Told::default();
        let beside = ExecuteSettings { folder, out: Some(out), ..ExecuteSettings::default() };
        execute(&beside, &told).unwrap();
        let told = told.0.into_inner().unwrap().join("\n");
        assert!(told.contains(&format!("{key} of the folder's scenario.toml was changed by hand")), "{told}");
    }

    /// Another version of a program goes on with nothing that the one before has executed, and nothing is lost.
    #[test]
    fn a_campaign_is_gone_on_with_by_the_program_that_began_it() {
        let (place, folder) = generated();
        let file = place.path().join("sim.py");
        let named = |says: &str| program(&file, says);
        let sets = vec![named("name=\"sim 1\", version=1")];
        let settings = ExecuteSettings { folder: folder.clone(), sets, ..ExecuteSettings::default() };
        execute(&settings, &Unwatched).unwrap();
        crate::judge::judge(&folder, &[("spec.deviation.max_m".to_owned(), "50.0".to_owned())]).unwrap();
        let resumed = ExecuteSettings { resume: true, ..settings.clone() };
        named("name=\"sim 2\", version=\"2\"");
        let results = || format!("{:?}", CampaignFolder::open(&folder).unwrap().read_results().unwrap());
        let judged = results();
        assert_eq!(execute(&resumed, &Unwatched).unwrap().flown.runs, 2, "none is missing, and it is not asked");
        assert!(judged.len() > 2 && results() == judged, "and what was judged stays: {judged}");
        // As where it was stopped before they landed.
        for part in ["runs", "executions"] {
            std::fs::remove_dir_all(folder.join(part)).unwrap();
        }
        let refused = refusal(&resumed);
        let told = "the program says of itself `sim 2`, version `2`; what is kept was executed by `sim 1`, version `1`";
        assert!(refused.starts_with(told), "{refused}");
        let kept = CampaignFolder::open(&folder).unwrap();
        assert_eq!(kept.read_executor().unwrap().unwrap().name, "sim 1");
        assert_eq!(kept.read_results().unwrap().len(), 2, "what was judged stays");
        named("name=\"sim 1\", version=1");
        assert_eq!(
            execute(&resumed, &Unwatched).unwrap().flown,
            Flown { runs: 2, failed: 0, attitude_unknown: 0, end_unsaid: 0, heights_by_map: 0 }
        );
        named("name=\"sim 2\"");
        execute(&settings, &Unwatched).unwrap();
        assert_eq!(CampaignFolder::open(&folder).unwrap().read_executor().unwrap().unwrap().name, "sim 2");
    }

    /// Random cases stand beside a campaign for what the same program makes of them.
    #[test]
    fn random_cases_are_flown_by_the_campaigns_program() {
        let (place, folder) = generated();
        let file = place.path().join("sim.py");
        let sets = vec![program(&file, "name=\"sim 1\""), ("execute.baseline".to_owned(), "2".to_owned())];
        let settings = ExecuteSettings { folder: folder.clone(), sets, ..ExecuteSettings::default() };
        execute(&settings, &Unwatched).unwrap();
        let baseline = folder.join("baseline.parquet");
        let measured = std::fs::read(&baseline).unwrap();
        std::fs::remove_file(&baseline).unwrap();
        let resumed = ExecuteSettings { resume: true, ..settings };
        program(&file, "name=\"sim 2\"");
        let refused = refusal(&resumed);
        assert!(refused.contains("`sim 2`") && refused.contains("`sim 1`") && !baseline.exists(), "{refused}");
        program(&file, "name=\"sim 1\"");
        execute(&resumed, &Unwatched).unwrap();
        assert_eq!(std::fs::read(&baseline).unwrap(), measured);
    }

    /// What `export` writes in degrees is the same cases again, with their plans and evidence.
    #[test]
    fn missions_in_degrees_are_the_cases_that_they_were_written_from() {
        let (place, folder) = generated();
        let settings = ExportSettings { folder: folder.clone(), ..ExportSettings::default() };
        let export = Export::open(&settings).unwrap();
        let written = export.write(Format::Geodetic).unwrap().files;
        let missions = place.path().join("degrees");
        std::fs::create_dir(&missions).unwrap();
        for file in &written {
            std::fs::rename(file, missions.join(file.file_name().unwrap())).unwrap();
        }
        let before = open_to_read(&folder).unwrap().folder.read_cases().unwrap();
        let settings =
            ExecuteSettings { folder: folder.clone(), missions: Some(missions), ..ExecuteSettings::default() };
        let executed = execute(&settings, &Unwatched).unwrap();
        assert_eq!((executed.cases, executed.missions), (2, vec!["0000".to_owned(), "0001".to_owned()]));
        assert_eq!(open_to_read(&folder).unwrap().folder.read_cases().unwrap(), before);
    }

    /// Waypoints are no programs: nothing of an arm's campaign goes for them, also where it is to make room.
    #[test]
    fn an_arms_campaign_outlives_missions() {
        use crate::max_load::{CloudAnswer, CloudSettings, search_cloud};
        use crate::work::IfThere;

        let place = tempfile::tempdir().unwrap();
        let [points, missions, folder, other] =
            ["p.csv", "way.csv", "arm", "other"].map(|name| place.path().join(name));
        std::fs::write(&points, "x_mm,y_mm,z_mm\n300,0,300\n300,100,300\n").unwrap();
        std::fs::write(&missions, "x_m,y_m,z_m\n0.3,0.1,0.4\n0.35,-0.1,0.3\n").unwrap();
        let settings = CloudSettings { cell: "irb120".into(), points: Some(points), ..CloudSettings::default() };
        let CloudAnswer::Searched(searched) = search_cloud(&settings, &Unwatched).unwrap() else {
            panic!("these points can be met")
        };
        for out in [&folder, &other] {
            searched.keep(out, IfThere::Refuse, &Unwatched).unwrap();
        }
        let beside = ExecuteSettings { out: Some(other.clone()), replaces: true, ..ExecuteSettings::default() };
        for settings in [ExecuteSettings::default(), beside] {
            let settings = ExecuteSettings { folder: folder.clone(), missions: Some(missions.clone()), ..settings };
            let refused = execute(&settings, &Unwatched).map(|_| ()).unwrap_err().to_string();
            assert!(refused.contains("an arm's cases are programs"), "{refused}");
        }
        for out in [&folder, &other] {
            assert!(open_to_read(out).unwrap().folder.read_cases().unwrap()[0].program().is_some());
        }
    }

    #[test]
    fn missions_take_the_place_of_cases() {
        let (place, folder) = generated();
        let missions = place.path().join("missions");
        std::fs::create_dir(&missions).unwrap();
        std::fs::write(missions.join("there.csv"), "x_m,y_m,z_m\n1,1,1\n3,2,1\n").unwrap();
        let settings = ExecuteSettings { folder, missions: Some(missions), ..ExecuteSettings::default() };
        let executed = execute(&settings, &Unwatched).unwrap();
        assert_eq!((executed.cases, executed.missions), (1, vec!["there".to_owned()]));
    }
}
