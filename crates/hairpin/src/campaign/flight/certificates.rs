//! Witnesses searched afterwards for what another reach set found.
//!
//! A hull's trajectory may or may not have a witness: yes with it, no with a proof, unknown else. Velocities at
//! waypoints and leg times are chosen for the whole sequence ([`certify`]).
//!
//! The limits are the scenario's: speed, tilt and flight time. That a hull's trajectory has no witness in the time of
//! its step says nothing of other times, which is why a ladder of times is tried.

use nalgebra::Point3;

use super::FlightSetup;
use super::legs::judge;
use crate::campaign::Evidence;
use crate::campaign::graph::Plan;
use crate::feasibility::certify::{Certificate, certify};
use crate::feasibility::steering::{LegJudge, LegTiming};

/// A certificate may take legs from this share of the step …
/// Legs far shorter than the step that the hull assumed are flown quicker with thrust to spare, far longer ones
/// always exist unless the flight time is limited.
const QUICKEST: f64 = 0.25;
/// … to this multiple of it.
/// A ladder between the two: each leg takes the shortest time that has a witness.
const SLOWEST: f64 = 10.0;

/// The step of step-wise sets, s.
///
/// 1 s where the scenario's timing is a range.
fn step(setup: &FlightSetup) -> f64 {
    setup.scenario.generate.timing_in_force().step_s.unwrap_or(1.0)
}

impl FlightSetup {
    /// Whether there is a witness of `waypoints` whose legs all take the step, as step-wise sets have it; a certificate
    /// may take other times.
    ///
    /// # Errors
    /// A rotor layout without a flatness map, in a sentence's part.
    ///
    /// `waypoints` in m, both ends included. For comparing reach sets at equal times.
    pub fn certificate_in_step(&self, waypoints: &[Point3<f64>]) -> Result<Certificate, String> {
        Ok(Certifier::timed(self, LegTiming::Step(step(self)))?.answer(waypoints))
    }
}

/// Certifies plans under the scenario's limits.
///
/// Holds the judge of legs: made once for many plans.
pub(super) struct Certifier {
    judge: LegJudge,
    timing: LegTiming,
    /// s; infinite without a limit.
    longest_flight: f64,
}

impl Certifier {
    /// Legs may take from a quarter of the step to ten times it, each its own time.
    ///
    /// # Errors
    /// As [`judge`].
    pub(super) fn new(setup: &FlightSetup) -> Result<Self, String> {
        let step = step(setup);
        Self::timed(setup, LegTiming::ladder(QUICKEST * step, SLOWEST * step))
    }

    fn timed(setup: &FlightSetup, timing: LegTiming) -> Result<Self, String> {
        let longest_flight = setup.scenario.generate.limits.max_flight_time_s.unwrap_or(f64::INFINITY);
        Ok(Self { judge: judge(setup)?, timing, longest_flight })
    }

    /// The answer for `waypoints`.
    ///
    /// `No` where no flight at all exists under the limits, `Unknown` where none was found.
    pub(super) fn answer(&self, waypoints: &[Point3<f64>]) -> Certificate {
        certify(&self.judge, waypoints, &self.timing, self.longest_flight)
    }

    /// Notes the answer in the plan; a `yes` brings its witness, with leg times of its own.
    ///
    /// `no` and `unknown` leave evidence and leg times as they are.
    ///
    /// Deterministic; what it costs is what [`certify`] does, at most a hundred rounds.
    pub(super) fn certify(&self, plan: &mut Plan) {
        match self.answer(&plan.waypoints) {
            Certificate::Yes(profile) => {
                plan.certified = Some("yes");
                plan.evidence = Evidence::Witnessed;
                plan.leg_times = profile.legs.iter().map(|leg| leg.duration).collect();
                plan.witness = Some(profile.into());
            }
            Certificate::No(_) => plan.certified = Some("no"),
            Certificate::Unknown { .. } => plan.certified = Some("unknown"),
        }
    }
}
