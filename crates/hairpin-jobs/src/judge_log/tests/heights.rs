//! Logs of drives without heights, on a map that goes up and down; and of what flies.

use std::path::PathBuf;

use hairpin::campaign::CaseNumber;
use hairpin::trajectory::Track;

use super::*;
use crate::Unwatched;
use crate::generate::generate;
use crate::work::{CampaignSettings, open_to_read};

/// A campaign of the shipped rover among craters, with one case, and its planned motion.
fn craters(place: &TempDir) -> (PathBuf, Track) {
    let sets = [
        ("task.length", "4"),
        ("generate.manoeuvres", "[\"forward\"]"),
        ("generate.search", "{ score = \"slope+slip\", waypoints = 24, cases = 1 }"),
        ("world.terrain", "{ generator = \"craters\", size_m = 60, cell_m = 0.2 }"),
    ];
    let settings = CampaignSettings {
        scenario: "rover".into(),
        out: Some(place.path().join("out")),
        sets: sets.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect(),
        ..CampaignSettings::default()
    };
    let folder = generate(&settings, &Unwatched).unwrap().work.folder.path().to_owned();
    let planned = open_to_read(&folder).unwrap().folder.read_planned(CaseNumber(0)).unwrap();
    (folder, planned)
}

/// The planned motion as a log, with heights as `height` has them of its own.
fn driven(planned: &Track, height: impl Fn(f64) -> f64) -> Logged {
    let of = |(t, pose): (&f64, &nalgebra::Isometry3<f64>)| {
        let p = pose.translation.vector;
        let p_m = Point3::new(p.x, p.y, height(p.z));
        Sample { t_s: *t, p_m, attitude: None, v_m_s: None, accuracy_m: None }
    };
    let samples = planned.times().iter().zip(planned.poses()).map(of).collect();
    let motions = vec![LoggedMotion::of("odom.csv", Source::Untold, samples)];
    Logged { format: "CSV", frame: LogFrame::Untold, motions, ..log(100.0, 0.0) }
}

fn judged_on(folder: &Path, logged: &Logged, offset_m: [f64; 3]) -> Result<JudgedLog, String> {
    judged_as(logged, |settings, _| {
        settings.against = Against::Campaign(folder.into());
        settings.sets = vec![("spec.limits".into(), "{ path_deviation_m = 0.25 }".into())];
        settings.frame.offset_m = offset_m;
    })
}

#[test]
fn what_drives_and_tells_no_heights_is_on_the_ground() {
    let place = TempDir::new().unwrap();
    let (folder, planned) = craters(&place);
    let heights: Vec<f64> = planned.poses().iter().map(|pose| pose.translation.vector.z).collect();
    let relief = heights.iter().fold(0.0_f64, |most, z| most.max((z - heights[0]).abs()));
    assert!(relief > 0.1, "{relief}");
    let measured = |judged: JudgedLog| {
        let found = judged.found.unwrap();
        (found.flown.unwrap().measures.max_deviation, found.frame.heights_by_map, found.notes.join("; "))
    };
    let (with, by_map, _) = measured(judged_on(&folder, &driven(&planned, |z| z), [0.0; 3]).unwrap());
    assert!(with < 1e-3 && !by_map, "{with}");
    // The body's height over the ground is the plan's, too: what is left is the heading, taken from the way.
    let (without, by_map, notes) = measured(judged_on(&folder, &driven(&planned, |_| 0.0), [0.0; 3]).unwrap());
    assert!(without < 0.01 && by_map, "{without}");
    let words =
        "the log has no heights: they are those of the vehicle on the map's ground, with the headings of its way";
    assert!(notes.contains(words), "{notes}");
    // What somebody names is his word, and so is a height that is told.
    let told = judged_on(&folder, &driven(&planned, |_| 0.0), [0.0, 0.0, 0.2 + heights[0]]).unwrap();
    assert!(!told.found.unwrap().frame.heights_by_map);
    let told = judged_on(&folder, &driven(&planned, |z| z + 47.0), [0.0; 3]).unwrap_err();
    assert!(told.contains("does not begin where its mission does"), "{told}");
    let told = judged_on(&folder, &driven(&planned, |_| 0.0), [5.0, 0.0, 0.0]).unwrap_err();
    assert!(told.contains("--offset -5.00,") && told.contains(",0.00 (after --turn"), "{told}");
}

#[test]
fn what_leaves_the_map_without_heights_left_it() {
    let place = TempDir::new().unwrap();
    let (folder, planned) = craters(&place);
    let mut out = driven(&planned, |_| 0.0);
    let last = *out.motions[0].samples.last().unwrap();
    let step = |k: u32| Sample {
        t_s: last.t_s + f64::from(k),
        p_m: Point3::new(last.p_m.x - 2.0 * f64::from(k), last.p_m.y, 0.0),
        ..last
    };
    out.motions[0].samples.extend((1..40).map(step));
    let verdict = judged_on(&folder, &out, [0.0; 3]).unwrap().verdict;
    assert_ne!(verdict.exit_code, 0, "{}", verdict.sentence);
}

#[test]
fn the_ground_is_where_waypoints_of_drives_are() {
    let place = TempDir::new().unwrap();
    let (folder, _) = craters(&place);
    let work = open_to_read(&folder).unwrap();
    let case = &work.folder.read_cases_without_profiles().unwrap()[0];
    let mut low: Vec<Point3<f64>> = case.waypoints.iter().map(|p| Point3::new(p.x, p.y, -7.0)).collect();
    crate::judge_log::heights::on_ground(&work.setup, &mut low);
    for (p, own) in low.iter().zip(&case.waypoints) {
        assert!((p - own).norm() < 1e-6, "{p} {own}");
    }
    // Off the map there is none, and what flies has no ground.
    let mut off = [Point3::new(-500.0, 0.0, 3.0)];
    crate::judge_log::heights::on_ground(&work.setup, &mut off);
    assert_eq!(off[0].z, 3.0);
}

#[test]
fn what_flies_is_not_judged_without_heights() {
    let mut flat = log(100.0, 0.0);
    flat.motions[0].samples.iter_mut().for_each(|sample| sample.p_m.z = 5.0);
    assert_eq!(said(&flat).1, 0);
    flat.motions[0].no_heights = Some("no column of z; columns that are not read: height_m".into());
    let told = judged_as(&flat, |_, _| {}).unwrap_err();
    let words = "no column of z; columns that are not read: height_m: heights of what flies are needed, as `z_m`";
    assert!(told.contains(words), "{told}");
}
