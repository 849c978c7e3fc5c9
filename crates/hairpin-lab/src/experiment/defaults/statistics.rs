//! How much more one side stresses than the other, over independent runs.

use hairpin::judgement::signed_rank;
use hairpin::math::random::stream;
use rand::RngExt;

/// Resamples of a bootstrap interval.
const RESAMPLES: usize = 4_000;
/// Stresses of zero have no logarithm: below a micrometre, they are one.
const LEAST: f64 = 1e-6;

/// What both sides of one run came to.
pub(super) type Sides = [Vec<f64>; 2];

/// Ratio of geometric means − 1, with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lift {
    /// A share: 0.5 is half as much again.
    pub(super) value: f64,
    /// The 95 % percentile bootstrap interval; whole runs are drawn again, both sides of one together.
    pub(super) interval: [f64; 2],
    /// Chance of as much if neither side were ahead in a run: Wilcoxon's signed ranks, one-sided.
    pub(super) p: f64,
}

/// Sum of logarithms and their number, of both sides of a run.
type Sums = [(f64, usize); 2];

fn sums(run: &Sides) -> Sums {
    let side = |values: &Vec<f64>| (values.iter().map(|value| libm::log(value.max(LEAST))).sum(), values.len());
    [side(&run[0]), side(&run[1])]
}

/// exp(mean ln x − mean ln y) over what `runs` hold together; NaN where a side is empty.
fn ratio<'a>(runs: impl Iterator<Item = &'a Sums>) -> f64 {
    let mut all: Sums = [(0.0, 0); 2];
    for run in runs {
        for (all, side) in all.iter_mut().zip(run) {
            (all.0, all.1) = (all.0 + side.0, all.1 + side.1);
        }
    }
    let mean = |(sum, count): (f64, usize)| sum / count as f64;
    libm::exp(mean(all[0]) - mean(all[1]))
}

/// The lift in each of many resamples of `runs`.
pub(super) fn resampled(runs: &[Sides], seed: u64) -> Vec<f64> {
    let runs: Vec<Sums> = runs.iter().map(sums).collect();
    if runs.is_empty() {
        return Vec::new();
    }
    let mut random = stream(seed);
    let mut again = || {
        let drawn: Vec<&Sums> = (0..runs.len()).map(|_| &runs[random.random_range(0..runs.len())]).collect();
        ratio(drawn.into_iter()) - 1.0
    };
    (0..RESAMPLES).map(|_| again()).filter(|lift| lift.is_finite()).collect()
}

/// The middle 95 % of `lifts`.
pub(super) fn interval(mut lifts: Vec<f64>) -> [f64; 2] {
    lifts.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = (share * lifts.len().saturating_sub(1) as f64).round() as usize;
        lifts.get(place).copied().unwrap_or(f64::NAN)
    };
    [at(0.025), at(0.975)]
}

/// How much larger the first side is; `None` where a side is empty in all runs.
pub(super) fn lift(runs: &[Sides], seed: u64) -> Option<Lift> {
    let all: Vec<Sums> = runs.iter().map(sums).collect();
    let value = ratio(all.iter()) - 1.0;
    if !value.is_finite() {
        return None;
    }
    let of_run = |run: &Sums| ratio(std::iter::once(run));
    let differences: Vec<f64> = all.iter().map(of_run).filter(|r| r.is_finite()).map(libm::log).collect();
    let test = signed_rank(&differences)?;
    let p = if test.plus > test.minus { 0.5 * test.p } else { 1.0 - 0.5 * test.p };
    Some(Lift { value, interval: interval(resampled(runs, seed)), p })
}

/// The chance that one of `sample` is larger than one of `other`, ties by half. Source: Vargha and Delaney, A critique
/// and improvement of the CL common language effect size statistics, 2000.
pub(super) fn a12(sample: &[f64], other: &[f64]) -> f64 {
    let ahead =
        |x: &f64| -> f64 { other.iter().map(|y| if x > y { 1.0 } else { 0.5 * f64::from(u8::from(x == y)) }).sum() };
    sample.iter().map(ahead).sum::<f64>() / (sample.len() * other.len()) as f64
}

