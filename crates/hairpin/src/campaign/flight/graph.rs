//! Sampling one graph: start, free waypoints, end.

use nalgebra::Point3;

use super::FlightSetup;
use crate::math::random::named_seed;
use crate::world::{self, SamplingError};

/// The waypoints of graph number `graph`: index 0 the start, the last the end, free ones between.
///
/// # Errors
/// Too little free space.
pub(super) fn sample(setup: &FlightSetup, graph: u64) -> Result<Vec<Point3<f64>>, SamplingError> {
    let search = &setup.scenario.generate.search;
    let seed = named_seed(setup.scenario.seed, "graph", graph);
    let clearance = setup.robot.clearance_radius;
    let free = world::sample_free(&setup.world, search.waypoints as usize, clearance, search.sampling, seed)?;
    let mut points = Vec::with_capacity(free.len() + 2);
    points.push(Point3::from(setup.scenario.task.start_m));
    points.extend(free);
    points.push(Point3::from(setup.scenario.task.end_m));
    Ok(points)
}
