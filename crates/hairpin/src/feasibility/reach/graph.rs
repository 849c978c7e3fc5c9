//! A graph's waypoints, and the box test over all of them at once.
//!
//! Single precision with a margin for its rounding: the box test may keep a point that is outside by a rounding, never
//! lose one.

use nalgebra::{Point3, Vector3};

use crate::math::simd::{Simd, kernel};

/// Waypoints per word of the box test's answer.
pub(super) const WORD: usize = 64;

/// Waypoints, exact and again rounded to single precision in whole words, one row per coordinate; the last word is
/// filled up with points that are in no box.
#[derive(Debug, Clone)]
pub(super) struct Graph {
    points: Vec<Vector3<f64>>,
    words: Vec<[[f32; WORD]; 3]>,
    /// More than single precision can lose of a coordinate, m.
    margin: f64,
}

/// The largest relative error of four roundings to single precision.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

impl Graph {
    /// m; waypoints are finite.
    pub(super) fn new(points: &[Point3<f64>]) -> Self {
        let mut words = vec![[[f32::NAN; WORD]; 3]; points.len().div_ceil(WORD)];
        let mut farthest: f64 = 0.0;
        for (i, point) in points.iter().enumerate() {
            for axis in 0..3 {
                words[i / WORD][axis][i % WORD] = point[axis] as f32;
                farthest = farthest.max(point[axis].abs());
            }
        }
        // Below the smallest normal number rounding is no longer relative.
        let margin = ROUNDING * farthest + f64::from(f32::MIN_POSITIVE);
        Self { points: points.iter().map(|point| point.coords).collect(), words, margin }
    }

    /// Exact, in the order of their indices.
    pub(super) fn points(&self) -> &[Vector3<f64>] {
        &self.points
    }

    /// Words of 64 waypoints.
    pub(super) fn words(&self) -> usize {
        self.words.len()
    }

    /// Exact, m.
    #[inline]
    pub(super) fn point(&self, index: u32) -> Vector3<f64> {
        self.points[index as usize]
    }

    /// Sets bit i of `bits` for every waypoint i, from word `first` on, in the box; also for some that are a rounding
    /// to single precision outside of it. Clears the others.
    #[inline]
    pub(super) fn near_box(&self, simd: Simd, min: &Vector3<f64>, max: &Vector3<f64>, first: usize, bits: &mut [u64]) {
        let outward = |c: f64| ROUNDING * c.abs() + self.margin;
        let low = [0, 1, 2].map(|i| (min[i] - outward(min[i])) as f32);
        let high = [0, 1, 2].map(|i| (max[i] + outward(max[i])) as f32);
        in_box(simd, &self.words[first..first + bits.len()], low, high, bits);
    }
}

kernel! {
    fn in_box(words: &[[[f32; WORD]; 3]], min: [f32; 3], max: [f32; 3], bits: &mut [u64]) {
        for ([x, y, z], bits) in words.iter().zip(bits) {
            let mut found = 0;
            for i in 0..WORD {
                let inside = (x[i] >= min[0])
                    & (x[i] <= max[0])
                    & (y[i] >= min[1])
                    & (y[i] <= max[1])
                    & (z[i] >= min[2])
                    & (z[i] <= max[2]);
                found |= u64::from(inside) << i;
            }
            *bits = found;
        }
    }
}
