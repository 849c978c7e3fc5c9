//! How well each sample of a log knows its place, and in which steps it tells that.

use hairpin::judgement::{Resolution, Step, TELLING};
use hairpin_formats::logs::{LoggedMotion, Sample, ToldTo};

/// Horizontal and vertical standard deviation of each sample, m, and what is to be told of it; none of a log that tells
/// nothing of any.
///
/// A log that tells how good it is, and not of every sample, does not know those better than the others: they count as
/// the least accurate that tells, across and up each by itself.
pub(super) fn accuracies(samples: &[Sample]) -> (Vec<Option<[f64; 2]>>, Option<String>) {
    let told = || samples.iter().filter_map(|sample| sample.accuracy_m);
    let Some(least) = told().reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]) else { return (Vec::new(), None) };
    let untold = samples.len() - told().count();
    let note = format!(
        "{untold} of {} samples tell no accuracy: they count as the least accurate that do, {:.2} m across and {:.2} m up",
        samples.len(),
        least[0],
        least[1]
    );
    let all = samples.iter().map(|sample| sample.accuracy_m.or(Some(least))).collect();
    (all, (untold > 0).then_some(note))
}

/// The steps in which the log tells its numbers, in its own frame: turned into the world's they are as long and no
/// longer to be seen.
pub(crate) fn resolution(motion: &LoggedMotion) -> Resolution {
    let of = |value: &dyn Fn(&Sample, usize) -> f64| {
        Step::of(&[0, 1, 2].map(|axis| motion.samples.iter().map(|sample| value(sample, axis)).collect()))
    };
    let velocities = motion.samples.iter().all(|sample| sample.v_m_s.is_some());
    let place = of(&|sample, axis| sample.p_m[axis]);
    Resolution {
        place: match motion.told_to.filter(|_| motion.samples.len() >= TELLING) {
            Some(ToldTo::Decimal(digit)) => place.written_to(digit),
            Some(ToldTo::Steps(steps)) => Step::along(steps),
            None => place,
        },
        velocity: if velocities { of(&|sample, axis| sample.v_m_s.map_or(0.0, |v| v[axis])) } else { Step::default() },
    }
}
