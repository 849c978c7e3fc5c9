//! What both Lagrangian relaxations have in common: multipliers, and what they say of each choice.
//!
//! Degrees are relaxed, connectedness is kept: what is left is a spanning structure that a greedy algorithm solves
//! exactly. Both relaxations are integral, so that their bounds are those of the linear program with the connectedness
//! constraints.

use super::choices::{Arc, Choice, Choices, IN, Made, OUT};

/// A problem without its rules on degrees, which multipliers price instead; what is left is solved exactly.
///
/// L(λ) = (costs of what is used) + Σ λ · (what each rule allows − what is used of it), so that L(λ) ≥ every path's
/// cost. Weights are integers: costs times the scale, multipliers in the same unit.
pub(super) trait Relaxation: Send {
    /// For problems of this shape.
    fn new(choices: &Choices) -> Self;

    /// The bound with `multipliers` (one a point, and one for starts), and [`Relaxation::used`]; `None` if nothing
    /// keeps the choices made. `renew` says that choices or arcs are others than last time.
    fn solve(&mut self, choices: &Choices, made: &Made, multipliers: &[i64], renew: bool) -> Option<i64>;

    /// Choices in the relaxed solution.
    ///
    /// One structure, not a path: degrees may be wrong.
    fn used(&self) -> &[u32];

    /// How far the relaxed solution is from each rule: arcs too many at each point, starts too many.
    ///
    /// n + 1 numbers, points and then starts: a subgradient of L up to its sign. All 0 where the structure is a path.
    fn excess(&self, choices: &Choices, excess: &mut [i32]);

    /// After [`Relaxation::solve`] with value `bound`: every open choice whose opposite has a bound below `threshold`,
    /// with the state that it must have.
    fn decided(
        &mut self,
        choices: &Choices,
        made: &Made,
        multipliers: &[i64],
        bound: i64,
        threshold: i64,
        decided: &mut Vec<(u32, u8)>,
    );
}

/// The two best ends: weight and choice.
///
/// An end weighs −λ of its point. An end that is in stands alone. `None` where no end is left.
pub(super) fn best_ends(choices: &Choices, made: &Made, multipliers: &[i64]) -> [Option<(i64, usize)>; 2] {
    let mut best = [None, None];
    for (point, multiplier) in multipliers[..choices.points].iter().enumerate() {
        let id = choices.end(point);
        if made.state[id] == OUT {
            continue;
        }
        let candidate = Some((-multiplier, id));
        if made.state[id] == IN {
            return [candidate, None];
        }
        if candidate.map(|c| c.0) > best[0].map(|c: (i64, usize)| c.0) {
            best = [candidate, best[0]];
        } else if candidate.map(|c| c.0) > best[1].map(|c| c.0) {
            best[1] = candidate;
        }
    }
    best
}

/// The path that relaxed choices are, if they keep all rules.
///
/// Points from the start on; loops and ends add nothing.
pub(super) fn path_of(choices: &Choices, used: &[u32]) -> Vec<usize> {
    const NOBODY: u32 = u32::MAX;
    let mut beside = vec![[NOBODY; 2]; choices.points];
    let mut add = |at: u32, next: u32| {
        let places = &mut beside[at as usize];
        places[usize::from(places[0] != NOBODY)] = next;
    };
    let mut first = None;
    for id in used {
        match choices.kind(*id as usize) {
            Choice::Arc(arc) => {
                let Arc { from, to, .. } = choices.arcs[arc];
                add(from, to);
                if !choices.directed {
                    add(to, from);
                }
            }
            Choice::Start(point) => first = Some(point as u32),
            Choice::Loop(_) | Choice::End(_) => {}
        }
    }
    let mut path = Vec::new();
    let (mut before, mut at) = (NOBODY, first);
    while let Some(point) = at {
        path.push(point as usize);
        let next = beside[point as usize].into_iter().find(|next| *next != NOBODY && *next != before);
        (before, at) = (point, next);
    }
    path
}
