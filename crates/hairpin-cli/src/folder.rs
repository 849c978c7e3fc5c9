//! From what was typed to a scenario and the campaign folder it belongs in.

use std::path::{Component, Path, PathBuf};

use hairpin::campaign::{Scenario, Setup, vary};
use hairpin::math::simd::Simd;
use hairpin_formats::atomic;
use hairpin_formats::folder::{CampaignFolder, Existing};
use hairpin_formats::recordings;
use hairpin_formats::scenario::{self, MadeBy, read_made_by, read_setup, setup_for};

use crate::args::{Campaign, Kernels, Threads};
use crate::interrupt::{self, Deadline};
use crate::problem::Problem;

/// A campaign being worked on.
pub(crate) struct Work {
    pub(crate) folder: CampaignFolder,
    pub(crate) setup: Setup,
}

/// Takes the threads that were asked for.
pub(crate) fn take_threads(threads: &Threads) {
    if let Some(count) = threads.threads {
        // It fails only where the pool exists already: one command, one pool.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(count.into()).build_global();
    }
}

/// The version of the kernels that was asked for.
pub(crate) fn simd(kernels: &Kernels) -> Simd {
    if kernels.portable { Simd::Portable } else { Simd::Widest }
}

/// A campaign that may begin: nothing is written yet.
pub(crate) struct Planned {
    pub(crate) path: PathBuf,
    pub(crate) setup: Setup,
    resume: bool,
}

/// Resolves the scenario, and whether its folder may be made or taken up.
pub(crate) fn plan(campaign: &Campaign, executor: Option<&str>) -> Result<Planned, Problem> {
    take_threads(&campaign.threads);
    let mut sets = split(&campaign.sets)?;
    sets.extend(campaign.seed.map(|seed| ("seed".to_owned(), seed.to_string())));
    sets.extend(executor.map(as_command));
    let path = campaign.out.clone().unwrap_or_else(|| default_folder(&campaign.scenario));
    let setup = setup_for(&campaign.scenario, &sets)?.with_simd(simd(&campaign.kernels));
    let setup = with_logs_from(setup, &path, Path::new(&campaign.scenario))?;
    setup.scenario.check_search()?;
    check_command(&setup.scenario)?;
    may_make(&path, &setup, campaign.resume, campaign.force)?;
    if let Some(user) = setup.user_score() {
        let deadline = Deadline::after(campaign.time_limit);
        let tried = interrupt::not_waiting_for(Some(user), deadline, || user.try_out());
        tried.map_err(|why| match interrupt::asked() {
            true => Problem::Interrupted("stopped before the score was loaded".into()),
            false => Problem::input(format!("`{}` = {why}", setup.scenario.score_key())),
        })?;
    }
    Ok(Planned { path, setup, resume: campaign.resume })
}

impl Planned {
    /// Makes or takes up its folder.
    pub(crate) fn begin(self) -> Result<Work, Problem> {
        let work = Work { folder: create(&self.path, &self.setup, self.resume)?, setup: self.setup };
        tracing::info!("campaign folder {}", work.folder.path().display());
        Ok(work)
    }
}

