//! What is said of a heaviest path, and the tree that proves it.

/// A path and what proves it.
///
/// As the campaign's file has it; costs and cost in one unit, whatever it is.
///
/// ```
/// use hairpin::verification::{HeaviestClaim, verify_heaviest};
///
/// // Points at 0, 1 and 5 on a line, no tree: the path is searched again.
/// let at = [0_i64, 1, 5];
/// let costs = at.iter().flat_map(|a| at.map(|b| (*a != b).then_some((a - b).abs()))).collect();
/// let (start, end, tree) = (None, None, None);
/// let mut claim = HeaviestClaim { points: 3, costs, start, end, path: vec![0, 2, 1], cost: 9, tree };
/// assert!(verify_heaviest(&claim).is_empty());
/// (claim.path, claim.cost) = (vec![0, 1, 2], 5); // a path of that cost, but not the heaviest
/// assert!(!verify_heaviest(&claim).is_empty());
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HeaviestClaim {
    /// Number of points.
    pub points: usize,
    /// Costs in rows, from → to; `None` without an arc. The diagonal has no meaning.
    pub costs: Vec<Option<i64>>,
    /// First point, if fixed.
    pub start: Option<usize>,
    /// Last point, if fixed.
    pub end: Option<usize>,
    /// The path.
    pub path: Vec<usize>,
    /// Its cost.
    pub cost: i64,
    /// The branching tree; without it the path is searched again.
    pub tree: Option<TreeClaim>,
}

/// A branching tree: steps from number 0.
///
/// The tree must cover the problem: each step is reached once, and each branch has both of its sides.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TreeClaim {
    /// Multipliers are in units of cost / scale.
    pub scale: i64,
    /// Whether arcs have directions.
    pub directed: bool,
    /// The steps.
    pub steps: Vec<StepClaim>,
}

/// A step: with these multipliers, these choices must be out or in, and then something follows. The arc i→j is choice
/// i·n + j (of an undirected arc, i < j); then follow n starts, n loops (points left out), and n ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StepClaim {
    /// One a point, and one for starts.
    pub multipliers: Vec<i64>,
    /// Priced cuts; of undirected arcs alone.
    pub cuts: Vec<CutClaim>,
    /// Must be out: with it in, the bound is too small.
    pub out: Vec<u64>,
    /// Must be in: with it out, the bound is too small.
    pub into: Vec<u64>,
    /// What follows.
    pub next: NextClaim,
}

/// A price for: of a set of points and one of them, arcs inside the set and points of it that are left out, that one
/// aside, are together fewer than the set's points. Every path keeps to it: one that meets the point has fewer arcs
/// there than points that it meets; of one that does not, the point itself is left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CutClaim {
    /// The set.
    pub points: Vec<usize>,
    /// The point of it that does not count as left out.
    pub except: usize,
    /// At least 0, in units of cost / scale.
    pub price: i64,
}

/// What follows a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NextClaim {
    /// Nothing is left.
    Closed,
    /// Another step for the same problem.
    Again(usize),
    /// One step with a choice out, one with it in.
    Branch {
        /// The choice.
        choice: u64,
        /// Step with it out.
        out: usize,
        /// Step with it in.
        into: usize,
    },
}
