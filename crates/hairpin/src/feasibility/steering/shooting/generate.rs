//! One call for every control: the flat solver's own, the closed forms, and the families; the value decides.

use super::control::Control;
use super::families::{self, Among, Answer, Iteration, Parameters, Problem};
use super::flat;
use super::preference::Effort;
use super::query::{Curvatures, Goal, Query};
use super::solve::{Choices, Method, Outcome, Solution, solve};
use crate::trajectory::drive::Gear;

/// What was found, with the family's own numbers.
///
/// `parameters` are those of the drive as it was solved, forward; a drive in reverse is its mirror image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Generated {
    /// The drive, and how it was found.
    pub solution: Solution,
    /// The parameters of controls other than chains, turns and single arcs.
    ///
    /// `None` as well of everything that the flat solver and the closed forms answer.
    pub parameters: Option<Parameters>,
    /// Largest difference between the family's curvature and that of the drive's segments, 1/m.
    pub fit_error: f64,
}

/// Solves `problem` within `bounds` by the controls of `control`.
///
/// The default, the quintic with a constant direction of travel, is [`solve`] itself. Other controls answer in their
/// own family or not at all: then the outcome is `NotConverged` and [`Solution::arc`] says what the family lacks. With
/// `choices.reversals` they try both gears; they do not change gear on the way. `stop` is asked between descents,
/// `observe` sees their steps.
///
/// Deterministic unless `stop` depends on a clock. Nothing is allocated by the quintic.
///
/// A drive in reverse is solved as its mirror image about the y axis, (x, y, ψ) ↦ (−x, y, −ψ) with κ as it is and
/// −swing for swing, and each segment's gear is set afterwards. Of two gears the solved drive wins, then the shorter,
/// then the preferred one.
pub fn generate(
    problem: &Problem,
    control: Control,
    bounds: &Curvatures,
    choices: &Choices,
    mut stop: impl FnMut() -> bool,
    mut observe: impl FnMut(&Iteration),
) -> Generated {
    let plain = |solution| Generated { solution, parameters: None, fit_error: 0.0 };
    let straight = problem.swing == 0.0;
    match control {
        Control::Quintic if straight => return plain(solve(&problem.query, bounds, choices, stop)),
        Control::TurnDriveTurn => {
            let turning = Choices { turns: true, arcs: false, ..*choices };
            return plain(solve(&problem.query, bounds, &turning, stop));
        }
        _ => {}
    }
    let other = choices.gear.opposite();
    let gears: &[Gear] = if choices.reversals { &[choices.gear, other] } else { &[choices.gear] };
    let mut best: Option<Generated> = None;
    for &gear in gears {
        if best.is_some() && stop() {
            break;
        }
        let question = mirrored(problem, gear);
        let mut found = match control.flat().filter(|_| straight) {
            Some(family) => {
                let settings = flat::Settings { control: family, ..choices.flat };
                let answer = flat::forward(&question.query, bounds, &settings);
                plain(solution(answer.status, answer.segments, answer.iterations, false))
            }
            None => {
                let settings = families::Settings { precision: choices.flat.precision, ..choices.families };
                in_family(&mut stop, |asked| {
                    families::solve(&question, control, bounds, &settings, asked, &mut observe)
                })
            }
        };
        found.solution.segments.iter_mut().for_each(|segment| segment.gear = gear);
        if best.as_ref().is_none_or(|best| better(&found.solution, &best.solution)) {
            best = Some(found);
        }
    }
    best.unwrap_or_else(|| plain(solve(&problem.query, bounds, choices, || true)))
}

/// [`generate`] in the gear of `choices` and in a family of its own, among what is in the way of its path; its guides
/// are driven forward.
///
/// No second gear is tried. `depth` of `among` is asked about commands driven forward, before the gear is set.
pub fn generate_among(
    problem: &Problem,
    control: Control,
    bounds: &Curvatures,
    choices: &Choices,
    among: &Among<'_>,
    mut stop: impl FnMut() -> bool,
    mut observe: impl FnMut(&Iteration),
) -> Generated {
    let settings = families::Settings { precision: choices.flat.precision, ..choices.families };
    let question = mirrored(problem, choices.gear);
    let mut found = in_family(&mut stop, |asked| {
        families::solve_among(&question, control, bounds, &settings, among, asked, &mut observe)
    });
    found.solution.segments.iter_mut().for_each(|segment| segment.gear = choices.gear);
    found
}

/// What `solve` answers, which is told to stop as `stop` is and once and for all.
///
/// Once `stop` has said so it stays so, whatever it says later, and what was not solved by then is `Stopped`, not
/// `NotConverged`.
fn in_family(stop: &mut dyn FnMut() -> bool, solve: impl FnOnce(&mut dyn FnMut() -> bool) -> Answer) -> Generated {
    let mut stopped = false;
    let answer = solve(&mut || {
        stopped |= stop();
        stopped
    });
    Generated {
        solution: solution(answer.status, answer.segments, answer.iterations, stopped),
        parameters: Some(answer.parameters),
        fit_error: answer.fit_error,
    }
}

/// `Infeasible` of a family becomes `NotConverged`; what it lacks stays in [`Solution::arc`].
fn solution(
    status: flat::Status,
    segments: crate::trajectory::drive::SegmentList,
    iterations: u32,
    stopped: bool,
) -> Solution {
    let outcome = match status {
        flat::Status::Ok => Outcome::Solved,
        _ if stopped => Outcome::Stopped,
        _ => Outcome::NotConverged,
    };
    Solution { outcome, segments, method: Method::SingleArc, iterations, arc: Some(status) }
}

/// Solved before unsolved, then by [`Effort`]; of equals the one that was there.
fn better(found: &Solution, best: &Solution) -> bool {
    match (found.outcome == Outcome::Solved, best.outcome == Outcome::Solved) {
        (true, true) => Effort::of(&found.segments).against(&Effort::of(&best.segments)).is_lt(),
        (found, _) => found,
    }
}

/// The problem that a drive in `gear` solves if it is driven forward: in reverse, the mirror image about the y axis.
fn mirrored(problem: &Problem, gear: Gear) -> Problem {
    match gear {
        Gear::Forward => *problem,
        Gear::Reverse => {
            let Query { goal, .. } = problem.query;
            let query = Query { goal: Goal { x: -goal.x, yaw: -goal.yaw, ..goal }, ..problem.query };
            Problem { query, swing: -problem.swing, ..*problem }
        }
    }
}
