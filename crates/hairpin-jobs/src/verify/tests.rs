//! What holds is told so, and what was changed by its name.

use std::path::PathBuf;

use hairpin::trajectory::{Channel, Track};
use hairpin::verification::Finding;
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::parquet::track;
use nalgebra::Translation3;
use tempfile::TempDir;

use super::check::words;
use super::*;
use crate::Unwatched;
use crate::generate::generate;
use crate::testing::generated;
use crate::work::CampaignSettings;

#[test]
fn what_has_no_number_is_told_in_words() {
    let finding = Finding { field: "it stops".into(), value: f64::NAN, bound: f64::NAN, unit: "", leg: 1, at: 0.5 };
    assert_eq!(words(&finding), "it stops, leg 1→2, t = 0.500 s");
    let finding = Finding { field: "end".into(), value: 2.0, bound: 1.0, unit: "m", ..finding };
    assert_eq!(words(&finding), "end = 2.000000e0 m, bound 1.000000e0 m, leg 1→2, t = 0.500 s");
    let finding = Finding { field: "legs[1]".into(), value: f64::NAN, bound: f64::MAX, unit: "", ..finding };
    assert_eq!(words(&finding), "legs[1] holds a number that cannot be, leg 1→2, t = 0.500 s");
}

#[test]
fn witnesses_hold_and_broken_ones_are_findings() {
    let (_place, folder) = generated();
    let verified = verify(&folder).unwrap();
    assert_eq!((verified.witnesses(), verified.has_findings()), ([2, 2], false));
    assert!(verified.unread() == 0 && verified.largest_m().is_some_and(|error| error < 1e-3), "{verified:?}");
    std::fs::write(folder.join("profiles/part-00000.parquet"), "broken").unwrap();
    let broken = verify(&folder).unwrap();
    assert_eq!((broken.checked(), broken.failed().count(), broken.witnesses()), (2, 2, [2, 0]));
    assert_eq!(broken.worst(), broken.failed().next());
    assert_eq!((broken.unread(), broken.largest_m()), (2, None), "no end error is known of what cannot be read");
    assert_eq!(broken.planned(), [0, 0], "rows are held to what holds");
    std::fs::remove_dir_all(folder.join("profiles")).unwrap();
    let lost = verify(&folder).unwrap();
    assert_eq!((lost.checked(), lost.failed().count()), (2, 2));
    // Nothing else is flown in its place either.
    let refused = open_to_read(&folder).unwrap().folder.read_cases().unwrap_err().to_string();
    assert!(refused.contains("profiles: case 0000 is witnessed and has no witness"), "{refused}");
}

#[test]
fn where_nothing_is_claimed_nothing_is_verified() {
    let place = tempfile::tempdir().unwrap();
    let hull = crate::testing::small_hull(place.path());
    let folder = made(&place, &hull, &[]);
    let verified = verify(&folder).unwrap();
    let told = "none of 3 cases claims a witness: evidence hull-feasible, generate.reach = \"hull\"";
    assert_eq!((verified.checked(), verified.nothing.as_deref()), (0, Some(told)));
    CampaignFolder::open_to_write(&folder).unwrap().write_new_cases(&[], 0).unwrap();
    assert_eq!(verify(&folder).unwrap().nothing.as_deref(), Some("the folder has no case"));
    let (_place, folder) = generated();
    assert_eq!(verify(&folder).unwrap().nothing, None);
}

