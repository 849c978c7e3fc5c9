//! The bound of symmetric problems: a maximal spanning tree in which points that are left out hang on the dummy.
//!
//! L(λ) = Σᵢ 2λᵢ + λ_s + max over spanning trees T of Σ_T w + max over allowed ends t of −λ_t, with
//! w(i, j) = c(i, j) − λᵢ − λⱼ, w(start i) = −λᵢ − λ_s, w(loop i) = −2λᵢ. Starts and loops join a point to the dummy.
//! Any path with loops for what it leaves out is such a tree with an end, has two arcs at each point and one start, and
//! so costs no more than L(λ), whatever the signs of λ. Held & Karp 1970; Kruskal 1956.
//!
//! Replacing the tree's edge e by another one f changes L by w(f) − w(e). So a choice outside the tree is decided by
//! the smallest weight on the tree's way between its points, one inside by the largest that could stand for it; both
//! come out of Kruskal's joins.
//!
//! Kruskal's joins, in their order and each with the time it was made, are kept as a forest without path compression:
//! the smallest weight on the tree's way between two points is then the latest join on their two ways up, O(log n) by
//! union by size.

use super::choices::{Arc, Choice, Choices, IN, Made, OPEN, OUT};
use super::relaxation::{Relaxation, best_ends};

/// A weight and a choice in one number, ordered by weight.
///
/// Least first is heaviest first, ties by number, so that sorting integers sorts choices, and the same tree comes out
/// on every machine. 64 bits where weights and numbers fit into one word, else 128.
pub(super) trait Key: Copy + Ord + Send {
    /// From both.
    fn pack(weight: i64, id: u32) -> Self;
    /// The weight.
    fn weight(self) -> i64;
    /// The choice.
    fn id(self) -> u32;
}

/// Bits of the choice's number in a short key.
pub(super) const ID_BITS: u32 = 20;

impl Key for i64 {
    #[inline(always)]
    fn pack(weight: i64, id: u32) -> Self {
        -weight << ID_BITS | i64::from(id)
    }
    #[inline(always)]
    fn weight(self) -> i64 {
        -(self >> ID_BITS)
    }
    #[inline(always)]
    fn id(self) -> u32 {
        (self & ((1 << ID_BITS) - 1)) as u32
    }
}

impl Key for i128 {
    #[inline(always)]
    fn pack(weight: i64, id: u32) -> Self {
        -i128::from(weight) << 32 | i128::from(id)
    }
    #[inline(always)]
    fn weight(self) -> i64 {
        -(self >> 32) as i64
    }
    #[inline(always)]
    fn id(self) -> u32 {
        self as u32
    }
}

/// When a set was joined to another.
#[derive(Clone, Copy)]
struct Link {
    parent: u32,
    /// Order of the joins; roots come last.
    time: u32,
}

/// Kruskal's algorithm, and the joins that it made.
pub(super) struct Forest<K> {
    keys: Vec<K>,
    links: Vec<Link>,
    sizes: Vec<u32>,
    /// The joins of the choices that are made, where every run begins.
    begun: Vec<Link>,
    /// What priced cuts take from each choice.
    taken: Vec<i64>,
    /// The choices of each cut.
    in_cuts: Vec<Vec<u32>>,
    begun_sizes: Vec<u32>,
    begun_joins: u32,
    /// Weight and choice of each join.
    joins: Vec<(i64, u32)>,
    used: Vec<u32>,
    forced: Vec<u32>,
}

const ROOT: u32 = u32::MAX;
/// Weight of a join that is made already: no other stands for it.
const FORCED: i64 = i64::MAX / 4;

/// The points that a choice joins; the dummy is point number n. Ends join nothing.
///
/// Starts and loops of one point are parallel edges to the dummy: a tree takes the heavier.
fn joined(choices: &Choices, id: usize) -> Option<(u32, u32)> {
    let dummy = choices.points as u32;
    match choices.kind(id) {
        Choice::Arc(arc) => Some((choices.arcs[arc].from, choices.arcs[arc].to)),
        Choice::Start(point) | Choice::Loop(point) => Some((point as u32, dummy)),
        Choice::End(_) => None,
    }
}

/// w of the head of this file; multipliers are λ of the points, then λ_s.
fn weight(choices: &Choices, id: usize, multipliers: &[i64]) -> i64 {
    match choices.kind(id) {
        Choice::Arc(arc) => {
            let Arc { from, to, cost } = choices.arcs[arc];
            cost - multipliers[from as usize] - multipliers[to as usize]
        }
        Choice::Start(point) => -multipliers[point] - multipliers[choices.points],
        Choice::Loop(point) => -2 * multipliers[point],
        Choice::End(point) => -multipliers[point],
    }
}

/// The set's name; O(log n), as sets are joined by size.
///
/// Walks up without shortening the way: the order of joins along it is what [`Forest::narrowest`] reads.
#[inline(always)]
fn root(links: &[Link], mut point: u32) -> u32 {
    while links[point as usize].time != ROOT {
        point = links[point as usize].parent;
    }
    point
}

