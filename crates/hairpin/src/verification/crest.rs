//! The largest tilt and torque along a piece that was driven, also between the looks that the way took.
//!
//! Tilt and torque are seen at the looks of the way alone, up to a tenth of a metre or of a radian apart. Tilts are
//! looked for again only in intervals that might hold a larger one than the largest so far, judged by how they change
//! from look to look: an estimate, not a bound. Torques are asked of rests that are interpolated between looks, at
//! about 2000 places a drive, and the body is looked at once where that is largest.

use super::stand::{Rest, joint, tilt};
use super::stride::{Look, Pose, Stretch, Taken, foreseen};
use super::wheels::{At, WheelExtremes};
use crate::world::terrain::Terrain;

/// What is seen of a drive along its way.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Followed {
    /// Largest angle of the body's z axis from the vertical, rad.
    pub(super) max_tilt: f64,
    /// Largest |angle| of a joint, rad.
    pub(super) max_joint: f64,
    /// Largest |torque| of each wheel, N·m.
    pub(super) max_torque: f64,
    /// What the wheels come to, where they are held to anything.
    pub(super) wheels: WheelExtremes,
    /// Strides taken.
    pub(super) strides: usize,
    /// What they may leave out, m and rad m.
    pub(super) left_out: f64,
}

/// Places of a drive that are shown, and how often its torques are asked for.
pub(super) const SHOWN: f64 = 2000.0;
/// Tilts are looked for between looks where they might be larger than the largest: by this share of what they change by
/// from look to look, and by this, rad.
const STEEP: f64 = 0.5;
const NEAR: f64 = 0.005;
/// Rests that differ by less are one, m and rad.
///
/// A body that, walked with in small steps, comes to the next look within this of the look's own rest has been the
/// same body all along.
const SAME: f64 = 1e-3;

impl<T: Terrain> Stretch<'_, T> {
    /// Adds the largest tilt and torque along what was driven. `looks` are in the way's order, the first where it
    /// begins.
    pub(super) fn add_peaks(&self, looks: &[Look], taken: &[Taken], followed: &mut Followed) {
        let tilts: Vec<f64> = looks.iter().map(|look| tilt(&look.rest)).collect();
        followed.max_tilt = tilts.iter().fold(followed.max_tilt, |most, tilt| most.max(*tilt));
        followed.max_joint = looks.iter().map(|look| joint(&look.rest)).fold(followed.max_joint, f64::max);
        // A rest that is walked with and is not the looks'.
        let mut apart: Option<Rest> = None;
        for (i, pair) in looks.windows(2).enumerate() {
            let change = tilts[i.saturating_sub(1)..(i + 3).min(tilts.len())].windows(2);
            let change = change.map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
            let might = tilts[i].max(tilts[i + 1]) + STEEP * change + NEAR;
            if apart.is_some() || might > followed.max_tilt {
                apart = self.walk([&pair[0], &pair[1]], apart, taken, followed);
            }
        }
        if self.course.vehicle.wheels.is_some() {
            self.add_wheels(looks, &mut followed.wheels);
        }
        if self.course.vehicle.haul.is_none() {
            return;
        }
        let torque = |rest: &Rest, s: f64| self.course.torque([rest.roll(), rest.pitch()], s);
        let count = (SHOWN * self.length.abs() / self.extent).ceil().max(16.0) as usize;
        let (mut most, mut highest, mut after) = (0.0, 0.0, 0);
        for i in 0..count {
            let s = self.length * (i as f64 + 0.5) / count as f64;
            while after + 2 < looks.len() && looks[after + 1].s.abs() < s.abs() {
                after += 1;
            }
            let between = torque(&foreseen(&looks[after..(after + 2).min(looks.len())], s), s);
            if between > most {
                (most, highest) = (between, s);
            }
        }
        // Where it seems largest the body is looked at.
        let nearest = looks.partition_point(|look| look.s.abs() < highest.abs()).clamp(1, looks.len().max(2) - 1);
        let there = match looks.get(nearest - 1..=nearest) {
            Some([before, behind]) => self.look_between([before, behind], highest, taken),
            _ => None,
        };
        let torques = looks.iter().chain(&there).map(|look| torque(&look.rest, look.s));
        followed.max_torque = torques.fold(followed.max_torque, f64::max);
    }

    /// Adds what the wheels do at about 2000 places a drive, the body resting between its looks as they lead to.
    fn add_wheels(&self, looks: &[Look], wheels: &mut WheelExtremes) {
        let count = (SHOWN * self.length.abs() / self.extent).ceil().max(16.0) as usize;
        let mut after = 0;
        for i in 0..=count {
            let s = self.length * i as f64 / count as f64;
            while after + 2 < looks.len() && looks[after + 1].s.abs() < s.abs() {
                after += 1;
            }
            let around = &looks[after..(after + 2).min(looks.len())];
            let (Some(first), Some(last)) = (around.first(), around.last()) else { return };
            let ends = [(first.s, &first.rest), (last.s, &last.rest)];
            wheels.add(self.course, &At { s, rest: &foreseen(around, s), around: ends });
        }
    }

    /// Looks from one to the other in small steps, each from the last, the first from `rest` if there is one; the last
    /// rest, where it is not that of `to`. Long looks pass by what a body climbs and falls off again between them.
    fn walk(
        &self,
        [from, to]: [&Look; 2],
        rest: Option<Rest>,
        taken: &[Taken],
        followed: &mut Followed,
    ) -> Option<Rest> {
        let count = (SHOWN * (to.s - from.s).abs() / self.extent).ceil().max(1.0) as usize;
        let mut rest = rest.unwrap_or(from.rest);
        for i in 1..=count {
            let s = from.s + (to.s - from.s) * i as f64 / count as f64;
            rest.carry_on(&self.course.vehicle.stand, self.terrain, pose_at(taken, s)?, &self.asked()).ok()?;
            followed.max_tilt = followed.max_tilt.max(tilt(&rest));
            followed.max_joint = followed.max_joint.max(joint(&rest));
        }
        (rest.apart(&to.rest) > SAME).then_some(rest)
    }

    /// Looks that are out of turn may find no rest, or one that the way does not lead to: they count for nothing.
    fn look_between(&self, [from, to]: [&Look; 2], s: f64, taken: &[Taken]) -> Option<Look> {
        let around = [from.clone(), to.clone()];
        let (look, fell) = self.look(&around, s, pose_at(taken, s)?).ok()?;
        (!fell).then_some(look)
    }
}

/// x, y, ψ at `s` of a way in strides.
fn pose_at(taken: &[Taken], s: f64) -> Option<Pose> {
    let stride = taken.partition_point(|taken| taken.s.abs() <= s.abs()).saturating_sub(1);
    taken.get(stride).map(|taken| taken.pose((s - taken.s) / taken.h))
}
