//! `hairpin export`: a campaign's trajectories as files that other programs open.

use hairpin::campaign::Case;
use hairpin::trajectory::Track;
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::frames::Cage;
use hairpin_formats::{atomic, csv, geodetic, tum, waypoints};
use nalgebra::Isometry3;

use crate::args::{Export, Format};
use crate::folder::Work;
use crate::problem::Problem;
use crate::{console, folder};

/// Runs the command.
pub(crate) fn run(export: &Export) -> Result<u8, Problem> {
    let work = folder::look(&export.folder)?;
    let cases = work.folder.read_cases_without_profiles()?;
    for format in &export.to {
        let (count, place) = match format {
            Format::Waypoints => (write_waypoints(&work.folder, &cases)?, "missions/CASE.csv"),
            Format::Geodetic => (write_geodetic(&work, &cases)?, "missions/CASE.geodetic.csv"),
            Format::Csv => (write_csv(&work.folder, &cases)?, "export/CASE.planned.csv, export/CASE-RUN.csv"),
            Format::Tum => (write_tum(&work.folder, &cases)?, "export/CASE.ref.tum, export/CASE.exec.tum"),
        };
        let path = work.folder.path().display();
        console::say(&format!("{count} files: {path}/{place}"));
    }
    Ok(0)
}

fn write_waypoints(folder: &CampaignFolder, cases: &[Case]) -> Result<usize, Problem> {
    let place = folder.file("missions");
    atomic::make_folder(&place)?;
    for case in cases {
        waypoints::write(&place.join(format!("{}.csv", case.id())), &case.waypoints)?;
    }
    Ok(cases.len())
}

fn write_geodetic(work: &Work, cases: &[Case]) -> Result<usize, Problem> {
    let Some(origin) = &work.setup.scenario.world.origin else {
        return Err(Problem::input(
            "--to geodetic: the scenario has no `world.origin`, such as \
             origin = { lat_deg = 47.3977, lon_deg = 8.5456, alt_amsl_m = 488.0, x_axis_heading_deg = 73.5 }",
        ));
    };
    let cage = Cage::new(origin);
    let place = work.folder.file("missions");
    atomic::make_folder(&place)?;
    for case in cases {
        geodetic::write(&place.join(format!("{}{}", case.id(), geodetic::ENDING)), &cage, &case.waypoints)?;
    }
    Ok(cases.len())
}

fn write_csv(folder: &CampaignFolder, cases: &[Case]) -> Result<usize, Problem> {
    let place = folder.file("export");
    atomic::make_folder(&place)?;
    let table = folder.read_runs_table()?;
    let mut count = 0;
    for case in cases {
        csv::write(&place.join(format!("{}.planned.csv", case.id())), &folder.read_planned(case.number)?)?;
        count += 1;
        for run in folder.read_runs(case.number, &table)? {
            if let Ok(flight) = &run.outcome {
                csv::write(&place.join(format!("{}-{}.csv", case.id(), run.run)), &flight.track)?;
                count += 1;
            }
        }
    }
    Ok(count)
}

/// Pairs of the planned motion and the worst run of every judged case (run 0 before judging).
fn write_tum(folder: &CampaignFolder, cases: &[Case]) -> Result<usize, Problem> {
    let place = folder.file("export");
    atomic::make_folder(&place)?;
    let table = folder.read_runs_table()?;
    let results = folder.read_results()?;
    let mut count = 0;
    for case in cases {
        let worst = results.iter().find(|result| result.case == case.number).map_or(0, |result| result.run);
        let Some(run) = folder.read_run(case.number, worst, &table)? else { continue };
        let Ok(flight) = run.outcome else { continue };
        if case.leg_times.is_empty() {
            return Err(Problem::input(format!(
                "case {}: a mission made elsewhere has no timed plan to compare with",
                case.id()
            )));
        }
        let planned = folder.read_planned(case.number)?;
        if let Some(reference) = at_stamps(&planned, flight.track.times()) {
            tum::write_pair(&place, &case.id(), &reference, &flight.track)?;
            count += 2;
        }
    }
    if count == 0 {
        return Err(Problem::input(format!("no flights to export: hairpin execute {}", folder.path().display())));
    }
    Ok(count)
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
                // Opposite attitudes have no shortest way between them.
                a.try_lerp_slerp(b, share, 1e-9).unwrap_or(*a)
            }
        }
    };
    Track::new(stamps.to_vec(), stamps.iter().map(pose).collect(), Vec::new()).ok()
}
