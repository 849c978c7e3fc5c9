//! Tables from other writers are understood, and broken ones answered with file, column, row and value.

#[allow(dead_code)]
#[path = "formats/out_campaign/mod.rs"]
mod out_campaign;

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::Path;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_cast::cast;
use arrow_schema::{DataType, Field, Schema};
use hairpin::campaign::{Case, CaseNumber, Run};
use hairpin::math::random::case_seed;
use hairpin_formats::folder::{CampaignFolder, Existing, Landed};
use hairpin_formats::parquet::part_writer::write_one;
use hairpin_formats::parquet::{TableError, profile, results, runs, track};
use out_campaign::campaign;
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::properties::WriterProperties;

/// Rewrites a file as another program might: other types, small row groups, another codec, no metadata.
fn rewrite(path: &Path, change: impl Fn(&str, &ArrayRef) -> Option<ArrayRef>) {
    let reader = ParquetRecordBatchReaderBuilder::try_new(File::open(path).unwrap()).unwrap().build().unwrap();
    let batches: Vec<_> = reader.collect::<Result<_, _>>().unwrap();
    let batch = &batches[0];
    let columns: Vec<(String, ArrayRef)> = batch
        .schema()
        .fields()
        .iter()
        .zip(batch.columns())
        .filter_map(|(field, column)| change(field.name(), column).map(|column| (field.name().clone(), column)))
        .collect();
    let fields: Vec<Field> = columns.iter().map(|(n, c)| Field::new(n, c.data_type().clone(), true)).collect();
    let batch = RecordBatch::try_new(Arc::new(Schema::new(fields)), columns.into_iter().map(|(_, c)| c).collect());
    let properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .set_max_row_group_row_count(Some(7))
        .build();
    let batch = batch.unwrap();
    let mut writer = ArrowWriter::try_new(File::create(path).unwrap(), batch.schema(), Some(properties)).unwrap();
    writer.write(&batch).unwrap();
    writer.close().unwrap();
}

fn write_profile(path: &Path, case: &Case) {
    write_one(path, "profile", profile::piece(case.number, case.profile().unwrap()).unwrap()).unwrap();
}

fn write_run(path: &Path, run: &Run) {
    write_one(path, "execution", runs::piece(run, &BTreeSet::new()).unwrap().unwrap()).unwrap();
}

fn as_type(column: &ArrayRef, kind: DataType) -> Option<ArrayRef> {
    Some(cast(column, &kind).unwrap())
}

fn dictionary() -> DataType {
    DataType::Dictionary(Box::new(DataType::Int32), Box::new(DataType::Utf8))
}

#[test]
fn profiles_survive_another_writer() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("0000.parquet");
    let witness = campaign().cases[0].profile().cloned().unwrap();
    write_one(&path, "profile", profile::piece(CaseNumber(0), &witness).unwrap()).unwrap();
    rewrite(&path, |name, column| match name {
        "leg" => as_type(column, DataType::Int16),
        "axis" => as_type(column, dictionary()),
        "t0_s" => None,
        _ => Some(column.clone()),
    });
    assert_eq!(profile::read(&path).unwrap(), witness);
    rewrite(&path, |name, column| match name {
        "leg" => as_type(column, DataType::Float64),
        "axis" => as_type(column, DataType::LargeUtf8),
        _ => as_type(column, DataType::Float32),
    });
    let single = profile::read(&path).unwrap();
    assert!((single.duration() - witness.duration()).abs() < 1e-6);
}

