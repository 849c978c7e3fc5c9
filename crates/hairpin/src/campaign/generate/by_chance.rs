//! Cases by chance: drawn from all that are feasible, so that nobody chose them.
//!
//! Each graph gives one draw, by the solver's own way of drawing: uniform over the graph's trajectories, or leg by leg
//! (`Solver::drawn_how`).

use rayon::prelude::*;

use super::graphs::{GRAPHS_PER_CASE, Graphs};
use super::varies;
use crate::campaign::graph::Plan;
use crate::campaign::{Case, CaseNumber, OwnSimulator, Setup, Stop, vary};
use crate::math::random::named_seed;

/// What cases by chance are for. Each has seeds and graphs of its own, which no campaign's are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// What a campaign's stress stands beside.
    Baseline,
    /// Limits that follow from what is ordinary.
    Limits,
}

impl Purpose {
    fn seeds(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Limits => "calibrate",
        }
    }

    /// Its first graph: no search has so many.
    fn first_graph(self) -> u64 {
        match self {
            Self::Baseline => 1 << 40,
            Self::Limits => 1 << 41,
        }
    }
}

/// Cases by chance.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ByChance {
    /// In the order of their numbers.
    pub cases: Vec<Case>,
    /// Where they are fewer than asked for, and it was not stopped: why, in a sentence's part.
    pub reason: Option<String>,
}

/// Draws `count` cases of what `setup` finds feasible, the claim and its limits included, numbered from 0; fewer where
/// 20 graphs for each do not give so many, or where `stop` says so.
///
/// Where `[vary]` shapes plans, each case draws its own values first. What a search would find beside the waypoints is
/// left out. One seed gives the same cases on any number of threads.
///
/// Where the draw of a graph fails the next one is asked, so that what is hard to draw is rarer here than it is among
/// all. `reason` is that of the last graph that gave nothing. Work is done in batches of twice the number of threads;
/// which graph becomes which case depends on their numbers alone.
pub fn by_chance(setup: &Setup, (purpose, count): (Purpose, u64), stop: &Stop) -> ByChance {
    let mut drawn = ByChance::default();
    let graphs = match Graphs::of(setup, &OwnSimulator) {
        Ok(graphs) => graphs,
        Err(reason) => return ByChance { reason: Some(reason), ..drawn },
    };
    let varied = varies(&setup.scenario);
    let units = if varied { count } else { count.saturating_mul(GRAPHS_PER_CASE) };
    let batch = 2 * rayon::current_num_threads() as u64;
    let (mut next, root) = (0, setup.scenario.seed());
    (stop.progress)(0, count as usize);
    while (drawn.cases.len() as u64) < count && next < units && !(stop.cancelled)() {
        let missing = count - drawn.cases.len() as u64;
        let last = units.min(next + batch.min(missing));
        let found: Vec<Result<(u64, Plan), Option<String>>> = (next..last)
            .into_par_iter()
            .map(|unit| match varied {
                true => drawn_plan(setup, (purpose, unit), stop),
                false => draw(&graphs, purpose.first_graph() + unit, stop),
            })
            .collect();
        for (found, unit) in found.into_iter().zip(next..) {
            match found {
                Ok((graph, plan)) => {
                    let number = if varied { unit as usize } else { drawn.cases.len() };
                    let seed = named_seed(root, purpose.seeds(), number as u64);
                    drawn.cases.push(Case { seed, ..plan.case(root, graph, number) });
                }
                Err(reason) => drawn.reason = reason.or(drawn.reason),
            }
        }
        next = last;
        (stop.progress)(drawn.cases.len(), count as usize);
    }
    if drawn.cases.len() as u64 == count {
        drawn.reason = None;
    }
    drawn
}

/// A plan of case number `number` where plans vary: of the scenario that is drawn for it, in graphs of its own.
///
/// Up to 20 graphs, from a range that belongs to the case alone.
fn drawn_plan(setup: &Setup, (purpose, number): (Purpose, u64), stop: &Stop) -> Result<(u64, Plan), Option<String>> {
    let seed = named_seed(setup.scenario.seed(), purpose.seeds(), number);
    let draws = vary::draw_for_case(&setup.scenario, seed, CaseNumber(number as usize));
    let drawn = setup.drawn(&draws).map_err(|mistake| Some(mistake.to_string()))?;
    let graphs = Graphs::of(&drawn, &OwnSimulator).map_err(Some)?;
    let first = purpose.first_graph() + number * GRAPHS_PER_CASE;
    let mut why = None;
    for graph in (first..first + GRAPHS_PER_CASE).take_while(|_| !(stop.cancelled)()) {
        match draw(&graphs, graph, stop) {
            Ok(found) => return Ok(found),
            Err(reason) => why = reason,
        }
    }
    Err(why)
}

