//! Faces of more than three corners, cut into triangles that lie in them: a fan of one that is not convex has triangles
//! outside of it, turned over, and what is inside of the mesh would be outside.

use nalgebra::{Point2, Vector3};

/// How far corners of a face may lie beside its plane, as a share of how wide it is.
const PLANAR: f64 = 0.01;
/// What is smaller, as a share of the face's squared width, is no area.
const NOTHING: f64 = 1e-12;
/// Corners of a face, at most: each is held against every other.
const MOST_CORNERS: usize = 4096;

/// The triangles of a face, as numbers of its corners, in its own orientation: the fan of a convex one, the ears of
/// others (Meisters, 1975), found in the plane of the least sum of products, which is Newell's.
///
/// # Errors
/// Why it is no face, behind `a face of 5 corners`.
pub(super) fn cut(corners: &[[f64; 3]]) -> Result<Vec<[usize; 3]>, String> {
    let fan = || (2..corners.len()).map(|i| [0, i - 1, i]).collect();
    // What is not finite is told by its vertex.
    if corners.len() <= 3 || corners.iter().flatten().any(|x| !x.is_finite()) {
        return Ok(fan());
    }
    if corners.len() > MOST_CORNERS {
        return Err(format!("has more than {MOST_CORNERS}"));
    }
    let at: Vec<Vector3<f64>> = corners.iter().map(|p| Vector3::from(*p)).collect();
    let middle = at.iter().sum::<Vector3<f64>>() / at.len() as f64;
    let at: Vec<Vector3<f64>> = at.iter().map(|p| p - middle).collect();
    let wide = 2.0 * at.iter().map(|p| p.norm()).fold(0.0, f64::max);
    let twice_area: Vector3<f64> = (0..at.len()).map(|i| at[i].cross(&at[(i + 1) % at.len()])).sum();
    let Some(normal) = twice_area.try_normalize(NOTHING * wide * wide) else {
        let longest = at.iter().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
        let axis = longest.and_then(|p| p.try_normalize(0.0)).unwrap_or_default();
        let off = at.iter().map(|p| (p - axis * p.dot(&axis)).norm()).fold(0.0, f64::max);
        // Without any width it is nowhere in the way.
        return if off <= 1e-6 * wide { Ok(fan()) } else { Err("crosses itself".into()) };
    };
    let off = at.iter().map(|p| p.dot(&normal).abs()).fold(0.0, f64::max);
    if off > PLANAR * wide {
        let share = 100.0 * off / wide;
        return Err(format!(
            "is not flat: a corner is {share:.1} % of its width beside its plane, at most {} %",
            100.0 * PLANAR
        ));
    }
    let first =
        at.iter().map(|p| p - normal * p.dot(&normal)).max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
    let x = first.and_then(|p| p.try_normalize(0.0)).unwrap_or_else(Vector3::x);
    let y = normal.cross(&x);
    let flat: Vec<Point2<f64>> = at.iter().map(|p| Point2::new(p.dot(&x), p.dot(&y))).collect();
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
                let triangles = cut(&corners).unwrap();
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
        let (all, least) = areas(&corners, &cut(&corners).unwrap());
        assert!((all - 24.0).abs() < 1e-9 && least > -1e-9, "{all} {least}");
    }

    #[test]
    fn convex_faces_are_fans() {
        let quad = turned(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 0);
        assert_eq!(cut(&quad).unwrap(), [[0, 1, 2], [0, 2, 3]]);
        let line = turned(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]], 0);
        assert_eq!(cut(&line).unwrap().len(), 2);
    }

    #[test]
    fn what_crosses_itself_or_is_not_flat_is_refused() {
        let bow = turned(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]], 0);
        assert_eq!(cut(&bow), Err("crosses itself".into()));
        let uneven = turned(&[[0.0, 0.0], [3.0, 2.0], [3.0, 0.0], [0.0, 1.0]], 0);
        assert_eq!(cut(&uneven), Err("crosses itself".into()));
        let star: Vec<[f64; 2]> = (0..5)
            .map(|k| {
                let t = 4.0 * f64::from(k) * std::f64::consts::PI / 5.0;
                [t.cos(), t.sin()]
            })
            .collect();
        assert_eq!(cut(&turned(&star, 0)), Err("crosses itself".into()));
        let bent = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.3], [0.0, 1.0, 0.0]];
        assert!(cut(&bent).unwrap_err().starts_with("is not flat: a corner is"), "{:?}", cut(&bent));
        let nearly = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.01], [0.0, 1.0, 0.0]];
        assert!(cut(&nearly).is_ok());
    }
}
