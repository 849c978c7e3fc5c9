//! From settings to a campaign that may begin, and its beginning.

use std::path::{Path, PathBuf};

use hairpin::campaign::scenario::Mistake;
use hairpin::campaign::{PassedOver, Setup, Tally, UserCode, vary};
use hairpin_formats::recordings;
use hairpin_formats::scenario::{check_asked, kept_in, setup_for, shadowed};

use super::asked::{check_command, tell_share};
use super::campaign::Work;
use super::place::{create, may_make};
use super::settings::{CampaignSettings, IfThere};
use crate::consent::{Consent, Wish};
use crate::spelling::check_names;
use crate::watch::not_waiting_for;
use crate::{Deadline, Problem, Watch};

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
    for PassedOver { key, value, why } in setup.passed_over() {
        watch.warn(&format!("`{key}` = {value} is passed over: {why}"));
    }
    let goes_on = may_make(&path, &setup, settings.if_there)?;
    // What was begun before such scores were refused may be finished.
    if let Some(given) = setup.attachments.own_score(setup.scenario.score()).filter(|_| !goes_on) {
        let refused = |Mistake { key, value, bound }| Problem::input(format!("`{key}` = {value}: must be {bound}"));
        setup.scenario.check_score(given).map_err(refused)?;
    }
    let code = setup.user_code().into_iter().chain(setup.steering_code());
    try_out(code, Deadline::after(settings.time_limit_s), watch)?;
    Ok(Planned { path, setup, if_there: settings.if_there, consent: settings.consent.clone() })
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

/// `out/NAME`, NAME being the scenario's or robot's without folder and ending.
fn default_folder(scenario: &str) -> PathBuf {
    let name = Path::new(scenario).file_stem().unwrap_or_else(|| "campaign".as_ref());
    Path::new("out").join(name)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use hairpin::campaign::user_score::LegFacts;
    use hairpin::campaign::{CallersCode, LegScorer};

    use super::*;
    use crate::Unwatched;
    use crate::sets::Set;
    use crate::testing::Told;
    use crate::work::{make, open_to_read};

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
