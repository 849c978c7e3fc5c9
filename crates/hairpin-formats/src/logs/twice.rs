//! Two samples of one stamp: the same one again, as loggers write it, or two places at one moment, of which nobody
//! knows which is the true one.

use nalgebra::Point3;

/// Numbers that differ by less, or by less than this share of themselves, are the same: what single precision leaves.
const ROUNDED: f64 = 1e-6;

/// Whether two numbers are none of them the other one rounded, and how far they are apart.
pub(super) fn apart(one: f64, other: f64) -> Option<f64> {
    let far = (one - other).abs();
    (far > ROUNDED * one.abs().max(other.abs()).max(1.0)).then_some(far)
}

/// How far apart two places are, m, where they are not the same one.
pub(super) fn places_apart(one: &Point3<f64>, other: &Point3<f64>) -> Option<f64> {
    let differ = (0..3).any(|axis| apart(one[axis], other[axis]).is_some());
    differ.then(|| (one - other).norm())
}

/// A number as it is told: six decimals at most.
pub(super) fn told(value: f64) -> String {
    ((value * 1e6).round() / 1e6 + 0.0).to_string()
}

/// Why a motion with two places at one moment is not to be judged by.
pub(super) fn two_places(t_s: f64, one: &Point3<f64>, other: &Point3<f64>) -> String {
    let place = |p: &Point3<f64>| format!("({}, {}, {}) m", told(p.x), told(p.y), told(p.z));
    two(t_s, "places", &place(one), &place(other))
}

/// Why what has two values of something at one moment is not to be judged by.
pub(super) fn two(t_s: f64, what: &str, one: &str, other: &str) -> String {
    format!("two {what} with the stamp {t_s} s, {one} and {other}: nobody knows which is true")
}
