//! From a log's file to a motion over a mission.

use std::path::{Path, PathBuf};

use hairpin::campaign::fit::Flown;
use hairpin::campaign::{Case, CaseNumber, Setup, plan_followed};
use hairpin::judgement::Resolution;
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Channel, Track};
use hairpin_formats::frames::Geodetic;
use hairpin_formats::logs::{self, EventKind, LogFrame, Logged, LoggedMotion, Progress, Sample};
use hairpin_formats::missions::Frame;
use hairpin_formats::placement::Placement;
use hairpin_formats::velocities::disagreement;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use super::once::Read;
use crate::check::read_about_home;
use crate::judge_log::{
    Asks, FrameSettings, Heights, IntoWorld, LegsBy, arm_of, best, course, matched, ran, resolution,
};
use crate::missions::followed;
use crate::{Problem, Watch};

/// What logs are flights of.
pub(super) enum Missions {
    /// All of this one, of this name, about this place on Earth where that is its own home.
    One(String, Box<Case>, Option<Geodetic>),
    /// Each of a case of a campaign's folder.
    Cases(PathBuf, Vec<Case>),
}

impl Missions {
    /// The mission of a file.
    pub(super) fn of_file(file: &Path, setup: &Setup, watch: &dyn Watch) -> Result<Self, Problem> {
        let mission = read_about_home(setup, file)?;
        followed(setup, &mission)?;
        mission.notes.iter().for_each(|note| watch.warn(&format!("{}: {note}", file.display())));
        let home = match mission.frame {
            Frame::Home(home) => Some(home),
            Frame::World | Frame::Placed => None,
        };
        let case = Case::bare(CaseNumber(0), 0, mission.waypoints);
        Ok(Self::One(file.display().to_string(), Box::new(case), home))
    }

    /// Where on Earth the frame is that they are in.
    ///
    /// # Errors
    /// Not at a place of the Earth.
    fn place(&self, setup: &Setup) -> Result<Option<Placement>, Problem> {
        match self {
            Self::One(_, _, Some(home)) => Ok(Some(Placement::about(home))),
            Self::One(..) | Self::Cases(..) => Placement::of(&setup.scenario).map_err(Problem::input),
        }
    }

    /// The only case, or the campaign's that the log in `file` is called after; `None` of one that is called otherwise.
    fn named(&self, file: &Path) -> Result<Option<&Case>, Problem> {
        let (folder, cases) = match self {
            Self::One(_, case, _) => return Ok(Some(case)),
            Self::Cases(folder, cases) => (folder, cases),
        };
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let number = name.split(['-', '.']).next().unwrap_or_default();
        match (number.parse::<usize>(), &cases[..]) {
            (Ok(number), _) => {
                let case = cases.iter().find(|case| case.number.0 == number).ok_or_else(|| {
                    let (folder, of) = (folder.display(), cases.len());
                    let why = format!("no case of {folder}, which has {of}: logs may be called CASE-RUN.csv");
                    Problem::of_file(file, why)
                });
                case.map(Some)
            }
            (Err(_), [only]) => Ok(Some(only)),
            (Err(_), _) => Ok(None),
        }
    }

    /// All that there are.
    fn cases(&self) -> &[Case] {
        match self {
            Self::One(_, case, _) => std::slice::from_ref(case.as_ref()),
            Self::Cases(_, cases) => cases,
        }
    }

    /// What the mission of `case` is called.
    fn name(&self, case: &Case) -> String {
        match self {
            Self::One(name, ..) => name.clone(),
            Self::Cases(folder, _) => format!("case {} of {}", case.id(), folder.display()),
        }
    }

    /// The mission of the log in `file`: the one that it is called after, else the one that its targets or its track
    /// say.
    fn of(&self, file: &Path, log: &InWorld, setup: &Setup) -> Result<&Case, Problem> {
        if let Some(named) = self.named(file)? {
            return Ok(named);
        }
        let plan = |case: &Case| -> Result<Option<Track>, Problem> { Ok(plan_followed(setup, case)) };
        let of = (log.logged, &log.progress[..], log.accept);
        let found = matched(self.cases(), &log.samples, of, (&plan, &Asks::FIT));
        found.map(|(case, _)| case).map_err(|problem| Problem::of_file(file, problem.to_string()))
    }
}

/// A log in the world's frame.
struct InWorld<'a> {
    logged: &'a Logged,
    /// Where its items are.
    progress: Vec<Progress>,
    /// What of its best motion was the mission, as far as the log tells it by events.
    samples: Vec<Sample>,
    /// A waypoint counts as reached within this, m.
    accept: f64,
}

