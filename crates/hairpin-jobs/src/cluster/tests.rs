//! One campaign, in whatever parts, order and number of goes.

use std::fs;
use std::path::{Path, PathBuf};

use super::*;
use crate::consent::Consent;
use crate::sets::Set;
use crate::stress::stress;
use crate::testing::{program, small_hull};
use crate::work::CampaignSettings;
use crate::{Problem, Unwatched};

fn set(key: &str, value: &str) -> Set {
    (key.to_owned(), value.to_owned())
}

fn settings(scenario: &str, out: &Path, more: &[Set]) -> CampaignSettings {
    let mut sets = vec![set("execute.baseline", "2")];
    sets.extend_from_slice(more);
    CampaignSettings { scenario: scenario.into(), out: Some(out.into()), sets, ..CampaignSettings::default() }
}

fn on_one_machine(settings: &CampaignSettings) -> String {
    stress(settings, None, &Unwatched).unwrap().work.folder.content_hash().unwrap()
}

fn planned(settings: &CampaignSettings, parts: Option<u64>) -> (PathBuf, Plan) {
    let (work, plan) = plan(&PlanSettings { campaign: settings.clone(), cases: None, parts }, &Unwatched).unwrap();
    (work.folder.path().to_owned(), plan)
}

fn run(folder: &Path, shards: &[&str]) -> Vec<Ran> {
    let one = |text: &&str| run_shard(folder, text.parse().unwrap(), &Consent::default(), &Unwatched).unwrap();
    shards.iter().map(one).collect()
}

fn merged(folder: &Path) -> Result<(String, usize), Problem> {
    merge(folder, &Consent::default(), &Unwatched).map(|merged| (merged.content_hash, merged.taken))
}

#[test]
fn any_shards_in_any_order_are_one_machine() {
    let place = tempfile::tempdir().unwrap();
    let more = [set("generate.search.cases", "5"), set("execute.repeat", "2")];
    let one = on_one_machine(&settings("demo-quadrotor", &place.path().join("one"), &more));
    let (folder, plan) = planned(&settings("demo-quadrotor", &place.path().join("many"), &more), None);
    assert_eq!((plan.parts, plan.units), (5, 5));
    let missing = merged(&folder).unwrap_err().to_string();
    assert!(missing.contains("5 of 5 parts") && missing.contains("part-00000"), "{missing}");
    run(&folder, &["3/3", "1/3"]);
    let missing = merged(&folder).unwrap_err().to_string();
    assert!(missing.contains("2 of 5 parts") && missing.contains("part-00001, part-00004"), "{missing}");
    // What a killed process was making, and a part that was spoiled.
    fs::create_dir(folder.join("parts/.hairpin-killed.tmp")).unwrap();
    fs::write(folder.join("parts/part-00002/results.parquet"), "no table").unwrap();
    let ran = run(&folder, &["2/3", "3/3"]);
    assert_eq!(ran.iter().map(|ran| (ran.parts, ran.made)).collect::<Vec<_>>(), [(2, 2), (1, 1)]);
    assert_eq!(merged(&folder).unwrap(), (one.clone(), 10));
    assert!(!folder.join("parts/.hairpin-killed.tmp").exists());
    // Once more, with other shards: all is there.
    assert_eq!(run(&folder, &["1/2"])[0].made, 0);
    assert_eq!(merged(&folder).unwrap().0, one);
}

#[test]
fn graphs_without_a_case_move_the_numbers_of_those_behind() {
    let place = tempfile::tempdir().unwrap();
    let scenario = small_hull(place.path());
    // Three of its first six graphs have no trajectory.
    let more = [set("generate.search.cases", "6")];
    let one = on_one_machine(&settings(&scenario, &place.path().join("one"), &more));
    let (folder, _) = planned(&settings(&scenario, &place.path().join("many"), &more), None);
    run(&folder, &["3/3", "2/3", "1/3"]);
    let (hash, first) = merged(&folder).unwrap();
    assert_eq!(hash, one);
    // A second time all parts know those before them.
    run(&folder, &["1/3", "2/3", "3/3"]);
    let (hash, second) = merged(&folder).unwrap();
    assert_eq!(hash, one);
    assert_eq!((first, second), (2, 3));
}

