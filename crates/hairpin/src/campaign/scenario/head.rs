//! What jobs ask of every scenario, whatever moves in it: each kind answers once, in a file of its own.

use std::any::Any;
use std::collections::BTreeMap;

use serde_json::Value;

use super::{
    Asked, Distribution, Environment, Mistake, Named, Origin, Projected, Record, SearchMethod, SearchSection, Subject,
    Target, Terms,
};
use crate::judgement::Stress;
use crate::trajectory::program::{Tool, WorkObject};

/// Who executes a campaign's trajectories, and how often.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Executor<'a> {
    /// A program that speaks the executor protocol; `None`: our own simulator.
    pub command: Option<&'a str>,
    /// Runs per case.
    pub repeat: u64,
    /// Wall-clock limit per mission of `command` or of a controller of the user's, s.
    pub timeout: f64,
    /// Turns of a controller of the user's in a second, where it is given.
    pub control_rate: Option<f64>,
    /// Processes of `command`.
    pub processes: Option<u64>,
    /// A waypoint counts as reached inside this radius, m.
    pub accept: f64,
    /// Further runs of every violation, with other noise.
    pub reruns: u64,
    /// Of which runs the motion is kept.
    pub record: Record,
    /// Random feasible cases that are flown beside those of the campaign.
    pub baseline: u64,
    /// When a run is given up.
    pub patience: Patience,
}

/// Wall-clock limit per mission of a program of the user's where the scenario names none, s.
pub(in crate::campaign) const TIMEOUT_S: f64 = 60.0;

/// Random feasible cases where the scenario does not say how many.
pub(in crate::campaign) const BASELINE: u64 = 20;

/// Confidence of intervals where the spec names none.
const CONFIDENCE: f64 = 0.95;

/// When a run is given up: after a time that is given, else after what it may be expected to take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patience {
    /// `execute.time_limit_s`.
    pub given: Option<f64>,
    /// s for each waypoint.
    pub per_waypoint: f64,
    /// Multiple of the planned duration.
    pub of_plan: f64,
    /// s beside these.
    pub spare: f64,
}

impl Patience {
    /// Time limit (s) of a run over so many waypoints that is planned to take `planned` s, and may take `slowest` s.
    pub fn time_limit(&self, waypoints: usize, planned: f64, slowest: f64) -> f64 {
        let expected = self.per_waypoint * waypoints as f64 + self.of_plan * planned + self.spare;
        self.given.unwrap_or(expected.max(slowest))
    }
}

/// What scenarios of all kinds say, under one name each.
#[derive(Debug, Clone)]
pub struct Head<'a> {
    /// Root seed of the campaign.
    pub seed: u64,
    /// Waypoints of a trajectory, both ends included; `None` where they are as many as load the robot most.
    pub length: Option<u64>,
    /// How graphs are searched.
    pub search: SearchSection,
    /// The score's name.
    pub score: &'a str,
    /// The key that says it.
    pub score_key: &'static str,
    /// The score where the scenario gives none; `None` where every method reads what is given.
    pub usual_score: Option<&'static str>,
    /// The key that says how many cases are asked for.
    pub cases_key: &'static str,
    /// The word of the reach set, or of what is proven clear.
    pub reach: &'static str,
    /// Who executes, and how often.
    pub executor: Executor<'a>,
    /// The word of the controller that executes, ours or the user's; `None` where a command does.
    pub controller: Option<&'a str>,
    /// Where on Earth the world stands.
    pub origin: Option<Origin>,
    /// Distributions, by key.
    pub vary: &'a BTreeMap<String, Distribution>,
    /// Share of cases that may violate the limits.
    pub violation_share: Option<f64>,
    /// Confidence of the share's interval, where one is given.
    pub confidence: Option<f64>,
    /// What a run is judged by.
    pub terms: Terms,
    /// What is asked of its runs.
    pub asked: Asked,
    /// Keys of the limits that there are.
    pub limits: &'static [&'static str],
    /// Longest leg that its plans can have, s.
    pub longest_leg: f64,
    /// Keys of an environment that act on what moves.
    pub surroundings: &'static [&'static str],
    /// Whether all cases come from one search, which begins anew where it was stopped.
    pub one_search: bool,
}

