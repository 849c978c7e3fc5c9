//! A float filter with derived error bounds: of one point against all others, which segments are proven clear of a
//! region, and which are proven to meet it. What it leaves open is left to interval arithmetic.
//!
//! Coordinates are taken relative to the region's centre, so that they are known up to η; M bounds them and the
//! region's sizes. With unit round-off u = 2⁻⁵³ every polynomial below has an error bound c·u·Mᵏ whose constant is
//! derived in docs/arms.md and rounded up to a power of two. A comparison that holds with that bound holds in the real
//! numbers.
//!
//! Each test is a sufficient condition with its error bound on the safe side, so that a lane says clear, met or
//! neither. No lane branches.

// NaN of 0/0 must become a bound here, not stay NaN.
#![allow(clippy::manual_clamp)]

use nalgebra::{Matrix3, Point3, Vector3};

use crate::math::outward::Interval;
use crate::math::simd::{Simd, kernel};
use crate::world::Shape;
use crate::world::cell::Region;

/// Unit round-off.
const U: f64 = 0.5 * f64::EPSILON;
/// Products of subnormal numbers have no relative error; no bound is less than this.
const TINY: f64 = 1e-290;

/// What the filter says of a segment.
pub(super) const OPEN: u64 = 0;
/// Proven clear.
///
/// One bit, so that lanes are or-ed.
pub(super) const CLEAR: u64 = 1;
/// Proven to meet the region.
pub(super) const HIT: u64 = 2;

/// The points relative to a region, one coordinate after the other.
pub(super) struct Filter {
    /// Lengths in m, in the region's own axes.
    kind: RegionKind,
    /// x, y, z relative to the region's centre, m; of half-spaces lower bounds, upper bounds and zeros.
    coordinates: [Vec<f64>; 3],
    scale: Scale,
}

/// What the error bounds are made of.
#[derive(Debug, Clone, Copy)]
struct Scale {
    /// Largest coordinate or size.
    ///
    /// M, m.
    m: f64,
    /// Error of a coordinate.
    ///
    /// η, m: rounding of the difference from the centre, and of the turn where there is one.
    eta: f64,
}

#[derive(Debug, Clone, Copy)]
enum RegionKind {
    /// Radius, grown.
    Ball(f64),
    /// Half extents, and by how much they grow.
    Box([f64; 3], f64),
    /// Radius and half length along z, and by how much they grow.
    Cylinder(f64, f64, f64),
    /// Points must stay within this radius.
    Beyond(f64),
    /// Coordinates are bounds of the height over a grown half-space, lower and upper.
    Heights,
    /// Half extents of a box that holds the region, already grown.
    Around([f64; 3]),
}

impl Filter {
    /// Prepares `points` against a region grown by `radius`; `None` for regions without a filter.
    ///
    /// Without one: words, regions without bounds, and points so far from the region that their coordinates lose 10⁻⁹
    /// of it.
    pub(super) fn new(region: &Region, points: &[Point3<f64>], radius: f64) -> Option<Self> {
        if let Region::HalfSpace { .. } = region {
            return heights(region, points, radius);
        }
        let no_turn = Matrix3::identity();
        let (centre, turn, kind) = match region {
            Region::Shape(Shape::Sphere { center, radius: own }) => (*center, no_turn, RegionKind::Ball(own + radius)),
            Region::Shape(Shape::Box { center, half_extents }) => {
                (*center, no_turn, RegionKind::Box((*half_extents).into(), radius))
            }
            Region::Beyond { center, radius: own } => (*center, no_turn, RegionKind::Beyond(own - radius)),
            Region::Cylinder { a, b, radius: own } => {
                let axis = b - a;
                (nalgebra::center(a, b), upright(&axis), RegionKind::Cylinder(*own, 0.5 * axis.norm(), radius))
            }
            region => {
                let bounds = region.bounds()?;
                // Outward by far more than its rounding.
                let half = (bounds.max - bounds.min) * (0.5 * (1.0 + 1e-12));
                let grown = half.map(|h| (h + radius) * (1.0 + 1e-12) + 1e-12);
                (nalgebra::center(&bounds.min, &bounds.max), no_turn, RegionKind::Around(grown.into()))
            }
        };
        let turned = turn != no_turn;
        let relative: Vec<Vector3<f64>> = points.iter().map(|p| turn * (p - centre)).collect();
        let sizes = match kind {
            RegionKind::Ball(r) | RegionKind::Beyond(r) => r,
            RegionKind::Box(h, r) => h.into_iter().fold(0.0, f64::max) + r,
            RegionKind::Cylinder(own, half, r) => own.max(half) + r,
            RegionKind::Around(h) => h.into_iter().fold(0.0, f64::max),
            RegionKind::Heights => 0.0,
        };
        let centred = centre.coords.amax();
        let m = relative.iter().map(|v| v.amax()).fold(sizes, f64::max).max(f64::MIN_POSITIVE) * (1.0 + 1e-12);
        // The centre itself is rounded, and a turn rounds every product of three.
        let eta = if turned { 64.0 * U * (m + centred) } else { 4.0 * U * (m + centred) };
        if eta > 1e-9 * m {
            // So far from the origin that the bounds below would not be small.
            return None;
        }
        let coordinates = [0, 1, 2].map(|k| relative.iter().map(|v| v[k]).collect());
        Some(Self { kind, coordinates, scale: Scale { m, eta } })
    }

