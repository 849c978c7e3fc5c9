//! Solids of plain numbers that paths are held away from: how far a place is from one, and in which direction.
//!
//! Of a surface of triangles each triangle is a solid without an inside of its own; what lies within the surface is
//! told by how often it winds around ([`winds_around`]).

/// A solid.
///
/// Convex; a box along the axes of the world. Numbers that are none make every path too near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ClearSolid {
    /// A ball: centre and radius, m.
    Ball([f64; 3], f64),
    /// A box along the axes: centre and edge lengths, m.
    Box([f64; 3], [f64; 3]),
    /// All that is near a segment: both its ends and the radius, m.
    Capsule([f64; 3], [f64; 3], f64),
    /// A triangle: its corners, m. Nothing is inside of it.
    Triangle([[f64; 3]; 3]),
}

impl ClearSolid {
    /// Whether all of its numbers are numbers.
    pub(super) fn is_finite(&self) -> bool {
        let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite());
        match self {
            Self::Ball(centre, radius) => finite(centre) && radius.is_finite(),
            Self::Box(centre, size) => finite(centre) && finite(size),
            Self::Capsule(a, b, radius) => finite(a) && finite(b) && radius.is_finite(),
            Self::Triangle(corners) => corners.iter().all(|corner| finite(corner)),
        }
    }

    /// Distance of `p`, m; negative inside.
    pub(super) fn distance(&self, p: &[f64; 3]) -> f64 {
        match self {
            Self::Ball(_, radius) | Self::Capsule(_, _, radius) => norm(self.from(p)) - radius,
            Self::Triangle(_) => norm(self.from(p)),
            Self::Box(centre, size) => {
                let beyond: [f64; 3] = std::array::from_fn(|i| (p[i] - centre[i]).abs() - 0.5 * size[i]);
                norm(beyond.map(|x| x.max(0.0))) + beyond.into_iter().fold(f64::NEG_INFINITY, f64::max).min(0.0)
            }
        }
    }

    /// Unit vector from the nearest point to `p`; `None` inside.
    pub(super) fn away(&self, p: &[f64; 3]) -> Option<[f64; 3]> {
        let from = self.from(p);
        let length = norm(from);
        (self.distance(p) > 0.0 && length > 0.0).then(|| from.map(|x| x / length))
    }

    /// To `p` from the nearest point: of the middle of balls and of the axis of capsules.
    fn from(&self, p: &[f64; 3]) -> [f64; 3] {
        match self {
            Self::Ball(centre, _) => minus(*p, *centre),
            Self::Box(centre, size) => std::array::from_fn(|i| {
                let (from, half) = (p[i] - centre[i], 0.5 * size[i]);
                from - from.min(half).max(-half)
            }),
            Self::Capsule(a, b, _) => from_segment(p, a, b),
            Self::Triangle(corners) => from_triangle(p, corners),
        }
    }
}

/// To `p` from the nearest point of the segment a–b.
fn from_segment(p: &[f64; 3], a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    let (along, from) = (minus(*b, *a), minus(*p, *a));
    let square = dot(along, along);
    let share = if square > 0.0 { (dot(from, along) / square).clamp(0.0, 1.0) } else { 0.0 };
    std::array::from_fn(|i| from[i] - share * along[i])
}

/// To `p` from the nearest point of a triangle: above or below its inside along the normal, else from an edge.
fn from_triangle(p: &[f64; 3], corners: &[[f64; 3]; 3]) -> [f64; 3] {
    let [a, b, c] = *corners;
    let normal = cross(minus(b, a), minus(c, a));
    let square = dot(normal, normal);
    let edges = [(a, b), (b, c), (c, a)];
    let within = |(from, to): (&[f64; 3], &[f64; 3])| dot(cross(minus(*to, *from), minus(*p, *from)), normal) >= 0.0;
    if square > 0.0 && edges.iter().all(|(from, to)| within((from, to))) {
        let height = dot(minus(*p, a), normal) / square;
        return normal.map(|x| x * height);
    }
    let [first, second, third] = edges.map(|(from, to)| from_segment(p, &from, &to));
    [second, third]
        .into_iter()
        .fold(first, |near, other| if dot(other, other) < dot(near, near) { other } else { near })
}

/// How often a closed surface of `triangles` winds around `p`: ±1 inside, 0 outside.
///
/// Σ Ω/4π with tan(Ω/2) = r₁·(r₂×r₃)/(|r₁||r₂||r₃| + (r₁·r₂)|r₃| + (r₂·r₃)|r₁| + (r₃·r₁)|r₂|). Source: van Oosterom and
/// Strackee, The solid angle of a plane triangle, IEEE Transactions on Biomedical Engineering 30(2), 1983.
pub(super) fn winds_around(triangles: &[[[f64; 3]; 3]], p: &[f64; 3]) -> f64 {
    let angle = |corners: &[[f64; 3]; 3]| {
        let [a, b, c] = corners.map(|corner| minus(corner, *p));
        let [la, lb, lc] = [a, b, c].map(norm);
        let volume = dot(a, cross(b, c));
        2.0 * libm::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
    };
    triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// √(v·v).
pub(super) fn norm(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    /// The nearest of many points of the solid, which is none nearer than the nearest.
    #[test]
    fn the_nearest_of_many_points_is_as_near() {
        let corners = [[1.0, 0.0, 0.2], [0.0, 2.0, -0.3], [-1.0, -0.5, 1.0]];
        let (a, b) = (corners[0], corners[1]);
        let steps = 400;
        for p in [[0.1, 0.6, 2.0], [3.0, 0.1, 0.0], [-2.0, -2.0, 2.0], [0.4, 1.9, 0.4], [0.0, 0.5, -3.0]] {
            let (mut triangle, mut segment) = (f64::INFINITY, f64::INFINITY);
            for i in 0..=steps {
                let u = f64::from(i) / f64::from(steps);
                segment = segment.min(norm(minus(p, std::array::from_fn(|k| a[k] + u * (b[k] - a[k])))));
                for j in 0..=steps - i {
                    let v = f64::from(j) / f64::from(steps);
                    let q =
                        std::array::from_fn(|k| (1.0 - u - v) * corners[0][k] + u * corners[1][k] + v * corners[2][k]);
                    triangle = triangle.min(norm(minus(p, q)));
                }
            }
            let found = ClearSolid::Triangle(corners).distance(&p);
            assert!(found <= triangle + 1e-12 && found > triangle - 1e-4, "{p:?}: {found} {triangle}");
            let found = ClearSolid::Capsule(a, b, 0.25).distance(&p) + 0.25;
            assert!(found <= segment + 1e-12 && found > segment - 1e-4, "{p:?}: {found} {segment}");
        }
    }

    #[test]
    fn a_tetrahedron_winds_around_what_is_inside() {
        let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let faces = [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
        assert!((winds_around(&faces, &[0.2, 0.2, 0.2]) - 1.0).abs() < 1e-12);
        assert!(winds_around(&faces, &[0.4, 0.4, 0.4]).abs() < 1e-12);
        assert!(winds_around(&faces, &[-3.0, 0.1, 0.1]).abs() < 1e-12);
    }
}
