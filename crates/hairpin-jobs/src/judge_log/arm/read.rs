//! From a file to a recording of an arm.

use std::path::Path;

use hairpin::campaign::arm::ArmSetup;
use hairpin::judgement::{Resolution, repeats};
use hairpin::robot::arm::{AXES, Arm, Joints};
use hairpin::trajectory::Track;
use hairpin_formats::controller_log::{self, ControllerLog};
use hairpin_formats::logs::{self, Clock, Logged, Source};
use hairpin_formats::quote::shortened;
use nalgebra::Vector3;

use super::super::aside::placed;
use super::super::asks::Asks;
use super::super::source::{SourceTold, clock_words};
use super::super::told;
use super::found::JointsTold;
use super::names::{axes, of_columns};
use crate::Problem;

/// A recording, and what is told of it.
pub(super) struct Read {
    pub(super) log: ControllerLog,
    pub(super) source: SourceTold,
    pub(super) joints: Option<JointsTold>,
    /// When the program is taken to begin, s of the log; its times are counted from there.
    pub(super) begins_s: f64,
    /// The moment to which it is judged, s of the log, where samples come after it.
    pub(super) to_s: Option<f64>,
    pub(super) notes: Vec<String>,
}

/// The recording in `file`: a bag's joints, of the topic `source` where one is asked for, or a table as controllers
/// write it; what lies between two moments of the log, s.
///
/// # Errors
/// What of it is broken; joints that are not the arm's; times of which nothing is left.
pub(super) fn recording(
    file: &Path,
    arm: &ArmSetup,
    (source, [from_s, to_s]): (Option<&str>, [Option<f64>; 2]),
    asks: &Asks,
) -> Result<Read, Problem> {
    let refuse = |why: String| Problem::of_file(file, why);
    let station = &arm.station;
    let (log, name, format, clock, joints, mut notes) = if logs::is_text(file).map_err(Problem::input)? {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if logs::is_planned(&name) && source != Some(name.as_str()) {
            return Err(refuse(format!("by its name what was planned, and not what moved; {}", asks.topic)));
        }
        let log = controller_log::read(file, Some((&station.arm, &station.tool.tcp))).map_err(Problem::input)?;
        let told = log.joints.as_ref().map(of_columns);
        (log, name, "CSV", Clock::File, told, Vec::new())
    } else {
        let logged = logs::read(file).map_err(Problem::input)?;
        let (joints, place, told) = chosen(&logged, &station.arm, source, asks).map_err(refuse)?;
        let rows: Vec<Joints> = joints.positions_rad.iter().map(|row| place.map(|index| row[index])).collect();
        let log = controller_log::of_joints(file, joints.times_s.clone(), &rows, (&station.arm, &station.tool.tcp));
        let name = joints.name.clone();
        (log.map_err(Problem::input)?, name, logged.format, logged.clock, Some(told), logged.notes)
    };
    let beyond = arm.beyond_bounds(&log.track).and_then(|beyond| {
        let name = |joints: &JointsTold| joints.names[beyond.axis - 1].clone();
        beyond.refused(&joints.as_ref().map_or_else(|| format!("joint {}", beyond.axis), name))
    });
    if let Some(why) = beyond {
        return Err(refuse(why));
    }
    let times = log.track.times();
    // A controller's log begins with its program; a recorder runs before it and has another clock.
    let first = if clock == Clock::File { 0.0 } else { times[0] };
    let begins_s = from_s.unwrap_or(first);
    let (from, to) = (from_s.unwrap_or(times[0]), to_s.unwrap_or(f64::INFINITY));
    let stale = repeated(&log.track);
    notes.extend(told::repeated(stale.iter().filter(|stale| **stale).count(), stale.len()));
    let which: Vec<usize> = (0..times.len()).filter(|&i| (from..=to).contains(&times[i]) && !stale[i]).collect();
    if which.len() < 2 {
        let (first, last) = (times[0], times[times.len() - 1]);
        return Err(refuse(format!("no two samples between --from and --to; it is from {first} to {last} s")));
    }
    let mut spans: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    spans.sort_unstable_by(f64::total_cmp);
    let source = SourceTold {
        format,
        topic: name.clone(),
        words: match (clock, log.from_joints) {
            (Clock::File, _) if logs::is_planned(&name) => "by its name planned",
            (_, true) => "joint encoders",
            (_, false) => "the controller's poses",
        },
        has_accuracy: true,
        others: Vec::new(),
        clock: clock_words(clock),
        samples: times.len(),
        rate_hz: 1.0 / spans[spans.len() / 2],
    };
    // Times are counted from where it begins.
    let track = placed(&log.track.only(&which), Vector3::zeros(), -begins_s);
    let track = track.map_err(|problem| refuse(problem.to_string()))?;
    let to_s = to_s.filter(|to| times[times.len() - 1] > *to);
    Ok(Read { log: ControllerLog { track, ..log }, source, joints, begins_s, to_s, notes })
}

/// A turn of 1 rad is as far as so many metres.
const LEVER_M: f64 = 0.1;

/// Which samples repeat the pose before them while the tool moves on.
fn repeated(track: &Track) -> Vec<bool> {
    let poses = track.poses();
    let apart = |i: usize, j: usize| match poses[i] == poses[j] {
        true => 0.0,
        false => {
            let moved = (poses[j].translation.vector - poses[i].translation.vector).norm();
            // Of quaternions that are a half angle apart; both signs are one attitude.
            let [a, b] = [i, j].map(|k| poses[k].rotation.coords);
            moved + LEVER_M * 2.0 * (a - b).norm().min((a + b).norm())
        }
    };
    repeats(track.times(), &apart, Resolution::of(track).place.all)
}

/// The only topic with the arm's joints, or the one that is asked for, and where the axes are in it.
fn chosen<'a>(
    logged: &'a Logged,
    arm: &Arm,
    asked: Option<&str>,
    asks: &Asks,
) -> Result<(&'a logs::Joints, [usize; AXES], JointsTold), String> {
    // What by its name was asked for is judged only where it is named.
    let is_meant = |joints: &&logs::Joints| match asked {
        Some(topic) => joints.name == topic,
        None => joints.source != Source::Asked,
    };
    let sets: Vec<&logs::Joints> = logged.joints.iter().filter(is_meant).collect();
    let names = || logged.joints.iter().map(|joints| joints.name.as_str()).collect::<Vec<_>>().join(", ");
    match (&sets[..], asked) {
        ([], Some(topic)) => return Err(format!("--source {topic}: no joints of that topic; it has {}", names())),
        ([], None) if !logged.joints.is_empty() => {
            let names = names();
            return Err(format!("no joints in it are known to have moved: {names} may be a command; {}", asks.topic));
        }
        ([], None) => return Err(format!("a {} log without joints (sensor_msgs/JointState)", logged.format)),
        _ => {}
    }
    let mut fitting = Vec::new();
    let mut why = String::new();
    for joints in sets {
        match axes(&joints.joints, &arm.joint_names) {
            Ok((place, told)) => fitting.push((joints, place, told)),
            Err(sentence) => why = format!("{}: {sentence}", shortened(&joints.name)),
        }
    }
    match (fitting.len(), fitting.pop()) {
        (1, Some((joints, ..))) if joints.unfit.is_some() => {
            Err(format!("{}: {}", shortened(&joints.name), joints.unfit.as_deref().unwrap_or_default()))
        }
        (1, Some(only)) => Ok(only),
        (0, _) => Err(why),
        _ => Err(format!("several topics have this arm's joints: {}; {}", names(), asks.topic)),
    }
}
