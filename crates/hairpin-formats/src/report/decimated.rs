//! Meshes of more triangles than a page holds, with fewer of them.

use std::collections::{HashMap, HashSet};

use hairpin::campaign::kind::Surface;
use nalgebra::Point3;

/// Vertices of a mesh at most: their numbers are written in 16 bits.
const VERTICES: usize = 65_535;
/// Times that the pitch is doubled, at most; that it is halved ends with what that gives.
const TURNS: usize = 40;

/// A surface with fewer triangles, each point of which is within `off` of the surface that it stands for.
pub(super) struct Decimated {
    /// What is drawn; no triangles where `most` leaves none.
    pub surface: Surface,
    /// The diagonal of a cell of the grid, m.
    pub off: f64,
}

/// Whether a surface can be drawn as it is.
pub(super) fn fits(surface: &Surface, most: usize) -> bool {
    surface.triangles.len() <= most && surface.vertices.len() < VERTICES
}

/// At most `most` triangles by clustering: vertices in one cell of a grid become their mean, and triangles that have
/// two corners in a cell go. The pitch is the finest of extent/√most, halved or doubled, that keeps the bound.
///
/// A point drawn is a mean of means within cells, so that none is farther from the surface than a cell's diagonal √3·p.
/// What is thinner than a cell may be missing.
pub(super) fn decimated(surface: &Surface, most: usize) -> Decimated {
    let mut pitch = extent(surface) / (most.max(1) as f64).sqrt();
    let mut found = clustered(surface, pitch);
    let too_many = |found: &Surface| !fits(found, most);
    for _ in 0..TURNS {
        if !too_many(&found) {
            break;
        }
        pitch *= 2.0;
        found = clustered(surface, pitch);
    }
    // Twice as fine has some four times the triangles: not tried where that cannot do.
    while found.triangles.len() * 2 <= most && found.triangles.len() * 2 < surface.triangles.len() {
        let finer = clustered(surface, pitch / 2.0);
        if too_many(&finer) || finer.triangles.len() <= found.triangles.len() {
            break;
        }
        (pitch, found) = (pitch / 2.0, finer);
    }
    Decimated { surface: found, off: pitch * 3.0_f64.sqrt() }
}

/// How many triangles each of the meshes may have: what it has, or an equal part of what smaller ones leave.
pub(super) fn shares(triangles: &[usize], most: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by_key(|&mesh| triangles[mesh]);
    let (mut left, mut shares) = (most, vec![0; triangles.len()]);
    for (done, mesh) in order.into_iter().enumerate() {
        shares[mesh] = triangles[mesh].min(left / (triangles.len() - done));
        left -= shares[mesh];
    }
    shares
}

fn extent(surface: &Surface) -> f64 {
    let side = |axis: usize| {
        let of = surface.vertices.iter().map(|v| v[axis]);
        of.clone().fold(f64::NEG_INFINITY, f64::max) - of.fold(f64::INFINITY, f64::min)
    };
    (0..3).map(side).fold(f64::MIN_POSITIVE, f64::max)
}

fn clustered(surface: &Surface, pitch: f64) -> Surface {
    let (mut cells, mut sums) = (HashMap::new(), Vec::<(Point3<f64>, f64)>::new());
    let mut cluster = |corner: u32| {
        let vertex = surface.vertices[corner as usize];
        let cell = [vertex.x, vertex.y, vertex.z].map(|x| (x / pitch).floor() as i64);
        let number = *cells.entry(cell).or_insert_with(|| {
            sums.push((Point3::origin(), 0.0));
            sums.len() as u32 - 1
        });
        let sum = &mut sums[number as usize];
        *sum = (sum.0 + vertex.coords, sum.1 + 1.0);
        number
    };
    let mapped: Vec<[u32; 3]> = surface.triangles.iter().map(|triangle| triangle.map(&mut cluster)).collect();
    let vertices: Vec<Point3<f64>> = sums.iter().map(|(sum, count)| sum / *count).collect();
    let mut known = HashSet::new();
    let kept = mapped.into_iter().filter(|t| has_area(&vertices, t, pitch) && known.insert(sorted(*t)));
    Surface { name: surface.name.clone(), triangles: kept.collect(), vertices }
}

