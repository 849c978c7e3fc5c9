//! What checks of scenarios find, and the few questions that most keys are asked.

use std::collections::BTreeMap;
use std::fmt::Display;

use crate::campaign::attachments::Attachments;
use crate::campaign::digits::grouped;
use crate::campaign::scenario::{
    CONTROLLER_KEY, Distribution, FlakySection, Head, KeyPath, LEARNED, Mistake, Origin, PYTHON, SearchMethod,
    SearchSection, Steering, Subject, TARGET_KEY, Target,
};
use crate::judgement::Stress;

/// Each is tried against every leg for every execution.
///
/// Of obstacles of one environment.
const MOST_PLACED: u64 = 100;

/// The mistakes found so far, with the few questions that most keys are asked.
///
/// In the order in which they were found, which is that of the file. Empty: nothing is wrong.
#[derive(Default)]
pub(in crate::campaign) struct Findings(pub(in crate::campaign) Vec<Mistake>);

impl Findings {
    /// The first keys of every scenario.
    ///
    /// `hairpin` = 1; seed 0 … 2⁶³ − 1.
    pub(in crate::campaign) fn head(&mut self, format: u32, seed: u64) {
        self.require(format == 1, "hairpin", format, "1, the only scenario format there is");
        // TOML's whole numbers end here: a campaign's scenario file must hold its seed.
        self.count("seed", seed, 0, i64::MAX as u64);
    }

    pub(in crate::campaign) fn add(&mut self, mistake: Mistake) {
        self.0.push(mistake);
    }

    /// One mistake, with the value as it was given, unless `fine`.
    ///
    /// `bound` says in words what the value must be; it is told after "must be".
    pub(in crate::campaign) fn require(&mut self, fine: bool, key: &str, value: impl ToString, bound: &str) {
        if !fine {
            self.add(Mistake { key: key.into(), value: value.to_string(), bound: bound.into() });
        }
    }

    /// Keys of `[vary]` that no run reads, each with what `unread` says why: what they were drawn for never saw them,
    /// and the verdict would count draws that are none.
    pub(in crate::campaign) fn drawn_for_nobody<Why: Display>(
        &mut self,
        vary: &BTreeMap<String, Distribution>,
        unread: impl Fn(&KeyPath) -> Option<Why>,
    ) {
        for key in vary.keys() {
            let Some(why) = KeyPath::parse(key).and_then(|path| unread(&path)) else { continue };
            let (place, bound) = (KeyPath::of(&["vary", key]).to_string(), format!("a key that runs read: {why}"));
            self.add(Mistake { key: place, value: format!("\"{key}\""), bound });
        }
    }

    /// Both ends are allowed.
    ///
    /// The message has thousands grouped: 1 … 1 000 000.
    pub(in crate::campaign) fn count(&mut self, key: &str, value: u64, least: u64, most: u64) {
        self.require((least..=most).contains(&value), key, value, &format!("{least} … {}", grouped(most)));
    }

    /// `least` itself is allowed.
    ///
    /// NaN is refused.
    pub(in crate::campaign) fn from(&mut self, key: &str, value: f64, least: f64, most: f64, unit: &str) {
        let bound = format!("≥ {least} and ≤ {most}{unit}");
        self.require(value >= least && value <= most, key, value, &bound);
    }

    /// `least` itself is not allowed.
    ///
    /// NaN is refused; `most` is allowed.
    pub(in crate::campaign) fn above(&mut self, key: &str, value: f64, least: f64, most: f64, unit: &str) {
        let bound = format!("> {least} and ≤ {most}{unit}");
        self.require(value > least && value <= most, key, value, &bound);
    }

    /// `Ok`'s value; what is wrong is one of the mistakes.
    pub(in crate::campaign) fn take<T>(&mut self, built: Result<T, Mistake>) -> Option<T> {
        built.map_err(|mistake| self.add(mistake)).ok()
    }

    /// `world.origin`: degrees, and metres above mean sea level.
    ///
    /// Latitude ± 90°, longitude ± 180°, altitude −1 … 20 km, heading of the x axis 0 … 360°, all ends allowed.
    pub(in crate::campaign) fn origin(&mut self, origin: &Origin) {
        self.from("world.origin.lat_deg", origin.lat_deg, -90.0, 90.0, "°");
        self.from("world.origin.lon_deg", origin.lon_deg, -180.0, 180.0, "°");
        self.from("world.origin.alt_amsl_m", origin.alt_amsl_m, -1000.0, 20_000.0, " m");
        self.from("world.origin.x_axis_heading_deg", origin.x_axis_heading_deg, 0.0, 360.0, "°");
    }

