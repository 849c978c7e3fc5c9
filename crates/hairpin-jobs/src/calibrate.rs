//! Limits that follow from what is ordinary: random feasible cases of their own, flown as the scenario's would be.

use std::sync::{Mutex, PoisonError};

use hairpin::campaign::calibrate::{self, LEAST, Outcome, Proposal};
use hairpin::campaign::generate::{ByChance, Purpose};
use hairpin::campaign::{Case, CaseNumber, Run, Setup};
use hairpin::judgement::cases_needed;
use hairpin::math::simd::Simd;
use hairpin_formats::scenario::{kept_in, setup_for, shadowed};

use crate::baseline::drawn;
use crate::consent::{Consent, Wish};
use crate::execute::fly_by_case;
use crate::sets::Set;
use crate::{Problem, Watch};

/// What the watch is told of.
const WHAT: &str = "calibrate";
/// Confidence of the limits' intervals.
const CONFIDENCE: f64 = 0.95;

/// What limits are for.
#[derive(Debug, Clone)]
pub struct CalibrateSettings {
    /// Scenario file, the name of a shipped scenario or robot, or a campaign folder's scenario.toml.
    pub scenario: String,
    /// Keys of the scenario with other values.
    pub sets: Vec<Set>,
    /// Share of random feasible cases that is to break each limit.
    pub share: f64,
    /// Cases that are flown; as many as the share takes, 200 at least, if not given.
    pub cases: Option<u64>,
    /// Version of the kernels.
    pub simd: Simd,
    /// What of a folder may run.
    pub consent: Consent,
}

impl Default for CalibrateSettings {
    fn default() -> Self {
        let (scenario, sets, cases, simd, consent) = Default::default();
        Self { scenario, sets, share: 0.05, cases, simd, consent }
    }
}

/// Limits, and what they follow from.
pub struct Calibrated {
    /// The scenario.
    pub setup: Setup,
    /// For every limit that it has or, where it has none, for the deviation.
    pub proposals: Vec<Proposal>,
    /// Cases that were flown.
    pub flown: usize,
    /// Of these, cases of which a run was not flown, or cannot be judged.
    pub lost: usize,
    /// Why the first run that was not flown was not, and by which program.
    pub trouble: Option<String>,
    /// Of these, cases of which a run left the world, a violation beside any limit.
    pub left_world: usize,
    /// Where fewer cases were found than were to be flown: why, in a sentence's part.
    pub reason: Option<String>,
}

/// Flies random feasible cases of the scenario and proposes the limits that the share breaks. Nothing is written.
///
/// # Errors
/// A scenario with mistakes, or whose runs are recordings; one of a campaign's folder that asks to run what its user
/// has not allowed; a program or controller of the user's that flew no case at all; it was asked to stop.
pub fn calibrate(settings: &CalibrateSettings, watch: &dyn Watch) -> Result<Calibrated, Problem> {
    shadowed(&settings.scenario).iter().for_each(|note| watch.warn(note));
    let setup = setup_for(&settings.scenario, &settings.sets)?.with_simd(settings.simd);
    if setup.recordings().is_some() {
        return Err(Problem::input("`execute.logs`: recordings cannot be made of random cases; leave it out"));
    }
    let (kept, wishes) = (kept_in(&settings.scenario), Wish::of_campaign(&setup));
    settings.consent.ask_of_scenario((&settings.scenario, kept.as_deref()), &wishes, &settings.sets, watch)?;
    let needed = cases_needed(settings.share, CONFIDENCE).unwrap_or(LEAST).max(LEAST) as u64;
    let wanted = settings.cases.unwrap_or(needed);
    let ByChance { cases, reason } = drawn(&setup, (Purpose::Limits, wanted), WHAT, watch)?;
    let unflown = Unflown::default();
    let made = |case: &Case, runs: &[Run]| {
        unflown.note(&setup, case, runs);
        calibrate::outcome(&setup, case, runs)
    };
    let outcomes = fly_by_case((&setup, None), &cases, &made, (WHAT, watch))?;
    let outcomes: Vec<Outcome> = outcomes.into_iter().flatten().collect();
    let trouble = unflown.trouble(cases.len())?;
    let proposals = calibrate::propose(&setup, &outcomes, settings.share);
    let left_world = outcomes.iter().filter(|outcome| outcome.left_world).count();
    let lost = cases.len() - outcomes.len();
    Ok(Calibrated { proposals, flown: cases.len(), lost, trouble, left_world, reason, setup })
}

