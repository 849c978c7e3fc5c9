//! What of trips is claimed, and by whom.
//!
//! The solver, what is lost, plans after others, the planned track, the proof and missions made elsewhere: each by
//! its file.

use nalgebra::{Point3, Vector3};
use serde_json::{Value, json};

use super::solve::BoatSolver;
use super::{BoatSetup, knobs, losses, passes, plan, through, verify};
use crate::campaign::graph::Losses;
use crate::campaign::kind::{Claim, Knobs, Made, PlanError, PlannedRows, Replanner, Same, Solver};
use crate::campaign::passage::{Demands, Passage};
use crate::campaign::{Case, Scenario, Timed};
use crate::trajectory::Track;
use crate::verification::{EndError, Finding, Proof};

impl Claim for BoatSetup {
    fn solver(&self) -> Result<Box<dyn Solver + '_>, String> {
        Ok(Box::new(BoatSolver::new(self)?))
    }

    fn lost(&self, graphs: u64) -> Losses {
        losses::losses(self, graphs)
    }

    fn replanner(&self, case: &Case) -> Result<Box<dyn Replanner>, String> {
        Ok(Box::new(Replanned(case.clone())))
    }

    fn planned(&self, case: &Case) -> Result<Track, PlanError> {
        Ok(plan::track(self, case)?)
    }

    fn timed(&self, case: &Case) -> Vec<Timed> {
        plan::timed(case)
    }

    fn headings(&self, case: &Case) -> Vec<f64> {
        plan::headings(case)
    }

    fn verify(&self, case: &Case, _: &Scenario, made: Made) -> (Option<Proof>, Option<EndError>) {
        verify::verify(self, case, made)
    }

    fn verify_planned(&self, case: &Case, kept: &PlannedRows) -> Vec<Finding> {
        verify::verify_planned(case, kept)
    }

    fn passes(&self, asked: &Demands) -> Result<Passage, String> {
        Ok(passes::passes(self, asked))
    }

    /// Waters without keep-outs, margin or current, as large as a mission from elsewhere needs.
    fn open_world(&self, size: &Vector3<f64>) -> Option<Value> {
        Some(json!({ "size_m": [size.x, size.y], "keep_in_margin_m": 0.0 }))
    }

    fn knobs(&self) -> Knobs {
        knobs::knobs(self)
    }
}

/// The case that others are planned after.
///
/// Each waypoint is passed with the velocity that the case has at the one whose place it takes.
struct Replanned(Case);

impl Replanner for Replanned {
    fn plan(&self, setup: Same, indices: &[usize], points: &[Point3<f64>]) -> Option<Case> {
        through::replan(setup.setup(), &self.0, indices, points)
    }
}
