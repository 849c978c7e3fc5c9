//! One question among places to keep out of.

use super::detour::detour;
use super::hazards::{Hazards, Intrusion};
use super::ways::{Way, every};
use crate::feasibility::steering::shooting::query::{Curvatures, Query};
use crate::feasibility::steering::shooting::solve::{self, Choices, Outcome, Solution};

/// A solution, and where it comes too near to a place to keep out of.
///
/// `intrusion.depth` is what the best drive lacks, so that 0 cannot occur in it.
///
/// A solution whose goal is not met may be clear; status and intrusion are asked apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cleared {
    /// The drive that stays clear; where none was found, the one that comes least near.
    pub solution: Solution,
    /// `None` if the drive stays clear.
    pub intrusion: Option<Intrusion>,
}

/// Solves `query` within `bounds` by a drive that stays clear of `hazards`.
///
/// Tried in turn: what [`solve::solve`] answers; every single arc, turn–drive–turn and word of clothoids that `choices`
/// allow, with circles of three sizes, shortest first; detours over poses beside what is in the way. `stop` is asked
/// between them.
///
/// Complete in nothing: `intrusion` of the best is the evidence.
///
/// `iterations` of the answer counts steps of the plain answer, ways that were offered and legs of detours together. A
/// start or a goal that is itself too near ends the search at once, as does a plain question without a solution.
/// Deterministic unless `stop` depends on a clock.
pub fn solve(
    query: &Query,
    bounds: &Curvatures,
    choices: &Choices,
    hazards: &Hazards<'_>,
    mut stop: impl FnMut() -> bool,
) -> Cleared {
    let solution = solve::solve(query, bounds, choices, &mut stop);
    let mut best = Cleared { solution, intrusion: hazards.intrusion(&solution.segments) };
    let Some(first) = best.intrusion else { return best };
    // Whatever starts or ends too near is too near.
    let goal = &query.goal;
    let hopeless = hazards.room(0.0, 0.0) < 0.0 || hazards.room(goal.x, goal.y) < 0.0;
    if hopeless || solution.outcome != Outcome::Solved {
        return best;
    }
    let mut depth = first.depth;
    let mut tried = 0;
    let mut offer = |way: &Way| {
        tried += 1;
        let intrusion = hazards.worst(&way.segments, depth);
        if intrusion.is_none_or(|intrusion| intrusion.depth < depth) {
            depth = intrusion.map_or(0.0, |intrusion| intrusion.depth);
            let solution = Solution { segments: way.segments, method: way.method, ..solution };
            best = Cleared { solution, intrusion };
        }
        intrusion.is_none()
    };
    let mut stopped = false;
    let mut over = || {
        stopped |= stop();
        stopped
    };
    let found = every(query, bounds, choices).iter().any(|way| over() || offer(way)) && !stopped;
    let mut legs = 0;
    if !found && !stopped {
        let (way, asked) = detour(query, bounds, choices, hazards, first.place, &mut || {
            stopped |= stop();
            stopped
        });
        legs = asked;
        way.iter().for_each(|way| {
            offer(way);
        });
    }
    best.solution.iterations += tried + legs;
    if best.intrusion.is_some() && stopped {
        best.solution.outcome = Outcome::Stopped;
    }
    best
}
