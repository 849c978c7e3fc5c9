//! Faces of more than three corners, cut into triangles. A fan of one that is not convex has triangles outside of it,
//! turned over, and what is inside of the mesh would be outside. One that is not flat is a surface that its corners do
//! not say: triangles are taken that hold all of them.

use std::collections::BTreeSet;

use nalgebra::{Point2, Vector3};

/// How far corners of a face may lie beside its plane, as a share of how wide it is, where nothing covers all ways to
/// cut it.
const PLANAR: f64 = 0.01;
/// Up to this share a face is flat: decimals of a text.
const FLAT: f64 = 1e-6;
/// What is smaller, as a share of the face's squared width, is no area.
const NOTHING: f64 = 1e-12;
/// A corner that turns by less, as a share of the face's squared width, does not make it convex.
const CONVEX: f64 = 1e-6;
/// Corners of a face, at most: each is held against every other.
const MOST_CORNERS: usize = 4096;
/// Corners of a face that is not flat, at most: all ways to cut it take the cube of them.
const MOST_UNEVEN: usize = 64;
/// The way out, for a person.
const WAY_OUT: &str = "triangulate on export";

/// What the triangles of a mesh are for, which says what a face that is not flat is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Faces {
    /// The surface of a solid that is wound outwards: of all ways to cut a face the one that all others lie within.
    Outwards,
    /// The surface of a solid that is wound inwards, alike.
    Inwards,
    /// Convex hulls: triangles in whose hull every way to cut a face lies, whichever part of them is looked at.
    Hulls,
}

/// The triangles of a face, as numbers of its corners, in its own orientation: the fan of a convex one, the ears of
/// others (Meisters, 1975), found in the plane of the least sum of products, which is Newell's.
///
/// A face that is not flat has as many surfaces as there are ways to cut it. Seen along its normal a convex one is a
/// height over a convex polygon, and of all triangulations of its corners the upper envelope, which is concave, is
/// nowhere lower than another: the one of the largest volume below it. So a solid's is cut by that, and holds what any
/// reader makes of it. Of hulls all triangles of a corner and an edge are taken: any two corners are joined.
///
/// # Errors
/// Why it is no face, behind `a face of 5 corners`.
pub(super) fn cut(corners: &[[f64; 3]], faces: Faces) -> Result<Vec<[usize; 3]>, String> {
    let fan = || (2..corners.len()).map(|i| [0, i - 1, i]).collect();
    // What is not finite is told by its vertex.
    if corners.len() <= 3 || corners.iter().flatten().any(|x| !x.is_finite()) {
        return Ok(fan());
    }
    if corners.len() > MOST_CORNERS {
        return Err(format!("has more than {MOST_CORNERS}: {WAY_OUT}"));
    }
    let few = corners.len() <= MOST_UNEVEN;
    if faces == Faces::Hulls && few {
        return Ok(match flat_triangles(corners, FLAT) {
            Ok(triangles) => triangles,
            Err(_) => joined(corners.len()),
        });
    }
    let at = centred(corners);
    if let Some((normal, wide)) = plane(&at)
        && few
        && beside(&at, &normal) > FLAT * wide
    {
        let flat = seen_along(&at, &normal);
        let turns = |i: usize| area(&flat[i], &flat[(i + 1) % flat.len()], &flat[(i + 2) % flat.len()]);
        let convex = (0..flat.len()).all(|i| turns(i) > CONVEX * wide * wide);
        if convex && !crosses_itself(&flat, NOTHING * wide * wide) {
            return Ok(outermost(&at, if faces == Faces::Inwards { -1.0 } else { 1.0 }));
        }
    }
    flat_triangles(corners, PLANAR)
}

/// The triangles of a face whose corners lie within a share `flat` of its width beside its plane.
fn flat_triangles(corners: &[[f64; 3]], flat: f64) -> Result<Vec<[usize; 3]>, String> {
    let fan = || (2..corners.len()).map(|i| [0, i - 1, i]).collect();
    let at = centred(corners);
    let Some((normal, wide)) = plane(&at) else {
        let longest = at.iter().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
        let axis = longest.and_then(|p| p.try_normalize(0.0)).unwrap_or_default();
        let off = at.iter().map(|p| (p - axis * p.dot(&axis)).norm()).fold(0.0, f64::max);
        // Without any width it is nowhere in the way.
        return if off <= 1e-6 * width(&at) { Ok(fan()) } else { Err("crosses itself".into()) };
    };
    let off = beside(&at, &normal);
    if off > flat * wide {
        let share = 100.0 * off / wide;
        return Err(format!(
            "is not flat: a corner is {share:.1} % of its width beside its plane, at most {} % where it is not convex \
             or has more than {MOST_UNEVEN}: {WAY_OUT}",
            100.0 * flat
        ));
    }
    let flat = seen_along(&at, &normal);
    let nothing = NOTHING * wide * wide;
    if crosses_itself(&flat, nothing) {
        return Err("crosses itself".into());
    }
    let turns = |i: usize| area(&flat[i], &flat[(i + 1) % flat.len()], &flat[(i + 2) % flat.len()]);
    if (0..flat.len()).all(|i| turns(i) >= -nothing) {
        return Ok(fan());
    }
    ears(&flat, nothing).ok_or_else(|| "is no simple polygon: nothing can be cut off it".into())
}

