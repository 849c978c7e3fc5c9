//! The reach set `witness`: a roadmap of waypoint states per graph, and the profile of what is found.
//!
//! Nodes are waypoints with velocities, legs polynomials of degree 7 in each axis, judged once and remembered
//! ([`Roadmap`]). What changes a plan beside the roadmap (over, crossed, altered) keeps every leg whose ends stay,
//! and mends the rest.

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::FlightSetup;
use super::legs::{judge, scores};
use crate::campaign::Witness as CaseWitness;
use crate::campaign::graph::{Looped, Outcome, Plan, Remembered, Roads, Wanted, Witnessed};
use crate::campaign::scenario::Timing;
use crate::feasibility::certify::{Certificate, certify};
use crate::feasibility::reach::mend::{Chosen, MendedWaypoint, OldLeg, mend, mend_over, mended, passed};
use crate::feasibility::reach::wander::{Wandered, wander};
use crate::feasibility::reach::{Roadmap, RoadmapSettings, WitnessLegs};
use crate::feasibility::steering::{LegJudge, LegTiming};
use crate::math::random::{Stream, named_seed, standard_normals, stream, unit};
use crate::trajectory::Profile;

/// Share of what is altered that is the time of a leg; the others are velocities at waypoints.
/// Velocities decide more: they bend two legs.
const OTHER_TIME: f64 = 0.3;

