//! A hull that grows by one point after the other: triangles that know their neighbours, and how a point is put in.
//!
//! Barber, Dobkin and Huhdanpaa, "The Quickhull algorithm for convex hulls" (ACM TOMS 22, 1996), with the plane's sign,
//! not a merge of facets, deciding what is seen: what rounding tangles is told and tried again with a larger tolerance.

use nalgebra::Vector3;

use super::cloud::{Cloud, Farthest, Plane, beyond};

/// Marks a triangle that is no longer of the hull.
const GONE: u32 = u32::MAX;

/// A triangle of the hull, counter-clockwise seen from outside.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    /// Numbers of its points.
    pub(super) corners: [u32; 3],
    /// Triangles across the edges 0→1, 1→2, 2→0.
    pub(super) neighbours: [u32; 3],
    /// Its plane, the normal outward.
    pub(super) plane: Plane,
    /// Twice its area, m².
    pub(super) area: f64,
    /// Number of the last insertion that looked at it, and whether that saw it from outside; or [`GONE`].
    ///
    /// It saves a clearing of marks: numbers of insertions only grow.
    looked: (u32, bool),
}

/// What rounding has broken.
///
/// The horizon was no single loop, a triangle had no area, or points came back without end.
pub(super) struct Tangled;

/// The plane through three points, its normal by the right hand, and twice the triangle's area.
///
/// NaN for three points in a line; whoever asks looks at the area first.
pub(super) fn plane(points: &[Vector3<f64>], corners: [u32; 3]) -> (Plane, f64) {
    let [a, b, c] = corners.map(|i| points[i as usize]);
    let normal = (b - a).cross(&(c - a));
    let area = normal.norm();
    let normal = normal / area;
    // The mean of the corners' offsets halves what rounding does to a sliver.
    ([normal.x, normal.y, normal.z, normal.dot(&((a + b + c) / 3.0))], area)
}

/// A hull of some of the points.
///
/// Triangles are only appended while it grows, and taken out by [`Growing::sweep`]; numbers stay what they are until
/// then. Lengths in m.
pub(super) struct Growing<'a> {
    points: &'a [Vector3<f64>],
    triangles: Vec<Triangle>,
    /// For every triangle the farthest point beyond it.
    farthest: Vec<Farthest>,
    /// m: points no farther beyond a plane than this lie in the hull.
    tolerance: f64,
    insertions: u32,
    /// For every point the new triangle whose first corner it is, if it is one.
    starts: Vec<u32>,
    seen: Vec<u32>,
    /// Edges between what is seen from the new point and what is not: (from, to, the triangle that is not seen).
    horizon: Vec<(u32, u32, u32)>,
    new_planes: Vec<Plane>,
}

impl<'a> Growing<'a> {
    /// The tetrahedron of four points, d below the triangle a, b, c as it turns.
    ///
    /// Orientation is not checked: d must lie below a, b, c, or every normal points inward.
    pub(super) fn new(points: &'a [Vector3<f64>], [a, b, c, d]: [u32; 4], tolerance: f64) -> Result<Self, Tangled> {
        let mut hull = Self {
            points,
            triangles: Vec::with_capacity(1024),
            farthest: Vec::with_capacity(1024),
            tolerance,
            insertions: 0,
            starts: vec![0; points.len()],
            seen: Vec::new(),
            horizon: Vec::new(),
            new_planes: Vec::new(),
        };
        for (corners, neighbours) in
            [([a, b, c], [1, 2, 3]), ([a, d, b], [3, 2, 0]), ([b, d, c], [1, 3, 0]), ([c, d, a], [2, 1, 0])]
        {
            hull.push(corners, neighbours)?;
        }
        Ok(hull)
    }

    /// Appends a triangle; one without area is tangled.
    fn push(&mut self, corners: [u32; 3], neighbours: [u32; 3]) -> Result<(), Tangled> {
        let (plane, area) = plane(self.points, corners);
        if area.is_nan() || area <= 0.0 {
            return Err(Tangled);
        }
        self.triangles.push(Triangle { corners, neighbours, plane, area, looked: (0, false) });
        Ok(())
    }

    /// To be called after [`Growing::sweep`].
    pub(super) fn into_triangles(self) -> Vec<Triangle> {
        self.triangles
    }

    /// One a triangle, in their order.
    pub(super) fn planes(&self) -> Vec<Plane> {
        self.triangles.iter().map(|triangle| triangle.plane).collect()
    }

