//! Why nothing, or little, is feasible.

use std::time::Instant;

use hairpin::campaign::explain::{self, Explanation};
use hairpin::campaign::{Setup, Stop};
use hairpin::judgement::Verdict;
use hairpin::math::simd::Simd;
use hairpin_formats::scenario::{kept_in, setup_for, shadowed};

use crate::consent::{Consent, Wish};
use crate::sets::Set;
use crate::{Deadline, Problem, Watch};

/// What the watch is told of: graphs of the scenario as it stands …
const GRAPHS: &str = "graphs";
/// … and keys that were changed.
const KEYS: &str = "keys";

/// So long (s) changes are looked for where nobody says how long: each is a search of its own, and of drives with tight
/// limits they come to many minutes.
pub const PATIENCE_S: f64 = 60.0;

/// What is explained.
#[derive(Debug, Clone)]
pub struct ExplainSettings {
    /// Scenario file, the name of a shipped scenario or robot, or a campaign folder's scenario.toml.
    pub scenario: String,
    /// Keys of the scenario with other values.
    pub sets: Vec<Set>,
    /// Graphs that are sampled and searched; with every change the same ones.
    pub graphs: u64,
    /// Seconds after which no further change is tried; what the kind of robot has patience for if not given, and
    /// [`PATIENCE_S`] where it has no own.
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
/// stop before that was known of the scenario as it stands. Stopped later, it gives the changes that were found so far.
pub fn explain(settings: &ExplainSettings, watch: &dyn Watch) -> Result<(Explanation, Verdict), Problem> {
    shadowed(&settings.scenario).iter().for_each(|note| watch.warn(note));
    let setup = setup_for(&settings.scenario, &settings.sets)?.with_simd(settings.simd);
    let setup = setup.answered_by(&settings.consent.code)?;
    let (kept, wishes) = (kept_in(&settings.scenario), Wish::of_search(&setup));
    settings.consent.ask_of_scenario((&settings.scenario, kept.as_deref()), &wishes, &settings.sets, watch)?;
    let (began, limit) = (Instant::now(), limit_s(settings, &setup));
    let deadline = Deadline::after(Some(limit));
    let clock = || began.elapsed().as_secs_f64();
    let told = |what: &'static str| move |done, of| watch.progress(what, done, of);
    let (graphs, keys) = (told(GRAPHS), told(KEYS));
    let stop = Stop { cancelled: &|| watch.stopped(), progress: &graphs, clock: &clock };
    let looking = Stop { cancelled: &|| watch.stopped() || deadline.passed(), progress: &keys, clock: &clock };
    let found = explain::explain(&setup, settings.graphs, &stop, &looking)?;
    [GRAPHS, KEYS].into_iter().for_each(|what| watch.finished(what));
    if !found.is_found_out() {
        let sentence = format!("stopped after {} of {} graphs, none with a trajectory", found.graphs, settings.graphs);
        return Err(Problem::Interrupted(sentence));
    }
    if found.stopped && !watch.stopped() && settings.time_limit_s.is_none() {
        watch.warn(&format!("after {limit} s no further change was tried; --time-limit takes longer"));
    }
    let verdict = found.verdict(&setup);
    Ok((found, verdict))
}

/// So long (s) changes are looked for.
fn limit_s(settings: &ExplainSettings, setup: &Setup) -> f64 {
    settings.time_limit_s.or(setup.patience()).unwrap_or(PATIENCE_S)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::*;
    use crate::Unwatched;

    /// Stops once changes are looked for.
    #[derive(Default)]
    struct Impatient(AtomicBool);

    impl Watch for Impatient {
        fn stopped(&self) -> bool {
            self.0.load(Ordering::Relaxed)
        }

        fn progress(&self, what: &'static str, _done: usize, _of: usize) {
            self.0.fetch_or(what == KEYS, Ordering::Relaxed);
        }
    }

    /// Minutes of searches went by without a word, and what they had found was lost to who stopped them.
    #[test]
    fn who_is_stopped_tells_what_was_found_so_far() {
        let sets = vec![("generate.limits.tilt_deg".into(), "2".into())];
        let steep = ExplainSettings { scenario: "rover".into(), sets, graphs: 1, ..ExplainSettings::default() };
        let watch = Impatient::default();
        let (found, verdict) = explain(&steep, &watch).unwrap();
        assert!(watch.stopped() && found.stopped && found.changes.is_empty(), "{found:?}");
        assert!(found.losses.asked > 0, "{found:?}");
        assert!(
            verdict.exit_code == 3 && verdict.sentence.ends_with("smallest change: not found in time"),
            "{verdict:?}"
        );
        let setup = setup_for("rover", &[]).unwrap();
        assert_eq!(limit_s(&steep, &setup), PATIENCE_S);
        assert_eq!(limit_s(&ExplainSettings { time_limit_s: Some(1.0), ..steep }, &setup), 1.0);
        let told = Impatient(true.into());
        let stopped = explain(&ExplainSettings { scenario: "rover".into(), ..ExplainSettings::default() }, &told);
        assert!(matches!(stopped, Err(Problem::Interrupted(why)) if why.contains("of 8 graphs")));
    }

    #[test]
    fn what_is_feasible_is_told_as_such() {
        let settings = ExplainSettings { scenario: "demo-quadrotor".into(), graphs: 1, ..ExplainSettings::default() };
        let (found, verdict) = explain(&settings, &Unwatched).unwrap();
        assert_eq!(verdict.exit_code, 0, "{verdict:?}");
        assert!(found.losses.left > 0 && found.losses.asked >= found.losses.left);
    }
}
