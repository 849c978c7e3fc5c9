//! The beam on `hull`: FlightGoggles, 250 waypoints, width 5, start (10, 10, 10), end (20, 20, 20), no speed cap. Every
//! trajectory counted includes its graph: sampling, set-up, pruning.

use hairpin::feasibility::reach::{Hull, HullSettings, StepNode, StepReach, StepSettings};
use hairpin::math::random::named_seed;
use hairpin::search::{BeamOutcome, BeamSettings, Score, Task, beam};
use hairpin::world::{Sampling, World, sample_free};
use nalgebra::{Point3, Vector3};

use super::{Row, Target, rate, robot};
use crate::problem::Problem;

pub(super) fn rows() -> Vec<Row> {
    let row = |name, target, measure| Row { name, unit: "1/s", target: Some(Target::AtLeast(target)), measure };
    vec![
        row("beam-expansions", 700_000.0, expansions),
        row("beam-trajectories-8", 2_000.0, || trajectories(8, false)),
        row("beam-trajectories-10", 2_000.0, || trajectories(10, false)),
        row("beam-trajectories-50", 1_000.0, || trajectories(50, false)),
        row("beam-trajectories-50-revisits", 1_000.0, || trajectories(50, true)),
    ]
}

struct Bench {
    hull: Hull,
    graphs: Vec<Vec<Point3<f64>>>,
}

impl Bench {
    fn new(graphs: u64) -> Result<Self, Problem> {
        let hull = Hull::new(&robot("flightgoggles")?, &HullSettings::default()).map_err(Problem::input)?;
        let world = World::new(Vector3::repeat(30.0), 0.0, Vec::new()).map_err(Problem::input)?;
        let sample = |graph| {
            let free = sample_free(&world, 250, 0.0, Sampling::Uniform, named_seed(1, "bench graph", graph));
            let mut points = vec![Point3::new(10.0, 10.0, 10.0)];
            points.extend(free.map_err(Problem::input)?);
            points.push(Point3::new(20.0, 20.0, 20.0));
            Ok(points)
        };
        Ok(Self { hull, graphs: (0..graphs).map(sample).collect::<Result<_, Problem>>()? })
    }

    fn solve(&self, points: &[Point3<f64>], settings: &BeamSettings) -> Result<BeamOutcome<StepNode>, Problem> {
        let hull = &self.hull;
        let reach = StepReach::new(hull, points, StepSettings::default());
        let end = points[points.len() - 1].coords;
        let may_arrive = |node: &StepNode, steps: usize| {
            let (before, now) = (points[node.previous as usize], points[node.current as usize]);
            hull.may_reach(&now.coords, &(now - before), &end, steps as u32)
        };
        let score = Score::named("high-velocity-90", 0, hull.farthest() / hull.step());
        let score = score.map_err(Problem::input)?;
        let task = Task { start: StepNode { previous: 0, current: 0 }, candidates: points, reach: &reach };
        Ok(beam(&task, &score, may_arrive, settings))
    }

    /// Items per second over all graphs.
    fn sweep(&self, settings: &BeamSettings, items: fn(BeamOutcome<StepNode>) -> u64) -> Result<f64, Problem> {
        // What can go wrong goes wrong the first time.
        self.solve(&self.graphs[0], settings)?;
        let all = || self.graphs.iter().filter_map(|points| self.solve(points, settings).ok()).map(items).sum();
        Ok(rate(3, all))
    }
}

fn expansions() -> Result<f64, Problem> {
    let settings = BeamSettings { length: 50, per_graph: usize::MAX, iterations: 400, ..Default::default() };
    Bench::new(20)?.sweep(&settings, |outcome| outcome.expansions)
}

fn trajectories(length: usize, revisits: bool) -> Result<f64, Problem> {
    let settings = BeamSettings { length, revisits, ..Default::default() };
    Bench::new(200)?.sweep(&settings, |outcome| outcome.found.len() as u64)
}
