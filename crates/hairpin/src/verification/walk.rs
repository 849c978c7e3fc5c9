//! The proof that no path is heavier that comes back to points: every bound of a branching tree recomputed, and that
//! its branches leave nothing out.
//!
//! Shares nothing with the search. Point n is a dummy before the first point and after the last. A path uses each arc
//! at most once, enters and leaves each point equally often and at most `visits` times, the dummy once. So for any
//! prices a_i of leaving and b_j of entering, with s_i = visits (1 of the dummy), its cost is at most
//!
//!   Σ s_i (a_i + b_i) + Σ_free max(0, c_ij − a_i − b_j) + Σ_used (c_ij − a_i − b_j) + Σ_points visits · max(0, −a_i −
//!   b_i):
//!
//! a point that is visited less often has so many times neither its a nor its b spent.

/// A path and what proves that it is the heaviest.
///
/// The proof's steps are read in any order; one that is missing, or a way out of a part that no branch has, is told.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WalkClaim {
    /// Number of points.
    pub points: usize,
    /// Costs in rows, from → to; `None` without an arc. The diagonal has no meaning.
    pub costs: Vec<Option<i64>>,
    /// First point, if fixed.
    pub start: Option<usize>,
    /// Last point, if fixed.
    pub end: Option<usize>,
    /// How often a point may come.
    pub visits: usize,
    /// The path.
    pub path: Vec<usize>,
    /// Its cost.
    pub cost: i64,
    /// The branching tree: steps from number 0.
    pub steps: Vec<WalkStepClaim>,
}

/// A step: prices that bound what is left, or a split of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WalkStepClaim {
    /// Of leaving each point and the dummy, then of entering them.
    pub prices: Vec<i64>,
    /// What follows where the bound does not end it.
    pub split: Option<SplitClaim>,
}

/// A path meets none of these points, or an arc leads it out of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SplitClaim {
    /// The points.
    pub points: Vec<usize>,
    /// The step without them; `None` where one of them must be met, because an arc there is used.
    pub without: Option<usize>,
    /// From, to (the number of points for the dummy), and the step in which this arc is used and those before it are
    /// not.
    pub ways: Vec<(usize, usize, usize)>,
}

const FREE: u8 = 0;
/// Every path of what is left uses it.
const USED: u8 = 1;
/// No path of what is left uses it, or it is no arc.
const GONE: u8 = 2;

/// All that does not hold, in words; empty: the path is one of this cost, and none is heavier.
///
/// The first finding only. O(steps · n²) time; every step holds its n² states while it waits.
pub fn verify_walk(claim: &WalkClaim) -> Vec<String> {
    check_path(claim).and_then(|()| check_tree(claim)).err().into_iter().collect()
}

/// The path on its own, O(n² + its length): it leads from the asked start to the asked end, no point comes more than
/// `visits` times, every arc exists and none is used twice, and its costs, summed in 128 bits, are the cost claimed.
fn check_path(claim: &WalkClaim) -> Result<(), String> {
    let n = claim.points;
    if n == 0 || claim.costs.len() != n * n || claim.visits == 0 {
        return Err(format!("{} costs for {n} points, {} visits", claim.costs.len(), claim.visits));
    }
    let (Some(first), Some(last)) = (claim.path.first(), claim.path.last()) else {
        return Err("the path has no point".into());
    };
    if claim.start.is_some_and(|start| start != *first) || claim.end.is_some_and(|end| end != *last) {
        return Err(format!("the path leads from {first} to {last}"));
    }
    let mut came = vec![0; n];
    for point in &claim.path {
        *came.get_mut(*point).ok_or_else(|| format!("point {point} of {n}"))? += 1;
    }
    if let Some(point) = came.iter().position(|times| *times > claim.visits) {
        return Err(format!("point {point} comes {} times", came[point]));
    }
    let mut used = vec![false; n * n];
    let mut sum = 0i128;
    for leg in claim.path.windows(2) {
        let index = leg[0] * n + leg[1];
        let cost = claim.costs[index].filter(|_| leg[0] != leg[1]);
        sum += i128::from(cost.ok_or_else(|| format!("no arc {}→{}", leg[0], leg[1]))?);
        if std::mem::replace(&mut used[index], true) {
            return Err(format!("the arc {}→{} is used twice", leg[0], leg[1]));
        }
    }
    if sum == i128::from(claim.cost) { Ok(()) } else { Err(format!("the path costs {sum}, not {}", claim.cost)) }
}