/// Corners from their middle.
fn centred(corners: &[[f64; 3]]) -> Vec<Vector3<f64>> {
    let at: Vec<Vector3<f64>> = corners.iter().map(|p| Vector3::from(*p)).collect();
    let middle = at.iter().sum::<Vector3<f64>>() / at.len() as f64;
    at.iter().map(|p| p - middle).collect()
}

fn width(at: &[Vector3<f64>]) -> f64 {
    2.0 * at.iter().map(|p| p.norm()).fold(0.0, f64::max)
}

/// Newell's normal, and how wide a face is; `None` of one without an area.
fn plane(at: &[Vector3<f64>]) -> Option<(Vector3<f64>, f64)> {
    let wide = width(at);
    let twice_area: Vector3<f64> = (0..at.len()).map(|i| at[i].cross(&at[(i + 1) % at.len()])).sum();
    twice_area.try_normalize(NOTHING * wide * wide).map(|normal| (normal, wide))
}

/// How far a corner lies beside the plane, at most.
fn beside(at: &[Vector3<f64>], normal: &Vector3<f64>) -> f64 {
    at.iter().map(|p| p.dot(normal).abs()).fold(0.0, f64::max)
}

/// Corners in the plane across `normal`, counter-clockwise as the face is.
fn seen_along(at: &[Vector3<f64>], normal: &Vector3<f64>) -> Vec<Point2<f64>> {
    let first =
        at.iter().map(|p| p - normal * p.dot(normal)).max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
    let x = first.and_then(|p| p.try_normalize(0.0)).unwrap_or_else(Vector3::x);
    let y = normal.cross(&x);
    at.iter().map(|p| Point2::new(p.dot(&x), p.dot(&y))).collect()
}

/// The triangulation of a polygon with the largest volume below it, `sign` = 1, or the smallest, −1: over chains of
/// corners, max V(i, j) = V(i, k) + V(k, j) + pᵢ·(pₖ × pⱼ)/6. O(n³).
fn outermost(at: &[Vector3<f64>], sign: f64) -> Vec<[usize; 3]> {
    let n = at.len();
    let mut best = vec![vec![(0.0, 0); n]; n];
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            let by = |k: usize| best[i][k].0 + best[k][j].0 + sign * at[i].dot(&at[k].cross(&at[j]));
            let found = (i + 1..j).map(|k| (by(k), k)).max_by(|a, b| a.0.total_cmp(&b.0));
            best[i][j] = found.unwrap_or_default();
        }
    }
    let mut triangles = Vec::with_capacity(n - 2);
    let mut open = vec![(0, n - 1)];
    while let Some((i, j)) = open.pop() {
        if j > i + 1 {
            let k = best[i][j].1;
            triangles.push([i, k, j]);
            open.extend([(i, k), (k, j)]);
        }
    }
    triangles
}

/// Every triangle of a corner and an edge, each once.
fn joined(n: usize) -> Vec<[usize; 3]> {
    let mut triangles = BTreeSet::new();
    for i in 0..n {
        for j in 0..n {
            let mut triangle = [i, j, (j + 1) % n];
            triangle.sort_unstable();
            if triangle[0] != triangle[1] && triangle[1] != triangle[2] {
                triangles.insert(triangle);
            }
        }
    }
    triangles.into_iter().collect()
}

/// Twice the area of a triangle, above 0 counter-clockwise.
fn area(a: &Point2<f64>, b: &Point2<f64>, c: &Point2<f64>) -> f64 {
    (b - a).perp(&(c - a))
}

/// Whether two edges cross between their ends; edges may touch, as those do that lead to a hole and back.
fn crosses_itself(flat: &[Point2<f64>], nothing: f64) -> bool {
    let edge = |i: usize| (&flat[i], &flat[(i + 1) % flat.len()]);
    let apart = |a: f64, b: f64| (a > nothing && b < -nothing) || (a < -nothing && b > nothing);
    (0..flat.len()).any(|i| {
        let (a, b) = edge(i);
        (i + 2..flat.len()).any(|k| {
            let (c, d) = edge(k);
            apart(area(a, b, c), area(a, b, d)) && apart(area(c, d, a), area(c, d, b))
        })
    })
}

