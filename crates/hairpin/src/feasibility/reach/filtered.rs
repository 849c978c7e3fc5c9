//! Obstacles and other limits of single legs, as a filter around any reach set.

use nalgebra::Point3;

use super::{Leg, Reach};

/// The legs of `inner` for which `keep(from waypoint's leg)` holds. What is dear to judge (segments against obstacles)
/// is to be judged once per pair of waypoints and looked up: see [`PairMask`].
#[derive(Debug, Clone)]
pub struct Filtered<R, F> {
    /// The reach set.
    pub inner: R,
    /// Whether a leg stays.
    pub keep: F,
}

impl<N, R: Reach<N>, F: Fn(&N, &Leg<N>) -> bool> Reach<N> for Filtered<R, F> {
    fn legs(&self, from: &N, candidates: &[Point3<f64>], out: &mut Vec<Leg<N>>) {
        let first = out.len();
        self.inner.legs(from, candidates, out);
        let mut index = 0;
        out.retain(|leg| {
            index += 1;
            index <= first || (self.keep)(from, leg)
        });
    }
}

/// One bit per unordered pair of waypoints, judged once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PairMask {
    points: usize,
    bits: Vec<u64>,
}

impl PairMask {
    /// Asks `allowed(a, b)` for every pair a < b of `points`.
    pub fn new(points: &[Point3<f64>], mut allowed: impl FnMut(&Point3<f64>, &Point3<f64>) -> bool) -> Self {
        let n = points.len();
        let mut mask = Self { points: n, bits: vec![0; (n * n).div_ceil(64)] };
        for a in 0..n {
            for b in a + 1..n {
                if allowed(&points[a], &points[b]) {
                    for place in [a * n + b, b * n + a] {
                        mask.bits[place / 64] |= 1 << (place % 64);
                    }
                }
            }
        }
        mask
    }

    /// Whether the leg between waypoints `a` and `b` is allowed.
    #[inline]
    pub fn allows(&self, a: u32, b: u32) -> bool {
        let place = a as usize * self.points + b as usize;
        self.bits[place / 64] >> (place % 64) & 1 == 1
    }
}
