//! The convex hull of a few hundred points, many of them equal or in one plane, as triangles.
//!
//! Quickhull (Barber, Dobkin, Huhdanpaa 1996) without lists of outside points: the farthest point beyond a triangle is
//! found by a scan over all points that are left, and few are left once those inside the hull of the extremes in 26
//! directions are gone. A point within a tolerance of a triangle counts as inside. Where rounding makes the part seen
//! from a new point no disc, the whole is begun again with ten times the tolerance.

use nalgebra::Vector3;

use super::cloud::{Cloud, Plane};
use super::growing::{Growing, Tangled, Triangle, plane};
use crate::math::simd::Simd;

/// First tolerance as a share of the extent.
const FIRST_TOLERANCE: f64 = 1e-11;

/// What [`convex_hull`] finds.
pub(super) struct Found {
    /// Closed surface, neighbours by number.
    pub(super) triangles: Vec<Triangle>,
    /// The points but those deep inside: every plane that holds them holds all.
    pub(super) shell: Cloud,
}

/// The hull of `points`, whose bounding box has the diagonal `extent`; `None` if the points lie in one plane, or nearly
/// so that no tolerance up to a millionth of the extent gives a hull.
///
/// Six tolerances from 10⁻¹¹ of the extent upwards. At least one finite point.
pub(super) fn convex_hull(simd: Simd, points: &[Vector3<f64>], extent: f64) -> Option<Found> {
    let cloud = Cloud::new(simd, points, (0..points.len() as u32).collect());
    let extremes = extremes(&cloud);
    let simplex = simplex(points, &cloud, &extremes)?;
    // Coordinates carry rounding of their own size, however small the cloud.
    let rounding = 1e-14 * points.iter().map(|p| p.amax()).fold(0.0, f64::max);
    let mut tolerance = FIRST_TOLERANCE * extent + rounding;
    while tolerance < 1e-6 * extent {
        if let Ok(found) = attempt(simd, points, &cloud, &extremes, simplex, tolerance) {
            return Some(found);
        }
        tolerance *= 10.0;
    }
    None
}

/// The hull of the extremes first, then grown by those points alone that lie outside of its planes or less than ten
/// tolerances inside; the rest cannot be a corner.
fn attempt(
    simd: Simd,
    points: &[Vector3<f64>],
    cloud: &Cloud,
    extremes: &[u32],
    simplex: [u32; 4],
    tolerance: f64,
) -> Result<Found, Tangled> {
    let mut hull = Growing::new(points, simplex, tolerance)?;
    hull.grow(&Cloud::new(simd, points, extremes.to_vec()))?;
    hull.sweep();
    // Ten tolerances inside of a hull of some, a point has a ball around it inside: no plane beyond all others meets
    // it.
    let shell = Cloud::new(simd, points, cloud.outside(&hull.planes(), -10.0 * tolerance));
    hull.grow(&shell)?;
    hull.sweep();
    Ok(Found { triangles: hull.into_triangles(), shell })
}

/// The farthest points in the 26 directions to a cube's corners, edges and faces, each once, in rising order.
fn extremes(cloud: &Cloud) -> Vec<u32> {
    let directions: Vec<Plane> = (0..27)
        .filter(|i| *i != 13)
        .map(|i| [(i % 3) as f64 - 1.0, (i / 3 % 3) as f64 - 1.0, (i / 9) as f64 - 1.0, 0.0])
        .collect();
    let mut found = Vec::with_capacity(directions.len());
    cloud.farthest(&directions, f64::NEG_INFINITY, &mut found);
    let mut numbers: Vec<u32> = found.into_iter().map(|farthest| farthest.point).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// Four points that span a large tetrahedron, the last below the first three as their order turns.
fn simplex(points: &[Vector3<f64>], cloud: &Cloud, extremes: &[u32]) -> Option<[u32; 4]> {
    let at = |i: u32| points[i as usize];
    let pairs = extremes.iter().flat_map(|&a| extremes.iter().map(move |&b| (a, b)));
    let (a, b) =
        pairs.max_by(|p, q| (at(p.0) - at(p.1)).norm_squared().total_cmp(&(at(q.0) - at(q.1)).norm_squared()))?;
    let line = at(b) - at(a);
    let off = |c: u32| line.cross(&(at(c) - at(a))).norm_squared();
    let c = (0..points.len() as u32).max_by(|p, q| off(*p).total_cmp(&off(*q)))?;
    let (plane, area) = plane(points, [a, b, c]);
    if area <= 0.0 {
        return None;
    }
    let mut found = Vec::with_capacity(2);
    cloud.farthest(&[plane, plane.map(|v| -v)], 0.0, &mut found);
    let (above, below) = (found[0], found[1]);
    // The fourth must lie below the first triangle.
    let (corners, d) = if below.distance >= above.distance { ([a, b, c], below) } else { ([a, c, b], above) };
    (d.distance > 0.0).then_some([corners[0], corners[1], corners[2], d.point])
}
