//! What was recorded of one topic.

use super::super::accuracy::half;
use super::super::error::Fault;
use super::super::log::{Clock, Joints, LoggedMotion, Sample, Source};
use super::super::planned::is_asked;
use super::super::samples::Budget;
use super::super::twice::{apart, places_apart, told, two, two_places};
use super::cdr::{Cdr, NoMessage};
use super::messages::{Kind, Pose, joints, odometry, path, pose};
use super::rising::rising;
use crate::quote::shortened;

/// Sets of joints that one topic may tell of, by turns.
const MOST_SETS: usize = 16;

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
    /// Messages whose numbers are no place or no angles, and where the first is.
    not_finite: usize,
    first_not_finite: usize,
    /// Messages of its type that tell nothing, and of the first where it is and why.
    unfit: usize,
    first_unfit: Option<(usize, String)>,
    /// Poses whose quaternion turns nothing; stamp (s) and length of the first.
    unturned: usize,
    first_unturned: Option<(f64, f64)>,
    /// How many of them are zeros, as of who tells places alone.
    zeros: usize,
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
        let (broken, first_broken, not_finite, first_not_finite) = Default::default();
        let (unfit, first_unfit) = Default::default();
        let (unturned, first_unturned, zeros, elsewhere, halves) = Default::default();
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
            not_finite,
            first_not_finite,
            unfit,
            first_unfit,
            unturned,
            first_unturned,
            zeros,
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
            Err(NoMessage::NotFinite) => {
                if self.not_finite == 0 {
                    self.first_not_finite = offset;
                }
                self.not_finite += 1;
                Ok(())
            }
            Err(NoMessage::Unfit(why)) => {
                self.first_unfit.get_or_insert((offset, why));
                self.unfit += 1;
                Ok(())
            }
            Err(NoMessage::Broken) => {
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
        if pose.attitude.is_none() {
            self.unturned += 1;
            self.zeros += usize::from(pose.quaternion_length == 0.0);
            self.first_unturned.get_or_insert((pose.header.stamp_ns as f64 / 1e9, pose.quaternion_length));
        }
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
            None => return Err(NoMessage::Broken),
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
        if self.not_finite > 0 {
            let what = if self.kind == Kind::Joints { "finite positions" } else { "a finite pose" };
            notes.push(format!(
                "{name}: {} messages without {what} are not read, the first at byte {}",
                self.not_finite, self.first_not_finite
            ));
        }
        if let Some((offset, why)) = &self.first_unfit {
            notes.push(format!("{name}: {} messages that tell nothing, the first {why}, at byte {offset}", self.unfit));
        }
        let of_places = self.zeros > 0 && self.zeros == samples.len();
        if of_places {
            notes.push(format!("{name}: quaternions of zeros: no attitude is told"));
        }
        // A table of such quaternions is refused as well.
        let unturned = self.first_unturned.filter(|_| !of_places).map(|(t_s, length)| {
            let count = self.unturned;
            format!(
                "{count} quaternions that are none, the first of length {length:.4} with the stamp {t_s} s, must be 1"
            )
        });
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
            // The times of a path are its poses' own, and its first may be zero.
            let stampless = match self.kind {
                Kind::Path => None,
                _ => without_stamps(&name, clock, &mut rows, &mut notes),
            };
            let far = |one: &Sample, other: &Sample| places_apart(&one.p_m, &other.p_m).unwrap_or_default();
            let (rows, twice) = rising(rows, clock, &far);
            let unfit = twice.tell(&name, &mut notes, |(t_s, one), other| two_places(*t_s, &one.p_m, &other.p_m));
            notes.extend(unturned.iter().map(|why| format!("{name}: {why}")));
            let unfit = stampless.or(unfit).or(unturned);
            let samples: Vec<Sample> = rows.into_iter().map(|(_, sample)| sample).collect();
            motions.push(LoggedMotion { unfit, ..LoggedMotion::of(&name, source, samples) });
        } else {
            frame = None;
        }
        let many = sets.len() > 1;
        for (index, set) in sets.into_iter().enumerate() {
            let times = if clock == Clock::Receive { set.received } else { set.times };
            let name = if many { format!("{name}[{index}]") } else { name.clone() };
            let far = |one: &Vec<f64>, other: &Vec<f64>| farthest(one, other).map_or(0.0, |(_, far)| far);
            let mut rows: Vec<(f64, Vec<f64>)> = times.into_iter().zip(set.rows).collect();
            let stampless = without_stamps(&name, clock, &mut rows, &mut notes);
            if rows.is_empty() {
                continue;
            }
            let (rows, twice) = rising(rows, clock, &far);
            let unfit = twice.tell(&name, &mut notes, |(t_s, one), other| {
                let joint = farthest(one, other).map_or(0, |(joint, _)| joint);
                let [one, other] = [one, other].map(|row| format!("{} rad", told(row[joint])));
                two(*t_s, &format!("positions of the joint {}", shortened(&set.names[joint])), &one, &other)
            });
            let unfit = stampless.or(unfit);
            let (times_s, positions_rad) = rows.into_iter().unzip();
            all.push(Joints { name, source, joints: set.names, times_s, positions_rad, unfit });
        }
        (frame.map(|frame| (name, frame)), notes)
    }
}

/// The first stamp of a clock that begins at 0, as a simulation's does, is no farther from the next one than this many
/// times what others are from one another, or than this, s.
const BEGINS: (f64, f64) = (2.0, 1.0);

/// Leaves out the rows whose header has no stamp among others that have one: they are of an unknown moment, not of the
/// year 1970. Tells how many they were, and gives what is wrong where that is half of them or more.
fn without_stamps<T>(name: &str, clock: Clock, rows: &mut Vec<(f64, T)>, notes: &mut Vec<String>) -> Option<String> {
    if clock != Clock::Header || begins_at_zero(rows) {
        return None;
    }
    let all = rows.len();
    rows.retain(|(t_s, _)| *t_s != 0.0);
    let missing = all - rows.len();
    if missing == 0 {
        return None;
    }
    let told = format!("{missing} of {all} messages have no stamp in their header");
    let why = (2 * missing >= all).then(|| format!("{told}: when they were nobody knows"));
    notes.push(match why {
        Some(_) => format!("{name}: {told}"),
        None => format!("{name}: {told} and are left out"),
    });
    why
}

/// Whether stamps of 0 are moments: of the first rows alone, with the next stamp not far behind.
fn begins_at_zero<T>(rows: &[(f64, T)]) -> bool {
    let times = || rows.iter().map(|(t_s, _)| *t_s).skip_while(|t_s| *t_s == 0.0);
    let gaps = times().zip(times().skip(1)).map(|(one, other)| (other - one).abs());
    let near = gaps.fold(BEGINS.1, |most, gap| most.max(BEGINS.0 * gap));
    times().next().is_some_and(|first| first <= near) && times().all(|t_s| t_s != 0.0)
}

/// The joint that is farthest from itself in two rows of the same joints, and how far, rad.
fn farthest(one: &[f64], other: &[f64]) -> Option<(usize, f64)> {
    let joints = one.iter().zip(other).enumerate();
    let far = joints.filter_map(|(joint, (one, other))| Some((joint, apart(*one, *other)?)));
    far.max_by(|a, b| a.1.total_cmp(&b.1))
}