/// What judges legs, and how long they may take.
///
/// `remembered` lets a later round of an adaptive search begin with the legs that an earlier one judged, within a
/// bound of memory.
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
    ///
    /// Yes, no with a proof, or unknown. Dearer than a leg of a roadmap: up to a hundred rounds of judging the
    /// sequence.
    pub(super) fn through(&self, waypoints: &[Point3<f64>]) -> Certificate {
        let longest = self.setup.scenario.generate.limits.max_flight_time_s.unwrap_or(f64::INFINITY);
        certify(&self.judge, waypoints, &self.timing, longest)
    }

    /// The states of graph number `graph` over `points`.
    ///
    /// Velocities are drawn from the graph's seed; the start and the end are at rest.
    ///
    /// `velocities` states a waypoint; nothing is judged here. The stream is named `roadmap`, so that velocities do not
    /// change with what else is drawn.
    pub(super) fn roadmap(&self, graph: u64, points: &[Point3<f64>]) -> Roadmap<'_> {
        let scenario = &self.setup.scenario;
        let settings = RoadmapSettings {
            velocities: scenario.generate.velocities as usize,
            timing: self.timing,
            seed: named_seed(scenario.seed, "roadmap", graph),
        };
        Roadmap::new(&self.judge, points, &settings)
    }

    /// A plan of graph number `graph` over `points`, drawn leg by leg.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part.
    ///
    /// Each leg is drawn among those that are witnessed and lead on; not uniform over trajectories.
    pub(super) fn draw(&self, graph: u64, points: &[Point3<f64>]) -> Result<Plan, String> {
        let scenario = &self.setup.scenario;
        let mut random = stream(named_seed(scenario.seed, "wander", graph));
        let drawn = wander(&self.judge, points, &self.timing, scenario.task.length as usize, &mut random);
        let Wandered { waypoints, profile } = drawn.ok_or("none was met by drawing leg by leg")?;
        self.plan(waypoints, profile).ok_or_else(|| "`max_flight_time_s` is exceeded".into())
    }

    /// `profile` over `waypoints`; `None` where it takes too long.
    fn plan(&self, waypoints: Vec<Point3<f64>>, profile: Profile) -> Option<Plan> {
        let longest = self.setup.scenario.generate.limits.max_flight_time_s.unwrap_or(f64::INFINITY);
        (profile.duration() <= longest).then(|| Plan::witnessed(waypoints, profile))
    }

    /// `plan` over `points`: what did not change is kept, and where that is in the way what is beside it is chosen anew
    /// as well.
    ///
    /// `None` where the mended profile is too long or a leg has no witness.
    ///
    /// `None` too for a plan without a witness.
    pub(super) fn over(&self, plan: &Plan, points: &[Point3<f64>]) -> Option<Plan> {
        let profile = plan.witness.as_ref()?.profile()?;
        let profile = mend_over(&self.judge, &self.timing, profile, &plan.waypoints, points)?;
        self.plan(points.to_vec(), profile)
    }

    /// `plan` up to the first waypoint of leg `leg`, and `other` after it.
    ///
    /// The leg that joins both is judged anew; where it is none, the velocities at its ends are chosen anew as well.
    ///
    /// Waypoints are passed with the velocities of the plan they come from, so that every other leg is the same
    /// polynomial as before.
    pub(super) fn crossed(&self, plan: &Plan, other: &Plan, leg: usize) -> Option<Plan> {
        let [head, tail] = [plan, other].map(|plan| plan.witness.as_ref().and_then(CaseWitness::profile));
        let (head, tail) = (head?, tail?);
        let points = plan.spliced(other, leg)?;
        let of = |k: usize| if k <= leg { head } else { tail };
        let joined = |chosen: bool| {
            let waypoint = |(k, place): (usize, &Point3<f64>)| MendedWaypoint {
                place: *place,
                velocity: passed(of(k), k),
                kept: !(chosen && (k == leg || k == leg + 1)),
            };
            let waypoints: Vec<_> = points.iter().enumerate().map(waypoint).collect();
            let old = |k: usize| of(k).legs.get(k).filter(|_| k != leg).map_or(OldLeg::None, OldLeg::Same);
            mend(&self.judge, &self.timing, &waypoints, old)
        };
        self.plan(points.clone(), joined(false).or_else(|| joined(true))?)
    }

    /// `plan` with another velocity at a waypoint of leg `leg`, or another time of that leg.
    ///
    /// 3 of 10: another rung of the ladder for leg `leg`. Else the velocity at one end: a uniform share of the top
    /// speed, along the old velocity or the chord of its neighbours, with a spread of 0.3. `None` where that is not
    /// feasible.
    ///
    /// At the start and at the end the robot rests: they are not changed. With one leg only its time can be.
    pub(super) fn altered(&self, plan: &Plan, leg: usize, random: &mut Stream) -> Option<Plan> {
        let profile = plan.witness.as_ref()?.profile()?;
        let last = plan.waypoints.len() - 1;
        if unit(random) < OTHER_TIME {
            let old = profile.legs.get(leg)?;
            let [from, to] = [leg, leg + 1].map(|k| self.judge.end(plan.waypoints[k], passed(profile, k)));
            let rungs = self.timing.rungs();
            let rung = rungs[random.random_range(0..rungs.len())];
            let mut legs = profile.legs.clone();
            legs[leg] = (rung != old.duration).then(|| self.judge.judge(&from, &to, rung).ok())??;
            return self.plan(plan.waypoints.clone(), Profile { legs });
        }
        let changed = (leg + random.random_range(0..2usize)).clamp(1, last.checked_sub(1).filter(|inner| *inner > 0)?);
        let mut waypoints = mended(profile, &plan.waypoints, &plan.waypoints, Chosen::None);
        let old = waypoints[changed].velocity;
        let speed = self.judge.top_speed() * unit(random);
        let way = if unit(random) < 0.5 { old } else { plan.waypoints[changed + 1] - plan.waypoints[changed - 1] };
        let way =
            way.try_normalize(1e-9).unwrap_or_else(Vector3::x) + Vector3::from(standard_normals::<3>(random)) * 0.3;
        waypoints[changed].velocity = way * (speed / way.norm().max(f64::MIN_POSITIVE));
        let old = |k: usize| match profile.legs.get(k) {
            Some(leg) if k != changed && k + 1 != changed => OldLeg::Same(leg),
            Some(leg) => OldLeg::Took(leg.duration),
            None => OldLeg::None,
        };
        self.plan(plan.waypoints.clone(), mend(&self.judge, &self.timing, &waypoints, old)?)
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
