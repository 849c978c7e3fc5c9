//! How far a convex hull of points is from a region: what links of arms are held against, where they are more than
//! segments.
//!
//! By Gilbert, Johnson and Keerthi's algorithm on support functions (`math::convex`), each step of which gives a lower
//! bound (a plane) and an upper one (two points); half-spaces and reach spheres have closed forms.

use nalgebra::{Point3, Vector3};

use super::region::Region;
use crate::math::convex::{Gap, farthest, gap};
use crate::math::segment;
use crate::world::{Bounds, Shape, Solid};

impl Region {
    /// Bounds of the distance between the convex hull of `points` (never none) and the region, m; `None` for words. The
    /// search ends where the distance is at most `met` or more than `clear`.
    ///
    /// Up to rounding; a region with a core (see [`Region::nearest`]) by its core and the radius that grows it.
    pub fn hull_gap(&self, points: &[Point3<f64>], [met, clear]: [f64; 2]) -> Option<Gap> {
        let hull = |n: &Vector3<f64>| farthest(points, n);
        let exactly = |distance: f64| Gap { least: distance.max(0.0), most: distance.max(0.0) };
        let grown = |core: &dyn Fn(&Vector3<f64>) -> Point3<f64>, radius: f64| {
            let found = gap(hull, core, [met + radius, clear + radius]);
            Gap { least: (found.least - radius).max(0.0), most: (found.most - radius).max(0.0) }
        };
        Some(match self {
            Self::Shape(Shape::Sphere { center, radius }) => grown(&|_| *center, *radius),
            Self::Shape(Shape::Capsule { a, b, radius }) => grown(&|n| farthest(&[*a, *b], n), *radius),
            Self::Shape(Shape::Box { center, half_extents: h }) => {
                grown(&|n| center + h.zip_map(n, |half, part| if part < 0.0 { -half } else { half }), 0.0)
            }
            Self::Cylinder { a, b, radius } => grown(&|n| of_cylinder(a, b, *radius, n), 0.0),
            Self::Shape(Shape::Hull(solid)) => {
                let corners = solid.vertices();
                grown(&|n| farthest(&corners, n), 0.0)
            }
            Self::Shape(Shape::Mesh(solid)) => of_mesh(points, solid, [met, clear]),
            Self::HalfSpace { normal, offset } => {
                let height = |p: &Point3<f64>| (normal.dot(&p.coords) - offset) / normal.norm();
                exactly(points.iter().map(height).fold(f64::INFINITY, f64::min))
            }
            // The farthest point of a hull is a corner.
            Self::Beyond { center, radius } => {
                exactly(radius - points.iter().map(|p| (p - center).norm()).fold(0.0, f64::max))
            }
            Self::Words(_) => return None,
        })
    }
}

/// The farthest point of a cylinder.
///
/// Along `n`, of any length; where `n` is along the axis any point of the disc is one, and its centre is taken.
fn of_cylinder(a: &Point3<f64>, b: &Point3<f64>, radius: f64, n: &Vector3<f64>) -> Point3<f64> {
    let axis = b - a;
    let across = n - axis * (n.dot(&axis) / axis.norm_squared());
    let rim = across.try_normalize(0.0).map_or(Vector3::zeros(), |out| out * radius);
    (if n.dot(&axis) > 0.0 { *b } else { *a }) + rim
}

