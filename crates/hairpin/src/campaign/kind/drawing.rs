//! What stands around the cases that are drawn: a cage with its obstacles, a stretch of ground, a cell.
//!
//! Plain shapes in the world frame, m: what the report, the figure and Python's plots draw, without asking which
//! robot it is.

use nalgebra::{Point3, Vector3};

use super::{RobotFigure, Surface};

/// A rotor, seen from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotor {
    /// Forward, m.
    pub x: f64,
    /// Left, m.
    pub y: f64,
    /// Whether it turns clockwise seen from above.
    pub clockwise: bool,
}

/// Heights of a stretch of ground on a square grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    /// Corner with least x and y, m.
    pub low: [f64; 2],
    /// Distance of neighbouring points, m.
    pub step: f64,
    /// Rows from least y on, each from least x on, m; NaN where nothing is known.
    pub heights: Vec<Vec<f64>>,
}

/// What stands around the cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Corner of the drawn box with least coordinates, m.
    pub low: Point3<f64>,
    /// Edge lengths of the drawn box, m.
    pub size: Vector3<f64>,
    /// Obstacles; keep-outs as discs and polygons at the ground's height.
    pub obstacles: Vec<Surface>,
    /// The robot's rotors, if it flies.
    pub rotors: Vec<Rotor>,
    /// Wheels from above, left and right, x and y in m, if it drives.
    pub wheels: Vec<[f64; 2]>,
    /// Radius of the ball that holds the robot, m.
    pub radius: f64,
    /// The ground, if it drives.
    pub relief: Option<Relief>,
    /// The robot; `None` where nothing of its shape is known.
    pub figure: Option<RobotFigure>,
    /// What a run has done: `flown`, `driven`, `sailed`, `moved`.
    pub done: &'static str,
}
