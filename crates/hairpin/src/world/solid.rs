//! Convex hulls and closed triangle meshes. The only file that sees parry, whose types are glam's.
//!
//! A hull keeps its face planes: inside it the signed distance is max over faces of n·p − offset, in closed form. A
//! mesh's inside is told by the nearest feature's pseudo-normal (Bærentzen and Aanæs, "Signed distance computation
//! using the angle weighted pseudonormal", IEEE TVCG 11(3), 2005, as parry has it); distances go through a tree of
//! boxes.
//!
//! Both kinds are checked where they are built: closed, wound alike, with a volume; so that inside and outside are
//! defined for every point.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{Point3, Vector3};
use parry3d_f64::math::Vector as ParryVector;
use parry3d_f64::query::{PointQuery, PointQueryWithLocation};
use parry3d_f64::shape::{TriMesh, TriMeshFlags};
use parry3d_f64::transformation::try_convex_hull;

use super::bounds::Bounds;
use crate::math::power::power;
use crate::math::segment::segment_distance;

/// A solid bounded by a closed, outward-oriented triangle surface.
///
/// Copies share the surface. Built by [`super::Shape::hull`] and [`super::Shape::mesh`] alone, so that an open or flat
/// one does not exist.
///
/// Memory: the triangles, and a tree of boxes over them.
#[derive(Clone)]
pub struct Solid {
    surface: Arc<TriMesh>,
    bounds: Bounds,
    /// Faces, of hulls only.
    faces: Option<Arc<[Face]>>,
}

impl std::fmt::Debug for Solid {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let kind = if self.faces.is_some() { "hull" } else { "mesh" };
        write!(f, "Solid({kind}, {} triangles)", self.surface.indices().len())
    }
}

/// The plane of a hull's face: normal·p ≤ offset inside.
///
/// Unit normal, outwards; offset in m.
#[derive(Clone, Copy)]
struct Face {
    normal: Vector3<f64>,
    offset: f64,
}

impl Face {
    /// m; above 0 outside of this face.
    fn height(&self, p: &Point3<f64>) -> f64 {
        self.normal.dot(&p.coords) - self.offset
    }
}

/// What is wrong with points or triangles: the offending value and what it must be.
/// Worded for the message that names the key.
pub(super) type Refusal = (String, String);

impl Solid {
    /// The convex hull of `points` (m).
    ///
    /// # Errors
    /// Points without a volume, or so placed that a point lies outside of the hull found by more than 10⁻⁷ of its
    /// size.
    pub(super) fn hull(points: &[Point3<f64>]) -> Result<Self, Refusal> {
        let flat = || (format!("{} points", points.len()), "at least 4 points that do not lie in one plane".to_owned());
        if points.len() < 4 {
            return Err(flat());
        }
        let given: Vec<ParryVector> = points.iter().map(to_parry).collect();
        let (vertices, triangles) = try_convex_hull(&given).map_err(|_| flat())?;
        let bounds = Bounds::around(points).ok_or_else(flat)?;
        let scale = (bounds.max - bounds.min).norm();
        let faces = faces(&vertices, &triangles, scale);
        if faces.len() < 4 || volume(&vertices, &triangles) <= 1e-9 * power(scale, 3) {
            return Err(flat());
        }
        let outside = |p: &Point3<f64>| faces.iter().any(|face| face.height(p) > 1e-7 * scale);
        if let Some(index) = points.iter().position(outside) {
            return Err((
                format!("point {index} outside the hull found"),
                "points whose hull is well conditioned".into(),
            ));
        }
        let surface = TriMesh::new(vertices, triangles).map_err(|_| flat())?;
        Ok(Self { surface: Arc::new(surface), bounds, faces: Some(faces.into()) })
    }

