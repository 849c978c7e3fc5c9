//! Fits: numbers from all logs but those held out, and the gap on each.
//!
//! ```text
//! logs ─▶ Loops ─┬─▶ output_error ─┬─▶ Found ─▶ Fit
//!                └─▶ imitated      ┘     └─▶ the same from all logs but one ─▶ gap on that one
//! ```

use super::answer::Fit;
use super::compare::Flown;
use super::found::{Disturbance, Found, written};
use super::gap::{Gap, deviation};
use super::simulate::Loops;
use super::{FitError, imitated, output_error};
use crate::campaign::Setup;

/// What is fitted on.
///
/// One log is always fitted to, whatever number is held out.
#[derive(Debug, Clone, Copy, Default)]
pub struct FitSettings {
    /// So many logs, the last ones, are not fitted to: the fit is tried on them. 0: each is, by a fit to all others.
    pub held_out: usize,
}

/// Fits the robot and controller of `setup` to logs; `stopped` is asked now and then.
///
/// # Errors
/// See [`FitError`].
///
/// `setup` is that of the robot as given; `flown` are its logs with their missions. With nothing held out each log's
/// `unseen` comes from a fit to all the others, of which is taken what is written of the whole: one more descent a log.
pub fn fit(
    setup: &Setup,
    flown: &[Flown],
    settings: &FitSettings,
    stopped: &(dyn Fn() -> bool + Sync),
) -> Result<Fit, FitError> {
    let loops = Loops::new(setup, flown)?;
    let given: Vec<f64> = loops.numbers.iter().map(|number| number.value).collect();
    if let Some(refused) = loops.refused(&given) {
        return Err(refused);
    }
    let held_out = settings.held_out.min(flown.len() - 1);
    let fitted: Vec<usize> = (0..flown.len() - held_out).collect();
    let found = match loops.imitator(&fitted)? {
        Some(imitator) => imitated::found(&loops, &*imitator, &given, &fitted, stopped),
        None => output_error::found(&loops, &given, &fitted, stopped),
    }?;
    let mut gaps: Vec<Gap> = (0..flown.len())
        .map(|at| Gap {
            log: flown[at].log.clone(),
            mission: flown[at].mission.clone(),
            before: deviation(&loops, &given, at),
            after: deviation(&loops, &found.written, at),
            unseen: None,
        })
        .collect();
    if held_out > 0 {
        gaps.iter_mut().skip(fitted.len()).for_each(|gap| gap.unseen = Some(gap.after));
    } else if flown.len() > 1 {
        for (at, gap) in gaps.iter_mut().enumerate() {
            if stopped() {
                return Err(FitError::Stopped);
            }
            let others: Vec<usize> = fitted.iter().copied().filter(|other| *other != at).collect();
            gap.unseen = refitted(&loops, &given, &found, &others).map(|theta| deviation(&loops, &theta, at));
        }
    }
    Ok(found.into_fit(&loops, &given, &fitted, gaps))
}

/// What would be written of the logs `which` alone.
fn refitted(loops: &Loops, given: &[f64], found: &Found, which: &[usize]) -> Option<Vec<f64>> {
    if found.told.is_empty() {
        return Some(found.written.clone());
    }
    let best = match &found.disturbance {
        Disturbance::Coloured(colour) => output_error::refitted(loops, found, colour, which),
        Disturbance::Noisy(noise) => imitated::refitted(loops, found, noise, which),
    };
    Some(written(given, &found.told, &best?))
}
