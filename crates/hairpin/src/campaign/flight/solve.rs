//! One graph, from its number to its plans: the reach set asked for, the search asked for, and never another.

use super::certificates::Certifier;
use super::stepwise::Stepwise;
use super::witness::Witness;
use super::{FlightSetup, graph};
use crate::campaign::graph::Outcome;
use crate::campaign::scenario::ReachName;

/// The part of a search that is the same for every graph.
pub(in crate::campaign) struct Solver<'a> {
    setup: FlightSetup<'a>,
    set: Set<'a>,
    certifier: Option<Certifier>,
}

enum Set<'a> {
    Stepwise(Stepwise<'a>),
    Witness(Box<Witness<'a>>),
}

impl<'a> Solver<'a> {
    /// Builds the reach set that the scenario asks for.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part; also where the planned duration alone is beyond its limit.
    pub(in crate::campaign) fn new(setup: FlightSetup<'a>) -> Result<Self, String> {
        let generate = &setup.scenario.generate;
        let set = match generate.reach {
            ReachName::Witness => Set::Witness(Box::new(Witness::new(setup)?)),
            _ => Set::Stepwise(Stepwise::new(setup)?),
        };
        let shortest = match &set {
            Set::Stepwise(set) => set.step(),
            Set::Witness(set) => set.shortest_leg(),
        };
        let legs = setup.scenario.task.length - 1;
        if let Some(limit) = generate.limits.max_flight_time_s.filter(|limit| legs as f64 * shortest > *limit) {
            return Err(format!("{legs} legs of at least {shortest} s take longer than max_flight_time_s = {limit}"));
        }
        let wanted = generate.certify && generate.reach != ReachName::Witness;
        let certifier = if wanted { Some(Certifier::new(&setup)?) } else { None };
        Ok(Self { setup, set, certifier })
    }

    /// Searches graph number `graph`.
    pub(in crate::campaign) fn solve(&self, graph: u64) -> Outcome {
        let points = match graph::sample(&self.setup, graph) {
            Ok(points) => points,
            Err(error) => return Outcome { graphs: 1, reason: Some(error.to_string()), ..Outcome::default() },
        };
        let mut outcome = match &self.set {
            Set::Stepwise(set) => set.solve(graph, &points),
            Set::Witness(set) => set.solve(graph, &points),
        };
        if let Some(certifier) = &self.certifier {
            outcome.plans.iter_mut().for_each(|(_, plan)| certifier.certify(plan));
        }
        outcome
    }
}
