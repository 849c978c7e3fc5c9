//! The search: the heaviest paths through the reachability graph, made into programs.

use super::ArmSetup;
use super::graph::{ArmGraph, graph_of};
use super::program::Way;
use crate::campaign::graph::{Outcome, Plan};
use crate::campaign::scenario::ArmMode;
use crate::campaign::{Case, Evidence, Stop};
use crate::search::heaviest::{
    Arcs, Ends, Heaviest, HeaviestSettings, Outcome as Found, WalkSettings, heaviest, heaviest_walk,
};
use crate::simulation::arm as controller;
use crate::trajectory::program::Program;

/// The search for an arm's programs.
pub(in crate::campaign) struct Solver<'a> {
    setup: ArmSetup<'a>,
}

impl<'a> Solver<'a> {
    pub(in crate::campaign) fn new(setup: ArmSetup<'a>) -> Self {
        Self { setup }
    }

    /// The programs of the one graph that there is.
    pub(in crate::campaign) fn solve(&self, stop: &Stop) -> Outcome {
        let mut outcome = Outcome { graphs: 1, ..Outcome::default() };
        let graph = match graph_of(&self.setup) {
            Ok(graph) => graph,
            Err(reason) => return Outcome { reason: Some(reason), ..outcome },
        };
        match self.setup.heaviest(&graph, stop) {
            Ok(found) => {
                outcome.expansions = found.nodes;
                outcome.proven_empty = u64::from(found.paths.is_empty() && found.proven);
                outcome.reason = found.paths.is_empty().then(|| self.setup.why_none(&graph, &found));
                let plans = found
                    .paths
                    .iter()
                    .enumerate()
                    .map(|(number, (cost, rows))| (0, self.setup.plan(&graph, rows, *cost, &found, number)));
                outcome.plans = plans.collect();
            }
            Err(reason) => outcome.reason = Some(reason),
        }
        outcome
    }
}

impl ArmSetup<'_> {
    /// The programs along the paths that were found, as cases of a campaign.
    pub fn cases(&self, graph: &ArmGraph, found: &Heaviest) -> Vec<Case> {
        let paths = found.paths.iter().enumerate();
        let plans = paths.map(|(number, (cost, rows))| (number, self.plan(graph, rows, *cost, found, number)));
        plans.map(|(number, plan)| plan.case(self.scenario.seed, 0, number)).collect()
    }

    /// The heaviest paths through `graph`, in rows of the cloud, that home can be left for and reached from.
    ///
    /// Where not every point can be a first and a last one, home is two points more: one with free arcs to where programs may begin,
    /// one with free arcs from where they may end.
    ///
    /// # Errors
    /// Costs that no search takes, in a sentence's part.
    pub fn heaviest(&self, graph: &ArmGraph, stop: &Stop) -> Result<Heaviest, String> {
        let search = &self.scenario.generate.search;
        let n = graph.points();
        let (first, last) = (search.start.map(|row| row as usize), search.end.map(|row| row as usize));
        let may_begin = |row: usize| graph.from_home[row] && first.is_none_or(|first| first == row);
        let may_end = |row: usize| graph.to_home[row] && last.is_none_or(|last| last == row);
        let anywhere = (0..n).all(|row| graph.from_home[row] && graph.to_home[row]);
        let (points, costs, ends) = if anywhere {
            (n, graph.costs.clone(), Ends { start: first, end: last })
        } else {
            let arc = |from: usize, to: usize| match (from, to) {
                (from, to) if from < n && to < n => graph.costs[from * n + to],
                (from, to) if from == n && to < n => may_begin(to).then_some(0),
                (from, to) if from < n && to == n + 1 => may_end(from).then_some(0),
                _ => None,
            };
            let pairs = (0..n + 2).flat_map(|from| (0..n + 2).map(move |to| (from, to)));
            (n + 2, pairs.map(|(from, to)| arc(from, to)).collect(), Ends { start: Some(n), end: Some(n + 1) })
        };
        let arcs = Arcs::new(points, &costs).map_err(|error| error.to_string())?;
        let begun = (stop.clock)();
        let over = || (stop.cancelled)() || search.time_limit_s.is_some_and(|limit| (stop.clock)() - begun >= limit);
        let settings = HeaviestSettings {
            ends,
            min_cost: search.min_cost.map(|least| (least / graph.unit).ceil() as i64),
            programs: search.programs as usize,
            seed: self.scenario.seed,
            ..HeaviestSettings::default()
        };
        let mut found = if search.visits == 1 {
            heaviest(&arcs, &settings, &over).map_err(|error| error.to_string())?
        } else {
            let HeaviestSettings { ends, min_cost, programs, most_nodes, .. } = settings;
            let settings =
                WalkSettings { ends, visits: search.visits as usize, min_cost, programs, most_nodes, proof: false };
            heaviest_walk(&arcs, &settings, &over).map_err(|error| error.to_string())?.0
        };
        for (_, path) in &mut found.paths {
            path.retain(|row| *row < n);
        }
        Ok(found)
    }

    /// Why there is no program.
    fn why_none(&self, graph: &ArmGraph, found: &Heaviest) -> String {
        match found.outcome {
            Found::BelowMinCost => format!(
                "none costs {} {}: the bound is {}",
                self.scenario.generate.search.min_cost.unwrap_or(0.0),
                graph.unit_name,
                found.bound.map_or("not known".into(), |bound| (bound as f64 * graph.unit).to_string())
            ),
            Found::NotFound => "none of the wanted cost was found in time".into(),
            Found::Infeasible | Found::Found => "the end cannot be reached from the start".into(),
        }
    }

    fn plan(&self, graph: &ArmGraph, rows: &[usize], cost: i64, found: &Heaviest, number: usize) -> Plan {
        let station = self.station;
        let way = Way {
            rows: rows.to_vec(),
            configurations: rows.iter().map(|row| graph.configuration(self, *row)).collect(),
        };
        let program = self.program(&way, number, |k, zone| graph.blends(self, rows, k, zone));
        let home = station.tool_at(&station.home);
        let places = rows.iter().map(|row| station.points[*row].pose);
        let poses = std::iter::once(home).chain(places).chain(std::iter::once(home));
        let leg_times = self.leg_times(&program);
        Plan {
            waypoints: poses.map(|pose| pose.translation.vector.into()).collect(),
            leg_times,
            score: cost as f64 * graph.unit,
            // The bound of the heaviest holds for all that come after it.
            bound: found.bound.map(|bound| bound as f64 * graph.unit).filter(|_| number == 0),
            evidence: match self.scenario.generate.mode {
                ArmMode::Joint => Evidence::ClearAllLinks,
                ArmMode::Cartesian => Evidence::ClearToolSphere,
            },
            certified: None,
            profile: None,
            drive: None,
            program: Some(program),
        }
    }
}

impl ArmSetup<'_> {
    /// Durations that the virtual controller plans for the moves of `program`; none where it cannot.
    pub(super) fn leg_times(&self, program: &Program) -> Vec<f64> {
        let station = self.station;
        let planned = self.orders(program).and_then(|orders| {
            let plan = controller::Plan::new(&station.arm, &station.home, &orders, &self.plan_settings())?;
            Ok(times(plan.passed(), orders.len()))
        });
        planned.unwrap_or_default()
    }
}

/// Durations of the moves; none where the arm stops before the last one, or takes no time for one.
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
