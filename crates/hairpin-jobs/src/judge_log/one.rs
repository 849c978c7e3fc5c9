//! One log, from its file to its sentence.

use std::path::Path;

use hairpin::campaign::missed::Missed;
use hairpin::campaign::{Case, Log, judge_flown, plan_followed};
use hairpin::judgement::{Reference, Resolution, Settings, legs_of_samples, repeats};
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Channel, Ended, Flight, Track};
use hairpin_formats::logs::{self, Logged, Progress, Sample, Span};
use hairpin_formats::velocities::disagreement;
use nalgebra::Isometry3;

use super::accuracy::{accuracies, resolution};
use super::again::{again, of_flight};
use super::against::{Of, Ready};
use super::asked;
use super::asks::Asks;
use super::begin::Before;
use super::cut::{Left, Unsound, cut};
use super::due::due;
use super::found::{Found, JudgedLog};
use super::frame::{FrameTold, IntoWorld};
use super::heights::Heights;
use super::left_out::LeftOut;
use super::legs::{Course, LegsBy, Mission, check_column, course, first_near, mission};
use super::reached::{missed, untrue};
use super::settings::LogSettings;
use super::{matching, over, source, told};
use crate::Problem;
use crate::execute::run_with_motion;

/// An autopilot was nowhere near a waypoint at so many times what counts as reached …
const NOWHERE: f64 = 3.0;
/// … and no nearer than this, m: its own radius is not the scenario's, 2 m across and less in height unless it is set.
const OWN_RADIUS_M: f64 = 2.5;

/// Judges the log in `file`.
///
/// # Errors
/// As of [`super::judge_log`] of a single log.
pub(super) fn judge_file(file: &Path, against: &Ready, settings: &LogSettings) -> Result<JudgedLog, Problem> {
    let logged = logs::read(file).map_err(Problem::input)?;
    judge(file, &logged, against, settings).map_err(|problem| match problem {
        Problem::Input(sentence) => Problem::of_file(file, sentence),
        other => other,
    })
}

