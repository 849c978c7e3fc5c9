//! Few points and a radius around many points: what a mesh's convex hull is taken for, never smaller.
//!
//! ```text
//! all points ⊂ { p : distance(p, hull of taken) ≤ radius }
//! ```
//!
//! Conservative by construction: distances to the enclosed body are bounded from below by those to the hull less the
//! radius.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashSet};

use nalgebra::{Point3, Vector3};

use super::convex::{farthest, gap};

/// All points within `radius` of the convex hull of `points`.
///
/// Both in the unit of the points; the radius is 0 where all of them lie in the hull.
#[derive(Debug, Clone, PartialEq)]
pub struct Enclosing {
    /// Some of those that were given.
    pub points: Vec<Point3<f64>>,
    /// How far the others may lie outside the hull of these.
    pub radius: f64,
}

/// Points that a hull is made of, at most.
const MOST_POINTS: usize = 64;
/// Points this near to the hull so far are not looked at again, as a share of the size.
///
/// A point dropped so stays within it, as the hull only grows.
const NEAR: f64 = 1e-3;

/// Few of `points`, and the radius with which their hull holds all of them; `None` without points.
///
/// Starts with the farthest in 50 directions; then whatever lies farthest outside is taken in, until nothing does by
/// more than a thousandth of the size or 64 points are taken. The radius is an upper bound of the distance of every
/// other point from the hull ([`gap`]), so that nothing is left out, whatever the search did.
///
/// Size is the largest distance from the first point. Cost: a [`gap`] to every point, and again to those that may be
/// the farthest as the hull grows, each O(points taken) a step; done once for a mesh. Deterministic.
pub fn enclose(points: &[Point3<f64>]) -> Option<Enclosing> {
    let first = points.first()?;
    let size = points.iter().map(|p| (p - first).norm()).fold(0.0, f64::max);
    let mut taken: Vec<Point3<f64>> = Vec::new();
    for direction in directions() {
        let p = farthest(points, &direction);
        if !taken.contains(&p) {
            taken.push(p);
        }
    }
    let near = NEAR * size;
    let mut radius = 0.0_f64;
    let outside =
        |taken: &[Point3<f64>], p: &Point3<f64>| gap(|n| farthest(taken, n), |_| *p, [0.0, f64::INFINITY]).most;
    // Triangles share their corners.
    let mut seen = HashSet::with_capacity(points.len());
    let is_new = |index: &usize| seen.insert(<[f64; 3]>::from(points[*index].coords).map(f64::to_bits));
    let once = (0..points.len()).rev().filter(is_new);
    let mut open: BinaryHeap<Open> = once.map(|index| Open { most: f64::INFINITY, index }).collect();
    while let Some(Open { index, .. }) = open.pop() {
        let far = Open { most: outside(&taken, &points[index]), index };
        if far.most <= near {
            // What is near stays near while the hull grows.
            radius = radius.max(far.most);
        } else if open.peek().is_some_and(|next| *next > far) {
            open.push(far);
        } else if taken.len() < MOST_POINTS {
            taken.push(points[index]);
        } else {
            radius = radius.max(far.most);
            break;
        }
    }
    // Bounds are of rounded numbers.
    let radius = if radius > 0.0 { radius + 1e-12 * size } else { 0.0 };
    Some(Enclosing { points: taken, radius })
}

/// A point outside, by how far it was when it was last asked for: as the hull grows it is no farther.
#[derive(Debug, Clone, Copy)]
struct Open {
    most: f64,
    index: usize,
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        self.most.total_cmp(&other.most).then(self.index.cmp(&other.index))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

/// To the faces, edges and corners of a cube, and between them: 50.
///
/// Not of unit length: 26 of a cube, and 24 with components 0, ± 1, ± 2.
pub fn directions() -> impl Iterator<Item = Vector3<f64>> {
    let side = |i: usize| i as f64 - 1.0;
    let cube = (0..27).map(move |i| Vector3::new(side(i % 3), side(i / 3 % 3), side(i / 9)));
    let between = (0..24).map(|i| {
        let (a, b) = (if i & 1 == 0 { 1.0 } else { -1.0 }, if i & 2 == 0 { 2.0 } else { -2.0 });
        match i / 4 {
            0 => Vector3::new(a, b, 0.0),
            1 => Vector3::new(b, a, 0.0),
            2 => Vector3::new(0.0, a, b),
            3 => Vector3::new(0.0, b, a),
            4 => Vector3::new(a, 0.0, b),
            _ => Vector3::new(b, 0.0, a),
        }
    });
    cube.chain(between).filter(|v| *v != Vector3::zeros())
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};

    #[test]
    fn nothing_is_left_out_and_little_is_added() {
        let mut random = stream(11);
        let ball: Vec<Point3<f64>> = (0..3000)
            .map(|_| {
                let v = Vector3::new(unit(&mut random) - 0.5, unit(&mut random) - 0.5, unit(&mut random) - 0.5);
                Point3::from(v.normalize() * 0.2)
            })
            .collect();
        let found = enclose(&ball).unwrap();
        assert!(found.points.len() <= 64 && found.radius < 0.02, "{} {}", found.points.len(), found.radius);
        for p in &ball {
            let far = gap(|n| farthest(&found.points, n), |_| *p, [0.0, f64::INFINITY]);
            assert!(far.least <= found.radius, "{far:?}");
        }
        let cube: Vec<Point3<f64>> = (0..5000)
            .map(|i| {
                let mut p = [unit(&mut random), unit(&mut random), unit(&mut random)];
                if i < 8 {
                    p = [0, 1, 2].map(|k| f64::from((i >> k & 1) as u8));
                }
                p.into()
            })
            .collect();
        let found = enclose(&cube).unwrap();
        assert!(found.points.len() == 8 && found.radius < 1e-9, "{found:?}");
        // Of 400 points of a cylinder 64 leave no more than the arcs between 16 of each rim.
        let rim = |i: usize| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * (i / 2) as f64 / 200.0);
            Point3::new(0.05 * cos, 0.05 * sin, if i.is_multiple_of(2) { 0.0 } else { 0.27 })
        };
        let found = enclose(&(0..400).map(rim).collect::<Vec<_>>()).unwrap();
        assert!(found.radius < 1.2e-3, "{}", found.radius);
        assert!(enclose(&[]).is_none());
        assert_eq!(enclose(&[Point3::origin()]).unwrap().radius, 0.0);
    }
}
