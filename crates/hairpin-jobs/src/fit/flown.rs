//! From a log's file to a flight of a mission.

use std::path::{Path, PathBuf};

use hairpin::campaign::fit::Flown;
use hairpin::campaign::{Case, CaseNumber, Setup};
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Channel, Track};
use hairpin_formats::logs::{self, EventKind, LogFrame, Logged, LoggedMotion, Sample};
use hairpin_formats::waypoints;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::{Problem, Watch};

/// What logs are flights of.
pub(super) enum Missions {
    /// All of this one, of this name.
    One(String, Box<Case>),
    /// Each of a case of a campaign's folder.
    Cases(PathBuf, Vec<Case>),
}

impl Missions {
    /// The waypoints of a file.
    pub(super) fn of_file(file: &Path, setup: &Setup) -> Result<Self, Problem> {
        let (points, _) = waypoints::read(file, &setup.scenario, setup.handed().farthest).map_err(Problem::input)?;
        if points.len() < 2 {
            return Err(Problem::of_file(
                file,
                format!("a mission needs at least 2 waypoints, this has {}", points.len()),
            ));
        }
        Ok(Self::One(file.display().to_string(), Box::new(Case::bare(CaseNumber(0), 0, points))))
    }

    /// The mission of the log in `file`, and its name.
    fn of(&self, file: &Path) -> Result<(String, &Case), Problem> {
        let (folder, cases) = match self {
            Self::One(name, case) => return Ok((name.clone(), case)),
            Self::Cases(folder, cases) => (folder, cases),
        };
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let number = name.split(['-', '.']).next().unwrap_or_default();
        let case = number.parse::<usize>().ok().and_then(|number| cases.iter().find(|case| case.number.0 == number));
        let case = case.ok_or_else(|| {
            let (folder, of) = (folder.display(), cases.len());
            let sentence = format!(
                "no case of {folder}, which has {of}: logs are called as `export` does, CASE-RUN.csv or CASE.exec.tum"
            );
            Problem::of_file(file, sentence)
        })?;
        Ok((format!("case {} of {}", case.id(), folder.display()), case))
    }
}

/// The flight that the log in `file` is of.
///
/// # Errors
/// It cannot be read, has no motion of a body, or is in another frame than the world's; no mission is known for it.
pub(super) fn flown(file: &Path, missions: &Missions, watch: &dyn Watch) -> Result<Flown, Problem> {
    let logged = logs::read(file).map_err(Problem::input)?;
    let (mission, case) = missions.of(file)?;
    match &logged.frame {
        LogFrame::Untold => {}
        LogFrame::Named(frame) => {
            watch.warn(&format!("{}: positions in the frame `{frame}` are taken for the world's", file.display()));
        }
        LogFrame::Enu(_) => {
            let why = "positions are east, north, up about a place of its own: give a log in the world's frame";
            return Err(Problem::of_file(file, why));
        }
    }
    let motion = logged.motions.first().ok_or_else(|| Problem::of_file(file, "no motion of a body"))?;
    let track = track(&logged, motion).map_err(|why| Problem::of_file(file, why))?;
    Ok(Flown { log: file.display().to_string(), mission, case: case.clone(), track })
}

/// What of a motion was the mission: from its begin, as far as the log tells it, to what ended it or the first moment
/// at which the source cannot be relied on.
fn track(logged: &Logged, motion: &LoggedMotion) -> Result<Track, String> {
    let of = |kind: EventKind| logged.events.iter().find(move |event| event.kind == kind).map(|event| event.t_s);
    let begin = of(EventKind::MissionBegins).unwrap_or(f64::NEG_INFINITY);
    let ends = [EventKind::MissionEnds, EventKind::Failsafe].map(|kind| of(kind).unwrap_or(f64::INFINITY));
    let cuts = motion.resets.iter().map(|reset| reset.t_s).chain(motion.invalid.iter().map(|span| span.from_s));
    let end = cuts.filter(|t| *t > begin).chain(ends).fold(f64::INFINITY, f64::min);
    let samples: Vec<&Sample> = motion.samples.iter().filter(|sample| (begin..end).contains(&sample.t_s)).collect();
    let first = samples.first().ok_or("no sample of the mission")?.t_s;
    let mut channels = Vec::new();
    let velocities: Option<Vec<Vector3<f64>>> = samples.iter().map(|sample| sample.v_m_s).collect();
    if let Some(velocities) = velocities {
        for (axis, name) in ["vx_m_s", "vy_m_s", "vz_m_s"].into_iter().enumerate() {
            channels.push(Channel { name: name.into(), values: velocities.iter().map(|v| v[axis]).collect() });
        }
    }
    if samples.iter().any(|sample| sample.attitude.is_none()) {
        channels.push(Channel { name: ATTITUDE_UNKNOWN.into(), values: vec![1.0; samples.len()] });
    }
    let pose = |sample: &&Sample| {
        let attitude = sample.attitude.unwrap_or_else(UnitQuaternion::identity);
        Isometry3::from_parts(sample.p_m.into(), attitude)
    };
    let times = samples.iter().map(|sample| sample.t_s - first).collect();
    Track::new(times, samples.iter().map(pose).collect(), channels).map_err(|error| error.to_string())
}
