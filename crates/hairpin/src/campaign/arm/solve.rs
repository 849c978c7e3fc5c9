//! The search: the heaviest paths through the reachability graph, made into programs.
//!
//! The graph's costs w (whole units, row = from) go to [`crate::search::heaviest`]: the path p₁ … pₘ that maximises Σ
//! w(pₖ, pₖ₊₁), each point at most once, or at most `visits` times with every move at most once. The moves from and
//! to home weigh nothing. Exact where the search ends within its time; a bound where it does not.

use super::ArmSetup;
use super::arm_graph::ArmGraph;
use super::program::Met;
use crate::campaign::graph::Plan;
use crate::campaign::scenario::ArmMode;
use crate::campaign::{Case, Evidence, Stop};
use crate::math::random::{named_seed, stream};
use crate::search::heaviest::{
    Arcs, Ends, Heaviest, HeaviestSettings, Method, Outcome as Found, Triples, WalkProof, WalkSettings, heaviest,
    heaviest_walk, heaviest_with_triples,
};
use crate::simulation::arm as controller;
use crate::trajectory::program::{Program, Speed, Zone};

/// Nodes of a search for the heaviest walk that only begins another one.
///
/// The walk that a random search begins from need not be proven heaviest.
const MOST_NODES: u64 = 100;

/// A graph as it is searched.
#[derive(Debug, Clone)]
pub struct Question {
    /// Points of the cloud, and where there are two more, home.
    pub points: usize,
    /// Whole costs, row = from.
    pub costs: Vec<Option<i64>>,
    /// First and last point, where they are fixed.
    pub ends: Ends,
}

impl ArmSetup {
    /// The programs along the paths that were found, as cases of a campaign.
    ///
    /// Numbered in the order of the paths, from 0; graph 0.
    pub fn cases(&self, graph: &ArmGraph, found: &Heaviest) -> Vec<Case> {
        let paths = found.paths.iter().enumerate();
        let plans = paths.map(|(number, (cost, rows))| (number, self.plan(graph, rows, *cost, found, number)));
        plans.map(|(number, plan)| plan.case(self.scenario.seed, 0, number)).collect()
    }

    /// What is searched: the graph's costs, and where not every point can be a first and a last one, home as two points
    /// more: one with free arcs to where programs may begin, one with free arcs from where they may end.
    ///
    /// Home's two points are row n (out) and row n + 1 (back). Where every point can begin and end a program the
    /// question has the cloud's n points alone.
    ///
    /// ```text
    /// w(n, to) = 0         where home can be left for `to`
    /// w(from, n + 1) = 0   where `from` can be left for home
    /// w(from, to)          as in the graph; every other pair with home has no arc
    /// ```
    ///
    /// So the sum over a path with home is the sum over the cloud's moves alone. O(n²) in time and memory. Where a
    /// start or an end is fixed and home is in the question, only that row has an arc from home, or to it.
    pub fn question(&self, graph: &ArmGraph) -> Question {
        let search = &self.scenario.generate.search;
        let n = graph.points();
        let (first, last) = (search.start.map(|row| row as usize), search.end.map(|row| row as usize));
        let may_begin = |row: usize| graph.from_home[row] && first.is_none_or(|first| first == row);
        let may_end = |row: usize| graph.to_home[row] && last.is_none_or(|last| last == row);
        if (0..n).all(|row| graph.from_home[row] && graph.to_home[row]) {
            return Question { points: n, costs: graph.costs.clone(), ends: Ends { start: first, end: last } };
        }
        let arc = |from: usize, to: usize| match (from, to) {
            (from, to) if from < n && to < n => graph.costs[from * n + to],
            (from, to) if from == n && to < n => may_begin(to).then_some(0),
            (from, to) if from < n && to == n + 1 => may_end(from).then_some(0),
            _ => None,
        };
        let pairs = (0..n + 2).flat_map(|from| (0..n + 2).map(move |to| (from, to)));
        let ends = Ends { start: Some(n), end: Some(n + 1) };
        Question { points: n + 2, costs: pairs.map(|(from, to)| arc(from, to)).collect(), ends }
    }

