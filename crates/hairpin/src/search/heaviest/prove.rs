//! From the root to the proof: guesses of the heaviest cost, and splits where they do not come true.
//!
//! The bound of the root is mostly a few millionths above the heaviest path, local search some ten-thousandths below
//! it. So a cost is guessed close to the bound, and only paths that reach it are searched: that decides nearly all
//! choices at once. All that is closed on the way has no path of the guessed cost, and so none above one that has it:
//! a path that is found is proven the heaviest. Where none is, the bound is less than the guess, and the next one is
//! lower.

use super::branch::{Ground, Open, Searched, branch};
use super::problem::Arcs;
use super::question::{HeaviestSettings, Method};
use super::record::{Next, Recorder};
use super::relaxation::Relaxation;
use super::root::Root;

/// Guesses: the bound, less one part of so many of what lies between it and the best path.
const PARTS: [i64; 5] = [32, 16, 8, 4, 2];
/// Problems that each part of branch and bound looks at under a guess.
const GUESSED_NODES: u64 = 32;

/// What came of guesses.
enum Guessed {
    /// A path, and that none is heavier.
    Proven(Searched),
    /// A heavier path than before.
    Better,
    /// No path; maybe a smaller bound.
    Nothing,
}

/// A search on its way.
struct Proving<'a, R> {
    root: Root<'a, R>,
    /// No path costs more, scaled, as guesses have shown. The root's own bound says how far its multipliers are.
    most: i64,
    most_nodes: u64,
    /// Problems looked at.
    nodes: u64,
    stop: &'a (dyn Fn() -> bool + Sync),
}

/// Proves the heaviest path, or comes as far as it may; `path` meets the ends. The second value is the upper bound,
/// scaled.
///
/// Guesses; else the root's kicks, steps and cuts, and guesses again; else branching, begun again from the root
/// whenever the first splits find a heavier path, which decides more before any split. `nodes` counts all of it.
pub(super) fn prove<'a, R: Relaxation>(
    arcs: &'a Arcs,
    settings: &HeaviestSettings,
    path: &[usize],
    record: Recorder,
    stop: &'a (dyn Fn() -> bool + Sync),
) -> (Searched, i64, Recorder) {
    let root = Root::<R>::new(arcs, settings, path, record, stop);
    let most_nodes = settings.most_nodes.unwrap_or(u64::MAX);
    let mut proving = Proving { root, most: i64::MAX, most_nodes, nodes: 0, stop };
    let Some(mut closed) = proving.root.widen() else { return proving.at_the_root(false) };
    // Branching with a path that is not the heaviest costs many times what kicks cost.
    let points = arcs.points() as u64;
    let mut kicks = settings.kicks.unwrap_or(points * (1 + points / 60));
    let guesses = settings.method != Method::Local && settings.programs <= 1;
    let mut settled = false;
    while !closed {
        match if guesses { proving.guess() } else { Guessed::Nothing } {
            Guessed::Proven(searched) => return proving.end(searched),
            // Its path is better than what kicks find.
            Guessed::Better => kicks = 0,
            Guessed::Nothing if settled => break,
            Guessed::Nothing => {}
        }
        closed = proving.root.settle(kicks);
        settled = true;
    }
    if closed || settings.method == Method::Local {
        return proving.at_the_root(closed);
    }
    loop {
        let searched = proving.split(most_nodes);
        if !searched.again || stop() {
            return proving.follow(searched);
        }
        // A heavier path decides more before anything is split: what was split with the lighter one is forgotten.
        proving.root.record.forget(searched.first);
        proving.root.learn(searched.best);
        if proving.root.settle(kicks) {
            return proving.at_the_root(true);
        }
    }
}

