//! Depth-first search over all paths: the published baseline ("revised DFS"), for comparison only.
//!
//! Collet, Gotlieb, Lazaar and Mossige, *Stress testing of single-arm robots through constraint-based generation of
//! continuous trajectories*, 2019: backtracking, cutting branches whose cost cannot exceed that of the best path; what
//! can still come is bounded by the points left times the largest cost.

use super::problem::{Arcs, Ends, NONE};

/// The heaviest path, and whether the search came to its end; `path` is where it begins.
///
/// O(n!) at worst. The cut is cost + (points left) · (largest cost) > best. `stop` is asked every 4096 extensions; then
/// the path is the best so far.
pub(super) fn depth_first(
    arcs: &Arcs,
    ends: Ends,
    path: Vec<usize>,
    stop: &(dyn Fn() -> bool + Sync),
) -> (Vec<usize>, bool) {
    let n = arcs.points();
    let mut best = (arcs.total(&path).unwrap_or(0), path);
    let mut looked = 0u64;
    for start in (0..n).filter(|start| ends.may_start(*start)) {
        let (mut walk, mut cost) = (vec![start], 0);
        let mut on_path = vec![false; n];
        on_path[start] = true;
        // For each point of the walk: the next follower to try.
        let mut tries = vec![0];
        while let Some(follower) = tries.last_mut() {
            let at = walk[walk.len() - 1];
            let (to, left) = (*follower, (n - walk.len()) as i64);
            *follower += 1;
            if to < n && cost + left * arcs.largest() > best.0 {
                if on_path[to] || arcs.raw(at, to) == NONE {
                    continue;
                }
                cost += arcs.raw(at, to);
                walk.push(to);
                tries.push(0);
                on_path[to] = true;
                if cost > best.0 && ends.may_end(to) {
                    best = (cost, walk.clone());
                }
                looked += 1;
                if looked.is_multiple_of(4096) && stop() {
                    return (best.1, false);
                }
                continue;
            }
            tries.pop();
            walk.pop();
            on_path[at] = false;
            if let Some(before) = walk.last() {
                cost -= arcs.raw(*before, at);
            }
        }
    }
    (best.1, true)
}
