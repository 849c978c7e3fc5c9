//! The claim: what a kind searches, plans and proves.

use nalgebra::Point3;
use thiserror::Error;

use super::{Knobs, Same};
use crate::campaign::graph::{Executions, Losses, Outcome, Wanted};
use crate::campaign::{Case, CaseNumber, Scenario, Stop, Timed};
use crate::simulation::SimulationError;
use crate::trajectory::{Track, TrackError};
use crate::verification::{EndError, Proof};

/// Why a case has no planned motion.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlanError {
    /// Its numbers are no track.
    #[error(transparent)]
    Track(#[from] TrackError),
    /// The ground does not carry its commands, or the arm does not follow them.
    #[error("{0}")]
    Act(#[from] SimulationError),
}

/// What verification says of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Verified {
    /// Number of the case.
    pub case: CaseNumber,
    /// The proof, and what was found of its environment; `None` for a case that claims no witness and has none.
    pub proof: Option<Proof>,
    /// End error of a whole flight, open loop, with rotor lag: what the claim leaves out.
    pub with_lag: Option<EndError>,
}

/// What is feasible, and what stands behind it.
pub(in crate::campaign) trait Claim {
    /// The part of a search that is the same for every graph.
    ///
    /// # Errors
    /// Why nothing can be searched, in a sentence's part.
    fn solver(&self) -> Result<Box<dyn Solver + '_>, String>;

    /// What becomes of the candidates for legs, in `graphs` graphs at most.
    fn lost(&self, graphs: u64) -> Losses;

    /// What plans `case` over other waypoints.
    ///
    /// # Errors
    /// Why nothing can be planned, in a sentence's part.
    fn replanner(&self, case: &Case) -> Result<Box<dyn Replanner>, String>;

    /// The planned motion with the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`.
    ///
    /// # Errors
    /// A case whose numbers are no motion, as a folder that was edited may hold.
    fn planned(&self, case: &Case) -> Result<Track, PlanError>;

    /// The path that is followed where nothing goes wrong: the planned one, unless the controller of ours makes one of
    /// its own.
    ///
    /// # Errors
    /// As [`Self::planned`].
    fn followed(&self, case: &Case) -> Result<Track, PlanError> {
        self.planned(case)
    }

    /// The timed reference that executors get of a case with leg times; empty where they get none.
    fn timed(&self, case: &Case) -> Vec<Timed>;

    /// Hands the written witness to the verification room, and with it the environment, held to the bounds of `drawn`:
    /// the scenario that the case was searched with. What is found of the two is one proof.
    fn verify(&self, case: &Case, drawn: &Scenario) -> (Option<Proof>, Option<EndError>);

    /// The scenario keys that can make more feasible, and what a run can be freed of.
    fn knobs(&self) -> Knobs;
}

/// Searches the graphs of one setup.
pub(in crate::campaign) trait Solver: Sync {
    /// Searches graph number `graph` for what is `wanted`; `executions` are for searches in the loop, `stop` ends what
    /// has no bound in counts.
    fn solve(&self, graph: u64, executions: Executions, wanted: Wanted, stop: &Stop) -> Outcome;

    /// Whether a round's uniform draws are that.
    fn draws(&self) -> bool {
        true
    }

    /// Whether its legs can be asked for the optimum of other scores, by their names, than the scenario's.
    fn takes_scores(&self) -> bool {
        false
    }
}

/// Plans a case over other waypoints, on the claim that the case stands on.
pub(in crate::campaign) trait Replanner {
    /// The case over `points`, of which the k-th was its waypoint number `indices[k]`, in the world of `setup`, if that
    /// is feasible as the case was. `None`: it is not, or nothing shows it.
    fn plan(&self, setup: Same, indices: &[usize], points: &[Point3<f64>]) -> Option<Case>;
}
