//! Joints that follow others (`mimic`): whether an axis of the arm drives them, and where what they carry may be.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Isometry3, Point3};

use super::element::{UrdfError, at, child, number, told};
use super::shapes::Shape;
use super::tree::{Joint, Tree, UNBOUNDED};

/// Joints that follow one another, at most.
const MOST_MASTERS: usize = 64;

/// What moves a joint of no axis.
pub(super) enum Driven {
    /// An axis of the arm: this far from 0 at most, rad or m.
    ByAxis(f64),
    /// Nothing: it rests here, rad or m.
    AtRest(f64),
}

/// All joints by name, and which of them are the arm's axes.
pub(super) struct Masters<'a, 't> {
    named: BTreeMap<&'t str, &'a Joint<'t>>,
    axes: BTreeSet<&'t str>,
}

impl<'a, 't> Masters<'a, 't> {
    pub(super) fn of(tree: &'a Tree<'t>, axes: impl Iterator<Item = usize>) -> Self {
        let named = tree.joints.iter().map(|joint| (joint.name, joint)).collect();
        Self { named, axes: axes.map(|joint| tree.joints[joint].name).collect() }
    }

    /// What moves a joint that is no axis, whichever joints it follows one another's: share · master + offset, from
    /// master to master.
    ///
    /// # Errors
    /// A master that is not there; joints that follow one another in a circle; a bound that is no number.
    pub(super) fn driven(&self, joint: &Joint) -> Result<Driven, UrdfError> {
        let (mut here, mut share, mut offset) = (joint, 1.0, 0.0);
        for _ in 0..=MOST_MASTERS {
            let Some((master, times, more)) = here.mimic else {
                return Ok(Driven::AtRest(share * alone(here)? + offset));
            };
            (offset, share) = (offset + share * more, share * times);
            let Some(followed) = self.named.get(master) else {
                let what = format!("joint {} follows `{}`, and no joint is called so", here.told(), told(master));
                return Err(at(&here.node, &what));
            };
            here = followed;
            if self.axes.contains(master) {
                let far = bounds(here)?.map(|bound| (share * bound + offset).abs());
                return Ok(Driven::ByAxis(far[0].max(far[1])));
            }
        }
        let what = format!("joint {} follows itself, or more than {MOST_MASTERS} others", joint.told());
        Err(at(&joint.node, &what))
    }
}

/// Where a joint that follows no other rests: at 0 or the bound next to it.
fn alone(joint: &Joint) -> Result<f64, UrdfError> {
    let Some(limit) = child(&joint.node, "limit") else { return Ok(0.0) };
    let bound = |name: &str| limit.attribute(name).map_or(Ok(0.0), |_| number(&limit, name));
    let (lower, upper) = (bound("lower")?, bound("upper")?);
    Ok(if lower <= upper { 0f64.clamp(lower, upper) } else { 0.0 })
}

/// Of an axis, rad.
fn bounds(axis: &Joint) -> Result<[f64; 2], UrdfError> {
    let limit = child(&axis.node, "limit").filter(|_| axis.node.attribute("type") != Some("continuous"));
    let Some(limit) = limit else { return Ok([-UNBOUNDED.to_radians(), UNBOUNDED.to_radians()]) };
    let bound = |name: &str| limit.attribute(name).map_or(Ok(0.0), |_| number(&limit, name));
    Ok([bound("lower")?, bound("upper")?])
}

/// Where a link is that followers carry: the frame that `since` places it in stands within `reach` (m) of `center` (m,
/// of the arm's link), however it is turned.
///
/// Followers go anywhere, each by itself: lengths add up, whatever the directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Orbit {
    center: Point3<f64>,
    reach: f64,
    since: Isometry3<f64>,
}

impl Orbit {
    pub(super) fn about(center: Point3<f64>) -> Self {
        Self { center, reach: 0.0, since: Isometry3::identity() }
    }

    /// Of what is fixed to it.
    pub(super) fn then(&self, by: &Isometry3<f64>) -> Self {
        Self { since: self.since * by, ..*self }
    }

    /// Of what turns on it.
    pub(super) fn turned(&self) -> Self {
        Self { reach: self.far(), since: Isometry3::identity(), ..*self }
    }

    /// Of what slides on it, this far.
    pub(super) fn slid(&self, travel: f64) -> Self {
        Self { reach: self.reach + travel, ..*self }
    }

    /// How far from the center the link's own frame is, at most, m.
    pub(super) fn far(&self) -> f64 {
        self.reach + self.since.translation.vector.norm()
    }

    pub(super) fn center(&self) -> Point3<f64> {
        self.center
    }

    /// The ball that holds `shape`, which is in the link's frame, wherever that is.
    pub(super) fn around(&self, shape: &Shape) -> Shape {
        let radius = self.reach + shape.placed(&self.since).about(&Point3::origin()).radius;
        Shape { points: vec![self.center], radius, larger: 2.0 * radius }
    }
}

#[cfg(test)]
mod tests {
    use hairpin::math::rotation::from_rotation_vector;
    use nalgebra::{Translation3, Vector3};

    use super::*;

    /// Whatever its followers do, a body stays within its ball: two that turn and one that slides, on one another.
    #[test]
    fn a_ball_holds_what_followers_carry() {
        let origin = |x: f64, y: f64, z: f64| Isometry3::translation(x, y, z);
        let origins = [origin(0.1, 0.0, 0.2), origin(0.0, 0.0, 0.3), origin(0.05, -0.1, 0.0)];
        let shape = Shape { points: vec![Point3::new(0.0, 0.0, -0.3)], radius: 0.03, larger: 0.0 };
        let center = Point3::from(origins[0].translation.vector);
        let orbit = Orbit::about(center).turned().then(&origins[1]).turned().then(&origins[2]).slid(0.25);
        let ball = orbit.around(&shape);
        assert_eq!(ball.points, [center]);
        let mut farthest: f64 = 0.0;
        for k in 0..4000 {
            let angle = |n: i32| f64::from(k % n) * std::f64::consts::TAU / f64::from(n);
            let turn = |axis: Vector3<f64>, angle: f64| {
                Isometry3::from_parts(Translation3::identity(), from_rotation_vector(&(axis * angle)))
            };
            let slide = Isometry3::from(Vector3::new(0.15, -0.2, 0.0) * angle(11).sin());
            let pose = origins[0]
                * turn(Vector3::y(), angle(37))
                * origins[1]
                * turn(Vector3::x(), angle(41))
                * origins[2]
                * slide;
            farthest = farthest.max((pose * shape.points[0] - center).norm() + shape.radius);
        }
        assert!(farthest <= ball.radius && ball.radius < farthest + 0.4, "{farthest} {}", ball.radius);
    }
}
