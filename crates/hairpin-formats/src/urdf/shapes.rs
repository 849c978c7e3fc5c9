//! The collision geometry of links as hulls of points grown by a radius.

use std::collections::BTreeMap;

use hairpin::world::Bounds;
use nalgebra::{Isometry3, Point3, Vector3};
use roxmltree::Node;

use super::element::{UrdfError, at, attribute, child, origin, positive, told, triple};
use super::outline::{Piece, outline};

/// All points within `radius` of the hull of `points`, m, in the frame of the link; and how much larger that may be
/// than what is described.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    pub(super) points: Vec<Point3<f64>>,
    pub(super) radius: f64,
    pub(super) larger: f64,
}

/// What a link's collision geometry came to.
#[derive(Debug, Default)]
pub(super) struct Shapes {
    pub(super) all: Vec<Shape>,
    /// Why some of it could not be had.
    pub(super) missing: Vec<String>,
    /// Whether any is described.
    pub(super) described: bool,
}

/// Vertices (m) and triangles of a mesh.
pub type Triangles = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// Gives a mesh by the name that a URDF has for it.
pub type MeshFile<'f> = dyn Fn(&str) -> Result<Triangles, NoMesh> + 'f;

/// Why there is no mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NoMesh {
    /// It is not there, or of a kind that is not read: its link gets a stand-in.
    Missing(String),
    /// It is there and no mesh: a mistake.
    Broken(String),
}

/// Reads shapes; meshes once each.
pub(super) struct Reader<'f> {
    find: &'f MeshFile<'f>,
    known: BTreeMap<String, Result<Vec<Shape>, String>>,
    triangles: usize,
}

/// Triangles of all meshes together.
const MOST_TRIANGLES: usize = 10_000_000;
/// A shape reaches no farther than this, m: what does is in another unit.
const LARGEST: f64 = 50.0;
/// A mesh smaller than this, m, is in another unit, and would be no body at all.
const SMALLEST: f64 = 0.001;
/// Sides of the prism around a cylinder: half a percent of the radius larger.
const SIDES: usize = 32;

impl<'f> Reader<'f> {
    pub(super) fn new(find: &'f MeshFile<'f>) -> Self {
        Self { find, known: BTreeMap::new(), triangles: 0 }
    }

    /// Of one link.
    ///
    /// # Errors
    /// A shape that is none; a mesh that is there and broken.
    pub(super) fn of(&mut self, link: &Node) -> Result<Shapes, UrdfError> {
        let mut shapes = Shapes::default();
        for collision in link.children().filter(|node| node.has_tag_name("collision")) {
            shapes.described = true;
            let from_shape = origin(&collision)?;
            let Some(shape) = child(&collision, "geometry").and_then(|g| g.children().find(Node::is_element)) else {
                return Err(at(&collision, "<collision> needs <geometry> with a shape"));
            };
            match self.shape(&shape)? {
                Ok(found) => shapes.all.extend(found.iter().map(|shape| shape.placed(&from_shape))),
                Err(why) => shapes.missing.push(why),
            }
        }
        Ok(shapes)
    }

