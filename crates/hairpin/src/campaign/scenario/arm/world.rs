//! `[world]`: the cell. Millimetres and quaternions with the scalar first, as arms' controllers have them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[world]`: base frame of the arm unless a key says otherwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CellSection {
    /// What the flange carries.
    pub tool: ToolSection,
    /// What points and programs are given in.
    pub wobj: WorkObjectSection,
    /// Where the arm's base stands in the world, for points that are given there.
    pub base_frame: FrameSection,
    /// What the arm must not touch.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<CellObstacle>,
    /// Inequations over x, y, z in mm, such as `x^2 + y^2 < 190^2 and z < 480`: where they hold the tool may not be.
    /// Links are not held against them: around the base they would forbid the arm itself; shapes in `obstacles` are.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keep_out_mm: Vec<String>,
}

impl Default for CellSection {
    /// An empty cell: no tool, no obstacle, points in the base frame.
    fn default() -> Self {
        Self {
            tool: ToolSection::default(),
            wobj: WorkObjectSection::default(),
            base_frame: FrameSection::default(),
            obstacles: Vec::new(),
            keep_out_mm: Vec::new(),
        }
    }
}

/// The quaternion of no turn.
const LEVEL: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

/// `tool = { name, declare, tcp_mm, q1_q4, mass_kg, cog_mm, radius_mm }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ToolSection {
    /// Name in programs.
    pub name: String,
    /// Whether programs declare it; otherwise they expect it on the controller.
    pub declare: bool,
    /// The tool's point, from the flange.
    pub tcp_mm: [f64; 3],
    /// Its orientation, scalar first.
    pub q1_q4: [f64; 4],
    /// Mass; 0: none given.
    pub mass_kg: f64,
    /// Centre of gravity, from the flange.
    pub cog_mm: [f64; 3],
    /// The tool is taken for all points this near to the line from the flange to its point.
    pub radius_mm: f64,
}

impl Default for ToolSection {
    fn default() -> Self {
        Self {
            name: "tool0".into(),
            declare: false,
            tcp_mm: [0.0; 3],
            q1_q4: LEVEL,
            mass_kg: 0.0,
            cog_mm: [0.0; 3],
            radius_mm: 0.0,
        }
    }
}

/// `wobj = { name, declare, uframe_mm, uframe_q1_q4, oframe_mm, oframe_q1_q4 }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct WorkObjectSection {
    /// Name in programs.
    pub name: String,
    /// Whether programs declare it; otherwise they expect it on the controller.
    pub declare: bool,
    /// The user frame in the world.
    pub uframe_mm: [f64; 3],
    /// Its orientation, scalar first.
    pub uframe_q1_q4: [f64; 4],
    /// The object frame in the user frame.
    pub oframe_mm: [f64; 3],
    /// Its orientation, scalar first.
    pub oframe_q1_q4: [f64; 4],
}

impl Default for WorkObjectSection {
    fn default() -> Self {
        Self {
            name: "wobj0".into(),
            declare: false,
            uframe_mm: [0.0; 3],
            uframe_q1_q4: LEVEL,
            oframe_mm: [0.0; 3],
            oframe_q1_q4: LEVEL,
        }
    }
}

/// `base_frame = { mm, q1_q4 }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FrameSection {
    /// Place.
    pub mm: [f64; 3],
    /// Orientation, scalar first.
    pub q1_q4: [f64; 4],
}

impl Default for FrameSection {
    fn default() -> Self {
        Self { mm: [0.0; 3], q1_q4: LEVEL }
    }
}

/// One obstacle: exactly one of the shapes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CellObstacle {
    /// Name in reports.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// A box, turned by `q1_q4`.
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    pub cuboid: Option<CellBox>,
    /// A ball.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sphere: Option<CellSphere>,
    /// All points within a radius of a segment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub capsule: Option<CellCapsule>,
    /// A cylinder with flat ends.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cylinder: Option<CellCapsule>,
    /// The convex hull of points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hull: Option<CellHull>,
    /// A closed triangle mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<CellMesh>,
    /// All points p with normal · p ≤ offset: a floor, a wall.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_space: Option<CellHalfSpace>,
}

/// `box = { center_mm, size_mm, q1_q4 }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellBox {
    /// Centre.
    pub center_mm: [f64; 3],
    /// Edge lengths.
    pub size_mm: [f64; 3],
    /// Orientation, scalar first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub q1_q4: Option<[f64; 4]>,
}

/// `sphere = { center_mm, radius_mm }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellSphere {
    /// Centre.
    pub center_mm: [f64; 3],
    /// Radius.
    pub radius_mm: f64,
}

/// `capsule = { a_mm, b_mm, radius_mm }`, `cylinder = { a_mm, b_mm, radius_mm }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellCapsule {
    /// One end of the axis.
    pub a_mm: [f64; 3],
    /// The other end.
    pub b_mm: [f64; 3],
    /// Radius.
    pub radius_mm: f64,
}

/// `hull = { points_mm }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellHull {
    /// At least four points that are not in one plane.
    pub points_mm: Vec<[f64; 3]>,
}

/// `mesh = { vertices_mm, triangles }` or `mesh = { file, scale_mm }` (STL, OBJ or Collada, resolved into the former
/// when read).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellMesh {
    /// An STL, OBJ or Collada file, relative to the scenario file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// How many mm the file's unit is; 1 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale_mm: Option<f64>,
    /// Vertices.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vertices_mm: Vec<[f64; 3]>,
    /// Triangles as vertex indices from 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub triangles: Vec<[u32; 3]>,
}

/// `half_space = { normal, offset_mm }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellHalfSpace {
    /// Out of what is forbidden; of any length but 0.
    pub normal: [f64; 3],
    /// Largest normal · p that is forbidden.
    pub offset_mm: f64,
}
