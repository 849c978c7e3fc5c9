//! Controls of any family among places to keep out of.

use super::hazards::{Hazards, Intrusion};
use super::solve::solve;
use crate::feasibility::steering::shooting::families::{Iteration, Problem};
use crate::feasibility::steering::shooting::query::Curvatures;
use crate::feasibility::steering::shooting::solve::Choices;
use crate::feasibility::steering::shooting::{Control, Generated, generate as shoot};
use crate::trajectory::drive::{Motion, Segment, SegmentList};

/// [`shoot`](crate::feasibility::steering::shooting::generate) and where its drive comes too near to one of `hazards`.
///
/// The default control with a constant direction of travel goes around them, as [`solve`] does. Other controls are what their family answers:
/// one drive, which is checked.
pub fn generate(
    problem: &Problem,
    control: Control,
    bounds: &Curvatures,
    choices: &Choices,
    hazards: &Hazards<'_>,
    stop: impl FnMut() -> bool,
    observe: impl FnMut(&Iteration),
) -> (Generated, Option<Intrusion>) {
    if control == Control::Quintic && problem.swing == 0.0 && !hazards.keep_outs.is_empty() {
        let found = solve(&problem.query, bounds, choices, hazards, stop);
        return (Generated { solution: found.solution, parameters: None, fit_error: 0.0 }, found.intrusion);
    }
    let found = shoot(problem, control, bounds, choices, stop, observe);
    let intrusion = hazards.intrusion(&travelled(&found.solution.segments, problem.swing));
    (found, intrusion)
}

/// The path that a body on `segments` takes whose direction of travel turns by `swing` along them: it bends as much more.
fn travelled(segments: &SegmentList, swing: f64) -> SegmentList {
    let length: f64 = segments.iter().map(Segment::length_m).sum();
    let mut path = *segments;
    if swing != 0.0 && length > 0.0 {
        for segment in path.iter_mut() {
            let sign = segment.gear.sign();
            if let Motion::Arc { curvature, .. } = &mut segment.motion {
                curvature[0] += sign * swing / length;
            }
        }
    }
    path
}