/// Judges a log that was read from `file`.
///
/// # Errors
/// It fits no case or does not lie where its mission begins.
pub(super) fn judge(
    file: &Path,
    logged: &Logged,
    against: &Ready,
    settings: &LogSettings,
) -> Result<JudgedLog, Problem> {
    let (motion, source) = source::choose(logged, settings.source.as_deref())?;
    Heights::needed(&against.setup, motion).map_err(Problem::input)?;
    let frame = IntoWorld::of(&logged.frame, against.place.as_ref(), &settings.frame)?;
    let span = mission(logged, [settings.from_s, settings.to_s]);
    let in_span = motion.samples.iter().filter(|sample| (span.from_s..=span.to_s).contains(&sample.t_s));
    let mut samples = in_span.map(|sample| frame.sample(sample)).collect::<Result<Vec<Sample>, Problem>>()?;
    let unlike = believe_velocities(&mut samples);
    let repeated = leave_out_repeats(&mut samples, resolution(motion).place.all);
    let lift_m = settings.frame.offset_m[2];
    let heights = Heights::of(&against.setup, (&logged.frame, motion), lift_m).filter(|_| against.in_world);
    let unstable = heights.as_ref().map_or_else(Vec::new, |heights| heights.put(&mut samples));
    let heights_told = heights.as_ref().map(|heights| heights.in_words(&samples, unstable.len()));
    let progress =
        logged.progress.iter().map(|step| frame.progress(step)).collect::<Result<Vec<Progress>, Problem>>()?;
    let progress = of_flight(progress, &span, (logged, &against.cases, against.accept));
    if frame.told.by_earth {
        in_reach(&samples, against.setup.handed().farthest)?;
    }
    let (case, matched) = match &against.cases[..] {
        [only] => (only, None),
        cases if samples.is_empty() => (&cases[0], None),
        cases => {
            let plan = |case: &Case| -> Result<Option<Track>, Problem> {
                Ok(plan_followed(&against.setup, &against.whole(case)?))
            };
            let log = (logged, &progress[..], against.accept);
            let found = matching::matched(cases, &samples, log, (&plan, &Asks::JUDGE))?;
            (found.0, Some(found.1))
        }
    };
    check_column(logged, case.waypoints.len()).map_err(Problem::input)?;
    let course = course(logged, &progress, &case.waypoints, against.accept);
    let by_earth = frame.told.by_earth;
    let no_heights = heights.is_some();
    let judged = Judging { logged, against, span: &span, course: course.as_ref(), case, by_earth, no_heights };
    let seen_s = samples.first().map(|sample| sample.t_s);
    let own = if span.never_began.is_some() { Vec::new() } else { judged.own_part(samples)? };
    let mut due = due(logged, &span, course.as_ref());
    if course.is_none() && own.first().map(|sample| sample.t_s) != seen_s {
        // On its way to the first waypoint it is at none of the legs.
        due.from_s = f64::NEG_INFINITY;
    }
    let invalid: Vec<Span> = motion.invalid.iter().copied().chain(unstable).collect();
    let unsound = Unsound { resets: &motion.resets, invalid: &invalid, dropouts: &logged.dropouts };
    let left = cut(&own, unsound, due, &against.swiftness);
    let left_out = judged.told_course().and_then(|course| LeftOut::of(course, &own, motion, settings.from_s));
    let (missed, to_the_end) = judged.end(&own, &left, left_out.is_some());
    let finished = to_the_end && left_out.is_none();
    let is_asked = settings.from_s.or(settings.to_s).is_some();
    let behind = |near_m| again(logged, &span, (&frame, motion), (&case.waypoints, near_m));
    let again_s = if is_asked { None } else { behind(judged.near_m())? };
    let name = against.name_of(case);
    let simulated = against.simulated.iter().find(|result| result.case == case.number);
    let mut notes = logged.notes.clone();
    if !logged.progress.is_empty() && course.is_none() {
        notes.push("the items of the log's mission are not the waypoints: legs are assigned".into());
    }
    notes.extend(heights_told);
    notes.extend(unlike);
    notes.extend(repeated);
    notes.extend(again_s.map(told::again));
    notes.extend(left_out.as_ref().map(LeftOut::in_words));
    let (accuracy, untold) = accuracies(&left.samples);
    notes.extend(untold);
    let mut found = Found {
        case: name,
        matched,
        source,
        frame: FrameTold { heights_by_map: no_heights, ..frame.told },
        span_s: left.samples.first().zip(left.samples.last()).map(|(first, last)| [first.t_s, last.t_s]),
        legs_by: course.as_ref().map_or(LegsBy::Assigned, |course| course.by),
        cuts: left.cuts.clone(),
        ended: span.ended.clone().or_else(|| {
            let to_s = settings.to_s.filter(|to| motion.samples.iter().any(|sample| sample.t_s > *to))?;
            Some(format!("--to at t = {to_s:.1} s"))
        }),
        finished,
        to_the_end,
        left_out,
        missed,
        again_s,
        never_began: span.never_began.clone(),
        flown: None,
        asked: None,
        simulated_m: simulated.and_then(|result| Some(result.measured()?.max_deviation)),
        notes,
    };
    let whole = against.whole(case)?;
    let log = if left.samples.len() >= 2 {
        Some(judged.to_judge(&left, (accuracy, resolution(motion)), &whole)?)
    } else {
        None
    };
    if let Some(log) = &log {
        found.notes.extend(against.setup.backwards(&whole, &log.flight.track));
        let mut flown = judge_flown(&against.setup, &whole, log).map_err(Problem::input)?;
        let told = mission(logged, [span.since_s, None]);
        let start = (case.waypoints[0], against.accept);
        let before = Before { motion, told: &told, from_s: settings.from_s, start };
        flown.doubts.extend(before.doubt(&flown, &own));
        flown.doubts.extend(before.end(&flown, &own, settings.to_s));
        if let Some(asked) = against.asked_of(case) {
            let asked = asked::hold(asked, log, &mut flown);
            found.notes.extend(asked.notes);
            found.asked = asked.open;
        }
        found.flown = Some(flown);
    }
    if let (None, Some(simulated)) = (&course, simulated) {
        let told_m = found.simulated_m;
        found.simulated_m = judged.simulated_alike(&whole, simulated.run);
        let limit = against.setup.scenario.deviation_limit();
        found.notes.extend(told::told_otherwise([found.simulated_m, told_m], limit));
    }
    let judged = told::judged((file, &told::name_in(&settings.path, file)), found, &against.setup);
    match settings.page {
        Some(_) => over::of_flight(judged, &whole, log, against),
        None => Ok(judged),
    }
}

