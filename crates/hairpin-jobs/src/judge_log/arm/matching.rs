//! Which program of a campaign a log ran: the one whose path it follows best and to its end; where two come near each
//! other it is asked for, not guessed.

use hairpin::campaign::Case;
use hairpin::campaign::arm::ArmSetup;
use hairpin_formats::controller_log::ControllerLog;
use rayon::prelude::*;

use super::super::asks::Asks;
use super::super::matching::{CLEAR, Matched};

/// Paths that lie nearer to each other are the same to a log, m: a servo's lag and noise.
const ALIKE_M: f64 = 5e-4;

/// The case of `cases` that `log` ran; a program that it does not run to its end only where no other is as near.
///
/// # Errors
/// Two that are as near; none whose path it can be held against, in a sentence.
pub(super) fn matched<'a>(
    arm: &ArmSetup,
    cases: &'a [Case],
    log: &ControllerLog,
    asks: &Asks,
) -> Result<(&'a Case, Option<Matched>), String> {
    if let [only] = cases {
        return Ok((only, None));
    }
    let far = |case: &'a Case| Some((arm.distance(case, &log.track, log.orientation_known).ok()?, case));
    let mut ranked: Vec<((f64, bool), &Case)> = cases.par_iter().filter_map(far).collect();
    ranked.sort_by(|((a, _), _), ((b, _), _)| a.total_cmp(b));
    let Some(((nearest, _), _)) = ranked.first().copied() else {
        return Err("it can be held against the program of no case".into());
    };
    let near = |far: f64| far <= CLEAR * nearest.max(ALIKE_M);
    let whole = ranked.iter().any(|((far, whole), _)| near(*far) && *whole);
    ranked.retain(|((far, is_whole), _)| !whole || *is_whole || !near(*far));
    match ranked[..] {
        [((best, _), case), ((next, _), other), ..] if near(next) => Err(format!(
            "ran case {} (mean {:.2} mm off) or {} ({:.2} mm), which come too near each other to tell: {}",
            case.id(),
            1e3 * best,
            other.id(),
            1e3 * next,
            asks.case
        )),
        [((mean_m, _), case), ref rest @ ..] => {
            let next = rest.first().map(|((far, _), other)| (other.id(), *far));
            Ok((case, Some(Matched { by_targets: false, mean_m, next })))
        }
        [] => Err("it can be held against the program of no case".into()),
    }
}
