//! The ground as it is drawn.

use std::f64::consts::TAU;

use nalgebra::{Point3, Vector3};

use super::DriveSetup;
use super::figure::figure;
use crate::campaign::kind::{Drawing, Relief, Surface};
use crate::world::terrain::{KeepOut, KeepOutShape, Terrain};

/// Points along a side of the drawn ground.
///
/// At most about 160 × 160 heights, whatever the map's size.
const RELIEF_POINTS: f64 = 160.0;
/// Ground around what is drawn, m.
const MARGIN: f64 = 3.0;
/// Corners of a drawn disc.
const AROUND: usize = 32;

/// The stretch of ground around `places`.
///
/// 3 m around them, within the map; the whole map for none. Heights in m by rows from south to north, in steps of a
/// 160th of the longer side and no finer than the map's cells.
///
/// Cells beyond the map or without data are NaN.
///
/// Low and high of the drawing are those of the known heights; its height is 0.5 m at least, so that level ground has a
/// box. O(160²) looks at the map.
pub(super) fn ground(setup: &DriveSetup, places: &[Point3<f64>]) -> Drawing {
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
        figure: Some(figure(&setup.rover)),
        done: "driven",
    }
}

/// A keep-out as a flat shape a little over the ground at its outline.
///
/// 5 cm above the highest known ground at its corners; a circle has 32 of them.
///
/// Concave polygons have an outline that is right and a fan that is not.
fn keep_out(setup: &DriveSetup, place: &KeepOut) -> Surface {
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
