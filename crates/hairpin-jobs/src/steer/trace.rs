//! The steps of searches, for those who want to see them.

use hairpin::feasibility::steering::shooting::families::{Iteration, Problem as Boundary};
use hairpin::feasibility::steering::shooting::query::Curvatures;
use hairpin::feasibility::steering::shooting::solve::{Choices, Solution};
use hairpin::feasibility::steering::shooting::{Control, flat, generate};

/// A step of a descent.
pub(super) fn trace_step(step: &Iteration) {
    let Iteration { start, step, length, miss, bends } = step;
    tracing::debug!("start {start}, step {step}: {length:.4} m, misses by {miss:.2e}, {bends:.4} of the bounds");
}

/// The flat solver's steps: it takes no observer along, so its answers after one, two and more steps are asked for
/// again.
pub(super) fn retrace(
    boundary: &Boundary,
    control: Control,
    bounds: &Curvatures,
    choices: &Choices,
    solution: &Solution,
) {
    for iterations in 0..=solution.iterations.min(choices.flat.iterations) {
        let flat = flat::Settings { iterations, ..choices.flat };
        let stopped = generate(boundary, control, bounds, &Choices { flat, ..*choices }, || false, |_| {});
        let length: f64 = stopped.solution.segments.iter().map(|segment| segment.length_m()).sum();
        tracing::debug!("{iterations} steps at most: {length:.4} m, {:?}", stopped.solution.arc);
    }
}
