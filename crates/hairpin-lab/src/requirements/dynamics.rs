//! Delay, lag and slip: met by a generator that knows them, and what they do to one that does not.

use hairpin::campaign::drive::Site;
use hairpin::feasibility::steering::shooting::rough::Settings;
use hairpin_jobs::Problem;

use super::check::{Check, Test};
use super::regression::{Times, on_the_ground};
use super::store;
use super::subject::Subject;

/// Share of goals that must be met, %.
const SHARE: f64 = 99.0;

/// R11: goals on rough ground that the late vehicle has driven to, solved for it and, for comparison, for the vehicle
/// without dynamics.
pub(super) fn compensated(subject: &Subject) -> Result<(Test, Times), Problem> {
    let goals = subject.goals(&subject.late, (subject.queries / 2).max(20), 34)?;
    let tally = on_the_ground(subject, &subject.late, &goals);
    let late = Site::straight(&subject.late, &subject.ground);
    let prompt = Site::straight(&subject.rocky8, &subject.ground);
    let mut misses: Vec<f64> = goals
        .iter()
        .filter_map(|(start, goal)| {
            let answer = prompt.drive(start, goal, &Settings::default());
            let [x, y, _] = late.replay(start, goal, &answer.segments).ok()?.error;
            Some(libm::hypot(x, y))
        })
        .collect();
    misses.sort_by(f64::total_cmp);
    let median = misses.get(misses.len() / 2).copied().unwrap_or(f64::NAN);
    let stored = store::compare(subject, store::ROUGH_DYNAMICS)?;
    let check = Check::new(
        format!(
            "{} of {} ({:.2} %) met within 0.01 m, rad and 1/m in {}; drives that do not know of the dynamics miss by {median:.3} m \
             in the median; {}",
            tally.met,
            tally.asked,
            tally.share(),
            tally.times(),
            stored.words()
        ),
        format!("≥ {SHARE} %, far more than 0.01 m without, none worse"),
        tally.share() >= SHARE && median > 0.05 && stored.good(),
    );
    let what = "rough ground with delay, lag and slip: predicted and compensated";
    let times = Times { of: "rocky8 with dynamics, rough ground", seconds: tally.seconds };
    Ok((Test::new("R11", "R-12", what, check), times))
}
