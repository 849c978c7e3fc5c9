//! Forward drives on flat ground between two poses with curvatures, under bounds on κ and κ′.
//!
//! Where the end is and how it bends leaves few unknowns: an arc of fifth order has four, for two equations. Dubins'
//! words say which ways around there are and how short a path can be at best; along each, shortest first, an arc is
//! fitted and, where none keeps the bounds, a chain of clothoids. Nothing is allocated, nothing depends on a clock;
//! work is counted in steps.
//!
//! Data flow: query → mirrored so that it leans left (`mirror`) → Dubins' words, shortest first (`dubins`) → an arc
//! along each by sequential quadratic programming (`arc`), else a chain of clothoids (`chain`) → judged from the
//! numbers that are handed out (`miss`, `extremes`) → [`Answer`]. Turns in place and single arcs are closed forms
//! (`controls`).

mod arc;
mod chain;
mod controls;
mod dubins;
mod ends;
pub(super) mod extremes;
mod forward;
mod mirror;
mod miss;
mod settings;
mod start_table;
mod tabulate;
mod task;

#[cfg(feature = "unit-tests")]
mod tests;

pub use controls::{crab, turn_drive_turn};
pub use settings::{Answer, Control, Cost, Limit, Settings, Status};
pub use start_table::steering;

use super::query::{Curvatures, Goal, Query};
use crate::trajectory::drive::SegmentList;

/// Length of the shortest forward path to the goal of `query` whose curvature stays within ± `bounds.most` but may
/// jump, m: no forward drive is shorter (Dubins 1957).
///
/// The bound on κ′ is left out, so that it errs low; 0 only for a goal that is the start itself.
pub fn least_length(query: &Query, bounds: &Curvatures) -> f64 {
    let Goal { x, y, yaw, .. } = query.goal;
    dubins::words(x * bounds.most, y * bounds.most, yaw)[0].length() / bounds.most
}

/// The shortest ways around, by Dubins: signs of the curvature ± `bounds.most` on three pieces, and their metres; those
/// that do not exist are infinitely long.
///
/// Sorted by length; those that do not exist come last.
pub(super) fn ways(query: &Query, bounds: &Curvatures) -> [([f64; 3], [f64; 3]); 6] {
    let Goal { x, y, yaw, .. } = query.goal;
    dubins::words(x * bounds.most, y * bounds.most, yaw)
        .map(|word| (word.signs, word.pieces.map(|piece| piece / bounds.most)))
}

/// Drives forward from the origin to the goal of `query` within `bounds`.
///
/// ```text
/// x′ = cos θ   y′ = sin θ   θ′ = κ(s)   |κ| ≤ most   |κ′| ≤ most_rate
/// ```
/// from (0, 0, 0, κ₀) to (x, y, ψ modulo 2π, κ_f). Metres and radians. The answer holds one arc or the pieces of a
/// chain, with continuous curvature; mirrored queries have mirrored answers, to the bit. It is `Ok` only if its own
/// numbers meet the goal and keep both bounds (up to 10⁻⁹ of them).
///
/// Bounds that are no vehicle's are brought between 10⁻⁹ and 10⁶ 1/m and 10⁻¹² and 10¹² 1/m². Work: at most six ways
/// around, of the quintic each of at most 8 steps of an arc and then `iterations` of a chain, cut by `most_steps` over
/// all.
pub fn forward(query: &Query, bounds: &Curvatures, settings: &Settings) -> Answer {
    if mirror::leans_right(query) {
        return mirror::answer(solve(&mirror::query(query), bounds, settings));
    }
    solve(query, bounds, settings)
}

/// Hands over the drives of every way around that [`forward`] may take, where it solves `query`, shortest way first.
///
/// At most six, one for `Control::Arc`; each as `forward` would answer it if it were the only way.
pub fn every(query: &Query, bounds: &Curvatures, settings: &Settings, mut take: impl FnMut(SegmentList)) {
    let right = mirror::leans_right(query);
    let asked = if right { mirror::query(query) } else { *query };
    let mut solved = |answer: Answer| {
        let answer = if right { mirror::answer(answer) } else { answer };
        if answer.status == Status::Ok {
            take(answer.segments);
        }
    };
    match settings.control {
        Control::Arc => solved(controls::arc(&asked, bounds, settings)),
        Control::Cubic | Control::Quintic => forward::every(&asked, bounds, settings, solved),
    }
}

/// `query` leans to the left or straight on.
fn solve(query: &Query, bounds: &Curvatures, settings: &Settings) -> Answer {
    match settings.control {
        Control::Arc => controls::arc(query, bounds, settings),
        Control::Cubic | Control::Quintic => forward::search(query, bounds, settings),
    }
}