/// One trajectory of graph number `graph`; or why there is none.
///
/// `Err(None)` where it was stopped.
fn draw(graphs: &Graphs, graph: u64, stop: &Stop) -> Result<(u64, Plan), Option<String>> {
    graphs.draw(graph, stop).map(|plan| (graph, graphs.solver.finished(plan)))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use std::collections::HashSet;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use serde_json::json;

    use super::*;
    use crate::campaign::Scenario;
    use crate::campaign::testing::quadrotor;
    use crate::math::random::case_seed;

    fn setup(vary: serde_json::Value) -> Setup {
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "seed": 5,
            "robot": quadrotor(),
            "world": { "size_m": [20.0, 20.0, 20.0] },
            "task": { "start_m": [2.0, 2.0, 5.0], "end_m": [9.0, 9.0, 8.0], "length": 5 },
            "generate": { "reach": "sphere", "timing": { "step_s": 1.0 },
                "search": { "method": "beam", "waypoints": 30, "cases": 3 } },
            "vary": vary,
        }))
        .unwrap();
        Setup::new(scenario).unwrap()
    }

    fn stop(cancelled: &(dyn Fn() -> bool + Sync)) -> Stop<'_> {
        Stop { cancelled, progress: &|_, _| {}, clock: &|| 0.0 }
    }

    #[test]
    fn they_are_drawn_once_and_for_all_and_are_no_campaigns() {
        let setup = setup(json!({}));
        let of = |purpose, count| by_chance(&setup, (purpose, count), &stop(&|| false)).cases;
        let cases = of(Purpose::Baseline, 12);
        assert_eq!(cases.iter().map(|case| case.number.0).collect::<Vec<_>>(), (0..12).collect::<Vec<_>>());
        assert!(cases.iter().all(|case| case.waypoints.len() == 5 && case.graph >= 1 << 40));
        let graphs: HashSet<u64> = cases.iter().map(|case| case.graph).collect();
        assert_eq!(graphs.len(), 12, "one of each graph");
        assert!(cases.iter().all(|case| (0..99).all(|number| case.seed != case_seed(5, number))));
        // More of them begin with the same; for another purpose they are others; threads change nothing.
        assert_eq!(of(Purpose::Baseline, 15)[..12], cases);
        let others = of(Purpose::Limits, 12);
        assert!(others.iter().zip(&cases).all(|(other, case)| {
            other.seed != case.seed && other.graph != case.graph && other.waypoints != case.waypoints
        }));
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(alone.install(|| of(Purpose::Baseline, 12)), cases);
    }

    #[test]
    fn what_varies_is_drawn_first() {
        let setup = setup(json!({ "task.length": { "choice": [4, 6] } }));
        let cases = by_chance(&setup, (Purpose::Baseline, 10), &stop(&|| false)).cases;
        let lengths: HashSet<usize> = cases.iter().map(|case| case.waypoints.len()).collect();
        assert_eq!(cases[0].waypoints.len(), 5, "case 0 is nominal");
        assert_eq!(lengths, HashSet::from([4, 5, 6]));
    }

    #[test]
    fn fewer_have_a_reason_unless_they_were_stopped() {
        let mut far = setup(json!({}));
        let keys = far.scenario.own_mut::<crate::campaign::scenario::FlightScenario>().unwrap();
        keys.generate.timing.as_mut().unwrap().step_s = Some(0.05);
        let far = Setup::new(far.scenario).unwrap();
        let none = by_chance(&far, (Purpose::Baseline, 2), &stop(&|| false));
        assert!(none.cases.is_empty() && none.reason.is_some(), "{none:?}");
        let stopped = by_chance(&setup(json!({})), (Purpose::Baseline, 2), &stop(&|| true));
        assert_eq!((stopped.cases.len(), stopped.reason), (0, None));
    }

    #[test]
    fn a_draw_is_stopped_within_its_graph() {
        let looks = AtomicUsize::new(0);
        // Before the graph is asked for all its legs, and long after the draw has begun.
        let cancelled = || looks.fetch_add(1, Ordering::Relaxed) >= 10;
        let stopped = by_chance(&setup(json!({})), (Purpose::Baseline, 1), &stop(&cancelled));
        assert_eq!((stopped.cases.len(), stopped.reason), (0, None));
    }
}
