//! All postures that put the last link somewhere, of arms with a spherical wrist: canonical subproblems on the lines of
//! their joints.
//!
//! (Paden, "Kinematics and control of robot manipulators", 1986; Murray, Li, Sastry, "A mathematical introduction to
//! robotic manipulation", 1994, 3.3.)
//!
//! Axis 1 from the wrist's place along axis 2, axes 2 and 3 as two links in a plane, axes 4 to 6 from what is left to
//! turn: two times two times two postures at most.

use std::f64::consts::TAU;

use nalgebra::{Isometry3, Point3, Vector3};

use super::Arm;
use super::claim::ArmTarget;
use super::configuration::middle_of;
use super::wrist::Wrist;

/// Axes 4 and 6 are in line below this sine.
const IN_LINE: f64 = 1e-12;

impl Arm<'_> {
    /// The angles that a move in joints from `near` to `target` ends at, its last link being at `link`: those claimed
    /// of it, those of its configuration, or those whose largest turn is least.
    ///
    /// `link` is `base_from_link6`. `None`: nothing tells them, since the arm has no spherical wrist and no angles were
    /// claimed.
    ///
    /// # Errors
    /// Why there are none, in words.
    pub(super) fn chosen(
        &self,
        target: &ArmTarget,
        link: &Isometry3<f64>,
        near: &[f64; 6],
    ) -> Result<Option<[f64; 6]>, String> {
        let Some(wrist) = self.wrist.as_ref().filter(|_| target.angles.is_none()) else { return Ok(target.angles) };
        let all = self.postures(wrist, link, near[3]);
        let first = *all.first().ok_or("out of reach")?;
        if let Some(wanted) = &target.configuration {
            let own = all.into_iter().find(|q| self.cfx(q) == wanted[3]).ok_or("out of reach")?;
            let [cf1, cf4, cf6, _] = wanted.map(middle_of);
            let [_, second, third, _, fifth, _] = *near;
            return Ok(Some(turned(&own, &[cf1, second, third, cf4, fifth, cf6])));
        }
        let within = all.iter().filter_map(|q| self.turned_within(q, near));
        let largest = |q: &[f64; 6]| q.iter().zip(near).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let nearest = within.min_by(|a, b| largest(a).total_cmp(&largest(b)));
        Ok(Some(nearest.unwrap_or_else(|| turned(&first, near))))
    }

    /// The whole turns of `q` nearest to `near` within the bounds of every joint.
    fn turned_within(&self, q: &[f64; 6], near: &[f64; 6]) -> Option<[f64; 6]> {
        let mut all = *q;
        for (k, angle) in all.iter_mut().enumerate() {
            let [low, high] = self.claim.joints[k].bounds;
            let (least, most) = (((low - *angle) / TAU).ceil(), ((high - *angle) / TAU).floor());
            if least > most {
                return None;
            }
            *angle += TAU * ((near[k] - *angle) / TAU).round().clamp(least, most);
        }
        Some(all)
    }

    /// Every posture, its turns aside, with the last link at `link`; where axes 4 and 6 are in line axis 4 is at
    /// `fourth`, rad.
    fn postures(&self, wrist: &Wrist, link: &Isometry3<f64>, fourth: f64) -> Vec<[f64; 6]> {
        let screws = &self.screws;
        // From where a point of the last link is at rest to where it is to be.
        let moved = link * screws.rest[6].inverse();
        let goal = moved * wrist.centre;
        let mut all = Vec::with_capacity(8);
        for first in self.sideways(wrist, &goal) {
            let seen = screws.turn(0, -first) * goal;
            for [second, third] in self.two_links(wrist, &seen) {
                let arm = screws.turn(0, first) * screws.turn(1, second) * screws.turn(2, third);
                let rest = arm.inverse() * moved;
                let [a, b] = self.wrist_angles(&rest, fourth);
                all.extend([a, b].map(|[fourth, fifth, sixth]| [first, second, third, fourth, fifth, sixth]));
            }
        }
        all
    }

    /// Angles of axis 1 that put the wrist's centre as far along axis 2 as it is at rest, for the axes behind it do not
    /// move it that way: n·Rot(−θ)u = c.
    fn sideways(&self, wrist: &Wrist, goal: &Point3<f64>) -> Vec<f64> {
        let ((base, up), (_, across)) = (self.screws.lines[0], self.screws.lines[1]);
        let u = goal - base;
        let flat = u - up * up.dot(&u);
        let asked = across.dot(&(wrist.centre - base));
        solutions(across.dot(&flat), -across.dot(&up.cross(&u)), asked - across.dot(&(u - flat)))
    }

    /// Angles of axes 2 and 3 that put the wrist's centre at `goal`: |a + Rot(θ₃)c| is the distance of the goal from
    /// axis 2, then θ₂ turns the one onto the other.
    ///
    /// Empty where the goal is nearer or farther than the two links reach.
    fn two_links(&self, wrist: &Wrist, goal: &Point3<f64>) -> Vec<[f64; 2]> {
        let ((shoulder, across), (elbow, third)) = (self.screws.lines[1], self.screws.lines[2]);
        let flat = |way: Vector3<f64>| way - across * across.dot(&way);
        let (a, c, wanted) = (flat(elbow - shoulder), flat(wrist.centre - elbow), flat(goal - shoulder));
        let rest = 0.5 * (wanted.norm_squared() - a.norm_squared() - c.norm_squared());
        let bends = solutions(a.dot(&c), a.dot(&third.cross(&c)), rest).into_iter();
        let both = |bend: f64| [angle_about(&across, &(a + self.screws.turn(2, bend) * c), &wanted), bend];
        bends.map(both).collect()
    }

    /// Both ways to turn the wrist by what `rest` turns.
    ///
    /// Angles of axes 4, 5 and 6, rad; with axes 4 and 6 in line axis 4 stays at `near`.
    fn wrist_angles(&self, rest: &Isometry3<f64>, near: f64) -> [[f64; 3]; 2] {
        let screws = &self.screws;
        let [fourth, fifth, sixth] = [3, 4, 5].map(|k| screws.lines[k].1);
        let goal = rest * sixth;
        let (sine, cosine) = (fourth.cross(&goal).norm(), fourth.dot(&goal));
        let at_rest = angle_about(&fifth, &fourth, &sixth);
        [1.0, -1.0].map(|side| {
            let bend = libm::atan2(side * sine, cosine) - at_rest;
            let bent = screws.turn(4, bend);
            let turn = if sine > IN_LINE { angle_about(&fourth, &(bent * sixth), &goal) } else { near };
            let left = (screws.turn(3, turn) * bent).inverse() * (rest * fifth);
            [turn, bend, angle_about(&sixth, &fifth, &left)]
        })
    }
}

/// All θ with a cos θ + b sin θ = c.
///
/// ```text
/// θ = atan2(b, a) ± atan2(√(a² + b² − c²), c)
/// ```
///
/// None where |c| is beyond hypot(a, b), two equal ones at the border; rounding may lose that one.
fn solutions(a: f64, b: f64, c: f64) -> Vec<f64> {
    let square = a * a + b * b - c * c;
    if square.is_nan() || square < 0.0 {
        return Vec::new();
    }
    let (middle, half) = (libm::atan2(b, a), libm::atan2(square.sqrt(), c));
    vec![middle - half, middle + half]
}

/// The angle about `axis` (of length 1) from one direction to the other, rad in (−π, π].
///
/// Both directions are first cut to what is across the axis; 0 where one of them lies along it.
fn angle_about(axis: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    let across = |v: &Vector3<f64>| v - axis * axis.dot(v);
    let (from, to) = (across(from), across(to));
    libm::atan2(axis.dot(&from.cross(&to)), from.dot(&to))
}

/// Every angle by whole turns as near to `near` as it comes.
fn turned(q: &[f64; 6], near: &[f64; 6]) -> [f64; 6] {
    std::array::from_fn(|k| q[k] + TAU * ((near[k] - q[k]) / TAU).round())
}
