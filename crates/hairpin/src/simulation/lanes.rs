//! Vectors in SIMD lanes: three components and a spare fourth, so that a tick needs half the instructions.

use nalgebra::{Vector3, Vector4};
use wide::f64x4;

/// (x, y, z, 0).
#[inline(always)]
pub(super) fn lanes(v: &Vector3<f64>) -> f64x4 {
    f64x4::new([v.x, v.y, v.z, 0.0])
}

/// The four components.
#[inline(always)]
pub(super) fn lanes4(v: &Vector4<f64>) -> f64x4 {
    f64x4::new([v.x, v.y, v.z, v.w])
}

/// (x, y, z).
#[inline(always)]
pub(super) fn vector(v: f64x4) -> Vector3<f64> {
    let [x, y, z, _] = v.to_array();
    Vector3::new(x, y, z)
}

/// The first three.
#[inline(always)]
pub(super) fn norm_squared(v: f64x4) -> f64 {
    let [x, y, z, _] = (v * v).to_array();
    x + y + z
}

/// The products (yz, zx, xy, 0) that couple body rates.
#[inline(always)]
pub(super) fn coupled(v: f64x4) -> f64x4 {
    let [x, y, z, _] = v.to_array();
    f64x4::new([y, z, x, 0.0]) * f64x4::new([z, x, y, 0.0])
}

/// A matrix, by its columns, times a vector.
#[inline(always)]
pub(super) fn transform(columns: &[f64x4; 4], v: f64x4) -> f64x4 {
    let [a, b, c, d] = v.to_array();
    (columns[0] * a + columns[1] * b) + (columns[2] * c + columns[3] * d)
}
