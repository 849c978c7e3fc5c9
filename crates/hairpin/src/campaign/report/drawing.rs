//! What stands around the cases that are drawn: a cage with its obstacles, or a stretch of ground.

use std::f64::consts::TAU;

use nalgebra::{Point3, Vector3};

use super::solid::{Surface, surface};
use crate::campaign::arm::ArmSetup;
use crate::campaign::drive::DriveSetup;
use crate::campaign::flight::FlightSetup;
use crate::campaign::setup::{Kind, Setup};
use crate::world::cell::Region;
use crate::world::terrain::{KeepOut, KeepOutShape, Terrain};
use crate::world::{Obstacle, Shape};

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
}

/// Points along a side of the drawn ground.
const RELIEF_POINTS: f64 = 160.0;
/// Ground around what is drawn, m.
const MARGIN: f64 = 3.0;
/// Corners of a drawn disc.
const AROUND: usize = 32;

/// What stands around `places`.
pub(super) fn drawing(setup: &Setup, places: impl Iterator<Item = Point3<f64>>) -> Drawing {
    match setup.kind() {
        Kind::Flight(setup) => cage(&setup),
        Kind::Drive(setup) => ground(&setup, places),
        Kind::Arm(setup) => cell(&setup, places),
    }
}

fn cage(setup: &FlightSetup) -> Drawing {
    let robot = setup.robot;
    Drawing {
        low: Point3::origin(),
        size: setup.world.size(),
        obstacles: setup.world.obstacles().iter().map(surface).collect(),
        rotors: robot.rotors.iter().map(|r| Rotor { x: r.x, y: r.y, clockwise: r.spin > 0.0 }).collect(),
        wheels: Vec::new(),
        radius: robot.clearance_radius,
        relief: None,
    }
}

/// The cell around what is drawn: half-spaces, keep-outs in words and what has no surface of its own are left to the
/// words.
fn cell(setup: &ArmSetup, places: impl Iterator<Item = Point3<f64>>) -> Drawing {
    let (mut low, mut high) = (Point3::origin(), Point3::origin());
    for place in places {
        (low, high) = (low.inf(&place), high.sup(&place));
    }
    let mut obstacles = Vec::new();
    for part in &setup.station.cell.parts {
        if let Some(bounds) = part.region.bounds() {
            (low, high) = (low.inf(&bounds.min), high.sup(&bounds.max));
        }
        let shape = match &part.region {
            Region::Shape(shape) => Some(shape.clone()),
            // Drawn as the capsule around it: a picture, not a proof.
            Region::Cylinder { a, b, radius } => Some(Shape::Capsule { a: *a, b: *b, radius: *radius }),
            Region::HalfSpace { .. } | Region::Beyond { .. } | Region::Words(_) => None,
        };
        obstacles.extend(shape.map(|shape| surface(&Obstacle { name: part.name.clone(), shape })));
    }
    let margin = Vector3::repeat(0.1);
    Drawing {
        low: low - margin,
        size: high - low + 2.0 * margin,
        obstacles,
        rotors: Vec::new(),
        wheels: Vec::new(),
        radius: setup.station.tool.radius,
        relief: None,
    }
}

fn ground(setup: &DriveSetup, places: impl Iterator<Item = Point3<f64>>) -> Drawing {
    let (map_low, map_high) = setup.map.extent();
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for place in places {
        for i in 0..2 {
            low[i] = low[i].min(place[i] - MARGIN).max(map_low[i]);
            high[i] = high[i].max(place[i] + MARGIN).min(map_high[i]);
        }
    }
    if !(low[0] < high[0] && low[1] < high[1]) {
        (low, high) = (map_low, map_high);
    }
    let side = (high[0] - low[0]).max(high[1] - low[1]);
    let cell = setup.map.grid().cell;
    let step = (side / RELIEF_POINTS).max(cell[0].min(cell[1]));
    let [columns, rows] = [0, 1].map(|i| ((high[i] - low[i]) / step).floor() as usize + 1);
    let heights: Vec<Vec<f64>> = (0..rows)
        .map(|row| {
            (0..columns).map(|c| height_at(setup, low[0] + c as f64 * step, low[1] + row as f64 * step)).collect()
        })
        .collect();
    let (wheels, count, _) = setup.rover.suspension.wheels(&[0.0; 3]);
    let known = heights.iter().flatten().filter(|h| h.is_finite());
    let (bottom, top) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(*h), high.max(*h)));
    let (bottom, top) = if bottom <= top { (bottom, top) } else { (0.0, 0.0) };
    Drawing {
        low: Point3::new(low[0], low[1], bottom),
        size: Vector3::new(high[0] - low[0], high[1] - low[1], (top - bottom).max(0.5)),
        obstacles: setup.keep_out.list().iter().map(|place| keep_out(setup, place)).collect(),
        rotors: Vec::new(),
        wheels: wheels[..count].iter().map(|wheel| [wheel.x, wheel.y]).collect(),
        radius: setup.rover.suspension.outer_radius(),
        relief: Some(Relief { low, step, heights }),
    }
}

/// A keep-out as a flat shape a little over the ground at its outline.
pub(super) fn keep_out(setup: &DriveSetup, place: &KeepOut) -> Surface {
    let corners: Vec<[f64; 2]> = match &place.shape {
        KeepOutShape::Circle { center_m: [x, y], radius_m } => (0..AROUND)
            .map(|i| {
                let (sin, cos) = libm::sincos(TAU * i as f64 / AROUND as f64);
                [x + radius_m * cos, y + radius_m * sin]
            })
            .collect(),
        KeepOutShape::Polygon { points_m } => points_m.clone(),
    };
    let heights = corners.iter().map(|[x, y]| height_at(setup, *x, *y)).filter(|h| h.is_finite());
    let height = heights.reduce(f64::max).unwrap_or(0.0);
    let vertices: Vec<Point3<f64>> = corners.iter().map(|[x, y]| Point3::new(*x, *y, height + 0.05)).collect();
    // A fan: exact for convex shapes; the outline is drawn from the corners.
    let triangles = (1..vertices.len().saturating_sub(1) as u32).map(|i| [0, i, i + 1]).collect();
    Surface { name: place.name.clone(), vertices, triangles }
}

/// Height of the ground, m; NaN where nothing is known.
fn height_at(setup: &DriveSetup, x: f64, y: f64) -> f64 {
    setup.map.patch(x, y).map_or(f64::NAN, |patch| patch.height)
}
