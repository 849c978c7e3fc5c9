//! A sample with a stamp older than one before it: one that came late, or of a clock that was set back. What was
//! flown by such a clock has stamps that others have, and is in no motion that rises in time.

use nalgebra::Point3;

use super::twice::told;

/// Messages overtake each other by no more of them than this.
const MESSAGES: usize = 4;
/// Or by no more than this, s.
const LATE_S: f64 = 0.1;
/// What estimates of one moment differ by at rest, m.
const NOISE_M: f64 = 0.02;

/// What is wrong with a sample at `t_s` and `p` that comes after `count` samples, at least one, of rising times: where
/// it is late by little, and the body may have been there then, nothing is.
pub(super) fn set_back(
    (t_s, p): (f64, &Point3<f64>),
    count: usize,
    time: impl Fn(usize) -> f64,
    place: impl Fn(usize) -> Point3<f64>,
) -> Option<String> {
    let last = count.checked_sub(1)?;
    let late_s = time(last) - t_s;
    if late_s > LATE_S && t_s < time(count.saturating_sub(MESSAGES)) {
        let (from, to) = (told(time(last)), told(t_s));
        return Some(format!("stamps go back from {from} s to {to} s: nobody knows what was when"));
    }
    // The samples that it lies between, and one more on either side.
    let next = (0..count).rev().take_while(|i| time(*i) > t_s).last().unwrap_or(last);
    let beside = next.saturating_sub(2)..(next + 1).min(last);
    let step = |i: usize| ((place(i + 1) - place(i)).norm(), time(i + 1) - time(i));
    let speed = beside.clone().map(step).map(|(far, dt)| far / dt).fold(0.0, f64::max);
    let longest_s = beside.map(|i| step(i).1).fold(0.0, f64::max);
    let off = [next.saturating_sub(1), next].map(|i| (place(i) - p).norm()).into_iter().fold(f64::INFINITY, f64::min);
    (off > speed * (late_s + longest_s) + NOISE_M).then(|| {
        let (at, from) = (told(t_s), told(time(last)));
        format!("a sample with the stamp {at} s, after {from} s, is {off:.2} m from those of that time")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten samples a second along x at 2 m/s from 1 s on, then one at `t_s` and `x`.
    fn after(t_s: f64, x: f64) -> Option<String> {
        let time = |i: usize| 1.0 + 0.1 * i as f64;
        set_back((t_s, &Point3::new(x, 0.0, 0.0)), 50, time, |i| Point3::new(0.2 * i as f64, 0.0, 0.0))
    }

    #[test]
    fn only_what_is_late_by_little_and_where_others_were_then_is_nothing() {
        // The last is at 5.9 s and 9.8 m.
        for (t_s, x) in [(5.85, 9.7), (5.65, 9.3), (5.85, 9.9)] {
            assert_eq!(after(t_s, x), None, "{t_s} {x}");
        }
        let far = after(5.85, 12.0).unwrap();
        assert_eq!(far, "a sample with the stamp 5.85 s, after 5.9 s, is 2.20 m from those of that time");
        // Wherever it is.
        let back = after(3.05, 4.1).unwrap();
        assert_eq!(back, "stamps go back from 5.9 s to 3.05 s: nobody knows what was when");
        // Before all.
        assert!(after(0.5, 0.0).is_some());
        // After one alone.
        let one = |t_s: f64, x: f64| set_back((t_s, &Point3::new(x, 0.0, 0.0)), 1, |_| 7.0, |_| Point3::origin());
        assert_eq!(one(6.95, 0.01), None);
        assert!(one(6.95, 0.5).is_some() && one(3.0, 0.0).is_some());
    }
}
