//! How a campaign is divided: into parts of whole units of work, the same for any number of machines.

use std::ops::Range;

use hairpin::campaign::Setup;
use hairpin::campaign::generate::{expected_before, has_rounds, sure_units};
use hairpin_formats::folder::PLAN;
use hairpin_formats::scenario::setup_for;
use hairpin_formats::{atomic, bounds, checksum};
use serde::{Deserialize, Serialize};

use crate::work::{self, CampaignSettings, Work};
use crate::{Problem, Watch};

/// Parts where nobody says how many, if there is as much to divide …
const PARTS: u64 = 64;
/// … and units of work of a part at most: what a kill may cost.
const MOST_UNITS: u64 = 1000;
/// Version of the file.
const FORMAT: u32 = 1;

/// What a campaign is planned with.
#[derive(Debug, Clone, Default)]
pub struct PlanSettings {
    /// As for one that begins on one machine.
    pub campaign: CampaignSettings,
    /// Cases asked for, instead of the scenario's.
    pub cases: Option<u64>,
    /// Into how many parts it is divided.
    pub parts: Option<u64>,
}

/// How a campaign is divided: `plan.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Version of the file.
    hairpin_plan: u32,
    /// Version of hairpin that makes the parts.
    pub version: String,
    /// Root seed.
    pub seed: u64,
    /// Cases asked for.
    pub cases: u64,
    /// What the work is counted in.
    pub unit: Unit,
    /// How many of it there are.
    pub units: u64,
    /// Into how many parts they are divided.
    pub parts: u64,
    /// SHA-256 of the scenario and of the files that it names.
    pub scenario: String,
    /// SHA-256 of all this.
    pub hash: String,
}

/// What the work of a search is counted in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Unit {
    /// Graphs that are searched one by one.
    Graph,
    /// Cases that are searched one by one.
    Case,
    /// One search, in which everything depends on all before it; and the runs of each case that it finds.
    Search,
    /// The same, of which all shards that run follow every round and execute a share of it.
    Rounds,
}

/// Divides the campaign of a scenario, whose folder is begun as on one machine.
///
/// # Errors
/// As of [`work::plan`]; more parts than there is work.
pub fn plan(settings: &PlanSettings, watch: &dyn Watch) -> Result<(Work, Plan), Problem> {
    let mut campaign = settings.campaign.clone();
    if let Some(cases) = settings.cases {
        let key = setup_for(&campaign.scenario, &campaign.sets)?.scenario.head().cases_key;
        campaign.sets.push((key.to_owned(), cases.to_string()));
    }
    let planned = work::plan(&campaign, watch)?;
    let plan = Plan::of(&planned.setup, settings.parts)?;
    let work = planned.begin()?;
    let file = work.folder.file(PLAN);
    if file.is_file() && Plan::read(&work).is_ok_and(|before| before.hash != plan.hash) {
        return Err(Problem::input(format!(
            "--resume: {} was divided otherwise: give the same arguments, or --force",
            work.folder.path().display()
        )));
    }
    atomic::write_json(&file, &plan)?;
    Ok((work, plan))
}

impl Plan {
    fn of(setup: &Setup, parts: Option<u64>) -> Result<Self, Problem> {
        let scenario = &setup.scenario;
        let sure = sure_units(scenario);
        // Of one search the runs of what it finds are by cases, each a unit beside it.
        let units = sure.unwrap_or_else(|| scenario.search().cases.saturating_add(1));
        let unit = match sure {
            None if has_rounds(scenario) => Unit::Rounds,
            None => Unit::Search,
            Some(_) if expected_before(scenario, 1) == 1 && units == scenario.search().cases && is_by_case(setup) => {
                Unit::Case
            }
            Some(_) => Unit::Graph,
        };
        let usual = units.min(PARTS).max(units.div_ceil(MOST_UNITS));
        let parts = parts.unwrap_or(usual);
        if parts == 0 || parts > units {
            let what = match unit {
                Unit::Search | Unit::Rounds => format!("it is one search, and the runs of {} cases", units - 1),
                Unit::Graph => format!("there are {units} graphs to search"),
                Unit::Case => format!("there are {units} cases to search for"),
            };
            return Err(Problem::input(format!("--parts {parts}: must be 1 to {units}: {what}")));
        }
        let mut plan = Self {
            hairpin_plan: FORMAT,
            version: env!("CARGO_PKG_VERSION").into(),
            seed: scenario.seed(),
            cases: scenario.search().cases,
            unit,
            units,
            parts,
            scenario: String::new(),
            hash: String::new(),
        };
        plan.scenario = scenario_hash(setup)?;
        plan.hash = plan.own_hash();
        Ok(plan)
    }