impl<K: Key> Forest<K> {
    /// Begins with the choices that are made; false if they close a circle.
    fn begin(&mut self, choices: &Choices, made: &Made) -> bool {
        for (point, link) in self.links.iter_mut().enumerate() {
            *link = Link { parent: point as u32, time: ROOT };
        }
        self.sizes.fill(1);
        self.joins.clear();
        self.forced.clear();
        self.keys.clear();
        for (id, state) in made.state.iter().enumerate() {
            match *state {
                IN => {
                    self.forced.push(id as u32);
                    if let Some((a, b)) = joined(choices, id)
                        && !self.join(a, b, FORCED, id as u32)
                    {
                        return false;
                    }
                }
                OPEN if joined(choices, id).is_some() => self.keys.push(K::pack(0, id as u32)),
                _ => {}
            }
        }
        self.begun.copy_from_slice(&self.links);
        self.begun_sizes.copy_from_slice(&self.sizes);
        self.begun_joins = self.joins.len() as u32;
        true
    }

    /// Joins the sets of two points; false where they are one already, and the edge would close a circle.
    #[inline(always)]
    fn join(&mut self, a: u32, b: u32, weight: i64, id: u32) -> bool {
        let (mut a, mut b) = (root(&self.links, a), root(&self.links, b));
        if a == b {
            return false;
        }
        if self.sizes[a as usize] < self.sizes[b as usize] {
            (a, b) = (b, a);
        }
        self.sizes[a as usize] += self.sizes[b as usize];
        self.links[b as usize] = Link { parent: a, time: self.joins.len() as u32 };
        self.joins.push((weight, id));
        true
    }

    /// The smallest weight on the tree's way between two points.
    ///
    /// The weight of the last join that connected them: joins come heaviest first. [`FORCED`] where only forced joins
    /// do. O(log n).
    pub(super) fn narrowest(&self, mut a: u32, mut b: u32) -> i64 {
        let mut last = 0;
        while a != b {
            let (one, other) = (self.links[a as usize], self.links[b as usize]);
            if one.time < other.time {
                (a, last) = (one.parent, one.time);
            } else {
                (b, last) = (other.parent, other.time);
            }
        }
        self.joins[last as usize].0
    }

    /// For each join that was free to be made: the largest weight that could stand for it.
    ///
    /// Tarjan's way to test minimal trees (1979), with paths halved: near O(m) for all of them. `None` where nothing
    /// else joins the two parts.
    ///
    /// Choices beside the tree come heaviest first; each covers the tree's edges on its way that none covered before,
    /// and is their best replacement. One entry a join, in the order of joins.
    fn replacements(&mut self, choices: &Choices) -> Vec<Option<i64>> {
        let n = choices.points + 1;
        // The tree as parents, from the dummy outwards.
        let mut around = vec![Vec::new(); n];
        for (number, (_, id)) in self.joins.iter().enumerate() {
            let (a, b) = joined(choices, *id as usize).expect("what was joined joins");
            around[a as usize].push((b, number));
            around[b as usize].push((a, number));
        }
        let (mut up, mut by, mut depth) = (vec![0u32; n], vec![0usize; n], vec![0u32; n]);
        let mut open = vec![(n - 1) as u32];
        let mut seen = vec![false; n];
        seen[n - 1] = true;
        while let Some(at) = open.pop() {
            for (next, number) in around[at as usize].iter().copied() {
                if !seen[next as usize] {
                    seen[next as usize] = true;
                    (up[next as usize], by[next as usize]) = (at, number);
                    depth[next as usize] = depth[at as usize] + 1;
                    open.push(next);
                }
            }
        }
        // The heaviest choice beside the tree that passes over a join stands for it; ways that are covered are skipped.
        let mut in_tree = vec![false; choices.len()];
        self.joins.iter().for_each(|(_, id)| in_tree[*id as usize] = true);
        let mut found = vec![None; self.joins.len()];
        let mut skip: Vec<u32> = (0..n as u32).collect();
        for key in self.keys.iter().filter(|key| !in_tree[key.id() as usize]) {
            let (a, b) = joined(choices, key.id() as usize).expect("only what joins has a key");
            let (mut a, mut b) = (top(&mut skip, a), top(&mut skip, b));
            while a != b {
                if depth[a as usize] < depth[b as usize] {
                    (a, b) = (b, a);
                }
                found[by[a as usize]] = Some(key.weight());
                skip[a as usize] = up[a as usize];
                a = top(&mut skip, up[a as usize]);
            }
        }
        found
    }
}

/// The first point on the way up whose edge is not covered yet.
fn top(skip: &mut [u32], mut point: u32) -> u32 {
    while skip[point as usize] != point {
        skip[point as usize] = skip[skip[point as usize] as usize];
        point = skip[point as usize];
    }
    point
}

