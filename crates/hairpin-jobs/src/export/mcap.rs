//! Motions as MCAP: for Foxglove, or for ROS 2.

use std::path::Path;

use hairpin::campaign::Case;
use hairpin::campaign::report::surroundings;
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Track};
use hairpin_formats::mcap::{JointMotion, McapError, Recording, foxglove, ros2};

use super::planned::planned;
use super::programs::{PlannedJoints, planned_joints, stands_aside};
use super::written::Written;
use crate::Problem;
use crate::execute::runs_with_motion;
use crate::work::Work;

/// Who opens the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum For {
    Foxglove,
    Ros2,
}

/// `CASE.mcap` or `CASE.ros2.mcap`: the planned motion where there is a timed one, and every run.
pub(super) fn write(work: &Work, place: &Path, cases: &[&Case], reader: For) -> Result<Written, Problem> {
    if stands_aside(work) {
        return Err(Problem::input(
            "--to mcap, mcap-ros2: motions are in the arm's base, which `world.base_frame` puts elsewhere than at the \
             origin of the file's frame `world`; --to csv and tum are in the base",
        ));
    }
    let mut written = Written::default();
    for case in cases {
        let planned = if case.leg_times.is_empty() { Track::default() } else { planned(work, case)? };
        let runs = runs_with_motion(work, case)?;
        let flown = runs.iter().filter_map(|run| Some((run.run, &run.outcome.as_ref().ok()?.track)));
        let is_level = |track: &Track| track.channel(ATTITUDE_UNKNOWN).is_some();
        let mut recording = Recording {
            planned: Some(&planned).filter(|track| !track.is_empty()),
            runs: flown.collect(),
            facts: vec![("case", case.id()), ("evidence", case.claim())],
            ..Recording::default()
        };
        let level = recording.runs.iter().any(|(_, track)| is_level(track));
        if level {
            recording.facts.push(("attitude", "unknown in runs: level stands for it".into()));
        }
        let (path, answer) = match reader {
            For::Foxglove => {
                recording.obstacles = surroundings(&work.setup, case);
                let path = place.join(format!("{}.mcap", case.id()));
                let answer = foxglove::write(&path, &recording);
                (path, answer)
            }
            For::Ros2 => {
                let mut case = (*case).clone();
                work.folder.read_witness(&mut case)?;
                if case.program().is_some() {
                    let PlannedJoints { names, times_s, rows } = planned_joints(work, &case).map_err(Problem::input)?;
                    let rows = rows.iter().map(|row| row.to_vec()).collect();
                    let names = names.to_vec();
                    recording.joints.push(JointMotion { name: "planned", names, times_s, rows });
                }
                let path = place.join(format!("{}.ros2.mcap", case.id()));
                let answer = ros2::write(&path, &recording);
                (path, answer)
            }
        };
        match answer {
            Ok(()) => {
                written.level.extend(level.then(|| path.clone()));
                written.files.push(path);
            }
            Err(McapError::Write(error)) => return Err(error.into()),
            Err(error) => written.missing.push(format!("case {}: {error}", case.id())),
        }
    }
    match written.missing.first() {
        Some(why) if written.files.is_empty() => Err(Problem::input(why)),
        _ => Ok(written),
    }
}
