//! The programs that were written, followed once more by code that shares nothing with what found and runs them.
//!
//! The end of each move against its waypoint: ‖p − p̂‖ ≤ [`MET`]. What is refused is told as a finding on the leg it
//! is of; the worst miss is the proof's `position`.

use super::ArmSetup;
use crate::campaign::Case;
use crate::trajectory::program::Program;
use crate::verification::{ArmMoveFinding, Collector, Proof, Worst};

/// Distance within which a waypoint counts as met, m: a module's numbers have a millionth of a millimetre.
const MET: f64 = 1e-6;

/// Follows the program of `case` by equations of its own: every move must lead to its waypoint, every joint stay within
/// its bounds, and, where all links are claimed to be clear, none come nearer to a part of the cell than was claimed,
/// nor touch it where a zone cuts a corner. Sampled: what the graph proves between samples is not proven again. `None`
/// for a case that has no program.
pub(super) fn verify(setup: &ArmSetup, case: &Case) -> Option<Proof> {
    let program = case.program()?;
    let mut proof = Proof::default();
    if let Some(refusal) = refused(program) {
        Collector::on_leg(&mut proof.findings, 0, 0.0).refuse(refusal);
        return Some(proof);
    }
    let replay = setup.followed_again(case, program);
    for (index, miss) in replay.misses.iter().enumerate() {
        let (leg, at) = leg_of(case, index);
        if *miss > proof.position.value {
            proof.position = Worst { value: *miss, leg, at };
        }
        let end = if index == 0 { "start.position" } else { "end.position" };
        Collector::on_leg(&mut proof.findings, leg, at).above(end, *miss, MET, "m");
    }
    for ArmMoveFinding { index, at, what } in replay.findings {
        let leg = leg_of(case, index).0;
        let what = format!("{what} at {:.0} % of the move", 100.0 * at);
        Collector::on_leg(&mut proof.findings, leg, 0.0).refuse(what);
    }
    Some(proof)
}

/// The leg that a move is, the first of which leads to where the legs begin, and when it is planned to end, s.
///
/// `at` is Σ of the planned durations of the moves before it, s: times beyond what is planned count as the plan's end.
fn leg_of(case: &Case, index: usize) -> (usize, f64) {
    (index.saturating_sub(1), case.leg_times.iter().take(index).sum())
}

/// Why a controller would not execute a program with this arm.
fn refused(program: &Program) -> Option<String> {
    if let Some(problem) = program.problems().into_iter().next() {
        return Some(format!("program = {problem}: must be one that a controller executes"));
    }
    program.moves.iter().find_map(|one| {
        let (tool, object) = (&program.tools[one.tool], &program.work_objects[one.work_object]);
        if !tool.held {
            return Some(format!("tool = {}: must be held by the arm", tool.name));
        }
        if object.held || object.moved_by.is_some() {
            return Some(format!("work_object = {}: must be at rest in the cell", object.name));
        }
        let slowest = one.speed.tcp.min(one.speed.orientation);
        (slowest <= 0.0).then(|| format!("speed = {slowest}: must be more than 0"))
    })
}
