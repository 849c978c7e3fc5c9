//! Obstacles placed where a flight leaves its plan: clear of every planned leg, and in the flight's way.

use nalgebra::{Point3, Unit, Vector3};

use super::FlightSetup;
use crate::campaign::Case;
use crate::campaign::scenario::{BoxSection, ObstacleSection, PlacedSection, SphereSection};
use crate::feasibility::collision::FreeSpace;
use crate::math::segment;
use crate::trajectory::Track;
use crate::world::{Obstacle, Shape, World};

/// Samples of a flight that obstacles are put to, at most.
const SAMPLES: usize = 150;
/// Chords of a planned leg that is not straight.
const CHORDS: usize = 12;
/// What obstacles keep from the plan beyond the robot's radius, m: a little at first, more where chords hide what is nearer.
const GAPS: [f64; 2] = [0.001, 0.05];
/// A flight that keeps closer than this to its plan gives no direction, m.
const LEAST: f64 = 1e-4;
/// Steps of an obstacle away from what it is too near to.
const STEPS: usize = 25;

/// Obstacles, and how near the flight came to them.
pub(in crate::campaign) struct Placement {
    pub(in crate::campaign) obstacles: Vec<ObstacleSection>,
    /// Least distance of the robot's ball to any of them, as if they had not stopped it; m, negative inside.
    pub(in crate::campaign) clearance: f64,
    /// The leg that was flown there.
    pub(in crate::campaign) leg: usize,
}

/// Up to `asked.count` obstacles of the shape asked for in the way of `track`, the flight of `case` without them; those first that it gets
/// into the deepest. `None` where there is no room for any.
pub(in crate::campaign) fn place(
    setup: &FlightSetup,
    case: &Case,
    track: &Track,
    asked: &PlacedSection,
) -> Option<Placement> {
    let radius = setup.robot.clearance_radius;
    let way = way(case);
    let stride = track.len().div_ceil(SAMPLES).max(1);
    let mut samples: Vec<(f64, Point3<f64>, Point3<f64>)> = (0..track.len())
        .step_by(stride)
        .map(|index| {
            let p = track.position(index);
            let nearest = nearest(&way, &p);
            ((p - nearest).norm(), p, nearest)
        })
        .filter(|(apart, ..)| *apart > LEAST && apart.is_finite())
        .collect();
    samples.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut placed: Vec<(ObstacleSection, Shape)> = Vec::new();
    // First what is met; where that finds no room, what is only near.
    for met in [true, false] {
        for (_, p, nearest) in &samples {
            // What stands there already is met there.
            let taken = placed.iter().any(|(_, shape)| shape.signed_distance(p) < radius);
            if taken || placed.len() as u64 == asked.count {
                continue;
            }
            let found = directions(&(p - nearest)).into_iter().find_map(|away| {
                GAPS.iter().find_map(|gap| {
                    let (section, shape) = beside(asked, &way, p, &away, radius + gap)?;
                    let near = !met || shape.signed_distance(p) < radius;
                    (near && inside(setup.world, &shape) && leaves_clear(setup, case, &shape))
                        .then_some((section, shape))
                })
            });
            placed.extend(found);
        }
    }
    let legs = track.channel("leg");
    let mut least: Option<(f64, usize)> = None;
    for index in 0..track.len() {
        let p = track.position(index);
        for (_, shape) in &placed {
            let clearance = shape.signed_distance(&p) - radius;
            if least.is_none_or(|(so_far, _)| clearance < so_far) {
                least = Some((clearance, legs.map_or(0, |legs| legs[index].max(0.0) as usize)));
            }
        }
    }
    let (clearance, leg) = least?;
    let name = |(number, (section, _)): (usize, (ObstacleSection, Shape))| ObstacleSection {
        name: format!("placed {number}"),
        ..section
    };
    Some(Placement { obstacles: placed.into_iter().enumerate().map(name).collect(), clearance, leg })
}

