//! A few numbers searched for stress: what surrounds a trajectory that stays as it is.
//!
//! Places are drawn uniformly at first; the best one is then improved by a (1+1) evolution strategy whose step follows
//! success (Rechenberg's one in five).
//!
//! Derivative-free and scale-free: only the order of stresses is used, so that a plateau or a jump (a crash) does no
//! harm.

use rand::RngExt;

use super::step::after;
use super::{Rank, Trial};
use crate::math::random::{standard_normals, stream};

/// Share of the executions that is drawn uniformly.
const DRAWN: f64 = 0.4;
/// First and least step of a coordinate.
const STEPS: [f64; 2] = [0.3, 1e-3];

/// The answer.
///
/// `best_so_far` never falls; a trial of several executions has as many entries.
///
/// All entries of `place` are within −1 … 1 and as `bound` left them.
#[derive(Debug, Clone, PartialEq)]
pub struct Climbed {
    /// The gravest place, if one was as grave as the first.
    pub place: Option<Vec<f64>>,
    /// Its execution, or the first one's.
    pub trial: Trial,
    /// The largest stress after each execution.
    pub best_so_far: Vec<f64>,
}

/// Searches places with coordinates between −1 and 1 from `start`, whose execution came to `trial`. `bound` puts a
/// place that is not allowed to the nearest that is; `execute` gives `None` where an execution failed; it is told the
/// rank of the best so far. `executions` is how many there are at most, `per_trial` how many one trial takes at most.
///
/// x′ = bound(x + σ n), n standard normal; accepted where the rank is no less. Places are scaled by the caller so
/// that ±1 are its bounds.
///
/// `start` and places have as many coordinates as what surrounds the trajectory has numbers. Draws are 2 of 5
/// executions; then σ begins at 0.3, grows by 1.5 on success, shrinks by 1.5^(−1/4) else, within 10⁻³ … 0.6.
///
/// Fewer executions than `per_trial` give the first place back, unexecuted. A failed execution counts as one and as
/// no success.
///
/// ```
/// use hairpin::search::in_loop::{Trial, climb};
///
/// // Stress falls with the distance from (0.5, −0.5): found within a tenth by 200 executions.
/// let stress = |x: &[f64]| -((x[0] - 0.5).powi(2) + (x[1] + 0.5).powi(2));
/// let trial = |stress| Trial { stress, fails: false, worst_leg: 0, executions: 1 };
/// let first = trial(stress(&[0.0, 0.0]));
/// let answer = climb(&[0.0, 0.0], first, 1, [200, 1], |_| {}, |place, _| Some(trial(stress(place))));
/// let place = answer.place.unwrap();
/// assert!((place[0] - 0.5).hypot(place[1] + 0.5) < 0.1 && answer.best_so_far.len() == 200);
/// ```
pub fn climb(
    start: &[f64],
    trial: Trial,
    seed: u64,
    [executions, per_trial]: [u64; 2],
    bound: impl Fn(&mut [f64]),
    mut execute: impl FnMut(&[f64], Rank) -> Option<Trial>,
) -> Climbed {
    let mut rng = stream(seed);
    let mut best = Climbed { place: None, trial, best_so_far: Vec::new() };
    let mut most = trial.stress;
    let mut here = start.to_vec();
    let drawn = (executions as f64 * DRAWN) as u64;
    let mut step = STEPS[0];
    while best.best_so_far.len() as u64 + per_trial.max(1) <= executions {
        let number = best.best_so_far.len() as u64;
        let mut place: Vec<f64> = if number < drawn {
            here.iter().map(|_| rng.random_range(-1.0..=1.0)).collect()
        } else {
            here.iter().map(|x| x + step * standard_normals::<1>(&mut rng)[0]).collect()
        };
        place.iter_mut().for_each(|x| *x = x.clamp(-1.0, 1.0));
        bound(&mut place);
        let trial = execute(&place, best.trial.rank());
        let count = trial.map_or(1, |trial| trial.executions);
        most = most.max(trial.map_or(f64::NAN, |trial| trial.stress));
        match trial {
            Some(trial) if trial.reaches(best.trial.rank()) => {
                here.clone_from(&place);
                (best.place, best.trial) = (Some(place), trial);
                step = after(step, true).min(2.0 * STEPS[0]);
            }
            _ if number >= drawn => step = after(step, false).max(STEPS[1]),
            _ => {}
        }
        best.best_so_far.extend((0..count).map(|_| most));
    }
    best
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn the_worst_place_is_found_within_its_bounds() {
        // Within the unit disc the sum of a hill's height and a slope is largest on the rim.
        let stress = |x: &[f64]| 2.0 * x[0] + x[1] - (x[2] - 0.4) * (x[2] - 0.4);
        let bound = |x: &mut [f64]| {
            let norm = (x[0] * x[0] + x[1] * x[1]).sqrt().max(1.0);
            x[..2].iter_mut().for_each(|x| *x /= norm);
        };
        for seed in 0..5 {
            let first = Trial { stress: stress(&[0.0; 3]), fails: false, worst_leg: 0, executions: 1 };
            let mut executed = 0;
            let found = climb(&[0.0; 3], first, seed, [200, 1], bound, |x, _| {
                executed += 1;
                assert!(x[0] * x[0] + x[1] * x[1] <= 1.0 + 1e-12 && x[2].abs() <= 1.0);
                (executed % 7 != 0).then(|| Trial { stress: stress(x), fails: false, worst_leg: 0, executions: 1 })
            });
            let place = found.place.unwrap();
            assert_eq!((executed, found.best_so_far.len()), (200, 200));
            assert!((found.trial.stress - 5.0f64.sqrt()).abs() < 0.01, "{seed}: {place:?} {:?}", found.trial);
            assert!(found.best_so_far.windows(2).all(|pair| pair[0] <= pair[1]));
            assert_eq!(stress(&place), found.trial.stress);
        }
        let first = Trial { stress: 1.0, fails: false, worst_leg: 2, executions: 1 };
        let nothing = climb(&[0.0], first, 1, [9, 1], |_| {}, |_, _| None);
        assert_eq!((nothing.place, nothing.trial.worst_leg, nothing.best_so_far), (None, 2, vec![1.0; 9]));
    }
}