/// Shards whose programs are two, or two versions of one, make no campaign, and their parts stay as they are.
#[test]
fn parts_that_two_programs_flew_are_not_put_together() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("sim.py");
    let allowing = Consent { allow_commands: true, ..Consent::default() };
    let fly = |folder: &Path, shard: &str, says: &str| {
        program(&file, says);
        run_shard(folder, shard.parse().unwrap(), &allowing, &Unwatched).unwrap();
    };
    let command = program(&file, "name=\"sim\", version=1");
    let more = [command, set("generate.search.cases", "2"), set("execute.repeat", "1"), set("execute.baseline", "0")];
    let (folder, _) = planned(&settings("demo-quadrotor", &place.path().join("two"), &more), None);
    fly(&folder, "1/2", "name=\"sim\", version=1");
    fly(&folder, "2/2", "name=\"sim\", version=2");
    let refused = merge(&folder, &allowing, &Unwatched).map(drop).unwrap_err().to_string();
    let told = ["part-00000 was executed by `sim`, version `1`", "part-00001 by `sim`, version `2`"];
    assert!(told.iter().all(|words| refused.contains(words)), "{refused}");
    fs::remove_dir_all(folder.join("parts/part-00001")).unwrap();
    fly(&folder, "2/2", "name=\"sim\", version=1");
    assert_eq!(merge(&folder, &allowing, &Unwatched).unwrap().taken, 2);
}

/// A search that learns, by each method that does, small.
fn learning(method: &str) -> [Set; 3] {
    let search = format!("{{ method = \"{method}\", waypoints = 80, cases = 2, executions = 24 }}");
    [set("generate.search", &search), set("execute.repeat", "1"), set("execute.baseline", "0")]
}

#[test]
fn searches_that_learn_are_shared_round_by_round() {
    let place = tempfile::tempdir().unwrap();
    let scenario = small_hull(place.path());
    for method in ["worst", "adaptive"] {
        let more = learning(method);
        let at = |name: &str| place.path().join(format!("{method}-{name}"));
        let one = on_one_machine(&settings(&scenario, &at("one"), &more));
        // Side by side, and one after the other, the last one first.
        let (folder, plan) = planned(&settings(&scenario, &at("many"), &more), None);
        assert_eq!((plan.parts, plan.unit), (3, Unit::Rounds));
        std::thread::scope(|scope| {
            for shard in ["3/3", "1/3", "2/3"] {
                let folder = &folder;
                scope.spawn(move || run(folder, &[shard]));
            }
        });
        assert!(folder.join("parts").read_dir().unwrap().count() > 3);
        assert_eq!(merged(&folder).unwrap(), (one.clone(), 2), "{method}");
        assert_eq!(folder.join("parts").read_dir().unwrap().count(), 3, "rounds are not needed any more");
        let (folder, _) = planned(&settings(&scenario, &at("last"), &more), None);
        let ran = run(&folder, &["2/2", "1/2"]);
        assert_eq!(ran.iter().map(|ran| (ran.made, ran.cases)).collect::<Vec<_>>(), [(1, 1), (1, 1)]);
        assert_eq!(merged(&folder).unwrap(), (one, 2), "{method}");
    }
}

#[test]
fn one_search_is_one_part() {
    let place = tempfile::tempdir().unwrap();
    // A clock ends it: nobody can follow where it was.
    let search = "{ method = \"worst\", waypoints = 80, cases = 2, seconds = 0.2 }";
    let more = [set("generate.search", search), set("execute.repeat", "1"), set("execute.baseline", "0")];
    let scenario = small_hull(place.path());
    let (folder, plan) = planned(&settings(&scenario, &place.path().join("many"), &more), None);
    assert_eq!((plan.parts, plan.unit, plan.told().is_some()), (3, Unit::Search, true));
    // The second flies a case of a search that is not there yet, and leaves it to whoever comes after.
    let ran = run(&folder, &["2/2", "1/2"]);
    assert!(ran[0].told.is_some() && (ran[0].cases, ran[1].cases) == (0, 1), "{ran:?}");
    let (hash, taken) = merged(&folder).unwrap();
    let again = run(&folder, &["2/2", "1/2"]);
    assert_eq!(again.iter().map(|ran| (ran.made, ran.cases)).collect::<Vec<_>>(), [(1, 1), (0, 1)]);
    assert_eq!((merged(&folder).unwrap(), taken), ((hash, 2), 1));
    let changed = fs::read_to_string(folder.join("scenario.toml")).unwrap().replace("seconds = 0.2", "seconds = 0.3");
    fs::write(folder.join("scenario.toml"), changed).unwrap();
    assert!(merged(&folder).unwrap_err().to_string().contains("not what it was"));
}

