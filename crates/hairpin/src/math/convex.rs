//! How far two convex sets are apart, of which only the farthest points in given directions are asked: bounds on both
//! sides, so that whoever decides by them need not trust that the search ended well.
//!
//! Sets are asked by their support function alone, s(n) = argmax over the set of n·p, so that capsules, hulls and boxes
//! need no common form. A step costs one question to each set and the nearest point of a simplex, O(1).

use nalgebra::{Point3, Vector3};

/// Bounds of a distance, m.
///
/// least ≤ distance ≤ most, to rounding. Both are 0 for sets that meet and were found to; `least` alone may be 0 where
/// the search ended early.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// No two points are nearer: the sets are separated by a plane with this room.
    pub least: f64,
    /// Two points are this near.
    pub most: f64,
}

impl Gap {
    /// Of sets that meet.
    pub const NONE: Self = Self { least: 0.0, most: 0.0 };
}

/// Steps at most; polytopes of some dozen corners take five to ten.
const MOST_STEPS: usize = 64;
/// Bounds this near to each other, as a share of the distance, are equal.
const EQUAL: f64 = 1e-12;

/// Distance of two convex sets, each given by its farthest point in a direction (of any length).
///
/// Gilbert, Johnson and Keerthi (1988): v is the point nearest to the origin of a simplex of differences a − b; the
/// farthest w against v bounds the distance from below by v·w/|v|, whatever v is, and |v| from above. The search ends
/// where both are equal, or where they tell enough: `most` is at most `met`, or `least` is more than `clear`.
///
/// Rounding leaves both bounds within some 1e-15 of the sets' size.
///
/// `met` and `clear` are m; [0, ∞] asks for the distance itself. After 64 steps the bounds so far are the answer. Not
/// for depths: of sets that overlap it tells 0, not by how much. NaN in a point leaves bounds that say nothing.
pub fn gap(
    a: impl Fn(&Vector3<f64>) -> Point3<f64>,
    b: impl Fn(&Vector3<f64>) -> Point3<f64>,
    [met, clear]: [f64; 2],
) -> Gap {
    let least_of = |v: &Vector3<f64>| a(&-v) - b(v);
    let mut v = least_of(&Vector3::x());
    let mut simplex = Simplex { points: [v; 4], count: 1 };
    let mut known = Gap { least: 0.0, most: v.norm() };
    for _ in 0..MOST_STEPS {
        if known.most == 0.0 {
            return Gap::NONE;
        }
        let w = least_of(&v);
        known.least = known.least.max(v.dot(&w) / v.norm());
        if known.most - known.least <= EQUAL * known.most || known.most <= met || known.least > clear {
            break;
        }
        if simplex.points[..simplex.count].contains(&w) {
            break;
        }
        let Some(nearest) = simplex.with(w) else { return Gap::NONE };
        if nearest.norm() >= known.most {
            break;
        }
        (v, known.most) = (nearest, nearest.norm());
    }
    known
}

/// The farthest of `points` in a direction; they are never none.
///
/// O(points). The first of equals; a direction of NaN gives the first point.
///
/// # Panics
/// Without points.
pub fn farthest(points: &[Point3<f64>], direction: &Vector3<f64>) -> Point3<f64> {
    let (mut best, mut most) = (points[0], f64::NEG_INFINITY);
    for p in points {
        let height = direction.dot(&p.coords);
        if height > most {
            (best, most) = (*p, height);
        }
    }
    best
}

/// At most four points.
///
/// Corners are differences a − b; `count` is 1 to 4 and those beyond it are left over.
struct Simplex {
    points: [Vector3<f64>; 4],
    count: usize,
}

impl Simplex {
    /// Takes in `w` and drops the points that are not needed: the point of all that is nearest to the origin, `None` if
    /// that is the origin itself, inside four points.
    ///
    /// Of four points the faces are looked at that the origin lies outside of; one whose fourth point lies in its plane
    /// counts as such, so that flat bodies are searched and not taken for a meeting.
    fn with(&mut self, w: Vector3<f64>) -> Option<Vector3<f64>> {
        self.points[self.count] = w;
        self.count += 1;
        let [a, b, c, d] = self.points;
        match self.count {
            2 => Some(self.keep(segment(&a, &b))),
            3 => Some(self.keep(triangle(&a, &b, &c))),
            _ => {
                let faces = [[a, b, c, d], [a, c, d, b], [a, d, b, c], [b, d, c, a]];
                let outside = |[a, b, c, other]: &[Vector3<f64>; 4]| {
                    let normal = (b - a).cross(&(c - a));
                    let (of_origin, of_other) = (-a.dot(&normal), (other - a).dot(&normal));
                    // A flat body has no inside.
                    of_origin * of_other < 0.0 || of_other == 0.0
                };
                let near = faces.iter().filter(|face| outside(face)).map(|[a, b, c, _]| triangle(a, b, c));
                let best = near.min_by(|(_, p), (_, q)| p.norm_squared().total_cmp(&q.norm_squared()))?;
                Some(self.keep(best))
            }
        }
    }

    /// Keeps the points of the smallest simplex that holds the nearest point, which is what keeps the next step well
    /// posed.
    fn keep(&mut self, (kept, nearest): (Kept, Vector3<f64>)) -> Vector3<f64> {
        self.count = kept.1;
        self.points[..kept.1].copy_from_slice(&kept.0[..kept.1]);
        nearest
    }
}