    /// Who executes: a controller or `execute.command`, not both; and how often one of the user's is asked.
    ///
    /// Rates lie in 1 … 1000 Hz and are given with a controller of the user's alone.
    pub(in crate::campaign) fn who<K>(
        &mut self,
        controller: Option<&Steering<K>>,
        rate: Option<f64>,
        command: Option<&str>,
    ) {
        let users = Steering::users(controller);
        if let Some(rate) = rate {
            let (key, bound) = ("execute.control_rate_hz", "left out where no controller of yours steers");
            self.require(users.is_some(), key, rate, bound);
            self.from(key, rate, 1.0, 1000.0, " Hz");
        }
        if let Some(users) = users {
            let what = users.file().or(users.command()).unwrap_or_default();
            let (given, bound) = (format!("\"{}\"", users.word()), "python:FILE or command:CMD");
            self.require(!what.trim().is_empty(), CONTROLLER_KEY, given, bound);
        }
        let Some(command) = command else { return };
        let (key, given) = ("execute.command", format!("\"{command}\""));
        self.require(controller.is_none(), key, &given, "left out where `controller` is given: one of the two");
        self.require(!command.trim().is_empty(), key, &given, "a program and its arguments");
    }

    /// How many processes of a command run side by side, by either name.
    ///
    /// 1 … 1024.
    pub(in crate::campaign) fn processes(&mut self, processes: Option<u64>, workers: Option<u64>) {
        for (key, count) in [("execute.processes", processes), ("execute.workers", workers)] {
            if let Some(count) = count {
                self.count(key, count, 1, 1024);
            }
        }
        let twice = workers.filter(|_| processes.is_some());
        let bound = "left out where `processes` is given, of which it is the older name";
        self.require(twice.is_none(), "execute.workers", twice.unwrap_or_default(), bound);
    }

    /// The share of violations that `table` allows lies in [0, 1), its confidence in [0.5, 1).
    pub(in crate::campaign) fn share(&mut self, table: &str, share: Option<f64>, confidence: Option<f64>) {
        if let Some(share) = share {
            let key = format!("{table}.violation_share");
            self.require((0.0..1.0).contains(&share), &key, share, "≥ 0 and < 1");
        }
        if let Some(confidence) = confidence {
            let (key, fine) = (format!("{table}.confidence"), (0.5..1.0).contains(&confidence));
            self.require(fine, &key, confidence, "≥ 0.5 and < 1, such as 0.95");
        }
    }

    /// `execute.repeat`.
    pub(in crate::campaign) fn repeat(&mut self, runs: Option<u64>) {
        if let Some(runs) = runs {
            self.count("execute.repeat", runs, 1, 100_000);
        }
    }

    /// `execute.flaky`.
    pub(in crate::campaign) fn flaky(&mut self, section: Option<FlakySection>) {
        if let Some(section) = section {
            self.count("execute.flaky.reruns", section.reruns, 1, 100_000);
        }
    }

    /// `execute.baseline`.
    pub(in crate::campaign) fn baseline(&mut self, cases: Option<u64>) {
        if let Some(cases) = cases {
            self.count("execute.baseline", cases, 0, 100_000);
        }
    }

    /// Whether a target of the user's own was read.
    pub(in crate::campaign) fn target_of_file(&mut self, target: Option<&Target>, attachments: &Attachments) {
        if let Some(Target::Python(_)) = target {
            let value = format!("\"{}\"", target.map(Target::word).unwrap_or_default());
            self.require(attachments.user_target(target).is_some(), TARGET_KEY, value, "read with its scenario");
        }
    }

    /// Whether a score that a file tells was read: a model, which must be of the legs of `subject`, or one of the
    /// user's own. `false` where `score` names no file.
    ///
    /// `true` says that the score is one of a file, whether or not it was right: no other question about it is left.
    pub(in crate::campaign) fn score_of_file(
        &mut self,
        key: &str,
        score: &str,
        attachments: &Attachments,
        subject: impl Fn() -> Subject,
    ) -> bool {
        if score.starts_with(PYTHON) {
            let read = attachments.user_score(score).is_some();
            self.require(read, key, format!("\"{score}\""), "read with its scenario");
            return true;
        }
        if !score.starts_with(LEARNED) {
            return false;
        }
        match attachments.model(score) {
            Some(model) => {
                if let Err(mistake) = model.read.check(&subject()) {
                    let bound = format!("a model of what this scenario executes: {mistake}");
                    self.require(false, key, format!("\"{}\"", model.given), &bound);
                }
            }
            None => self.require(false, key, format!("\"{score}\""), "read with its scenario"),
        }
        true
    }