/// Resolves the scenario and makes or takes up its folder.
pub(crate) fn begin(campaign: &Campaign, executor: Option<&str>) -> Result<Work, Problem> {
    plan(campaign, executor)?.begin()
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

/// `--logs PATTERN`, relative to where the command runs, as the key that it sets in the scenario of `folder`. JSON's strings are TOML's.
pub(crate) fn as_logs(folder: &Path, pattern: &str) -> (String, String) {
    let logs = recordings::relative_to(folder, Path::new(""), pattern);
    ("execute.logs".to_owned(), serde_json::Value::from(logs).to_string())
}

/// Makes `path` the folder of a campaign, or takes it up again.
pub(crate) fn make(path: &Path, setup: &Setup, resume: bool, force: bool) -> Result<CampaignFolder, Problem> {
    may_make(path, setup, resume, force)?;
    create(path, setup, resume)
}

/// Whether `path` can become the folder of a campaign, or be taken up again.
fn may_make(path: &Path, setup: &Setup, resume: bool, force: bool) -> Result<(), Problem> {
    // `new/../old` is no place before `new` is made, and `old` once it is.
    let mut begun = PathBuf::new();
    for part in path.components() {
        if part == Component::ParentDir && !begun.as_os_str().is_empty() && !begun.exists() {
            return Err(Problem::input(format!("--out {}: there is no folder {}", path.display(), begun.display())));
        }
        begun.push(part);
    }
    if let Ok(old) = CampaignFolder::open(path) {
        if !resume && !force {
            return Err(Problem::input(format!(
                "{} holds a campaign already: --resume goes on with it, --force replaces it, --out DIR keeps both",
                path.display()
            )));
        }
        if resume {
            let before = read(&old, &[])?;
            let files = || before.attachments.files().into_iter().zip(setup.attachments.files());
            let file = || files().find(|(before, now)| before != now).map(|((name, _), _)| name.to_owned());
            if let Some(key) = first_difference(&before.scenario, &setup.scenario).or_else(file) {
                return Err(Problem::input(format!(
                    "--resume: `{key}` is not what it was when {} was begun: give the same arguments, or another --out",
                    path.display()
                )));
            }
            same_level(&old, setup.simd)?;
        }
    }
    Ok(())
}

fn create(path: &Path, setup: &Setup, resume: bool) -> Result<CampaignFolder, Problem> {
    let folder = CampaignFolder::create(path, if resume { Existing::Resume } else { Existing::Replace })?;
    write_scenario(&folder, setup, setup.simd.level())?;
    Ok(folder)
}

/// Opens a campaign folder for the next part, its scenario changed by `sets` in the tables `allowed`; [`keep_changes`] writes it. Its SIMD level stays:
/// a part that runs kernels (`flown`) goes on at it, or not at all.
pub(crate) fn open(
    path: &Path,
    sets: &[(String, String)],
    allowed: &[&str],
    flown: Option<&Kernels>,
) -> Result<Work, Problem> {
    for (key, _) in sets {
        let table = key.split(['.', '[']).next().unwrap_or_default().trim();
        if !allowed.contains(&table) {
            return Err(Problem::input(format!(
                "--set {key}: the folder's trajectories were made with its value; here only {} can be set",
                allowed.join(", ")
            )));
        }
    }
    let folder = CampaignFolder::open_to_write(path)?;
    let level = level(&folder)?;
    let setup = read(&folder, sets)?.with_simd(simd_of(level.as_deref()));
    check_command(&setup.scenario)?;
    let plans = |scenario: &Scenario| {
        let of_plans = scenario.vary().iter().filter(|(key, _)| vary::shapes_the_plan(key));
        of_plans.map(|(key, drawn)| (key.clone(), drawn.clone())).collect::<Vec<_>>()
    };
    if !sets.is_empty() && plans(&setup.scenario) != plans(&read(&folder, &[])?.scenario) {
        return Err(Problem::input(
            "--set vary: the folder's trajectories were drawn by its keys under `task` and `generate`; these must stay",
        ));
    }
    if let Some(kernels) = flown {
        // The users' own programs run none of our kernels.
        match (kernels.portable, setup.scenario.executor().command) {
            (true, _) => same_level(&folder, Simd::Portable)?,
            (false, None) => same_level(&folder, setup.simd)?,
            (false, Some(_)) => {}
        }
    }
    Ok(Work { folder, setup })
}

/// Writes the scenario of `work` as [`open`] changed it.
pub(crate) fn keep_changes(work: &Work) -> Result<(), Problem> {
    let level = level(&work.folder)?;
    write_scenario(&work.folder, &work.setup, level.as_deref().unwrap_or(work.setup.simd.level()))
}

/// The first key of the folder's scenario that `sets` change.
pub(crate) fn changed_by(folder: &CampaignFolder, sets: &[(String, String)]) -> Result<Option<String>, Problem> {
    Ok(first_difference(&read(folder, &[])?.scenario, &read(folder, sets)?.scenario))
}

/// Opens a campaign folder to read it.
pub(crate) fn look(path: &Path) -> Result<Work, Problem> {
    let folder = CampaignFolder::open(path)?;
    let setup = read(&folder, &[])?.with_simd(simd_of(level(&folder)?.as_deref()));
    Ok(Work { folder, setup })
}

fn read(folder: &CampaignFolder, sets: &[(String, String)]) -> Result<Setup, Problem> {
    let name = folder.file("scenario.toml");
    Ok(read_setup(&folder.read_scenario()?, &name.to_string_lossy(), folder.path(), sets)?)
}

/// The version of the kernels that goes on with a campaign of `level`.
fn simd_of(level: Option<&str>) -> Simd {
    if level == Some(Simd::Portable.level()) { Simd::Portable } else { Simd::Widest }
}

/// The SIMD level at which the campaign of a folder was begun, if that is written there.
fn level(folder: &CampaignFolder) -> Result<Option<String>, Problem> {
    Ok(read_made_by(&folder.read_scenario()?).map(|made_by| made_by.simd))
}

/// Refuses to go on in `folder` at another SIMD level: the bits would be the same, but what is written of their origin
/// would not be true.
fn same_level(folder: &CampaignFolder, simd: Simd) -> Result<(), Problem> {
    let (now, path) = (simd.level(), folder.path().display());
    match level(folder)? {
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

/// Writes the resolved scenario, with what the results depend on beside it.
fn write_scenario(folder: &CampaignFolder, setup: &Setup, level: &str) -> Result<(), Problem> {
    let root_seed = setup.scenario.seed();
    let made_by = MadeBy { version: env!("CARGO_PKG_VERSION").into(), root_seed, simd: level.into() };
    let text = scenario::to_toml(&setup.scenario, Some(&made_by)).map_err(Problem::input)?;
    // First the files, then what says that there are such.
    for (file, bytes) in setup.attachments.files() {
        atomic::write(&folder.file(file), bytes)?;
    }
    Ok(folder.write_scenario(&text)?)
}

/// `key=value` as typed; the value may hold further signs of equality.
pub(crate) fn split(sets: &[String]) -> Result<Vec<(String, String)>, Problem> {
    let one = |set: &String| match set.split_once('=') {
        Some((key, value)) => Ok((key.trim().to_owned(), value.trim().to_owned())),
        None => Err(Problem::input(format!("--set {set}: must be KEY=VALUE, such as --set execute.repeat=5"))),
    };
    sets.iter().map(one).collect()
}

/// `--executor COMMAND` as the scenario key it sets. JSON's strings are TOML's.
pub(crate) fn as_command(command: &str) -> (String, String) {
    ("execute.command".to_owned(), serde_json::Value::from(command).to_string())
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

/// The first key in which two scenarios differ.
fn first_difference(a: &Scenario, b: &Scenario) -> Option<String> {
    differences(a, b).into_iter().next()
}

/// The keys in which two scenarios differ.
pub(crate) fn differences(a: &Scenario, b: &Scenario) -> Vec<String> {
    fn differ(key: &str, a: &serde_json::Value, b: &serde_json::Value, found: &mut Vec<String>) {
        match (a.as_object(), b.as_object()) {
            (Some(a), Some(b)) => {
                let null = serde_json::Value::Null;
                for name in a.keys().chain(b.keys().filter(|key| !a.contains_key(*key))) {
                    let dotted = if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
                    differ(&dotted, a.get(name).unwrap_or(&null), b.get(name).unwrap_or(&null), found);
                }
            }
            _ if a != b => found.push(key.to_owned()),
            _ => {}
        }
    }
    let value = |scenario| serde_json::to_value(scenario).unwrap_or_default();
    let mut found = Vec::new();
    differ("", &value(a), &value(b), &mut found);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_named_after_scenarios() {
        assert_eq!(default_folder("quadrotor.toml"), Path::new("out/quadrotor"));
        assert_eq!(default_folder("/a/b/my.drone.toml"), Path::new("out/my.drone"));
        assert_eq!(default_folder("anafi"), Path::new("out/anafi"));
    }

    #[test]
    fn sets_are_split_at_the_first_sign_of_equality() {
        assert_eq!(split(&["a.b = c=d".into()]).unwrap(), [("a.b".to_owned(), "c=d".to_owned())]);
        assert!(split(&["a.b".into()]).is_err());
        assert_eq!(as_command("sh -c \"x\""), ("execute.command".to_owned(), r#""sh -c \"x\"""#.to_owned()));
    }
}
