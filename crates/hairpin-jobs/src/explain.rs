//! Why nothing, or little, is feasible.

use std::time::Instant;

use hairpin::campaign::Stop;
use hairpin::campaign::explain::{self, Explanation};
use hairpin::judgement::Verdict;
use hairpin::math::simd::Simd;
use hairpin_formats::scenario::{kept_in, setup_for, shadowed};

use crate::consent::{Consent, Wish};
use crate::sets::Set;
use crate::{Deadline, Problem, Watch};

/// What is explained.
#[derive(Debug, Clone)]
pub struct ExplainSettings {
    /// Scenario file, the name of a shipped scenario or robot, or a campaign folder's scenario.toml.
    pub scenario: String,
    /// Keys of the scenario with other values.
    pub sets: Vec<Set>,
    /// Graphs that are sampled and searched; with every change the same ones.
    pub graphs: u64,
    /// Seconds after which no further change is tried; what the kind of robot has patience for if not given.
    pub time_limit_s: Option<f64>,
    /// Version of the kernels.
    pub simd: Simd,
    /// What of a folder may run.
    pub consent: Consent,
}

impl Default for ExplainSettings {
    fn default() -> Self {
        let (scenario, sets, time_limit_s, simd, consent) = Default::default();
        Self { scenario, sets, graphs: 8, time_limit_s, simd, consent }
    }
}

/// Searches graphs, counts where candidates for legs are lost, and looks for the smallest change that helps; with the
/// verdict on it. Nothing is written.
///
/// # Errors
/// A scenario with mistakes; one of a campaign's folder that asks to run what its user has not allowed; it was asked to
/// stop.
pub fn explain(settings: &ExplainSettings, watch: &dyn Watch) -> Result<(Explanation, Verdict), Problem> {
    shadowed(&settings.scenario).iter().for_each(|note| watch.warn(note));
    let setup = setup_for(&settings.scenario, &settings.sets)?.with_simd(settings.simd);
    let setup = setup.answered_by(&settings.consent.code)?;
    let (kept, wishes) = (kept_in(&settings.scenario), Wish::of_search(&setup));
    settings.consent.ask_of_scenario((&settings.scenario, kept.as_deref()), &wishes, &settings.sets, watch)?;
    let (began, deadline) = (Instant::now(), Deadline::after(settings.time_limit_s.or(setup.patience())));
    let clock = || began.elapsed().as_secs_f64();
    let stop = Stop { cancelled: &|| watch.stopped(), progress: &|_, _| {}, clock: &clock };
    let found = explain::explain(&setup, settings.graphs, &stop, &|| deadline.passed())?;
    if watch.stopped() {
        return Err(Problem::Interrupted("stopped".into()));
    }
    let verdict = found.verdict(&setup);
    Ok((found, verdict))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;

    #[test]
    fn what_is_feasible_is_told_as_such() {
        let settings = ExplainSettings { scenario: "demo-quadrotor".into(), graphs: 1, ..ExplainSettings::default() };
        let (found, verdict) = explain(&settings, &Unwatched).unwrap();
        assert_eq!(verdict.exit_code, 0, "{verdict:?}");
        assert!(found.losses.left > 0 && found.losses.asked >= found.losses.left);
    }
}
