use std::path::{Path, PathBuf};

use hairpin::campaign::learn::{LegSample, ScoreModel};
use hairpin::campaign::samples::{self, leg_samples};
use hairpin::judgement::Stress;

use super::alike::open_alike;
use super::learn;
use super::pooled::pooled;
use crate::Unwatched;
use crate::execute::{ExecuteSettings, execute, runs_to_judge};
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
    let works = open_alike(&folders).unwrap();
    // The union: the cases of one, then those of the other as number 7 and so on.
    let mut union = Vec::new();
    for (work, before) in works.iter().zip([0, 7]) {
        for mut case in work.folder.read_cases().unwrap() {
            let runs = runs_to_judge(work, &case).unwrap().runs;
            case.number.0 += before;
            union.extend(leg_samples(&work.setup, &case, &runs, Stress::MaxDeviation));
        }
    }
    assert_eq!(pooled::<LegSample>(&works, Stress::MaxDeviation).unwrap(), union);
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
    // Executed or measured otherwise: one leg would have two stresses.
    for (name, key, value, told) in [
        ("e", "execute.noise", "true", "its `execute.noise` is true, and that of "),
        ("f", "execute.fixed_velocity_m_s", "3.0", "its `execute.fixed_velocity_m_s` is 3.0, and that of "),
        ("g", "world.wind_m_s", "[1.0, 0.0, 0.0]", "its `world.wind_m_s` is [1.0,0.0,0.0], and that of "),
        ("h", "spec.deviation.from", "\"path\"", "its `spec.deviation.from` is \"path\", and that of "),
    ] {
        let otherwise = refused(&flown(&place, name, (3, 1), (key, value)));
        assert!(otherwise.contains(told), "{otherwise}");
    }
    // More of the same runs, or fewer, are a copy.
    let copy = refused(&flown(&place, "i", (1, 9), ("execute.repeat", "2")));
    let told = "case 0000 is case 0000 of ";
    assert!(
        copy.contains(told) && copy.ends_with("executed to the same numbers: what it says would count twice"),
        "{copy}"
    );
}

#[test]
fn what_is_missing_is_told() {
    let refused = |folder: &Path| {
        let learned = learn(&[folder.to_owned()], &folder.join("model.json"), Stress::MaxDeviation);
        learned.map(|_| ()).unwrap_err().to_string()
    };
    let (_place, folder) = generated();
    assert!(refused(&folder).contains("nothing was executed"));
    std::fs::remove_file(folder.join("waypoints.parquet")).unwrap();
    assert!(refused(&folder).contains("nothing to learn from: no case was generated"));
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