/// Cuts off one corner after the other whose triangle has no other corner in it, nor on its edge, if there is one.
fn ears(flat: &[Point2<f64>], nothing: f64) -> Option<Vec<[usize; 3]>> {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    let mut triangles = Vec::with_capacity(flat.len() - 2);
    while left.len() > 3 {
        let ear = [true, false]
            .into_iter()
            .find_map(|closed| (0..left.len()).find(|place| is_ear(flat, &left, *place, nothing, closed)))?;
        let before = left[(ear + left.len() - 1) % left.len()];
        triangles.push([before, left[ear], left[(ear + 1) % left.len()]]);
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    Some(triangles)
}

fn is_ear(flat: &[Point2<f64>], left: &[usize], place: usize, nothing: f64, closed: bool) -> bool {
    let corner = |step: usize| &flat[left[(place + step) % left.len()]];
    let (a, b, c) = (corner(left.len() - 1), corner(0), corner(1));
    if area(a, b, c) <= nothing {
        return false;
    }
    let least = if closed { -nothing } else { nothing };
    let is_in = |p: &Point2<f64>| {
        let is_corner = [a, b, c].into_iter().any(|corner| p == corner);
        !is_corner && area(a, b, p) > least && area(b, c, p) > least && area(c, a, p) > least
    };
    !left.iter().any(|other| is_in(&flat[*other]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the area that triangles have together along the normal of all, and the least of one.
    fn areas(corners: &[[f64; 3]], triangles: &[[usize; 3]]) -> (f64, f64) {
        let of = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| Vector3::from(corners[i]));
            (b - a).cross(&(c - a))
        };
        let all: Vector3<f64> = triangles.iter().map(of).sum();
        let normal = all.normalize();
        let least = triangles.iter().map(|t| of(t).dot(&normal)).fold(f64::INFINITY, f64::min);
        (all.norm(), least)
    }

    fn turned(flat: &[[f64; 2]], from: usize) -> Vec<[f64; 3]> {
        // In a plane that no axis lies in.
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, -1.1, 2.0);
        let place =
            |p: &[f64; 2]| <[f64; 3]>::from(turn * Vector3::new(p[0], p[1], 3.0) + Vector3::new(50.0, -7.0, 9.0));
        flat.iter().cycle().skip(from).take(flat.len()).map(place).collect()
    }

    const L: [[f64; 2]; 6] = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]];
    const COMB: [[f64; 2]; 8] =
        [[0.0, 0.0], [6.0, 0.0], [6.0, 5.0], [5.0, 1.0], [3.0, 5.0], [2.0, 1.0], [1.0, 5.0], [0.5, 1.0]];

    #[test]
    fn concave_faces_are_cut_within_themselves_wherever_they_begin() {
        for shape in [&L[..], &COMB[..]] {
            let reversed: Vec<[f64; 2]> = shape.iter().rev().copied().collect();
            for (shape, from) in (0..shape.len()).flat_map(|from| [(shape, from), (&reversed[..], from)]) {
                let corners = turned(shape, from);
                let triangles = cut(&corners, Faces::Outwards).unwrap();
                assert_eq!(triangles.len(), shape.len() - 2);
                let (all, least) = areas(&corners, &triangles);
                let shoelace: f64 = (0..shape.len())
                    .map(|i| {
                        let ([a, b], [c, d]) = (shape[i], shape[(i + 1) % shape.len()]);
                        a * d - b * c
                    })
                    .sum();
                assert!((all - shoelace.abs()).abs() < 1e-9 && least > 1e-9, "{from}: {all} {least}");
            }
        }
    }

    #[test]
    fn a_way_to_a_hole_and_back_is_cut_too() {
        let keyhole = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ];
        let corners = turned(&keyhole, 0);
        let (all, least) = areas(&corners, &cut(&corners, Faces::Outwards).unwrap());
        assert!((all - 24.0).abs() < 1e-9 && least > -1e-9, "{all} {least}");
    }

    #[test]
    fn convex_faces_are_fans() {
        let quad = turned(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 0);
        assert_eq!(cut(&quad, Faces::Outwards).unwrap(), [[0, 1, 2], [0, 2, 3]]);
        let line = turned(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]], 0);
        assert_eq!(cut(&line, Faces::Outwards).unwrap().len(), 2);
    }

    #[test]
    fn what_crosses_itself_or_is_not_flat_is_refused() {
        let bow = turned(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]], 0);
        assert_eq!(cut(&bow, Faces::Outwards), Err("crosses itself".into()));
        let uneven = turned(&[[0.0, 0.0], [3.0, 2.0], [3.0, 0.0], [0.0, 1.0]], 0);
        assert_eq!(cut(&uneven, Faces::Outwards), Err("crosses itself".into()));
        let star: Vec<[f64; 2]> = (0..5)
            .map(|k| {
                let t = 4.0 * f64::from(k) * std::f64::consts::PI / 5.0;
                [t.cos(), t.sin()]
            })
            .collect();
        assert_eq!(cut(&turned(&star, 0), Faces::Outwards), Err("crosses itself".into()));
        // A dart whose tip is lifted: what covers all ways to cut it is not known.
        let dart = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.5, 0.5, 0.2], [0.0, 2.0, 0.0]];
        let told = cut(&dart, Faces::Outwards).unwrap_err();
        assert!(told.starts_with("is not flat: a corner is") && told.ends_with("triangulate on export"), "{told}");
        assert_eq!(cut(&dart, Faces::Hulls).unwrap().len(), 4);
        assert_eq!(cut(&bow, Faces::Hulls).unwrap().len(), 4);
        // Too many corners, each a little beside the plane of the others.
        let crown = |n: usize| -> Vec<[f64; 3]> {
            (0..n)
                .map(|k| {
                    let t = std::f64::consts::TAU * k as f64 / n as f64;
                    [t.cos(), t.sin(), if k % 2 == 0 { 0.1 } else { -0.1 }]
                })
                .collect()
        };
        assert!(cut(&crown(66), Faces::Outwards).unwrap_err().contains("more than 64: triangulate on export"));
        assert!(cut(&crown(66), Faces::Hulls).unwrap_err().contains("triangulate on export"));
        assert_eq!(cut(&crown(64), Faces::Outwards).unwrap().len(), 62);
    }

    /// Where a triangulation is over a place of the plane.
    fn height(corners: &[[f64; 3]], triangles: &[[usize; 3]], x: f64, y: f64) -> Option<f64> {
        triangles.iter().find_map(|t| {
            let [a, b, c] = t.map(|i| corners[i]);
            let flat = |p: [f64; 3]| Point2::new(p[0], p[1]);
            let p = Point2::new(x, y);
            let all = area(&flat(a), &flat(b), &flat(c));
            let shares = [
                area(&flat(b), &flat(c), &p) / all,
                area(&flat(c), &flat(a), &p) / all,
                area(&flat(a), &flat(b), &p) / all,
            ];
            shares.iter().all(|share| *share >= -1e-12).then(|| shares[0] * a[2] + shares[1] * b[2] + shares[2] * c[2])
        })
    }

    #[test]
    fn an_uneven_face_holds_every_way_to_cut_it() {
        use hairpin::math::random::hashed_unit;
        for seed in 0..200 {
            let unit = |i: u64, k: u64| hashed_unit(seed, &[i, k]);
            let n = 4 + (seed % 5) as usize;
            let corners: Vec<[f64; 3]> = (0..n)
                .map(|i| {
                    let t = std::f64::consts::TAU * (i as f64 + 0.6 * unit(i as u64, 0)) / n as f64;
                    [t.cos(), t.sin(), 0.1 * (unit(i as u64, 1) - 0.5)]
                })
                .collect();
            let [over, under] = [Faces::Outwards, Faces::Inwards].map(|faces| cut(&corners, faces).unwrap());
            // Newell's plane may be turned a little: what is asked of is seen from above.
            for from in 0..n {
                let fan: Vec<[usize; 3]> = (2..n).map(|i| [from, (from + i - 1) % n, (from + i) % n]).collect();
                for k in 0..50 {
                    let (x, y) = (2.0 * unit(k, 2) - 1.0, 2.0 * unit(k, 3) - 1.0);
                    let Some(at) = height(&corners, &fan, x, y) else { continue };
                    let bounds = [&under, &over].map(|t| height(&corners, t, x, y));
                    let [Some(low), Some(high)] = bounds else { panic!("seed {seed}: {bounds:?}") };
                    assert!(low <= at + 1e-9 && at <= high + 1e-9, "seed {seed}, from {from}: {low} {at} {high}");
                }
            }
        }
    }

    #[test]
    fn hulls_join_any_two_corners() {
        let bent = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.3], [0.0, 1.0, 0.0]];
        assert_eq!(cut(&bent, Faces::Hulls).unwrap(), [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]);
        let five = joined(5);
        let joins = |a: usize, b: usize| five.iter().any(|t| t.contains(&a) && t.contains(&b));
        assert!((0..5).all(|a| (0..5).all(|b| joins(a, b))));
        let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1e-7], [0.0, 1.0, 0.0]];
        assert_eq!(cut(&flat, Faces::Hulls).unwrap().len(), 2);
    }
}
