//! Samples that tell a place once more though the robot has moved on: an estimate of 5 Hz, written down at 50 Hz.
//!
//! What may hide between two samples is bounded by the time between them, and a repeated place bounds nothing: between
//! one new place and the next the robot was anywhere that it can get to and back.

/// A step that is so many times faster than those beside it did not begin at the sample before it.
const FASTER: f64 = 1.5;
/// Steps below this are nobody's motion, m or rad.
const LEAST: f64 = 1e-3;

/// Which of the samples at `times` (s) repeat the place of the one before while the robot moves on.
///
/// `apart` is how far two samples are apart: 0 where they are the same. `step` is that in which places are told, the
/// length of the vector of all axes: what is moved by less than two of them has been rounded.
///
/// A run of samples of one place is left for the next one by a step. Taken from the run's last sample it has a speed u,
/// and where that place was held meanwhile it is faster than the way from there to the next place is,
///
/// ```text
/// u = |p₁ − p₀|/(t₁ − last t₀) > 1.5 v,     v = |p₂ − p₁|/(t₂ − t₁)
/// ```
///
/// Who stands and then drives on is no faster in the first step than in the second. Of the last run, and of what was
/// left to it, nothing is said but by the step before.
///
/// One entry a sample, never true of the first. O(samples).
pub fn repeats(times: &[f64], apart: &dyn Fn(usize, usize) -> f64, step: f64) -> Vec<bool> {
    let mut stale = vec![false; times.len()];
    let begins: Vec<usize> = (0..times.len()).filter(|&i| i == 0 || apart(i - 1, i) > 0.0).collect();
    let speed = |k: usize| Some(apart(begins[k], *begins.get(k + 1)?) / (times[begins[k + 1]] - times[begins[k]]));
    for (k, pair) in begins.windows(2).enumerate() {
        let (first, next) = (pair[0], pair[1]);
        let far = apart(first, next);
        if next - first < 2 || far <= (2.0 * step).max(LEAST) {
            continue;
        }
        let beside = speed(k + 1).or_else(|| k.checked_sub(1).and_then(speed)).unwrap_or(0.0);
        if far / (times[next] - times[next - 1]) > FASTER * beside {
            stale[first + 1..next].fill(true);
        }
    }
    stale
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    /// How many of `places`, 20 ms apart, are left out.
    fn count(places: &[f64], step: f64) -> usize {
        let times: Vec<f64> = (0..places.len()).map(|i| 0.02 * i as f64).collect();
        repeats(&times, &|i, j| (places[j] - places[i]).abs(), step).iter().filter(|stale| **stale).count()
    }

    fn every(count: usize, of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..count).map(|i| of(0.02 * i as f64)).collect()
    }

    #[test]
    fn places_that_are_held_between_updates_are_repeats() {
        // Of 500 samples one in ten is new; what the last is left for is not known.
        let held = |period: f64| move |t: f64| (t / period + 1e-9).floor() * period;
        assert_eq!(count(&every(500, held(0.2)), 0.0), 49 * 9);
        // Twice as many as there are.
        assert_eq!(count(&every(500, held(0.04)), 0.0), 249);
        // Accelerating, braking and turning back.
        let there = |t: f64| 2.0 * (0.6 * t).sin();
        let found = count(&every(500, |t| there(held(0.2)(t))), 0.0);
        assert!(found > 400, "{found}");
        // One freeze on the way.
        let frozen = |t: f64| if (2.0..3.0).contains(&t) { 2.0 } else { t };
        assert_eq!(count(&every(500, frozen), 0.0), 49);
    }

    #[test]
    fn who_stands_repeats_nothing() {
        let start = |a: f64| move |t: f64| if t < 4.0 { 0.0 } else { 0.5 * a * (t - 4.0) * (t - 4.0) };
        assert_eq!((count(&every(500, start(0.5)), 0.0), count(&every(500, start(20.0)), 0.0)), (0, 0));
        // At once at its speed, as models of drives are, and at rest on the way.
        let at_once = |t: f64| (t.min(2.0) + (t - 4.0).clamp(0.0, 3.0)) * 0.7;
        assert_eq!(count(&every(500, at_once), 0.0), 0);
        assert_eq!(count(&every(500, |t| t), 0.0), 0);
        assert_eq!(count(&every(500, |_| 3.0), 0.0), 0);
        assert_eq!((count(&[], 0.0), count(&[1.0], 0.0), count(&[1.0, 1.0], 0.0)), (0, 0, 0));
        // Slower than what it is rounded to.
        let rounded = |step: f64| move |t: f64| (0.3 * t / step).round() * step;
        assert_eq!(count(&every(500, rounded(0.1)), 0.1), 0);
        assert!(count(&every(500, rounded(0.1)), 0.01) > 300);
    }
}
