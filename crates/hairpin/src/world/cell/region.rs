//! The kinds of region, as one formula each that numbers, intervals and centred forms can evaluate.
//!
//! | region | ≤ 0 exactly where the region, grown by r, is |
//! | --- | --- |
//! | ball | ‖p − c‖² − (R + r)² |
//! | box, r > 0 | Σ_k max(\|p_k − c_k\| − h_k, 0)² − r²; with r = 0 the largest of the three excesses |
//! | capsule | ‖w − s u‖² − (R + r)², s = clamp(w·u/u·u, 0, 1), w = p − a, u = b − a |
//! | cylinder, r > 0 | max(e₁, 0)² + max(e₂, 0)² − r², e₁ along the axis past a disc, e₂ = ‖w × u‖/‖u‖ − R |
//! | half-space | n·p − offset − r‖n‖ |
//! | beyond | max(R − r, 0)² − ‖p − c‖² |

use nalgebra::{Point3, Vector3};

use super::words::Words;
use crate::math::outward::{Interval, Real};
use crate::world::{Bounds, Shape, Solid, WorldError};

/// Where something must not be; the base's frame, m.
///
/// A point of the border is inside: distance 0 is contact. Grown by r a box has round edges, a cylinder round rims: it
/// is the Minkowski sum with a ball, not a larger box.
#[derive(Debug, Clone)]
pub enum Region {
    /// A ball, box, capsule, convex hull or closed mesh.
    Shape(Shape),
    /// All points between the discs of `radius` around `a` and `b`.
    Cylinder {
        /// Centre of one disc.
        a: Point3<f64>,
        /// Centre of the other.
        b: Point3<f64>,
        /// Radius, > 0.
        radius: f64,
    },
    /// All points with normal·p ≤ offset.
    HalfSpace {
        /// Outward, of any length but zero.
        normal: Vector3<f64>,
        /// In the same measure.
        offset: f64,
    },
    /// All points farther than `radius` from the centre: a sphere to stay inside of.
    Beyond {
        /// Centre.
        center: Point3<f64>,
        /// Radius, > 0.
        radius: f64,
    },
    /// All points for which the words are true.
    Words(Words),
}

/// Vertices and triangles of a hull or mesh.
#[derive(Debug, Clone)]
pub struct Surface {
    /// m.
    pub vertices: Vec<Point3<f64>>,
    /// Counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Of a solid.
    pub fn of(solid: &Solid) -> Self {
        Self { vertices: solid.vertices(), triangles: solid.triangles().to_vec() }
    }

    /// The corners of every triangle.
    pub fn corners(&self) -> impl Iterator<Item = [Point3<f64>; 3]> {
        self.triangles.iter().map(|triangle| triangle.map(|v| self.vertices[v as usize]))
    }
}

/// Numbers beyond this (m) are refused, as in the world.
const LARGEST: f64 = 1e7;

impl Region {
    /// The cylinder between two discs.
    ///
    /// # Errors
    /// `cylinder.a_m`, `cylinder.b_m`: not finite, or one place. `cylinder.radius_m`: not > 0.
    pub fn cylinder(a_m: [f64; 3], b_m: [f64; 3], radius_m: f64) -> Result<Self, WorldError> {
        for (field, place) in [("cylinder.a_m", a_m), ("cylinder.b_m", b_m)] {
            numbers(field, &place)?;
        }
        let (a, b) = (Point3::from(a_m), Point3::from(b_m));
        if (b - a).norm() < 1e-9 {
            return Err(WorldError::new("cylinder.b_m", format!("{b_m:?}"), "another place than a"));
        }
        Ok(Self::Cylinder { a, b, radius: positive("cylinder.radius_m", radius_m)? })
    }

    /// All points with normal·p ≤ offset; the normal need not be of length 1, but then `offset` is in its measure.
    ///
    /// # Errors
    /// `half_space.normal`: no direction. `half_space.offset_m`: not finite.
    pub fn half_space(normal: [f64; 3], offset_m: f64) -> Result<Self, WorldError> {
        numbers("half_space.normal", &normal)?;
        numbers("half_space.offset_m", &[offset_m])?;
        let direction = Vector3::from(normal);
        if direction.norm() < 1e-9 {
            return Err(WorldError::new("half_space.normal", format!("{normal:?}"), "a direction"));
        }
        Ok(Self::HalfSpace { normal: direction, offset: offset_m })
    }

    /// The outside of a sphere.
    ///
    /// # Errors
    /// `reach.center_m`, `reach.radius_m`.
    pub fn beyond(center_m: [f64; 3], radius_m: f64) -> Result<Self, WorldError> {
        numbers("reach.center_m", &center_m)?;
        Ok(Self::Beyond { center: center_m.into(), radius: positive("reach.radius_m", radius_m)? })
    }

