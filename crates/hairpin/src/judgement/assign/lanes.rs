//! Pieces of a path side by side, so that one instruction compares several of them with a sample.

use std::ops::Range;

use nalgebra::Point3;

use super::piece::Piece;
use crate::math::simd::{Simd, kernel};

/// Pieces as columns: from where, which way, and the square of its length.
#[derive(Debug)]
pub(super) struct Lanes {
    from: [Vec<f64>; 3],
    way: [Vec<f64>; 3],
    square: Vec<f64>,
}

impl Lanes {
    pub(super) fn of(pieces: &[Piece]) -> Self {
        let ways = || pieces.iter().map(|piece| piece.to - piece.from);
        Self {
            from: std::array::from_fn(|axis| pieces.iter().map(|piece| piece.from[axis]).collect()),
            way: std::array::from_fn(|axis| ways().map(|way| way[axis]).collect()),
            square: ways().map(|way| way.norm_squared()).collect(),
        }
    }

    /// distance² of `p` to each piece of `window`, m², to the bits of what
    /// [`point_distance`](crate::math::segment::point_distance) has, squared.
    pub(super) fn squares(&self, simd: Simd, p: &Point3<f64>, window: Range<usize>, out: &mut [f64]) {
        let from = self.from.each_ref().map(|column| &column[window.clone()]);
        let way = self.way.each_ref().map(|column| &column[window.clone()]);
        squares(simd, [p.x, p.y, p.z], from, way, &self.square[window], out);
    }
}

kernel! {
    fn squares(p: [f64; 3], from: [&[f64]; 3], way: [&[f64]; 3], length: &[f64], out: &mut [f64]) {
        let count = out.len();
        let [[fx, fy, fz], [wx, wy, wz]] = [from, way].map(|columns| columns.map(|column| &column[..count]));
        let length = &length[..count];
        for i in 0..count {
            let dot = (p[0] - fx[i]) * wx[i] + (p[1] - fy[i]) * wy[i] + (p[2] - fz[i]) * wz[i];
            // A piece without a length is where it begins.
            let share = if length[i] > 0.0 { (dot / length[i]).clamp(0.0, 1.0) } else { 0.0 };
            let x = p[0] - (fx[i] + wx[i] * share);
            let y = p[1] - (fy[i] + wy[i] * share);
            let z = p[2] - (fz[i] + wz[i] * share);
            let distance = (x * x + y * y + z * z).sqrt();
            out[i] = distance * distance;
        }
    }
}
