//! The heaviest path in which points may come several times and no arc twice: branch and bound on circulations.
//!
//! A path is a circulation through the dummy that hangs together. Where the heaviest circulation does not, let C be the
//! points of a part without the dummy: every path either leaves C out altogether, or uses an arc that leads out of C.
//! So C is taken out in one branch, and in one branch each the first, second, … of those arcs is in, with those before
//! it out. That ends, for every branch decides one arc more.

use std::collections::BinaryHeap;

use super::circulation::{Net, State};
use super::problem::{Arcs, Ends};

/// From and to; the dummy is the number of points.
pub(super) type Arrow = (usize, usize);

/// One look at a problem: prices whose bound closes it, or what follows.
///
/// Checked by the formula of `circulation`: a sum over arcs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WalkStep {
    /// Prices of rows, then of columns; the dummy's are the last of both.
    pub prices: Vec<i64>,
    /// Nothing follows where the bound is too small.
    pub split: Option<Split>,
}

/// The branches about points that do not hang together with the rest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Split {
    /// The points.
    pub points: Vec<usize>,
    /// The step without them; `None` where an arc at one of them is in.
    pub without: Option<usize>,
    /// Arcs that lead out of them, to the dummy (number n) where the path may end: each with the step in which it is in
    /// and those before it are out.
    pub ways: Vec<(usize, usize, usize)>,
}

/// A proof that no path is heavier than the best: steps from number 0.
///
/// [`crate::verification::verify_walk`] recomputes each bound and that the ways out of a part are all there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WalkProof {
    /// How often a point may come.
    pub visits: usize,
    /// The tree.
    pub steps: Vec<WalkStep>,
}

/// What came of a search.
///
/// The heaviest path above the floor, and what is known beyond it.
pub(super) struct Walks {
    /// Cost and points in order; `None` where none was heavier than the floor.
    pub(super) best: Option<(i64, Vec<usize>)>,
    /// No path of the region costs more.
    pub(super) bound: i64,
    /// Whether the search came to its end.
    pub(super) proven: bool,
    /// Circulations solved.
    pub(super) nodes: u64,
    /// The proof, if it was to be kept.
    pub(super) steps: Vec<WalkStep>,
}

/// Which circulations are looked at: arcs that must be used, and arcs that must not.
#[derive(Debug, Clone, Default)]
pub(super) struct Region {
    /// Arcs that must be used.
    pub(super) within: Vec<Arrow>,
    /// Arcs that must not be used.
    pub(super) without: Vec<Arrow>,
}

/// How a search goes.
pub(super) struct Search<'a> {
    pub(super) arcs: &'a Arcs,
    pub(super) ends: Ends,
    /// Times that a point may come, at most.
    pub(super) visits: usize,
    /// Paths must be heavier.
    pub(super) above: i64,
    /// Circulations solved at most.
    pub(super) most_nodes: Option<u64>,
    /// Whether steps are kept for a proof.
    pub(super) keep: bool,
    pub(super) stop: &'a (dyn Fn() -> bool + Sync),
}

/// A branch that waits: its bound is at most its parent's.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Waiting {
    bound: i64,
    /// Later ones first: they have decided more.
    number: usize,
}

struct Branch {
    parent: usize,
    /// Which of the parent's ways is in; `None`: the points are out.
    way: Option<usize>,
    /// What its own split is, once it was looked at.
    points: Vec<usize>,
    ways: Vec<Arrow>,
    step: usize,
}