/// Points and how many of them count.
type Kept = ([Vector3<f64>; 3], usize);

/// The point of the segment a–b nearest to the origin, and the ends that it needs.
///
/// ```text
/// p = a + d · clamp(−a·d/|d|², 0, 1),   d = b − a
/// ```
///
/// Of a segment without length it is `a`.
fn segment(a: &Vector3<f64>, b: &Vector3<f64>) -> (Kept, Vector3<f64>) {
    let d = b - a;
    let (along, square) = (-a.dot(&d), d.norm_squared());
    if along <= 0.0 || square == 0.0 {
        (([*a; 3], 1), *a)
    } else if along >= square {
        (([*b; 3], 1), *b)
    } else {
        (([*a, *b, *b], 2), a + d * (along / square))
    }
}

/// The point of a triangle nearest to the origin, and the corners that it needs (Ericson, "Real-Time Collision
/// Detection", 2005, §5.1.5).
///
/// Of a flat triangle the nearest of its three edges. O(1), without a division but by |n|² and |d|².
fn triangle(a: &Vector3<f64>, b: &Vector3<f64>, c: &Vector3<f64>) -> (Kept, Vector3<f64>) {
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    // On the inner side of all three edges the foot on the plane is nearest.
    let inside = |u: &Vector3<f64>, v: &Vector3<f64>| u.cross(v).dot(&normal) > 0.0;
    if square > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return (([*a, *b, *c], 3), normal * (a.dot(&normal) / square));
    }
    let edges = [segment(a, b), segment(b, c), segment(c, a)];
    let [first, rest @ ..] = edges;
    rest.into_iter().fold(first, |best, edge| if edge.1.norm_squared() < best.1.norm_squared() { edge } else { best })
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};
    use crate::math::segment::segment_distance;

    fn all(points: &[Point3<f64>]) -> impl Fn(&Vector3<f64>) -> Point3<f64> + '_ {
        |n| farthest(points, n)
    }

    fn cube(at: [f64; 3]) -> Vec<Point3<f64>> {
        let side = |c: usize, k: usize| f64::from((c >> k & 1) as u8) - 0.5;
        (0..8).map(|c| Point3::new(at[0] + side(c, 0), at[1] + side(c, 1), at[2] + side(c, 2))).collect()
    }

    #[test]
    fn segments_and_cubes_are_as_far_apart_as_closed_forms_say() {
        let mut random = stream(3);
        for i in 0..20_000u32 {
            let p: Vec<Point3<f64>> = (0..4)
                .map(|_| {
                    Point3::new(
                        unit(&mut random),
                        unit(&mut random),
                        if i.is_multiple_of(3) { 0.0 } else { unit(&mut random) },
                    )
                })
                .collect();
            let found = gap(all(&p[..2]), all(&p[2..]), [0.0, f64::INFINITY]);
            let right = segment_distance(&p[0], &p[1], &p[2], &p[3]);
            assert!(found.least <= right + 1e-12 && right <= found.most + 1e-12, "{found:?} {right} {p:?}");
            assert!(found.most - found.least < 1e-9, "{found:?} {right} {p:?}");
        }
        for (at, right) in
            [([3.0, 0.0, 0.0], 2.0), ([4.0, 5.0, 0.2], 5.0), ([0.9, 0.9, 0.9], 0.0), ([1.0, 0.0, 0.0], 0.0)]
        {
            let found = gap(all(&cube([0.0; 3])), all(&cube(at)), [0.0, f64::INFINITY]);
            assert!((found.least - right).abs() < 1e-12 && (found.most - right).abs() < 1e-9, "{at:?} {found:?}");
        }
    }

    #[test]
    fn turned_boxes_agree_with_points_of_their_surfaces() {
        let mut random = stream(5);
        for _ in 0..300 {
            let mut turned = |shift: f64| {
                let axis = Vector3::new(unit(&mut random), unit(&mut random), unit(&mut random)) * 3.0;
                let pose =
                    nalgebra::Isometry3::new(Vector3::new(shift * unit(&mut random), unit(&mut random), 0.0), axis);
                cube([0.0; 3]).iter().map(|p| pose * p).collect::<Vec<_>>()
            };
            let (a, b) = (turned(0.0), turned(4.0));
            let found = gap(all(&a), all(&b), [0.0, f64::INFINITY]);
            // Edges against edges and corners against faces: what is sampled is never nearer than the least.
            let pairs = |p: &[Point3<f64>]| -> Vec<[Point3<f64>; 2]> {
                (0..8).flat_map(|i| (0..8).map(move |j| (i, j))).map(|(i, j)| [p[i], p[j]]).collect()
            };
            let (a, b) = (pairs(&a), pairs(&b));
            let seen = a.iter().flat_map(|[p, q]| b.iter().map(move |[r, s]| segment_distance(p, q, r, s)));
            let seen = seen.fold(f64::INFINITY, f64::min);
            assert!(found.least <= seen + 1e-9 && found.most - found.least < 1e-6, "{found:?} {seen}");
        }
    }

    #[test]
    fn what_decides_is_enough() {
        let (a, b) = (cube([0.0; 3]), cube([9.0, 0.3, 0.1]));
        assert!(gap(all(&a), all(&b), [0.0, 1.0]).least > 1.0);
        assert!(gap(all(&a), all(&b), [9.0, 100.0]).most <= 9.0);
    }
}
