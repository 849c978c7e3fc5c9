//! The proof that no path is heavier where moves may pass a point: searched again, forwards over the points that were
//! met.
//!
//! Shares nothing with the search, which goes backwards, ranks whole orders of points and cuts them afterwards: here a
//! state is what was met and where the last move ended, and every move, straight or through a point, is handed on from
//! there.

use super::heaviest::loop_free;

/// A path and what it is held against.
///
/// The path's own cost is added up from its moves, arcs and triples, as `passed` cuts it.
///
/// `passed` in the order of the path; a triple's middle is the point passed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TriplesClaim {
    /// Number of points.
    pub points: usize,
    /// Costs in rows, from → to; `None` without an arc.
    pub costs: Vec<Option<i64>>,
    /// \[from, via, to\] with their costs, ≥ 0.
    pub triples: Vec<([usize; 3], i64)>,
    /// First point, if fixed.
    pub start: Option<usize>,
    /// Last point, if fixed.
    pub end: Option<usize>,
    /// All points of the path in their order.
    pub path: Vec<usize>,
    /// Those of them that are passed on the way.
    pub passed: Vec<usize>,
    /// What the path costs.
    pub cost: i64,
}

/// More points are not searched again: n·2ⁿ numbers.
pub const MOST_TRIPLES_AGAIN: usize = 20;

/// All that does not hold; empty: the path is one of this cost, and none is heavier.
///
/// Findings in words, the first one only. 8 n 2ⁿ bytes: 168 MB at 20 points, the most that are searched again.
///
/// ```
/// use hairpin::verification::{TriplesClaim, verify_triples};
///
/// // Three points in a row: 1 + 1 straight, 5 in one move through the middle.
/// let costs = vec![None, Some(1), None, None, None, Some(1), None, None, None];
/// let (triples, start, end) = (vec![([0, 1, 2], 5)], None, None);
/// let (path, passed) = (vec![0, 1, 2], vec![1]);
/// let mut claim = TriplesClaim { points: 3, costs, triples, start, end, path, passed, cost: 5 };
/// assert!(verify_triples(&claim).is_empty());
/// (claim.passed, claim.cost) = (vec![], 2); // a path of that cost, but not the heaviest
/// assert!(!verify_triples(&claim).is_empty());
/// ```
pub fn verify_triples(claim: &TriplesClaim) -> Vec<String> {
    if let Err(what) = check_path(claim) {
        return vec![what];
    }
    if claim.points > MOST_TRIPLES_AGAIN {
        return vec![format!("{} points: at most {MOST_TRIPLES_AGAIN} are searched again", claim.points)];
    }
    let most = search_again(claim);
    if most == claim.cost { Vec::new() } else { vec![format!("the heaviest path costs {most}, not {}", claim.cost)] }
}

/// The path on its own: points and costs are some, no point comes twice, each move is an arc, or a triple where its
/// next point is one of those passed, every point said to be passed is, and the costs, summed in 128 bits, are the cost
/// claimed.
fn check_path(claim: &TriplesClaim) -> Result<(), String> {
    let n = claim.points;
    if n == 0 || claim.costs.len() != n * n {
        return Err(format!("{} costs for {n} points", claim.costs.len()));
    }
    if let Some((points, _)) = claim.triples.iter().find(|(points, cost)| *cost < 0 || points.iter().any(|p| *p >= n)) {
        return Err(format!("the arc {points:?} is none of {n} points, or costs less than 0"));
    }
    loop_free(n, [claim.start, claim.end], &claim.path)?;
    let (mut sum, mut at, mut met) = (0i128, 0, 0);
    while at + 1 < claim.path.len() {
        let (from, next) = (claim.path[at], claim.path[at + 1]);
        let (cost, step) = if claim.passed.contains(&next) {
            let to = *claim.path.get(at + 2).ok_or_else(|| format!("the path ends at {next}, which it passes"))?;
            let known = claim.triples.iter().find(|(points, _)| *points == [from, next, to]);
            met += 1;
            (known.ok_or_else(|| format!("no arc {from}→{next}→{to}"))?.1, 2)
        } else {
            (claim.costs[from * n + next].ok_or_else(|| format!("no move {from}→{next}"))?, 1)
        };
        sum += i128::from(cost);
        at += step;
    }
    if met != claim.passed.len() {
        return Err(format!("{} points are passed, not {}", met, claim.passed.len()));
    }
    if sum == i128::from(claim.cost) { Ok(()) } else { Err(format!("the path costs {sum}, not {}", claim.cost)) }
}

