//! How far two trajectories are apart: how far their ways are, and how far what came of them is, each as a share of
//! what a sample spans.
//!
//! Data flow: the first executions make a [`Scale`] ([`Scale::of`]); each trajectory is put on it once
//! ([`Scale::place`]) and compared as often as needed ([`Scale::apart`]), many of them side by side in a
//! [`Crowd`](super::Crowd).

use std::f64::consts::PI;

use super::lanes::largest_square;
use crate::trajectory::Route;

/// Waves of a way that its outline has, along each axis.
const WAVES: usize = 4;

/// A trajectory as it is compared.
///
/// Plain data: [`Scale::place`] turns it into what is compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Its way.
    pub route: Route,
    /// What came of it, each measure in its own unit, as many of each trajectory; empty where that is not known.
    pub behaviour: Vec<f64>,
}

/// A trajectory on a scale.
///
/// Only comparable with others that the same [`Scale`] placed.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    route: Route,
    /// Each measure as a share of its range.
    shares: Vec<f64>,
}

/// Units of distance, fixed by a sample of trajectories.
///
/// ```text
/// d(a, b) = ½ ( way(a, b) / max way  +  ‖shares(a) − shares(b)‖ / max ‖·‖ )
/// ```
///
/// over the pairs of the sample, shares being (x − min) / (max − min) of each measure; a part that is 0 throughout the
/// sample is left out, and so are behaviours where one is not known. Both parts are metrics, and so is the whole.
///
/// ```
/// use hairpin::search::worst::{Scale, Trace};
/// use hairpin::trajectory::route::Route;
/// use nalgebra::Point3;
///
/// // Straight ways at three heights, each with one measure.
/// let trace = |z: f64, measure: f64| Trace {
///     route: Route::along(&[Point3::new(0.0, 0.0, z), Point3::new(9.0, 0.0, z)]),
///     behaviour: vec![measure],
/// };
/// let sample = [trace(0.0, 1.0), trace(1.0, 3.0), trace(4.0, 2.0)];
/// let scale = Scale::of(&sample);
/// let [a, b, c] = [0, 1, 2].map(|i| scale.place(&sample[i]));
/// assert!((scale.apart(&a, &b) - 0.5 * (0.25 + 1.0)).abs() < 1e-12); // 1 of 4 m, the whole range of the measure
/// assert!((scale.apart(&a, &c) - 0.5 * (1.0 + 0.5)).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// Least value and range of each measure.
    measures: Vec<[f64; 2]>,
    /// Largest distance of two ways of the sample, m, and of two vectors of shares; 0 for a part that does not count.
    longest: [f64; 2],
}

impl Scale {
    /// The scale of `sample`.
    ///
    /// O(n log n) where only a few ways and behaviours lie far out, O(n²) outlines of them at worst, on all threads,
    /// and O(n) memory; ways themselves only where outlines do not say that they are nearer than others.
    ///
    /// A sample of none or one gives a scale on which everything is 0 apart. Measures beyond the number that all
    /// traces have are not looked at.
    pub fn of(sample: &[Trace]) -> Self {
        let count = sample.iter().map(|trace| trace.behaviour.len()).min().unwrap_or(0);
        let range = |m: usize| {
            let column = || sample.iter().map(|trace| trace.behaviour[m]);
            let low = column().fold(f64::INFINITY, f64::min);
            [low, column().fold(f64::NEG_INFINITY, f64::max) - low]
        };
        let scale = Self { measures: (0..count).map(range).collect(), longest: [0.0; 2] };
        if sample.is_empty() {
            return scale;
        }
        let placed: Vec<Placed> = sample.iter().map(|trace| scale.place(trace)).collect();
        let ways: Vec<Vec<f64>> = placed.iter().map(|placed| placed.route.coordinates().collect()).collect();
        let shares: Vec<Vec<f64>> = placed.into_iter().map(|placed| placed.shares).collect();
        let way = largest_square(&ways, 3, &waves());
        let behaviour = largest_square(&shares, 1, &axes(count));
        Self { longest: roots([way, behaviour]), ..scale }
    }

    /// Where `trace` stands; shares of what lies outside of the sample's range lie outside of 0 … 1.
    ///
    /// A measure that is the same throughout the sample has no range and share 0 for all, whatever comes later.
    /// O(places + measures).
    pub fn place(&self, trace: &Trace) -> Placed {
        let share = |(value, [low, range]): (&f64, &[f64; 2])| if *range > 0.0 { (value - low) / range } else { 0.0 };
        Placed { route: trace.route.clone(), shares: trace.behaviour.iter().zip(&self.measures).map(share).collect() }
    }

    /// How far two trajectories are apart: 0 … 1 within the sample, and maybe more beyond.
    ///
    /// Of both parts that are not 0 throughout the sample the mean, or one of them alone.
    ///
    /// Symmetric, 0 of one with itself, and the triangle inequality holds: a mean of metrics.
    pub fn apart(&self, one: &Placed, other: &Placed) -> f64 {
        let squares = one.shares.iter().zip(&other.shares).map(|(x, y)| (x - y) * (x - y));
        self.mean([one.route.apart(&other.route), squares.sum::<f64>().sqrt()])
    }

