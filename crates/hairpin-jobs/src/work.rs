//! From settings to a scenario and the campaign folder it belongs in: begun, gone on with, or looked at.

use std::path::{Component, Path, PathBuf};

use hairpin::campaign::scenario::{Asked, Mistake};
use hairpin::campaign::{CallersCode, PassedOver, Scenario, Setup, Tally, UserCode, vary};
use hairpin::judgement::{Chosen, cases_needed};
use hairpin::math::simd::Simd;
use hairpin_formats::folder::{CampaignFolder, Existing, FolderError};
use hairpin_formats::quote::shell_word;
use hairpin_formats::recordings;
use hairpin_formats::scenario::{check_asked, kept_in, read_kept, setup_for, shadowed};

use crate::consent::{Consent, Wish};
use crate::differences::differences;
use crate::sets::Set;
use crate::spelling::check_names;
use crate::watch::not_waiting_for;
use crate::{Deadline, Problem, Watch};

/// Confidence of intervals where the spec names none.
const CONFIDENCE: f64 = 0.95;

/// A campaign being worked on.
pub struct Work {
    /// Its folder.
    pub folder: CampaignFolder,
    /// Its scenario, resolved and ready to run.
    pub setup: Setup,
}

impl Work {
    /// The same, with the caller's code in place of files.
    ///
    /// # Errors
    /// As of [`Setup::answered_by`].
    pub(crate) fn answered_by(self, code: &CallersCode) -> Result<Self, Problem> {
        Ok(Self { setup: self.setup.answered_by(code)?, ..self })
    }

    /// Its setup as it is told of: with what the program that executed calls itself.
    ///
    /// # Errors
    /// What the folder keeps of that is broken.
    pub(crate) fn told(&self) -> Result<Setup, Problem> {
        let greeting = self.folder.read_executor()?;
        let name = greeting.map(|greeting| greeting.name).unwrap_or_default();
        Ok(self.setup.clone().executed_by(&name))
    }
}

/// What a campaign is begun with.
#[derive(Debug, Clone, Default)]
pub struct CampaignSettings {
    /// Scenario file, or the name of a shipped scenario or robot.
    pub scenario: String,
    /// Campaign folder; out/NAME of the scenario if not given.
    pub out: Option<PathBuf>,
    /// Keys of the scenario with other values.
    pub sets: Vec<Set>,
    /// What happens to a campaign that is in the folder already.
    pub if_there: IfThere,
    /// Seconds after which generation stops and keeps what exists.
    pub time_limit_s: Option<f64>,
    /// Seconds for the whole campaign; what is not done by then is told, and no pass.
    pub budget_s: Option<f64>,
    /// Version of the kernels.
    pub simd: Simd,
    /// What of a folder may run.
    pub consent: Consent,
}

/// What beginning a campaign does about one that is in its folder already.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum IfThere {
    /// Refuses.
    #[default]
    Refuse,
    /// Goes on with it, if it was begun with the same settings.
    Resume,
    /// Replaces it.
    Replace,
}

/// A campaign that may begin: nothing is written yet.
pub struct Planned {
    /// The folder that it will be in.
    pub path: PathBuf,
    /// Its scenario, resolved and ready to run.
    pub setup: Setup,
    if_there: IfThere,
    consent: Consent,
}

