//! Strides along a piece of a drive on the ground: whole and in halves.
//!
//! Terrain is C¹, so that rates have kinks wherever a wheel passes the border of two cells, and no method of high order
//! is any: looks at the ground are what counts, and each stride has four.

use super::course::Course;
use super::drive::DrivePiece;
use super::peak::largest;
use super::stand::{Asked, EXACTLY, NoRest, Rest};
use super::twist::{Place, carry};
use crate::world::terrain::Terrain;

/// A piece, and the ground that it leads over.
///
/// One piece of commands, in one gear or turned in place.
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

/// x, y (m), ψ (rad).
pub(super) type Pose = [f64; 3];

/// The body at rest, looked at.
///
/// `s` in metres (or radians of a turn) since the piece began; `rates` are those of [`Course::rates`] there.
#[derive(Clone)]
pub(super) struct Look {
    pub(super) s: f64,
    pub(super) rest: Rest,
    pub(super) rates: [f64; 3],
}

/// A stride before it is taken; its looks are the last ones.
///
/// Taken where `off` is little enough for the metres left; else the stride is halved.
pub(super) struct Tried {
    /// Its parts, in turn.
    pub(super) taken: Vec<Taken>,
    /// Whether its last look is at its end.
    pub(super) ended: bool,
    /// What its halves leave out, judged by what they differ by from the whole, m and rad m.
    pub(super) off: f64,
    /// Whether a look found the body far from where it was foreseen: it fell, or a nearer rest was passed by.
    pub(super) fell: bool,
}

/// A stride that was taken, or a half of it: a parabola through three poses.
pub(super) struct Taken {
    pub(super) s: f64,
    pub(super) h: f64,
    pub(super) poses: [Pose; 3],
}

/// Heights and angles farther from what was foreseen are those of another rest, m and rad.
/// So much more than extrapolation is off by in a stride that is short enough.
pub(super) const FELL: f64 = 0.02;
/// Rests of looks are known to this, m and rad, over the square of a drive's metres: what rates are off by then, and
/// headings of what they lead to, is little beside what strides may leave out.
const KNOWN: f64 = 3e-5;
/// Jacobians of a look: one that more would do for is near one that a few do for.
const TRIES: usize = 10;
/// And beside that by this a metre or radian: what a border of cells changes of their slopes.
pub(super) const KINK: f64 = 2.0;

