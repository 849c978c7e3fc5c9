//! What a mesh is taken for: convex hulls, never smaller than it, and how much larger they may be.

use hairpin::math::convex::farthest;
use hairpin::math::enclosing::{Enclosing, directions, enclose};
use hairpin::world::Shape;
use nalgebra::{Point3, Vector3};

/// A hull, and how much larger than its part of the mesh it may be, m.
pub(super) struct Piece {
    pub(super) hull: Enclosing,
    pub(super) larger: f64,
}

/// A mesh that its hull exceeds by more than this share of its size, and by more than so many m, is cut …
const CUT: [f64; 2] = [0.03, 5e-3];
/// … across its length into so many slabs, each with a hull of its own.
const SLABS: usize = 4;
/// What slabs together must leave of the volume of one hull.
const GAIN: f64 = 0.9;

/// The hull of a mesh's points, or where that is much larger the hulls of its slabs: what lies inside the mesh between
/// two parallel planes lies in the hull of what of its surface does, for every line parallel to them leaves the mesh
/// there. None without points.
pub(super) fn outline(vertices: &[Point3<f64>], triangles: &[[u32; 3]]) -> Vec<Piece> {
    let corners: Vec<[Point3<f64>; 3]> = triangles.iter().map(|t| t.map(|v| vertices[v as usize])).collect();
    let Some(whole) = piece(vertices, &corners) else { return Vec::new() };
    let (low, high) = vertices.iter().fold((vertices[0], vertices[0]), |(low, high), p| (low.inf(p), high.sup(p)));
    let size = high - low;
    if whole.larger <= (CUT[0] * size.norm()).max(CUT[1]) {
        return vec![whole];
    }
    let axis = size.imax();
    let edge = |i: usize| low[axis] + size[axis] * i as f64 / SLABS as f64;
    let slab = |i: usize| {
        let parts: Vec<Vec<Point3<f64>>> = corners
            .iter()
            .map(|triangle| between(triangle, axis, [edge(i), edge(i + 1)]))
            .filter(|part| part.len() >= 3)
            .collect();
        let fans = parts.iter().flat_map(|part| (2..part.len()).map(move |k| [part[0], part[k - 1], part[k]]));
        let (fans, points) = (fans.collect::<Vec<_>>(), parts.concat());
        piece(&points, &fans)
    };
    let slabs: Vec<Piece> = (0..SLABS).filter_map(slab).collect();
    let filled: f64 = slabs.iter().map(|slab| volume(&slab.hull.points)).sum();
    if slabs.len() == SLABS && filled < GAIN * volume(&whole.hull.points) { slabs } else { vec![whole] }
}

/// Of the hull of some points, m³; 0 of flat ones.
fn volume(points: &[Point3<f64>]) -> f64 {
    let given: Vec<[f64; 3]> = points.iter().map(|p| p.coords.into()).collect();
    let Ok(Shape::Hull(solid)) = Shape::hull(&given) else { return 0.0 };
    let vertices = solid.vertices();
    let corner = |index: u32| vertices[index as usize] - points[0];
    solid.triangles().iter().map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0).sum()
}

fn piece(points: &[Point3<f64>], triangles: &[[Point3<f64>; 3]]) -> Option<Piece> {
    let hull = enclose(points)?;
    let larger = hull.radius + hollow(&hull.points, triangles);
    Some(Piece { hull, larger })
}

