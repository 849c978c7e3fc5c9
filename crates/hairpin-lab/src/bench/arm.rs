//! The reachability graph of arms: 1000 points against a sphere, a box and a cylinder; 50 points with every link of an
//! arm; 16 with arcs, and their search.

use std::f64::consts::PI;

use hairpin::feasibility::reachability::joint::{Cost, JointSettings, Station, arcs, joint};
use hairpin::feasibility::reachability::{CartesianSettings, Level, ReachabilityGraph, cartesian};
use hairpin::math::random::{Stream, named_seed, stream, unit};
use hairpin::math::rotation::{quaternion_from_euler, unit_quaternion};
use hairpin::robot::arm::{Arm, Tool};
use hairpin::search::heaviest::{Arcs, HeaviestSettings, Triples, heaviest_with_triples};
use hairpin::world::Shape;
use hairpin::world::cell::{Cell, Part, Region};
use hairpin_formats::scenario::arm_for;
use hairpin_jobs::Problem;
use nalgebra::{Isometry3, Point3, Translation3};

use super::row::Row;
use crate::clock::median_time;

/// Points of the Cartesian graph and of the one in joints.
const POINTS: [usize; 2] = [1000, 50];
/// Points of the one with arcs.
const WITH_ARCS: usize = 16;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::at_most("arm-cartesian-1000-certified", "ms", 30.0, |_| Ok(1e3 * graph_time(Level::Certified)?)),
        Row::at_most("arm-cartesian-1000-over-float", "1", 3.0, |_| {
            Ok(graph_time(Level::Certified)? / graph_time(Level::Fast)?)
        }),
        Row::at_most("arm-joint-50", "s", 1.0, |_| joint_time()),
        Row::unbound("arm-arcs-16", "ms", |_| Ok(1e3 * arcs_times()?[0])),
        Row::unbound("arm-arcs-16-search", "ms", |_| Ok(1e3 * arcs_times()?[1])),
    ]
}

fn cell(regions: Vec<(&str, Region)>) -> Cell {
    Cell { parts: regions.into_iter().map(|(name, region)| Part { name: name.into(), region }).collect() }
}

/// Uniform in the workspace of the paper's experiment: a reach sphere of 580 mm at (0, 0, 290) mm, above the floor.
fn cloud(random: &mut Stream) -> Vec<Point3<f64>> {
    let centre = Point3::new(0.0, 0.0, 0.29);
    let mut points = Vec::with_capacity(POINTS[0]);
    while points.len() < POINTS[0] {
        let mut side = || 1.16 * unit(random) - 0.58;
        let p = Point3::new(side(), side(), 0.29 + side());
        let distance = (p - centre).norm();
        if distance < 0.58 && distance > 0.19 && p.z > 0.0 {
            points.push(p);
        }
    }
    points
}

/// Seconds of a graph of 1000 points, every pair against every part.
fn graph_time(level: Level) -> Result<f64, Problem> {
    let cell = cell(vec![
        ("unreachable", Region::Shape(Shape::sphere([0.0, 0.0, 0.29], 0.19).map_err(Problem::input)?)),
        ("fixture", Region::Shape(Shape::cuboid([0.35, 0.25, 0.1], [0.12, 0.12, 0.2]).map_err(Problem::input)?)),
        ("post", Region::cylinder([-0.3, 0.2, 0.0], [-0.3, 0.2, 0.4], 0.06).map_err(Problem::input)?),
    ]);
    let points = cloud(&mut stream(named_seed(1, "bench arm", 0)));
    let settings = CartesianSettings { level, ..Default::default() };
    let graph = || -> ReachabilityGraph { cartesian(&points, &cell, &settings) };
    tracing::info!("density {:.3}, {:.2} questions a pair", graph().density(), graph().queries_per_pair());
    Ok(median_time(7, graph))
}

/// An IRB 120 with a tool between two boxes.
fn between_boxes() -> Result<(Arm, Tool, Cell), Problem> {
    let tool =
        Tool::new("tGrip", [0.0, 0.0, 80.0], [1.0, 0.0, 0.0, 0.0], 20.0, 0.8, [0.0; 3]).map_err(Problem::input)?;
    let cell = cell(vec![
        ("fixture", Region::Shape(Shape::cuboid([0.35, 0.25, 0.1], [0.12, 0.12, 0.2]).map_err(Problem::input)?)),
        ("column", Region::Shape(Shape::cuboid([0.38, -0.05, 0.1], [0.06, 0.06, 0.3]).map_err(Problem::input)?)),
    ]);
    Ok((arm_for("irb120")?, tool, cell))
}

/// Places in front of it, the tool down.
fn stations(count: usize) -> Vec<Station> {
    let mut random = stream(named_seed(1, "bench arm", 1));
    let down = unit_quaternion(&quaternion_from_euler(0.0, PI, 0.0));
    (0..count)
        .map(|_| {
            let (radius, angle) = (0.28 + 0.17 * unit(&mut random), 2.4 * (unit(&mut random) - 0.5));
            let at = Translation3::new(radius * angle.cos(), radius * angle.sin(), 0.15 + 0.3 * unit(&mut random));
            Station { pose: Isometry3::from_parts(at, down), configuration: None }
        })
        .collect()
}

/// Seconds of a graph of 50 poses, every ordered pair, every link.
fn joint_time() -> Result<f64, Problem> {
    let ((arm, tool, cell), stations) = (between_boxes()?, stations(POINTS[1]));
    let graph = || joint(&arm, &tool, &cell, &stations, &JointSettings::default(), &Cost::Distance);
    let found = graph();
    tracing::info!("density {:.3}, {:.0} questions a pair", found.graph.density(), found.graph.queries_per_pair());
    Ok(median_time(3, graph))
}

/// Seconds of all arcs between 16 poses, and of the proof of the heaviest path with them.
fn arcs_times() -> Result<[f64; 2], Problem> {
    let ((arm, tool, cell), stations) = (between_boxes()?, stations(WITH_ARCS));
    let (settings, cost) = (JointSettings::default(), Cost::Distance);
    let pairs = joint(&arm, &tool, &cell, &stations, &settings, &cost);
    let all = || arcs(&arm, &tool, &cell, &stations, &pairs.joints, &settings, &cost);
    let found = all();
    tracing::info!("{} of {} arcs are possible", found.free.len(), found.free.len() + found.refused.len());
    let straight = Arcs::new(WITH_ARCS, &pairs.graph.matrix()).map_err(Problem::input)?;
    let triples = Triples::new(WITH_ARCS, &found.free).map_err(Problem::input)?;
    let settings = HeaviestSettings::default();
    let search = || heaviest_with_triples(&straight, &triples, &settings, &|| false).map(|found| found.bound);
    search().map_err(Problem::input)?;
    Ok([median_time(3, all), median_time(5, search)])
}
