//! One motion of several estimates, of which the vehicle flew by one after another.

use std::collections::BTreeMap;

use super::log::{LoggedMotion, Reset, Source};

/// The positions of what was `chosen`, from when on (s) which, of `own` by their numbers, all of which are there; each
/// change is a jump of unknown size.
pub(super) fn by_turns(name: &str, chosen: &[(f64, u32)], own: &BTreeMap<u32, &LoggedMotion>) -> LoggedMotion {
    let changes = chosen.iter().skip(1).map(|(t_s, _)| *t_s);
    // What was before the first word is the first one's.
    let begins = std::iter::once(f64::NEG_INFINITY).chain(changes.clone());
    let ends = changes.clone().chain([f64::INFINITY]);
    let (mut samples, mut resets, mut invalid, mut unfit) = (Vec::new(), Vec::new(), Vec::new(), None);
    for ((from, to), (_, number)) in begins.zip(ends).zip(chosen) {
        let Some(own) = own.get(number) else { continue };
        samples.extend(own.samples.iter().filter(|sample| (from..to).contains(&sample.t_s)));
        resets.extend(own.resets.iter().filter(|reset| (from..to).contains(&reset.t_s)).cloned());
        invalid.extend(own.invalid.iter().filter(|span| span.to_s >= from && span.from_s < to).copied());
        unfit = unfit.or_else(|| own.unfit.clone());
    }
    resets.extend(changes.map(|t_s| Reset { t_s, by_m: None }));
    resets.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    LoggedMotion { resets, invalid, unfit, ..LoggedMotion::of(name, Source::Estimate, samples) }
}