/// The most that a path costs; below 0 where there is none.
///
/// Held and Karp's recursion over subsets (1962), forwards: for each set of points met and the point where the last
/// move ended, the most that leads there; a triple adds two points at once. O(2ⁿ n (n + triples a point)) time and 8 n
/// 2ⁿ bytes.
fn search_again(claim: &TriplesClaim) -> i64 {
    const NOTHING: i64 = -1;
    let n = claim.points;
    let mut of_start: Vec<Vec<(usize, usize, i64)>> = vec![Vec::new(); n];
    for ([from, via, to], cost) in &claim.triples {
        of_start[*from].push((*via, *to, *cost));
    }
    let mut reached = vec![NOTHING; n << n];
    for start in (0..n).filter(|point| claim.start.is_none_or(|start| start == *point)) {
        reached[(1 << start) * n + start] = 0;
    }
    let mut most = NOTHING;
    for met in 1..1usize << n {
        for at in 0..n {
            let so_far = reached[met * n + at];
            if so_far == NOTHING {
                continue;
            }
            if claim.end.is_none_or(|end| end == at) {
                most = most.max(so_far);
            }
            let mut hand = |points: usize, to: usize, cost: i64| {
                if met & points == 0 {
                    let state = &mut reached[(met | points) * n + to];
                    *state = (*state).max(so_far + cost);
                }
            };
            for to in (0..n).filter(|to| *to != at) {
                if let Some(cost) = claim.costs[at * n + to] {
                    hand(1 << to, to, cost);
                }
            }
            for (via, to, cost) in &of_start[at] {
                hand(1 << via | 1 << to, *to, *cost);
            }
        }
    }
    most
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    /// Four points in a row of arcs worth 1 each, and an arc 0→1→2 worth 5.
    fn claim() -> TriplesClaim {
        let mut costs = vec![None; 16];
        (0..3).for_each(|from| costs[from * 4 + from + 1] = Some(1));
        TriplesClaim {
            points: 4,
            costs,
            triples: vec![([0, 1, 2], 5)],
            start: None,
            end: None,
            path: vec![0, 1, 2, 3],
            passed: vec![1],
            cost: 6,
        }
    }

    #[test]
    fn only_the_heaviest_path_of_its_own_cost_holds() {
        assert_eq!(verify_triples(&claim()), [""; 0]);
        let wrong = |change: fn(&mut TriplesClaim)| {
            let mut claim = claim();
            change(&mut claim);
            verify_triples(&claim).join("; ")
        };
        assert!(wrong(|claim| claim.cost = 7).contains("costs 6, not 7"));
        assert!(wrong(|claim| claim.passed = vec![]).contains("costs 3, not 6"));
        assert!(wrong(|claim| claim.passed = vec![2]).contains("no arc 1→2→3"));
        assert!(wrong(|claim| claim.passed = vec![1, 9]).contains("1 points are passed, not 2"));
        assert!(wrong(|claim| (claim.path, claim.passed, claim.cost) = (vec![1, 2, 3], vec![], 2)).contains("costs 6"));
        assert!(wrong(|claim| claim.triples.push(([1, 2, 3], 9))).contains("costs 10"));
        assert!(wrong(|claim| claim.path = vec![0, 1, 2, 1]).contains("comes twice"));
        assert!(wrong(|claim| claim.end = Some(2)).contains("leads from 0 to 3"));
        assert!(wrong(|claim| claim.triples[0].0 = [0, 1, 7]).contains("none of 4 points"));
    }
}
