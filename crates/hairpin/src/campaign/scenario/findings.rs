//! What checks of scenarios find, and the few questions that most keys are asked.

use super::{Mistake, SearchMethod, SearchSection};
use crate::campaign::UserScore;
use crate::campaign::learn::{KeptModel, Subject};
use crate::judgement::Stress;

/// Each is tried against every leg for every execution.
const MOST_PLACED: u64 = 100;

/// The mistakes found so far, with the few questions that most keys are asked.
#[derive(Default)]
pub(super) struct Findings(pub(super) Vec<Mistake>);

impl Findings {
    /// The first keys of every scenario.
    pub(super) fn head(&mut self, format: u32, seed: u64) {
        self.require(format == 1, "hairpin", format, "1, the only scenario format there is");
        // TOML's whole numbers end here: a campaign's scenario file must hold its seed.
        self.count("seed", seed, 0, i64::MAX as u64);
    }

    pub(super) fn add(&mut self, mistake: Mistake) {
        self.0.push(mistake);
    }

    pub(super) fn require(&mut self, fine: bool, key: &str, value: impl ToString, bound: &str) {
        if !fine {
            self.add(Mistake { key: key.into(), value: value.to_string(), bound: bound.into() });
        }
    }

    pub(super) fn count(&mut self, key: &str, value: u64, least: u64, most: u64) {
        self.require((least..=most).contains(&value), key, value, &format!("{least} … {}", grouped(most)));
    }

    /// `least` itself is allowed.
    pub(super) fn from(&mut self, key: &str, value: f64, least: f64, most: f64, unit: &str) {
        let bound = format!("≥ {least} and ≤ {most}{unit}");
        self.require(value >= least && value <= most, key, value, &bound);
    }

    /// `least` itself is not allowed.
    pub(super) fn above(&mut self, key: &str, value: f64, least: f64, most: f64, unit: &str) {
        let bound = format!("> {least} and ≤ {most}{unit}");
        self.require(value > least && value <= most, key, value, &bound);
    }

    /// Whether a score that a model is asked for has one, of the legs of `subject`.
    pub(super) fn model(&mut self, key: &str, score: &str, model: Option<&KeptModel>, subject: impl Fn() -> Subject) {
        let value = format!("\"{}\"", model.map_or(score, |kept| &kept.given));
        match model.map(|kept| kept.model.check(&subject())) {
            Some(Ok(())) => {}
            Some(Err(mistake)) => {
                self.require(false, key, value, &format!("a model of this scenario's legs: {mistake}"));
            }
            None => self.require(false, key, value, "read with its scenario"),
        }
    }

    /// Whether a score of the user's own was read.
    pub(super) fn user_score(&mut self, key: &str, score: &str, user: Option<&UserScore>) {
        self.require(user.is_some(), key, format!("\"{score}\""), "read with its scenario");
    }

    /// Whether rounds can learn. `score`: the key of the score, and its value.
    pub(super) fn rounds<'k>(
        &mut self,
        method: SearchMethod,
        (score, value): (&str, &str),
        mut varied: impl Iterator<Item = &'k String>,
    ) {
        if method == SearchMethod::Adaptive {
            let bound = "one of those that have names: the method `adaptive` learns its own, from its own executions";
            let free = KeptModel::file_of(value).is_none() && UserScore::file_of(value).is_none();
            self.require(free, score, format!("\"{value}\""), bound);
            if let Some(varied) = varied.find(|key| key.starts_with("task.") || key.starts_with("generate.")) {
                let bound = format!("another one, or `{varied}` not varied: rounds learn from cases of one plan");
                self.require(false, "generate.search.method", "\"adaptive\"", &bound);
            }
        }
    }

    /// Whether `generate.environment` is searched, and for something: `some`, or else `keys` are to be given.
    pub(super) fn environment(&mut self, search: &SearchSection, some: bool, keys: &str) {
        let key = "generate.environment";
        let in_loop = search.method == SearchMethod::InLoop;
        self.require(in_loop, key, "given", "left out: only the method `in-loop` searches the environment");
        self.require(some, key, "{}", &format!("given {keys}"));
    }

    /// Whether `count` obstacles of an environment are for the stress that is searched; `execution`: a flight or a
    /// drive.
    pub(super) fn placed(&mut self, search: &SearchSection, count: u64, execution: &str) {
        let key = "generate.environment.obstacles";
        let bound = format!(
            "left out, or generate.search.stress = \"clearance\": obstacles do nothing else to a {execution} but end it"
        );
        self.require(search.stress == Stress::Clearance, key, "given", &bound);
        self.count(&format!("{key}.count"), count, 1, MOST_PLACED);
        let least = search.per_graph.saturating_mul(2).saturating_add(1 + search.confirm);
        let bound = format!(
            "≥ {least} with obstacles: two for each of the generate.search.per_graph trajectories that they are put around, and one to \
             find a trajectory"
        );
        self.require(search.executions >= least, "generate.search.executions", search.executions, &bound);
    }

    /// Whether a search that executes is for a stress that `execution`, a flight or a drive, is measured by.
    pub(super) fn stress(&mut self, stress: Stress, measured: bool, execution: &str) {
        let bound = format!("a stress that a {execution} is measured by");
        self.require(measured, "generate.search.stress", format!("\"{}\"", stress.word()), &bound);
    }

    /// Whether what is searched under `key` stands nowhere else: given in its own place, or varied there.
    pub(super) fn searched_alone(&mut self, key: &str, value: f64, given: bool, place: &str) {
        let bound = format!("left out: what is searched takes the place of what is given in {place} or varied");
        self.require(!given, key, value, &bound);
    }
}

/// `1000000` as `1 000 000`, which can be read.
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}
