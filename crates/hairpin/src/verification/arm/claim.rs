//! What is claimed of an arm, as plain numbers.
//!
//! Everything is in the arm's base frame unless a name says otherwise: `a_from_b` maps coordinates in b to those in a.
//! The claim has the description's numbers again, and the program's text parsed; it knows no arm, no cell and no
//! planner.

use nalgebra::{Isometry3, Point3, Vector3};

/// One joint: q turns the link about `axis` where `parent_from_joint` puts it.
///
/// parent_from_link = `parent_from_joint` · Rot(`axis`, q), as in URDF.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmJointClaim {
    /// At angle 0.
    ///
    /// m and a unit quaternion.
    pub parent_from_joint: Isometry3<f64>,
    /// Of length 1.
    pub axis: Vector3<f64>,
    /// Least and largest angle, rad.
    pub bounds: [f64; 2],
}

/// All points within `radius` of the convex hull of some points, in the frame of a link.
///
/// Two points are a capsule's; equal ones, or one, a ball's.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmBodyClaim {
    /// 1 to 6: what joint k moves; the tool is in 6.
    pub link: usize,
    /// As findings call it.
    pub name: String,
    /// Whether it is the tool.
    pub tool: bool,
    /// Points whose hull it is, m.
    pub points: Vec<Point3<f64>>,
    /// m.
    pub radius: f64,
}

/// What must not be touched, in the base frame, m.
pub struct ArmSolidClaim<'a> {
    /// As findings call it.
    pub name: &'a str,
    /// Whether only the tool has to keep off.
    pub tool_only: bool,
    /// Its points.
    pub form: ArmSolidForm<'a>,
}

/// Forms of solids.
pub enum ArmSolidForm<'a> {
    /// Centre and radius.
    Ball(Point3<f64>, f64),
    /// Centre and half the edge lengths.
    Box(Point3<f64>, Vector3<f64>),
    /// Both ends of the axis and the radius.
    Capsule([Point3<f64>; 2], f64),
    /// The same with flat ends.
    Cylinder([Point3<f64>; 2], f64),
    /// All p with normal·p ≤ offset.
    HalfSpace(Vector3<f64>, f64),
    /// The inside of closed triangles.
    Triangles(Vec<[Point3<f64>; 3]>),
    /// Where this is true; distances from it are not known.
    Where(&'a dyn Fn(&Point3<f64>) -> bool),
}

/// How an arm is built, where that tells which of several postures a program means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ArmBuild {
    /// Axis 1 upright, 2 and 3 across it, 4, 5 and 6 through one point, 4 and 6 square to 5; ±1 of each axis: whether
    /// it turns as its angle counts.
    SphericalWrist([f64; 6]),
    /// Any other.
    Chain,
}

/// An arm, what its flange carries, and what stands around it.
pub struct ArmClaim<'a> {
    /// From the base on.
    pub joints: &'a [ArmJointClaim; 6],
    /// How they are built.
    pub build: ArmBuild,
    /// `link6_from_flange`.
    pub flange: Isometry3<f64>,
    /// `flange_from_tcp` of what the flange carries.
    pub tool: Isometry3<f64>,
    /// Links and tool.
    pub bodies: &'a [ArmBodyClaim],
    /// The cell.
    pub solids: &'a [ArmSolidClaim<'a>],
    /// What bodies keep from solids, m.
    ///
    /// Beyond touching, on every move that is to be clear; where corners are cut links may come as near as to touch,
    /// and the tool's point keeps it by the triangle of the corner.
    pub clearance: f64,
}

/// A pose to go to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmTarget {
    /// `object_from_tcp`.
    pub pose: Isometry3<f64>,
    /// Quadrants of axes 1, 4 and 6 and which of the eight postures, where it must be met in one.
    ///
    /// RAPID's confdata \[cf1, cf4, cf6, cfx\]: quadrant k of an axis is k · 90° … (k + 1) · 90°; cfx 0 … 7.
    pub configuration: Option<[i32; 4]>,
    /// Joint angles there, rad, as claimed of arms of which a configuration does not tell them.
    pub angles: Option<[f64; 6]>,
}

/// How a move of a program leads from where the one before it ended.
///
/// MoveAbsJ, MoveJ, MoveL and MoveC of a program, in this order.
#[derive(Debug, Clone, PartialEq)]
pub enum ArmMotion {
    /// All joints in step, to these angles, rad.
    Posture([f64; 6]),
    /// All joints in step, to a pose.
    Joints(ArmTarget),
    /// The tool straight, turning about one axis.
    Straight(ArmTarget),
    /// The tool on the arc through a point of the object (m), turning about one axis.
    Arc(Point3<f64>, ArmTarget),
}

/// A move of a program as it was written.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmProgramMove {
    /// How, and where to.
    pub motion: ArmMotion,
    /// `flange_from_tcp` that its targets are for.
    pub tool: Isometry3<f64>,
    /// `base_from_user` and `user_from_object` that they are in.
    ///
    /// RAPID's wobjdata: uframe and oframe.
    pub object: [Isometry3<f64>; 2],
    /// How far (m) before its end the path may leave it; 0 where the arm stops.
    ///
    /// The zone's radius about the end point; what is cut is at most half of either move.
    pub zone: f64,
}

/// A program, and what is claimed of it.
///
/// `waypoints` has one entry a move: [`ArmProgramReplay`](super::ArmProgramReplay) tells the distances.
pub struct ArmProgramClaim<'a> {
    /// Where the arm stands before it, rad.
    pub start: [f64; 6],
    /// Its moves.
    pub moves: &'a [ArmProgramMove],
    /// Where each of them is to end, m, base frame.
    pub waypoints: &'a [Point3<f64>],
    /// Least margin from singularities where the tool is led, a pure number.
    pub singularity: f64,
    /// Whether links and tool keep clear of the cell, and corners are cut between straight moves alone.
    pub clear: bool,
}

/// Something that does not hold on a move.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmMoveFinding {
    /// The move, from 0.
    pub index: usize,
    /// Share of it.
    ///
    /// 0 at its beginning, 1 at its end; findings about the corner at its end have 1.
    pub at: f64,
    /// What, in words.
    pub what: String,
}
