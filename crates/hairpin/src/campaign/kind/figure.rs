//! The robot as it is drawn: links that turn, each with surfaces, and what of them is a stand-in.
//!
//! A tree of links, as in URDF; every link has surfaces in its own frame, x forward, y left, z up. What a stand-in is
//! drawn for says so, in words and link by link.

use nalgebra::{Isometry3, Point3, Translation3, Vector3};

use super::Surface;
use super::solid::{cuboid, cylinder, named, round};

/// What turns a link about its axis.
///
/// Angles are counter-clockwise about the link's own axis.
#[derive(Debug, Clone, PartialEq)]
pub enum Turned {
    /// Nothing.
    Never,
    /// By `factor` times a channel of the track, rad; `rolled` is the way driven, m.
    By {
        /// The channel.
        channel: String,
        /// rad by its unit.
        factor: f64,
    },
    /// About z, so that a wheel at this place of the body (forward, left, m) rolls along its way.
    Steers {
        /// Forward and left, m.
        at: [f64; 2],
    },
}

/// What a link looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// A body.
    Body,
    /// The part that points forward.
    Nose,
    /// A wheel or a rotor.
    Wheel,
}

impl Look {
    /// Its name.
    pub fn word(self) -> &'static str {
        match self {
            Self::Body => "body",
            Self::Nose => "nose",
            Self::Wheel => "wheel",
        }
    }
}

/// A link, drawn in its own frame.
///
/// world_from_link = world_from_parent · `place` · rotation(`axis`, angle).
#[derive(Debug, Clone, PartialEq)]
pub struct FigureLink {
    /// The link that carries it; `None`: the robot's own frame.
    pub parent: Option<usize>,
    /// `parent_from_link` where nothing turns it, m.
    pub place: Isometry3<f64>,
    /// Axis of the turn, in its own frame.
    pub axis: Vector3<f64>,
    /// What turns it.
    pub turned: Turned,
    /// What it looks like.
    pub look: Look,
    /// Whether its shape is not the robot's own.
    pub stand_in: bool,
    /// Of a rotor: the channel of its speed, and 1 over the square of the largest, s²/rad².
    pub thrust: Option<(String, f64)>,
    /// Its surfaces, m.
    pub surfaces: Vec<Surface>,
}

impl FigureLink {
    /// A link that does not turn, in the robot's own frame.
    pub(in crate::campaign) fn still(look: Look, stand_in: bool, surfaces: Vec<Surface>) -> Self {
        Self {
            parent: None,
            place: Isometry3::identity(),
            axis: Vector3::z(),
            turned: Turned::Never,
            look,
            stand_in,
            thrust: None,
            surfaces,
        }
    }

    /// The same elsewhere in the robot's own frame, m.
    pub(in crate::campaign) fn at(self, place: Vector3<f64>) -> Self {
        Self { place: Translation3::from(place).into(), ..self }
    }
}

/// The robot.
///
/// Links are few and simple, since the figure is drawn for every frame of a page; meshes of arms are the exception.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotFigure {
    /// Its links; a parent comes before what it carries.
    pub links: Vec<FigureLink>,
    /// Whether it stands where it stands, and its track is not its own pose.
    pub fixed: bool,
    /// Radius of the ball that holds it, m.
    pub radius: f64,
    /// Height of its origin over what it stands on, m.
    pub lift: f64,
    /// What is not its own shape, in a sentence's part; empty for nothing.
    pub told: String,
}

/// A box between two corners, m.
///
/// `low` and `high` are opposite corners, in the link's frame.
pub(in crate::campaign) fn block(low: [f64; 3], high: [f64; 3]) -> Surface {
    let (low, high) = (Point3::from(low), Point3::from(high));
    named("body", cuboid(&nalgebra::center(&low, &high), &((high - low) / 2.0)))
}

/// All within `radius` of the line from `a` to `b`, m.
pub(in crate::campaign) fn capsule(a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> Surface {
    named("link", round(a, b, radius))
}

/// A wheel about y, or with `upright` a disc about z, around the origin, m.
pub(in crate::campaign) fn wheel(radius: f64, width: f64, upright: bool) -> Surface {
    let half = if upright { Vector3::z() } else { Vector3::y() } * (0.5 * width);
    named("wheel", cylinder(&Point3::from(-half), &Point3::from(half), radius))
}

/// A rod from `a` to `b`, m.
pub(in crate::campaign) fn rod(a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> Surface {
    named("rod", cylinder(a, b, radius))
}

/// A prism over a convex outline (forward, left), between two heights, m.
///
/// The outline runs counter-clockwise, so that triangles face outwards.
pub(in crate::campaign) fn prism(outline: &[[f64; 2]], low: f64, high: f64) -> Surface {
    let n = outline.len() as u32;
    let at = |z: f64| outline.iter().map(move |[x, y]| Point3::new(*x, *y, z));
    let sides = (0..n).flat_map(|i| {
        let j = (i + 1) % n;
        [[i, j, n + i], [j, n + j, n + i]]
    });
    let lids = (1..n.saturating_sub(1)).flat_map(|i| [[0, i + 1, i], [n, n + i, n + i + 1]]);
    Surface { name: "hull".into(), vertices: at(low).chain(at(high)).collect(), triangles: sides.chain(lids).collect() }
}