fn sorted(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}

fn has_area(vertices: &[Point3<f64>], triangle: &[u32; 3], pitch: f64) -> bool {
    let [a, b, c] = triangle.map(|corner| vertices[corner as usize]);
    (b - a).cross(&(c - a)).norm() > 1e-9 * pitch * pitch
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::solids::{Meshes, meshes};

    /// A ball of radius 2 m by rings.
    fn ball(rings: u32, around: u32) -> Surface {
        let at = |ring: u32, turn: u32| {
            let (polar, azimuth) = (f64::from(ring) / f64::from(rings), f64::from(turn) / f64::from(around));
            let (sin, cos) = (polar * std::f64::consts::PI).sin_cos();
            let (y, x) = (azimuth * std::f64::consts::TAU).sin_cos();
            Point3::new(2.0 * sin * x, 2.0 * sin * y, 2.0 * cos)
        };
        let vertices = (0..=rings).flat_map(|ring| (0..around).map(move |turn| at(ring, turn))).collect();
        let quad = |ring: u32, turn: u32| {
            let corner = |down: u32, on: u32| (ring + down) * around + (turn + on) % around;
            [[corner(0, 0), corner(1, 0), corner(1, 1)], [corner(0, 0), corner(1, 1), corner(0, 1)]]
        };
        let triangles = (0..rings).flat_map(|ring| (0..around).flat_map(move |turn| quad(ring, turn))).collect();
        Surface { name: "ball".into(), vertices, triangles }
    }

    #[test]
    fn a_ball_of_200_000_triangles_keeps_the_bound_and_its_shape() {
        let ball = ball(250, 400);
        assert_eq!(ball.triangles.len(), 200_000);
        let Decimated { surface, off } = decimated(&ball, 20_000);
        assert!(surface.triangles.len() <= 20_000 && surface.triangles.len() > 2_000, "{}", surface.triangles.len());
        assert!(off < 0.2, "{off}");
        let corners = |t: &[u32; 3]| t.map(|corner| surface.vertices[corner as usize]);
        for [a, b, c] in surface.triangles.iter().map(corners) {
            assert!((b - a).cross(&(c - a)).norm() > 0.0);
            let middle = Point3::from((a.coords + b.coords + c.coords) / 3.0);
            assert!([a, b, c, middle].iter().all(|p| (p.coords.norm() - 2.0).abs() <= off));
        }
        // And the other way: no point of the ball is without a corner nearby.
        let near = |p: &Point3<f64>| surface.vertices.iter().any(|v| (v - p).norm() <= off);
        assert!(ball.vertices.iter().step_by(97).all(near));
        let again = decimated(&ball, 20_000).surface;
        assert!(again.triangles == surface.triangles && again.vertices == surface.vertices);
    }

    #[test]
    fn what_a_page_carries_of_meshes_has_a_bound_however_many_there_are() {
        let surfaces: Vec<Surface> = (0..6).map(|k| Surface { name: format!("rock {k}"), ..ball(120, 200) }).collect();
        let Meshes { drawn, told } = meshes(&surfaces);
        let carried = serde_json::to_string(&drawn).unwrap().len();
        assert!(carried < 1_000_000, "{carried} bytes of a page of 3 MB");
        assert!(told.starts_with("rock 0 shown with ") && told.contains(" of 48000 triangles, within "), "{told}");
        assert!(told.ends_with("3 more meshes shown with fewer triangles"), "{told}");
    }

    #[test]
    fn small_meshes_keep_their_triangles_and_large_ones_share_the_rest() {
        assert_eq!(shares(&[200_000, 12, 90_000], 20_012), [10_000, 12, 10_000]);
        assert_eq!(shares(&[5, 7], 100), [5, 7]);
    }
}