/// Resolves the scenario, and whether its folder may be made or taken up.
///
/// # Errors
/// A scenario with mistakes; one of a campaign's folder that asks to run what its user has not allowed; a folder that
/// holds something else; code of the user's that does not load.
pub fn plan(settings: &CampaignSettings, watch: &dyn Watch) -> Result<Planned, Problem> {
    let path = settings.out.clone().unwrap_or_else(|| default_folder(&settings.scenario));
    shadowed(&settings.scenario).iter().for_each(|note| watch.warn(note));
    let setup = setup_for(&settings.scenario, &settings.sets)?.with_simd(settings.simd);
    let setup = with_logs_from(setup, &path, Path::new(&settings.scenario))?.answered_by(&settings.consent.code)?;
    check_asked(&setup.scenario, Path::new(&settings.scenario))?;
    setup.scenario.check_search()?;
    check_command(&setup.scenario)?;
    check_names(&setup)?;
    let (kept, wishes) = (kept_in(&settings.scenario), Wish::of_campaign(&setup));
    settings.consent.ask_of_scenario((&settings.scenario, kept.as_deref()), &wishes, &settings.sets, watch)?;
    let search = setup.scenario.search();
    tell_share(&setup.scenario, (search.cases, Tally::default().chosen(&search)), watch);
    // Of programs of arms these are none of their keys.
    let passed_over = search.passed_over(setup.scenario.score());
    for (key, value) in passed_over.into_iter().filter(|_| !setup.has_programs()) {
        let method = search.method.word();
        watch.warn(&format!("`generate.search.{key}` = {value} is passed over: `{method}` has no use for it here"));
    }
    for PassedOver { key, value, why } in setup.passed_over() {
        watch.warn(&format!("`{key}` = {value} is passed over: {why}"));
    }
    let goes_on = may_make(&path, &setup, settings.if_there)?;
    if !goes_on {
        // What was begun before such scores were refused may be finished.
        check_score(&setup, watch)?;
    }
    let code = setup.user_code().into_iter().chain(setup.steering_code());
    try_out(code, Deadline::after(settings.time_limit_s), watch)?;
    Ok(Planned { path, setup, if_there: settings.if_there, consent: settings.consent.clone() })
}

/// Whether the method of `setup` reads its score, which is told as it was given.
///
/// # Errors
/// A file of the user's own that it does not: who brings one means it. A name may be left from another method, and is
/// passed over with a word.
fn check_score(setup: &Setup, watch: &dyn Watch) -> Result<(), Problem> {
    let (score, files) = (setup.scenario.score(), &setup.attachments);
    let of_model = files.model(score).map(|file| &file.given);
    let of_file = of_model.or(files.user_score(score).map(|file| &file.given));
    match (setup.scenario.check_score(of_file.map_or(score, |given| given)), of_file) {
        (Err(Mistake { key, value, bound }), None) => {
            watch.warn(&format!("`{key}` = {value} is passed over; it is to be {bound}"));
            Ok(())
        }
        (Err(Mistake { key, value, bound }), Some(_)) => {
            Err(Problem::input(format!("`{key}` = {value}: must be {bound}")))
        }
        (Ok(()), _) => Ok(()),
    }
}

/// Whether the user's own code loads: before anything that it is to take the place of is removed.
///
/// # Errors
/// The first of it that does not; it was asked to stop.
pub(crate) fn try_out<'c>(
    code: impl IntoIterator<Item = (&'static str, &'c dyn UserCode)>,
    deadline: Deadline,
    watch: &dyn Watch,
) -> Result<(), Problem> {
    for (key, user) in code {
        let tried = not_waiting_for(&[(key, user)], watch, deadline, || user.try_out());
        tried.map_err(|why| match watch.stopped() {
            true => Problem::Interrupted(format!("stopped before the file of `{key}` was loaded")),
            false => Problem::input(format!("`{key}` = {why}")),
        })?;
    }
    Ok(())
}

impl Planned {
    /// Whether it goes on with the campaign that is in its folder.
    pub(crate) fn resumes(&self) -> bool {
        self.if_there == IfThere::Resume
    }

    /// Makes or takes up its folder, and leaves the user's mark on what it may run: it is his.
    ///
    /// # Errors
    /// The folder cannot be made or written to.
    pub fn begin(self) -> Result<Work, Problem> {
        let work = Work { folder: create(&self.path, &self.setup, self.if_there)?, setup: self.setup };
        self.consent.mark(work.folder.path(), &Wish::of_campaign(&work.setup));
        tracing::info!("campaign folder {}", work.folder.path().display());
        Ok(work)
    }
}

/// Logs are named relative to the scenario file: the campaign's own lies in `folder`.
fn with_logs_from(setup: Setup, folder: &Path, file: &Path) -> Result<Setup, Problem> {
    let Some(logs) = setup.recordings() else { return Ok(setup) };
    let base = if file.is_file() { file.parent().unwrap_or(Path::new("")) } else { Path::new("") };
    let logs = recordings::relative_to(folder, base, logs);
    // Where runs are recorded nothing varies, so that nothing is lost of `[vary]`.
    let scenario = vary::apply(&setup.scenario, &[("execute.logs".into(), logs.into())])?;
    Ok(setup.changed(scenario)?)
}

