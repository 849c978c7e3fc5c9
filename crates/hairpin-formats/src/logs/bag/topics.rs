//! What was recorded of one topic.

use super::super::accuracy::half;
use super::super::error::Fault;
use super::super::log::{Clock, Joints, LoggedMotion, Sample, Source};
use super::super::samples::Budget;
use super::super::twice::{apart, places_apart, told, two, two_places};
use super::cdr::{Cdr, NoMessage};
use super::messages::{Kind, Pose, joints, odometry, path, pose};
use crate::quote::shortened;

/// Sets of joints that one topic may tell of, by turns.
const MOST_SETS: usize = 16;
/// Stamps are told in milliseconds or finer, s; twice that, for what moves may go faster in between.
const COARSE_S: f64 = 2e-3;
/// A recorder that was held up takes what came in as much time with one stamp, s.
const HELD_UP_S: f64 = 0.5;

/// One topic.
#[derive(Debug)]
pub(super) struct Topic {
    pub(super) name: String,
    kind: Kind,
    frame: Option<String>,
    samples: Vec<Sample>,
    sets: Vec<Set>,
    /// When each sample, or row, was received, s.
    received: Vec<f64>,
    paths: usize,
    /// Whether any header has a stamp.
    stamped: bool,
    seen: bool,
    /// Messages that are none of the type, and where the first is.
    broken: usize,
    first_broken: usize,
    /// Samples in another frame than the first.
    elsewhere: usize,
    /// Samples whose accuracy is told across or up alone.
    halves: usize,
}

#[derive(Debug)]
struct Set {
    names: Vec<String>,
    times: Vec<f64>,
    received: Vec<f64>,
    rows: Vec<Vec<f64>>,
}

impl Topic {
    pub(super) fn of(name: String, kind: Kind) -> Self {
        let (frame, samples, sets, received, paths, stamped, seen) = Default::default();
        let (broken, first_broken, elsewhere, halves) = Default::default();
        Self {
            name,
            kind,
            frame,
            samples,
            sets,
            received,
            paths,
            stamped,
            seen,
            broken,
            first_broken,
            elsewhere,
            halves,
        }
    }

    pub(super) fn push(
        &mut self,
        data: &[u8],
        received_ns: u64,
        offset: usize,
        budget: &mut Budget,
    ) -> Result<(), Fault> {
        self.seen = true;
        let taken = Cdr::of(data).and_then(|mut cdr| self.take(&mut cdr, received_ns as f64 / 1e9));
        match taken {
            Ok(samples) => (0..samples).try_for_each(|_| budget.take()),
            Err(NoMessage) => {
                if self.broken == 0 {
                    self.first_broken = offset;
                }
                self.broken += 1;
                Ok(())
            }
        }
    }

    /// Takes a message, and says of how many samples it was.
    fn take(&mut self, cdr: &mut Cdr, received_s: f64) -> Result<usize, NoMessage> {
        match self.kind {
            Kind::Pose => {
                let pose = pose(cdr)?;
                Ok(self.sample(&pose, received_s))
            }
            Kind::Odometry => {
                let pose = odometry(cdr)?;
                Ok(self.sample(&pose, received_s))
            }
            Kind::Path => {
                let poses = path(cdr)?;
                self.paths += 1;
                let rises = poses.windows(2).all(|pair| pair[0].header.stamp_ns < pair[1].header.stamp_ns);
                // A path is the whole way each time; the last that has times counts.
                if rises && poses.len() > 1 {
                    let before = self.samples.len();
                    self.samples.clear();
                    self.received.clear();
                    let now: usize = poses.iter().map(|pose| self.sample(pose, received_s)).sum();
                    return Ok(now.saturating_sub(before));
                }
                Ok(0)
            }
            Kind::Joints => self.row(cdr, received_s),
        }
    }

    fn sample(&mut self, pose: &Pose, received_s: f64) -> usize {
        let frame = self.frame.get_or_insert_with(|| pose.header.frame.to_owned());
        if frame != pose.header.frame {
            self.elsewhere += 1;
            return 0;
        }
        self.stamped |= pose.header.stamp_ns != 0;
        self.received.push(received_s);
        self.halves += usize::from(pose.is_half && pose.accuracy_m.is_some());
        self.samples.push(Sample {
            t_s: pose.header.stamp_ns as f64 / 1e9,
            p_m: pose.p_m,
            attitude: pose.attitude,
            v_m_s: pose.v_m_s,
            accuracy_m: pose.accuracy_m,
        });
        1
    }