/// Leaves out velocities that are not those of the positions beside them, and tells so: who believes them judges
/// accelerations that nobody had, and what may hide between samples by a motion that there was not.
fn believe_velocities(samples: &mut [Sample]) -> Option<String> {
    let velocities: Vec<[f64; 3]> = samples.iter().map(|sample| sample.v_m_s.map(Into::into)).collect::<Option<_>>()?;
    let times: Vec<f64> = samples.iter().map(|sample| sample.t_s).collect();
    let pose = |sample: &Sample| Isometry3::from_parts(sample.p_m.into(), sample.attitude.unwrap_or_default());
    let poses: Vec<_> = samples.iter().map(pose).collect();
    let found = disagreement(&times, &poses, &velocities)?;
    samples.iter_mut().for_each(|sample| sample.v_m_s = None);
    Some(format!("{}: its velocities are not believed, it is judged by positions alone", found.in_words()))
}

/// Leaves out samples that repeat a place while the robot moves on, of places told in steps of `step` m, and tells so.
fn leave_out_repeats(samples: &mut Vec<Sample>, step: f64) -> Option<String> {
    let times: Vec<f64> = samples.iter().map(|sample| sample.t_s).collect();
    let stale = repeats(&times, &|i, j| (samples[j].p_m - samples[i].p_m).norm(), step);
    let (count, all) = (stale.iter().filter(|stale| **stale).count(), samples.len());
    let mut stale = stale.iter();
    samples.retain(|_| stale.next().is_none_or(|stale| !stale));
    told::repeated(count, all)
}

/// Refuses a log of which no sample lies within `farthest` m of the world's origin: as of missions, it is of another
/// place, or its latitudes and longitudes are exchanged.
fn in_reach(samples: &[Sample], farthest: f64) -> Result<(), Problem> {
    let is_there = |sample: &Sample| sample.p_m.iter().all(|x| x.abs() <= farthest);
    let Some(first) = samples.first().filter(|_| !samples.iter().any(is_there)) else { return Ok(()) };
    let (far, most) = (first.p_m.coords.norm() / 1000.0, farthest / 1000.0);
    Err(Problem::input(format!(
        "it was flown elsewhere on Earth: {far:.1} km from the world's origin at t = {:.1} s, {most} at most; latitude and \
         longitude may be exchanged, or world.origin is another place's",
        first.t_s
    )))
}

struct Judging<'a> {
    logged: &'a Logged,
    against: &'a Ready,
    span: &'a Mission,
    course: Option<&'a Course>,
    case: &'a Case,
    /// Whether its place is known by the Earth's.
    by_earth: bool,
    /// Whether its heights are the ground's.
    no_heights: bool,
}

