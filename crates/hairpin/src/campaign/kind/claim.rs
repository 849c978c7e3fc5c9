//! The claim: what a kind searches, plans and proves.
//!
//! A claim is made of plans alone: nothing here executes, but what a search hands in as [`Executions`].

use nalgebra::{Point3, Vector3};
use serde_json::Value;
use thiserror::Error;

use super::{Knobs, Made, PlannedRows, Same};
use crate::campaign::graph::{Executions, Losses, Outcome, Plan, Wanted};
use crate::campaign::passage::{Demands, Passage};
use crate::campaign::{Case, CaseNumber, Scenario, Stop, Timed};
use crate::math::random::Stream;
use crate::simulation::SimulationError;
use crate::trajectory::{Track, TrackError};
use crate::verification::{Collector, EndError, Finding, Proof, RowTolerances};

/// Why a case has no planned motion.
///
/// An error of the folder or of the model, never of the search: cases that a search gave have a motion.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlanError {
    /// Its numbers are no track.
    /// Times that do not rise, channels of different lengths, numbers that are none.
    #[error(transparent)]
    Track(#[from] TrackError),
    /// The ground does not carry its commands, or the arm does not follow them.
    #[error("{0}")]
    Act(#[from] SimulationError),
}

/// What verification says of one case.
///
/// One row of `verify`'s answer. With both `None` nothing was claimed, which is no finding.
#[derive(Debug, Clone, PartialEq)]
pub struct Verified {
    /// Number of the case.
    pub case: CaseNumber,
    /// The proof, and what was found of its environment; `None` for a case that claims no witness and has none.
    /// What it found is data, not an error: a case that fails has a proof with findings.
    pub proof: Option<Proof>,
    /// End error of a whole flight, open loop, with rotor lag: what the claim leaves out.
    /// m, m/s and rad; only of flights. Told, and not held to a tolerance.
    pub with_lag: Option<EndError>,
}

/// What is feasible, and what stands behind it.
///
/// Answers are pure functions of the setup and the arguments. Kinds that lack something keep the defaults.
pub(in crate::campaign) trait Claim {
    /// The part of a search that is the same for every graph.
    ///
    /// # Errors
    /// Why nothing can be searched, in a sentence's part.
    ///
    /// Costs what all graphs share: a hull, a roadmap's terrain, an arm's graph. Made once a job.
    fn solver(&self) -> Result<Box<dyn Solver + '_>, String>;

    /// What becomes of the candidates for legs, in `graphs` graphs at most.
    ///
    /// Counts by reason, in the order of the tests; what they say is where legs were lost, not what would help.
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
    ///
    /// World frame, m and m/s; `leg` counts from 0. Flights are sampled at 100 Hz, drives step by step of the
    /// prediction.
    fn planned(&self, case: &Case) -> Result<Track, PlanError>;

    /// The rows of the planned motion where it bends, and the time between its samples, s; `None` where it must be
    /// sampled to find them.
    ///
    /// # Errors
    /// As [`Self::planned`].
    ///
    /// The rows that [`bends`](crate::trajectory::bends()) keeps of it.
    fn planned_rows(&self, _case: &Case) -> Result<Option<(Track, f64)>, PlanError> {
        Ok(None)
    }

    /// The path that is followed where nothing goes wrong: the planned one, unless the controller of ours makes one of
    /// its own.
    ///
    /// # Errors
    /// As [`Self::planned`].
    fn followed(&self, case: &Case) -> Result<Track, PlanError> {
        self.planned(case)
    }

    /// The timed reference that executors get of a case with leg times; empty where they get none.
    ///
    /// Stamps rise from 0 s. Cases without times have none, as those of `none` and `sphere` that only name waypoints.
    fn timed(&self, case: &Case) -> Vec<Timed>;

    /// The planned duration (s) that a run's time limit is reckoned from: that of its `timed` reference.
    fn planned_s(&self, timed: &[Timed]) -> f64 {
        timed.last().map_or(0.0, |last| last.t)
    }

    /// The planned heading at each waypoint, rad from x towards y; empty where there is none.
    ///
    /// One a waypoint, or none at all; counter-clockwise seen from above.
    fn headings(&self, case: &Case) -> Vec<f64>;

    /// Hands the written witness to the verification room, and with it the environment, held to the bounds of `drawn`:
    /// the scenario that the case was searched with. What is found of the two is one proof.
    ///
    /// `None` where nothing is claimed. The environment's numbers (wind, gusts, obstacles) are held to the bounds
    /// that `drawn` gave the search; what was [`Made::Searched`] to the task.
    fn verify(&self, case: &Case, drawn: &Scenario, made: Made) -> (Option<Proof>, Option<EndError>);

    /// Holds the rows of its planned motion that are kept to the witness of `case`, which itself holds: to the
    /// polynomials by independent code, where a witness is polynomials, or else to the motion that the witness is
    /// planned as once more. Nothing for a case that claims none.
    fn verify_planned(&self, case: &Case, kept: &PlannedRows) -> Vec<Finding> {
        if case.witness.is_none() {
            return Vec::new();
        }
        match self.planned(case) {
            Ok(planned) => {
                let mut findings = kept.against(&planned, &RowTolerances::default());
                findings.extend(self.strays(case, &planned));
                findings
            }
            Err(error) => {
                let mut findings = Vec::new();
                Collector::about(&mut findings, "planned").refuse(format!("its motion cannot be planned: {error}"));
                findings
            }
        }
    }

    /// Where the motion that the witness of `case` is `planned` as leads elsewhere than the witness does: rows that are
    /// those of a wrong motion hold to it. Nothing of kinds whose motion is the witness.
    fn strays(&self, _case: &Case, _planned: &Track) -> Vec<Finding> {
        Vec::new()
    }

    /// What is claimed of waypoints that somebody else chose: a witness, or what breaks, leg by leg.
    ///
    /// # Errors
    /// Why nothing is, in a sentence's part.
    ///
    /// Legs are asked one by one, so that the first that breaks does not hide the next.
    fn passes(&self, _asked: &Demands) -> Result<Passage, String> {
        Err("missions are checked for flights, drives and boats".into())
    }

    /// The scenario's table of a world of `size` (m, from the origin on) with nothing in it, where there is one.
    ///
    /// For missions that are checked without a scenario: a cage, a field, waters. `None`: the kind needs a world of
    /// its own.
    fn open_world(&self, _size: &Vector3<f64>) -> Option<Value> {
        None
    }

    /// The scenario keys that can make more feasible, and what a run can be freed of.
    ///
    /// What explain turns, in the order in which a person would try it.
    fn knobs(&self) -> Knobs;
}

/// Searches the graphs of one setup.
///
/// Called from several threads, one graph each. `graph` and `random` decide every answer: a graph may be asked again,
/// for another purpose or after an interruption, and is the same.
///
/// Plans that it gives are feasible as the scenario's reach says, and have the evidence of that reach.
pub(in crate::campaign) trait Solver: Sync {
    /// Searches graph number `graph` for what is `wanted`; `executions` are for searches in the loop, `stop` ends it
    /// early.
    ///
    /// Scores of the result are those of the scenario's objective, or the executed stress where the search executes.
    /// What `stop` cut off is what was found until then, or nothing that is [`Outcome::stopped`].
    fn solve(&self, graph: u64, executions: Executions, wanted: Wanted, stop: &Stop) -> Outcome;

    /// Whether its legs can be asked for the optimum of other scores, by their names, than the scenario's.
    ///
    /// False where scores are not those of points and legs (drives, arms): [`Wanted::Optima`] with names is then
    /// refused.
    fn takes_scores(&self) -> bool {
        false
    }

    /// One feasible plan of graph number `graph`, drawn at random; the same whenever it is asked for, unless `stop`
    /// ends the drawing first.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part.
    ///
    /// The baseline of every comparison, so that it must not favour what a score favours.
    fn draw(&self, graph: u64, stop: &Stop) -> Result<Plan, String>;

    /// How [`draw`](Self::draw) draws, in a sentence's part.
    fn drawn_how(&self) -> &'static str;

    /// Plans that other searches of its own find, to begin a search of changes with beside draws.
    fn seeds(&self, _stop: &Stop) -> Vec<Plan> {
        Vec::new()
    }

    /// Whether waypoints of plans may lie anywhere that is feasible.
    fn moves(&self) -> bool {
        true
    }

    /// `plan`, drawn from graph number `graph`, over other `points`, as many as its own; `None` where that is not
    /// feasible.
    ///
    /// `points` in m. Only what changes is solved anew: legs with both ends as they were are kept.
    fn over(&self, graph: u64, plan: &Plan, points: &[Point3<f64>]) -> Option<Plan>;

    /// A waypoint of graph number `graph`, drawn at random.
    ///
    /// m. Uniform over the graph's waypoints; not asked whether a plan may pass it.
    fn elsewhere(&self, graph: u64, random: &mut Stream) -> Option<Point3<f64>>;

    /// `plan`, drawn from graph number `graph`, up to the first waypoint of leg `leg`, and `other` after it.
    fn crossed(&self, graph: u64, plan: &Plan, other: &Plan, leg: usize, _random: &mut Stream) -> Option<Plan> {
        self.over(graph, plan, &plan.spliced(other, leg)?)
    }

    /// `plan` with something else than its waypoints changed, at leg `leg` if that can be; `None` where nothing can, or
    /// what was drawn is not feasible.
    ///
    /// Leg times of flights, headings of drives, speeds, zones and configurations of arms.
    fn altered(&self, _plan: &Plan, _leg: usize, _random: &mut Stream) -> Option<Plan> {
        None
    }

    /// What is kept of a search, with what only kept plans are given.
    fn finished(&self, plan: Plan) -> Plan {
        plan
    }
}

/// Plans a case over other waypoints, on the claim that the case stands on.
///
/// For shrinking: a case loses waypoints, the world loses obstacles, and what is left must be feasible as before.
pub(in crate::campaign) trait Replanner {
    /// The case over `points`, of which the k-th was its waypoint number `indices[k]`, in the world of `setup`, if that
    /// is feasible as the case was. `None`: it is not, or nothing shows it.
    ///
    /// `indices` rise and are as many as `points`. The evidence of the new case is that of the old one; its score is
    /// not computed.
    fn plan(&self, setup: Same, indices: &[usize], points: &[Point3<f64>]) -> Option<Case>;
}
