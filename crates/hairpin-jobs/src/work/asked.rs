//! What a scenario asks for, and whether that can be answered.

use hairpin::campaign::scenario::Asked;
use hairpin::campaign::{Scenario, Setup, vary};
use hairpin::judgement::{Chosen, cases_needed};

use crate::{Problem, Watch};

/// Confidence of intervals where the spec names none.
const CONFIDENCE: f64 = 0.95;

/// `setup`, whose scenario says in so many words that nothing is asked of its runs where it has no limit: what is
/// written for other commands to read asks for something, or says that it does not.
pub(crate) fn saying_what_is_asked(setup: Setup) -> Result<Setup, Problem> {
    if setup.scenario.asked() != Asked::Unsaid {
        return Ok(setup);
    }
    let varied = setup.scenario.vary().clone();
    let scenario = vary::apply(&setup.scenario, &[("spec".into(), "none".into())])?;
    Ok(setup.changed(scenario.with_vary(varied))?)
}

/// Tells whoever waits for `cases` cases that they are too few for the share of violations that `scenario` allows,
/// where they are drawn at random: of any others the count decides.
pub(crate) fn tell_share(scenario: &Scenario, (cases, chosen): (u64, Chosen), watch: &dyn Watch) {
    let head = scenario.head();
    let Some(share) = head.violation_share.filter(|_| chosen == Chosen::AtRandom) else { return };
    let confidence = head.confidence.unwrap_or(CONFIDENCE);
    let Some(needed) = cases_needed(share, confidence).filter(|needed| *needed as u64 > cases) else { return };
    let key = if head.limits.iter().any(|key| key.starts_with("spec.limits.")) { "spec.limits" } else { "spec" };
    watch.warn(&format!(
        "`{key}.violation_share` = {share}: of {cases} cases none can show so small a share at {} % confidence; it takes {needed} \
         without a violation. The verdict can be FAIL or INCONCLUSIVE, not PASS",
        100.0 * confidence
    ));
}

pub(super) fn check_command(scenario: &Scenario) -> Result<(), Problem> {
    let Some(command) = scenario.executor().command else { return Ok(()) };
    let parsed = command.parse::<hairpin_formats::executor::Command>();
    parsed.map(drop).map_err(|error| Problem::input(format!("`execute.command` = {command:?} {error}")))
}
