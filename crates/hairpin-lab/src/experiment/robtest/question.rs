//! Clouds in cells as RobTest was measured on, and the three threats that its authors named: points that lie in
//! clusters, obstacles that thin the graph out, costs that are no distances.
//!
//! Source: Collet, Gotlieb, Lazaar & Mossige, "Stress testing of single-arm robots through constraint-based generation
//! of continuous trajectories" (2019), sections IV-B and IV-F.

use hairpin::feasibility::reachability::{CartesianSettings, ReachabilityGraph, cartesian};
use hairpin::math::random::{Stream, named_seed, stream, unit};
use hairpin::search::heaviest::{Arcs, Workspace};
use hairpin::world::cell::{Cell, Part, Region};
use hairpin::world::{Shape, WorldError};
use hairpin_jobs::Problem;
use nalgebra::Point3;

/// Where the arm reaches.
const WORKSPACE: Workspace = Workspace::PUBLISHED;
/// Half the size of an obstacle, from and to, m: a box's half edge, a ball's or a cylinder's radius.
const OBSTACLE: [f64; 2] = [0.03, 0.08];

/// A cloud in a cell.
#[derive(Debug, Clone)]
pub(super) struct Question {
    /// The points, m.
    pub(super) points: Vec<Point3<f64>>,
    /// What the straight moves between them must keep clear of.
    pub(super) cell: Cell,
}

impl Question {
    /// The published kind: `points` points uniform in the workspace, whose core is the only obstacle.
    ///
    /// # Errors
    /// None in practice: the workspace's own numbers are shapes.
    pub(super) fn published(points: usize, seed: u64) -> Result<Self, Problem> {
        Ok(Self { points: WORKSPACE.points(points, seed), cell: empty_cell().map_err(Problem::input)? })
    }

    /// The same among `obstacles` boxes, balls and upright cylinders of 60 to 160 mm, uniform in the workspace; no
    /// point lies in one.
    ///
    /// # Errors
    /// As [`published`](Self::published).
    pub(super) fn among_obstacles(points: usize, obstacles: usize, seed: u64) -> Result<Self, Problem> {
        let cell = filled_cell(obstacles, seed).map_err(Problem::input)?;
        // More than enough: even forty obstacles leave most of the workspace free.
        let drawn = WORKSPACE.points(20 * points + 1000, seed);
        let free = |p: &Point3<f64>| !cell.parts.iter().any(|part| part.region.meets(p, p, 0.0));
        Ok(Self { points: drawn.into_iter().filter(free).take(points).collect(), cell })
    }

    /// Points in `clusters` clusters with a deviation of `spread` m.
    ///
    /// # Errors
    /// As [`published`](Self::published).
    pub(super) fn clustered(points: usize, clusters: usize, spread: f64, seed: u64) -> Result<Self, Problem> {
        let points = WORKSPACE.clustered(points, clusters, spread, seed);
        Ok(Self { points, cell: empty_cell().map_err(Problem::input)? })
    }

    /// The seed of question number `index` of so many `points`, the same in all experiments of the seed `root`.
    pub(super) fn seed(root: u64, points: usize, index: u64) -> u64 {
        named_seed(root, "robtest", 1000 * points as u64 + index)
    }

    /// The reachability graph, every arc proven; costs are distances in whole micrometres.
    pub(super) fn graph(&self) -> ReachabilityGraph {
        cartesian(&self.points, &self.cell, &CartesianSettings::default())
    }
}

/// The reach, and the core around the arm's base.
fn empty_cell() -> Result<Cell, WorldError> {
    let centre = WORKSPACE.centre();
    let (at, [reach, core]) = ([centre.x, centre.y, centre.z], WORKSPACE.radii());
    let part = |name: &str, region| Part { name: name.into(), region };
    Ok(Cell {
        parts: vec![
            part("reach", Region::beyond(at, reach)?),
            part("core", Region::Shape(Shape::sphere(at, core)?)),
            part("floor", Region::half_space([0.0, 0.0, 1.0], -1e-9)?),
        ],
    })
}

/// The same with `obstacles` obstacles.
fn filled_cell(obstacles: usize, seed: u64) -> Result<Cell, WorldError> {
    let mut cell = empty_cell()?;
    let mut random = stream(named_seed(seed, "obstacles", 0));
    let centres = WORKSPACE.points(obstacles, named_seed(seed, "centres", 0));
    for (number, centre) in centres.iter().enumerate() {
        let [a, b, c] = [0; 3].map(|_| OBSTACLE[0] + (OBSTACLE[1] - OBSTACLE[0]) * unit(&mut random));
        let at = [centre.x, centre.y, centre.z];
        let region = match number % 3 {
            0 => Region::Shape(Shape::cuboid(at, [2.0 * a, 2.0 * b, 2.0 * c])?),
            1 => Region::Shape(Shape::sphere(at, a)?),
            _ => Region::cylinder([at[0], at[1], at[2] - b], [at[0], at[1], at[2] + b], a)?,
        };
        cell.parts.push(Part { name: format!("obstacle {number}"), region });
    }
    Ok(cell)
}