/// A part of another scenario is none of the campaign, whatever it says of itself.
#[test]
fn a_part_of_another_scenario_is_missing() {
    let place = tempfile::tempdir().unwrap();
    let [ours, theirs] = ["1", "2"].map(|seed| {
        let more = [set("generate.search.cases", "2"), set("execute.repeat", "1"), set("seed", seed)];
        let (folder, plan) = planned(&settings("demo-quadrotor", &place.path().join(seed), &more), None);
        run(&folder, &["1/1"]);
        (folder.join("parts/part-00000"), plan.hash)
    });
    fs::remove_dir_all(&ours.0).unwrap();
    fs::rename(&theirs.0, &ours.0).unwrap();
    let part = ours.0.join("part.json");
    let told = fs::read_to_string(&part).unwrap().replace(&theirs.1, &ours.1);
    assert!(told.contains(&ours.1));
    fs::write(part, told).unwrap();
    let refused = merged(&place.path().join("1")).unwrap_err().to_string();
    assert!(refused.contains("1 of 2 parts") && refused.contains("part-00000"), "{refused}");
    assert_eq!(run(&place.path().join("1"), &["1/1"])[0].made, 1);
    merged(&place.path().join("1")).unwrap();
}

/// A run that no program could be started for is nothing that was found out: the shard says so, and flies it when it is
/// run again.
#[cfg(unix)]
#[test]
fn what_no_program_was_asked_for_is_flown_by_the_same_shard_again() {
    use std::os::unix::fs::PermissionsExt;

    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("sim.py");
    program(&file, "name=\"sim\", version=1");
    let text = format!("#!/usr/bin/env python3\n{}", fs::read_to_string(&file).unwrap());
    fs::remove_file(&file).unwrap();
    let command = set("execute.command", &format!("\"'{}'\"", file.display()));
    let search = "{ method = \"uniform\", waypoints = 60, cases = 2 }";
    let more = [command, set("generate.search", search), set("execute.repeat", "1"), set("execute.baseline", "0")];
    let (folder, _) = planned(&settings("demo-quadrotor", &place.path().join("many"), &more), None);
    let allowing = Consent { allow_commands: true, ..Consent::default() };
    let run = || {
        let ran = run_shard(&folder, "1/1".parse().unwrap(), &allowing, &Unwatched).unwrap();
        (ran.made, ran.cases, ran.failed, ran.never_asked)
    };
    assert_eq!((run(), run()), ((2, 2, 2, 2), (2, 2, 2, 2)), "not there");
    fs::write(&file, text).unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).unwrap();
    assert_eq!((run(), run()), ((2, 2, 0, 0), (0, 2, 0, 0)), "there");
    // What a program failed at is kept, as it is by one machine.
    for part in ["part-00000", "part-00001"] {
        fs::remove_dir_all(folder.join("parts").join(part)).unwrap();
    }
    fs::write(&file, fs::read_to_string(&file).unwrap().replace("fly(message)", "sys.exit(3)")).unwrap();
    assert_eq!((run(), run()), ((2, 2, 2, 0), (0, 2, 2, 0)), "and fails");
}

/// Where nobody's program flew anything, nothing is kept that a program which is mended would be told by.
#[test]
fn a_search_in_vain_begins_anew_with_a_program_that_flies() {
    let place = tempfile::tempdir().unwrap();
    let scenario = small_hull(place.path());
    let file = place.path().join("sim.py");
    let command = program(&file, "name=\"sim\", version=1");
    let healthy = fs::read_to_string(&file).unwrap();
    let more = [learning("worst").to_vec(), vec![command]].concat();
    let (folder, _) = planned(&settings(&scenario, &place.path().join("many"), &more), None);
    let allowing = Consent { allow_commands: true, ..Consent::default() };
    let run = || run_shard(&folder, "1/1".parse().unwrap(), &allowing, &Unwatched);
    for breaks in [healthy.replace("fly(message)", "sys.exit(3)"), "import sys\nsys.exit(3)\n".into()] {
        fs::write(&file, breaks).unwrap();
        for _ in 0..2 {
            assert!(matches!(run(), Err(Problem::Executor(_))));
        }
    }
    fs::write(&file, healthy).unwrap();
    let ran = run().unwrap();
    assert_eq!((ran.cases, ran.failed), (2, 0));
}
