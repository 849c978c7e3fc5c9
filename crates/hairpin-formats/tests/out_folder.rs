//! A campaign folder comes back as it was written, refuses what is not its own, and survives being killed.

mod out_campaign;

use std::fs;
use std::path::Path;

use hairpin::campaign::{CaseNumber, Witness};
use hairpin_formats::folder::{CampaignFolder, Existing, FolderError};
use hairpin_formats::parquet::runs::RunFacts;
use out_campaign::{campaign, planned};

fn written(path: &Path) -> CampaignFolder {
    let campaign = campaign();
    let folder = CampaignFolder::create(path, Existing::Replace).unwrap();
    folder.write_scenario("hairpin = 1\n").unwrap();
    folder.write_tally(&campaign.tally).unwrap();
    for case in &campaign.cases {
        folder.write_planned(case.number, &planned(case)).unwrap();
    }
    folder.write_cases(&campaign.cases).unwrap();
    for run in &campaign.runs {
        folder.write_run(run).unwrap();
    }
    folder.write_runs_table(&campaign.runs.iter().map(RunFacts::of).collect::<Vec<_>>()).unwrap();
    folder.write_results(&campaign.cases, &campaign.results).unwrap();
    folder
}

#[test]
fn everything_comes_back_to_the_bit() {
    let place = tempfile::tempdir().unwrap();
    let campaign = campaign();
    drop(written(place.path()));
    let folder = CampaignFolder::open(place.path()).unwrap();
    assert_eq!(folder.read_scenario().unwrap(), "hairpin = 1\n");
    assert_eq!(folder.read_tally().unwrap(), campaign.tally);
    assert_eq!(folder.read_cases().unwrap(), campaign.cases);
    assert_eq!(folder.read_results().unwrap(), campaign.results);
    let table = folder.read_runs_table().unwrap();
    for case in &campaign.cases {
        let expected: Vec<_> = campaign.runs.iter().filter(|run| run.case == case.number).cloned().collect();
        assert_eq!(folder.read_runs(case.number, &table).unwrap(), expected);
        assert_eq!(folder.read_planned(case.number).unwrap(), planned(case));
    }
}

#[test]
fn generated_cases_stand_without_results() {
    let place = tempfile::tempdir().unwrap();
    let folder = CampaignFolder::create(place.path(), Existing::Replace).unwrap();
    folder.write_scenario("hairpin = 1\n").unwrap();
    assert!(!folder.has_cases());
    folder.write_cases(&campaign().cases).unwrap();
    assert!(folder.has_cases());
    assert_eq!(folder.read_cases().unwrap(), campaign().cases);
    assert!(folder.read_results().unwrap().is_empty());
}

#[test]
fn the_same_campaign_is_the_same_bytes() {
    let (first, second) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    drop((written(first.path()), written(second.path())));
    for name in
        ["results.parquet", "waypoints.parquet", "runs.parquet", "profiles/0000.parquet", "executions/0000-1.parquet"]
    {
        assert_eq!(fs::read(first.path().join(name)).unwrap(), fs::read(second.path().join(name)).unwrap(), "{name}");
    }
}

#[test]
fn a_run_is_valid_only_if_it_is_whole_and_the_one_named() {
    let place = tempfile::tempdir().unwrap();
    let folder = written(place.path());
    assert!(folder.has_valid_run(CaseNumber(0), 1));
    assert!(folder.has_valid_run(CaseNumber(1), 0), "a failed executor is an answer as well");
    assert!(!folder.has_valid_run(CaseNumber(0), 9));
    let bytes = fs::read(folder.run_path(CaseNumber(0), 1)).unwrap();
    fs::write(folder.run_path(CaseNumber(0), 1), &bytes[..bytes.len() / 2]).unwrap();
    assert!(!folder.has_valid_run(CaseNumber(0), 1));
    fs::copy(folder.run_path(CaseNumber(0), 0), folder.run_path(CaseNumber(0), 1)).unwrap();
    assert!(!folder.has_valid_run(CaseNumber(0), 1), "run 0 under the name of run 1");
    assert!(matches!(
        folder.read_runs(CaseNumber(0), &folder.read_runs_table().unwrap()),
        Err(FolderError::Contradiction { case: CaseNumber(0), .. })
    ));
}