#[test]
fn results_and_runs_survive_another_writer() {
    let place = tempfile::tempdir().unwrap();
    let campaign = campaign();
    let path = place.path().join("results.parquet");
    results::write(&path, &campaign.cases, &campaign.results).unwrap();
    rewrite(&path, |name, column| match column.data_type() {
        DataType::Int64 => as_type(column, DataType::Float64), // nulls among integers, in a data frame
        DataType::Utf8 if name == "case" => as_type(column, DataType::LargeUtf8),
        DataType::Utf8 => as_type(column, dictionary()),
        DataType::List(item) => as_type(column, DataType::new_large_list(item.data_type().clone(), true)),
        _ => Some(column.clone()),
    });
    let rows = results::read(&path).unwrap();
    assert_eq!(rows.iter().map(|row| row.case.seed).collect::<Vec<_>>(), [0, 1, 2].map(|i| campaign.cases[i].seed));
    let mut expected = campaign.results.clone();
    for result in &mut expected {
        // Integers drawn for `[vary]` have become floats.
        result.drawn.iter_mut().filter(|(key, _)| key == "seed").for_each(|(_, value)| *value = serde_json::json!(2.0));
    }
    assert_eq!(rows.into_iter().filter_map(|row| row.result).collect::<Vec<_>>(), expected);

    let path = place.path().join("0000-1.parquet");
    write_run(&path, &campaign.runs[1]);
    rewrite(&path, |_, column| Some(column.clone()));
    let (track, facts) = runs::read_run(&path).unwrap();
    assert_eq!((Some(&track), facts), (campaign.runs[1].outcome.as_ref().ok().map(|flight| &flight.track), None));
}

#[test]
fn the_first_columns_of_the_results_are_the_contract() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("results.parquet");
    let campaign = campaign();
    results::write(&path, &campaign.cases, &campaign.results).unwrap();
    let reader = ParquetRecordBatchReaderBuilder::try_new(File::open(&path).unwrap()).unwrap();
    let schema = reader.schema().clone();
    let names: Vec<&str> = schema.fields().iter().map(|field| field.name().as_str()).collect();
    let contract = "case,seed,status,evidence,length,score,max_deviation_m,mean_deviation_m,t_worst_s,leg_worst,\
                    max_acceleration_m_s2,total_time_s,min_clearance_m,saturation_share,ended";
    assert_eq!(names[..15].join(","), contract);
    assert_eq!(schema.field_with_name("seed").unwrap().data_type(), &DataType::UInt64);
    assert_eq!(schema.field_with_name("case").unwrap().data_type(), &DataType::Utf8);
    assert!(names.contains(&"vary:world.wind_m_s[2]") && names.contains(&"vary:robot.mass_kg"));
    let batch = reader.build().unwrap().next().unwrap().unwrap();
    let text = |name: &str, row: usize| batch.column_by_name(name).unwrap().as_string::<i32>().value(row).to_owned();
    assert_eq!(text("case", 2), "0002");
    assert_eq!(text("violations", 0), "deviation 0.65 m > 0.50 m at t=12.34 s; left the world at t=8.50 s");
}

#[test]
fn a_wrong_value_is_named_with_its_place() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("0000.parquet");
    let campaign = campaign();
    let tamper = |wanted: &'static str, row: usize, value: f64| {
        write_profile(&path, &campaign.cases[0]);
        rewrite(&path, |name, column| {
            let mut values: Vec<f64> = match name == wanted {
                true => cast(column, &DataType::Float64)
                    .unwrap()
                    .as_primitive::<arrow_array::types::Float64Type>()
                    .values()
                    .to_vec(),
                false => return Some(column.clone()),
            };
            values[row] = value;
            Some(Arc::new(Float64Array::from(values)))
        });
        profile::read(&path)
    };
    for (column, row, value) in [
        ("c3", 4, f64::NAN),
        ("c0", 2, f64::INFINITY),
        ("duration_s", 0, -1.0),
        ("duration_s", 5, 2.0),
        ("leg", 1, 7.0),
        ("leg", 3, 0.5),
    ] {
        match tamper(column, row, value) {
            Err(TableError::Value { column: c, row: r, .. }) => assert_eq!((c.as_str(), r), (column, row)),
            other => panic!("{column}[{row}] = {value}: {other:?}"),
        }
    }
    write_profile(&path, &campaign.cases[0]);
    rewrite(&path, |name, column| (name != "c7").then(|| column.clone()));
    let message = profile::read(&path).unwrap_err().to_string();
    assert!(message.contains("0000.parquet") && message.contains("c7") && message.contains("missing"), "{message}");
    write_profile(&path, &campaign.cases[0]);
    rewrite(&path, |name, column| if name == "c1" { as_type(column, DataType::Utf8) } else { Some(column.clone()) });
    assert!(matches!(profile::read(&path), Err(TableError::Column { column, .. }) if column == "c1"));
}

