//! Obstacles placed where a flight leaves its plan: clear of every planned leg, and in the flight's way.

use nalgebra::{Point3, Unit, Vector3};

use super::FlightSetup;
use crate::campaign::placement::{Placed, Placement, Placing, name};
use crate::campaign::scenario::{BoxSection, ObstacleSection, PlacedSection, SphereSection};
use crate::campaign::{Case, Environment};
use crate::feasibility::collision::FreeSpace;
use crate::trajectory::Track;
use crate::world::{Obstacle, Shape, World};

/// Chords of a planned leg that is not straight.
/// The larger gap covers what a chord cuts off.
///
/// Even in time, not in length.
const CHORDS: usize = 12;
/// What obstacles keep from the plan beyond the robot's radius, m: a little at first, more where chords hide what is
/// nearer.
const GAPS: [f64; 2] = [0.001, 0.05];

/// Up to `asked.count` obstacles of the shape asked for in the way of `track`, the flight of `case` without them.
/// `None` where there is no room for any.
///
/// Each is as near to the executed way as the plan lets it be.
pub(super) fn place(setup: &FlightSetup, case: &Case, track: &Track, asked: &PlacedSection) -> Option<Placement> {
    let placing = Placing {
        way: &way(case),
        count: asked.count as usize,
        radius: setup.robot.clearance_radius,
        gaps: &GAPS,
        shape: &|center| shape(asked, center),
        directions,
        stands: &|_, shape| inside(&setup.world, shape) && leaves_clear(setup, case, shape),
    };
    let places: Vec<Point3<f64>> = (0..track.len()).map(|index| track.position(index)).collect();
    let Placed { centers, clearance, leg } = placing.in_the_way_of(track, &places)?;
    let obstacles = centers.iter().enumerate().map(|(number, center)| section(asked, number, center)).collect();
    let among = Environment { obstacles, ..case.environment.clone().unwrap_or_default() };
    Some(Placement { among, clearance, leg })
}

/// Whether every planned leg of `case` keeps the robot's radius from `shape`: its witness everywhere on it, else its
/// straight legs.
///
/// Of a witness the proof of free space, on polynomials rather than samples.
///
/// The robot is a ball about its origin. `false` also where the shape makes no world.
fn leaves_clear(setup: &FlightSetup, case: &Case, shape: &Shape) -> bool {
    let radius = setup.robot.clearance_radius;
    let Some(profile) = case.profile() else {
        return case.waypoints.windows(2).all(|leg| shape.segment_distance(&leg[0], &leg[1]) >= radius);
    };
    let obstacle = Obstacle { name: String::new(), shape: shape.clone() };
    let Ok(world) = World::new(setup.world.size(), 0.0, vec![obstacle]) else { return false };
    let space = FreeSpace::new(&world, radius);
    profile.legs.iter().all(|leg| space.contains(leg).is_ok())
}

/// The plan as a chain of segments.
///
/// Witnesses in 12 chords per leg.
fn way(case: &Case) -> Vec<Point3<f64>> {
    let Some(profile) = case.profile() else { return case.waypoints.clone() };
    let along = profile
        .legs
        .iter()
        .flat_map(|leg| (0..CHORDS).map(move |chord| leg.position(leg.duration * chord as f64 / CHORDS as f64)));
    along.chain(case.waypoints.last().copied()).collect()
}

/// Directions in which an obstacle may give way: away from the plan, and across that.
///
/// Five unit vectors; `away` is not 0.
///
/// `away` and ± two axes across it: the first across that axis of the world which `away` has least of, the second
/// across both. In three dimensions there is room on all sides.
fn directions(away: &Vector3<f64>) -> Vec<Unit<Vector3<f64>>> {
    let away = Unit::new_normalize(*away);
    let axis = Vector3::ith(away.iamin(), 1.0);
    let one = Unit::new_normalize(away.cross(&axis));
    let other = Unit::new_normalize(away.cross(&one));
    vec![away, one, -one, other, -other]
}

/// Boxes are parallel to the cage's axes. `None` where neither is asked for.
fn shape(asked: &PlacedSection, center: &Point3<f64>) -> Option<Shape> {
    let center = center.coords.into();
    match (asked.radius_m, asked.size_m) {
        (Some(radius), _) => Shape::sphere(center, radius).ok(),
        (None, Some(size)) => Shape::cuboid(center, size).ok(),
        (None, None) => None,
    }
}

fn section(asked: &PlacedSection, number: usize, center: &Point3<f64>) -> ObstacleSection {
    let center_m: [f64; 3] = center.coords.into();
    let sphere = asked.radius_m.map(|radius_m| SphereSection { center_m, radius_m });
    let cuboid = asked.size_m.filter(|_| sphere.is_none()).map(|size_m| BoxSection { center_m, size_m });
    ObstacleSection { name: name(number), cuboid, sphere, capsule: None, hull: None, mesh: None }
}

/// By the bounding box.
///
/// All of it within the walls.
fn inside(world: &World, shape: &Shape) -> bool {
    let bounds = shape.bounds();
    (0..3).all(|axis| bounds.min[axis] >= 0.0 && bounds.max[axis] <= world.size()[axis])
}