    /// Adds points of `cloud` until none lies beyond the hull; all triangles must be of the hull.
    ///
    /// Each insertion takes the point farthest beyond one open triangle. O(points · new triangles), points eight
    /// abreast in [`Cloud`].
    pub(super) fn grow(&mut self, cloud: &Cloud) -> Result<(), Tangled> {
        self.farthest.clear();
        cloud.farthest(&self.planes(), self.tolerance, &mut self.farthest);
        let mut open: Vec<u32> = (0..self.triangles.len() as u32).collect();
        while let Some(triangle) = open.pop() {
            let farthest = self.farthest[triangle as usize];
            if self.triangles[triangle as usize].looked.0 == GONE || farthest.distance <= self.tolerance {
                continue;
            }
            let first = self.triangles.len() as u32;
            self.insert(farthest.point, triangle)?;
            self.new_planes.clear();
            self.new_planes.extend(self.triangles[first as usize..].iter().map(|new| new.plane));
            cloud.farthest(&self.new_planes, self.tolerance, &mut self.farthest);
            open.extend(first..self.triangles.len() as u32);
        }
        Ok(())
    }

    /// Puts the cone from `point` to the horizon in the place of the triangles seen from it, `visible` among them.
    ///
    /// New triangles are a fan (from, to, point) over the horizon; neighbours are joined around it by their first
    /// corners. The hull is not to be used after [`Tangled`].
    fn insert(&mut self, point: u32, visible: u32) -> Result<(), Tangled> {
        self.insertions += 1;
        // A point that comes back again and again, because rounding takes it out each time.
        if self.insertions as usize > 2 * self.points.len() + 8 {
            return Err(Tangled);
        }
        self.look(point, visible);
        if self.horizon.is_empty() {
            return Err(Tangled);
        }
        let first = self.triangles.len() as u32;
        for edge in 0..self.horizon.len() {
            let (from, to, outer) = self.horizon[edge];
            let new = self.triangles.len() as u32;
            // A second edge from the same corner: what is seen is no disc.
            if self.new_at(from, first).is_some() {
                return Err(Tangled);
            }
            self.starts[from as usize] = new;
            self.push([from, to, point], [outer, GONE, GONE])?;
            let outer = &mut self.triangles[outer as usize];
            let side = (0..3).find(|side| outer.corners[*side] == to).ok_or(Tangled)?;
            outer.neighbours[side] = new;
        }
        // Once around: as many steps as edges, or there were several loops.
        let (mut at, mut steps) = (first, 0);
        while steps == 0 || (at != first && steps < self.horizon.len()) {
            let next = self.new_at(self.triangles[at as usize].corners[1], first).ok_or(Tangled)?;
            self.triangles[at as usize].neighbours[1] = next;
            self.triangles[next as usize].neighbours[2] = at;
            (at, steps) = (next, steps + 1);
        }
        if at == first && steps == self.horizon.len() { Ok(()) } else { Err(Tangled) }
    }

    /// The triangle from `first` on whose first corner is `corner`.
    fn new_at(&self, corner: u32, first: u32) -> Option<u32> {
        let start = self.starts[corner as usize];
        let new = start >= first && self.triangles.get(start as usize).is_some_and(|t| t.corners[0] == corner);
        new.then_some(start)
    }

    /// Takes out the triangles seen from `point`, by neighbourhood from `visible`, and collects the horizon.
    ///
    /// Breadth first over neighbours; each triangle is held against the point once. What is seen is meant to be a disc,
    /// whose edge is the horizon.
    fn look(&mut self, point: u32, visible: u32) {
        let x = self.points[point as usize];
        self.horizon.clear();
        self.seen.clear();
        self.seen.push(visible);
        self.triangles[visible as usize].looked = (self.insertions, true);
        let mut next = 0;
        while let Some(&triangle) = self.seen.get(next) {
            next += 1;
            let Triangle { corners, neighbours, .. } = self.triangles[triangle as usize];
            for side in 0..3 {
                let other = &mut self.triangles[neighbours[side] as usize];
                if other.looked.0 != self.insertions {
                    other.looked = (self.insertions, beyond(&other.plane, &x) > self.tolerance);
                    if other.looked.1 {
                        self.seen.push(neighbours[side]);
                    }
                }
                if !other.looked.1 {
                    self.horizon.push((corners[side], corners[(side + 1) % 3], neighbours[side]));
                }
            }
        }
        for &triangle in &self.seen {
            self.triangles[triangle as usize].looked.0 = GONE;
        }
    }

    /// Forgets the triangles that are gone.
    ///
    /// O(triangles); numbers of triangles change.
    pub(super) fn sweep(&mut self) {
        let mut kept = 0;
        let places: Vec<u32> = (self.triangles.iter())
            .map(|triangle| {
                let place = kept;
                kept += u32::from(triangle.looked.0 != GONE);
                place
            })
            .collect();
        self.triangles.retain(|triangle| triangle.looked.0 != GONE);
        for triangle in &mut self.triangles {
            triangle.neighbours = triangle.neighbours.map(|i| places[i as usize]);
        }
    }
}