impl<T: Terrain> Stretch<'_, T> {
    /// How exactly rests of looks are asked for.
    pub(super) fn asked(&self) -> Asked {
        Asked { closed: (KNOWN / (self.extent * self.extent).max(1.0)).max(EXACTLY.closed), ..EXACTLY }
    }

    /// `rest` looked at.
    pub(super) fn seen(&self, s: f64, rest: Rest) -> Look {
        Look { s, rates: self.course.rates(&rest, s), rest }
    }

    /// The body at rest at `pose`, looked for from what the last `looks` lead to there, and whether it is far from
    /// that.
    ///
    /// # Errors
    /// [`NoRest`]: no rest is found there from either.
    pub(super) fn look(&self, looks: &[Look], s: f64, pose: Pose) -> Result<(Look, bool), NoRest> {
        let stand = &self.course.vehicle.stand;
        let ahead = foreseen(looks, s);
        let mut rest = ahead;
        rest.follow(stand, self.terrain, pose, &Asked { jacobians: TRIES, ..self.asked() })?;
        let fell = surprises(&ahead, &rest, looks, s);
        Ok((self.seen(s, rest), fell))
    }

    /// A stride of `h` from a place at s, behind the last of `looks`, to be taken if it is near enough; else its looks
    /// are taken back.
    ///
    /// # Errors
    /// As [`Self::look`].
    pub(super) fn attempt(&self, from: (f64, Pose), h: f64, looks: &mut Vec<Look>) -> Result<Tried, NoRest> {
        if self.course.vehicle.exact { self.carried(from, h, looks) } else { self.by_panels(from, h, looks) }
    }

    /// From rest to rest by the twist between them, whole and in halves.
    ///
    /// Kinematics `exact`: the body is carried as a rigid one by its twist.
    ///
    /// Both ways are of second order: halves are off by a third of what they differ by from the whole, and
    /// extrapolated by that.
    fn carried(&self, (s, from): (f64, Pose), h: f64, looks: &mut Vec<Look>) -> Result<Tried, NoRest> {
        let (course, stand) = (self.course, &self.course.vehicle.stand);
        let step = |rest: &mut Rest, pose: Pose, s: f64, h: f64| {
            let ahead = moved(&pose, &turned(&course.rates(rest, s), pose[2]), h);
            carry(stand, self.terrain, rest, [pose, ahead], h, |place: &Place| course.body_rates(place, s + 0.5 * h))
        };
        let mut at_once = looks[looks.len() - 1].rest;
        let mut rest = at_once;
        let whole = step(&mut at_once, from, s, h)?;
        let middle = step(&mut rest, from, s, 0.5 * h)?;
        looks.push(self.seen(s + 0.5 * h, rest));
        let halves = step(&mut rest, middle, s + 0.5 * h, 0.5 * h)?;
        // Both ways lead to one rest, but where they end in two.
        let fell = at_once.apart(&rest) > FELL;
        looks.push(self.seen(s + h, rest));
        let off: Pose = std::array::from_fn(|i| (halves[i] - whole[i]) / 3.0);
        let taken = vec![Taken { s, h, poses: [from, middle, moved(&halves, &off, 1.0)] }];
        Ok(Tried { taken, ended: true, off: self.far(s, &off), fell })
    }

    /// A step of `h` as it comes, looked for from the last rest with Jacobians of its own: where the body falls no
    /// stride is short enough. What it may leave out is what it differs by from the way on at the rates before.
    pub(super) fn plainly(&self, (s, from): (f64, Pose), h: f64, looks: &mut Vec<Look>) -> Result<Tried, NoRest> {
        let (course, stand) = (self.course, &self.course.vehicle.stand);
        let last = &looks[looks.len() - 1];
        let ahead = moved(&from, &turned(&last.rates, from[2]), h);
        let (mut rest, halfway) = (last.rest, s + 0.5 * h);
        let end = if course.vehicle.exact {
            let body = |place: &Place| course.body_rates(place, halfway);
            let end = carry(stand, self.terrain, &mut rest, [from; 2], h, body)?;
            looks.push(self.seen(s + h, rest));
            end
        } else {
            rest.carry_on(stand, self.terrain, from, &EXACTLY)?;
            let here = self.seen(s, rest);
            let middle = moved(&from, &turned(&here.rates, from[2]), 0.5 * h);
            rest.carry_on(stand, self.terrain, middle, &EXACTLY)?;
            let there = self.seen(halfway, rest);
            let end = moved(&from, &turned(&there.rates, middle[2]), h);
            looks.extend([here, there]);
            end
        };
        let off = self.far(s, &std::array::from_fn(|i| end[i] - ahead[i]));
        let middle = std::array::from_fn(|i| 0.5 * (from[i] + end[i]));
        Ok(Tried {
            taken: vec![Taken { s, h, poses: [from, middle, end] }],
            ended: course.vehicle.exact,
            off,
            fell: true,
        })
    }

    /// How far `off` leads from `s` on, m and rad m: headings times the metres left.
    pub(super) fn far(&self, s: f64, off: &Pose) -> f64 {
        let ahead = match self.course.piece {
            DrivePiece::Arc { .. } => self.left - s,
            DrivePiece::Turn { .. } => self.left,
        };
        [off[0], off[1], off[2] * ahead.max(1.0)].into_iter().map(f64::abs).fold(0.0, largest)
    }
}

impl Taken {
    /// At the share `t` of the stride.
    pub(super) fn pose(&self, t: f64) -> Pose {
        let [from, middle, to] = &self.poses;
        let weights = [(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)];
        std::array::from_fn(|i| weights[0] * from[i] + weights[1] * middle[i] + weights[2] * to[i])
    }
}

/// Whether `rest` at `s` is another one than the last of `looks` lead to, `ahead`: farther from it than kinks on the
/// way can have led.
pub(super) fn surprises(ahead: &Rest, rest: &Rest, looks: &[Look], s: f64) -> bool {
    let way = looks.last().map_or(0.0, |last| (s - last.s).abs());
    ahead.apart(rest) > FELL + KINK * way
}

/// Where the last two looks lead to at `s`.
pub(super) fn foreseen(looks: &[Look], s: f64) -> Rest {
    match looks {
        [.., before, last] if last.s != before.s => {
            Rest::foreseen(&before.rest, &last.rest, (s - last.s) / (last.s - before.s))
        }
        [.., last] => last.rest,
        [] => unreachable!("a piece begins with a look"),
    }
}

/// pose + h · rates.
fn moved(pose: &Pose, rates: &Pose, h: f64) -> Pose {
    std::array::from_fn(|i| pose[i] + h * rates[i])
}

/// `rates` of the level frame at heading `yaw`: dx/ds, dy/ds, dψ/ds.
pub(super) fn turned([ahead, left, turn]: &[f64; 3], yaw: f64) -> Pose {
    let (sin, cos) = libm::sincos(yaw);
    [cos * ahead - sin * left, sin * ahead + cos * left, *turn]
}
