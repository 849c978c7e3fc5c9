//! The waters as they are drawn.

use std::f64::consts::TAU;

use nalgebra::{Point3, Vector3};

use super::BoatSetup;
use crate::campaign::kind::{Drawing, FigureLink, Look, RobotFigure, Surface, block, prism};
use crate::world::terrain::{KeepOut, KeepOutShape};

/// Corners of a drawn disc.
const AROUND: usize = 32;
/// Height of the drawn box and of what stands in it, m.
const HEIGHT: f64 = 0.5;

/// All of the waters.
///
/// Water has no height: the box is there so that pictures have one.
pub(super) fn waters(setup: &BoatSetup) -> Drawing {
    let [x, y] = setup.scenario.world.size_m;
    Drawing {
        low: Point3::origin(),
        size: Vector3::new(x, y, HEIGHT),
        obstacles: setup.keep_out.list().iter().map(keep_out).collect(),
        rotors: Vec::new(),
        wheels: Vec::new(),
        radius: setup.boat.radius,
        relief: None,
        figure: Some(figure(setup.boat.radius)),
        done: "sailed",
    }
}

/// A hull of a ship's proportions inside its disc of `radius` (m); how long and wide it is, is a stand-in.
///
/// Body frame, bow along x: 1.9 radii long, 0.56 wide. The bridge stands aft, the bow is marked on deck.
fn figure(radius: f64) -> RobotFigure {
    let (half, beam, deck) = (0.95 * radius, 0.28 * radius, 0.18 * radius);
    let outline = [
        [-half, -0.8 * beam],
        [0.3 * half, -beam],
        [0.75 * half, -0.5 * beam],
        [half, 0.0],
        [0.75 * half, 0.5 * beam],
        [0.3 * half, beam],
        [-half, 0.8 * beam],
    ];
    let bridge = block([-0.6 * half, -0.6 * beam, deck], [-0.1 * half, 0.6 * beam, deck + 0.25 * radius]);
    let bow = prism(&[[0.5 * half, -0.6 * beam], [0.9 * half, 0.0], [0.5 * half, 0.6 * beam]], deck, 1.2 * deck);
    RobotFigure {
        links: vec![
            FigureLink::still(Look::Body, true, vec![prism(&outline, -0.5 * deck, deck), bridge]),
            FigureLink::still(Look::Nose, true, vec![bow]),
        ],
        fixed: false,
        radius,
        lift: 0.0,
        told: "the hull (hatched) is a stand-in as long as the boat's disc is wide".into(),
    }
}

/// A keep-out as a flat shape; a fan, exact for convex ones.
///
/// Discs as polygons of [`AROUND`] corners; triangles all share the first corner, O(corners). A polygon that is not
/// convex is drawn with too much.
fn keep_out(place: &KeepOut) -> Surface {
    let vertices: Vec<Point3<f64>> = match &place.shape {
        KeepOutShape::Circle { center_m: [x, y], radius_m } => (0..AROUND)
            .map(|i| {
                let (sin, cos) = libm::sincos(TAU * i as f64 / AROUND as f64);
                Point3::new(x + radius_m * cos, y + radius_m * sin, 0.0)
            })
            .collect(),
        KeepOutShape::Polygon { points_m } => points_m.iter().map(|[x, y]| Point3::new(*x, *y, 0.0)).collect(),
    };
    let triangles = (1..vertices.len().saturating_sub(1) as u32).map(|i| [0, i, i + 1]).collect();
    Surface { name: place.name.clone(), vertices, triangles }
}
