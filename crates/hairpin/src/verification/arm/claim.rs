//! What is claimed of an arm, as plain numbers.

use nalgebra::{Isometry3, Point3, Vector3};

/// One joint: q turns the link about `axis` where `parent_from_joint` puts it.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmJointClaim {
    /// At angle 0.
    pub parent_from_joint: Isometry3<f64>,
    /// Of length 1.
    pub axis: Vector3<f64>,
    /// Least and largest angle, rad.
    pub bounds: [f64; 2],
}

/// All points within `radius` of a segment, in the frame of a link.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmBodyClaim {
    /// 1 to 6: what joint k moves; the tool is in 6.
    pub link: usize,
    /// As findings call it.
    pub name: String,
    /// Whether it is the tool.
    pub tool: bool,
    /// Both ends of the segment, m.
    pub axis: [Point3<f64>; 2],
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

/// A move from where the one before it ended.
///
/// Orientation along straight moves and arcs turns about one axis in proportion to the way.
#[derive(Debug, Clone, PartialEq)]
pub enum ArmMoveClaim {
    /// All joints in step, to these angles (rad), at which the tool is at the pose if one is given.
    Joints([f64; 6], Option<Isometry3<f64>>),
    /// The tool straight to the pose, turning about one axis.
    Straight(Isometry3<f64>),
    /// The tool on the arc through a point (m) to the pose, turning about one axis.
    Arc(Point3<f64>, Isometry3<f64>),
}

/// An arm, its cell, and a program.
///
/// Frames: joints from the base on, `tool` on link 6, solids in the base.
pub struct ArmMovesClaim<'a> {
    /// From the base on.
    pub joints: &'a [ArmJointClaim; 6],
    /// `link6_from_tcp`.
    pub tool: Isometry3<f64>,
    /// Links and tool.
    pub bodies: &'a [ArmBodyClaim],
    /// The cell.
    pub solids: &'a [ArmSolidClaim<'a>],
    /// What bodies keep from solids, m.
    pub clearance: f64,
    /// Where the program starts, rad.
    pub start: [f64; 6],
    /// Its moves.
    pub moves: &'a [ArmMoveClaim],
    /// Of each move how far (m) from its end a blend may leave it; 0 where the arm stops. None at all: it stops everywhere.
    pub zones: &'a [f64],
}

/// Something that does not hold on a move.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmMoveFinding {
    /// The move, from 0.
    pub index: usize,
    /// Share of it.
    pub at: f64,
    /// What, in words.
    pub what: String,
}
