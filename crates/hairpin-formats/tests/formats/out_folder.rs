//! A campaign folder comes back as it was written, refuses what is not its own, and survives being killed.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::out_campaign::{campaign, planned};
use hairpin::campaign::{Case, CaseNumber, Run, Tally, Witness};
use hairpin_formats::folder::{CampaignFolder, Existing, FolderError, Landed};
use hairpin_formats::parquet::runs::{self, RunFacts};
use hairpin_formats::parquet::track;

const PART: &str = "executions/part-00000.parquet";
const PART_OF_RUNS: &str = "runs/part-00000.parquet";

fn written(path: &Path) -> CampaignFolder {
    let campaign = campaign();
    let folder = CampaignFolder::create(path, Existing::Replace).unwrap();
    folder.write_scenario("hairpin = 1\n").unwrap();
    folder.write_tally(&campaign.tally).unwrap();
    let pack = |case: &Case| (case.number, track::planned(case.number, &planned(case)).unwrap());
    folder.write_planned(campaign.cases.iter().map(pack).collect()).unwrap();
    folder.write_cases(&campaign.cases).unwrap();
    land(&folder, campaign.runs.iter());
    folder.write_results(&campaign.cases, &campaign.results).unwrap();
    folder
}

/// Runs land in the order given.
fn land<'r>(folder: &CampaignFolder, runs: impl Iterator<Item = &'r Run> + Clone) {
    let writer = folder.write_runs(3, runs.clone().map(|run| (run.case, run.run)));
    runs.for_each(|run| writer.land(Landed::of(run, &BTreeSet::new()).unwrap()).unwrap());
    writer.finish().unwrap();
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
    for case in &campaign.cases {
        let expected: Vec<_> = campaign.runs.iter().filter(|run| run.case == case.number).cloned().collect();
        assert_eq!(folder.read_runs(case.number).unwrap(), expected, "what is not measured is kept whole");
        let (read, planned) = (folder.read_planned(case.number).unwrap(), planned(case));
        assert_eq!(read.len(), planned.len());
        for row in 0..read.len() {
            assert!((read.position(row) - planned.position(row)).norm() < 1e-4);
        }
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

/// A case that is nowhere in the results would be judged by nobody, be it the only one that violates.
#[test]
fn results_that_lost_cases_are_refused_once_the_search_is_over() {
    let place = tempfile::tempdir().unwrap();
    let (folder, campaign) = (written(place.path()), campaign());
    for kept in [0, 2] {
        folder.write_results(&campaign.cases[..kept], &[]).unwrap();
        folder.write_tally(&Tally { complete: false, ..campaign.tally.clone() }).unwrap();
        assert_eq!(folder.read_cases().unwrap().len(), kept, "a kill amid a checkpoint costs no more");
        folder.write_tally(&Tally { complete: true, ..campaign.tally.clone() }).unwrap();
        let told = folder.read_cases().unwrap_err().to_string();
        assert!(told.contains(&format!("waypoints.parquet: case 000{kept} is not in results.parquet")), "{told}");
    }
}

#[test]
fn the_same_campaign_is_the_same_bytes() {
    let (first, second) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    drop((written(first.path()), written(second.path())));
    for name in [
        "results.parquet",
        "waypoints.parquet",
        PART_OF_RUNS,
        "profiles/part-00000.parquet",
        PART,
        "trajectories/part-00000.parquet",
    ] {
        assert_eq!(fs::read(first.path().join(name)).unwrap(), fs::read(second.path().join(name)).unwrap(), "{name}");
    }
}

#[test]
fn a_run_is_valid_only_if_it_is_whole() {
    let place = tempfile::tempdir().unwrap();
    drop(written(place.path()));
    let reopened = || CampaignFolder::open(place.path()).unwrap();
    assert!(reopened().has_valid_run(CaseNumber(0), 1));
    assert!(reopened().has_valid_run(CaseNumber(1), 0), "a failed executor is an answer as well");
    assert!(!reopened().has_valid_run(CaseNumber(0), 9));
    let (part, facts) = (place.path().join(PART), place.path().join(PART_OF_RUNS));
    let bytes = fs::read(&part).unwrap();
    fs::write(&part, &bytes[..bytes.len() / 2]).unwrap();
    assert!(!reopened().has_valid_run(CaseNumber(0), 1));
    assert!(reopened().has_valid_run(CaseNumber(1), 0), "of what was not flown no motion is missed");
    fs::remove_file(&part).unwrap();
    let told = reopened().read_runs(CaseNumber(0)).unwrap_err();
    assert!(matches!(told, FolderError::Contradiction { case: CaseNumber(0), .. }), "{told}");
    fs::remove_file(&facts).unwrap();
    fs::write(&part, bytes).unwrap();
    assert!(!reopened().has_valid_run(CaseNumber(0), 1), "nothing says how it ended");
}

/// A motion that lost its end would be exported, drawn and measured as one that ended earlier.
#[test]
fn a_motion_that_lost_its_last_rows_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let folder = written(place.path());
    let known = campaign().cases.into_iter().flat_map(|case| folder.facts_of(case.number).unwrap());
    // As if each had flown a hundredth of a second longer than its rows go.
    let longer = known.map(|facts| RunFacts { end_s: facts.end_s.map(|end| end + 0.01), ..facts });
    runs::write_facts(&place.path().join(PART_OF_RUNS), &longer.collect::<Vec<_>>()).unwrap();
    let reopened = CampaignFolder::open(place.path()).unwrap();
    let told = reopened.read_runs(CaseNumber(0)).unwrap_err().to_string();
    assert!(told.contains("the last rows are missing"), "{told}");
    assert_eq!(reopened.read_runs(CaseNumber(1)).unwrap().len(), 1, "what was not flown has no rows");
}

/// Whatever the order in which runs land, and whatever an interruption left, the files are the same.
#[test]
fn runs_land_in_any_order_and_go_on() {
    let (first, second) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    drop(written(first.path()));
    let campaign = campaign();
    let folder = CampaignFolder::create(second.path(), Existing::Replace).unwrap();
    folder.write_scenario("hairpin = 1\n").unwrap();
    let begun = |runs: &[&Run]| {
        let writer = folder.write_runs(3, campaign.runs.iter().map(|run| (run.case, run.run)));
        runs.iter().for_each(|run| writer.land(Landed::of(run, &BTreeSet::new()).unwrap()).unwrap());
        writer.finish().unwrap();
    };
    let (late, early): (Vec<&Run>, Vec<&Run>) = campaign.runs.iter().rev().partition(|run| run.run == 1);
    begun(&early);
    let reopened = CampaignFolder::open(second.path()).unwrap();
    assert!(reopened.has_valid_run(CaseNumber(2), 0) && !reopened.has_valid_run(CaseNumber(0), 1));
    begun(&late);
    for name in [PART, PART_OF_RUNS] {
        assert_eq!(fs::read(first.path().join(name)).unwrap(), fs::read(second.path().join(name)).unwrap(), "{name}");
    }
}

/// A table may be one file, and a data frame may have written it, its rows in one group.
#[test]
fn another_writers_table_is_read() {
    use arrow_select::concat::concat_batches;
    use parquet::arrow::ArrowWriter;
    use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
    use parquet::file::properties::WriterProperties;
    let place = tempfile::tempdir().unwrap();
    drop(written(place.path()));
    let campaign = campaign();
    let part = place.path().join(PART);
    let reader = ParquetRecordBatchReaderBuilder::try_new(fs::File::open(&part).unwrap()).unwrap();
    assert_eq!(reader.metadata().num_row_groups(), 4, "a group for each run that was flown");
    let schema = reader.schema().clone();
    let batches: Vec<_> = reader.build().unwrap().map(Result::unwrap).collect();
    let whole = concat_batches(&schema, &batches).unwrap();
    fs::remove_file(&part).unwrap();
    // All rows in one group; groups that run over from one run to the next; several groups a run.
    for rows in [1_000_000, 7, 5] {
        let properties = WriterProperties::builder().set_max_row_group_row_count(Some(rows)).build();
        let single = fs::File::create(place.path().join("executions.parquet")).unwrap();
        let mut writer = ArrowWriter::try_new(single, schema.clone(), Some(properties)).unwrap();
        writer.write(&whole).unwrap();
        writer.close().unwrap();
        let folder = CampaignFolder::open(place.path()).unwrap();
        for run in campaign.runs.iter().filter(|run| run.outcome.is_ok()) {
            assert_eq!(folder.read_run(run.case, run.run).unwrap().as_ref(), Some(run), "{rows} rows a group");
        }
    }
}

/// Folders of earlier versions have a file for each case and run, with what is known of a run in its file's metadata.
#[test]
fn a_file_per_case_and_run_is_read() {
    use parquet::arrow::ArrowWriter;
    use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
    use parquet::file::metadata::KeyValue;
    use parquet::file::properties::WriterProperties;
    let place = tempfile::tempdir().unwrap();
    drop(written(place.path()));
    let campaign = campaign();
    let read = CampaignFolder::open(place.path()).unwrap();
    let plan = read.read_planned(CaseNumber(0)).unwrap();
    // A group of a part without its first columns is what stood in a file.
    let split = |table: &str, keys: usize, name: &dyn Fn(usize) -> (String, Option<String>)| {
        let part = place.path().join(table).join("part-00000.parquet");
        let groups = ParquetRecordBatchReaderBuilder::try_new(fs::File::open(&part).unwrap())
            .unwrap()
            .metadata()
            .num_row_groups();
        for group in 0..groups {
            let reader = ParquetRecordBatchReaderBuilder::try_new(fs::File::open(&part).unwrap()).unwrap();
            let batch = reader.with_row_groups(vec![group]).build().unwrap().next().unwrap().unwrap();
            let batch = batch.project(&(keys..batch.num_columns()).collect::<Vec<_>>()).unwrap();
            let (file, facts) = name(group);
            let notes = facts.map(|facts| vec![KeyValue::new("hairpin.run".to_owned(), facts)]);
            let properties = WriterProperties::builder().set_key_value_metadata(notes).build();
            let file = fs::File::create(place.path().join(table).join(file)).unwrap();
            let mut writer = ArrowWriter::try_new(file, batch.schema(), Some(properties)).unwrap();
            writer.write(&batch).unwrap();
            writer.close().unwrap();
        }
        fs::remove_file(part).unwrap();
    };
    split("profiles", 1, &|_| ("0000.parquet".into(), None));
    split("trajectories", 1, &|case| (format!("{case:04}.parquet"), None));
    let flown: Vec<&Run> = campaign.runs.iter().filter(|run| run.outcome.is_ok()).collect();
    split("executions", 2, &|place| {
        let run = flown[place];
        let flight = run.outcome.as_ref().unwrap();
        let facts = serde_json::json!({
            "case": run.case, "run": run.run, "ended": flight.ended.word(), "message": null,
            "left_world_s": flight.left_world, "reached_s": flight.reached, "drawn": run.drawn,
        });
        (format!("{}-{}.parquet", run.case, run.run), Some(facts.to_string()))
    });
    fs::rename(place.path().join(PART_OF_RUNS), place.path().join("runs.parquet")).unwrap();
    fs::remove_dir(place.path().join("runs")).unwrap();
    let folder = CampaignFolder::open(place.path()).unwrap();
    assert_eq!(folder.read_cases().unwrap(), campaign.cases);
    for run in flown {
        assert_eq!(folder.read_run(run.case, run.run).unwrap().as_ref(), Some(run));
        assert!(folder.has_valid_run(run.case, run.run));
    }
    let stamps = folder.read_planned(CaseNumber(0)).unwrap();
    assert!(stamps.len() <= plan.len() && stamps.times().last() == plan.times().last(), "rows are read as they stand");
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
    assert!(told.contains("profiles") && told.contains("another number of legs"), "{told}");
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
    fs::create_dir(place.path().join("missions")).unwrap();
    fs::write(place.path().join("missions/0000.plan"), "{}").unwrap();
    drop(CampaignFolder::create(place.path(), Existing::Resume).unwrap());
    assert!(place.path().join(PART).exists());
    let folder = CampaignFolder::create(place.path(), Existing::Replace).unwrap();
    assert!(!folder.has_cases() && !folder.has_runs());
    for table in ["executions", "profiles", "runs", "trajectories"] {
        assert!(!place.path().join(table).exists(), "{table}");
    }
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