/// Whether two paths lead to one place.
pub(crate) fn same_place(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// Makes `path` the folder of the campaign of `setup`.
///
/// # Errors
/// As of [`plan`] and [`Planned::begin`].
pub fn make(path: &Path, setup: Setup, if_there: IfThere) -> Result<Work, Problem> {
    may_make(path, &setup, if_there)?;
    Ok(Work { folder: create(path, &setup, if_there)?, setup })
}

/// `setup`, whose scenario says in so many words that nothing is asked of its runs where it has no limit: what is
/// written for other commands to read asks for something, or says that it does not.
pub(crate) fn saying_what_is_asked(setup: Setup) -> Result<Setup, Problem> {
    if setup.scenario.asked() != Asked::Unsaid {
        return Ok(setup);
    }
    let varied = setup.scenario.vary().clone();
    let scenario = vary::apply(&setup.scenario, &[("spec".into(), "none".into())])?;
    Ok(setup.changed(scenario.with_vary(varied))?)
}

/// Whether `path`, which can become the folder of a campaign, is taken up again.
///
/// # Errors
/// It can be neither.
fn may_make(path: &Path, setup: &Setup, if_there: IfThere) -> Result<bool, Problem> {
    // `new/../old` is no place before `new` is made, and `old` once it is.
    let mut begun = PathBuf::new();
    for part in path.components() {
        if part == Component::ParentDir && !begun.as_os_str().is_empty() && !begun.exists() {
            return Err(Problem::input(format!("--out {}: there is no folder {}", path.display(), begun.display())));
        }
        begun.push(part);
    }
    CampaignFolder::refuse_anothers(path)?;
    let old = match CampaignFolder::open(path) {
        Err(FolderError::NoCampaign { .. }) => return Ok(false),
        old => old?,
    };
    match if_there {
        IfThere::Refuse => Err(Problem::input(format!(
            "{} holds a campaign already: --resume goes on with it, --force replaces it, --out DIR keeps both",
            path.display()
        ))),
        IfThere::Resume => may_resume(&old, setup).map(|()| true),
        IfThere::Replace => Ok(false),
    }
}

/// Whether the campaign in `old` was begun as `setup` would begin it.
fn may_resume(old: &CampaignFolder, setup: &Setup) -> Result<(), Problem> {
    let before = resolve(old, &[])?;
    if old.has_cases() || old.has_runs() {
        same_as_made(old, &before, &[])?;
    }
    if let Some(key) = first_difference(&before, setup) {
        return Err(Problem::input(format!(
            "--resume: `{key}` is not what it was when {} was begun: give the same arguments, or another --out",
            old.path().display()
        )));
    }
    same_level(old, setup.simd)
}

fn create(path: &Path, setup: &Setup, if_there: IfThere) -> Result<CampaignFolder, Problem> {
    let existing = if if_there == IfThere::Resume { Existing::Resume } else { Existing::Replace };
    let folder = CampaignFolder::create(path, existing)?;
    folder.keep_scenario(setup, setup.simd.level(), setup.scenario.clear_within_mm())?;
    Ok(folder)
}

/// Opens a campaign folder for the next part, its scenario changed by `sets` in the tables `allowed`; [`keep_changes`]
/// writes it. Its SIMD level stays: a part that runs kernels goes on at it, those of the version `flown`, or not at
/// all.
pub(crate) fn open_to_change(
    path: &Path,
    sets: &[Set],
    allowed: &[&str],
    flown: Option<Simd>,
) -> Result<Work, Problem> {
    check_tables(sets, allowed)?;
    let folder = CampaignFolder::open_to_write(path)?;
    let setup = changed(&folder, sets)?;
    // The users' own programs run none of our kernels.
    match (flown, setup.scenario.executor().command) {
        (Some(Simd::Portable), _) => same_level(&folder, Simd::Portable)?,
        (Some(Simd::Widest), None) => same_level(&folder, setup.simd)?,
        (Some(Simd::Widest), Some(_)) | (None, _) => {}
    }
    Ok(Work { folder, setup })
}

/// That `sets` change nothing but the tables `allowed`.
///
/// # Errors
/// The first that does.
pub(crate) fn check_tables(sets: &[Set], allowed: &[&str]) -> Result<(), Problem> {
    for (key, _) in sets {
        let table = key.split(['.', '[']).next().unwrap_or_default().trim();
        if !allowed.contains(&table) {
            return Err(Problem::input(format!(
                "--set {key}: the folder's trajectories were made with its value; here only {} can be set",
                allowed.join(", ")
            )));
        }
    }
    Ok(())
}

/// What the scenario of `folder` describes once `sets` change it.
///
/// # Errors
/// A scenario with mistakes, or one that the folder's trajectories are none of.
pub(crate) fn changed(folder: &CampaignFolder, sets: &[Set]) -> Result<Setup, Problem> {
    let setup = resolve(folder, sets)?;
    check_asked(&setup.scenario, &folder.file("scenario.toml"))?;
    check_command(&setup.scenario)?;
    let plans = |scenario: &Scenario| {
        let of_plans = scenario.vary().iter().filter(|(key, _)| vary::shapes_the_plan(key));
        of_plans.map(|(key, drawn)| (key.clone(), drawn.clone())).collect::<Vec<_>>()
    };
    if !sets.is_empty() && plans(&setup.scenario) != plans(&resolve(folder, &[])?.scenario) {
        return Err(Problem::input(
            "--set vary: the folder's trajectories were drawn by its keys under `task` and `generate`; these must stay",
        ));
    }
    Ok(setup)
}

/// Writes the scenario of `work` as [`open_to_change`] changed it.
pub(crate) fn keep_changes(work: &Work) -> Result<(), Problem> {
    let level = work.folder.simd_level()?;
    let level = level.as_deref().unwrap_or(work.setup.simd.level());
    Ok(work.folder.keep_scenario(&work.setup, level, work.folder.clear_within_mm()?)?)
}

/// The first key of the folder's scenario that `sets` change, or else the first of its files: one of the same name may
/// say something else.
pub(crate) fn changed_by(folder: &CampaignFolder, sets: &[Set]) -> Result<Option<String>, Problem> {
    Ok(first_difference(&resolve(folder, &[])?, &resolve(folder, sets)?))
}

/// The first key that differs, or else the first file.
fn first_difference(before: &Setup, now: &Setup) -> Option<String> {
    let mut files = before.attachments.files().into_iter().zip(now.attachments.files());
    let file = || files.find(|(before, now)| before != now).map(|((name, _), _)| name.to_owned());
    differences(&before.scenario, &now.scenario).into_iter().next().or_else(file)
}

/// Opens a campaign folder to read it.
///
/// # Errors
/// There is no campaign in it, or its scenario is broken.
pub fn open_to_read(path: &Path) -> Result<Work, Problem> {
    open_with(path, &[])
}

/// The same, for what is said of its cases and runs.
///
/// # Errors
/// As of [`same_as_made`].
pub(crate) fn open_as_made(path: &Path) -> Result<Work, Problem> {
    let work = open_to_read(path)?;
    same_as_made(&work.folder, &work.setup, &[])?;
    Ok(work)
}

/// Whether the runs in `folder` are of the scenario that it has: whoever edits that makes no other runs of them.
///
/// # Errors
/// A key beside those of `spec`, or the controller's file, was changed since hairpin wrote them.
pub(crate) fn same_as_executed(folder: &CampaignFolder, setup: &Setup) -> Result<(), Problem> {
    if folder.has_runs() { same_as_made(folder, setup, &[]) } else { Ok(()) }
}

/// Where on Earth a world is may be written afterwards, for exports and logs that ask for it.
pub(crate) const PLACE: [&str; 2] = ["world.origin", "world.terrain.epsg"];

/// Whether the cases in `folder`, and its runs where it has some, are of the scenario that it has. Keys that are, or
/// lie under, one of `beside` may change.
///
/// # Errors
/// As of [`same_as_executed`].
pub(crate) fn same_as_made(folder: &CampaignFolder, setup: &Setup, beside: &[&str]) -> Result<(), Problem> {
    let is_beside = |key: &String| {
        let under = |of: &&str| key.strip_prefix('`').and_then(|key| key.strip_prefix(*of));
        beside.iter().filter_map(under).any(|rest| rest.starts_with(['.', '`']))
    };
    let edited: Vec<String> = folder.edited(setup)?.into_iter().filter(|key| !is_beside(key)).collect();
    if edited.is_empty() {
        return Ok(());
    }
    let (what, anew) = match folder.has_runs() {
        true => ("runs were executed", format!("fly all anew: {}", execute_of(folder))),
        false => ("cases were made", format!("make them anew, or fly them by it: {}", execute_of(folder))),
    };
    let (kept, edited) = (what.split(' ').next().unwrap_or_default(), edited.join(", "));
    Err(Problem::of_file(
        &folder.file("scenario.toml"),
        format!(
            "was changed beside `spec` since its {what}: {edited}. The {kept} are of what it was. Put it back, or {anew}"
        ),
    ))
}

fn execute_of(folder: &CampaignFolder) -> String {
    format!("hairpin execute {}", shell_word(&folder.path().display().to_string()))
}

/// The same with other values of `sets`.
pub(crate) fn open_with(path: &Path, sets: &[Set]) -> Result<Work, Problem> {
    let folder = CampaignFolder::open(path)?;
    let setup = resolve(&folder, sets)?;
    Ok(Work { folder, setup })
}

/// Opens a campaign folder to read it, its scenario changed by `sets` here and not there.
///
/// # Errors
/// As of [`open_to_read`]; a key that does not fit.
pub(crate) fn open_to_read_as(path: &Path, sets: &[Set]) -> Result<Work, Problem> {
    let folder = CampaignFolder::open(path)?;
    let setup = resolve(&folder, sets)?;
    check_asked(&setup.scenario, &folder.file("scenario.toml"))?;
    Ok(Work { folder, setup })
}

/// What its scenario describes once `sets` change it, with the version of the kernels that goes on with it.
fn resolve(folder: &CampaignFolder, sets: &[Set]) -> Result<Setup, Problem> {
    let name = folder.file("scenario.toml");
    let setup = read_kept(&folder.read_scenario()?, &name.to_string_lossy(), folder.path(), sets)?;
    // What stands at its end says that nothing was cut off: keys that are gone would be taken for those not given.
    let Some(level) = folder.simd_level()? else {
        let bound = "must end with `[made_by]`: version, root_seed, simd; it was cut, or is not this folder's";
        return Err(Problem::input(format!("{}: {bound}", name.display())));
    };
    Ok(setup.with_simd(if level == Simd::Portable.level() { Simd::Portable } else { Simd::Widest }))
}

/// Refuses to go on in `folder` at another SIMD level: the bits would be the same, but what is written of their origin
/// would not be true.
pub(crate) fn same_level(folder: &CampaignFolder, simd: Simd) -> Result<(), Problem> {
    let (now, path) = (simd.level(), folder.path().display());
    match folder.simd_level()? {
        Some(before) if before != now => Err(Problem::input(if before == Simd::Portable.level() {
            format!("{path} was begun with --portable: go on with it, or take another --out")
        } else {
            format!(
                "{path} was begun at the SIMD level {before}, and this is {now}: go on at {before}, or begin another \
                 with --portable, which goes on anywhere"
            )
        })),
        _ => Ok(()),
    }
}

/// Tells whoever waits for `cases` cases that they are too few for the share of violations that `scenario` allows,
/// where they are drawn at random: of any others the count decides.
pub(crate) fn tell_share(scenario: &Scenario, (cases, chosen): (u64, Chosen), watch: &dyn Watch) {
    let head = scenario.head();
    let Some(share) = head.violation_share.filter(|_| chosen == Chosen::AtRandom) else { return };
    let confidence = head.confidence.unwrap_or(CONFIDENCE);
    let Some(needed) = cases_needed(share, confidence).filter(|needed| *needed as u64 > cases) else { return };
    let key = if head.limits.iter().any(|key| key.starts_with("spec.limits.")) { "spec.limits" } else { "spec" };
    watch.warn(&format!(
        "`{key}.violation_share` = {share}: of {cases} cases none can show so small a share at {} % confidence; it takes {needed} \
         without a violation. The verdict can be FAIL or INCONCLUSIVE, not PASS",
        100.0 * confidence
    ));
}

fn check_command(scenario: &Scenario) -> Result<(), Problem> {
    let Some(command) = scenario.executor().command else { return Ok(()) };
    let parsed = command.parse::<hairpin_formats::executor::Command>();
    parsed.map(drop).map_err(|error| Problem::input(format!("`execute.command` = {command:?} {error}")))
}

/// `out/NAME`, NAME being the scenario's or robot's without folder and ending.
fn default_folder(scenario: &str) -> PathBuf {
    let name = Path::new(scenario).file_stem().unwrap_or_else(|| "campaign".as_ref());
    Path::new("out").join(name)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use hairpin::campaign::LegScorer;
    use hairpin::campaign::user_score::LegFacts;

    use super::*;
    use crate::Unwatched;
    use crate::testing::{Told, generated};

    #[test]
    fn a_scenario_that_lost_its_end_is_refused() {
        let (_place, folder) = generated();
        let file = folder.join("scenario.toml");
        let whole = std::fs::read_to_string(&file).unwrap();
        let lines = whole.split_inclusive('\n').collect::<Vec<_>>();
        for kept in 0..lines.len() {
            std::fs::write(&file, lines[..kept].concat()).unwrap();
            assert!(open_to_read(&folder).is_err(), "{kept} of {} lines", lines.len());
        }
        let without = whole.split("[made_by]").next().unwrap();
        std::fs::write(&file, without).unwrap();
        let told = open_to_read(&folder).map(|_| ()).unwrap_err().to_string();
        assert!(told.contains("must end with `[made_by]`"), "{told}");
    }

    /// What was proven clear within a limit is proven within it, however often the limit was changed since.
    #[test]
    fn proofs_hold_for_their_limit() {
        let place = tempfile::tempdir().unwrap();
        let (file, folder) = (place.path().join("cell.toml"), place.path().join("out"));
        let text = "hairpin = 1\nrobot = \"irb120\"\n[spec]\npath = { max_mm = 10 }\n[task]\npoints = [[300, 0, 300], [300, 100, 300]]\n";
        std::fs::write(&file, text).unwrap();
        let scenario = file.to_string_lossy().into_owned();
        let settings = CampaignSettings { scenario, out: Some(folder.clone()), ..CampaignSettings::default() };
        plan(&settings, &Unwatched).unwrap().begin().unwrap();
        for max in ["5", "500", "8"] {
            let sets = [("spec.path.max_mm".to_owned(), max.to_owned())];
            keep_changes(&open_to_change(&folder, &sets, &["spec"], None).unwrap()).unwrap();
            assert_eq!(open_to_read(&folder).unwrap().folder.clear_within_mm().unwrap(), Some(10.0), "{max}");
        }
    }

    /// Scores long legs.
    struct Long;

    impl UserCode for Long {
        fn trouble(&self) -> Option<String> {
            None
        }

        fn try_out(&self) -> Result<(), String> {
            Ok(())
        }

        fn stop(&self) {}
    }

    impl LegScorer for Long {
        fn own_and_left(&self, legs: &[LegFacts]) -> Vec<[f64; 2]> {
            legs.iter().map(|leg| [leg.length_m, 0.0]).collect()
        }
    }

    #[test]
    fn code_of_the_callers_answers_in_place_of_a_file_that_cannot() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("long.py");
        std::fs::write(&file, "raise RuntimeError('it lives elsewhere')").unwrap();
        let settings = CampaignSettings {
            scenario: "demo-quadrotor".into(),
            out: Some(place.path().join("out")),
            sets: vec![("generate.score".into(), format!("'python:{}'", file.display()))],
            ..CampaignSettings::default()
        };
        let refused = plan(&settings, &Unwatched).map(drop).unwrap_err().to_string();
        assert!(refused.contains("it lives elsewhere"), "{refused}");
        let code = CallersCode { score: Some(Arc::new(Long)), ..CallersCode::default() };
        let settings = CampaignSettings { consent: Consent { code, ..Consent::default() }, ..settings };
        let planned = plan(&settings, &Unwatched).unwrap();
        assert_eq!(planned.setup.attachments.files()[0].1, std::fs::read(&file).unwrap(), "the file is what is kept");
        let leg = LegFacts {
            v_in_m_s: 1.0,
            v_out_m_s: 1.0,
            turn_rad: 0.0,
            length_m: 7.0,
            climb_m: 0.0,
            slope_in: 0.0,
            ground: 0.0,
            duration_s: 7.0,
            from_m: [0.0; 3],
            to_m: [7.0, 0.0, 0.0],
            start_m: [0.0; 3],
            end_m: [7.0, 0.0, 0.0],
        };
        assert_eq!(planned.setup.user_score().unwrap().own_and_left(&[leg]), [[7.0, 0.0]]);
    }

    #[test]
    fn a_score_that_the_method_does_not_read_is_told_where_it_would_be_searched_by() {
        let place = tempfile::tempdir().unwrap();
        let settings = |scenario: &str, sets: &[(&str, &str)]| CampaignSettings {
            scenario: scenario.into(),
            out: Some(place.path().join("out")),
            sets: sets.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect(),
            ..CampaignSettings::default()
        };
        // What is said beside it.
        let planned = |scenario: &str, sets: &[(&str, &str)]| {
            let heard = Told::default();
            let planned = plan(&settings(scenario, sets), &heard).map(drop).map_err(|refused| refused.to_string());
            let lines = heard.0.into_inner().unwrap();
            planned.map(|()| lines.into_iter().filter(|line| line.contains("score")).collect::<String>())
        };
        let (score, of_drives) = ("generate.score", "generate.search.score");
        let shipped = [("quadrotor", score), ("boat", score), ("rover", of_drives), ("car", of_drives)];
        for (scenario, key) in shipped {
            assert_eq!(planned(scenario, &[]).unwrap(), "", "{scenario}");
            let told = planned(scenario, &[(key, "random")]).unwrap();
            let words = ["= \"random\"", "\"beam\", \"exact\", \"in-loop\"", "the method `worst` reads none"];
            assert!(told.contains(key) && words.iter().all(|word| told.contains(word)), "{told}");
            assert_eq!(planned(scenario, &[(key, "random"), ("generate.search.method", "uniform")]).unwrap(), "");
        }
        let rounds = [(score, "random"), ("generate.search.method", "adaptive"), ("generate.search.executions", "900")];
        assert!(planned("quadrotor", &rounds).unwrap().contains("the method `adaptive` reads none"));
        // A file is meant, and refused as it was typed, not as the folder would call it.
        let file = place.path().join("mine.py");
        std::fs::write(&file, "def score(leg):\n    return 1.0\n").unwrap();
        let typed = format!("python:{}", file.display());
        assert!(planned("quadrotor", &[(score, &format!("'{typed}'"))]).unwrap_err().contains(&typed));
        // Arms, whose first program is the heaviest, read their costs.
        let search = ("generate.search", "{ method = \"worst\", programs = 2 }");
        planned("arm", &[search, ("generate.cost", "\"time\"")]).unwrap();
        // What was begun with one is read, and gone on with.
        let typed = format!("'{typed}'");
        let sets = [(score, typed.as_str())];
        let old = setup_for("quadrotor", &settings("quadrotor", &sets).sets).unwrap();
        drop(make(&place.path().join("out"), old, IfThere::Refuse).unwrap());
        assert!(open_to_read(&place.path().join("out")).is_ok());
        let again =
            |if_there| plan(&CampaignSettings { if_there, ..settings("quadrotor", &sets) }, &Unwatched).map(drop);
        again(IfThere::Resume).unwrap();
        assert!(again(IfThere::Replace).unwrap_err().to_string().contains("reads none"));
    }

    #[test]
    fn folders_are_named_after_scenarios() {
        assert_eq!(default_folder("quadrotor.toml"), Path::new("out/quadrotor"));
        assert_eq!(default_folder("/a/b/my.drone.toml"), Path::new("out/my.drone"));
        assert_eq!(default_folder("anafi"), Path::new("out/anafi"));
    }

    #[test]
    fn a_campaign_is_begun_once_and_resumed_as_it_was() {
        let place = tempfile::tempdir().unwrap();
        let settings = CampaignSettings {
            scenario: "demo-quadrotor".into(),
            out: Some(place.path().join("out")),
            ..CampaignSettings::default()
        };
        drop(plan(&settings, &Unwatched).unwrap().begin().unwrap());
        let again = |if_there, sets: Vec<Set>| {
            plan(&CampaignSettings { if_there, sets, ..settings.clone() }, &Unwatched).map(drop)
        };
        let refused = again(IfThere::Refuse, Vec::new()).unwrap_err().to_string();
        assert!(refused.contains("holds a campaign already"), "{refused}");
        again(IfThere::Resume, Vec::new()).unwrap();
        let refused = again(IfThere::Resume, vec![crate::sets::seed(99)]).unwrap_err().to_string();
        assert!(refused.contains("`seed` is not what it was"), "{refused}");
        again(IfThere::Replace, vec![crate::sets::seed(99)]).unwrap();
        assert!(open_to_read(&place.path().join("out")).is_ok());
    }
}