/// The keys of one kind of robot's scenarios.
pub trait Keys: Any {
    /// What it has in common with all others.
    fn head(&self) -> Head<'_>;

    /// Whose legs it is about.
    fn subject(&self) -> Subject;

    /// Distributions for changes.
    fn vary_mut(&mut self) -> &mut BTreeMap<String, Distribution>;

    /// Executes with the noise of the robot's own densities; where a simulator always has noise, nothing changes.
    fn set_noisy(&mut self);

    /// Takes over who executes and what is within spec from a scenario of its kind; noise and force, which no
    /// controller chooses, stay. `None`, and nothing is taken over: it is of another kind.
    fn adopt(&mut self, now: &dyn Keys) -> Option<()>;

    /// Puts what was searched beside the waypoints into the world, and leaves nothing to be searched for there.
    fn surround(&mut self, environment: &Environment);

    /// Writes what is in force where a key is left out and resolved scenarios say it.
    fn write_defaults(&mut self);

    /// The keys that name files.
    fn named(&mut self) -> Named<'_>;

    /// The tool and the work object that programs of its arm find on the controller where they do not declare them;
    /// `None` where there are no programs.
    fn frames(&self) -> Option<(Tool, WorkObject)> {
        None
    }

    /// How far off its path (mm) a run may be for what is proven clear of its plan to hold of it; `None` where nothing
    /// is proven of what runs do.
    fn clear_within_mm(&self) -> Option<f64> {
        None
    }

    /// The value of a key of the whole, such as `world`; `None` where it has no such key.
    fn section(&self, name: &str) -> Option<Value>;

    /// Puts another value there.
    ///
    /// # Errors
    /// No such key; a value of another shape.
    fn put_section(&mut self, name: &str, value: Value) -> serde_json::Result<()>;

    /// Root seed of the campaign.
    fn seed(&self) -> u64 {
        self.head().seed
    }

    /// Waypoints of a trajectory, both ends included; `None` where they are as many as load the robot most.
    fn length(&self) -> Option<u64> {
        self.head().length
    }

    /// How graphs are searched.
    fn search(&self) -> SearchSection {
        self.head().search
    }

    /// The score's name.
    fn score(&self) -> &str {
        self.head().score
    }