    /// Whether rounds can learn. `score`: the key of the score, and its value.
    ///
    /// Only of the method `adaptive`: its score has a name, and nothing is varied that shapes plans.
    pub(in crate::campaign) fn rounds<'k>(
        &mut self,
        method: SearchMethod,
        (score, value): (&str, &str),
        mut varied: impl Iterator<Item = &'k String>,
    ) {
        if method == SearchMethod::Adaptive {
            let bound = "one of those that have names: the method `adaptive` learns its own, from its own executions";
            let free = !value.starts_with(LEARNED) && !value.starts_with(PYTHON);
            self.require(free, score, format!("\"{value}\""), bound);
            if let Some(varied) = varied.find(|key| key.starts_with("task.") || key.starts_with("generate.")) {
                let bound = format!("another one, or `{varied}` not varied: rounds learn from cases of one plan");
                self.require(false, "generate.search.method", "\"adaptive\"", &bound);
            }
        }
    }

    /// Whether `generate.environment` is searched, and for something: `some`, or else `keys` are to be given.
    pub(in crate::campaign) fn environment(&mut self, search: &SearchSection, some: bool, keys: &str) {
        let key = "generate.environment";
        let in_loop = search.method == SearchMethod::InLoop;
        self.require(in_loop, key, "given", "left out: only the method `in-loop` searches the environment");
        self.require(some, key, "{}", &format!("given {keys}"));
    }

    /// Whether `count` obstacles of an environment are for the stress that is searched; `execution`: a flight or a
    /// drive.
    ///
    /// At most 100, and executions for them: 2 per trajectory of a graph, one to find it, and those that confirm.
    pub(in crate::campaign) fn placed(&mut self, search: &SearchSection, count: u64, execution: &str) {
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

    /// Whether a search that executes is for what an `execution`, a flight or a drive, is measured by: its target, its
    /// stress, or at least one of the limits that the method `worst` searches for. Where `near` is false there are none
    /// of the `things` that a clearance is measured from.
    ///
    /// Searches that execute nothing are not asked. A target of the user's own has no stress, and is taken as measured.
    pub(in crate::campaign) fn sought(
        &mut self,
        head: &Head<'_>,
        measured: &dyn Fn(Stress) -> bool,
        (execution, things, near): (&str, &str, bool),
    ) {
        let search = &head.search;
        if !search.executes(head.score) {
            return;
        }
        let (key, word, stress) = match &search.target {
            Some(target) => (TARGET_KEY, target.word(), target.stress()),
            None => ("generate.search.stress", search.stress.word().to_owned(), Some(search.stress)),
        };
        let given = format!("\"{word}\"");
        let bound = format!("another one, or {things} given: there is nothing to be near to");
        match stress {
            Some(Stress::Clearance) => self.require(near, key, given, &bound),
            Some(stress) => {
                self.require(measured(stress), key, given, &format!("a stress that a {execution} is measured by"));
            }
            None => {}
        }
        if search.method == SearchMethod::Worst && search.target.is_none() && !near {
            self.limited_nearness(head, things);
        }
    }

    /// Refuses a clearance as the only limit, and so as what the method `worst` searches for, where there are none of
    /// the `things` that it is measured from.
    ///
    /// The value told is the limit's own; among the terms a clearance has the opposite sign.
    fn limited_nearness(&mut self, head: &Head<'_>, things: &str) {
        if let [(Stress::Clearance, least)] = head.terms.limited()[..] {
            let key = head.limits.iter().find(|key| key.contains("clearance")).copied().unwrap_or("spec");
            let bound = format!("beside another limit, or {things} given: there is nothing to be near to");
            self.require(false, key, -least, &bound);
        }
    }

    /// Whether what is searched under `key` stands nowhere else: given in its own place, or varied there.
    pub(in crate::campaign) fn searched_alone(&mut self, key: &str, value: f64, given: bool, place: &str) {
        let bound = format!("left out: what is searched takes the place of what is given in {place} or varied");
        self.require(!given, key, value, &bound);
    }
}
