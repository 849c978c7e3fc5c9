//! The proof that no path is heavier: every bound of a branching tree recomputed, by other algorithms than those that
//! found it.
//!
//! Shares nothing with the search: trees by Prim's algorithm on the whole table, arborescences by contraction of one
//! circle at a time, sums in 128 bits; what follows from choices is found by going over all rules again and again.
//! Where there is no tree of steps, the heaviest path is searched again, backwards over subsets.
//!
//! | what a claim has | how it is checked | cost |
//! | --- | --- | --- |
//! | a path and its cost | arc by arc, in 128 bits | n |
//! | a tree of steps | every bound, every decision, every branch recomputed | n² to n³ a bound |
//! | no tree | the heaviest path searched again, backwards over subsets | 2ⁿ n² |
//!
//! Costs and the path's own cost must be 0 or more for a tree, and stay below 2⁶⁰ when scaled; without a tree any
//! whole numbers will do whose sums fit 64 bits.

use super::heaviest_bound::Prices;
use super::heaviest_choices::{Chosen, IN, Layout, OPEN, OUT};
use super::heaviest_claim::{HeaviestClaim, NextClaim, StepClaim, TreeClaim};

/// Something about a claim that does not hold.
///
/// In the order of checking; the first of a tree ends its check.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PathFinding {
    /// The step, if it is about one.
    pub step: Option<usize>,
    /// What does not hold.
    pub what: String,
}

/// More points are not searched again: n·2^n numbers.
pub const MOST_SEARCHED_AGAIN: usize = 22;

/// All that does not hold; empty: the path is one of this cost, and none is heavier.
///
/// With a tree n² to n³ a step and probe; without one 2ⁿ n², up to [`MOST_SEARCHED_AGAIN`] points. Costs are whole, so
/// that "no heavier" is a bound below cost + 1.
///
/// Nothing panics on what a file may hold. Deterministic; exact integers throughout.
pub fn verify_heaviest(claim: &HeaviestClaim) -> Vec<PathFinding> {
    let mut findings = Vec::new();
    let mut find = |step: Option<usize>, what: String| findings.push(PathFinding { step, what });
    if let Err(what) = check_path(claim) {
        find(None, what);
        return findings;
    }
    match &claim.tree {
        None if claim.points > MOST_SEARCHED_AGAIN => find(None, format!("no proof, and {} points", claim.points)),
        None => {
            let most = search_again(claim);
            if most != Some(claim.cost) {
                find(None, format!("the heaviest path costs {most:?}, not {}", claim.cost));
            }
        }
        Some(tree) => {
            if let Err((step, what)) = check_tree(claim, tree) {
                find(step, what);
            }
        }
    }
    findings
}

/// Whether `path` leads from end to end, where they are fixed, over points less than `n`, to none of them twice.
///
/// # Errors
/// What is wrong with it, in words.
pub(super) fn loop_free(n: usize, [start, end]: [Option<usize>; 2], path: &[usize]) -> Result<(), String> {
    let (Some(first), Some(last)) = (path.first(), path.last()) else {
        return Err("the path has no point".into());
    };
    if start.is_some_and(|start| start != *first) || end.is_some_and(|end| end != *last) {
        return Err(format!("the path leads from {first} to {last}"));
    }
    let mut seen = vec![false; n];
    for point in path {
        match seen.get_mut(*point) {
            None => return Err(format!("point {point} of {n}")),
            Some(true) => return Err(format!("point {point} comes twice")),
            Some(seen) => *seen = true,
        }
    }
    Ok(())
}

/// Points, ends, arcs, and the sum of costs in 128 bits: errors in words.
fn check_path(claim: &HeaviestClaim) -> Result<(), String> {
    let n = claim.points;
    if n == 0 || claim.costs.len() != n * n {
        return Err(format!("{} costs for {n} points", claim.costs.len()));
    }
    loop_free(n, [claim.start, claim.end], &claim.path)?;
    let mut sum = 0i128;
    for leg in claim.path.windows(2) {
        let cost = claim.costs[leg[0] * n + leg[1]].ok_or_else(|| format!("no arc {}→{}", leg[0], leg[1]))?;
        sum += i128::from(cost);
    }
    if sum == i128::from(claim.cost) { Ok(()) } else { Err(format!("the path costs {sum}, not {}", claim.cost)) }
}

/// f(S, j): the heaviest way on from j when S has been met, from the full set downwards.
///
/// 2ⁿ n numbers: at most [`MOST_SEARCHED_AGAIN`] points. `None` where no path meets the ends.
///
/// ```text
/// f(S, j) = max( 0 if j may end,  max over k ∉ S of w(j, k) + f(S ∪ {k}, k) ),   answer max over starts s of f({s}, s)
/// ```
fn search_again(claim: &HeaviestClaim) -> Option<i64> {
    let n = claim.points;
    let full = (1usize << n) - 1;
    let mut on: Vec<Option<i64>> = vec![None; n << n];
    for met in (1..=full).rev() {
        for at in (0..n).filter(|at| met >> at & 1 == 1) {
            let ends = claim.end.is_none_or(|end| end == at).then_some(0);
            let nexts = (0..n).filter(|next| met >> next & 1 == 0);
            let ways = nexts.filter_map(|next| Some(claim.costs[at * n + next]? + on[(met | 1 << next) * n + next]?));
            on[met * n + at] = ways.max().max(ends);
        }
    }
    (0..n).filter(|start| claim.start.is_none_or(|fixed| fixed == *start)).filter_map(|s| on[(1 << s) * n + s]).max()
}