/// How deep the middles of triangles lie within a hull, at most, m: 0 of a convex mesh, whose triangles lie on it.
///
/// A plane with all of the hull on one side is as far from the middle as the hull there is thick, at least; those
/// across the triangle and in fifty directions are looked at.
fn hollow(hull: &[Point3<f64>], triangles: &[[Point3<f64>; 3]]) -> f64 {
    let height = |n: &Vector3<f64>| n.dot(&farthest(hull, n).coords);
    let fixed: Vec<(Vector3<f64>, f64)> = directions().map(|n| n.normalize()).map(|n| (n, height(&n))).collect();
    let depth = |[a, b, c]: &[Point3<f64>; 3]| {
        let middle = (a.coords + b.coords + c.coords) / 3.0;
        let across = (b - a).cross(&(c - a)).try_normalize(0.0);
        let own = across.iter().flat_map(|n| [*n, -n]).map(|n| height(&n) - n.dot(&middle));
        let all = own.chain(fixed.iter().map(|(n, height)| height - n.dot(&middle)));
        all.fold(f64::INFINITY, f64::min).max(0.0)
    };
    triangles.iter().map(depth).fold(0.0, f64::max)
}

/// The part of a triangle between two planes across an axis.
fn between(triangle: &[Point3<f64>; 3], axis: usize, [low, high]: [f64; 2]) -> Vec<Point3<f64>> {
    let mut part = triangle.to_vec();
    for (bound, sign) in [(low, 1.0), (high, -1.0)] {
        let inside = |p: &Point3<f64>| sign * (p[axis] - bound) >= 0.0;
        let mut kept = Vec::with_capacity(part.len() + 1);
        for (i, p) in part.iter().enumerate() {
            let q = &part[(i + 1) % part.len()];
            if inside(p) {
                kept.push(*p);
            }
            if inside(p) != inside(q) {
                let mut cut = p + (q - p) * ((bound - p[axis]) / (q[axis] - p[axis]));
                cut[axis] = bound;
                kept.push(cut);
            }
        }
        part = kept;
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairpin::math::convex::gap;

    /// A box from `low` to `high`, its triangles beside those of others.
    fn add(mesh: &mut (Vec<Point3<f64>>, Vec<[u32; 3]>), low: [f64; 3], high: [f64; 3]) {
        let first = mesh.0.len() as u32;
        mesh.0.extend((0..8).map(|c| Point3::from([0, 1, 2].map(|k| if c >> k & 1 == 1 { high[k] } else { low[k] }))));
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        mesh.1.extend(faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).map(|t| t.map(|v| v + first)));
    }

    fn holds(pieces: &[Piece], p: &Point3<f64>) -> bool {
        let far = |piece: &Piece| gap(|n| farthest(&piece.hull.points, n), |_| *p, [0.0, f64::INFINITY]).least;
        pieces.iter().any(|piece| far(piece) <= piece.hull.radius + 1e-12)
    }

    #[test]
    fn a_convex_mesh_is_its_hull() {
        let mut cube = Default::default();
        add(&mut cube, [0.0; 3], [0.1, 0.2, 0.3]);
        let pieces = outline(&cube.0, &cube.1);
        assert!(pieces.len() == 1 && pieces[0].larger < 1e-9, "{}", pieces[0].larger);
        assert!(outline(&[], &[]).is_empty());
    }

    #[test]
    fn a_bent_mesh_is_cut_and_still_held() {
        // An L of 0.5 m and 0.2 m.
        let mut bent = Default::default();
        add(&mut bent, [0.0; 3], [0.5, 0.1, 0.1]);
        add(&mut bent, [0.4, 0.0, 0.0], [0.5, 0.1, 0.3]);
        let pieces = outline(&bent.0, &bent.1);
        assert_eq!(pieces.len(), 4);
        for i in 0..4000 {
            let share = |n: usize, of: usize| (i / n % of) as f64 / (of - 1) as f64;
            let p = Point3::new(0.5 * share(1, 20), 0.1 * share(20, 10), 0.3 * share(200, 20));
            let inside = p.z <= 0.1 || p.x >= 0.4;
            assert!(!inside || holds(&pieces, &p), "{p}");
        }
        // What one hull would fill is free again.
        assert!(!holds(&pieces, &Point3::new(0.2, 0.05, 0.15)));
        assert!(pieces.iter().any(|piece| piece.larger > 1e-3), "the slab with the bend is larger than the bend");
    }
}