/// Cases that have a run that was not flown, as they land.
#[derive(Default)]
struct Unflown(Mutex<Vec<(CaseNumber, bool, String)>>);

impl Unflown {
    /// Takes `case` in, where one of its runs was not flown.
    fn note(&self, setup: &Setup, case: &Case, runs: &[Run]) {
        let lost = |run: &Run| Some(setup.by_program(run.run, run.outcome.as_ref().err()?));
        if let Some(message) = runs.iter().find_map(lost) {
            let wholly = runs.iter().all(|run| run.outcome.is_err());
            self.0.lock().unwrap_or_else(PoisonError::into_inner).push((case.number, wholly, message));
        }
    }

    /// Why the first of them was not flown, whichever landed first.
    ///
    /// # Errors
    /// No run of any of all `cases` was flown.
    fn trouble(self, cases: usize) -> Result<Option<String>, Problem> {
        let all = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        let first = all.iter().min_by_key(|(case, ..)| *case);
        let first = first.map(|(case, _, message)| format!("case {case}, {message}"));
        match first {
            Some(message) if all.iter().filter(|(_, wholly, _)| *wholly).count() == cases => {
                Err(Problem::Executor(format!("none of {cases} random feasible cases was flown: {message}")))
            }
            first => Ok(first),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;
    use crate::testing::small_hull;

    #[test]
    fn limits_follow_from_random_cases() {
        let place = tempfile::tempdir().unwrap();
        let scenario = small_hull(place.path());
        let settings = CalibrateSettings { scenario, ..CalibrateSettings::default() };
        let found = calibrate(&settings, &Unwatched).unwrap();
        let [only] = found.proposals.as_slice() else { panic!("{:?}", found.proposals) };
        let ([low, high], value) = (only.interval.unwrap(), only.value.unwrap());
        assert!(0.0 < low && low <= value && value <= high, "{only:?}");
        assert_eq!((only.field, only.cases, found.flown, found.lost), ("spec.deviation.max_m", 200, 200, 0));
        // The same cases each time, and a larger share breaks a tighter limit.
        let again = calibrate(&settings, &Unwatched).unwrap();
        assert_eq!(again.proposals, found.proposals);
        let tighter = calibrate(&CalibrateSettings { share: 0.5, ..settings.clone() }, &Unwatched).unwrap();
        assert!(tighter.proposals[0].value.unwrap() < low, "{:?} {only:?}", tighter.proposals);
        let few = calibrate(&CalibrateSettings { cases: Some(20), ..settings }, &Unwatched).unwrap();
        assert_eq!((few.proposals[0].value, few.proposals[0].cases, few.trouble), (None, 20, None));
    }

    /// A program that flies nothing has failed: no limit follows, and that it did is told.
    #[test]
    fn a_program_that_is_dead_is_told() {
        let place = tempfile::tempdir().unwrap();
        let scenario = small_hull(place.path());
        let text = std::fs::read_to_string(&scenario).unwrap();
        std::fs::write(&scenario, text.replace("controller = \"stable-waypoint\"", "command = \"false\"")).unwrap();
        let settings = CalibrateSettings { scenario, cases: Some(3), ..CalibrateSettings::default() };
        let Err(Problem::Executor(told)) = calibrate(&settings, &Unwatched).map(|_| ()) else { panic!("it flew") };
        assert!(told.starts_with("none of 3 random feasible cases was flown: case 0000, "), "{told}");
        assert!(told.contains("`false`, run 0: "), "{told}");
    }
}
