//! A campaign's trajectories as files that other programs open.

mod programs;
mod written;

use std::path::{Path, PathBuf};

use hairpin::campaign::{Case, Evidence};
use hairpin::math::rotation::between;
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Track};
use hairpin_formats::placement::Placement;
use hairpin_formats::{atomic, csv, geodetic, missions, tum, waypoints};
use nalgebra::Isometry3;

use crate::Problem;
use crate::execute::{run_with_motion, runs_with_motion};
use crate::work::{Work, open_to_read};

pub use programs::Language;
pub use written::Written;

/// A format of trajectories.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// missions/CASE.csv: x_m,y_m,z_m.
    Waypoints,
    /// missions/CASE.geodetic.csv, by the scenario's world.origin or its map's EPSG code.
    Geodetic,
    /// CASE.planned.csv and CASE-RUN.csv: poses in time.
    Csv,
    /// Of arms, in the language of a controller.
    Program(Language),
    /// Of arms: arc_clock.mod, which clocks every move of the graph on the controller.
    ArcClock,
    /// CASE.ref.tum and CASE.exec.tum: planned motion and worst run on the same stamps.
    Tum,
}

/// A campaign that is exported.
pub struct Export {
    work: Work,
    cases: Vec<Case>,
}

impl Export {
    /// The campaign in `folder`.
    ///
    /// # Errors
    /// The folder is no campaign's, or broken.
    pub fn open(folder: &Path) -> Result<Self, Problem> {
        let work = open_to_read(folder)?;
        Ok(Self { cases: work.folder.read_cases_without_profiles()?, work })
    }

    /// Writes all files of a format into the campaign's folder.
    ///
    /// # Errors
    /// There is nothing to write; a file cannot be read or written.
    pub fn write(&self, format: Format) -> Result<Written, Problem> {
        let Self { work, cases } = self;
        match format {
            Format::Waypoints => write_waypoints(work, cases),
            Format::Geodetic => write_geodetic(work, cases),
            Format::Csv => write_csv(work, cases),
            Format::Tum => write_tum(work, cases),
            Format::Program(language) => programs::write(work, cases, language),
            Format::ArcClock => programs::write_clock(work),
        }
    }
}

/// `missions/CASE.csv`, and `missions/CASE.environment.json` of what a case has beside them.
fn write_waypoints(work: &Work, cases: &[Case]) -> Result<Written, Problem> {
    let place = work.folder.file("missions");
    atomic::make_folder(&place)?;
    let one = |case: &Case| {
        let path = place.join(format!("{}.csv", case.id()));
        waypoints::write(&path, &case.waypoints).map(|()| path)
    };
    let mut files = cases.iter().map(one).collect::<Result<Vec<_>, _>>()?;
    for case in cases {
        if let Some(environment) = &case.environment {
            let path = missions::environment_path(&place, &case.id());
            atomic::write_json(&path, environment)?;
            files.push(path);
        }
    }
    Ok(Written::all(files))
}

/// `missions/CASE.geodetic.csv`.
fn write_geodetic(work: &Work, cases: &[Case]) -> Result<Written, Problem> {
    let refuse = |why: String| Problem::input(format!("--to geodetic: {why}"));
    let Some(world) = Placement::of(&work.setup.scenario).map_err(refuse)? else {
        return Err(refuse(
            "the scenario has no `world.origin`, such as \
             origin = { lat_deg = 47.3977, lon_deg = 8.5456, alt_amsl_m = 488.0, x_axis_heading_deg = 73.5 }, and no map \
             whose file or `world.terrain.epsg` says in which plane it lies"
                .into(),
        ));
    };
    let place = work.folder.file("missions");
    atomic::make_folder(&place)?;
    let one = |case: &Case| -> Result<PathBuf, Problem> {
        let path = place.join(format!("{}{}", case.id(), geodetic::ENDING));
        let text =
            geodetic::text(&world, &case.waypoints).map_err(|why| refuse(format!("case {}: {why}", case.id())))?;
        geodetic::write(&path, &text)?;
        Ok(path)
    };
    Ok(Written::all(cases.iter().map(one).collect::<Result<_, _>>()?))
}

/// `CASE.planned.csv` and `CASE-RUN.csv`.
fn write_csv(work: &Work, cases: &[Case]) -> Result<Written, Problem> {
    let folder = &work.folder;
    let mut written = Written::default();
    let mut write = |path: PathBuf, track: &Track, level: bool| -> Result<(), Problem> {
        csv::write(&path, track)?;
        written.level.extend(level.then(|| path.clone()));
        written.files.push(path);
        Ok(())
    };
    for case in cases {
        write(folder.planned_csv_path(case.number), &folder.read_planned(case.number)?, !is_planned(case))?;
        for run in runs_with_motion(work, case)? {
            if let Ok(flight) = &run.outcome {
                write(folder.run_csv_path(case.number, run.run), &flight.track, is_level(&flight.track))?;
            }
        }
    }
    Ok(written)
}

/// `CASE.ref.tum` and `CASE.exec.tum`: the planned motion and the worst run of every judged case (run 0 before
/// judging).
fn write_tum(work: &Work, cases: &[Case]) -> Result<Written, Problem> {
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
        let [reference, executed] = tum::write_pair(folder.path(), &case.id(), &reference, &flight.track)?;
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

/// Whether attitudes are planned: only a witness has them.
fn is_planned(case: &Case) -> bool {
    case.evidence == Evidence::Witnessed
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{executed, generated};

    #[test]
    fn files_lie_in_the_campaign() {
        let (_place, folder) = executed();
        let export = Export::open(&folder).unwrap();
        for (format, count) in [(Format::Waypoints, 2), (Format::Geodetic, 2), (Format::Csv, 4), (Format::Tum, 4)] {
            let written = export.write(format).unwrap();
            assert_eq!((written.files.len(), written.missing.len()), (count, 0), "{format:?}");
            assert!(written.files.iter().all(|file| file.starts_with(&folder) && file.is_file()));
        }
        for format in [Format::Program(Language::Rapid), Format::ArcClock] {
            assert!(export.write(format).is_err(), "{format:?}");
        }
    }

    #[test]
    fn what_was_not_flown_has_no_pair() {
        let (_place, folder) = generated();
        let refused = Export::open(&folder).unwrap().write(Format::Tum).unwrap_err().to_string();
        assert!(refused.contains("it has not been flown"), "{refused}");
    }
}