impl Search<'_> {
    /// Best first: the open branch of the greatest bound is split, or closed by its parent's prices where its bound is
    /// no more than the best path found (or the weight it has to be above). What stays open when stopped is the bound
    /// of the answer.
    ///
    /// A circulation is O(n³ K) and a look at a problem costs one; problems are copies of the net, n² each.
    pub(super) fn run(&self, region: &Region) -> Walks {
        let mut net = Net::new(self.arcs, self.ends, self.visits as i64);
        region.within.iter().for_each(|arc| net.decide(*arc, State::In));
        region.without.iter().for_each(|arc| net.decide(*arc, State::Out));
        let mut found = Walks { best: None, bound: self.above, proven: true, nodes: 0, steps: Vec::new() };
        let mut floor = self.above;
        let mut branches = vec![Branch { parent: 0, way: None, points: Vec::new(), ways: Vec::new(), step: 0 }];
        let mut open = BinaryHeap::from([Waiting { bound: i64::MAX, number: 0 }]);
        while let Some(Waiting { bound, number }) = open.pop() {
            let parent = branches[number].parent;
            if bound <= floor {
                // The parent's prices bound this one too.
                let prices = if self.keep { found.steps[branches[parent].step].prices.clone() } else { Vec::new() };
                self.step(&mut found, &mut branches, number, prices);
                continue;
            }
            if (self.stop)() || self.most_nodes.is_some_and(|most| found.nodes >= most) {
                found.proven = false;
                found.bound = bound;
                break;
            }
            let problem = decided(&net, &branches, number);
            let circulation = problem.heaviest();
            found.nodes += 1;
            let bound = i64::try_from(problem.bound(&circulation.prices)).unwrap_or(i64::MAX);
            self.step(&mut found, &mut branches, number, circulation.prices);
            let Some(used) = circulation.arcs.filter(|_| bound > floor) else { continue };
            if let Some((cost, path)) = joined(&net, &used).filter(|(cost, _)| *cost > floor) {
                floor = cost;
                found.best = Some((cost, path));
            }
            if bound <= floor {
                continue;
            }
            let Some(points) = apart(&problem, &used) else { continue };
            let ways = ways_out(&problem, &points);
            let without = (!met(&problem, &points)).then_some(None);
            for way in without.into_iter().chain((0..ways.len()).map(Some)) {
                open.push(Waiting { bound, number: branches.len() });
                branches.push(Branch { parent: number, way, points: Vec::new(), ways: Vec::new(), step: 0 });
            }
            (branches[number].points, branches[number].ways) = (points, ways);
        }
        if found.proven {
            found.bound = floor;
        }
        if self.keep && found.proven {
            splits(&mut found.steps, &branches);
        }
        found
    }

    /// Notes the prices of a branch as the next step of the proof.
    fn step(&self, found: &mut Walks, branches: &mut [Branch], number: usize, prices: Vec<i64>) {
        branches[number].step = found.steps.len();
        if self.keep {
            found.steps.push(WalkStep { prices, split: None });
        }
    }
}

/// The net with all that leads to branch `number` decided.
fn decided(net: &Net, branches: &[Branch], number: usize) -> Net {
    let mut problem = net.clone();
    let mut at = number;
    while at != 0 {
        let (parent, way) = (&branches[branches[at].parent], branches[at].way);
        match way {
            None => {
                for point in &parent.points {
                    for other in 0..problem.nodes {
                        for arc in [(*point, other), (other, *point)] {
                            problem.decide(arc, State::Out);
                        }
                    }
                }
            }
            Some(way) => {
                parent.ways[..way].iter().for_each(|arc| problem.decide(*arc, State::Out));
                problem.decide(parent.ways[way], State::In);
            }
        }
        at = branches[at].parent;
    }
    problem
}

/// Writes what follows into the steps.
fn splits(steps: &mut [WalkStep], branches: &[Branch]) {
    for branch in branches.iter().filter(|branch| !branch.points.is_empty()) {
        let ways = branch.ways.iter().map(|(from, to)| (*from, *to, 0)).collect();
        steps[branch.step].split = Some(Split { points: branch.points.clone(), without: None, ways });
    }
    for branch in branches.iter().skip(1) {
        let Some(split) = &mut steps[branches[branch.parent].step].split else { continue };
        match branch.way {
            None => split.without = Some(branch.step),
            Some(way) => split.ways[way].2 = branch.step,
        }
    }
}

/// Whether an arc at one of the points is in.
fn met(net: &Net, points: &[usize]) -> bool {
    let ends = |point: usize| (0..net.nodes).flat_map(move |other| [(point, other), (other, point)]);
    points.iter().any(|point| ends(*point).any(|arc| net.state(arc) == State::In))
}

/// Arcs that lead out of `points` and are not out, the heaviest first. None is in: the circulation would use it.
fn ways_out(net: &Net, points: &[usize]) -> Vec<Arrow> {
    let others = (0..net.nodes).filter(|to| !points.contains(to));
    let all = others.flat_map(|to| points.iter().map(move |from| (*from, to)));
    let mut ways: Vec<Arrow> = all.filter(|arc| net.state(*arc) == State::Open).collect();
    ways.sort_unstable_by_key(|arc| (-net.cost(*arc), *arc));
    ways
}

