//! Strides along a piece of a drive on the ground: whole and in halves, extrapolated.
//!
//! Terrain is C¹, so that rates have kinks wherever a wheel passes the border of two cells, and no method of high order
//! is any: looks at the ground are what counts, and each stride has three.

use super::course::Course;
use super::drive::DrivePiece;
use super::peak::largest;
use super::stand::{NoRest, Rest};
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
/// `s` in metres (or radians of a turn) since the piece began.
#[derive(Clone)]
pub(super) struct Look {
    pub(super) s: f64,
    pub(super) rest: Rest,
}

/// Where a stride begins.
///
/// `rates` are dx/ds, dy/ds, dψ/ds there.
pub(super) struct Station {
    pub(super) s: f64,
    pub(super) pose: Pose,
    pub(super) rest: Rest,
    rates: Pose,
}

/// A stride before it is taken.
///
/// Taken where `off` is little enough for the metres left; else the stride is halved.
pub(super) struct Tried {
    pub(super) middle: Pose,
    pub(super) end: Pose,
    /// At its end: as seen, or foreseen.
    pub(super) rest: Rest,
    pub(super) looks: Vec<Look>,
    /// What its halves differ by from what they are extrapolated to, m and rad m.
    pub(super) off: f64,
    /// Whether a look found the body far from where it was foreseen: it fell, or a nearer rest was passed by.
    pub(super) fell: bool,
}

/// A stride that was taken: a parabola through three poses.
pub(super) struct Taken {
    pub(super) s: f64,
    pub(super) h: f64,
    pub(super) poses: [Pose; 3],
}

/// Heights and angles farther from what was foreseen are those of another rest, m and rad.
/// So much more than extrapolation is off by in a stride that is short enough.
pub(super) const FELL: f64 = 0.02;

impl<T: Terrain> Stretch<'_, T> {
    /// Its rates are computed once and serve every stride that is tried from it.
    pub(super) fn station(&self, s: f64, pose: Pose, rest: Rest) -> Station {
        let rates = self.course.rates(&rest, pose[2], s);
        Station { s, pose, rest, rates }
    }

    /// The body at rest at `pose`, looked for from what the last `looks` lead to there; if that leads nowhere, from the
    /// last of them.
    ///
    /// # Errors
    /// [`NoRest`]: no rest is found there from either.
    pub(super) fn look(&self, looks: &[Look], s: f64, pose: Pose) -> Result<Look, NoRest> {
        let stand = &self.course.vehicle.stand;
        let mut rest = foreseen(looks, s);
        if rest.follow(stand, self.terrain, pose).is_err() {
            rest = looks.last().map_or(rest, |last| last.rest.afresh());
            rest.carry_on(stand, self.terrain, pose)?;
        }
        Ok(Look { s, rest })
    }

    /// A stride of `h` behind the last of `looks`, to be taken if it is near enough.
    ///
    /// # Errors
    /// As [`Self::look`].
    pub(super) fn attempt(&self, from: &Station, h: f64, looks: &[Look]) -> Result<Tried, NoRest> {
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
    ///
    /// Kinematics `exact`: the body is carried as a rigid one by its twist.
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
        Tried { middle, end, rest, looks, off: self.far(from, &off), fell: false }
    }

    /// A step of `h` as it comes, looked for from the last rest with Jacobians of its own: where the body falls no
    /// stride is short enough. What it may leave out is what it differs by from the way on at the rates before.
    pub(super) fn plainly(&self, from: &Station, h: f64, looks: &[Look]) -> Result<Tried, NoRest> {
        let (course, stand) = (self.course, &self.course.vehicle.stand);
        let (mut rest, s) = (looks.last().map_or(&from.rest, |last| &last.rest).afresh(), from.s + 0.5 * h);
        let mut seen = Vec::with_capacity(2);
        let end = if course.vehicle.exact {
            let body = |place: &Place| course.body_rates(place, s);
            let end = carry(stand, self.terrain, &mut rest, [from.pose; 2], h, body)?;
            seen.push(Look { s: from.s + h, rest: rest.clone() });
            end
        } else {
            rest.carry_on(stand, self.terrain, from.pose)?;
            let rates = course.rates(&rest, from.pose[2], from.s);
            seen.push(Look { s: from.s, rest: rest.clone() });
            let middle = moved(&from.pose, &rates, 0.5 * h);
            rest.carry_on(stand, self.terrain, middle)?;
            seen.push(Look { s, rest: rest.clone() });
            moved(&from.pose, &course.rates(&rest, middle[2], s), h)
        };
        let ahead = moved(&from.pose, &from.rates, h);
        let off = self.far(from, &std::array::from_fn(|i| end[i] - ahead[i]));
        let middle = std::array::from_fn(|i| 0.5 * (from.pose[i] + end[i]));
        Ok(Tried { middle, end, rest, looks: seen, off, fell: true })
    }

    /// How far `off` leads, m and rad m: headings times the metres left.
    fn far(&self, from: &Station, off: &Pose) -> f64 {
        let ahead = match self.course.piece {
            DrivePiece::Arc { .. } => self.left - from.s,
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

/// Where the last two looks lead to at `s`.
pub(super) fn foreseen(looks: &[Look], s: f64) -> Rest {
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
