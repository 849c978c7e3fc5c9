//! Runs are flown once and by whom they were begun, and what takes their place is looked at before they go.

use hairpin::math::simd::Simd;

use super::*;
use crate::Unwatched;
use crate::export::{Export, ExportSettings, Format};
use crate::judge_log::{Against, LogSettings, judge_log};
use crate::sets::Set;
use crate::testing::{Told, generated, program};

#[test]
fn runs_are_flown_once_and_resumed() {
    let (_place, folder) = generated();
    let settings = ExecuteSettings { folder, ..ExecuteSettings::default() };
    let executed = execute(&settings, &Unwatched).map(|executed| (executed.cases, executed.flown)).unwrap();
    assert_eq!(
        executed,
        (2, Flown { runs: 2, failed: 0, never_asked: 0, attitude_unknown: 0, end_unsaid: 0, heights_by_map: 0 })
    );
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
    let log = LogSettings::new(folder.join("0000-0.csv"), Against::Campaign(folder.clone()));
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
        Flown { runs: 2, failed: 0, never_asked: 0, attitude_unknown: 0, end_unsaid: 0, heights_by_map: 0 }
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
    let settings = ExecuteSettings { folder: folder.clone(), missions: Some(missions), ..ExecuteSettings::default() };
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
    let [points, missions, folder, other] = ["p.csv", "way.csv", "arm", "other"].map(|name| place.path().join(name));
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
