//! Where a move leads by itself: joints in step, or the tool's point on a line or circle while its orientation runs
//! along a great arc of quaternions.

use nalgebra::{Isometry3, Point3, Quaternion, UnitQuaternion, Vector3};

/// A move over its share, 0 … 1.
#[derive(Debug, Clone)]
pub(super) enum Course {
    /// All joints in step, rad.
    Joints([[f64; 6]; 2]),
    /// The tool.
    Tool(ToolCourse),
}

/// `base_from_tcp` over the share.
///
/// The point runs evenly along line or arc, the orientation evenly about one axis; both over the same share.
#[derive(Debug, Clone)]
pub(super) struct ToolCourse {
    ends: [Isometry3<f64>; 2],
    round: Option<Round>,
}

impl ToolCourse {
    /// `base_from_tcp` at both ends.
    pub(super) fn straight(from: Isometry3<f64>, to: Isometry3<f64>) -> Self {
        Self { ends: [from, to], round: None }
    }

    /// On the arc through a point; `None` where the three lie on a line.
    pub(super) fn arc(from: Isometry3<f64>, via: &Point3<f64>, to: Isometry3<f64>) -> Option<Self> {
        let [a, b] = [from, to].map(|pose| Point3::from(pose.translation.vector));
        Some(Self { ends: [from, to], round: Some(Round::through(&a, via, &b)?) })
    }

    /// `base_from_tcp` at a share of the way, 0 … 1.
    pub(super) fn at(&self, share: f64) -> Isometry3<f64> {
        let [from, to] = &self.ends;
        let (a, b) = (from.translation.vector, to.translation.vector);
        let place = self.round.as_ref().map_or(a * (1.0 - share) + b * share, |round| round.at(share).coords);
        Isometry3::from_parts(place.into(), great_arc(&from.rotation, &to.rotation, share))
    }

    /// Length of the way of the tool's point, m.
    pub(super) fn way(&self) -> f64 {
        self.round.as_ref().map_or_else(|| apart(&self.ends[0], &self.ends[1]).0, Round::length)
    }

    /// How far its orientation turns, rad.
    pub(super) fn turn(&self) -> f64 {
        apart(&self.ends[0], &self.ends[1]).1
    }
}

/// Distance and angle between two poses.
///
/// m, and rad in 0 … π.
pub(super) fn apart(a: &Isometry3<f64>, b: &Isometry3<f64>) -> (f64, f64) {
    let across = a.rotation.conjugate() * b.rotation;
    let angle = 2.0 * libm::atan2(across.imag().norm(), across.w.abs());
    ((a.translation.vector - b.translation.vector).norm(), angle)
}

/// (sin((1 − s)Ω) a + sin(sΩ) b) / sin Ω with Ω between the quaternions, of which the nearer one of ±b is taken.
/// (Shoemake, "Animating rotation with quaternion curves", 1985.)
fn great_arc(a: &UnitQuaternion<f64>, b: &UnitQuaternion<f64>, share: f64) -> UnitQuaternion<f64> {
    /// Nearer quaternions are joined by a line.
    const NEAR: f64 = 1e-9;
    let (a, b) = (a.coords, b.coords);
    let b = if a.dot(&b) < 0.0 { -b } else { b };
    let angle = 2.0 * libm::atan2((b - a).norm(), (b + a).norm());
    let sum = if angle < NEAR {
        a * (1.0 - share) + b * share
    } else {
        a * libm::sin((1.0 - share) * angle) + b * libm::sin(share * angle)
    };
    UnitQuaternion::new_normalize(Quaternion::from(sum))
}

/// A circle by its centre, two axes of its plane of its radius' length, and the angle of an arc of it, rad.
#[derive(Debug, Clone)]
struct Round {
    centre: Point3<f64>,
    axes: [Vector3<f64>; 2],
    angle: f64,
}

impl Round {
    /// The arc from `a` over `via` to `b`; `None` where they lie on a line. With u and w from a to the others and n = u
    /// × w the centre is a + (|w|² n × u + |u|² w × n) / 2|n|²; seen against n, b comes after via.
    fn through(a: &Point3<f64>, via: &Point3<f64>, b: &Point3<f64>) -> Option<Self> {
        let (u, w) = (via - a, b - a);
        let n = u.cross(&w);
        let square = n.norm_squared();
        if square.is_nan() || square <= 1e-12 * u.norm_squared() * w.norm_squared() {
            return None;
        }
        let centre = a + (n.cross(&u) * w.norm_squared() + w.cross(&n) * u.norm_squared()) / (2.0 * square);
        let out = a - centre;
        let aside = n.cross(&out) / n.norm();
        let end = b - centre;
        let angle = libm::atan2(end.dot(&aside), end.dot(&out));
        let angle = if angle > 0.0 { angle } else { angle + std::f64::consts::TAU };
        Some(Self { centre, axes: [out, aside], angle })
    }

    /// c + cos(sα) u + sin(sα) v.
    fn at(&self, share: f64) -> Point3<f64> {
        let angle = share * self.angle;
        self.centre + self.axes[0] * libm::cos(angle) + self.axes[1] * libm::sin(angle)
    }

    /// r α, m.
    fn length(&self) -> f64 {
        self.axes[0].norm() * self.angle
    }
}
