//! Strides along a piece of a drive on the ground: whole and in halves, extrapolated, as long as what the two differ by
//! allows.
//!
//! Terrain is C¹, so that rates have kinks wherever a wheel passes the border of two cells, and no method of high order
//! is any: looks at the ground are what counts, and each stride has three.

use super::course::Course;
use super::drive::DrivePiece;
use super::peak::largest;
use super::stand::{NoRest, Rest, tilt};
use super::twist::{Place, carry};
use crate::world::terrain::Terrain;

/// A piece, and the ground that it leads over.
pub(super) struct Stretch<'a, T> {
    pub(super) course: &'a Course<'a>,
    pub(super) terrain: &'a T,
    /// Metres, or radians of a turn in place with their sign.
    pub(super) length: f64,
    /// Metres left of the drive where it begins.
    pub(super) left: f64,
    /// Metres and radians of the whole drive.
    pub(super) extent: f64,
}

/// What is seen of a drive along its way.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Followed {
    /// Largest angle of the body's z axis from the vertical, rad.
    pub(super) max_tilt: f64,
    /// Largest |torque| of each wheel, N·m.
    pub(super) max_torque: f64,
    /// Strides taken.
    pub(super) strides: usize,
    /// What they may leave out, m and rad m.
    pub(super) left_out: f64,
}

/// x, y (m), ψ (rad).
type Pose = [f64; 3];

/// The body at rest, looked at.
#[derive(Clone)]
struct Look {
    s: f64,
    rest: Rest,
}

/// Where a stride begins.
struct Station {
    s: f64,
    pose: Pose,
    rest: Rest,
    rates: Pose,
}

/// A stride before it is taken.
struct Tried {
    middle: Pose,
    end: Pose,
    /// At its end: as seen, or foreseen.
    rest: Rest,
    looks: Vec<Look>,
    /// What its halves differ by from what they are extrapolated to.
    off: f64,
    /// Whether a look found the body far from where it was foreseen: it fell, or a nearer rest was passed by.
    fell: bool,
}

/// A stride that was taken: a parabola through three poses.
struct Taken {
    s: f64,
    h: f64,
    poses: [Pose; 3],
}

/// What a drive's strides may leave out of its end's place in all, m, and of its heading times the metres left: a
/// hundredth of what drives are usually held to.
const ACCURACY: f64 = 1e-4;
/// Longest stride, m and rad: what lies between two looks is not seen.
const LONGEST: f64 = 0.1;
/// The shortest is this share of the drive, or this long, m and rad: whatever it leaves out is told.
const SHORTEST: (f64, f64) = (1.0 / 4000.0, 2.5e-4);
/// Heights and angles farther from what was foreseen are those of another rest, m and rad.
const FELL: f64 = 0.02;
/// Places of a drive that are shown, and how often its torques are asked for.
const SHOWN: f64 = 2000.0;
/// Tilts are looked for where they might exceed the largest by this, rad.
const HIGHER: f64 = 1e-4;