    /// The heaviest paths through `graph`, in rows of the cloud, that home can be left for and reached from.
    ///
    /// # Errors
    /// Costs that no search takes, in a sentence's part.
    ///
    /// `generate.search.programs` of them at most, by falling cost. An empty list has an outcome other than `Found`;
    /// a path of one point, which no move of the graph is on, counts as none. `stop` and
    /// `generate.search.time_limit_s` end the search with what was found by then.
    pub fn heaviest(&self, graph: &ArmGraph, stop: &Stop) -> Result<Heaviest, String> {
        self.heaviest_of(graph, self.scenario.generate.search.programs as usize, None, stop)
    }

    /// The same, so many of them, by a method of one's own where points come once and moves pass none.
    pub(super) fn heaviest_of(
        &self,
        graph: &ArmGraph,
        programs: usize,
        method: Option<Method>,
        stop: &Stop,
    ) -> Result<Heaviest, String> {
        let (mut found, _) = self.search(graph, &self.question(graph), programs, (false, method), stop)?;
        for (_, path) in &mut found.paths {
            path.retain(|row| *row < graph.points());
        }
        // Home, a point and home again loads no move of the graph: paths of no arc are the heaviest where there is
        // none.
        let moves: Vec<bool> = found.paths.iter().map(|(_, path)| path.len() > 1).collect();
        let mut of_path = moves.iter();
        found.passed.retain(|_| of_path.next().is_none_or(|moves| *moves));
        found.paths.retain(|(_, path)| path.len() > 1);
        if found.paths.is_empty() && found.outcome == Found::Found {
            (found.outcome, found.bound) = (Found::Infeasible, None);
        }
        Ok(found)
    }

    /// The question, its heaviest path (home and all), and what proves it; `None` where it is not proven in time.
    ///
    /// # Errors
    /// As [`Self::heaviest`].
    ///
    /// Of the question's own rows: where home is in it, rows n and n + 1 are the first and the last of the path.
    pub fn optimum(
        &self,
        graph: &ArmGraph,
        stop: &Stop,
    ) -> Result<Option<(Question, Heaviest, Option<WalkProof>)>, String> {
        let question = self.question(graph);
        let (found, walk) = self.search(graph, &question, 1, (true, None), stop)?;
        let of_cloud = |path: &[usize]| path.iter().filter(|row| **row < graph.points()).count();
        let proven = found.proven && found.paths.first().is_some_and(|(_, path)| of_cloud(path) > 1);
        Ok(proven.then_some((question, found, walk)))
    }

    /// The clock is asked against `time_limit_s` from where this begins; `min_cost`, in the graph's unit, is rounded
    /// up to whole ones. `method` is for paths whose points come once; with more visits it cuts the search off after
    /// [`MOST_NODES`] nodes instead.
    fn search(
        &self,
        graph: &ArmGraph,
        question: &Question,
        programs: usize,
        (proof, method): (bool, Option<Method>),
        stop: &Stop,
    ) -> Result<(Heaviest, Option<WalkProof>), String> {
        let search = &self.scenario.generate.search;
        let arcs = Arcs::new(question.points, &question.costs).map_err(|error| error.to_string())?;
        let begun = (stop.clock)();
        let over = || (stop.cancelled)() || search.time_limit_s.is_some_and(|limit| (stop.clock)() - begun >= limit);
        let (ends, min_cost) = (question.ends, search.min_cost.map(|least| (least / graph.unit).ceil() as i64));
        if search.visits > 1 {
            let visits = search.visits as usize;
            let most_nodes = method.map(|_| MOST_NODES);
            let settings = WalkSettings { ends, visits, min_cost, programs, most_nodes, proof };
            return heaviest_walk(&arcs, &settings, &over).map_err(|error| error.to_string());
        }
        let settings = HeaviestSettings {
            ends,
            min_cost,
            programs,
            method: method.unwrap_or_default(),
            seed: self.scenario.seed,
            proof,
            ..HeaviestSettings::default()
        };
        if let Some(through) = &graph.arcs {
            let triples = Triples::new(question.points, &through.free).map_err(|error| error.to_string())?;
            let found = heaviest_with_triples(&arcs, &triples, &settings, &over).map_err(|error| error.to_string())?;
            return Ok((found, None));
        }
        heaviest(&arcs, &settings, &over).map(|found| (found, None)).map_err(|error| error.to_string())
    }

