//! The reach set `witness`: a roadmap of waypoint states per graph, and the profile of what is found.

use nalgebra::Point3;

use super::FlightSetup;
use super::legs::{judge, scores};
use crate::campaign::graph::{Looped, Outcome, Remembered, Roads, Wanted, Witnessed};
use crate::campaign::scenario::Timing;
use crate::feasibility::certify::{Certificate, certify};
use crate::feasibility::reach::{Roadmap, RoadmapSettings, WitnessLegs};
use crate::feasibility::steering::{LegJudge, LegTiming};
use crate::math::random::named_seed;

/// What judges legs, and how long they may take.
pub(super) struct Witness<'a> {
    setup: &'a FlightSetup,
    judge: LegJudge,
    timing: LegTiming,
    /// Of the graphs that rounds come back to.
    remembered: Remembered<WitnessLegs>,
}

impl<'a> Witness<'a> {
    /// # Errors
    /// As [`judge`].
    pub(super) fn new(setup: &'a FlightSetup) -> Result<Self, String> {
        let timing = match setup.scenario.generate.timing_in_force() {
            Timing { step_s: Some(step), .. } => LegTiming::Step(step),
            Timing { leg_time_s: Some([shortest, longest]), .. } => LegTiming::ladder(shortest, longest),
            Timing { .. } => return Err("`timing` names neither leg_time_s nor step_s".into()),
        };
        Ok(Self { setup, judge: judge(setup)?, timing, remembered: Remembered::default() })
    }

    /// The shortest leg time tried, s.
    pub(super) fn shortest_leg(&self) -> f64 {
        self.timing.range().0
    }

    /// The witness of `waypoints` flown in order, if one is found for them alone.
    ///
    /// Under the scenario's limits of leg and flight times; velocities at waypoints are chosen for this sequence.
    pub(super) fn through(&self, waypoints: &[Point3<f64>]) -> Certificate {
        let longest = self.setup.scenario.generate.limits.max_flight_time_s.unwrap_or(f64::INFINITY);
        certify(&self.judge, waypoints, &self.timing, longest)
    }

    /// The states of graph number `graph` over `points`.
    pub(super) fn roadmap(&self, graph: u64, points: &[Point3<f64>]) -> Roadmap<'_> {
        let scenario = &self.setup.scenario;
        let settings = RoadmapSettings {
            velocities: scenario.generate.velocities as usize,
            timing: self.timing,
            seed: named_seed(scenario.seed, "roadmap", graph),
        };
        Roadmap::new(&self.judge, points, &settings)
    }

    /// Searches graph number `graph` over `points`.
    ///
    /// A profile longer than the flight time's limit is no plan. Legs that were judged are kept for the next round of
    /// an adaptive campaign.
    pub(super) fn solve(&self, graph: u64, points: &[Point3<f64>], looped: Looped) -> Outcome {
        let scenario = &self.setup.scenario;
        let again = matches!(looped.wanted, Wanted::Round(_));
        let mut roadmap = self.roadmap(graph, points);
        if let Some(legs) = self.remembered.take(graph) {
            roadmap = roadmap.knowing(legs);
        }
        let (score, also) = scores(self.setup, graph, self.judge.top_speed(), &looped);
        let asked = Witnessed {
            search: &scenario.generate.search,
            length: scenario.task.length,
            longest: scenario.generate.limits.max_flight_time_s.unwrap_or(f64::INFINITY),
            seed: (scenario.seed, graph),
            points,
            score,
            also,
            looped,
        };
        let outcome = asked.solve(Roads {
            reach: &roadmap,
            start: roadmap.start(),
            may_arrive: &|node, steps| roadmap.may_arrive(node, steps),
            profile: &|nodes| roadmap.profile(nodes).ok(),
        });
        if again {
            let legs = roadmap.into_legs();
            let bytes = legs.bytes();
            self.remembered.keep(graph, legs, bytes);
        }
        outcome
    }
}
