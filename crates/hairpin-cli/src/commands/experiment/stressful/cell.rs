//! One way to generate: a scenario of the paper's with some of its keys changed, its cases, and what they come to.

use hairpin::campaign::experiment::lift::Flown;
use hairpin::campaign::learn::{KeptModel, ScoreModel, learn, leg_samples};
use hairpin::campaign::{self, Case, Known, Scenario, Setup, Stop};
use hairpin::judgement::Stress;
use hairpin_formats::scenario::scenario_for;
use rayon::prelude::*;

use crate::interrupt;
use crate::problem::Problem;

/// The shipped scenario that cells of FlightGoggles' quadrotor start from.
pub(super) const FLIGHT_GOGGLES: &str = "paper-minimum-snap";
/// The one of the Anafi's stand-in.
pub(super) const ANAFI: &str = "paper-anafi";

/// Dotted keys and TOML values.
pub(super) type Sets<'a> = &'a [(&'a str, String)];

/// The shipped `scenario` with `sets`, and with a learned score if there is a model.
pub(super) fn setup(scenario: &str, sets: Sets, model: Option<&ScoreModel>) -> Result<Setup, Problem> {
    let sets: Vec<(String, String)> = sets.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    let mut scenario = scenario_for(scenario, &sets)?;
    if let (Scenario::Flight(flight), Some(model)) = (&mut scenario, model) {
        flight.generate.score = KeptModel::score();
        flight.generate.model = Some(KeptModel { model: model.clone().into(), bytes: [].into() });
    }
    Ok(Setup::new(scenario)?)
}

fn stop() -> Stop<'static> {
    Stop { cancelled: &interrupt::asked, ..Stop::never() }
}

/// All cases that `setup` asks for, as many as its graphs give.
pub(super) fn cases(setup: &Setup) -> Result<Vec<Case>, Problem> {
    let mut cases = Vec::new();
    let _ = campaign::generate(setup, &Known::default(), &stop(), &mut |new, _| cases.extend_from_slice(new));
    super::super::go_on()?;
    Ok(cases)
}

/// The `stress` that `cases` come to under `setup`.
pub(super) fn flown(setup: &Setup, cases: &[Case], stress: Stress) -> Result<Flown, Problem> {
    Flown::of(setup, cases, stress, &stop()).ok_or(Problem::Interrupted("interrupted: nothing was written".into()))
}

/// A model of the largest deviation per leg, learned from one nominal run of each of `cases`.
pub(super) fn model(setup: &Setup, cases: &[Case]) -> Result<ScoreModel, Problem> {
    let samples: Vec<Vec<_>> = cases
        .par_iter()
        .map(|case| leg_samples(setup, case, &[campaign::execute_run(setup, case, 0)], Stress::MaxDeviation))
        .collect();
    super::super::go_on()?;
    learn(setup, Stress::MaxDeviation, &samples.concat()).map_err(Problem::input)
}