/// Whoever reads cases walks legs by number: a file that has too few, or times for too many, would be walked beyond its
/// end.
#[test]
fn legs_are_as_many_as_there_are_between_waypoints() {
    let place = tempfile::tempdir().unwrap();
    let folder = written(place.path());
    let mut edited = campaign().cases;
    let Some(Witness::Profile(profile)) = &mut edited[0].witness else { panic!("the first case has a profile") };
    profile.legs.pop();
    folder.write_cases(&edited).unwrap();
    let told = folder.read_cases().unwrap_err().to_string();
    assert!(told.contains("0000.parquet") && told.contains("another number of legs"), "{told}");
    let mut edited = campaign().cases;
    edited[0].leg_times.push(1.0);
    folder.write_cases(&edited).unwrap();
    let told = folder.read_cases().unwrap_err().to_string();
    assert!(told.contains("leg times for another number of legs"), "{told}");
}

#[test]
fn a_coverage_that_does_not_fit_its_grid_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let folder = written(place.path());
    let axis = |edges: &str| format!(r#"{{ "name": "speed", "unit": "m/s", "edges": {edges}, "words": [] }}"#);
    let text = |edges: &str, cells: usize, cell: usize| {
        format!(
            r#"{{ "grid": {{ "axes": [{}] }}, "cells": {cells}, "hit": 1, "cases": {{ "{cell}": 1 }} }}"#,
            axis(edges)
        )
    };
    for (text, fits) in [
        (text("[0, 1, 2]", 2, 1), true),
        (text("[]", 0, 0), false),
        (text("[0]", 0, 0), false),
        (text("[1, 1]", 1, 0), false),
        (text("[0, 1, 2]", 3, 1), false),
        (text("[0, 1, 2]", 2, 2), false),
    ] {
        fs::write(place.path().join("coverage.json"), &text).unwrap();
        let read = folder.read_coverage();
        assert_eq!(read.is_ok(), fits, "{text}: {read:?}");
    }
}

#[test]
fn a_folder_of_somebody_else_is_left_alone() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("thesis.tex"), "x").unwrap();
    let refused = CampaignFolder::create(place.path(), Existing::Replace);
    assert!(matches!(refused, Err(FolderError::Foreign { .. })));
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    assert!(matches!(CampaignFolder::open(place.path()), Err(FolderError::NoCampaign { .. })));
    assert!(matches!(CampaignFolder::open_to_write(&place.path().join("no")), Err(FolderError::NoCampaign { .. })));
}

#[test]
fn one_writer_at_a_time() {
    let place = tempfile::tempdir().unwrap();
    let first = written(place.path());
    assert!(matches!(CampaignFolder::create(place.path(), Existing::Resume), Err(FolderError::Locked { .. })));
    assert!(CampaignFolder::open(place.path()).is_ok(), "readers need no lock");
    drop(first);
    assert!(CampaignFolder::open_to_write(place.path()).is_ok());
}

#[test]
fn a_new_campaign_takes_nothing_over_and_keeps_missions() {
    let place = tempfile::tempdir().unwrap();
    drop(written(place.path()));
    fs::write(place.path().join("missions/0000.plan"), "{}").unwrap();
    drop(CampaignFolder::create(place.path(), Existing::Resume).unwrap());
    assert!(place.path().join("executions/0000-0.parquet").exists());
    let folder = CampaignFolder::create(place.path(), Existing::Replace).unwrap();
    assert!(
        !folder.has_cases()
            && !folder.run_path(CaseNumber(0), 0).exists()
            && !folder.profile_path(CaseNumber(0)).exists()
    );
    assert!(place.path().join("missions/0000.plan").exists());
}

#[test]
fn what_a_killed_writer_left_is_ignored_and_cleared() {
    let place = tempfile::tempdir().unwrap();
    drop(written(place.path()));
    let before = fs::read(place.path().join("results.parquet")).unwrap();
    for name in [".hairpin-a1B2c3.tmp", "executions/.hairpin-d4E5f6.tmp"] {
        fs::write(place.path().join(name), &before[..before.len() / 2]).unwrap();
    }
    let folder = CampaignFolder::open(place.path()).unwrap();
    assert_eq!(folder.read_results().unwrap(), campaign().results);
    drop(CampaignFolder::open_to_write(place.path()).unwrap());
    assert!(!place.path().join(".hairpin-a1B2c3.tmp").exists());
    assert!(!place.path().join("executions/.hairpin-d4E5f6.tmp").exists());
    assert_eq!(fs::read(place.path().join("results.parquet")).unwrap(), before);
}

#[test]
fn a_place_that_cannot_be_written_is_named() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("file");
    fs::write(&file, "x").unwrap();
    let error = CampaignFolder::create(&file.join("out"), Existing::Replace).unwrap_err();
    assert!(error.to_string().contains("file/out"), "{error}");
    assert!(matches!(error, FolderError::Write(_)));
}