    /// A function of a point that is ≤ 0 exactly where the region, grown by `radius` (≥ 0), is; `None` for hulls,
    /// meshes and words.
    ///
    /// `p` in m in the region's frame. With [`crate::math::outward::Interval`]s a value whose upper bound is < 0 proves
    /// that every point enclosed is inside, one whose lower bound is > 0 that none is; with
    /// [`crate::math::outward::Centred`] forms the bounds close quadratically as the segment is halved.
    ///
    /// In m² for balls, capsules, reach spheres and grown boxes and cylinders, in m (times ‖n‖ for half-spaces)
    /// otherwise: only its sign means anything across regions.
    pub fn formula<N: Real>(&self, p: [N; 3], radius: f64) -> Option<N> {
        let c = N::constant;
        let zero = c(0.0);
        let minus = |p: [N; 3], q: &Point3<f64>| [p[0] - c(q.x), p[1] - c(q.y), p[2] - c(q.z)];
        let square = |v: [N; 3]| v[0].square() + v[1].square() + v[2].square();
        // Two or three excesses over a convex body: its distance, or, where nothing is grown, the largest of them.
        let grown = |excesses: &[N]| {
            if radius > 0.0 {
                let sum = excesses.iter().fold(zero, |sum, e| sum + e.max(zero).square());
                sum - c(radius).square()
            } else {
                excesses.iter().skip(1).fold(excesses[0], |most, e| most.max(*e))
            }
        };
        Some(match self {
            Self::Shape(Shape::Sphere { center, radius: own }) => {
                square(minus(p, center)) - (c(*own) + c(radius)).square()
            }
            Self::Shape(Shape::Box { center, half_extents: h }) => {
                let q = minus(p, center);
                grown(&[q[0].abs() - c(h.x), q[1].abs() - c(h.y), q[2].abs() - c(h.z)])
            }
            Self::Shape(Shape::Capsule { a, b, radius: own }) => {
                let u = [c(b.x) - c(a.x), c(b.y) - c(a.y), c(b.z) - c(a.z)];
                let w = minus(p, a);
                let along = if a == b { zero } else { (w[0] * u[0] + w[1] * u[1] + w[2] * u[2]) / square(u) };
                let s = along.max(zero).min(c(1.0));
                square([w[0] - s * u[0], w[1] - s * u[1], w[2] - s * u[2]]) - (c(*own) + c(radius)).square()
            }
            Self::Cylinder { a, b, radius: own } => {
                let n = [c(b.x) - c(a.x), c(b.y) - c(a.y), c(b.z) - c(a.z)];
                let w = minus(p, a);
                let length = square(n).sqrt();
                let along = (w[0] * n[0] + w[1] * n[1] + w[2] * n[2]) / length;
                let across = [w[1] * n[2] - w[2] * n[1], w[2] * n[0] - w[0] * n[2], w[0] * n[1] - w[1] * n[0]];
                let from_axis = square(across).sqrt() / length;
                grown(&[(-along).max(along - length), from_axis - c(*own)])
            }
            Self::HalfSpace { normal: n, offset } => {
                let length = (c(n.x).square() + c(n.y).square() + c(n.z).square()).sqrt();
                p[0] * c(n.x) + p[1] * c(n.y) + p[2] * c(n.z) - c(*offset) - c(radius) * length
            }
            Self::Beyond { center, radius: own } => (c(*own) - c(radius)).max(zero).square() - square(minus(p, center)),
            Self::Shape(Shape::Hull(_) | Shape::Mesh(_)) | Self::Words(_) => return None,
        })
    }

    /// The support function of the region's core, max n·q over its points q, and the radius of the ball that grows it
    /// to the region: bounds of both. `None` for regions without a core (see [`Region::nearest`]).
    ///
    /// n·x(t) > h(n) + (R + r)‖n‖ at both ends of a segment proves it farther than r from the region, whatever `n` is
    /// and however it was found: the separating plane theorem needs no other premise.
    ///
    /// `n` of any length; the bound is in m times its length, outward rounded.
    pub fn support(&self, n: &Vector3<f64>) -> Option<(Interval, f64)> {
        let i = Interval::point;
        let dot = |p: &Point3<f64>| i(n.x) * i(p.x) + i(n.y) * i(p.y) + i(n.z) * i(p.z);
        Some(match self {
            Self::Shape(Shape::Sphere { center, radius }) => (dot(center), *radius),
            Self::Shape(Shape::Capsule { a, b, radius }) => (dot(a).max(dot(b)), *radius),
            Self::Shape(Shape::Box { center, half_extents: h }) => {
                let half = i(n.x.abs()) * i(h.x) + i(n.y.abs()) * i(h.y) + i(n.z.abs()) * i(h.z);
                (dot(center) + half, 0.0)
            }
            Self::Cylinder { a, b, radius } => {
                let axis = [0, 1, 2].map(|k| i(b[k]) - i(a[k]));
                let across = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| i(n[j]) * axis[k] - i(n[k]) * axis[j]);
                let square = |v: [Interval; 3]| v[0].square() + v[1].square() + v[2].square();
                (dot(a).max(dot(b)) + i(*radius) * (square(across) / square(axis)).sqrt(), 0.0)
            }
            _ => return None,
        })
    }

    /// A box that holds the region; `None` if it has no end.
    ///
    /// Of cylinders the box of the capsule around it, which is larger.
    pub fn bounds(&self) -> Option<Bounds> {
        match self {
            Self::Shape(shape) => Some(shape.bounds()),
            Self::Cylinder { a, b, radius } => Some(Bounds { min: a.inf(b), max: a.sup(b) }.grown(*radius)),
            Self::HalfSpace { .. } | Self::Beyond { .. } | Self::Words(_) => None,
        }
    }
}

fn numbers(field: &str, values: &[f64]) -> Result<(), WorldError> {
    if values.iter().all(|value| value.abs() < LARGEST) {
        return Ok(());
    }
    Err(WorldError::new(field, format!("{values:?}"), format!("numbers between ±{LARGEST}")))
}

fn positive(field: &str, value: f64) -> Result<f64, WorldError> {
    if value > 0.0 && value < LARGEST {
        return Ok(value);
    }
    Err(WorldError::new(field, format!("{value}"), format!("> 0 and < {LARGEST}")))
}