/// What an arc costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Costs {
    /// Its length, µm: the published one.
    Distance,
    /// The square of its length: two legs may cost more or less than the leg past them, so no triangle inequality.
    Squared,
    /// Uniform, the same in both directions.
    Random,
    /// Its length times 1 ± this, each direction on its own.
    Skewed(f64),
    /// Uniform, each direction on its own.
    RandomDirected,
    /// All arcs cost the same: the longest path, with as many best ones as can be.
    Equal,
}

/// Largest of the costs that are no distances.
const LARGEST: f64 = 1e6;

impl Costs {
    /// The arcs of `graph` at these costs.
    ///
    /// # Errors
    /// A graph without points.
    pub(super) fn of(self, graph: &ReachabilityGraph, seed: u64) -> Result<Arcs, Problem> {
        let n = graph.points();
        let mut random = stream(named_seed(seed, "costs", 0));
        let mut costs = graph.matrix();
        for from in 0..n {
            for to in 0..n {
                if let Some(length) = graph.cost(from, to) {
                    let mirrored = (from > to).then(|| costs[to * n + from]).flatten();
                    costs[from * n + to] = Some(self.draw(length, mirrored, &mut random));
                }
            }
        }
        Arcs::new(n, &costs).map_err(Problem::input)
    }

    /// The cost of an arc of `length` µm; `mirrored` is what the same arc costs the other way, if that is known.
    fn draw(self, length: i64, mirrored: Option<i64>, random: &mut Stream) -> i64 {
        let uniform = |random: &mut Stream| (LARGEST * unit(random)).round() as i64;
        match self {
            Self::Distance => length,
            // mm², as exact as it is needed.
            Self::Squared => ((length as f64 * 1e-3) * (length as f64 * 1e-3)).round() as i64,
            Self::Random => mirrored.unwrap_or_else(|| uniform(random)),
            Self::Skewed(by) => (length as f64 * (1.0 + by * (2.0 * unit(random) - 1.0))).round() as i64,
            Self::RandomDirected => uniform(random),
            Self::Equal => LARGEST as i64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn proven_graphs_of_the_published_kind_are_those_of_the_closed_form() {
        let question = Question::published(60, 4).unwrap();
        let (graph, arcs) = (question.graph(), WORKSPACE.arcs(&question.points).unwrap());
        for i in 0..60 {
            for j in (0..60).filter(|j| *j != i) {
                assert_eq!(graph.cost(i, j), arcs.cost(i, j), "{i}→{j}");
            }
        }
    }

    #[test]
    fn obstacles_thin_the_graph_out_and_hold_no_point() {
        let density = |obstacles| {
            let question = Question::among_obstacles(80, obstacles, 9).unwrap();
            assert_eq!((question.points.len(), question.cell.parts.len()), (80, 3 + obstacles));
            question.graph().density()
        };
        let densities = [0, 20, 60].map(density);
        assert!(densities.windows(2).all(|pair| pair[1] < pair[0] - 0.04), "{densities:?}");
        assert!(densities[0] > 0.7 && densities[2] > 0.02, "{densities:?}");
    }

    #[test]
    fn costs_are_of_their_kind() {
        let graph = Question::published(30, 2).unwrap().graph();
        let arcs = |costs: Costs| costs.of(&graph, 7).unwrap();
        for (costs, symmetric) in [
            (Costs::Distance, true),
            (Costs::Squared, true),
            (Costs::Random, true),
            (Costs::Equal, true),
            (Costs::Skewed(0.3), false),
            (Costs::RandomDirected, false),
        ] {
            let table = arcs(costs);
            assert_eq!(table.symmetric(), symmetric, "{costs:?}");
            assert!((0..30).all(|i| (0..30).all(|j| table.cost(i, j).is_some() == graph.is_free(i, j))), "{costs:?}");
            assert_eq!(table, arcs(costs), "{costs:?}");
        }
        let skewed = arcs(Costs::Skewed(0.3));
        let pairs = (0..30).flat_map(|i| (0..30).map(move |j| (i, j)));
        let ratios = pairs.filter_map(|(i, j)| Some(skewed.cost(i, j)? as f64 / graph.cost(i, j)? as f64));
        let (low, high) = ratios.fold((9.0f64, 0.0f64), |(low, high), r| (low.min(r), high.max(r)));
        assert!((0.699..0.75).contains(&low) && (1.25..1.301).contains(&high), "{low} {high}");
        let random = arcs(Costs::Random);
        let violated = (0..30).any(|i| {
            (0..30).any(|j| {
                let leg = |a: usize, b: usize| random.cost(a, b);
                (0..30).any(|k| matches!((leg(i, j), leg(i, k), leg(k, j)), (Some(d), Some(a), Some(b)) if d > a + b))
            })
        });
        assert!(violated);
    }
}
