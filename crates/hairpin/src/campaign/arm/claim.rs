//! What of programs is claimed, and by whom.

use super::held::held;
use super::solver::ArmSolver;
use super::{ArmSetup, knobs, losses, plan, replan, verify};
use crate::campaign::graph::Losses;
use crate::campaign::kind::{Claim, Knobs, Made, PlanError, Replanner, Solver};
use crate::campaign::{Case, Scenario, Timed};
use crate::trajectory::Track;
use crate::verification::{EndError, Proof};

impl Claim for ArmSetup {
    fn solver(&self) -> Result<Box<dyn Solver + '_>, String> {
        Ok(Box::new(ArmSolver::new(self)))
    }

    /// There is one graph, whose moves are all looked at.
    fn lost(&self, _: u64) -> Losses {
        losses::losses(self)
    }

    fn replanner(&self, case: &Case) -> Result<Box<dyn Replanner>, String> {
        Ok(Box::new(replan::Shortened::new(self, case)?))
    }

    fn planned(&self, case: &Case) -> Result<Track, PlanError> {
        plan::track(self, case)
    }

    /// Arms get their program instead.
    fn timed(&self, _: &Case) -> Vec<Timed> {
        Vec::new()
    }

    fn headings(&self, _: &Case) -> Vec<f64> {
        Vec::new()
    }

    /// An arm's task is a cloud: a program is held to the waypoints of its case, and one that was searched for to the
    /// cloud, the graph and what programs may be.
    fn verify(&self, case: &Case, _: &Scenario, made: Made) -> (Option<Proof>, Option<EndError>) {
        let mut proof = verify::verify(self, case);
        if let (Some(program), Some(proof), Made::Searched) = (case.program(), &mut proof, made) {
            proof.findings.extend(held(self, case, program));
        }
        if case.environment.is_some() {
            proof.get_or_insert_default();
        }
        (proof, None)
    }

    fn knobs(&self) -> Knobs {
        knobs::knobs(self)
    }
}
