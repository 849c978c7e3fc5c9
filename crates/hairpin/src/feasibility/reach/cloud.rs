//! Points in the lanes of the vector unit, and the scans over all of them that a convex hull is made of.
//!
//! No product is fused with a sum and lanes are always eight: every SIMD level gives the same bits.

use nalgebra::Vector3;

use crate::math::simd::{Simd, kernel};

/// Points per block.
const LANES: usize = 8;

/// Eight points, one row per coordinate.
type Block = [[f64; LANES]; 3];

/// A plane {x : n · x = b} as (nx, ny, nz, b), |n| = 1.
pub(super) type Plane = [f64; 4];

/// n · x − b, m: how far `x` lies beyond `plane`.
#[inline(always)]
pub(super) fn beyond(plane: &Plane, x: &Vector3<f64>) -> f64 {
    plane[0] * x.x + plane[1] * x.y + plane[2] * x.z - plane[3]
}

/// The point farthest beyond a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Farthest {
    /// n · x − b, m; −∞ of no points.
    pub(super) distance: f64,
    /// Its number in the points that the first cloud was made from.
    pub(super) point: u32,
}

/// Some of the points of a set, each known by its number there.
///
/// A structure of arrays: 8 points are three vector loads a plane.
pub(super) struct Cloud {
    /// The last block is filled up with copies of the last point.
    blocks: Vec<Block>,
    numbers: Vec<u32>,
    simd: Simd,
}

impl Cloud {
    /// The points of `all` with these numbers, at least one, to be scanned at the level `simd`.
    pub(super) fn new(simd: Simd, all: &[Vector3<f64>], numbers: Vec<u32>) -> Self {
        assert!(!numbers.is_empty(), "a cloud has at least one point");
        let mut blocks = Vec::with_capacity(numbers.len().div_ceil(LANES));
        for chunk in numbers.chunks(LANES) {
            let mut block = [[0.0; LANES]; 3];
            for lane in 0..LANES {
                let point = &all[chunk[lane.min(chunk.len() - 1)] as usize];
                (block[0][lane], block[1][lane], block[2][lane]) = (point.x, point.y, point.z);
            }
            blocks.push(block);
        }
        Self { blocks, numbers, simd }
    }

    /// Appends to `out`, for every plane, the point that lies farthest beyond it, or any if none lies beyond it by more
    /// than `tolerance`; the first of equals.
    ///
    /// O(planes · points); the point is looked up only where one lies beyond.
    pub(super) fn farthest(&self, planes: &[Plane], tolerance: f64, out: &mut Vec<Farthest>) {
        let first = out.len();
        out.resize(first + planes.len(), Farthest { distance: f64::NEG_INFINITY, point: 0 });
        farthest(self.simd, &self.blocks, planes, tolerance, &mut out[first..]);
        for found in &mut out[first..] {
            found.point = self.numbers[(found.point as usize).min(self.numbers.len() - 1)];
        }
    }

    /// The numbers of the points that lie farther than `tolerance` beyond any of `planes`.
    ///
    /// In rising order. `tolerance` may be negative: then those less deep inside are there as well.
    pub(super) fn outside(&self, planes: &[Plane], tolerance: f64) -> Vec<u32> {
        let mut distances = vec![[0.0; LANES]; self.blocks.len()];
        outermost(self.simd, &self.blocks, planes, &mut distances);
        let outside = distances.iter().flatten().zip(&self.numbers).filter(|(distance, _)| **distance > tolerance);
        outside.map(|(_, number)| *number).collect()
    }

    /// For every plane the least and the greatest n · x over the points.
    pub(super) fn spans(&self, planes: &[Plane]) -> Vec<(f64, f64)> {
        let mut spans = vec![(0.0, 0.0); planes.len()];
        spans_of(self.simd, &self.blocks, planes, &mut spans);
        spans
    }
}

/// n · x − b for eight points.
#[inline(always)]
fn distances(&[nx, ny, nz, b]: &Plane, [x, y, z]: &Block) -> [f64; LANES] {
    let mut distances = [0.0; LANES];
    for lane in 0..LANES {
        distances[lane] = nx * x[lane] + ny * y[lane] + nz * z[lane] - b;
    }
    distances
}

/// Lane by lane the greater.
#[inline(always)]
fn greater(a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
    let mut greater = [0.0; LANES];
    for lane in 0..LANES {
        greater[lane] = if b[lane] > a[lane] { b[lane] } else { a[lane] };
    }
    greater
}

kernel! {
    fn farthest(blocks: &[Block], planes: &[Plane], tolerance: f64, out: &mut [Farthest]) {
        for (plane, found) in planes.iter().zip(out) {
            let mut best = [f64::NEG_INFINITY; LANES];
            for block in blocks {
                best = greater(best, distances(plane, block));
            }
            found.distance = best.into_iter().fold(f64::NEG_INFINITY, f64::max);
            if found.distance > tolerance {
                // Which one it was is seldom asked, and carried along it would halve the speed.
                for (number, block) in blocks.iter().enumerate() {
                    let distances = distances(plane, block);
                    let any = distances.iter().fold(false, |any, distance| any | (*distance == found.distance));
                    if any {
                        let lane = distances.iter().position(|distance| *distance == found.distance).unwrap_or(0);
                        found.point = (number * LANES + lane) as u32;
                        break;
                    }
                }
            }
        }
    }
}

kernel! {
    fn outermost(blocks: &[Block], planes: &[Plane], out: &mut [[f64; LANES]]) {
        for (block, outermost) in blocks.iter().zip(out) {
            let mut best = [f64::NEG_INFINITY; LANES];
            for plane in planes {
                best = greater(best, distances(plane, block));
            }
            *outermost = best;
        }
    }
}

kernel! {
    fn spans_of(blocks: &[Block], planes: &[Plane], out: &mut [(f64, f64)]) {
        for (&[nx, ny, nz, _], span) in planes.iter().zip(out) {
            // The least is the greatest against the direction: one and the same kind of lane.
            let (mut low, mut high) = ([f64::NEG_INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
            for block in blocks {
                high = greater(high, distances(&[nx, ny, nz, 0.0], block));
            }
            for block in blocks {
                low = greater(low, distances(&[-nx, -ny, -nz, 0.0], block));
            }
            let most = |lanes: [f64; LANES]| lanes.into_iter().fold(f64::NEG_INFINITY, f64::max);
            *span = (-most(low), most(high));
        }
    }
}
