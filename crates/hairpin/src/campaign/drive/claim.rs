//! What of drives is claimed, and by whom.

use nalgebra::{Point3, Vector3};
use serde_json::{Value, json};

use super::solve::DriveSolver;
use super::{DriveSetup, knobs, losses, passes, plan, replan, verify};
use crate::campaign::graph::Losses;
use crate::campaign::kind::{Claim, Knobs, Made, PlanError, Replanner, Same, Solver};
use crate::campaign::passage::{Demands, Passage};
use crate::campaign::scenario::DriveScenario;
use crate::campaign::{Case, Scenario, Timed};
use crate::trajectory::Track;
use crate::verification::{EndError, Finding, Proof};

/// Cells along a side of level ground without end, and the least of them, m.
/// Enough for any scale of mission, and few enough to be made at once.
const OPEN_CELLS: f64 = 400.0;
const LEAST_CELL_M: f64 = 0.1;
/// Rate of the timed reference that executors get, Hz.
/// Who passes on nothing but its rows is seen as often: accelerations are judged of four poses a second and more, and
/// `check-executor` remarks below ten.
const REFERENCE_RATE: f64 = 10.0;
/// What the duration of a plan is rounded down to where time limits are reckoned, s: they stay what they were.
const PATIENCE_S: f64 = 0.5;

impl Claim for DriveSetup {
    fn solver(&self) -> Result<Box<dyn Solver + '_>, String> {
        let solver = DriveSolver::new(self)?;
        // Before any ground is sampled.
        solver.may_go()?;
        Ok(Box::new(solver))
    }

    fn lost(&self, graphs: u64) -> Losses {
        losses::losses(self, graphs)
    }

    fn replanner(&self, case: &Case) -> Result<Box<dyn Replanner>, String> {
        Ok(Box::new(Replanned(case.clone())))
    }

    fn planned(&self, case: &Case) -> Result<Track, PlanError> {
        plan::track(self, case)
    }

    fn timed(&self, case: &Case) -> Vec<Timed> {
        plan::timed(self, case, REFERENCE_RATE)
    }

    fn planned_s(&self, timed: &[Timed]) -> f64 {
        timed.last().map_or(0.0, |last| (last.t / PATIENCE_S).floor() * PATIENCE_S)
    }

    fn headings(&self, case: &Case) -> Vec<f64> {
        plan::headings(self, case)
    }

    fn verify(&self, case: &Case, drawn: &Scenario, made: Made) -> (Option<Proof>, Option<EndError>) {
        let mut proof = verify::verify(self, case, made);
        if case.environment.is_some() {
            let asked = drawn.own::<DriveScenario>().and_then(|drawn| drawn.generate.environment);
            proof.get_or_insert_default().findings.extend(verify::verify_environment(self, asked, case));
        }
        (proof, None)
    }

    fn strays(&self, case: &Case, planned: &Track) -> Vec<Finding> {
        case.commands().map_or_else(Vec::new, |drive| verify::strays(self, drive, planned))
    }

    fn passes(&self, asked: &Demands) -> Result<Passage, String> {
        passes::passes(self, asked)
    }

    fn open_world(&self, size: &Vector3<f64>) -> Option<Value> {
        let side = size.x.max(size.y);
        // Level ground is the same whatever its cells.
        let cell = (side / OPEN_CELLS).max(LEAST_CELL_M);
        Some(json!({ "terrain": { "generator": "flat", "size_m": side, "cell_m": cell } }))
    }

    fn knobs(&self) -> Knobs {
        knobs::knobs(self)
    }
}

/// The case that others are planned after.
///
/// Its passings (headings, curvatures, gears) are kept where its waypoints are.
struct Replanned(Case);

impl Replanner for Replanned {
    fn plan(&self, setup: Same, indices: &[usize], points: &[Point3<f64>]) -> Option<Case> {
        replan::replan(setup.setup(), &self.0, indices, points)
    }
}