/// Whether every planned leg of `case` keeps the robot's radius from `shape`: its witness everywhere on it, else its straight legs.
fn leaves_clear(setup: &FlightSetup, case: &Case, shape: &Shape) -> bool {
    let radius = setup.robot.clearance_radius;
    let Some(profile) = &case.profile else {
        return case.waypoints.windows(2).all(|leg| shape.segment_distance(&leg[0], &leg[1]) >= radius);
    };
    let obstacle = Obstacle { name: String::new(), shape: shape.clone() };
    let Ok(world) = World::new(setup.world.size(), 0.0, vec![obstacle]) else { return false };
    let space = FreeSpace::new(&world, radius);
    profile.legs.iter().all(|leg| space.contains(leg).is_ok())
}

/// The plan as a chain of segments.
fn way(case: &Case) -> Vec<Point3<f64>> {
    let Some(profile) = &case.profile else { return case.waypoints.clone() };
    let along = profile
        .legs
        .iter()
        .flat_map(|leg| (0..CHORDS).map(move |chord| leg.position(leg.duration * chord as f64 / CHORDS as f64)));
    along.chain(case.waypoints.last().copied()).collect()
}

fn nearest(way: &[Point3<f64>], p: &Point3<f64>) -> Point3<f64> {
    let points = way.windows(2).map(|leg| segment::nearest_point(p, &leg[0], &leg[1]));
    points.min_by(|a, b| (p - a).norm_squared().total_cmp(&(p - b).norm_squared())).unwrap_or(*p)
}

/// Directions in which an obstacle may give way: away from the plan, and across that.
fn directions(away: &Vector3<f64>) -> [Unit<Vector3<f64>>; 5] {
    let away = Unit::new_normalize(*away);
    let axis = Vector3::ith(away.iamin(), 1.0);
    let one = Unit::new_normalize(away.cross(&axis));
    let other = Unit::new_normalize(away.cross(&one));
    [away, one, -one, other, -other]
}

/// The obstacle nearest to `p`, in the direction `away`, that is `apart` from all of `way`: moved from what it is too near to until it is not.
fn beside(
    asked: &PlacedSection,
    way: &[Point3<f64>],
    p: &Point3<f64>,
    away: &Unit<Vector3<f64>>,
    apart: f64,
) -> Option<(ObstacleSection, Shape)> {
    let mut center = p + away.as_ref() * LEAST;
    for _ in 0..STEPS {
        let (section, shape) = section(asked, center)?;
        let distances = way.windows(2).map(|leg| (shape.segment_distance(&leg[0], &leg[1]), leg));
        let (distance, leg) = distances.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let short = apart - distance;
        if short <= 0.0 {
            return Some((section, shape));
        }
        let from = center - segment::nearest_point(&center, &leg[0], &leg[1]);
        let direction = Unit::try_new(from, LEAST * LEAST).unwrap_or(*away);
        // A little more than it lacks, so that few steps are enough.
        center += direction.as_ref() * (1.01 * short + LEAST);
    }
    None
}

fn section(asked: &PlacedSection, center: Point3<f64>) -> Option<(ObstacleSection, Shape)> {
    let center_m: [f64; 3] = center.coords.into();
    let bare =
        ObstacleSection { name: String::new(), cuboid: None, sphere: None, capsule: None, hull: None, mesh: None };
    match (asked.radius_m, asked.size_m) {
        (Some(radius_m), _) => {
            let sphere = Some(SphereSection { center_m, radius_m });
            Some((ObstacleSection { sphere, ..bare }, Shape::sphere(center_m, radius_m).ok()?))
        }
        (None, Some(size_m)) => {
            let cuboid = Some(BoxSection { center_m, size_m });
            Some((ObstacleSection { cuboid, ..bare }, Shape::cuboid(center_m, size_m).ok()?))
        }
        (None, None) => None,
    }
}

fn inside(world: &World, shape: &Shape) -> bool {
    let bounds = shape.bounds();
    (0..3).all(|axis| bounds.min[axis] >= 0.0 && bounds.max[axis] <= world.size()[axis])
}