    /// The inside of the closed surface given by `vertices` (m) and `triangles` (vertex indices from 0).
    ///
    /// Vertices with equal coordinates are one vertex, triangles that thereby lose their area vanish, and a surface
    /// wound inside out is turned. Self-intersections are not looked for.
    ///
    /// # Errors
    /// Indices that do not exist, edges that are not between two triangles wound alike, triangles without area, no
    /// volume.
    pub(super) fn mesh(vertices: &[Point3<f64>], triangles: &[[u32; 3]]) -> Result<Self, Refusal> {
        if let Some((index, triangle)) =
            triangles.iter().enumerate().find(|(_, t)| t.iter().any(|&v| v as usize >= vertices.len()))
        {
            return Err((
                format!("triangles[{index}] = {triangle:?}"),
                format!("three vertex indices below {}", vertices.len()),
            ));
        }
        let (vertices, mut triangles) = merge(vertices, triangles);
        closed(&triangles)?;
        if let Some((index, _)) = triangles.iter().enumerate().find(|(_, t)| sliver(&vertices, t)) {
            return Err((format!("triangle {index} of the merged mesh without area"), "triangles with an area".into()));
        }
        let volume = volume(&vertices, &triangles);
        if volume < 0.0 {
            for triangle in &mut triangles {
                triangle.swap(1, 2);
            }
        }
        let none = || ("no volume".to_owned(), "a closed surface around a volume".to_owned());
        let bounds = Bounds::around(&vertices.iter().map(from_parry).collect::<Vec<_>>()).ok_or_else(none)?;
        if volume.abs() <= 1e-12 * power((bounds.max - bounds.min).norm(), 3) {
            return Err(none());
        }
        let surface = TriMesh::with_flags(vertices, triangles, TriMeshFlags::ORIENTED)
            .map_err(|error| (error.to_string(), "a closed, consistently wound surface".to_owned()))?;
        Ok(Self { surface: Arc::new(surface), bounds, faces: None })
    }

    /// The smallest box around the solid.
    ///
    /// m.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The surface's vertices, m, for drawing.
    pub fn vertices(&self) -> Vec<Point3<f64>> {
        self.surface.vertices().iter().map(from_parry).collect()
    }

    /// The surface's triangles, counter-clockwise seen from outside, as indices into [`Solid::vertices`].
    pub fn triangles(&self) -> &[[u32; 3]] {
        self.surface.indices()
    }

    /// Distance of `p` to the surface, m; negative inside.
    ///
    /// O(faces) inside of hulls; else a descent of the tree.
    pub fn signed_distance(&self, p: &Point3<f64>) -> f64 {
        let point = to_parry(p);
        if let Some(faces) = &self.faces {
            // Inside a convex polyhedron the nearest face's plane is the nearest point of the surface.
            let depth = faces.iter().map(|face| face.height(p)).fold(f64::NEG_INFINITY, f64::max);
            return if depth <= 0.0 { depth } else { self.surface.distance_to_local_point(point, false).abs() };
        }
        let (projection, _) = self.surface.project_local_point_and_get_location(point, false);
        let distance = (projection.point - point).length();
        if projection.is_inside { -distance } else { distance }
    }

    /// Smallest distance between the segment a–b and the solid, m. Where they meet: 0, or the deeper end's signed
    /// distance, a lower bound of the depth.
    ///
    /// A best-first descent of the box tree; each triangle costs three pairs of segments and one crossing.
    pub fn segment_distance(&self, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
        let ends = self.signed_distance(a).min(self.signed_distance(b));
        if ends <= 0.0 {
            return ends;
        }
        let Some(box_of_segment) = Bounds::around([a, b]) else { return ends };
        let to_surface = self.surface.bvh().find_best(
            ends,
            |node, _| {
                let node = Bounds { min: from_parry(&node.mins()), max: from_parry(&node.maxs()) };
                box_of_segment.distance_to(&node)
            },
            |triangle, _| {
                let triangle = self.surface.triangle(triangle);
                Some(segment_to_triangle(a, b, &[triangle.a, triangle.b, triangle.c].map(|p| from_parry(&p))))
            },
        );
        to_surface.map_or(ends, |(_, distance)| distance.min(ends))
    }
}