    fn shape(&mut self, shape: &Node) -> Result<Result<Vec<Shape>, String>, UrdfError> {
        let one = |points, radius, larger| Ok(Ok(vec![Shape { points, radius, larger }]));
        match shape.tag_name().name() {
            "sphere" => one(vec![Point3::origin()], positive(shape, "radius")?, 0.0),
            "capsule" => {
                let half = Vector3::z() * 0.5 * positive(shape, "length")?;
                one(vec![Point3::from(-half), Point3::from(half)], positive(shape, "radius")?, 0.0)
            }
            "box" => {
                attribute(shape, "size")?;
                let half = Vector3::from(triple(shape, "size", [0.0; 3])?) * 0.5;
                if half.min() <= 0.0 || half.max() > LARGEST {
                    return Err(at(shape, "size must be three numbers > 0 and < 100, m"));
                }
                let side = |c: usize, k: usize| if c >> k & 1 == 1 { half[k] } else { -half[k] };
                one((0..8).map(|c| Point3::new(side(c, 0), side(c, 1), side(c, 2))).collect(), 0.0, 0.0)
            }
            "cylinder" => {
                let (half, radius) = (0.5 * positive(shape, "length")?, positive(shape, "radius")?);
                let out = radius / libm::cos(std::f64::consts::PI / SIDES as f64);
                let rim = |i: usize| {
                    let (sin, cos) = libm::sincos(std::f64::consts::TAU * (i / 2) as f64 / SIDES as f64);
                    Point3::new(out * cos, out * sin, if i.is_multiple_of(2) { half } else { -half })
                };
                one((0..2 * SIDES).map(rim).collect(), 0.0, out - radius)
            }
            "mesh" => self.mesh(shape),
            other => Err(at(shape, &format!("<{}> is no shape of URDF", told(other)))),
        }
    }

    fn mesh(&mut self, shape: &Node) -> Result<Result<Vec<Shape>, String>, UrdfError> {
        let name = attribute(shape, "filename")?;
        let scale = triple(shape, "scale", [1.0; 3])?;
        if scale.contains(&0.0) {
            return Err(at(shape, "scale must be three numbers that are not 0"));
        }
        let key = format!("{name} {scale:?}");
        if let Some(known) = self.known.get(&key) {
            return Ok(known.clone());
        }
        let wrong = |why: &str| at(shape, &format!("{}: {why}", told(name)));
        let read = match (self.find)(name) {
            Err(NoMesh::Missing(why)) => Err(why),
            Err(NoMesh::Broken(why)) => return Err(at(shape, &why)),
            Ok((vertices, triangles)) => {
                self.triangles += triangles.len();
                if self.triangles > MOST_TRIANGLES {
                    return Err(wrong(&format!("all meshes together have more than {MOST_TRIANGLES} triangles")));
                }
                let scaled = |v: &[f64; 3]| Point3::new(v[0] * scale[0], v[1] * scale[1], v[2] * scale[2]);
                let vertices: Vec<Point3<f64>> = vertices.iter().map(scaled).collect();
                if vertices.iter().any(|p| p.coords.amax() > LARGEST) {
                    return Err(wrong("is larger than 50 m: its unit is another, which scale says"));
                }
                let size = Bounds::around(&vertices).map_or(0.0, |bounds| (bounds.max - bounds.min).max());
                if !vertices.is_empty() && size < SMALLEST {
                    return Err(wrong("is smaller than 1 mm: its unit is another, which scale says"));
                }
                let pieces = outline(&vertices, &triangles);
                if pieces.is_empty() {
                    return Err(wrong("has no points"));
                }
                let shape =
                    |piece: Piece| Shape { points: piece.hull.points, radius: piece.hull.radius, larger: piece.larger };
                Ok(pieces.into_iter().map(shape).collect())
            }
        };
        self.known.insert(key, read.clone());
        Ok(read)
    }
}

impl Shape {
    /// Seen from where `pose` is given.
    pub(super) fn placed(&self, pose: &Isometry3<f64>) -> Self {
        Self { points: self.points.iter().map(|p| pose * p).collect(), ..*self }
    }

    /// The ball about a point that holds the shape however it is turned about it.
    pub(super) fn about(&self, center: &Point3<f64>) -> Self {
        let far = self.points.iter().map(|p| (p - center).norm()).fold(0.0, f64::max) + self.radius;
        Self { points: vec![*center], radius: far, larger: 2.0 * far }
    }

    /// How large it is, at most, m.
    pub(super) fn size(&self) -> f64 {
        let first = self.points.first().copied().unwrap_or_else(Point3::origin);
        2.0 * (self.points.iter().map(|p| (p - first).norm()).fold(0.0, f64::max) + self.radius)
    }
}