/// Goes through the tree from its root with what is decided of every arc: free, used, gone. O(steps · n²).
///
/// A leaf is closed if its bound is no more than the cost claimed. A split names points C, never the dummy among them:
/// a path either meets none of C, which is the branch without them and may be missing only where a used arc touches C;
/// or it leaves C, for it has to come back to the dummy. The k-th way uses one arc that leads out of C and has those of
/// the ways before it gone; after the last one no arc out of C may be left. So no path is lost. Steps refer to later
/// ones only and each is met exactly once: the walk ends, and nothing of the claim goes unread.
fn check_tree(claim: &WalkClaim) -> Result<(), String> {
    let nodes = claim.points + 1;
    let start: Vec<u8> =
        (0..nodes * nodes).map(|index| if cost(claim, index).is_some() { FREE } else { GONE }).collect();
    let mut met = vec![false; claim.steps.len()];
    let mut open = vec![(0usize, start)];
    while let Some((number, states)) = open.pop() {
        let wrong = |what: &str| format!("step {number} {what}");
        let step = claim.steps.get(number).ok_or_else(|| wrong("is missing"))?;
        if std::mem::replace(&mut met[number], true) {
            return Err(wrong("comes twice"));
        }
        let Some(split) = &step.split else {
            if bound(claim, &states, &step.prices).ok_or_else(|| wrong("has too many, too few or too large prices"))?
                > i128::from(claim.cost)
            {
                return Err(wrong("is left open: its bound is above the cost"));
            }
            continue;
        };
        let mut inside = vec![false; nodes];
        for point in &split.points {
            match inside.get_mut(*point).filter(|_| *point < claim.points) {
                Some(inside) => *inside = true,
                None => return Err(wrong("splits off a point that there is not")),
            }
        }
        let mut states_of_ways = states.clone();
        let touches = |index: usize| inside[index / nodes] || inside[index % nodes];
        let mut children = match split.without {
            Some(child) => vec![(child, without(&states, touches))],
            None if states.iter().enumerate().any(|(index, state)| *state == USED && touches(index)) => Vec::new(),
            None => return Err(wrong("leaves out what meets none of its points")),
        };
        for (from, to, child) in &split.ways {
            if *from >= nodes || *to >= nodes || !inside[*from] || inside[*to] {
                return Err(wrong("has a way that does not lead out"));
            }
            let index = from * nodes + to;
            let mut used = states_of_ways.clone();
            // An arc that is gone cannot be used: nothing is left there, and what its step says of it holds all the
            // same.
            used[index] = if used[index] == GONE { GONE } else { USED };
            children.push((*child, used));
            states_of_ways[index] = GONE;
        }
        let leads_out = |index: &usize| inside[index / nodes] && !inside[index % nodes];
        if (0..nodes * nodes).filter(leads_out).any(|index| states_of_ways[index] != GONE) {
            return Err(wrong("leaves out a way"));
        }
        for (child, states) in children {
            if child <= number {
                return Err(wrong("goes back"));
            }
            open.push((child, states));
        }
    }
    match met.iter().position(|met| !met) {
        Some(number) => Err(format!("step {number} belongs to nothing")),
        None => Ok(()),
    }
}

/// Cost of an arc between points and the dummy; `None` without one.
fn cost(claim: &WalkClaim, index: usize) -> Option<i64> {
    let n = claim.points;
    match (index / (n + 1), index % (n + 1)) {
        (from, to) if from == to => None,
        (from, to) if from == n => claim.start.is_none_or(|start| start == to).then_some(0),
        (from, to) if to == n => claim.end.is_none_or(|end| end == from).then_some(0),
        (from, to) => claim.costs[from * n + to],
    }
}

/// What is left where no path meets the points: every arc that touches one of them is gone. Where one of those must be
/// used there is no such path, and letting it go only asks for more.
fn without(states: &[u8], touches: impl Fn(usize) -> bool) -> Vec<u8> {
    let left = |(index, state): (usize, &u8)| if touches(index) { GONE } else { *state };
    states.iter().enumerate().map(left).collect()
}

/// The bound of this file's head for given prices, exact in 128 bits. It holds for any prices whatever, so that where
/// they came from needs no trust: poor ones make a weak bound, never a wrong one.
fn bound(claim: &WalkClaim, states: &[u8], prices: &[i64]) -> Option<i128> {
    let nodes = claim.points + 1;
    if prices.len() != 2 * nodes {
        return None;
    }
    let (leave, enter) = prices.split_at(nodes);
    let both = |node: usize| i128::from(leave[node]) + i128::from(enter[node]);
    let visits = i128::try_from(claim.visits).ok()?;
    let mut sum = both(claim.points);
    for point in 0..claim.points {
        sum += visits * both(point).max(0);
    }
    for (index, state) in states.iter().enumerate().filter(|(_, state)| **state != GONE) {
        let left =
            i128::from(cost(claim, index)?) - i128::from(leave[index / nodes]) - i128::from(enter[index % nodes]);
        sum += if *state == USED { left } else { left.max(0) };
    }
    Some(sum)
}