    fn row(&mut self, cdr: &mut Cdr, received_s: f64) -> Result<usize, NoMessage> {
        let (stamp_ns, names, positions) = joints(cdr)?;
        if names.is_empty() {
            return Ok(0);
        }
        let order = |set: &Set| -> Option<Vec<usize>> {
            let places = set.names.iter().map(|name| names.iter().position(|other| other == name));
            places.collect::<Option<Vec<_>>>().filter(|places| places.len() == names.len())
        };
        let known = self.sets.iter().enumerate().find_map(|(index, set)| Some((index, order(set)?)));
        let (index, order) = match known {
            Some(known) => known,
            None if self.sets.len() < MOST_SETS => {
                let names = names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
                let order = (0..names.len()).collect();
                self.sets.push(Set { names, times: Vec::new(), received: Vec::new(), rows: Vec::new() });
                (self.sets.len() - 1, order)
            }
            None => return Err(NoMessage),
        };
        self.stamped |= stamp_ns != 0;
        let set = &mut self.sets[index];
        set.times.push(stamp_ns as f64 / 1e9);
        set.received.push(received_s);
        set.rows.push(order.into_iter().map(|place| positions[place]).collect());
        // A row of many joints counts for more than one of few.
        Ok(names.len().div_ceil(8))
    }

    /// Whether there are messages, and none has a stamp in its header.
    pub(super) fn is_without_stamps(&self) -> bool {
        !self.stamped && (!self.samples.is_empty() || !self.sets.is_empty())
    }

    /// Who says so, as far as type and name tell.
    pub(super) fn source(&self) -> Source {
        match self.kind {
            _ if is_asked(&self.name) => Source::Asked,
            Kind::Path => Source::Way,
            Kind::Pose | Kind::Odometry | Kind::Joints => Source::Untold,
        }
    }

    /// Adds what moved, by one clock; its frame where it has one, and what is to be told of it.
    pub(super) fn finish(
        self,
        clock: Clock,
        motions: &mut Vec<LoggedMotion>,
        all: &mut Vec<Joints>,
    ) -> (Option<(String, String)>, Vec<String>) {
        let source = self.source();
        let Self { name, samples, sets, received, mut frame, .. } = self;
        let mut notes = Vec::new();
        if self.broken > 0 {
            notes.push(format!(
                "{name}: {} messages that are none of its type, the first at byte {}",
                self.broken, self.first_broken
            ));
        }
        if self.elsewhere > 0 {
            notes.push(format!("{name}: {} poses in another frame than the first are not read", self.elsewhere));
        }
        notes.extend(half(&name, self.halves));
        if self.kind == Kind::Path && self.seen {
            let which = match (samples.is_empty(), clock) {
                (true, _) => "none has poses with stamps that rise: a plan, not a motion",
                (false, Clock::Header) => "the last one with stamps is read",
                (false, _) => "its poses have no time by the recorder's clock: not read",
            };
            notes.push(format!("{name}: {} paths; {which}", self.paths));
        }
        let is_timeless = self.kind == Kind::Path && clock != Clock::Header;
        if !samples.is_empty() && !is_timeless {
            let mut rows: Vec<(f64, Sample)> = samples.into_iter().map(|sample| (sample.t_s, sample)).collect();
            if clock == Clock::Receive {
                rows.iter_mut().zip(received).for_each(|((t_s, sample), at)| (*t_s, sample.t_s) = (at, at));
            }
            let far = |one: &Sample, other: &Sample| places_apart(&one.p_m, &other.p_m).unwrap_or_default();
            let (rows, twice) = rising(rows, clock, &far);
            let unfit = twice.tell(&name, &mut notes, |(t_s, one), other| two_places(*t_s, &one.p_m, &other.p_m));
            let samples: Vec<Sample> = rows.into_iter().map(|(_, sample)| sample).collect();
            let (resets, invalid) = Default::default();
            motions.push(LoggedMotion { name: name.clone(), source, samples, resets, invalid, unfit });
        } else {
            frame = None;
        }
        let many = sets.len() > 1;
        for (index, set) in sets.into_iter().enumerate() {
            let times = if clock == Clock::Receive { set.received } else { set.times };
            let name = if many { format!("{name}[{index}]") } else { name.clone() };
            let far = |one: &Vec<f64>, other: &Vec<f64>| farthest(one, other).map_or(0.0, |(_, far)| far);
            let (rows, twice) = rising(times.into_iter().zip(set.rows).collect(), clock, &far);
            let unfit = twice.tell(&name, &mut notes, |(t_s, one), other| {
                let joint = farthest(one, other).map_or(0, |(joint, _)| joint);
                let [one, other] = [one, other].map(|row| format!("{} rad", told(row[joint])));
                two(*t_s, &format!("positions of the joint {}", shortened(&set.names[joint])), &one, &other)
            });
            let (times_s, positions_rad) = rows.into_iter().unzip();
            all.push(Joints { name, source, joints: set.names, times_s, positions_rad, unfit });
        }
        (frame.map(|frame| (name, frame)), notes)
    }
}

