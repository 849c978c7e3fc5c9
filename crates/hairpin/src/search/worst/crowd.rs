//! Many trajectories on one scale, compared with one another.
//!
//! The same distances as [`Scale::apart`](super::Scale::apart), in SIMD lanes: for sums over all pairs, and for
//! greedy choices that need one row of distances after another.

use super::lanes::Lanes;
use super::pairs::{Centred, over_pairs};
use super::scale::{Placed, Scale, roots};
use crate::trajectory::Route;

/// Trajectories on a scale, to be compared by the million.
///
/// Memory: 72 coordinates and the measures of each, twice.
#[derive(Debug, Clone)]
pub struct Crowd {
    scale: Scale,
    ways: Vec<Vec<f64>>,
    shares: Vec<Vec<f64>>,
    lanes: [Lanes; 2],
}

impl Crowd {
    /// Of `placed`, which stand on `scale`.
    ///
    /// Numbers in the crowd are indices into `placed`, all of which `scale` must have placed.
    pub fn new(scale: &Scale, placed: &[Placed]) -> Self {
        let (ways, shares): (Vec<_>, Vec<_>) = placed.iter().map(Placed::vectors).map(|[w, s]| (w, s)).unzip();
        Self::of(scale.clone(), ways, shares)
    }

    fn of(scale: Scale, ways: Vec<Vec<f64>>, shares: Vec<Vec<f64>>) -> Self {
        let size = shares.first().map_or(0, Vec::len);
        let lanes = [Lanes::new(&ways, 3 * Route::PLACES, 3), Lanes::new(&shares, size, 1)];
        Self { scale, ways, shares, lanes }
    }

    /// How far each is from number `one`, to the bits of [`Scale::apart`].
    ///
    /// Entry k belongs to number k; its own is 0. O(n).
    ///
    /// # Panics
    /// If there is no number `one`.
    pub fn from(&self, one: usize) -> Vec<f64> {
        let [ways, behaviours] = [0, 1].map(|part| self.lanes[part].squares_from(one));
        ways.into_iter().zip(behaviours).map(|(way, other)| self.scale.mean(roots([way, other]))).collect()
    }

    /// Those of these numbers.
    ///
    /// On the same scale, in the order given; number k of the new crowd is `numbers[k]` of this one.
    ///
    /// # Panics
    /// If one of them does not exist.
    pub fn some(&self, numbers: &[usize]) -> Self {
        let of = |vectors: &[Vec<f64>]| numbers.iter().map(|number| vectors[*number].clone()).collect();
        Self::of(self.scale.clone(), of(&self.ways), of(&self.shares))
    }

    /// The mean distance of two, to about ten digits, and the least, to the bits of [`Scale::apart`]; 0 of fewer than
    /// two.
    ///
    /// O(n²) products of numbers on all threads, O(n) memory.
    ///
    /// The mean is taken from ‖x‖² + ‖y‖² − 2 x·y, which loses digits where two are alike; the least therefore is
    /// looked for among the blocks that come within 10⁻⁶ of the smallest, and computed from differences. The same on
    /// any number of threads.
    pub fn spread(&self) -> (f64, f64) {
        let count = self.ways.len();
        if count < 2 {
            return (0.0, 0.0);
        }
        let parts = [Centred::new(&self.ways), Centred::new(&self.shares)];
        let (sum, near) = over_pairs([&parts[0], &parts[1]], self.scale.weights());
        let mut least = f64::INFINITY;
        for one in near {
            let before = self.from(one);
            least = before[..one].iter().copied().fold(least, f64::min);
            if least == 0.0 {
                break;
            }
        }
        (sum / (count * (count - 1) / 2) as f64, least)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::math::random::{stream, unit};
    use crate::search::worst::Trace;

    #[test]
    fn many_are_compared_as_two_are() {
        for (seed, (count, measures)) in [(1, 0), (2, 7), (9, 7), (37, 0), (61, 3), (200, 7)].into_iter().enumerate() {
            let mut random = stream(seed as u64);
            let mut number = |scale: f64| scale * (unit(&mut random) - 0.5);
            let mut traces: Vec<Trace> = (0..count)
                .map(|_| {
                    // All begin together.
                    let mut way = vec![Point3::new(1.0, 0.3, -2.0)];
                    way.extend((0..4).map(|_| Point3::new(number(9.0), number(30.0), number(4.0))));
                    Trace { route: Route::along(&way), behaviour: (0..measures).map(|_| number(3.0)).collect() }
                })
                .collect();
            if count > 60 {
                // Near and very near copies.
                traces[50] = Trace { behaviour: traces[4].behaviour.clone(), ..traces[3].clone() };
                traces[51] = traces[50].clone();
            }
            let scale = Scale::of(&traces);
            let placed: Vec<Placed> = traces.iter().map(|trace| scale.place(trace)).collect();
            let (mut longest, mut sum, mut least) = (0.0_f64, 0.0, f64::INFINITY);
            let crowd = Crowd::new(&scale, &placed);
            for (a, one) in placed.iter().enumerate() {
                let apart: Vec<f64> = placed.iter().map(|other| scale.apart(one, other)).collect();
                assert_eq!(crowd.from(a), apart, "{count}");
                sum += apart[..a].iter().sum::<f64>();
                least = apart[..a].iter().copied().fold(least, f64::min);
                let ways = traces[..a].iter().map(|other| other.route.apart(&traces[a].route));
                longest = ways.fold(longest, f64::max);
            }
            // The farthest ways are one apart, to the bit.
            assert_eq!(scale.longest()[0], longest);
            let (mean, nearest) = crowd.spread();
            let pairs = count * (count - 1) / 2;
            assert!(pairs == 0 || (mean - sum / pairs as f64).abs() < 1e-9 && nearest == least, "{count}: {mean}");
        }
    }
}
