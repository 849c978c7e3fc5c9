//! What of flights is claimed, and by whom.

use nalgebra::{Point3, Vector3};
use serde_json::{Value, json};

use super::fly::own_curve;
use super::solve::FlightSolver;
use super::{FlightSetup, knobs, losses, passes, plan, replan, verify};
use crate::campaign::graph::Losses;
use crate::campaign::kind::{Claim, Knobs, Made, PlanError, PlannedRows, Replanner, Same, Solver};
use crate::campaign::passage::{Demands, Passage};
use crate::campaign::scenario::FlightScenario;
use crate::campaign::{Case, Scenario, Timed};
use crate::trajectory::Track;
use crate::verification::{EndError, Finding, Proof};

/// Rate of the timed reference that executors get, Hz.
/// Trackers interpolate; the polynomials themselves are in the folder.
const REFERENCE_RATE: f64 = 50.0;

impl Claim for FlightSetup {
    fn solver(&self) -> Result<Box<dyn Solver + '_>, String> {
        Ok(Box::new(FlightSolver::new(self)?))
    }

    fn lost(&self, graphs: u64) -> Losses {
        losses::losses(self, graphs)
    }

    fn replanner(&self, case: &Case) -> Result<Box<dyn Replanner>, String> {
        Ok(Box::new(Replanned(case.clone())))
    }

    fn planned(&self, case: &Case) -> Result<Track, PlanError> {
        Ok(plan::track(&self.robot, case)?)
    }

    fn planned_rows(&self, case: &Case) -> Result<Option<(Track, f64)>, PlanError> {
        Ok(plan::straight_rows(&self.robot, case)?)
    }

    fn followed(&self, case: &Case) -> Result<Track, PlanError> {
        let Some(curve) = own_curve(self, case) else { return self.planned(case) };
        let leg_times = curve.legs.iter().map(|leg| leg.duration).collect();
        let along = Case { leg_times, witness: Some(curve.into()), ..case.clone() };
        Ok(plan::track(&self.robot, &along)?)
    }

    fn timed(&self, case: &Case) -> Vec<Timed> {
        plan::timed(case, REFERENCE_RATE)
    }

    /// Plans of flights do not turn: their flat outputs are x, y, z.
    fn headings(&self, case: &Case) -> Vec<f64> {
        vec![0.0; case.waypoints.len()]
    }

    fn verify(&self, case: &Case, drawn: &Scenario, made: Made) -> (Option<Proof>, Option<EndError>) {
        let (mut proof, with_lag) = verify::verify(self, case, made).unzip();
        if case.environment.is_some() {
            let asked = drawn.own::<FlightScenario>().and_then(|drawn| drawn.generate.environment);
            proof.get_or_insert_default().findings.extend(verify::verify_environment(self, asked, case));
        }
        (proof, with_lag.flatten())
    }

    fn verify_planned(&self, case: &Case, kept: &PlannedRows) -> Vec<Finding> {
        verify::verify_planned(&self.robot, case, kept)
    }

    fn passes(&self, asked: &Demands) -> Result<Passage, String> {
        passes::passes(self, asked)
    }

    fn open_world(&self, size: &Vector3<f64>) -> Option<Value> {
        Some(json!({ "size_m": [size.x, size.y, size.z], "keep_in_margin_m": 0.0 }))
    }

    fn knobs(&self) -> Knobs {
        knobs::knobs(self)
    }
}

/// The case that others are planned after.
///
/// Waypoints are the new ones alone: which of the case's they were does not matter to a flight.
struct Replanned(Case);

impl Replanner for Replanned {
    fn plan(&self, setup: Same, _: &[usize], points: &[Point3<f64>]) -> Option<Case> {
        replan::replan(setup.setup(), &self.0, points)
    }
}
