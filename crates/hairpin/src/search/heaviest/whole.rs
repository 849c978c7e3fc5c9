//! The whole table of a symmetric problem, looked at without a list of its arcs.
//!
//! Of thousands of points the arcs are millions, of which steps of the multipliers need a few for each point: they go
//! along those, and the whole is asked now and then for its bound, for the arcs that the few lack, and in the end for
//! those that may be in a heavier path.
//!
//! The heaviest tree of the whole is that of its own arcs: Prim's algorithm finds them in O(n²), and [`Forest`] bounds
//! them alone.

use super::choices::{Arc, Choices, Made, OUT};
use super::forest::Forest;
use super::problem::{Arcs, Ends, NONE};
use super::relaxation::Relaxation;

/// The whole at some multipliers.
pub(super) struct Whole<'a> {
    arcs: &'a Arcs,
    scale: i64,
    multipliers: &'a [i64],
    tree: Vec<Arc>,
    forest: Forest<i128>,
    /// No path costs more, scaled.
    pub(super) bound: i64,
}

impl<'a> Whole<'a> {
    /// O(n²). `None` if no end is left.
    pub(super) fn at(arcs: &'a Arcs, ends: Ends, scale: i64, multipliers: &'a [i64]) -> Option<Self> {
        let tree = heaviest_tree(arcs, ends, scale, multipliers);
        let few = Choices::new(arcs.points(), false, tree.clone());
        // What follows from few arcs does not follow from all.
        let mut made = Made::nothing(&few);
        for point in 0..arcs.points() {
            for (id, may) in [(few.start(point), ends.may_start(point)), (few.end(point), ends.may_end(point))] {
                if !may {
                    made.choose(&few, id, OUT)?;
                }
            }
        }
        let mut forest = Forest::new(&few);
        let bound = forest.solve(&few, &made, multipliers, true)?;
        Some(Self { arcs, scale, multipliers, tree, forest, bound })
    }

    /// The arcs of the heaviest tree.
    pub(super) fn tree(&self) -> &[Arc] {
        &self.tree
    }

    /// Calls `arc(arc, stays)` for each arc: whether it may be in a path whose scaled cost is `threshold`. O(n² log n).
    pub(super) fn each(&self, threshold: i64, mut arc: impl FnMut(Arc, bool)) {
        let n = self.arcs.points();
        for from in 0..n {
            for to in (from + 1..n).filter(|to| self.arcs.raw(from, *to) != NONE) {
                let cost = self.arcs.raw(from, to) * self.scale;
                let weight = cost - self.multipliers[from] - self.multipliers[to];
                let (from, to) = (from as u32, to as u32);
                let with = self.bound - self.forest.narrowest(from, to) + weight;
                arc(Arc { from, to, cost }, with >= threshold);
            }
        }
    }
}

/// The arcs of the heaviest spanning tree of points and dummy (`forest`), which begins at the dummy.
fn heaviest_tree(arcs: &Arcs, ends: Ends, scale: i64, multipliers: &[i64]) -> Vec<Arc> {
    const INSIDE: u32 = u32::MAX;
    let n = arcs.points();
    let hung = |point: usize| {
        let start = if ends.may_start(point) { -multipliers[point] - multipliers[n] } else { i64::MIN };
        start.max(-2 * multipliers[point])
    };
    let mut reach: Vec<(i64, u32)> = (0..n).map(|point| (hung(point), n as u32)).collect();
    let mut tree = Vec::with_capacity(n);
    for _ in 0..n {
        let open = (0..n).filter(|point| reach[*point].1 != INSIDE);
        let Some(next) = open.max_by_key(|point| reach[*point].0) else { break };
        let by = reach[next].1 as usize;
        if by < n {
            let (from, to) = (by.min(next), by.max(next));
            tree.push(Arc { from: from as u32, to: to as u32, cost: arcs.raw(from, to) * scale });
        }
        reach[next].1 = INSIDE;
        for (to, reach) in reach.iter_mut().enumerate() {
            let cost = arcs.raw(next, to);
            if cost != NONE && reach.1 != INSIDE {
                let weight = cost * scale - multipliers[next] - multipliers[to];
                if weight > reach.0 {
                    *reach = (weight, next as u32);
                }
            }
        }
    }
    tree
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::super::workspace::Workspace;
    use super::*;

    /// Against the bounds with all arcs in the list, and with each arc in.
    #[test]
    fn the_whole_is_bounded_as_its_list_of_arcs_is() {
        for (seed, ends) in
            [(1, Ends::default()), (2, Ends { start: Some(3), end: None }), (3, Ends { start: Some(0), end: Some(5) })]
        {
            let workspace = Workspace::PUBLISHED;
            let arcs = workspace.arcs(&workspace.points(20, seed)).unwrap();
            let scale = 16;
            let multipliers: Vec<i64> = (0..21).map(|i| (i * 7919 * seed as i64) % 1_000_003 * scale - scale).collect();
            let all = Choices::all(&arcs, scale);
            let mut made = Made::nothing(&all);
            for point in 0..20 {
                if !ends.may_start(point) {
                    made.choose(&all, all.start(point), OUT).unwrap();
                }
                if !ends.may_end(point) {
                    made.choose(&all, all.end(point), OUT).unwrap();
                }
            }
            let bound = |made: &Made| Forest::<i128>::new(&all).solve(&all, made, &multipliers, true);
            let whole = Whole::at(&arcs, ends, scale, &multipliers).unwrap();
            assert_eq!(Some(whole.bound), bound(&made), "seed {seed}");
            let threshold = whole.bound - 300_000 * scale;
            let (mut id, mut out) = (0, 0);
            whole.each(threshold, |arc, stays| {
                assert_eq!((arc.from, arc.to), (all.arcs[id].from, all.arcs[id].to));
                let mut with = made.clone();
                with.choose(&all, id, super::super::choices::IN).unwrap();
                assert_eq!(stays, bound(&with).unwrap() >= threshold, "seed {seed}: {}→{}", arc.from, arc.to);
                (id, out) = (id + 1, out + usize::from(!stays));
            });
            assert!(id == all.arcs.len() && out > 0 && out < id, "seed {seed}: {out} of {id}");
        }
    }
}