/// Whatever is done to the parts of a campaign: an answer, or a refusal.
#[test]
fn no_broken_part_panics() {
    let place = tempfile::tempdir().unwrap();
    let campaign = campaign();
    let folder = CampaignFolder::create(place.path(), Existing::Replace).unwrap();
    folder.write_scenario("hairpin = 1\n").unwrap();
    folder.write_cases(&campaign.cases).unwrap();
    let writer = folder.write_runs(3, campaign.runs.iter().map(|run| (run.case, run.run)));
    campaign.runs.iter().for_each(|run| writer.land(Landed::of(run, &BTreeSet::new()).unwrap()).unwrap());
    writer.finish().unwrap();
    std::panic::set_hook(Box::new(|_| {}));
    let mut refused = 0;
    for name in ["executions", "runs", "profiles"] {
        let path = place.path().join(name).join("part-00000.parquet");
        let sound = fs::read(&path).unwrap();
        for trial in 0..60_u64 {
            let mut bytes = sound.clone();
            let at = (case_seed(sound.len() as u64, trial) % bytes.len() as u64) as usize;
            match trial % 3 {
                0 => bytes.truncate(at),
                1 => bytes[at] ^= 1 << (trial % 8),
                _ => {
                    let end = bytes.len() - 1 - at % 900.min(bytes.len());
                    bytes[end] ^= (trial >> 1) as u8 | 1;
                }
            }
            fs::write(&path, &bytes).unwrap();
            let opened = CampaignFolder::open(place.path()).unwrap();
            let answers = [opened.read_runs(CaseNumber(0)).is_err(), opened.read_cases().is_err()];
            opened.has_valid_run(CaseNumber(0), 1);
            refused += usize::from(answers.contains(&true));
        }
        fs::write(&path, sound).unwrap();
    }
    drop(std::panic::take_hook());
    assert!(refused > 90, "{refused} of 180 spoiled parts were refused");
}

#[test]
fn no_broken_file_panics() {
    let place = tempfile::tempdir().unwrap();
    let campaign = campaign();
    let path = place.path().join("file.parquet");
    std::panic::set_hook(Box::new(|_| {})); // the decoder's own panics are caught; their noise is not the test's
    let mut refused = 0;
    for kind in 0..3_u64 {
        match kind {
            0 => write_profile(&path, &campaign.cases[0]),
            1 => results::write(&path, &campaign.cases, &campaign.results).unwrap(),
            _ => write_run(&path, &campaign.runs[1]),
        }
        let sound = fs::read(&path).unwrap();
        for trial in 0..400_u64 {
            let mut bytes = sound.clone();
            let random = case_seed(kind, trial);
            let place = (random % bytes.len() as u64) as usize;
            match trial % 4 {
                0 => bytes.truncate(place),
                1 => bytes[place] ^= 1 << (random >> 61),
                // The footer is where a flipped bit does the most.
                2 => {
                    let end = bytes.len() - 1 - place % 600.min(bytes.len());
                    bytes[end] ^= (random >> 56) as u8;
                }
                _ => bytes[place..].iter_mut().take(9).for_each(|byte| *byte = (random >> 48) as u8),
            }
            fs::write(&path, &bytes).unwrap();
            let answers = [profile::read(&path).is_err(), results::read(&path).is_err(), track::read(&path).is_err()];
            refused += usize::from(answers == [true; 3]);
        }
    }
    let _ = std::panic::take_hook();
    assert!(refused > 600, "only {refused} of 1200 broken files were refused");
    assert!(matches!(profile::read(place.path()), Err(TableError::Unreadable { .. })), "a folder");
    assert!(matches!(profile::read(&place.path().join("none")), Err(TableError::Unreadable { .. })));
    fs::write(&path, "").unwrap();
    assert!(matches!(profile::read(&path), Err(TableError::Broken { .. })));
}
