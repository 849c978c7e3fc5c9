//! `hairpin export`: a campaign's trajectories as files that other programs open.

mod programs;

use std::path::PathBuf;

use hairpin::campaign::{Case, Evidence};
use hairpin::math::rotation::between;
use hairpin::trajectory::Track;
use hairpin_formats::executor::ATTITUDE_UNKNOWN;
use hairpin_formats::frames::Cage;
use hairpin_formats::{atomic, csv, geodetic, tum, waypoints};
use nalgebra::Isometry3;
use serde_json::json;

use crate::args::{Export, Format};
use crate::folder::Work;
use crate::problem::Problem;
use crate::{console, folder};

/// What came of one format.
#[derive(Default)]
struct Written {
    files: Vec<PathBuf>,
    /// Of these, files of a format that asks for attitudes, where nobody knows them: they say level.
    level: Vec<PathBuf>,
    /// Cases that have no such file, with the reason.
    missing: Vec<String>,
}

impl Written {
    fn all(files: Vec<PathBuf>) -> Self {
        Self { files, ..Self::default() }
    }
}

/// Runs the command: 0 when everything is written that there is to write.
pub(crate) fn run(export: &Export) -> Result<u8, Problem> {
    let work = folder::look(&export.folder)?;
    let cases = work.folder.read_cases_without_profiles()?;
    let mut formats = Vec::new();
    let mut all = Written::default();
    for format in &export.to {
        let written = match format {
            Format::Waypoints => write_waypoints(&work, &cases)?,
            Format::Geodetic => write_geodetic(&work, &cases)?,
            Format::Csv => write_csv(&work, &cases)?,
            Format::Tum => write_tum(&work, &cases)?,
            Format::Rapid | Format::Urscript | Format::Krl | Format::JointTrajectory => {
                programs::write(&work, &cases, *format)?
            }
            Format::ArcClock => programs::write_clock(&work)?,
        };
        let (count, (word, programs)) = (written.files.len(), of_format(*format));
        formats.push(json!({ "format": word, "files": count, "opened_by": programs }));
        if !export.json {
            written.files.iter().for_each(|path| console::say(&path.display().to_string()));
            console::warn(&format!("{count} files {word}, opened by {programs}"));
        }
        all.files.extend(written.files);
        all.level.extend(written.level);
        all.missing.extend(written.missing);
    }
    if let Some(first) = all.level.first() {
        console::warn(&format!(
            "Warning: the attitude is unknown in {} files, such as {}: its columns say level",
            all.level.len(),
            first.display()
        ));
    }
    for why in &all.missing {
        console::warn(&format!("Warning: {why}"));
    }
    if export.json {
        let object = json!({
            "exit_code": 0, "formats": formats, "files": all.files, "attitude_unknown": all.level, "missing": all.missing,
        });
        console::say(&object.to_string());
    }
    Ok(0)
}

/// The format's word, and who opens its files.
fn of_format(format: Format) -> (&'static str, &'static str) {
    match format {
        Format::Waypoints => ("waypoints", "`hairpin execute OUT --missions DIR` and spreadsheets"),
        Format::Geodetic => ("geodetic", "spreadsheets and geographic information systems"),
        Format::Rapid => ("rapid", "RobotStudio and ABB controllers: load CASE.pgf or CASE.mod, run CASE_slow first"),
        Format::Urscript => ("urscript", "Universal Robots controllers and URSim"),
        Format::Krl => ("krl", "KUKA controllers and OfficeLite"),
        Format::JointTrajectory => ("joint-trajectory", "ROS 2: `ros2 topic pub` and joint_trajectory_controller"),
        Format::ArcClock => {
            ("arc-clock", "ABB controllers: run clock_arcs, then `hairpin import arc_ms.log` makes arc_ms.csv")
        }
        Format::Csv => ("csv", "spreadsheets, pandas, PlotJuggler"),
        Format::Tum => ("tum", "evo: `evo_ape tum CASE.ref.tum CASE.exec.tum`, never with --align"),
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
            let path = waypoints::environment_path(&place, &case.id());
            let text = serde_json::to_string_pretty(environment).map_err(Problem::input)?;
            atomic::write(&path, (text + "\n").as_bytes())?;
            files.push(path);
        }
    }
    Ok(Written::all(files))
}

/// `missions/CASE.geodetic.csv`.
fn write_geodetic(work: &Work, cases: &[Case]) -> Result<Written, Problem> {
    let Some(origin) = &work.setup.scenario.origin() else {
        return Err(Problem::input(
            "--to geodetic: the scenario has no `world.origin`, such as \
             origin = { lat_deg = 47.3977, lon_deg = 8.5456, alt_amsl_m = 488.0, x_axis_heading_deg = 73.5 }",
        ));
    };
    let cage = Cage::new(origin);
    let place = work.folder.file("missions");
    atomic::make_folder(&place)?;
    let one = |case: &Case| {
        let path = place.join(format!("{}{}", case.id(), geodetic::ENDING));
        geodetic::write(&path, &cage, &case.waypoints).map(|()| path)
    };
    Ok(Written::all(cases.iter().map(one).collect::<Result<_, _>>()?))
}

/// `CASE.planned.csv` and `CASE-RUN.csv`.
fn write_csv(work: &Work, cases: &[Case]) -> Result<Written, Problem> {
    let folder = &work.folder;
    let table = folder.read_runs_table()?;
    let mut written = Written::default();
    let mut write = |path: PathBuf, track: &Track, level: bool| -> Result<(), Problem> {
        csv::write(&path, track)?;
        written.level.extend(level.then(|| path.clone()));
        written.files.push(path);
        Ok(())
    };
    for case in cases {
        write(folder.planned_csv_path(case.number), &folder.read_planned(case.number)?, !is_planned(case))?;
        for run in folder.read_runs(case.number, &table)? {
            if let Ok(flight) = &run.outcome {
                write(folder.run_csv_path(case.number, run.run), &flight.track, is_level(&flight.track))?;
            }
        }
    }
    Ok(written)
}

/// `CASE.ref.tum` and `CASE.exec.tum`: the planned motion and the worst run of every judged case (run 0 before judging).
fn write_tum(work: &Work, cases: &[Case]) -> Result<Written, Problem> {
    let folder = &work.folder;
    let table = folder.read_runs_table()?;
    let results = folder.read_results()?;
    let mut written = Written::default();
    for case in cases {
        let mut miss = |why: &str| written.missing.push(format!("case {} has no .tum: {why}", case.id()));
        let worst = results.iter().find(|result| result.case == case.number).map_or(0, |result| result.run);
        let Some(run) = folder.read_run(case.number, worst, &table)? else {
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