    /// Judges the segments from point `i` to the points from `i + 1` on.
    ///
    /// `out` has one entry for each point behind `i`: [`OPEN`], [`CLEAR`] or [`HIT`]. The same bits at every level of
    /// SIMD.
    ///
    /// Cost: some tens of operations a segment, in lanes.
    pub(super) fn row(&self, simd: Simd, i: usize, out: &mut [u64]) {
        let [xs, ys, zs] = &self.coordinates;
        let from = [xs[i], ys[i], zs[i]];
        let points = [&xs[i + 1..], &ys[i + 1..], &zs[i + 1..]];
        let scale = self.scale;
        match self.kind {
            RegionKind::Ball(r) => ball(simd, from, r, scale, points, out),
            RegionKind::Beyond(r) => beyond(simd, from, r, scale, points, out),
            RegionKind::Box(half, r) => cuboid(simd, from, half, r, scale, points, out),
            RegionKind::Cylinder(own, half, r) => cylinder(simd, from, [own, half, r], scale, points, out),
            RegionKind::Heights => {
                let [low, high, _] = points;
                for ((low, high), out) in low.iter().zip(high).zip(out) {
                    // Heights are linear along the segment.
                    let clear = (from[0] > 0.0) & (*low > 0.0);
                    *out = u64::from(clear) | (u64::from((from[1] <= 0.0) | (*high <= 0.0)) << 1);
                }
            }
            RegionKind::Around(half) => around(simd, from, half, scale, points, out),
        }
    }
}

/// Heights of all points over a half-space, in intervals: no more than that is needed.
///
/// A half-space is met if either end is: heights are linear, so that nothing between the ends counts.
fn heights(region: &Region, points: &[Point3<f64>], radius: f64) -> Option<Filter> {
    let height = |p: &Point3<f64>| region.formula([p.x, p.y, p.z].map(Interval::point), radius);
    let all: Vec<Interval> = points.iter().map(height).collect::<Option<_>>()?;
    let coordinates = [all.iter().map(|h| h.low).collect(), all.iter().map(|h| h.high).collect(), vec![0.0; all.len()]];
    Some(Filter { kind: RegionKind::Heights, coordinates, scale: Scale { m: 0.0, eta: 0.0 } })
}

/// A rotation that turns `axis` into z; along a coordinate axis without rounding.
///
/// Rows are the new axes in the old frame, orthonormal to rounding, which η counts.
fn upright(axis: &Vector3<f64>) -> Matrix3<f64> {
    let longest = axis.iamax();
    let z = axis.normalize();
    // Cyclic neighbours of the longest component are never parallel to it.
    let mut other = Vector3::zeros();
    other[(longest + 1) % 3] = 1.0;
    let x = (other - z * z.dot(&other)).normalize();
    let y = z.cross(&x);
    Matrix3::from_rows(&[x.transpose(), y.transpose(), z.transpose()])
}

/// Error bounds of squares of lengths (degree 2) and of the determinant (degree 4); with coordinates known up to η, η ≥
/// 4u M.
impl Scale {
    /// Of a sum of three products of coordinates or differences: 36 M η + 64 u M² ≤ 64 M η.
    ///
    /// Degree 2; the unit is m².
    fn square(self) -> f64 {
        64.0 * self.m * self.eta + TINY
    }
    /// Of (|u|² − r²)|d|² − (u·d)²: 288 M³η + 1100 u M⁴ ≤ 1024 M³ η.
    ///
    /// Degree 4; m⁴.
    fn determinant(self) -> f64 {
        1024.0 * self.m * self.m * self.m * self.eta + TINY
    }
}