/// The motion that the log in `file` is of: an arm's by its joints, all others in the world's frame.
///
/// # Errors
/// It cannot be read, has no motion of a body, or is about a place on Earth of its own where the world has none; no
/// mission is known for it.
pub(super) fn flown(file: &Path, missions: &Missions, setup: &Setup, watch: &dyn Watch) -> Result<Read, Problem> {
    if let Some(arm) = arm_of(setup) {
        let named = missions.named(file)?;
        let (case, track) = ran(file, arm, named.map_or(missions.cases(), std::slice::from_ref), &Asks::FIT)?;
        let step_m = Resolution::of(&track).place.all;
        let (log, mission) = (file.display().to_string(), missions.name(case));
        return Ok(Read { flown: Flown { log, mission, case: case.clone(), track }, step_m });
    }
    let logged = logs::read(file).map_err(Problem::input)?;
    let place = missions.place(setup)?;
    match (&logged.frame, &place) {
        (LogFrame::Named(frame), _) => {
            watch.warn(&format!("{}: positions in the frame `{frame}` are taken for the world's", file.display()));
        }
        (LogFrame::Enu(Some(_)), None) => {
            let why =
                "positions are east, north, up about a place on Earth, and the world has none: give it `world.origin`";
            return Err(Problem::of_file(file, why));
        }
        _ => {}
    }
    let motion = best(&logged, &Asks::FIT).map_err(|why| Problem::of_file(file, why))?;
    Heights::needed(setup, motion).map_err(|why| Problem::of_file(file, why))?;
    let frame = IntoWorld::of(&logged.frame, place.as_ref(), &FrameSettings::default())?;
    let mut samples =
        mission_of(&logged, motion).map(|sample| frame.sample(sample)).collect::<Result<Vec<Sample>, _>>()?;
    if let Some(heights) = Heights::of(setup, (&logged.frame, motion), 0.0) {
        // Its case is looked for in space; a fit of what drives is in the plane.
        heights.put(&mut samples);
    }
    let progress = logged.progress.iter().map(|step| frame.progress(step)).collect::<Result<_, _>>()?;
    let log = InWorld { logged: &logged, progress, samples, accept: setup.scenario.executor().accept };
    let case = missions.of(file, &log, setup)?;
    let track = track(&log, case).map_err(|why| Problem::of_file(file, why))?;
    // In the log's own frame: turned into the world's, steps are no longer to be seen.
    let step_m = resolution(motion).place.all;
    let (log, mission) = (file.display().to_string(), missions.name(case));
    Ok(Read { flown: Flown { log, mission, case: case.clone(), track }, step_m })
}

/// What of a motion was the mission: from its begin, as far as the log tells it, to what ended it or the first moment
/// at which the source cannot be relied on.
fn mission_of<'a>(logged: &Logged, motion: &'a LoggedMotion) -> impl Iterator<Item = &'a Sample> {
    let of = |kind: EventKind| logged.events.iter().find(move |event| event.kind == kind).map(|event| event.t_s);
    let begin = of(EventKind::MissionBegins).unwrap_or(f64::NEG_INFINITY);
    let ends = [EventKind::MissionEnds, EventKind::Failsafe].map(|kind| of(kind).unwrap_or(f64::INFINITY));
    let cuts = motion.resets.iter().map(|reset| reset.t_s).chain(motion.invalid.iter().map(|span| span.from_s));
    let end = cuts.filter(|t| *t > begin).chain(ends).fold(f64::INFINITY, f64::min);
    motion.samples.iter().filter(move |sample| (begin..end).contains(&sample.t_s))
}

/// The motion over the waypoints of `case`: from where the mission's own state says that it left the first one, until
/// it went on behind the last; of a log that does not say, all of it.
fn track(log: &InWorld, case: &Case) -> Result<Track, String> {
    let course = course(log.logged, &log.progress, &case.waypoints, log.accept);
    let course = course.filter(|course| course.by == LegsBy::Targets);
    let at_it = |sample: &&Sample| course.as_ref().is_none_or(|course| course.leg_at(sample.t_s).is_some());
    let samples: Vec<&Sample> = log.samples.iter().filter(at_it).collect();
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
    let times: Vec<f64> = samples.iter().map(|sample| sample.t_s - first).collect();
    let poses: Vec<_> = samples.iter().map(pose).collect();
    let told: Option<Vec<[f64; 3]>> = samples.iter().map(|sample| sample.v_m_s.map(Into::into)).collect();
    if let Some(unlike) = told.and_then(|told| disagreement(&times, &poses, &told)) {
        return Err(format!("{}: leave velocities out where they are not known", unlike.in_words()));
    }
    Track::new(times, poses, channels).map_err(|error| error.to_string())
}