/// Distance between the segment a–b and a triangle, given that the ends' own distances are known: the minimum lies at
/// an end, on an edge, or is zero where the segment crosses the inside.
fn segment_to_triangle(a: &Point3<f64>, b: &Point3<f64>, corners: &[Point3<f64>; 3]) -> f64 {
    let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
    let (above, below) = (normal.dot(&(a - corners[0])), normal.dot(&(b - corners[0])));
    if above * below <= 0.0 && above != below {
        let crossing = a + (b - a) * (above / (above - below));
        let inside = (0..3).all(|i| {
            let (from, to) = (corners[i], corners[(i + 1) % 3]);
            (to - from).cross(&(crossing - from)).dot(&normal) >= 0.0
        });
        if inside {
            return 0.0;
        }
    }
    (0..3).map(|i| segment_distance(a, b, &corners[i], &corners[(i + 1) % 3])).fold(f64::INFINITY, f64::min)
}

fn to_parry(p: &Point3<f64>) -> ParryVector {
    ParryVector::new(p.x, p.y, p.z)
}

fn from_parry(p: &ParryVector) -> Point3<f64> {
    Point3::new(p.x, p.y, p.z)
}

/// The signed volume Σ a·(b×c)/6, about the first vertex for accuracy far from the origin.
fn volume(vertices: &[ParryVector], triangles: &[[u32; 3]]) -> f64 {
    let Some(origin) = vertices.first() else { return 0.0 };
    let corner = |index: u32| vertices[index as usize] - *origin;
    triangles.iter().map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c))) / 6.0).sum()
}

/// Outward planes of the hull's faces; faces too thin to have a direction are left out.
///
/// Coplanar triangles each have one: only their maximum is asked for.
fn faces(vertices: &[ParryVector], triangles: &[[u32; 3]], scale: f64) -> Vec<Face> {
    triangles
        .iter()
        .filter_map(|t| {
            let [a, b, c] = t.map(|index| from_parry(&vertices[index as usize]));
            let normal = (b - a).cross(&(c - a));
            (normal.norm() > 1e-12 * scale * scale).then(|| {
                let normal = normal.normalize();
                Face { normal, offset: normal.dot(&a.coords) }
            })
        })
        .collect()
}

/// One vertex per distinct coordinates, and no triangle that uses one twice.
///
/// Equal to the bit, but for the sign of zero.
fn merge(vertices: &[Point3<f64>], triangles: &[[u32; 3]]) -> (Vec<ParryVector>, Vec<[u32; 3]>) {
    let mut numbers = BTreeMap::new();
    let mut distinct = Vec::new();
    let renumbered: Vec<u32> = vertices
        .iter()
        .map(|p| {
            // Adding zero makes −0.0 the same key as 0.0.
            let key = [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits());
            *numbers.entry(key).or_insert_with(|| {
                distinct.push(to_parry(p));
                (distinct.len() - 1) as u32
            })
        })
        .collect();
    let triangles = triangles.iter().map(|t| t.map(|v| renumbered[v as usize]));
    (distinct, triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect())
}

/// Every edge must be used once in each direction.
fn closed(triangles: &[[u32; 3]]) -> Result<(), Refusal> {
    let mut uses: BTreeMap<(u32, u32), [u32; 2]> = BTreeMap::new();
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            uses.entry((from.min(to), from.max(to))).or_default()[usize::from(from > to)] += 1;
        }
    }
    let bound = || "a closed surface: every edge between exactly two triangles, wound the same way".to_owned();
    if triangles.is_empty() {
        return Err(("no triangles".into(), bound()));
    }
    match uses.iter().find(|(_, count)| **count != [1, 1]) {
        None => Ok(()),
        Some((edge, [1, 0] | [0, 1])) => Err((format!("open at edge {edge:?}"), bound())),
        Some((edge, [2, 0] | [0, 2])) => Err((format!("triangles wound against each other at edge {edge:?}"), bound())),
        Some((edge, [forth, back])) => Err((format!("{} triangles at edge {edge:?}", forth + back), bound())),
    }
}

/// Twice its area at most 10⁻¹² of the square of its longest edge.
fn sliver(vertices: &[ParryVector], triangle: &[u32; 3]) -> bool {
    let [a, b, c] = triangle.map(|index| from_parry(&vertices[index as usize]));
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    (b - a).cross(&(c - a)).norm() <= 1e-12 * longest * longest
}
