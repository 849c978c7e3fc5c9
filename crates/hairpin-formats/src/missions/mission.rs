//! A mission in a world.

use std::path::PathBuf;

use hairpin::campaign::Environment;
use hairpin::world::terrain::KeepOutShape;
use nalgebra::{Point2, Point3, Vector2};

use crate::frames::Geodetic;
pub use crate::qgc::read_plan::Whose;

/// A mission made elsewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Mission {
    /// Name of its file, without the ending unless another has the same.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// What it is written in: `CSV`, `QGroundControl plan`, `QGC WPL 110`.
    pub format: &'static str,
    /// Start first, m.
    pub waypoints: Vec<Point3<f64>>,
    /// Where in the file each waypoint stands, such as `item 4`; empty where that is its number.
    pub sources: Vec<String>,
    /// Whether they were given in degrees, whose last digit is some hundredths of a millimetre.
    pub rounded: bool,
    /// How they came to be metres of the world.
    pub frame: Frame,
    /// The speed demanded on each leg, m/s, where one is.
    pub speeds: Vec<Option<f64>>,
    /// The acceptance radius of each waypoint, m, where it has one; empty where none does.
    pub accept: Vec<Option<f64>>,
    /// Whose it is, where the file says so.
    pub whose: Whose,
    /// Waypoints between the ends where it stops.
    pub stops: Vec<Stop>,
    /// What of the file changes nothing that is judged, in words.
    pub notes: Vec<String>,
    /// What of the file changes the motion and is not followed.
    pub uncertain: Vec<Uncertain>,
    /// Where it must stay, or must not go.
    pub fences: Vec<Fence>,
    /// What it meets beside them, of the file [`environment_path`](super::environment_path) where there is one.
    pub environment: Option<Environment>,
}

/// How places became metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Frame {
    /// They were metres of the world.
    World,
    /// By the place on Earth that the scenario gives its world.
    Placed,
    /// East, north, up about the mission's own home, as the world is nowhere on Earth.
    Home(Geodetic),
}

/// A waypoint where the vehicle comes to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Its number.
    pub waypoint: usize,
    /// s; infinite: until it is told to go on.
    pub hold_s: f64,
}

/// What is not followed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Uncertain {
    /// From this waypoint on nothing is certain.
    pub waypoint: usize,
    /// What it is, in words.
    pub words: String,
}

/// A part of the mission's own geofence.
#[derive(Debug, Clone, PartialEq)]
pub struct Fence {
    /// Whether the vehicle must stay inside; else outside.
    pub keeps_in: bool,
    /// Its outline in the world.
    pub outline: Outline,
}

/// An outline on the ground, m.
#[derive(Debug, Clone, PartialEq)]
pub enum Outline {
    /// Centre and radius.
    Circle(Point2<f64>, f64),
    /// Corners.
    Polygon(Vec<Point2<f64>>),
}

impl Outline {
    /// What it encloses.
    pub fn shape(&self) -> KeepOutShape {
        match self {
            Self::Circle(center, radius) => KeepOutShape::Circle { center_m: [center.x, center.y], radius_m: *radius },
            Self::Polygon(corners) => KeepOutShape::Polygon { points_m: corners.iter().map(|p| [p.x, p.y]).collect() },
        }
    }

    /// Moves it by `by`, m.
    pub fn shift(&mut self, by: &Vector2<f64>) {
        match self {
            Self::Circle(center, _) => *center += by,
            Self::Polygon(corners) => corners.iter_mut().for_each(|corner| *corner += by),
        }
    }
}

impl Mission {
    /// How long it waits at all of its stops together, s; infinite where it is told to go on.
    pub fn hold(&self) -> f64 {
        // The sum of none is −0.
        self.stops.iter().map(|stop| stop.hold_s).sum::<f64>() + 0.0
    }

    /// Where waypoint `number` stands in the file: `waypoint 3 (item 5)`.
    pub fn told(&self, number: usize) -> String {
        match self.sources.get(number) {
            Some(source) => format!("waypoint {number} ({source})"),
            None => format!("waypoint {number}"),
        }
    }
}
