//! Obstacles and other limits of single legs, as a filter around any reach set.

use nalgebra::Point3;

use super::{Leg, Reach};

/// The legs of `inner` for which `keep(from, leg)` holds. What is dear to judge (segments against obstacles) is judged
/// once per pair of waypoints: see [`PairMask`].
///
/// Order and features of what stays are the inner set's.
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

    fn leg(&self, from: &N, to: &N, candidates: &[Point3<f64>]) -> Option<Leg<N>>
    where
        N: PartialEq,
    {
        self.inner.leg(from, to, candidates).filter(|leg| (self.keep)(from, leg))
    }
}

/// Two bits per unordered pair of waypoints: judged when first asked for, then remembered. A search looks at few of the
/// pairs of a graph.
///
/// 2 n² bits, of which those above the diagonal are used.
///
/// For n = 250 16 kB.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PairMask {
    points: usize,
    bits: Vec<u64>,
}

impl PairMask {
    /// Nothing judged yet, for a graph of `points` waypoints.
    pub fn new(points: usize) -> Self {
        Self { points, bits: vec![0; (2 * points * points).div_ceil(64)] }
    }

    /// Whether the leg between waypoints `a` and `b` is allowed; asks `allowed` the first time.
    ///
    /// The answer must be symmetric and not depend on when it is asked.
    #[inline]
    pub fn allows(&mut self, a: u32, b: u32, allowed: impl FnOnce() -> bool) -> bool {
        let (low, high) = (a.min(b) as usize, a.max(b) as usize);
        let place = 2 * (low * self.points + high);
        let (word, shift) = (place / 64, place % 64);
        if self.bits[word] >> shift & 1 == 0 {
            self.bits[word] |= (1 | u64::from(allowed()) << 1) << shift;
        }
        self.bits[word] >> shift & 2 == 2
    }
}
