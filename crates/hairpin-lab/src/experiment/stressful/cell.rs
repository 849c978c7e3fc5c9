//! One way to generate: a scenario of the paper's with some of its keys changed, its cases, and what they come to.

use hairpin::campaign::learn::{NAME, ScoreModel};
use hairpin::campaign::scenario::LEARNED;
use hairpin::campaign::{self, Attached, Attachments, Case, Known, Optimum, OwnSimulator, Resolved, Setup, generate};
use hairpin::judgement::Stress;
use hairpin::math::random::named_seed;
use hairpin_formats::scenario::setup_for;
use hairpin_jobs::{Problem, Watch};

use super::lift::Flown;
use crate::experiment::watched::{interrupted, watched};

/// The shipped scenario that cells of FlightGoggles' quadrotor start from.
pub(super) const FLIGHT_GOGGLES: &str = "paper-minimum-snap";
/// The one of the Anafi's stand-in.
pub(super) const ANAFI: &str = "paper-anafi";

/// Scores are learned in so many rounds, if each then has at least so many executions: what the round before taught
/// decides what a round executes, and many small rounds get farther than few large ones.
const ROUNDS: u64 = 15;
const LEAST_PER_ROUND: u64 = 13;
/// Trajectories per graph and round.
const PER_GRAPH_AND_ROUND: u64 = 3;

/// A dotted key and its TOML value.
pub(super) type Set = (&'static str, String);

/// A string in TOML.
pub(super) fn text(value: &str) -> String {
    format!("\"{value}\"")
}

/// `base`, and `sets` after it.
pub(super) fn with(base: &[Set], sets: &[Set]) -> Vec<Set> {
    [base, sets].concat()
}

/// Rotor speeds sampled per rotor: those of the authors' program for the authors' set, else those of the paper.
pub(super) fn resolution(reach: &str) -> Set {
    ("generate.resolution", if reach == "published" { "4" } else { "5" }.to_owned())
}

/// The shipped `scenario` with `sets`, and with a learned score if there is a model.
pub(super) fn setup(scenario: &str, sets: &[Set], model: Option<&ScoreModel>) -> Result<Setup, Problem> {
    let sets: Vec<(String, String)> = sets.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    let setup = setup_for(scenario, &sets)?;
    let Some(model) = model else { return Ok(setup) };
    let score = format!("{LEARNED}{NAME}");
    let mut scenario = setup.scenario;
    scenario.named().score.into_iter().for_each(|(_, named)| named.clone_from(&score));
    let model = Attached { read: model.clone().into(), bytes: [].into(), name: NAME.into(), given: score };
    let attachments = Attachments { model: Some(model), ..Attachments::default() };
    Ok(Setup::new(Resolved { scenario, attachments })?)
}

/// All cases that `setup` asks for, as many as its graphs give.
pub(super) fn cases(setup: &Setup, watch: &dyn Watch) -> Result<Vec<Case>, Problem> {
    let mut cases = Vec::new();
    watched(watch, |stop| {
        generate(setup, &Known::default(), &OwnSimulator, stop, &mut |new, _| cases.extend_from_slice(new))
    })?;
    Ok(cases)
}

/// The optima of the scores by hand called `names`, or of the one that `setup` has, in its graphs.
pub(super) fn optima(setup: &Setup, names: &[&str], watch: &dyn Watch) -> Result<Vec<Optimum>, Problem> {
    watched(watch, |stop| campaign::optima(setup, names, stop))?.map_err(Problem::input)
}

/// The setup that judges: the flights of `base` with noise, `runs` each.
pub(super) fn with_noise(scenario: &str, base: &[Set], runs: u64) -> Result<Setup, Problem> {
    setup(scenario, &with(base, &[("execute.noise", "true".into()), ("execute.repeat", runs.to_string())]), None)
}

/// What `cases` come to under `setup`, by each of `stresses`.
pub(super) fn flown<const N: usize>(
    setup: &Setup,
    cases: &[Case],
    stresses: [Stress; N],
    watch: &dyn Watch,
) -> Result<[Flown; N], Problem> {
    watched(watch, |stop| Flown::of(setup, cases, stresses, stop))?.ok_or_else(interrupted)
}

/// A model of the largest deviation per leg, learned in rounds from `executions` nominal runs of trajectories of other
/// graphs than those of `seed`: uniform ones at first, then mostly the worst ones that the model of the rounds before
/// knows of.
pub(super) fn learned(
    scenario: &str,
    base: &[Set],
    executions: u64,
    seed: u64,
    watch: &dyn Watch,
) -> Result<ScoreModel, Problem> {
    let rounds = (executions / LEAST_PER_ROUND).clamp(1, ROUNDS);
    let graphs = executions.div_ceil(rounds * PER_GRAPH_AND_ROUND);
    let sets = [
        ("seed", (named_seed(seed, "training", 0) >> 1).to_string()),
        ("generate.search.method", text("adaptive")),
        ("generate.search.aggregate", text("max")),
        ("generate.search.cases", graphs.to_string()),
        ("generate.search.executions", executions.to_string()),
        ("generate.search.rounds", rounds.to_string()),
    ];
    let setup = setup(scenario, &with(base, &sets), None)?;
    let tally = watched(watch, |stop| generate(&setup, &Known::default(), &OwnSimulator, stop, &mut |_, _| {}))?;
    let reason = || tally.unlearned.or(tally.nothing).unwrap_or_else(|| "no trajectory was executed".into());
    tally.model.map(|model| *model).ok_or_else(|| Problem::input(format!("nothing to learn from: {}", reason())))
}