/// Words in names of topics that are no motions but what motions are to be.
const ASKED: &str = "carrot clicked cmd command commanded commands demand demanded des desired expected fake goal goals \
                     ideal initial lookahead nominal plan planned planner planning plans predicted prediction ref \
                     reference requested setpoint setpoints sp target targets tgt wanted waypoint waypoints wp wps";
/// What is written together with them: `goalpose`, `jointcmd`.
const BODIES: [&str; 8] = ["pose", "position", "odometry", "odom", "path", "states", "state", "joint"];

/// Whether the name of a topic says that it was asked for: `/firefly/command/pose`, `/goal_pose`, `/targetPose2`,
/// `/set_point`, and what PX4 is told (`/fmu/in/…`).
fn is_asked(name: &str) -> bool {
    let words = words(name);
    let is = |word: &str| ASKED.split(' ').any(|asked| asked == word);
    let is_beside =
        |word: &str, body: &str| word.strip_suffix(body).is_some_and(is) || word.strip_prefix(body).is_some_and(is);
    words.iter().any(|word| is(word) || BODIES.iter().any(|body| is_beside(word, body)))
        || words.windows(2).any(|pair| pair[0] == "set" && pair[1].starts_with("point") || pair == ["fmu", "in"])
}

/// The words of a name, in small letters: between other signs, between letters and digits, and where a large letter
/// begins one (`goalPose`, `CMDPose`).
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let characters: Vec<char> = name.chars().collect();
    for (i, c) in characters.iter().enumerate() {
        let before = i.checked_sub(1).map_or('/', |before| characters[before]);
        let then_small = characters.get(i + 1).is_some_and(|next| next.is_lowercase());
        let begins = c.is_numeric() != before.is_numeric()
            || c.is_uppercase() && (before.is_lowercase() || before.is_uppercase() && then_small);
        if begins || !c.is_alphanumeric() {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| c.is_alphanumeric()) {
            word.extend(c.to_lowercase());
        }
    }
    words
}

/// The joint that is farthest from itself in two rows of the same joints, and how far, rad.
fn farthest(one: &[f64], other: &[f64]) -> Option<(usize, f64)> {
    let joints = one.iter().zip(other).enumerate();
    let far = joints.filter_map(|(joint, (one, other))| Some((joint, apart(*one, *other)?)));
    far.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Rows whose stamp was there before.
struct Twice<T> {
    /// How many.
    count: usize,
    /// The first that says something else than the row before it: both.
    other: Option<((f64, T), T)>,
}

impl<T> Twice<T> {
    /// Tells of them, and gives what is wrong with them.
    fn tell(self, name: &str, notes: &mut Vec<String>, words: impl Fn(&(f64, T), &T) -> String) -> Option<String> {
        if self.count > 0 {
            notes.push(format!("{name}: {} messages with a stamp that was there before", self.count));
        }
        // A stamp of zero is none.
        let other = self.other.filter(|((t_s, _), _)| *t_s != 0.0);
        let why = other.map(|(one, other)| words(&one, &other));
        notes.extend(why.iter().map(|why| format!("{name}: {why}")));
        why
    }
}

/// Rows in the order of their times, one each, and those that were left out for it; `far` says how far two are apart.
///
/// Of one stamp are also messages that follow each other faster than stamps are told, or that a recorder took together.
/// So those that are no farther apart than what moves moves around that time within [`COARSE_S`], by the recorder's
/// clock within [`HELD_UP_S`], say nothing else.
fn rising<T: Clone>(mut rows: Vec<(f64, T)>, clock: Clock, far: &dyn Fn(&T, &T) -> f64) -> (Vec<(f64, T)>, Twice<T>) {
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept: Vec<(f64, T)> = Vec::with_capacity(rows.len());
    let mut again: Vec<(usize, T)> = Vec::new();
    for (t_s, row) in rows {
        match kept.last() {
            Some((last, _)) if t_s <= *last => again.push((kept.len() - 1, row)),
            _ => kept.push((t_s, row)),
        }
    }
    let speed = |from: usize| {
        let (Some(one), Some(other)) = (kept.get(from), kept.get(from + 1)) else { return 0.0 };
        far(&one.1, &other.1) / (other.0 - one.0)
    };
    let coarse = if clock == Clock::Receive { HELD_UP_S } else { COARSE_S };
    let is_other = |(place, row): &&(usize, T)| {
        let speed = place.checked_sub(1).map_or(0.0, speed).max(speed(*place));
        far(&kept[*place].1, row) > speed * coarse
    };
    let other = again.iter().find(is_other).map(|(place, row)| (kept[*place].clone(), row.clone()));
    (kept, Twice { count: again.len(), other })
}
