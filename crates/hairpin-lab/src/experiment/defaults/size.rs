//! How large the experiment is, and the cells that it has.

use hairpin::campaign::scenario::Target;
use hairpin::judgement::Stress;
use hairpin::math::random::named_seed;
use hairpin_jobs::Problem;
use serde::{Deserialize, Serialize};

use super::ways::Way;

/// What seeds are derived from where the sheet names nothing: the commit that the build was told of, or the version.
const BUILD: &str = match option_env!("HAIRPIN_COMMIT") {
    Some(commit) => commit,
    None => env!("CARGO_PKG_VERSION"),
};

/// Size of the experiment.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Size {
    /// Independent runs of a cell.
    pub(super) runs: usize,
    /// Cases of a run.
    pub(super) cases: usize,
    /// Executions for each case.
    pub(super) executions: u64,
    /// Default runs that are held against ten times their executions by chance.
    pub(super) pairs: usize,
    /// How many times their executions.
    pub(super) chance: u64,
    /// Fresh executions of what is kept.
    pub(super) fresh: usize,
    /// Random trajectories of a run that are executed afresh.
    pub(super) singles: usize,
    /// What is measured beside random trajectories.
    pub(super) ways: Vec<Way>,
    /// Pieces of names of cells: those that have one of them; all if there are none.
    pub(super) only: Vec<String>,
    /// What seeds are derived from; empty: the build.
    seed_of: String,
    families: Vec<Family>,
}

/// Robots and controllers in one scenario.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Family {
    /// A shipped one.
    scenario: String,
    /// What stands in names for the robot, where another family has the same one.
    name: Option<String>,
    robots: Vec<String>,
    controllers: Vec<String>,
    /// KEY=VALUE over the scenario.
    #[serde(default)]
    sets: Vec<String>,
    /// What is searched for; the deviation if nothing is said.
    #[serde(default = "deviation")]
    target: Target,
    /// Coordinates that a waypoint is moved in: three, two where heights are the ground's, none where points are given.
    #[serde(default = "in_space")]
    coordinates: usize,
    /// Whether random trajectories come from the search's own graphs.
    #[serde(default)]
    same_graphs: bool,
    /// The key of the seed of a ground that is drawn: each run has one of its own, on which the robot can begin.
    ground: Option<String>,
    /// In the place of the sheet's.
    ways: Option<Vec<Way>>,
    runs: Option<usize>,
    executions: Option<u64>,
    pairs: Option<usize>,
    /// Whether the mean over its cells is a row of its own, and by which name.
    mean: Option<String>,
}

fn deviation() -> Target {
    Target::Deviation
}

fn in_space() -> usize {
    3
}

/// A robot under a controller.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    /// `anafi/minimum-snap`.
    pub(super) name: String,
    pub(super) scenario: String,
    /// Keys and values over the scenario.
    pub(super) sets: Vec<(String, String)>,
    pub(super) target: Target,
    /// The target, as all ways are measured by it.
    pub(super) stress: Stress,
    pub(super) coordinates: usize,
    pub(super) same_graphs: bool,
    pub(super) ground: Option<String>,
    ways: Option<Vec<Way>>,
    runs: Option<usize>,
    executions: Option<u64>,
    pairs: Option<usize>,
    /// The mean that it is part of.
    pub(super) mean: Option<String>,
}

/// What a record was measured with: another one is not taken for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Settings {
    pub(super) cell: String,
    scenario: String,
    sets: Vec<(String, String)>,
    runs: usize,
    cases: usize,
    executions: u64,
    pairs: usize,
    chance: u64,
    fresh: usize,
    singles: usize,
    ways: Vec<Way>,
    seed_of: String,
}

impl Size {
    /// The root of all seeds.
    pub(super) fn seed(&self) -> u64 {
        named_seed(0, &format!("defaults of {}", self.seed_of()), 0)
    }

    /// What seeds are derived from.
    pub(super) fn seed_of(&self) -> &str {
        if self.seed_of.is_empty() { BUILD } else { &self.seed_of }
    }

    /// The cells that are asked for.
    ///
    /// # Errors
    /// A key of a family without a value; coordinates that no waypoint has; a target that the judge does not measure;
    /// ways that move waypoints of a family that has none to move.
    pub(super) fn cells(&self) -> Result<Vec<Cell>, Problem> {
        let mut cells = Vec::new();
        for family in &self.families {
            if !matches!(family.coordinates, 0 | 2 | 3) {
                let given = family.coordinates;
                return Err(Problem::input(format!("`coordinates` = {given}: must be 0, 2 or 3")));
            }
            if family.coordinates == 0 && family.ways.as_deref() != Some(&[Way::Worst]) {
                let name = &family.scenario;
                return Err(Problem::input(format!(
                    "`ways` of `{name}`: must be [\"worst\"], as other ways move waypoints and it has `coordinates` = 0"
                )));
            }
            for robot in &family.robots {
                for controller in &family.controllers {
                    cells.push(family.cell(robot, controller)?);
                }
            }
        }
        let wanted = |cell: &Cell| self.only.is_empty() || self.only.iter().any(|piece| cell.name.contains(piece));
        cells.retain(wanted);
        Ok(cells)
    }
}

impl Family {
    fn cell(&self, robot: &str, controller: &str) -> Result<Cell, Problem> {
        let own = [("robot", robot), ("execute.controller", controller)];
        let mut sets: Vec<(String, String)> =
            own.iter().map(|(key, word)| ((*key).to_owned(), format!("\"{word}\""))).collect();
        for set in &self.sets {
            let Some((key, value)) = set.split_once('=') else {
                return Err(Problem::input(format!("`sets` has `{set}`, must be KEY=VALUE")));
            };
            sets.push((key.trim().to_owned(), value.trim().to_owned()));
        }
        let no_measure =
            || Problem::input(format!("`target` = {:?}: must be a measure of the judge's", self.target.word()));
        Ok(Cell {
            name: format!("{}/{controller}", self.name.as_deref().unwrap_or(robot)),
            scenario: self.scenario.clone(),
            sets,
            target: self.target.clone(),
            stress: self.target.stress().ok_or_else(no_measure)?,
            coordinates: self.coordinates,
            same_graphs: self.same_graphs,
            ground: self.ground.clone(),
            ways: self.ways.clone(),
            runs: self.runs,
            executions: self.executions,
            pairs: self.pairs,
            mean: self.mean.clone(),
        })
    }
}

impl Cell {
    /// The name of its record.
    pub(super) fn file(&self) -> String {
        format!("{}.json", self.name.replace('/', "."))
    }

    /// How large it is: what its family says goes before what the sheet does.
    pub(super) fn size(&self, size: &Size) -> Size {
        Size {
            ways: self.ways.clone().unwrap_or_else(|| size.ways.clone()),
            // A family may only be smaller: what is typed over the sheet is often a trial.
            runs: self.runs.map_or(size.runs, |runs| runs.min(size.runs)),
            executions: self.executions.map_or(size.executions, |executions| executions.min(size.executions)),
            pairs: self.pairs.map_or(size.pairs, |pairs| pairs.min(size.pairs)),
            ..size.clone()
        }
    }

    /// What its record is measured with.
    pub(super) fn settings(&self, size: &Size) -> Settings {
        Settings {
            cell: self.name.clone(),
            scenario: self.scenario.clone(),
            sets: self.sets.clone(),
            runs: size.runs,
            cases: size.cases,
            executions: size.executions,
            pairs: size.pairs,
            chance: size.chance,
            fresh: size.fresh,
            singles: size.singles,
            ways: size.ways.clone(),
            seed_of: size.seed_of().to_owned(),
        }
    }
}