/// The nearest of all triangles; a hull that meets none is inside the mesh as a whole, or outside.
///
/// Triangles whose boxes are farther than `clear`, or than the nearest one so far, count by their boxes, which errs
/// low. A first point inside ends it. O(triangles).
fn of_mesh(points: &[Point3<f64>], solid: &Solid, [met, clear]: [f64; 2]) -> Gap {
    let Some(around) = Bounds::around(points) else { return Gap { least: f64::INFINITY, most: f64::INFINITY } };
    if solid.signed_distance(&points[0]) <= 0.0 {
        return Gap::NONE;
    }
    let vertices = solid.vertices();
    let mut nearest = Gap { least: f64::INFINITY, most: f64::INFINITY };
    for triangle in solid.triangles() {
        let corners = triangle.map(|v| vertices[v as usize]);
        let apart = Bounds::around(&corners).map_or(0.0, |own| own.distance_to(&around));
        if apart > clear.min(nearest.most) {
            nearest.least = nearest.least.min(apart);
            continue;
        }
        let found = gap(|n| farthest(points, n), |n| farthest(&corners, n), [met, clear]);
        nearest = Gap { least: nearest.least.min(found.least), most: nearest.most.min(found.most) };
        if nearest.most <= met {
            break;
        }
    }
    nearest
}

/// Bounds of the distance between two hulls of points, as [`Region::hull_gap`] has it; of two segments their own
/// formula.
///
/// Both sets are never empty. m; 0 where they meet.
pub fn hulls_gap(a: &[Point3<f64>], b: &[Point3<f64>], enough: [f64; 2]) -> Gap {
    match (a, b) {
        ([p, q], [r, s]) => {
            let distance = segment::segment_distance(p, q, r, s);
            Gap { least: distance, most: distance }
        }
        _ => gap(|n| farthest(a, n), |n| farthest(b, n), enough),
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    const WHOLE: [f64; 2] = [0.0, f64::INFINITY];

    fn corners(at: [f64; 3], half: f64) -> Vec<[f64; 3]> {
        let side = |c: usize, k: usize| at[k] + if c >> k & 1 == 1 { half } else { -half };
        (0..8).map(|c| [0, 1, 2].map(|k| side(c, k))).collect()
    }

    fn points(at: [f64; 3]) -> Vec<Point3<f64>> {
        corners(at, 0.5).into_iter().map(Point3::from).collect()
    }

    #[test]
    fn a_cube_is_as_far_from_every_region_as_closed_forms_say() {
        let shape = |shape: Result<Shape, crate::world::WorldError>| Region::Shape(shape.unwrap());
        let twelve = [
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        let regions = [
            (shape(Shape::sphere([3.5, 0.0, 0.0], 1.0)), 2.0),
            (shape(Shape::capsule([3.5, 0.0, -9.0], [3.5, 0.0, 9.0], 1.0)), 2.0),
            (shape(Shape::cuboid([4.0, 5.0, 0.2], [1.0; 3])), 5.0),
            (Region::cylinder([0.0, 0.0, 2.5], [0.0, 0.0, 9.0], 0.7).unwrap(), 2.0),
            (shape(Shape::hull(&corners([4.0, 5.0, 0.2], 0.5))), 5.0),
            (shape(Shape::mesh(&corners([4.0, 5.0, 0.2], 0.5), &twelve)), 5.0),
            (Region::half_space([0.0, 0.0, 2.0], -5.0).unwrap(), 2.0),
            (Region::beyond([0.0, 0.0, 0.0], 2.0 + 0.75_f64.sqrt()).unwrap(), 2.0),
        ];
        for (region, right) in &regions {
            let found = region.hull_gap(&points([0.0; 3]), WHOLE).unwrap();
            assert!((found.least - right).abs() < 1e-9 && (found.most - right).abs() < 1e-9, "{found:?} {region:?}");
            assert!(region.hull_gap(&points([0.0; 3]), [0.0, 1.0]).unwrap().least > 1.0, "{region:?}");
        }
        // Wholly inside.
        for region in [shape(Shape::mesh(&corners([0.0; 3], 5.0), &twelve)), shape(Shape::sphere([0.0; 3], 5.0))] {
            assert_eq!(region.hull_gap(&points([1.0; 3]), WHOLE), Some(Gap::NONE));
        }
        let words = Region::Words(super::super::Words::parse("z < 0", 1.0).unwrap());
        assert_eq!(words.hull_gap(&points([0.0; 3]), WHOLE), None);
    }
}