/// The parts that arcs make of the nodes they touch: for each node the least node of its part.
fn components(nodes: usize, used: &[Arrow]) -> Vec<usize> {
    let mut part: Vec<usize> = (0..nodes).collect();
    let root = |part: &[usize], mut at: usize| {
        while part[at] != at {
            at = part[at];
        }
        at
    };
    for (from, to) in used {
        let (a, b) = (root(&part, *from), root(&part, *to));
        part[a.max(b)] = a.min(b);
    }
    (0..nodes).map(|node| root(&part, node)).collect()
}

/// The smallest part without the dummy.
///
/// `None` where all arcs hang together with the dummy: the circulation is a path.
fn apart(net: &Net, used: &[Arrow]) -> Option<Vec<usize>> {
    let part = components(net.nodes, used);
    let of = |root: usize| (0..net.nodes).filter(|node| part[*node] == root).collect::<Vec<_>>();
    let others: Vec<usize> =
        used.iter().map(|(from, _)| part[*from]).filter(|root| *root != part[net.dummy()]).collect();
    others.into_iter().map(of).min_by_key(|points| (points.len(), points[0]))
}

/// A path from a circulation: parts are joined to the dummy's where that costs least, and left out where nothing joins
/// them. `None` where what must be used would be left out.
///
/// One exchange after another, the one of greatest gain first: an arc of each part crosswise, or an arc for a way by a
/// point with visits left.
fn joined(net: &Net, used: &[Arrow]) -> Option<(i64, Vec<usize>)> {
    let mut used = used.to_vec();
    loop {
        let part = components(net.nodes, &used);
        let own = part[net.dummy()];
        let (main, rest): (Vec<_>, Vec<_>) = used.iter().copied().partition(|(from, _)| part[*from] == own);
        if rest.is_empty() {
            break;
        }
        let visits = |node: usize| used.iter().filter(|(_, to)| *to == node).count() as i64;
        let room: Vec<bool> = (0..net.nodes).map(|node| node != net.dummy() && visits(node) < net.visits).collect();
        let may = |arc: Arrow| net.state(arc) == State::Open;
        // Gain, arcs that go, arcs that come.
        let mut best: Option<(i64, [Arrow; 2], [Arrow; 2])> = None;
        let mut offer = |gain: i64, drop: [Arrow; 2], add: [Arrow; 2]| {
            if best.as_ref().is_none_or(|(most, ..)| gain > *most) {
                best = Some((gain, drop, add));
            }
        };
        for &(c, d) in rest.iter().filter(|arc| may(**arc)) {
            for &(a, b) in main.iter().filter(|arc| may(**arc)) {
                if may((a, d)) && may((c, b)) {
                    let gain = net.cost((a, d)) + net.cost((c, b)) - net.cost((a, b)) - net.cost((c, d));
                    offer(gain, [(a, b), (c, d)], [(a, d), (c, b)]);
                }
            }
            for v in (0..net.nodes).filter(|v| room[*v] && part[*v] == own && may((*v, d)) && may((c, *v))) {
                if main.iter().any(|(_, to)| *to == v) {
                    offer(net.cost((v, d)) + net.cost((c, v)) - net.cost((c, d)), [(c, d); 2], [(v, d), (c, v)]);
                }
            }
        }
        match best {
            Some((_, drop, add)) => {
                used.retain(|arc| !drop.contains(arc));
                used.extend(add);
            }
            None if rest.iter().all(|arc| may(*arc)) => used = main,
            None => return None,
        }
    }
    let cost = used.iter().map(|arc| net.cost(*arc)).sum();
    Some((cost, trail(net, &used)))
}

/// The points along all arcs, from the dummy to the dummy (Hierholzer 1873).
fn trail(net: &Net, used: &[Arrow]) -> Vec<usize> {
    let mut next: Vec<Vec<usize>> = vec![Vec::new(); net.nodes];
    for (from, to) in used.iter().rev() {
        next[*from].push(*to);
    }
    let (mut open, mut path) = (vec![net.dummy()], Vec::with_capacity(used.len() + 1));
    while let Some(at) = open.last().copied() {
        match next[at].pop() {
            Some(to) => open.push(to),
            None => path.extend(open.pop()),
        }
    }
    path.reverse();
    path[1..path.len() - 1].to_vec()
}