    /// Of two parts, m and shares of ranges, the distance.
    pub(super) fn mean(&self, parts: [f64; 2]) -> f64 {
        let share = |(part, longest): (f64, f64)| if longest > 0.0 { part / longest } else { 0.0 };
        parts.into_iter().zip(self.longest).map(share).sum::<f64>() / self.counting()
    }

    #[cfg(feature = "unit-tests")]
    pub(super) fn longest(&self) -> [f64; 2] {
        self.longest
    }

    /// How many parts count.
    fn counting(&self) -> f64 {
        self.longest.iter().filter(|longest| **longest > 0.0).count().max(1) as f64
    }

    /// By what the roots of both parts' squared differences are multiplied before they are added up.
    ///
    /// 1/(longest · parts that count), the way's divided by √24 as well, since [`Route::apart`] takes the mean over
    /// places; 0 for a part that does not count.
    pub(super) fn weights(&self) -> [f64; 2] {
        let [way, behaviour] = self.longest.map(|l| if l > 0.0 { 1.0 / (l * self.counting()) } else { 0.0 });
        [way / (Route::PLACES as f64).sqrt(), behaviour]
    }

    /// The distance that so many of the pairs of `sample` (0 … 1) are nearer than; 0 without pairs.
    ///
    /// The order statistic number ⌊q m⌋, from 0, of the m = n (n − 1)/2 distances, without interpolation; the largest
    /// for q = 1. O(n² log n) time and O(n²) memory: for samples, not for populations.
    pub fn quantile(&self, sample: &[Trace], quantile: f64) -> f64 {
        let placed: Vec<Placed> = sample.iter().map(|trace| self.place(trace)).collect();
        let rows = placed.iter().enumerate();
        let pairs = rows.flat_map(|(a, one)| placed[..a].iter().map(move |other| self.apart(one, other)));
        let mut distances: Vec<f64> = pairs.collect();
        distances.sort_unstable_by(f64::total_cmp);
        distances.get((quantile * distances.len() as f64) as usize).or(distances.last()).copied().unwrap_or(0.0)
    }
}

impl Placed {
    /// The coordinates of its way and its shares.
    pub(super) fn vectors(&self) -> [Vec<f64>; 2] {
        [self.route.coordinates().collect(), self.shares.clone()]
    }
}

/// Both parts from the squares of their differences, as [`Route::apart`] has that of ways.
pub(super) fn roots([way, behaviour]: [f64; 2]) -> [f64; 2] {
    [(way / Route::PLACES as f64).sqrt(), behaviour.sqrt()]
}

/// The directions of the first waves of the ways' orthonormal cosine transform along each axis.
///
/// DCT-II: c_k(p) = √(2/P) cos(π (p + ½) k / P), k = 1 … 3, and c_0 = √(1/P), P = 24 places. Ways are smooth, so that
/// four waves hold nearly all of their differences and the bound of what is left out is tight.
fn waves() -> Vec<Vec<f64>> {
    let places = Route::PLACES;
    let wave = |k: usize, place: usize| {
        let long = if k == 0 { 1.0 } else { 2.0 };
        (long / places as f64).sqrt() * libm::cos(PI * (place as f64 + 0.5) * k as f64 / places as f64)
    };
    let direction = |k: usize, axis: usize| {
        (0..3 * places).map(|i| if i % 3 == axis { wave(k, i / 3) } else { 0.0 }).collect::<Vec<f64>>()
    };
    (0..3 * WAVES).map(|d| direction(d / 3, d % 3)).collect()
}

/// All directions of so many numbers: nothing is left out.
fn axes(count: usize) -> Vec<Vec<f64>> {
    (0..count).map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect()).collect()
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Point3;

    use super::*;

    fn trace(x: f64, stress: f64) -> Trace {
        let route = Route::along(&[Point3::origin(), Point3::new(x, 0.0, 0.0)]);
        Trace { route, behaviour: vec![stress, 7.0] }
    }

    #[test]
    fn the_sample_spans_one_and_what_is_beyond_more() {
        let sample = [trace(1.0, 0.0), trace(2.0, 4.0), trace(3.0, 1.0)];
        let scale = Scale::of(&sample);
        let apart = |one: &Trace, other: &Trace| scale.apart(&scale.place(one), &scale.place(other));
        assert_eq!(apart(&sample[0], &sample[0]), 0.0);
        // Half of the longest way, and all of the widest behaviour.
        assert!((apart(&sample[0], &sample[1]) - 0.75).abs() < 1e-12);
        assert!((apart(&sample[0], &trace(5.0, 8.0)) - 2.0).abs() < 1e-12);
        let least = apart(&sample[0], &sample[2]).min(apart(&sample[1], &sample[2])).min(0.75);
        assert_eq!(scale.quantile(&sample, 0.0), least);
        assert_eq!(Scale::of(&sample[..1]).quantile(&sample[..1], 0.1), 0.0);
        // Where all behave alike, ways decide alone.
        let alike = [trace(1.0, 2.0), trace(3.0, 2.0)];
        let scale = Scale::of(&alike);
        assert_eq!(scale.apart(&scale.place(&alike[0]), &scale.place(&alike[1])), 1.0);
    }
}