kernel! {
    /// Bit 0, clear: both ends outside of the ball and the line's nearest point not between them, b > 0 or c < 0, or
    /// the whole line outside, (a − r²)d − b² > 0, with a = |u|², b = u·(v − u), c = v·(v − u), d = |v − u|², each
    /// beyond its error bound. Bit 1, met: the segment's nearest point, computed however roughly, lies inside beyond
    /// the bound.
    ///
    /// `r` is the radius grown by the tool's. Clear of three ways in which a segment passes a ball: it moves away from
    /// its first end on, comes nearer up to its last one, or has its nearest point between and outside.
    fn ball(from: [f64; 3], r: f64, scale: Scale, points: [&[f64]; 3], out: &mut [u64]) {
        let [xs, ys, zs] = points;
        let (e2, e4, rr) = (scale.square(), scale.determinant(), r * r);
        let [ux, uy, uz] = from;
        let a = ux * ux + uy * uy + uz * uz;
        let first = a > rr + e2;
        for (((x, y), z), out) in xs.iter().zip(ys).zip(zs).zip(out) {
            let (dx, dy, dz) = (x - ux, y - uy, z - uz);
            let (b, d) = (ux * dx + uy * dy + uz * dz, dx * dx + dy * dy + dz * dz);
            let c = x * dx + y * dy + z * dz;
            let last = x * x + y * y + z * z > rr + e2;
            // Moving away at the first end, or still coming nearer at the last one, or the whole line is clear.
            let passes = (b > e2) | (c < -e2) | ((a - rr) * d - b * b > e4);
            let t = (-b / d).max(0.0).min(1.0);
            let (px, py, pz) = (ux + t * dx, uy + t * dy, uz + t * dz);
            let hit = px * px + py * py + pz * pz < rr - e2;
            *out = u64::from(first & last & passes) | (u64::from(hit) << 1);
        }
    }
}

kernel! {
    fn beyond(from: [f64; 3], r: f64, scale: Scale, points: [&[f64]; 3], out: &mut [u64]) {
        let [xs, ys, zs] = points;
        let (e2, rr) = (scale.square(), if r > 0.0 { r * r } else { 0.0 });
        let [ux, uy, uz] = from;
        let a = ux * ux + uy * uy + uz * uz;
        for (((x, y), z), out) in xs.iter().zip(ys).zip(zs).zip(out) {
            let far = x * x + y * y + z * z;
            // A ball is convex: both ends inside, or one outside.
            let (inside, outside) = ((a < rr - e2) & (far < rr - e2), (a > rr + e2) | (far > rr + e2));
            *out = u64::from(inside) | (u64::from(outside) << 1);
        }
    }
}

/// Whether axes separate the segment from the box ±h: three of the faces, three across an edge and the segment.
macro_rules! separated {
    ($u:expr, $p:expr, $h:expr, $e1:expr, $e2:expr) => {{
        let ([ux, uy, uz], [x, y, z], [hx, hy, hz]) = ($u, $p, $h);
        let (mx, my, mz) = (0.5 * (ux + x), 0.5 * (uy + y), 0.5 * (uz + z));
        let (sx, sy, sz) = (0.5 * (x - ux), 0.5 * (y - uy), 0.5 * (z - uz));
        let (ax, ay, az) = (sx.abs(), sy.abs(), sz.abs());
        (mx.abs() - ax > hx + $e1)
            | (my.abs() - ay > hy + $e1)
            | (mz.abs() - az > hz + $e1)
            | ((my * sz - mz * sy).abs() - (hy * az + hz * ay) > $e2)
            | ((mz * sx - mx * sz).abs() - (hz * ax + hx * az) > $e2)
            | ((mx * sy - my * sx).abs() - (hx * ay + hy * ax) > $e2)
    }};
}

kernel! {
    fn around(from: [f64; 3], half: [f64; 3], scale: Scale, points: [&[f64]; 3], out: &mut [u64]) {
        let [xs, ys, zs] = points;
        let (e1, e2) = (16.0 * scale.eta, scale.square());
        for (((x, y), z), out) in xs.iter().zip(ys).zip(zs).zip(out) {
            *out = u64::from(separated!(from, [*x, *y, *z], half, e1, e2));
        }
    }
}

