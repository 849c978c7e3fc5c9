//! Solids placed where an execution leaves its plan: clear of all of the plan, and in the way of what was executed.

use nalgebra::{Point3, Unit, Vector3};

use super::Environment;
use crate::math::segment;
use crate::trajectory::Track;
use crate::world::Shape;

/// Samples of an execution that solids are put to, at most.
const SAMPLES: usize = 150;
/// An execution that keeps closer than this to its plan gives no direction, m.
const LEAST: f64 = 1e-4;
/// Steps of a solid away from what it is too near to.
const STEPS: usize = 25;

/// A case's environment with what was placed in it, and how near the execution came to that.
pub(super) struct Placement {
    /// What surrounds the case then.
    pub(super) among: Environment,
    /// Least distance of the robot's ball to what was placed, as if that had not stopped it; m, negative inside.
    pub(super) clearance: f64,
    /// The leg that was executed there.
    pub(super) leg: usize,
}

/// What is to be placed, and where it may stand.
pub(super) struct Placing<'a> {
    /// The plan as a chain of segments, m.
    pub(super) way: &'a [Point3<f64>],
    /// How many at most.
    pub(super) count: usize,
    /// Radius of the robot's ball, m.
    pub(super) radius: f64,
    /// What they keep from the way beyond it, m: the first that they may stand with is taken.
    pub(super) gaps: &'a [f64],
    /// The solid about a centre; `None`: there is none.
    pub(super) shape: &'a dyn Fn(&Point3<f64>) -> Option<Shape>,
    /// Where it may give way to, seen from the plan towards the execution.
    pub(super) directions: fn(&Vector3<f64>) -> Vec<Unit<Vector3<f64>>>,
    /// Whether it may stand about a centre: in the world, and all of the plan proven clear of it.
    pub(super) stands: &'a dyn Fn(&Point3<f64>, &Shape) -> bool,
}

/// Where solids stand.
pub(super) struct Placed {
    /// Their centres, m.
    pub(super) centers: Vec<Point3<f64>>,
    /// As in [`Placement`].
    pub(super) clearance: f64,
    /// As in [`Placement`].
    pub(super) leg: usize,
}

impl Placing<'_> {
    /// Up to `count` solids in the way of `track`, whose samples are at `places`; those first that it gets into the
    /// deepest. `None` where there is no room for any.
    pub(super) fn in_the_way_of(&self, track: &Track, places: &[Point3<f64>]) -> Option<Placed> {
        let stride = places.len().div_ceil(SAMPLES).max(1);
        let mut samples: Vec<(f64, Point3<f64>, Point3<f64>)> = places
            .iter()
            .step_by(stride)
            .map(|p| {
                let nearest = self.nearest(p);
                ((p - nearest).norm(), *p, nearest)
            })
            .filter(|(apart, ..)| *apart > LEAST && apart.is_finite())
            .collect();
        samples.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut placed: Vec<(Point3<f64>, Shape)> = Vec::new();
        // First what is met; where that finds no room, what is only near.
        for met in [true, false] {
            for (apart, p, nearest) in &samples {
                // What stands there already is met there.
                let taken = placed.iter().any(|(_, shape)| shape.signed_distance(p) < self.radius);
                if taken || placed.len() == self.count {
                    continue;
                }
                // Nothing that keeps a gap from the plan is met by what leaves it by less.
                let gaps = self.gaps.iter().filter(|gap| !met || apart > *gap);
                let found = (self.directions)(&(p - nearest)).into_iter().find_map(|away| {
                    gaps.clone().find_map(|gap| {
                        let (center, shape) = self.beside(p, &away, self.radius + gap)?;
                        let near = !met || shape.signed_distance(p) < self.radius;
                        (near && (self.stands)(&center, &shape)).then_some((center, shape))
                    })
                });
                placed.extend(found);
            }
        }
        let legs = track.channel("leg");
        let mut least: Option<(f64, usize)> = None;
        for (index, p) in places.iter().enumerate() {
            for (_, shape) in &placed {
                let clearance = shape.signed_distance(p) - self.radius;
                if least.is_none_or(|(so_far, _)| clearance < so_far) {
                    least = Some((clearance, legs.map_or(0, |legs| legs[index].max(0.0) as usize)));
                }
            }
        }
        let (clearance, leg) = least?;
        Some(Placed { centers: placed.into_iter().map(|(center, _)| center).collect(), clearance, leg })
    }

    fn nearest(&self, p: &Point3<f64>) -> Point3<f64> {
        let points = self.way.windows(2).map(|leg| segment::nearest_point(p, &leg[0], &leg[1]));
        points.min_by(|a, b| (p - a).norm_squared().total_cmp(&(p - b).norm_squared())).unwrap_or(*p)
    }

    /// The solid nearest to `p`, in the direction `away`, that is `apart` from all of the way: moved from what it is
    /// too near to until it is not.
    fn beside(&self, p: &Point3<f64>, away: &Unit<Vector3<f64>>, apart: f64) -> Option<(Point3<f64>, Shape)> {
        let mut center = p + away.as_ref() * LEAST;
        for _ in 0..STEPS {
            let shape = (self.shape)(&center)?;
            let distances = self.way.windows(2).map(|leg| (shape.segment_distance(&leg[0], &leg[1]), leg));
            let (distance, leg) = distances.min_by(|a, b| a.0.total_cmp(&b.0))?;
            let short = apart - distance;
            if short <= 0.0 {
                return Some((center, shape));
            }
            let from = center - segment::nearest_point(&center, &leg[0], &leg[1]);
            let direction = Unit::try_new(from, LEAST * LEAST).unwrap_or(*away);
            // A little more than it lacks, so that few steps are enough.
            center += direction.as_ref() * (1.01 * short + LEAST);
        }
        None
    }
}

/// The name of the placed solid number `number`.
pub(super) fn name(number: usize) -> String {
    format!("placed {number}")
}