/// exp(mean ln x); NaN of none.
pub(super) fn geometric_mean(values: &[f64]) -> f64 {
    libm::exp(values.iter().map(|value| libm::log(value.max(LEAST))).sum::<f64>() / values.len() as f64)
}

/// The value that `share` of `values` exceed; `None` where that is less than one of them.
pub(super) fn exceeded_by(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let exceeding = (share * sorted.len() as f64) as usize;
    if exceeding == 0 { None } else { sorted.get(exceeding).copied() }
}

/// The middle value, the mean of the two middle ones of an even number; `None` of none.
pub(super) fn middle(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    let upper = *values.get(half)?;
    Some(if values.len().is_multiple_of(2) { 0.5 * (values[half - 1] + upper) } else { upper })
}

#[cfg(test)]
mod tests {
    use hairpin::judgement::holm;
    use hairpin::math::random::standard_normals;

    use super::*;

    #[test]
    fn a12_is_the_share_of_pairs() {
        assert_eq!(a12(&[3.0, 4.0], &[1.0, 2.0]), 1.0);
        assert_eq!(a12(&[1.0, 2.0], &[1.0, 2.0]), 0.5);
        // 2 > 1; 5 > 1, 5 > 4; 2 against 4 is lost; 3 ties with nothing.
        assert_eq!(a12(&[2.0, 5.0], &[1.0, 4.0]), 0.75);
        assert_eq!(a12(&[2.0], &[2.0, 1.0, 3.0, 3.0]), (0.5 + 1.0) / 4.0);
    }

    #[test]
    fn holm_takes_the_smallest_times_all() {
        assert_eq!(holm(&[0.01, 0.04, 0.03]), [0.03, 0.06, 0.06]);
        assert_eq!(holm(&[0.5, 0.9]), [1.0, 1.0]);
    }

    #[test]
    fn a_lift_is_a_ratio_of_geometric_means() {
        // √(1·4) over √(1·1), in each run: no spread at all.
        let runs: Vec<Sides> = vec![[vec![1.0, 4.0], vec![1.0, 1.0]]; 12];
        let told = lift(&runs, 1).unwrap();
        assert!((told.value - 1.0).abs() < 1e-12 && told.interval.iter().all(|end| (end - 1.0).abs() < 1e-12));
        // All twelve of one sign: one assignment of 2¹².
        assert_eq!(told.p, 1.0 / 4096.0);
        // A run that lacks a side weighs by what it has.
        let lacking = [runs[0].clone(), [Vec::new(), vec![4.0, 4.0]]];
        assert!((lift(&lacking, 1).unwrap().value - 0.0).abs() < 1e-12);
        assert_eq!(lift(&[[vec![1.0], Vec::new()]], 1), None);
        assert!((geometric_mean(&[1.0, 4.0, 16.0]) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn the_interval_is_that_of_a_mean_of_normal_logarithms() {
        // ln of the ratio: mean of n normals of deviation 0.3, so that half the interval is 1.96 · 0.3 / √n.
        let mut random = stream(9);
        let n = 400;
        let mut run = || [vec![libm::exp(0.2 + 0.3 * standard_normals::<1>(&mut random)[0])], vec![1.0]];
        let runs: Vec<Sides> = (0..n).map(|_| run()).collect();
        let told = lift(&runs, 2).unwrap();
        let [low, high] = told.interval.map(|end| libm::log(1.0 + end));
        let half = 1.96 * 0.3 / (n as f64).sqrt();
        assert!((0.5 * (high - low) / half - 1.0).abs() < 0.1, "{low} … {high}, {half}");
        assert!((libm::log(1.0 + told.value) - 0.2).abs() < 2.0 * half && told.p < 1e-6);
        assert_eq!(lift(&runs, 2), Some(told));
    }

    #[test]
    fn limits_are_exceeded_by_as_many_as_asked() {
        let values: Vec<f64> = (1..=40).map(f64::from).collect();
        assert_eq!(exceeded_by(&values, 0.05), Some(38.0));
        assert_eq!(exceeded_by(&values[..10], 0.05), None);
        assert_eq!(
            (middle(vec![3.0, 1.0, f64::INFINITY]), middle(vec![1.0, 2.0]), middle(vec![])),
            (Some(3.0), Some(1.5), None)
        );
    }
}