kernel! {
    /// Bit 0 by separating axes of the box grown by r (an outer bound of the rounded box: nothing near its edges is
    /// proven clear by this test). Bit 1 by a witness: the middle of what the grown box's slabs leave of the segment,
    /// inside of the box or closer than r to it.
    fn cuboid(from: [f64; 3], half: [f64; 3], r: f64, scale: Scale, points: [&[f64]; 3], out: &mut [u64]) {
        let [xs, ys, zs] = points;
        let (e1, e2, rr) = (16.0 * scale.eta, scale.square(), r * r);
        let grown = [half[0] + r, half[1] + r, half[2] + r];
        let [ux, uy, uz] = from;
        for (((x, y), z), out) in xs.iter().zip(ys).zip(zs).zip(out) {
            let clear = separated!(from, [*x, *y, *z], grown, e1, e2);
            let (dx, dy, dz) = (x - ux, y - uy, z - uz);
            // The middle of what the grown box's slabs leave of the segment; any t is as good a witness.
            let (ix, iy, iz) = (1.0 / dx, 1.0 / dy, 1.0 / dz);
            let (rx, ry, rz) = ((grown[0] * ix).abs(), (grown[1] * iy).abs(), (grown[2] * iz).abs());
            let low = (-ux * ix - rx).max(-uy * iy - ry).max(-uz * iz - rz).max(0.0);
            let high = (-ux * ix + rx).min(-uy * iy + ry).min(-uz * iz + rz).min(1.0);
            let t = (0.5 * (low + high)).max(0.0).min(1.0);
            let (px, py, pz) = ((ux + t * dx).abs() - half[0], (uy + t * dy).abs() - half[1], (uz + t * dz).abs() - half[2]);
            let inside = (px < -e1) & (py < -e1) & (pz < -e1);
            let (qx, qy, qz) = (px.max(0.0), py.max(0.0), pz.max(0.0));
            let near = qx * qx + qy * qy + qz * qz < rr - e2;
            *out = u64::from(clear) | (u64::from(inside | near) << 1);
        }
    }
}

kernel! {
    /// Bit 0: beyond a disc at both ends, past the shell in the plane as [`ball`] has it, or, between the discs,
    /// nowhere closer to the axis than the radius. Bit 1 by a witness in the middle of what discs and shell leave,
    /// inside of the shell grown by r below the disc's height, or of the shell itself below the height grown by r.
    ///
    /// `sizes` are the cylinder's radius, half length and the tool's radius. With r > 0 the grown rim is round, and
    /// what lies only in the corner between shell and disc is left open.
    fn cylinder(from: [f64; 3], sizes: [f64; 3], scale: Scale, points: [&[f64]; 3], out: &mut [u64]) {
        let [xs, ys, zs] = points;
        let Scale { m, eta } = scale;
        let [own, half, r] = sizes;
        let (e1, e2, e4) = (16.0 * eta, scale.square(), scale.determinant());
        let (radius, height) = (own + r, half + r);
        let (rr, inner) = (radius * radius, own * own);
        let (slight, short) = (m * m / 1048576.0, m / 1048576.0);
        let [ux, uy, uz] = from;
        let a = ux * ux + uy * uy;
        let first = a > rr + e2;
        for (((x, y), z), out) in xs.iter().zip(ys).zip(zs).zip(out) {
            let (dx, dy, dz) = (x - ux, y - uy, z - uz);
            let apart = (uz.min(*z) > height + e1) | (uz.max(*z) < -height - e1);
            let (b, d) = (ux * dx + uy * dy, dx * dx + dy * dy);
            let c = x * dx + y * dy;
            let last = x * x + y * y > rr + e2;
            let passes = (b > e2) | (c < -e2) | ((a - rr) * d - b * b > e4);
            // The part of the segment between the discs, and where it is nearest to the axis.
            let inverse = 1.0 / dz;
            let (t0, t1) = ((-height - uz) * inverse, (height - uz) * inverse);
            let (low, high) = (t0.min(t1).max(0.0).min(1.0), t0.max(t1).max(0.0).min(1.0));
            let t = (-b / d).max(low).min(high);
            let (px, py) = (ux + t * dx, uy + t * dy);
            let f = px * px + py * py;
            let slack = 8.0 * m * m * (8.0 * eta * inverse.abs() + 8.0 * U) + 4.0 * e2;
            let clipped = (d > slight) & (dz.abs() > short) & (f > rr + slack);
            let clear = apart | (first & last & passes) | clipped;
            // The middle of what discs and shell leave of the segment; any t is as good a witness.
            let root = (b * b - (a - rr) * d).max(0.0).sqrt();
            let (enter, leave) = (((-b - root) / d).max(low), ((root - b) / d).min(high));
            let t = (0.5 * (enter + leave)).max(0.0).min(1.0);
            let (px, py, level) = (ux + t * dx, uy + t * dy, (uz + t * dz).abs());
            let f = px * px + py * py;
            let hit = ((f < rr - e2) & (level < half - e1)) | ((f < inner - e2) & (level < height - e1));
            *out = u64::from(clear) | (u64::from(hit) << 1);
        }
    }
}
