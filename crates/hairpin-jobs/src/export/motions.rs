//! Waypoints and motions as text: what spreadsheets, evo and hairpin itself read back.

use std::path::{Path, PathBuf};

use hairpin::campaign::Case;
use hairpin::math::rotation::between;
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Track};
use hairpin_formats::{atomic, csv, geodetic, missions, tum, waypoints};
use nalgebra::Isometry3;

use super::placed::placed;
use super::planned::planned;
use super::written::Written;
use crate::Problem;
use crate::execute::{run_with_motion, runs_with_motion};
use crate::work::Work;

/// `CASE.csv`, and `CASE.environment.json` of what a case has beside its waypoints.
pub(super) fn write_waypoints(place: &Path, cases: &[&Case]) -> Result<Written, Problem> {
    let one = |case: &&Case| {
        let path = place.join(format!("{}.csv", case.id()));
        waypoints::write(&path, &case.waypoints).map(|()| path)
    };
    let mut files = cases.iter().map(one).collect::<Result<Vec<_>, _>>()?;
    for case in cases {
        if let Some(environment) = &case.environment {
            let path = missions::environment_path(place, &case.id());
            atomic::write_json(&path, environment)?;
            files.push(path);
        }
    }
    Ok(Written::all(files))
}

/// `CASE.geodetic.csv`.
pub(super) fn write_geodetic(work: &Work, place: &Path, cases: &[&Case]) -> Result<Written, Problem> {
    let refuse = |why: String| Problem::input(format!("--to geodetic: {why}"));
    let world = placed(work, "geodetic")?;
    let one = |case: &&Case| -> Result<PathBuf, Problem> {
        let path = place.join(format!("{}{}", case.id(), geodetic::ENDING));
        let text =
            geodetic::text(&world, &case.waypoints).map_err(|why| refuse(format!("case {}: {why}", case.id())))?;
        geodetic::write(&path, &text)?;
        Ok(path)
    };
    Ok(Written::all(cases.iter().map(one).collect::<Result<_, _>>()?))
}

/// `CASE.planned.csv` and `CASE-RUN.csv`.
pub(super) fn write_csv(work: &Work, place: &Path, cases: &[&Case]) -> Result<Written, Problem> {
    let mut written = Written::default();
    let mut write = |path: PathBuf, track: &Track, level: bool| -> Result<(), Problem> {
        csv::write(&path, track)?;
        written.level.extend(level.then(|| path.clone()));
        written.files.push(path);
        Ok(())
    };
    for case in cases {
        write(place.join(format!("{}.planned.csv", case.id())), &planned(work, case)?, !is_planned(case))?;
        for run in runs_with_motion(work, case)? {
            if let Ok(flight) = &run.outcome {
                write(place.join(format!("{}-{}.csv", case.id(), run.run)), &flight.track, is_level(&flight.track))?;
            }
        }
    }
    Ok(written)
}

/// `CASE.ref.tum` and `CASE.exec.tum`: the planned motion and the worst run of every judged case (run 0 before
/// judging).
pub(super) fn write_tum(work: &Work, place: &Path, cases: &[&Case]) -> Result<Written, Problem> {
    let folder = &work.folder;
    let results = folder.read_results()?;
    let mut written = Written::default();
    for case in cases {
        let mut miss = |why: &str| written.missing.push(format!("case {} has no .tum: {why}", case.id()));
        let worst = results.iter().find(|result| result.case == case.number).map_or(0, |result| result.run);
        let Some(run) = run_with_motion(work, case, worst)? else {
            miss("it has not been flown");
            continue;
        };
        let Ok(flight) = run.outcome else {
            miss("its executor failed");
            continue;
        };
        if case.leg_times.is_empty() {
            miss("a mission made elsewhere has no timed plan to compare with");
            continue;
        }
        let planned = folder.read_planned(case.number)?;
        let Some(reference) = at_stamps(&planned, flight.track.times()) else {
            miss("its plan is empty");
            continue;
        };
        let [reference, executed] = tum::write_pair(place, &case.id(), &reference, &flight.track)?;
        written.level.extend((!is_planned(case)).then(|| reference.clone()));
        written.level.extend(is_level(&flight.track).then(|| executed.clone()));
        written.files.extend([reference, executed]);
    }
    match written.missing.first() {
        Some(why) if written.files.is_empty() => {
            Err(Problem::input(format!("--to tum: {why} (hairpin execute {})", folder.path().display())))
        }
        _ => Ok(written),
    }
}

/// Whether attitudes are planned: a witness has them, and so has an arm's program.
fn is_planned(case: &Case) -> bool {
    case.evidence.is_of_a_witness()
}

/// Whether the executor sent no attitudes.
fn is_level(track: &Track) -> bool {
    track.channel(ATTITUDE_UNKNOWN).is_some()
}

/// The planned motion at other stamps, interpolated; before its start and after its end it stands still.
fn at_stamps(planned: &Track, stamps: &[f64]) -> Option<Track> {
    let (times, poses) = (planned.times(), planned.poses());
    let (first, last) = (poses.first()?, poses.last()?);
    let pose = |&t: &f64| -> Isometry3<f64> {
        let after = times.partition_point(|&stamp| stamp <= t);
        match after {
            0 => *first,
            _ if after == times.len() => *last,
            _ => {
                let share = (t - times[after - 1]) / (times[after] - times[after - 1]);
                let (a, b) = (&poses[after - 1], &poses[after]);
                let place = a.translation.vector.lerp(&b.translation.vector, share);
                Isometry3::from_parts(place.into(), between(&a.rotation, &b.rotation, share))
            }
        }
    };
    Track::new(stamps.to_vec(), stamps.iter().map(pose).collect(), Vec::new()).ok()
}
