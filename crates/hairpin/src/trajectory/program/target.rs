//! Where a move goes, and how it gets there.

use nalgebra::Isometry3;

/// External axes in the unit of their controller (mm or degrees: a program does not say which); `None` is not in use.
pub type External = [Option<f64>; 6];

/// No external axis in use.
pub const NO_EXTERNAL: External = [None; 6];

/// A pose of the tool's centre point in the work object.
///
/// A pose has up to eight postures and more turns; `configuration` is which one is meant, the numbers of
/// `robot::arm::Configuration`.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseTarget {
    /// Its name; without one it is written in place.
    pub name: Option<String>,
    /// `object_from_tcp`, m.
    pub pose: Isometry3<f64>,
    /// \[cf1, cf4, cf6, cfx\]: quadrants of axes 1, 4 and 6 and which of the eight solutions; `None` is unknown.
    pub configuration: Option<[i32; 4]>,
    /// External axes.
    pub external: External,
}

/// A posture of the arm.
#[derive(Debug, Clone, PartialEq)]
pub struct JointTarget {
    /// Its name; without one it is written in place.
    pub name: Option<String>,
    /// Angles of the six axes from the base on, rad.
    pub joints: [f64; 6],
    /// External axes.
    pub external: External,
}

/// How a move gets where.
///
/// RAPID's MoveAbsJ, MoveJ, MoveL, MoveC. Arcs are those of [`super::Arc`].
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// All axes at once to a posture.
    AbsoluteJoint(JointTarget),
    /// All axes at once to a pose.
    Joint(PoseTarget),
    /// The tool's centre point on a straight line.
    Linear(PoseTarget),
    /// The tool's centre point on the arc through a third pose.
    Circular {
        /// The pose on the way; its orientation and configuration are not met.
        via: PoseTarget,
        /// The end.
        to: PoseTarget,
    },
}

impl PoseTarget {
    /// A target without name, configuration and external axes.
    pub fn unnamed(pose: Isometry3<f64>) -> Self {
        Self { name: None, pose, configuration: None, external: NO_EXTERNAL }
    }

    /// The same target under a name.
    pub fn named(self, name: &str) -> Self {
        Self { name: Some(name.into()), ..self }
    }
}

impl Motion {
    /// The pose at the end; `None` where only a posture is given.
    pub fn end(&self) -> Option<&PoseTarget> {
        match self {
            Self::AbsoluteJoint(_) => None,
            Self::Joint(to) | Self::Linear(to) | Self::Circular { to, .. } => Some(to),
        }
    }

    /// The name of the end.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::AbsoluteJoint(to) => to.name.as_deref(),
            Self::Joint(to) | Self::Linear(to) | Self::Circular { to, .. } => to.name.as_deref(),
        }
    }

    /// All poses it names, in the order of the path.
    pub fn poses(&self) -> impl Iterator<Item = &PoseTarget> {
        let via = match self {
            Self::Circular { via, .. } => Some(via),
            _ => None,
        };
        via.into_iter().chain(self.end())
    }
}