    /// The plan of the campaign in `work`.
    ///
    /// # Errors
    /// There is none; it is another version's; its scenario is not what it was.
    pub(super) fn read(work: &Work) -> Result<Self, Problem> {
        let (path, folder) = (work.folder.file(PLAN), work.folder.path().display());
        if !path.is_file() {
            return Err(Problem::input(format!("{folder} is not divided: hairpin plan SCENARIO --out DIR")));
        }
        let refuse = |why: String| Problem::of_file(&path, why);
        let text = bounds::read_json_text(&path).map_err(|cause| refuse(cause.to_string()))?;
        let plan: Self = serde_json::from_str(&text).map_err(|cause| refuse(cause.to_string()))?;
        let now = env!("CARGO_PKG_VERSION");
        if plan.version != now || plan.hairpin_plan != FORMAT {
            return Err(refuse(format!(
                "planned by hairpin {}, and this is {now}: all parts must be made by one version",
                plan.version
            )));
        }
        if plan.hash != plan.own_hash() || plan.parts == 0 || plan.parts > plan.units {
            return Err(refuse("it was changed: its hash is another".into()));
        }
        if plan.scenario != scenario_hash(&work.setup)? {
            return Err(Problem::input(format!(
                "the scenario of {folder} is not what it was when it was planned: its parts are of another campaign; \
                 hairpin plan … --force divides it anew"
            )));
        }
        Ok(plan)
    }

    /// What whoever planned has to know, in a sentence.
    pub fn told(&self) -> Option<String> {
        let told = match self.unit {
            Unit::Graph | Unit::Case => return None,
            Unit::Rounds => {
                "it is one search, in which each round depends on what was executed before: all shards that run share the \
                 executions of every round, and one that comes late or dies holds up none of the others"
            }
            Unit::Search => {
                "it is one search, in which everything depends on what was found before: shard 1 makes all of it, and the \
                 others fly what it finds, as far as it is there when they begin"
            }
        };
        Some(told.to_owned())
    }

    /// Whether it is one search, and the runs of what it finds.
    pub(super) fn is_one_search(&self) -> bool {
        matches!(self.unit, Unit::Search | Unit::Rounds)
    }

    fn own_hash(&self) -> String {
        let Self { hairpin_plan, version, seed, cases, unit, units, parts, scenario, hash: _ } = self;
        checksum::sha256(format!("{hairpin_plan} {version} {seed} {cases} {unit:?} {units} {parts} {scenario}"))
    }

    /// The units of part number `part`.
    pub(super) fn units_of(&self, part: u64) -> Range<u64> {
        dealt(self.units, self.parts, part)
    }

    /// Of one search, which of the cases that it finds part number `part` flies: those of the first part are flown by
    /// the others, if there are others.
    pub(super) fn flown_by(&self, part: u64) -> Range<u64> {
        match (self.parts, part) {
            (1, _) => 0..self.cases,
            (_, 0) => 0..0,
            (parts, part) => dealt(self.cases, parts - 1, part - 1),
        }
    }
}

/// What place `place` of `places` gets of `total`.
fn dealt(total: u64, places: u64, place: u64) -> Range<u64> {
    let until = |place: u64| (u128::from(total) * u128::from(place) / u128::from(places)) as u64;
    until(place)..until(place + 1)
}

/// Whether a unit is a case: `[vary]` shapes its plan.
fn is_by_case(setup: &Setup) -> bool {
    setup.scenario.vary().keys().any(|key| hairpin::campaign::scenario::shapes_the_plan(key))
}

/// Of all that the parts are made of: the scenario as it is kept, and what it names.
fn scenario_hash(setup: &Setup) -> Result<String, Problem> {
    let text = hairpin_formats::scenario::to_toml(&setup.scenario, None).map_err(Problem::input)?;
    let mut all = checksum::sha256(text);
    for (name, bytes) in setup.attachments.files() {
        all += name;
        all += &checksum::sha256(bytes);
    }
    Ok(checksum::sha256(all))
}