impl<R: Relaxation> Proving<'_, R> {
    /// What is known without splits, proven if nothing is left.
    fn at_the_root(self, closed: bool) -> (Searched, i64, Recorder) {
        let searched = self.unsplit((!closed).then_some(self.root.bound));
        self.end(searched)
    }

    fn unsplit(&self, open: Option<i64>) -> Searched {
        Searched { best: self.root.best.clone(), open, nodes: 0, first: 0, again: false }
    }

    /// With the steps of a search hung on those of the root.
    fn follow(mut self, searched: Searched) -> (Searched, i64, Recorder) {
        self.root.record.follow(self.root.step, Next::Again(searched.first));
        self.end(searched)
    }

    fn end(self, searched: Searched) -> (Searched, i64, Recorder) {
        (Searched { nodes: self.nodes, ..searched }, self.root.bound.min(self.most), self.root.record)
    }

    /// Splits what the root left.
    fn split(&mut self, most_nodes: u64) -> Searched {
        let root = &mut self.root;
        let gap = (root.bound - root.best.aim() * root.scale).max(0) as f64;
        let ground =
            Ground { arcs: root.arcs, choices: &root.choices, scale: root.scale, gap, most_nodes, stop: self.stop };
        let problem = Open::new(root.made.clone(), root.multipliers.clone(), root.bound);
        let searched = branch::<R>(ground, problem, root.best.clone(), &mut root.record);
        self.nodes += searched.nodes;
        searched
    }

    /// Guesses in turn, until one comes true or is too much work.
    fn guess(&mut self) -> Guessed {
        for parts in PARTS {
            let bound = self.root.bound.min(self.most) / self.root.scale;
            let least = bound - (bound - self.root.best.cost()) / parts;
            if least <= self.root.best.needed() || (self.stop)() {
                break;
            }
            match self.search_from(least) {
                Some(Guessed::Nothing) => {}
                Some(guessed) => return guessed,
                None => break,
            }
        }
        Guessed::Nothing
    }

    /// Searches paths that cost `least` or more; `None` if that was given up without one. The root is then as it was,
    /// with a heavier path or a smaller bound.
    ///
    /// Where much is left open under the guess splits are not even begun, as they would be many.
    fn search_from(&mut self, least: i64) -> Option<Guessed> {
        let (kept, closed) = self.root.want(least);
        let searched = match closed {
            true => self.unsplit(None),
            false if self.root.many_open() => self.unsplit(Some(self.root.bound)),
            false => {
                let searched = self.split(self.most_nodes.min(GUESSED_NODES));
                self.root.record.follow(self.root.step, Next::Again(searched.first));
                searched
            }
        };
        let (found, complete) = (searched.best.cost() >= least, searched.open.is_none() && !searched.again);
        if found && complete {
            return Some(Guessed::Proven(searched));
        }
        self.root.go_back(kept);
        if complete {
            self.most = self.most.min((least - 1) * self.root.scale);
        }
        self.root.learn(searched.best);
        match (found, complete) {
            (true, _) => Some(Guessed::Better),
            (false, true) => Some(Guessed::Nothing),
            (false, false) => None,
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::super::forest::Forest;
    use super::super::workspace::Workspace;
    use super::*;

    /// One too high lowers the bound below it and changes nothing else; one that is true is proven.
    #[test]
    fn guesses_are_searched_to_their_end() {
        let mut searched_to_the_end = 0;
        for seed in 0..10 {
            let arcs = Workspace::PUBLISHED.arcs(&Workspace::PUBLISHED.points(50, seed)).unwrap();
            let settings = HeaviestSettings { proof: true, ..Default::default() };
            let (proven, ..) = prove::<Forest<i64>>(&arcs, &settings, &[0], Recorder::new(false), &|| false);
            assert_eq!(proven.open, None, "seed {seed}");
            let heaviest = proven.best.cost();
            let root = Root::<Forest<i64>>::new(&arcs, &settings, &[0], Recorder::new(true), &|| false);
            let mut proving = Proving { root, most: i64::MAX, most_nodes: u64::MAX, nodes: 0, stop: &|| false };
            if proving.root.widen() == Some(true) {
                continue;
            }
            searched_to_the_end += 1;
            let before = |proving: &Proving<'_, Forest<i64>>| {
                let root = &proving.root;
                (root.choices.arcs.len(), root.multipliers.clone(), root.step, root.record.steps.len())
            };
            let (was, scale) = (before(&proving), proving.root.scale);
            assert!(matches!(proving.search_from(heaviest + 1), Some(Guessed::Nothing)), "seed {seed}");
            assert_eq!(before(&proving), was, "seed {seed}");
            assert_eq!(proving.most, heaviest * scale, "seed {seed}");
            assert!(proving.root.best.needed() <= heaviest, "seed {seed}");
            match proving.search_from(heaviest) {
                Some(Guessed::Proven(searched)) => assert_eq!(searched.best.cost(), heaviest, "seed {seed}"),
                // Found before the splits were shared out, as one of a search that is to begin again.
                Some(Guessed::Better) => assert_eq!(proving.root.best.cost(), heaviest, "seed {seed}"),
                _ => panic!("seed {seed}: no path of the heaviest cost"),
            }
        }
        assert!(searched_to_the_end > 5, "{searched_to_the_end} questions were not closed before");
    }
}
