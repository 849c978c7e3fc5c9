//! Distances of points from solids, each by a formula of its own.
//!
//! Triangles: the nearest of all, and inside by the sum of solid angles (4π inside, 0 outside), where the claim has a
//! winding number and eleven separating directions.

use nalgebra::{Point3, Vector3};

use super::claim::ArmSolidForm;

/// The box around triangles.
pub(super) fn box_around(form: &ArmSolidForm) -> Option<ArmSolidForm<'static>> {
    let ArmSolidForm::Triangles(triangles) = form else { return None };
    let mut corners = triangles.iter().flatten();
    let first = *corners.next()?;
    let (low, high) = corners.fold((first, first), |(low, high), corner| (low.inf(corner), high.sup(corner)));
    Some(ArmSolidForm::Box(nalgebra::center(&low, &high), (high - low) * 0.5))
}

/// Distance of a point from a solid, m; inside at most 0.
///
/// Exact up to rounding, but for words, which have 0 or infinity. A cylinder's axis must have a length; the normal
/// of a half space need not be of length 1.
pub(super) fn distance(form: &ArmSolidForm, p: &Point3<f64>) -> f64 {
    match form {
        ArmSolidForm::Ball(center, radius) => (p - center).norm() - radius,
        ArmSolidForm::Box(center, half) => {
            let d = (p - center).abs() - half;
            d.map(|part| part.max(0.0)).norm() + d.max().min(0.0)
        }
        ArmSolidForm::Capsule(axis, radius) => (p - nearest_on(axis, p)).norm() - radius,
        ArmSolidForm::Cylinder([a, b], radius) => {
            let along = (b - a).normalize();
            let height = (p - a).dot(&along);
            let aside = (p - a - along * height).norm() - radius;
            let beyond = (-height).max(height - (b - a).norm());
            Vector3::new(aside.max(0.0), beyond.max(0.0), 0.0).norm() + aside.max(beyond).min(0.0)
        }
        ArmSolidForm::HalfSpace(normal, offset) => (normal.dot(&p.coords) - offset) / normal.norm(),
        ArmSolidForm::Triangles(triangles) => {
            let far =
                triangles.iter().map(|triangle| (p - nearest_in(triangle, p)).norm()).fold(f64::INFINITY, f64::min);
            // The solid angle of a closed surface, seen from inside, is the whole sphere's.
            let seen: f64 = triangles.iter().map(|triangle| solid_angle(triangle, p)).sum();
            if seen.abs() > std::f64::consts::TAU { -far } else { far }
        }
        ArmSolidForm::Where(holds) => {
            if holds(p) {
                0.0
            } else {
                f64::INFINITY
            }
        }
    }
}

/// Of the segment.
fn nearest_on([a, b]: &[Point3<f64>; 2], p: &Point3<f64>) -> Point3<f64> {
    let way = b - a;
    let square = way.norm_squared();
    let share = if square > 0.0 { ((p - a).dot(&way) / square).clamp(0.0, 1.0) } else { 0.0 };
    a + way * share
}

/// The foot on the plane where it lies inside, else the nearest point of an edge.
fn nearest_in(triangle: &[Point3<f64>; 3], p: &Point3<f64>) -> Point3<f64> {
    let [a, b, c] = triangle;
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    if square > 0.0 {
        let foot = p - normal * ((p - a).dot(&normal) / square);
        let inside = |u: &Point3<f64>, v: &Point3<f64>| (v - u).cross(&(foot - u)).dot(&normal) >= 0.0;
        if inside(a, b) && inside(b, c) && inside(c, a) {
            return foot;
        }
    }
    let edges = [[*a, *b], [*b, *c], [*c, *a]].map(|edge| nearest_on(&edge, p));
    let far = |q: &Point3<f64>| (p - q).norm_squared();
    edges.into_iter().min_by(|q, r| far(q).total_cmp(&far(r))).unwrap_or(*a)
}

/// Van Oosterom & Strackee 1983.
///
/// tan(Ω/2) = a·(b × c)/(|a||b||c| + (a·b)|c| + (b·c)|a| + (c·a)|b|), signed by the side, sr. "The solid angle of a
/// plane triangle", IEEE Trans. Biomedical Engineering 30(2).
fn solid_angle(triangle: &[Point3<f64>; 3], p: &Point3<f64>) -> f64 {
    let [a, b, c] = triangle.map(|corner| corner - p);
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let below = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    2.0 * libm::atan2(a.dot(&b.cross(&c)), below)
}

/// Whether words hold at a distance of `room` (m) from a point, in one of the directions `around`; of other forms the
/// distance tells.
pub(super) fn holds_around(form: &ArmSolidForm, p: &Point3<f64>, room: f64, around: &[Vector3<f64>]) -> bool {
    let ArmSolidForm::Where(holds) = form else { return false };
    around.iter().any(|direction| holds(&(p + direction * room)))
}

/// Directions to the corners, edges and faces of a cube, of length 1.
///
/// 26 of them: every place at `room` from a point is within about half of `room` of one that is asked.
pub(super) fn to_all_sides() -> Vec<Vector3<f64>> {
    let side = |i: usize| i as f64 - 1.0;
    let cube = (0..27).map(|i| Vector3::new(side(i % 3), side(i / 3 % 3), side(i / 9)));
    cube.filter_map(|v| v.try_normalize(0.0)).collect()
}