/// The task in the folder's scenario is changed: who was searched for by another is none of it.
#[test]
fn what_was_searched_for_is_held_to_the_task_and_missions_are_not() {
    let (_place, folder) = generated();
    let file = folder.join("scenario.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let length = text.lines().find(|line| line.starts_with("length = ")).unwrap();
    std::fs::write(&file, text.replace(length, "length = 4")).unwrap();
    let searched = verify(&folder).unwrap();
    assert_eq!(searched.failed().count(), 2);
    let told = |answer: &Answer| matches!(answer, Answer::Checked { findings, .. } if findings[0].starts_with("task.length = "));
    assert!(searched.failed().all(told), "{searched:?}");
    let missions = vec!["a".into(), "b".into()];
    let kept = CampaignFolder::open_to_write(&folder).unwrap();
    kept.write_tally(&Tally { missions, ..kept.read_tally().unwrap() }).unwrap();
    drop(kept);
    let given = verify(&folder).unwrap();
    assert_eq!((given.witnesses(), given.has_findings()), ([2, 2], false), "{given:?}");
    std::fs::remove_file(folder.join("generation.json")).unwrap();
    assert_eq!(verify(&folder).unwrap().failed().count(), 2, "what no tally says was given was searched for");
}

fn made(place: &TempDir, scenario: &str, sets: &[(&str, &str)]) -> PathBuf {
    let settings = CampaignSettings {
        scenario: scenario.into(),
        out: Some(place.path().join("out")),
        sets: sets.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect(),
        ..CampaignSettings::default()
    };
    generate(&settings, &Unwatched).unwrap().work.folder.path().to_owned()
}

/// `track` with the row in its middle `way_m` farther along x, and as much faster as `more_m_s`.
fn changed(track: &Track, way_m: f64, more_m_s: f64) -> Track {
    let middle = track.len() / 2;
    let mut poses = track.poses().to_vec();
    poses[middle] = Translation3::new(way_m, 0.0, 0.0) * poses[middle];
    let mut channels: Vec<Channel> = track.channels().to_vec();
    for channel in channels.iter_mut().filter(|channel| channel.name == "vx_m_s") {
        channel.values[middle] += more_m_s;
    }
    Track::new(track.times().to_vec(), poses, channels).unwrap()
}

/// All planned motions in `folder` hold; the last one no more once one of its rows is elsewhere or at another
/// speed, and none is missed where none is kept.
fn rows_are_held_to_their_witness(folder: &Path) {
    let sound = verify(folder).unwrap();
    let [all, _] = sound.witnesses();
    assert!(all > 0 && !sound.has_findings(), "{sound:?}");
    assert_eq!(sound.planned(), [all; 2]);
    let kept = open_to_read(folder).unwrap().folder;
    let last = kept.read_cases_without_profiles().unwrap().last().unwrap().number;
    let (rows, _) = kept.read_planned_rows(last).unwrap().unwrap();
    for (way_m, more_m_s, field) in [(3.0, 0.0, "planned.position"), (0.0, 0.5, "planned.velocity")] {
        let piece = track::planned(last, &changed(&rows, way_m, more_m_s)).unwrap();
        CampaignFolder::open_to_write(folder).unwrap().write_planned(vec![(last, piece)]).unwrap();
        let found = verify(folder).unwrap();
        let failed: Vec<&Answer> = found.failed().collect();
        let [Answer::Checked { case, findings, .. }] = failed[..] else { panic!("{found:?}") };
        assert_eq!(*case, last);
        let told = findings.join("; ");
        assert!(told.contains(field) && told.contains(", bound ") && told.contains(", t = "), "{told}");
        assert_eq!((found.planned(), found.has_findings()), ([all, all - 1], true));
    }
    drop(kept);
    std::fs::remove_dir_all(folder.join("trajectories")).unwrap();
    let without = verify(folder).unwrap();
    assert_eq!((without.planned(), without.witnesses(), without.has_findings()), ([0, 0], [all; 2], false));
}

#[test]
fn planned_motions_of_flights_are_held_to_their_polynomials() {
    let (_place, folder) = generated();
    rows_are_held_to_their_witness(&folder);
}

#[test]
fn planned_motions_of_drives_are_held_to_their_commands() {
    let place = tempfile::tempdir().unwrap();
    let sets = [
        ("task.length", "4"),
        ("generate.manoeuvres", "[\"forward\"]"),
        ("generate.search", "{ score = \"slope+slip\", waypoints = 24, cases = 2 }"),
        ("world.terrain", "{ generator = \"craters\", size_m = 60, cell_m = 0.2 }"),
    ];
    rows_are_held_to_their_witness(&made(&place, "rover", &sets));
}

#[test]
fn planned_motions_of_boats_are_held_to_their_polynomials() {
    let place = tempfile::tempdir().unwrap();
    let text = r#"
hairpin = 1
robot = "cybership-ii"
seed = 5
[world]
size_m = [60, 60]
[task]
start_m = [27, 27]
end_m = [33, 33]
length = 2
[generate]
leg_time_s = [60, 300]
search = { method = "beam", waypoints = 30, cases = 2 }
[execute]
repeat = 1
time_limit_s = 400
[spec]
deviation = { max_m = 0.1 }
"#;
    let file = place.path().join("waters.toml");
    std::fs::write(&file, text).unwrap();
    rows_are_held_to_their_witness(&made(&place, &file.to_string_lossy(), &[]));
}

#[test]
fn planned_motions_of_arms_are_held_to_their_programs() {
    let place = tempfile::tempdir().unwrap();
    let sets = [("task.points.count", "8"), ("generate.search.programs", "2")];
    rows_are_held_to_their_witness(&made(&place, "arm", &sets));
}

/// What a case draws and the noise of its runs follow from its seed: one of another campaign is none of this.
#[test]
fn a_seed_that_does_not_follow_from_the_root_is_found() {
    let (_place, folder) = crate::testing::executed();
    crate::judge::judge(&folder, &[]).unwrap();
    let work = open_to_read(&folder).unwrap();
    let (mut cases, results) = (work.folder.read_cases().unwrap(), work.folder.read_results().unwrap());
    cases[1].seed ^= 1;
    work.folder.write_results(&cases, &results).unwrap();
    let verified = verify(&folder).unwrap();
    assert_eq!((verified.checked(), verified.failed().count()), (2, 1));
    let told = format!("{:?}", verified.failed().next());
    assert!(told.contains("`seed` = ") && told.contains("which follows from the root seed"), "{told}");
    let consent = crate::consent::Consent::default();
    let simd = hairpin::math::simd::Simd::Portable;
    let replay =
        |case| crate::replay::replay_case((&folder, hairpin::campaign::CaseNumber(case)), simd, &consent, &Unwatched);
    assert!(replay(0).is_ok());
    let refused = replay(1).map(drop).unwrap_err().to_string();
    assert!(refused.contains("results.parquet") && refused.contains("case 0001: `seed` = "), "{refused}");
}