    /// The key of [`Self::score`].
    fn score_key(&self) -> &'static str {
        self.head().score_key
    }

    /// The word of the reach set, or of what is proven clear.
    fn reach(&self) -> &'static str {
        self.head().reach
    }

    /// Who executes, and how often.
    fn executor(&self) -> Executor<'_> {
        self.head().executor
    }

    /// Random cases that the campaign is compared with. With a command, which may be slow, the method `worst` flies
    /// them out of its budget, and at most half of that goes to them.
    fn baseline_cases(&self) -> u64 {
        let executor = self.executor();
        match self.pays_for_its_baseline() {
            true => executor.baseline.min(self.search().pooled_executions() / (2 * executor.repeat.max(1))),
            false => executor.baseline,
        }
    }

    /// Executions that the pool of the method `worst` has for its search.
    fn searched_executions(&self) -> u64 {
        let baseline = if self.pays_for_its_baseline() { self.baseline_cases() * self.executor().repeat } else { 0 };
        self.search().pooled_executions() - baseline
    }

    /// Whether the random cases are flown out of the search's budget: a time is a budget of the search alone.
    fn pays_for_its_baseline(&self) -> bool {
        let search = self.search();
        self.executor().command.is_some() && search.method == SearchMethod::Worst && search.seconds.is_none()
    }

    /// The word of the controller that executes, ours or the user's; `None` where a command does.
    fn controller(&self) -> Option<&str> {
        self.head().controller
    }

    /// Where on Earth the world stands.
    fn origin(&self) -> Option<Origin> {
        self.head().origin
    }

    /// The plane of the Earth that its map lies in, where it has one.
    fn projected(&self) -> Option<Projected> {
        None
    }

    /// What the plane of its map is called whose metres are taken for the ground's, as its projection is not known.
    fn unknown_plane(&self) -> Option<&str> {
        None
    }

    /// Distributions, by key.
    fn vary(&self) -> &BTreeMap<String, Distribution> {
        self.head().vary
    }

    /// Share of cases that may violate the limits.
    fn violation_share(&self) -> Option<f64> {
        self.head().violation_share
    }

    /// Confidence of the share's interval, where one is given.
    fn confidence(&self) -> Option<f64> {
        self.head().confidence
    }

    /// Confidence of all intervals that are told of its cases, runs and draws: that of the spec, 0.95 where it says
    /// none.
    fn confidence_of_intervals(&self) -> f64 {
        self.confidence().unwrap_or(CONFIDENCE)
    }

    /// Limit of the deviation, m.
    fn deviation_limit(&self) -> Option<f64> {
        self.head().terms.limits.deviation
    }

    /// What is asked of its runs.
    fn asked(&self) -> Asked {
        self.head().asked
    }

    /// Whether it says what its runs are judged by, be it nothing.
    ///
    /// # Errors
    /// `spec`, without a limit and without the word for none.
    fn check_asked(&self) -> Result<(), Mistake> {
        if self.asked() != Asked::Unsaid {
            return Ok(());
        }
        let value = self.section("spec").map_or("{}".into(), |spec| spec.to_string());
        let bound = format!(
            "a table with at least one of {}; or \"none\" (spec = \"none\"), which judges nothing but crashes: what asks for nothing \
             would pass whatever happens",
            self.head().limits.join(", ")
        );
        Err(Mistake { key: "spec".into(), value, bound })
    }

    /// What is searched for as it is measured beside all other cases: the target or the stress, and where the method
    /// `worst` searches for the only limit of `[spec]`, what that bounds.
    ///
    /// Of several limits, and of a target of the user's, the usual stress.
    fn sought(&self) -> Stress {
        let Head { search, terms, .. } = self.head();
        let by_limits = search.method == SearchMethod::Worst && search.target.is_none();
        match terms.limited()[..] {
            [(only, _)] if by_limits && search.stress == Stress::default() => only,
            _ => search.target.as_ref().and_then(Target::stress).unwrap_or(search.stress),
        }
    }

    /// Whether trajectories are executed while they are searched for.
    fn executes(&self) -> bool {
        self.search().executes(self.score())
    }

    /// Whether it can be searched as it asks for: what executes in the loop is a controller of ours or a command.
    /// Trajectories that are there already are anybody's to execute.
    ///
    /// # Errors
    /// The method of search, or the score.
    fn check_search(&self) -> Result<(), Mistake> {
        if !self.executes() || self.controller().is_some() || self.executor().command.is_some() {
            return Ok(());
        }
        let method = self.search().method;
        let (key, value) = match method.executes() {
            true => ("generate.search.method", serde_json::to_string(&method).unwrap_or_default()),
            false => (self.score_key(), format!("\"{}\"", self.score())),
        };
        let bound =
            "another one, or execute.controller or execute.command given: recordings are not executed in the loop";
        Err(Mistake { key: key.into(), value, bound: bound.into() })
    }

    /// Whether its method reads its score, which the user gave as `given`. Resolved scenarios say the usual one of any
    /// method.
    ///
    /// # Errors
    /// The score: what is found would be the same without.
    fn check_score(&self, given: &str) -> Result<(), Mistake> {
        let Head { score_key, usual_score, search, .. } = self.head();
        if search.method.reads_scores() || usual_score.is_none_or(|usual| usual == given) {
            return Ok(());
        }
        let bound = format!(
            "left out, or generate.search.method one of \"beam\", \"exact\", \"in-loop\", which search by a score (\"uniform\" tells it of \
             what it draws): the method `{}` reads none",
            search.method.word()
        );
        Err(Mistake { key: score_key.into(), value: format!("\"{given}\""), bound })
    }
}
