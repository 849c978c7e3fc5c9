//! What the files hold that a scenario names. It lies beside the keys, is read once, by the door, and is found by what
//! a key says: a score that is drawn has the model that was read if it names its file, and none otherwise.
//!
//! A key that draws may change must not find a file that it does not name: each lookup takes the key's value and
//! answers `None` where the file that was read is another.

use std::fmt;
use std::sync::Arc;

use super::baseline::Baseline;
use super::learn::ScoreModel;
use super::scenario::{CostTable, LEARNED, PYTHON, PointsSource, RegressionLimit, Scenario, Target, TerrainSection};
use super::user_controller::UserController;
use super::user_score::LegScorer;
use super::user_target::RunMeter;
use crate::world::terrain::ElevationMap;

/// A file as it was read.
///
/// Shared by all clones of a setup; `bytes` are those that were read, so that a copy is exact even if the file
/// changes.
pub struct Attached<T: ?Sized> {
    /// What it says.
    pub read: Arc<T>,
    /// Its contents: a campaign keeps its own copy.
    pub bytes: Arc<[u8]>,
    /// The copy's name in a campaign's folder, by which a resolved scenario calls it.
    pub name: String,
    /// What the scenario called it before, which mistakes are told with.
    pub given: String,
}

impl<T: ?Sized> Clone for Attached<T> {
    fn clone(&self) -> Self {
        let Self { read, bytes, name, given } = self;
        Self { read: read.clone(), bytes: bytes.clone(), name: name.clone(), given: given.clone() }
    }
}

impl<T: ?Sized> fmt::Debug for Attached<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { read: _, bytes, name, given } = self;
        f.debug_struct("Attached").field("name", name).field("given", given).field("bytes", &bytes.len()).finish()
    }
}

/// One point of a cloud as it was given.
///
/// In the units and conventions of the file (ABB's): mm, scalar first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloudPoint {
    /// x, y, z, mm, in the frame of the points.
    pub mm: [f64; 3],
    /// Orientation, scalar first; that of the scenario where there is none.
    pub q1_q4: Option<[f64; 4]>,
    /// cf1, cf4, cf6, cfx; any where there are none.
    pub configuration: Option<[i32; 4]>,
}

/// A table of costs in whole units.
///
/// Whole numbers, so that sums and bounds of [`crate::search::heaviest`] are exact; a cost in the table's own unit is
/// `costs` · `unit`.
#[derive(Debug, Clone, PartialEq)]
pub struct CostMatrix {
    /// N.
    pub points: usize,
    /// N·N costs, row = from; `None`: no such move.
    pub costs: Vec<Option<i64>>,
    /// What one unit is in the table's own.
    pub unit: f64,
}

/// All that a scenario's files hold.
///
/// `None` wherever the scenario names no file.
#[derive(Debug, Clone, Default)]
pub struct Attachments {
    /// `world.terrain.file`, read as all of `world.terrain` says.
    pub map: Option<(TerrainSection, Attached<ElevationMap>)>,
    /// `task.points`.
    pub cloud: Option<Attached<[CloudPoint]>>,
    /// `generate.cost.table`.
    pub costs: Option<Attached<CostMatrix>>,
    /// The model of a score `learned:FILE`.
    pub model: Option<Attached<ScoreModel>>,
    /// The score of the user's own, `python:FILE`.
    pub user_score: Option<Attached<dyn LegScorer>>,
    /// The target of the user's own, `python:FILE`.
    pub user_target: Option<Attached<dyn RunMeter>>,
    /// The controller of the user's own.
    pub user_controller: Option<Arc<UserController>>,
    /// `spec.regression.baseline`.
    pub baseline: Option<Attached<Baseline>>,
}

impl Attachments {
    /// Names and contents of the files that a campaign keeps in its folder.
    ///
    /// Of code in the caller's process it is the file that it stands for.
    pub fn files(&self) -> Vec<(&str, &[u8])> {
        fn kept<T: ?Sized>(attached: Option<&Attached<T>>) -> Option<(&str, &[u8])> {
            attached.map(|attached| (attached.name.as_str(), &*attached.bytes))
        }
        let Self { map, cloud, costs, model, user_score, user_target, user_controller, baseline } = self;
        let controller = user_controller.as_ref().and_then(|user| user.file.as_ref());
        let map = map.as_ref().map(|(_, map)| map);
        let all = [
            kept(map),
            kept(cloud.as_ref()),
            kept(costs.as_ref()),
            kept(model.as_ref()),
            kept(user_score.as_ref()),
            kept(user_target.as_ref()),
            controller.map(|(name, bytes)| (name.as_str(), &**bytes)),
            kept(baseline.as_ref()),
        ];
        all.into_iter().flatten().collect()
    }

    /// The map of `terrain`, where that is how it was read.
    pub fn map(&self, terrain: &TerrainSection) -> Option<&Arc<ElevationMap>> {
        self.map.as_ref().filter(|(as_read, _)| as_read == terrain).map(|(_, map)| &map.read)
    }

    /// The points of a file.
    pub fn cloud(&self, points: &PointsSource) -> Option<&[CloudPoint]> {
        let PointsSource::File(file) = points else { return None };
        self.cloud.as_ref().filter(|cloud| cloud.name == *file).map(|cloud| &*cloud.read)
    }

    /// The numbers of a table.
    pub fn costs(&self, table: &CostTable) -> Option<&CostMatrix> {
        self.costs.as_ref().filter(|costs| costs.name == table.table).map(|costs| &*costs.read)
    }

    /// The model that `score` names.
    pub fn model(&self, score: &str) -> Option<&Attached<ScoreModel>> {
        self.model.as_ref().filter(|model| score.strip_prefix(LEARNED) == Some(&model.name))
    }

    /// The score of the user's own that `score` names.
    pub fn user_score(&self, score: &str) -> Option<&Attached<dyn LegScorer>> {
        self.user_score.as_ref().filter(|user| score.strip_prefix(PYTHON) == Some(&user.name))
    }

    /// The file, as it was given, that `score` names.
    pub fn own_score(&self, score: &str) -> Option<&str> {
        let of_model = self.model(score).map(|model| &model.given);
        of_model.or(self.user_score(score).map(|user| &user.given)).map(String::as_str)
    }

    /// The target of the user's own that `target` names.
    pub fn user_target(&self, target: Option<&Target>) -> Option<&Attached<dyn RunMeter>> {
        let Some(Target::Python(file)) = target else { return None };
        self.user_target.as_ref().filter(|user| user.name == *file)
    }

    /// The controller of the user's own that `word` names.
    pub fn user_controller(&self, word: Option<&str>) -> Option<&UserController> {
        self.user_controller.as_deref().filter(|user| Some(user.word.as_str()) == word)
    }

    /// What earlier releases did.
    pub fn baseline(&self, limit: &RegressionLimit) -> Option<&Baseline> {
        self.baseline.as_ref().filter(|baseline| baseline.name == limit.baseline).map(|baseline| &*baseline.read)
    }
}

/// A scenario that names nothing but files of a campaign's folder, with what these hold.
///
/// What [`Setup::build`](super::setup::Setup::build) takes.
#[derive(Debug, Clone)]
pub struct Resolved {
    /// Every key; the robot's table inline, meshes read, the base world merged.
    pub scenario: Scenario,
    /// Its files.
    pub attachments: Attachments,
}

impl From<Scenario> for Resolved {
    /// Of a scenario that names no file.
    fn from(scenario: Scenario) -> Self {
        Self { scenario, attachments: Attachments::default() }
    }
}