impl<T: Terrain> Stretch<'_, T> {
    /// Drives on from `at`, where the body rests, to the end of the piece, where `at` is then.
    ///
    /// `pass` is shown places along the way. No rest is told with s.
    pub(super) fn follow(
        &self,
        at: &mut (Pose, Rest),
        followed: &mut Followed,
        pass: &mut Option<&mut dyn FnMut(Pose)>,
    ) -> Result<(), (f64, NoRest)> {
        let length = self.length.abs();
        if !length.is_finite() {
            return Err((0.0, NoRest::NotFound));
        }
        let mut looks = vec![Look { s: 0.0, rest: at.1.clone() }];
        let mut taken: Vec<Taken> = Vec::new();
        let mut station = self.station(0.0, at.0, at.1.clone());
        let shortest = SHORTEST.1.max(SHORTEST.0 * self.extent);
        let (mut done, mut stride) = (0.0, LONGEST);
        while done < length {
            let last = stride >= length - done;
            let h = if last { length - done } else { stride };
            let allowed = ACCURACY * h / self.extent;
            let tried = match self.attempt(&station, h.copysign(self.length), &looks) {
                Ok(tried) => tried,
                Err(no) if h <= shortest => return Err((station.s, no)),
                Err(_) => {
                    stride = shortest.max(0.25 * h);
                    continue;
                }
            };
            // A difference that is not a number is as large as can be; its root is that of third-order terms.
            let longer = 0.9 * (allowed / tried.off).sqrt();
            if h > shortest && (tried.fell || !(tried.off <= allowed)) {
                let shorter = if tried.fell { 0.25 } else { longer.max(0.2).min(0.7) };
                stride = shortest.max(h * shorter);
                continue;
            }
            followed.strides += 1;
            followed.left_out += tried.off;
            let poses = [station.pose, tried.middle, tried.end];
            let walked = Taken { s: station.s, h: h.copysign(self.length), poses };
            if let Some(pass) = pass {
                let parts = (SHOWN * h / self.extent).ceil().max(1.0) as usize;
                (1..=parts).for_each(|part| pass(walked.pose(part as f64 / parts as f64)));
            }
            taken.push(walked);
            looks.extend(tried.looks);
            done = if last { length } else { done + h };
            station = self.station(done.copysign(self.length), tried.end, tried.rest);
            stride = LONGEST.min(h * longer.max(0.5).min(2.0)).max(shortest);
        }
        let end = self.look(&looks, self.length, station.pose).map_err(|no| (self.length, no))?;
        *at = (station.pose, end.rest.clone());
        looks.push(end);
        self.peaks(&looks, &taken, followed)
    }

    fn station(&self, s: f64, pose: Pose, rest: Rest) -> Station {
        let rates = self.course.rates(&rest, pose[2], s);
        Station { s, pose, rest, rates }
    }

    /// The body at rest at `pose`, looked for from what the last `looks` lead to there.
    fn look(&self, looks: &[Look], s: f64, pose: Pose) -> Result<Look, NoRest> {
        let mut rest = foreseen(looks, s);
        rest.carry_on(&self.course.vehicle.stand, self.terrain, pose)?;
        Ok(Look { s, rest })
    }

    fn attempt(&self, from: &Station, h: f64, looks: &[Look]) -> Result<Tried, NoRest> {
        if self.course.vehicle.exact { self.carried(from, h) } else { self.by_midpoints(from, h, looks) }
    }

    /// By the midpoint rule, whole and in halves.
    ///
    /// At a station the rest only says where the first middle lies: it is foreseen there, not looked at.
    fn by_midpoints(&self, from: &Station, h: f64, looks: &[Look]) -> Result<Tried, NoRest> {
        let rates = |look: &Look, pose: &Pose| self.course.rates(&look.rest, pose[2], look.s);
        let mut near = looks[looks.len().saturating_sub(2)..].to_vec();
        let mut fell = false;
        let mut look = |s: f64, pose: &Pose| -> Result<Look, NoRest> {
            let look = self.look(&near, s, *pose)?;
            fell |= foreseen(&near, s).apart(&look.rest) > FELL;
            near.push(look.clone());
            Ok(look)
        };
        let first = moved(&from.pose, &from.rates, 0.25 * h);
        let first_look = look(from.s + 0.25 * h, &first)?;
        let middle = moved(&from.pose, &from.rates, 0.5 * h);
        let middle_look = look(from.s + 0.5 * h, &middle)?;
        let whole = moved(&from.pose, &rates(&middle_look, &middle), h);
        let half = moved(&from.pose, &rates(&first_look, &first), 0.5 * h);
        let second = moved(&half, &rates(&middle_look, &half), 0.25 * h);
        let second_look = look(from.s + 0.75 * h, &second)?;
        let halves = moved(&half, &rates(&second_look, &second), 0.5 * h);
        let seen = vec![first_look, middle_look, second_look];
        let ahead = foreseen(&seen, from.s + h);
        Ok(Tried { fell, ..self.extrapolated(from, &whole, half, &halves, ahead, seen) })
    }

    /// From rest to rest by the twist between them, whole and in halves.
    fn carried(&self, from: &Station, h: f64) -> Result<Tried, NoRest> {
        let (course, stand) = (self.course, &self.course.vehicle.stand);
        let step = |rest: &mut Rest, pose: Pose, s: f64, h: f64| {
            let ahead = moved(&pose, &course.rates(rest, pose[2], s), h);
            carry(stand, self.terrain, rest, [pose, ahead], h, |place: &Place| course.body_rates(place, s + 0.5 * h))
        };
        let mut at_once = from.rest.clone();
        let whole = step(&mut at_once, from.pose, from.s, h)?;
        let mut rest = from.rest.clone();
        let half = step(&mut rest, from.pose, from.s, 0.5 * h)?;
        let middle = Look { s: from.s + 0.5 * h, rest: rest.clone() };
        let halves = step(&mut rest, half, from.s + 0.5 * h, 0.5 * h)?;
        let end = Look { s: from.s + h, rest: rest.clone() };
        // Both ways lead to one rest, but where they end in two.
        let fell = at_once.apart(&rest) > FELL;
        Ok(Tried { fell, ..self.extrapolated(from, &whole, half, &halves, rest, vec![middle, end]) })
    }

    /// Both ways of second order: halves are off by a third of what they differ by from the whole.
    fn extrapolated(
        &self,
        from: &Station,
        whole: &Pose,
        middle: Pose,
        halves: &Pose,
        rest: Rest,
        looks: Vec<Look>,
    ) -> Tried {
        let off: Pose = std::array::from_fn(|i| (halves[i] - whole[i]) / 3.0);
        let end = moved(halves, &off, 1.0);
        let ahead = match self.course.piece {
            DrivePiece::Arc { .. } => self.left - from.s,
            DrivePiece::Turn { .. } => self.left,
        };
        let off = [off[0], off[1], off[2] * ahead.max(1.0)].into_iter().map(f64::abs).fold(0.0, largest);
        Tried { middle, end, rest, looks, off, fell: false }
    }

    /// Adds the largest tilt and torque along what was driven.
    fn peaks(&self, looks: &[Look], taken: &[Taken], followed: &mut Followed) -> Result<(), (f64, NoRest)> {
        let tilts: Vec<f64> = looks.iter().map(|look| tilt(&look.rest)).collect();
        followed.max_tilt = tilts.iter().fold(followed.max_tilt, |most, tilt| most.max(*tilt));
        let changes: Vec<f64> = tilts.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
        for (i, pair) in looks.windows(2).enumerate() {
            let around = &changes[i.saturating_sub(1)..(i + 2).min(changes.len())];
            let changes = around.iter().copied().fold(0.0, f64::max);
            self.rise([&pair[0], &pair[1]], changes, taken, followed)?;
        }
        if self.course.vehicle.haul.is_none() {
            return Ok(());
        }
        let torque = |rest: &Rest, s: f64| self.course.torque([rest.roll(), rest.pitch()], s);
        let count = (SHOWN * self.length.abs() / self.extent).ceil().max(16.0) as usize;
        let (mut most, mut after) = ((0.0, 0.0), 0);
        for i in 0..count {
            let s = self.length * (i as f64 + 0.5) / count as f64;
            while after + 2 < looks.len() && looks[after + 1].s.abs() < s.abs() {
                after += 1;
            }
            let between = torque(&foreseen(&looks[after..(after + 2).min(looks.len())], s), s);
            if between > most.0 {
                most = (between, s);
            }
        }
        // Where it seems largest the body is looked at.
        let nearest = looks.partition_point(|look| look.s.abs() < most.1.abs()).clamp(1, looks.len() - 1);
        let highest = self.look_between([&looks[nearest - 1], &looks[nearest]], most.1, taken)?;
        let seen = looks.iter().chain([&highest]).map(|look| torque(&look.rest, look.s));
        followed.max_torque = seen.fold(followed.max_torque, f64::max);
        Ok(())
    }

    /// Looks between two looks for as long as a tilt there might exceed the largest: by half of what it `changes` by
    /// from look to look.
    fn rise(
        &self,
        [from, to]: [&Look; 2],
        changes: f64,
        taken: &[Taken],
        followed: &mut Followed,
    ) -> Result<(), (f64, NoRest)> {
        let [first, last] = [from, to].map(|look| tilt(&look.rest));
        let might = first.max(last) + 0.5 * changes;
        if might <= followed.max_tilt + HIGHER || (to.s - from.s).abs() <= self.extent / SHOWN {
            return Ok(());
        }
        let middle = self.look_between([from, to], 0.5 * (from.s + to.s), taken)?;
        let between = tilt(&middle.rest);
        followed.max_tilt = followed.max_tilt.max(between);
        let changes = (between - first).abs().max((last - between).abs());
        self.rise([from, &middle], changes, taken, followed)?;
        self.rise([&middle, to], changes, taken, followed)
    }

    fn look_between(&self, [from, to]: [&Look; 2], s: f64, taken: &[Taken]) -> Result<Look, (f64, NoRest)> {
        let stride = taken.partition_point(|taken| taken.s.abs() <= s.abs()).saturating_sub(1);
        let Some(taken) = taken.get(stride) else { return Ok(from.clone()) };
        let pose = taken.pose((s - taken.s) / taken.h);
        self.look(&[from.clone(), to.clone()], s, pose).map_err(|no| (s, no))
    }
}

impl Taken {
    /// At the share `t` of the stride.
    fn pose(&self, t: f64) -> Pose {
        let [from, middle, to] = &self.poses;
        let weights = [(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)];
        std::array::from_fn(|i| weights[0] * from[i] + weights[1] * middle[i] + weights[2] * to[i])
    }
}

/// Where the last two looks lead to at `s`.
fn foreseen(looks: &[Look], s: f64) -> Rest {
    match looks {
        [.., before, last] if last.s != before.s => {
            Rest::foreseen(&before.rest, &last.rest, (s - last.s) / (last.s - before.s))
        }
        [.., last] => last.rest.clone(),
        [] => unreachable!("a piece begins with a look"),
    }
}

/// pose + h · rates.
fn moved(pose: &Pose, rates: &Pose, h: f64) -> Pose {
    std::array::from_fn(|i| pose[i] + h * rates[i])
}
