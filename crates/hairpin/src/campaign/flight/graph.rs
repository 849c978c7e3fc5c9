//! Sampling one graph: start, free waypoints, end.
//!
//! A graph is a list of places: who may follow whom is the reach set's business. Graphs are numbered, and each is made
//! from its number alone, so that they may be searched in any order and on any thread.

use nalgebra::Point3;

use super::FlightSetup;
use crate::math::random::named_seed;
use crate::world::{self, SamplingError};

/// The waypoints of graph number `graph`: index 0 the start, the last the end, free ones between.
///
/// m, in the cage's frame; free ones keep the robot's radius from obstacles. The same seed and number give the same
/// graph.
///
/// # Errors
/// Too little free space.
///
/// Free ones keep the keep-in margin from the walls too. Start and end are not sampled and were checked with the task.
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
