//! The keys of a scenario that name files, whatever moves in it: what the door reads, and renames to the copies of a
//! campaign's folder.

use super::{CostTable, RegressionLimit, Target, TerrainSection, UserSteering};

/// Keys that name files.
#[derive(Debug, Default)]
pub struct Named<'a> {
    /// `world.terrain`, where it has a file.
    pub map: Option<&'a mut TerrainSection>,
    /// `task.points` and `task.checksum`.
    pub cloud: Option<(&'a mut String, &'a mut Option<String>)>,
    /// Whether the points are said to be in the work object, as robtargets may be.
    pub in_object: bool,
    /// `generate.cost`, where it is a table.
    pub costs: Option<&'a mut CostTable>,
    /// Meshes of obstacles.
    pub meshes: Vec<NamedMesh<'a>>,
    /// The score with its key.
    pub score: Option<(&'static str, &'a mut String)>,
    /// `generate.search.target`.
    pub target: Option<&'a mut Target>,
    /// `execute.controller`, where it is the user's.
    pub controller: Option<&'a mut UserSteering>,
    /// `spec.regression`.
    pub baseline: Option<&'a mut RegressionLimit>,
}

/// A mesh by its file, which becomes its triangles.
#[derive(Debug)]
pub struct NamedMesh<'a> {
    /// Key of the file: `world.obstacles[0].mesh.file`.
    pub key: String,
    /// The file.
    pub file: &'a mut Option<String>,
    /// What the file's unit is in the vertices' own.
    pub scale: &'a mut Option<f64>,
    /// Name of the key that says it.
    pub scale_key: &'static str,
    /// How many of the vertices' unit a metre is.
    pub per_metre: f64,
    /// Name of the key that its vertices have.
    pub vertices_key: &'static str,
    /// Its vertices.
    pub vertices: &'a mut Vec<[f64; 3]>,
    /// Its triangles.
    pub triangles: &'a mut Vec<[u32; 3]>,
}