impl Judging<'_> {
    /// The samples between waypoints: from where the mission left the first one on, until it went on behind the last.
    /// Where it does not say, from where the robot first is at the first one; of a log that says nothing at all that
    /// must be its first sample, for it may as well lie elsewhere.
    fn own_part(&self, samples: Vec<Sample>) -> Result<Vec<Sample>, Problem> {
        let (start, accept) = (self.case.waypoints[0], self.against.accept);
        if let Some(course) = self.course {
            let own: Vec<Sample> = samples.into_iter().filter(|sample| course.leg_at(sample.t_s).is_some()).collect();
            // Targets are places: they were found where the waypoints are.
            let told = self.by_earth || course.by == LegsBy::Targets;
            return match own.first() {
                Some(first) if !told && (first.p_m - start).norm() > accept && course.leg_at(first.t_s) == Some(0) => {
                    Err(self.elsewhere(first, (first.p_m - start).norm()))
                }
                _ => Ok(own),
            };
        }
        let Some(first) = samples.first() else { return Ok(samples) };
        let far = (first.p_m - start).norm();
        if far <= accept {
            return Ok(samples);
        }
        if !self.span.is_told && !self.by_earth {
            return Err(self.elsewhere(first, far));
        }
        match first_near(&samples, &start, accept) {
            Ok(near) => Ok(samples[near..].to_vec()),
            Err(nearest) => Err(Problem::input(format!(
                "it never is within {accept} m of waypoint 0 of {}, {}; the nearest is {nearest:.2} m: not aligned, \
                 --offset X,Y,Z and --turn DEG move it by name",
                self.against.name_of(self.case),
                place(&start)
            ))),
        }
    }

    /// Within how much a waypoint counts as reached, m.
    fn accept_m(&self) -> f64 {
        self.against.setup.scenario.deviation_limit().unwrap_or(0.0).max(self.against.accept)
    }

    /// Beyond how much nobody was anywhere near it, m.
    fn near_m(&self) -> f64 {
        (NOWHERE * self.accept_m()).max(OWN_RADIUS_M)
    }

    /// The course that an autopilot tells of itself, which a table's column is not.
    fn told_course(&self) -> Option<&Course> {
        self.course.filter(|_| self.logged.format != "CSV")
    }

    /// The first waypoint that it was never at, and whether it flew the mission to its end; of what `is_part` the
    /// beginning is not looked at.
    ///
    /// An autopilot says itself when it has reached one, and its own acceptance may be wider than the scenario's, but
    /// not as if anything were: what it says it was at it was near. What it says after the judged part has ended is of
    /// what is not judged. Of all others ending at the last waypoint is not enough: a mission may lead back to its
    /// start, or cross itself.
    fn end(&self, own: &[Sample], left: &Left, is_part: bool) -> (Option<Missed>, bool) {
        let waypoints = &self.case.waypoints[..];
        let accept = self.accept_m();
        let (last, to_s) = (waypoints.len() - 1, self.span.to_s);
        let flew = self.course.is_none_or(|course| course.is_whole(waypoints.len(), to_s));
        let near_last = own.last().is_some_and(|sample| (sample.p_m - waypoints[last]).norm() <= self.against.accept);
        let Some(course) = self.told_course() else {
            let missed = missed(&left.samples, waypoints, accept);
            return (missed, flew && near_last && missed.is_none());
        };
        let says_so = self.span.ended.as_ref().is_some_and(|words| words.starts_with("mission_result finished"));
        let is_over = flew && (says_so || course.is_done(to_s));
        let leg = |sample: Option<&Sample>| course.leg_at(sample?.t_s);
        let (Some(begins), Some(ends)) = (leg(own.first()), leg(own.last())) else { return (None, false) };
        // Where it was when it left a waypoint that --from leaves out is not seen.
        let first = if begins == 0 && !is_part { 0 } else { begins + 1 };
        let told = first..=if is_over { last } else { ends };
        let missed = untrue(own, (course, told), waypoints, self.near_m());
        (missed, flew && missed.is_none() && (is_over || near_last))
    }

    /// Why a log whose frame is only taken for the world's is refused.
    fn elsewhere(&self, first: &Sample, far: f64) -> Problem {
        let (start, p) = (self.case.waypoints[0], first.p_m);
        let move_by = start - p;
        Problem::input(format!(
            "its frame is not told to be the world's, and it does not begin where its mission does: {} at t = {:.1} s, {far:.2} m \
             from waypoint 0 of {}, {}, with {} m accepted. Nothing is aligned: --offset {:.2},{:.2},{:.2} (after --turn DEG) \
             moves it by name, --from S begins later, --case ID names another case",
            place(&p),
            first.t_s,
            self.against.name_of(self.case),
            place(&start),
            self.against.accept,
            move_by.x,
            move_by.y,
            if self.no_heights { 0.0 } else { move_by.z },
        ))
    }

    /// The legs of a track that tells none.
    fn assigned(&self, track: &Track, whole: &Case, breaks: &[usize]) -> Result<Channel, Problem> {
        let plan = plan_followed(&self.against.setup, whole);
        let reference = plan.as_ref().map_or(Reference::Leg, Reference::Path);
        let settings = Settings { reference, breaks, ..Settings::default() };
        let legs = legs_of_samples(track, &self.case.waypoints, &settings).map_err(Problem::input)?;
        Ok(Channel { name: "leg".into(), values: legs.into_iter().map(|leg| leg as f64).collect() })
    }

    /// The largest deviation (m) of a run of the campaign as if it were a log of poses alone: its own legs, which its
    /// executor told, are others than those that cost least, and a log of the same motion would differ from it.
    ///
    /// `None` where its motion is not to be had.
    fn simulated_alike(&self, whole: &Case, run: usize) -> Option<f64> {
        let Of::Campaign(work) = &self.against.of else { return None };
        let flight = run_with_motion(work, whole, run).ok()??.outcome.ok()?;
        let (times, poses) = (flight.track.times().to_vec(), flight.track.poses().to_vec());
        let with = |channels: Vec<Channel>| Track::new(times.clone(), poses.clone(), channels).ok();
        let mut channels: Vec<Channel> = flight.track.channels().to_vec();
        channels.retain(|channel| channel.name != "leg");
        channels.push(self.assigned(&with(channels.clone())?, whole, &[]).ok()?);
        let flight = Flight { track: with(channels)?, ..flight };
        let resolution = Resolution::default();
        let log = Log { flight, breaks: Vec::new(), accuracy: Vec::new(), resolution, in_world: false };
        Some(judge_flown(&self.against.setup, whole, &log).ok()?.measures.max_deviation)
    }

    /// What is left as a log to be judged, of the case with its plan.
    fn to_judge(
        &self,
        left: &Left,
        (accuracy, resolution): (Vec<Option<[f64; 2]>>, Resolution),
        whole: &Case,
    ) -> Result<Log, Problem> {
        let samples = &left.samples;
        let column = |name: &str, of: &dyn Fn(&Sample) -> f64| Channel {
            name: name.into(),
            values: samples.iter().map(of).collect(),
        };
        let mut channels = Vec::new();
        if samples.iter().all(|sample| sample.v_m_s.is_some()) {
            for (axis, name) in ["vx_m_s", "vy_m_s", "vz_m_s"].into_iter().enumerate() {
                channels.push(column(name, &|sample| sample.v_m_s.map_or(0.0, |v| v[axis])));
            }
        }
        if samples.iter().any(|sample| sample.attitude.is_none()) {
            channels.push(column(ATTITUDE_UNKNOWN, &|_| 1.0));
        }
        if let Some(course) = self.course {
            channels.push(column("leg", &|sample| course.leg_at(sample.t_s).unwrap_or_default() as f64));
        }
        let pose = |sample: &Sample| Isometry3::from_parts(sample.p_m.into(), sample.attitude.unwrap_or_default());
        let times: Vec<f64> = samples.iter().map(|sample| sample.t_s).collect();
        let refuse = |error| Problem::input(format!("{}: {error}", self.logged.format));
        let of = |channels| Track::new(times.clone(), samples.iter().map(pose).collect(), channels).map_err(refuse);
        let mut track = of(channels.clone())?;
        if self.course.is_none() {
            channels.push(self.assigned(&track, whole, &left.breaks)?);
            track = of(channels)?;
        }
        let reached = vec![Some(0.0); self.case.waypoints.len()];
        let flight = Flight { track, ended: Ended::Done, left_world: None, reached };
        Ok(Log { flight, breaks: left.breaks.clone(), accuracy, resolution, in_world: self.against.in_world })
    }
}

fn place(p: &nalgebra::Point3<f64>) -> String {
    format!("({:.2}, {:.2}, {:.2}) m", p.x, p.y, p.z)
}
