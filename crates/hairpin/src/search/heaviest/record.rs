//! The branching tree as it was searched: what a certificate says.

use super::choices::Choices;

/// One look at a problem: the multipliers, what their bound decides, and what was done then.
///
/// Multipliers alone fix the bound: whoever has the costs computes it again. `out` and `into` are claims that the bound
/// supports: each by its opposite's bound being below the best.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// One integer a point, and one for starts, in units of cost / [`Proof::scale`].
    pub multipliers: Vec<i64>,
    /// Cuts with a price above 0.
    pub cuts: Vec<PricedCut>,
    /// Choices whose opposite has too small a bound: out.
    pub out: Vec<u64>,
    /// Likewise: in.
    pub into: Vec<u64>,
    /// What follows.
    pub next: Next,
}

/// A price for: arcs inside a set of points, and points of it left out but one of them, are together less than the
/// set's points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PricedCut {
    /// The set.
    pub points: Vec<usize>,
    /// The point of it that does not count as left out.
    pub except: usize,
    /// At least 0, in units of cost / [`Proof::scale`].
    pub price: i64,
}

/// What follows a [`Step`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Next {
    /// Nothing: the bound is too small, or the choices contradict each other.
    Closed,
    /// Another look at the same problem, by number.
    Again(usize),
    /// A choice is out in one step, in in the other.
    Branch {
        /// The choice.
        choice: u64,
        /// The step with it out.
        out: usize,
        /// The step with it in.
        into: usize,
    },
}

/// A proof that no path is heavier than the best: steps from number 0.
///
/// Choices have numbers: the arc i→j is i·n + j (of an undirected arc, i < j), then follow n starts, n loops (a point
/// is left out), and n ends.
///
/// A tree in the order of search. A leaf is closed by a bound below what is wanted, one more than the best path's cost,
/// or by choices that contradict each other: so no path is heavier.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Proof {
    /// Multipliers are in units of cost / scale.
    pub scale: i64,
    /// Whether arcs have directions.
    pub directed: bool,
    /// The tree.
    pub steps: Vec<Step>,
}

/// Steps as they come; a search that is to prove nothing to anybody keeps none.
#[derive(Clone, Default)]
pub(super) struct Recorder {
    /// Whether steps are kept; if not, every number is 0 and nothing is written.
    pub(super) wanted: bool,
    /// In the order in which they were taken.
    pub(super) steps: Vec<Step>,
}

impl Recorder {
    pub(super) fn new(wanted: bool) -> Self {
        Self { wanted, steps: Vec::new() }
    }

    /// A step that is closed until [`Recorder::follow`] says otherwise; its number.
    pub(super) fn step(&mut self, choices: &Choices, multipliers: &[i64], out: Vec<u64>, into: Vec<u64>) -> usize {
        if self.wanted {
            let (multipliers, prices) = multipliers.split_at(choices.points + 1);
            let priced = choices.cuts.iter().zip(prices).filter(|(_, price)| **price > 0);
            let cuts = priced.map(|(cut, price)| {
                let (points, except) = cut.named();
                PricedCut { points, except, price: *price }
            });
            let (multipliers, cuts) = (multipliers.to_vec(), cuts.collect());
            self.steps.push(Step { multipliers, cuts, out, into, next: Next::Closed });
        }
        self.steps.len().saturating_sub(1)
    }

    /// Says what comes after a step.
    pub(super) fn follow(&mut self, step: usize, next: Next) {
        if self.wanted {
            self.steps[step].next = next;
        }
    }

    /// Forgets the steps from this number on.
    pub(super) fn forget(&mut self, from: usize) {
        self.steps.truncate(from);
    }

    /// The number that the next step will have.
    pub(super) fn next_number(&self) -> usize {
        self.steps.len()
    }

    /// Puts the steps of a part behind the own ones; where they begin.
    ///
    /// Numbers inside the part are moved with it.
    pub(super) fn append(&mut self, part: Vec<Step>) -> usize {
        let base = self.steps.len();
        let moved = part.into_iter().map(|step| {
            let next = match step.next {
                Next::Closed => Next::Closed,
                Next::Again(step) => Next::Again(step + base),
                Next::Branch { choice, out, into } => Next::Branch { choice, out: out + base, into: into + base },
            };
            Step { next, ..step }
        });
        self.steps.extend(moved);
        base
    }
}