type Finding = (Option<usize>, String);

/// Goes through the tree with the choices made so far; each step ends closed, goes on as a later step that knows more,
/// or branches on one choice, out and in. Closed means: its bound is below cost + 1, in the tree's scale, or its
/// choices contradict each other. With costs · scale below 2⁶⁰ and multipliers up to 2⁶⁰ no sum in 128 bits is rounded
/// or wraps.
///
/// Steps must lead forwards and be met exactly once each, so that leaves cover the tree and nothing is proven by
/// itself.
fn check_tree(claim: &HeaviestClaim, tree: &TreeClaim) -> Result<(), Finding> {
    let n = claim.points;
    let arc = |from: usize, to: usize| claim.costs[from * n + to].filter(|_| from != to);
    let asymmetric = (0..n).any(|i| (0..i).any(|j| arc(i, j) != arc(j, i)));
    if asymmetric && !tree.directed {
        return Err((None, "costs depend on the direction, the tree does not".into()));
    }
    let small = |cost: &i64| cost.checked_mul(tree.scale).is_some_and(|scaled| (0..1 << 60).contains(&scaled));
    if tree.scale < 1 || !small(&claim.cost) || !claim.costs.iter().flatten().all(small) {
        return Err((None, format!("scale {} and these costs leave 60 bits", tree.scale)));
    }
    let layout = Layout { points: n, directed: tree.directed, costs: &claim.costs, scale: tree.scale };
    let mut visited = vec![false; tree.steps.len()];
    let mut open = vec![(0, Some(Chosen::new(&layout, claim.start, claim.end)))];
    while let Some((number, chosen)) = open.pop() {
        let wrong = |what: String| (Some(number), what);
        let step = tree.steps.get(number).ok_or_else(|| wrong("is missing".into()))?;
        if std::mem::replace(&mut visited[number], true) {
            return Err(wrong("comes twice".into()));
        }
        let left = match chosen {
            None => None,
            Some(chosen) => check_step(&layout, claim.cost, step, chosen).map_err(wrong)?,
        };
        match (left, step.next) {
            (_, NextClaim::Again(next)) if next <= number => return Err(wrong("goes back".into())),
            (None, NextClaim::Closed) => {}
            (Some(_), NextClaim::Closed) => return Err(wrong("is left open".into())),
            (left, NextClaim::Again(next)) => open.push((next, left)),
            (left, NextClaim::Branch { choice, out, into }) => {
                for (next, state) in [(out, OUT), (into, IN)] {
                    if next <= number {
                        return Err(wrong("goes back".into()));
                    }
                    let child = left.clone().and_then(|left| left.with(&layout, choice as usize, state));
                    open.push((next, child));
                }
                if choice as usize >= layout.len() {
                    return Err(wrong(format!("choice {choice} of {}", layout.len())));
                }
            }
        }
    }
    match visited.iter().position(|visited| !visited) {
        Some(number) => Err((Some(number), "belongs to nothing".into())),
        None => Ok(()),
    }
}

/// What a step leaves of a problem; `None` if nothing.
///
/// What a step claims to be decided must follow from the bound with the opposite choice.
fn check_step(layout: &Layout<'_>, cost: i64, step: &StepClaim, chosen: Chosen) -> Result<Option<Chosen>, String> {
    let prices = Prices::of(layout, step)?;
    let threshold = (i128::from(cost) + 1) * i128::from(layout.scale);
    let Some(mut chosen) = chosen.closed(layout) else { return Ok(None) };
    let below = |probe: Option<(usize, u8)>| {
        super::heaviest_bound::bound(layout, &chosen, &prices, probe).is_none_or(|bound| bound < threshold)
    };
    if below(None) {
        return Ok(None);
    }
    let sides = [(&step.out, OUT, IN), (&step.into, IN, OUT)];
    let mut must = Vec::new();
    for (choices, state, opposite) in sides {
        for choice in choices.iter().map(|choice| *choice as usize) {
            let now = *chosen.state.get(choice).ok_or_else(|| format!("choice {choice} of {}", layout.len()))?;
            if now == state {
                continue;
            }
            if now != OPEN || !below(Some((choice, opposite))) {
                return Err(format!("choice {choice} is not decided by the bound"));
            }
            must.push((choice, state));
        }
    }
    must.into_iter().for_each(|(choice, state)| chosen.state[choice] = state);
    Ok(chosen.closed(layout))
}