impl<K: Key> Relaxation for Forest<K> {
    fn new(choices: &Choices) -> Self {
        let n = choices.points + 1;
        let none = Link { parent: 0, time: ROOT };
        Self {
            keys: Vec::new(),
            links: vec![none; n],
            sizes: vec![1; n],
            begun: vec![none; n],
            taken: vec![0; choices.len()],
            in_cuts: choices.cuts.iter().map(|cut| choices.counted(cut)).collect(),
            begun_sizes: vec![1; n],
            begun_joins: 0,
            joins: Vec::with_capacity(n),
            used: Vec::with_capacity(n + 1),
            forced: Vec::new(),
        }
    }

    /// Kruskal from the forced joins on. Keys are sorted anew with each λ, nearly in order from the last run; O(m log
    /// m) at worst, near O(m) where the order has hardly changed.
    fn solve(&mut self, choices: &Choices, made: &Made, multipliers: &[i64], renew: bool) -> Option<i64> {
        if renew && !self.begin(choices, made) {
            self.begun_joins = u32::MAX;
        }
        if self.begun_joins == u32::MAX {
            return None;
        }
        self.links.copy_from_slice(&self.begun);
        self.sizes.copy_from_slice(&self.begun_sizes);
        self.joins.truncate(self.begun_joins as usize);
        let n = choices.points;
        let mut bound = multipliers[n] + 2 * multipliers[..n].iter().sum::<i64>();
        if !self.in_cuts.is_empty() {
            self.taken.fill(0);
            for ((price, cut), members) in multipliers[n + 1..].iter().zip(&choices.cuts).zip(&self.in_cuts) {
                if *price > 0 {
                    bound += price * cut.room;
                    members.iter().for_each(|id| self.taken[*id as usize] += price);
                }
            }
        }
        for key in &mut self.keys {
            let id = key.id();
            *key = K::pack(weight(choices, id as usize, multipliers) - self.taken[id as usize], id);
        }
        // The order of the last run is nearly that of this one, which the stable sort is quick with.
        self.keys.sort();
        self.used.clear();
        for id in &self.forced {
            self.used.push(*id);
            if joined(choices, *id as usize).is_some() {
                bound += weight(choices, *id as usize, multipliers) - self.taken[*id as usize];
            }
        }
        for at in 0..self.keys.len() {
            let key = self.keys[at];
            let (a, b) = joined(choices, key.id() as usize).expect("only what joins has a key");
            if self.join(a, b, key.weight(), key.id()) {
                bound += key.weight();
                self.used.push(key.id());
                if self.joins.len() == n {
                    break;
                }
            }
        }
        if self.joins.len() < n {
            return None;
        }
        let (end, id) = best_ends(choices, made, multipliers)[0]?;
        if made.state[id] != IN {
            self.used.push(id as u32);
        }
        Some(bound + end)
    }

    fn used(&self) -> &[u32] {
        &self.used
    }

    fn excess(&self, choices: &Choices, excess: &mut [i32]) {
        excess.fill(-2);
        excess[choices.points] = -1;
        for (excess, cut) in excess[choices.points + 1..].iter_mut().zip(&choices.cuts) {
            *excess = self.used.iter().filter(|id| choices.counts(cut, **id as usize)).count() as i32 - cut.room as i32;
        }
        for id in &self.used {
            match choices.kind(*id as usize) {
                Choice::Arc(arc) => {
                    excess[choices.arcs[arc].from as usize] += 1;
                    excess[choices.arcs[arc].to as usize] += 1;
                }
                Choice::Start(point) => {
                    excess[point] += 1;
                    excess[choices.points] += 1;
                }
                Choice::Loop(point) => excess[point] += 2,
                Choice::End(point) => excess[point] += 1,
            }
        }
    }

    /// By the bound with one choice turned over, none of them solved again: a join not in the tree costs the narrowest
    /// join on its way, one in the tree its best replacement, an end the best end's lead over it.
    fn decided(
        &mut self,
        choices: &Choices,
        made: &Made,
        multipliers: &[i64],
        bound: i64,
        threshold: i64,
        decided: &mut Vec<(u32, u8)>,
    ) {
        for key in &self.keys {
            let (a, b) = joined(choices, key.id() as usize).expect("only what joins has a key");
            if bound - self.narrowest(a, b) + key.weight() < threshold {
                decided.push((key.id(), OUT));
            }
        }
        for (number, replacement) in self.replacements(choices).into_iter().enumerate() {
            let (weight, id) = self.joins[number];
            if weight != FORCED && replacement.is_none_or(|other| bound - weight + other < threshold) {
                decided.push((id, IN));
            }
        }
        let [Some((best, best_id)), second] = best_ends(choices, made, multipliers) else { return };
        for (point, multiplier) in multipliers[..choices.points].iter().enumerate() {
            let id = choices.end(point);
            if made.state[id] == OPEN && bound - best - multiplier < threshold {
                decided.push((id as u32, OUT));
            }
        }
        if made.state[best_id] == OPEN && second.is_none_or(|(other, _)| bound - best + other < threshold) {
            decided.push((best_id as u32, IN));
        }
    }
}