    /// Why there is no program, in a sentence's part.
    pub fn why_none(&self, graph: &ArmGraph, found: &Heaviest) -> String {
        match found.outcome {
            Found::BelowMinCost => format!(
                "none costs {} {}: the bound is {}",
                self.scenario.generate.search.min_cost.unwrap_or(0.0),
                graph.unit_name,
                found.bound.map_or("not known".into(), |bound| (bound as f64 * graph.unit).to_string())
            ),
            Found::NotFound => "none of the wanted cost was found in time".into(),
            Found::Infeasible | Found::Found if graph.points() == 1 => {
                "the cloud has one point, and a program goes from one to another at least".into()
            }
            Found::Infeasible | Found::Found if graph.costs.iter().all(Option::is_none) => {
                "no move from one point of the cloud to another is possible".into()
            }
            Found::Infeasible | Found::Found => {
                "none leads from home through two points of the cloud or more, and back".into()
            }
        }
    }

    /// Speeds and zones come from the stream `moves` of the scenario's seed and `number`: the same for every run.
    pub(super) fn plan(&self, graph: &ArmGraph, rows: &[usize], cost: i64, found: &Heaviest, number: usize) -> Plan {
        let passed = found.passed.get(number).map_or(&[][..], Vec::as_slice);
        let mut random = stream(named_seed(self.scenario.seed, "moves", number as u64));
        let met = |(row, (speed, zone)): (&usize, (Speed, Zone))| Met {
            row: *row,
            configuration: graph.configuration(self, *row),
            speed,
            zone,
            passed: passed.contains(row),
        };
        let way: Vec<Met> = rows.iter().zip(self.drawn_moves(rows.len(), &mut random)).map(met).collect();
        Plan {
            score: cost as f64 * graph.unit,
            // The bound of the heaviest holds for all that come after it.
            bound: found.bound.map(|bound| bound as f64 * graph.unit).filter(|_| number == 0),
            ..self.planned(graph, &way, number)
        }
    }

    /// The program along `way` as program number `number`, without a score.
    pub(super) fn planned(&self, graph: &ArmGraph, way: &[Met], number: usize) -> Plan {
        let station = &self.station;
        let rows: Vec<usize> = way.iter().map(|met| met.row).collect();
        let program = self.program(way, number, |k, zone| graph.blends(self, &rows, k, zone));
        let home = station.tool_at(&station.home);
        // Where moves end; arcs pass the others.
        let ends = way.iter().filter(|met| !met.passed);
        let places = ends.map(|met| station.points[met.row].pose);
        let poses = std::iter::once(home).chain(places).chain(std::iter::once(home));
        let leg_times = self.leg_times(&program);
        Plan {
            waypoints: poses.map(|pose| pose.translation.vector.into()).collect(),
            leg_times,
            seen: Vec::new(),
            score: 0.0,
            bound: None,
            evidence: match self.scenario.generate.mode {
                ArmMode::Joint => Evidence::ClearAllLinks,
                ArmMode::Cartesian => Evidence::ClearToolSphere,
            },
            certified: None,
            witness: Some(program.into()),
            environment: None,
        }
    }
}

impl ArmSetup {
    /// Durations that the virtual controller plans for the moves of `program`; none where it cannot.
    ///
    /// One entry a move after the first (which only stands at home), s, each above 0: the lag of servos and noise are
    /// not in them.
    pub(super) fn leg_times(&self, program: &Program) -> Vec<f64> {
        let station = &self.station;
        let planned = self.orders(program).and_then(|orders| {
            let plan = controller::Plan::new(&station.arm, &station.home, &orders, &self.plan_settings())?;
            Ok(times(plan.passed(), orders.len()))
        });
        planned.unwrap_or_default()
    }
}

/// Durations of the moves; none where the arm stops before the last one, or takes no time for one.
///
/// `passed` are the times (s, from the start) at which moves end; duration k is `passed[k] − passed[k − 1]`.
fn times(passed: &[f64], moves: usize) -> Vec<f64> {
    let mut before = 0.0;
    let times: Vec<f64> = passed
        .iter()
        .map(|time| {
            let duration = time - before;
            before = *time;
            duration
        })
        .collect();
    if times.len() == moves && times.iter().all(|time| *time > 0.0) { times } else { Vec::new() }
}
