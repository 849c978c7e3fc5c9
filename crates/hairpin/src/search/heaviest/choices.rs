//! The problem as choices, each in or out, and what follows from some for others.
//!
//! A path is closed by a dummy point: one start arc from it, one end arc to it; a point that is left out has a loop.
//! Then every point has exactly two arcs (one in and one out where arcs are directed), a loop being both. Arcs, starts,
//! loops and ends are numbered in this order.
//!
//! Rules are sums: Σ of shares at a point = 2 (or 1 in and 1 out), one start, one end. What a rule has no more room for
//! is out, what it cannot do without is in; of each chain of chosen arcs the other end is kept, so that no arc closes a
//! circle.

use super::cut::Cut;
use super::problem::{Arcs, Ends};

/// Whether a choice is made.
pub(super) const OPEN: u8 = 0;
/// No solution of what is left has it.
pub(super) const OUT: u8 = 1;
/// Every solution of what is left has it.
pub(super) const IN: u8 = 2;

/// An arc: costs are scaled. Undirected ones are there once, with `from < to`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    pub(super) from: u32,
    pub(super) to: u32,
    pub(super) cost: i64,
}

/// All choices of a problem, and the rules between them.
#[derive(Clone)]
pub(super) struct Choices {
    /// Points.
    pub(super) points: usize,
    /// Whether i→j and j→i are two choices; else a rule of a point counts both of its arcs.
    pub(super) directed: bool,
    /// In the order of their numbers, which are those of their choices.
    pub(super) arcs: Vec<Arc>,
    /// What no path violates and relaxed solutions may; priced by the multipliers behind those of points and starts.
    pub(super) cuts: Vec<Cut>,
    /// Choices of each rule, rules one after another: of each point (its arcs out, where directed, then its arcs in),
    /// then of starts and ends.
    members: Vec<u32>,
    first: Vec<u32>,
    /// The rule of starts; that of ends follows.
    starts_rule: usize,
}

/// What a choice is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Choice {
    /// Arc number so and so.
    Arc(usize),
    /// The path begins at a point.
    Start(usize),
    /// A point is left out.
    Loop(usize),
    /// The path ends at a point.
    End(usize),
}

impl Choices {
    /// Whether a choice counts in a cut.
    pub(super) fn counts(&self, cut: &Cut, id: usize) -> bool {
        match self.kind(id) {
            Choice::Arc(arc) => cut.has_arc(self.arcs[arc].from, self.arcs[arc].to),
            Choice::Loop(point) => cut.has_loop(point),
            Choice::Start(_) | Choice::End(_) => false,
        }
    }

    /// The choices that count in a cut.
    pub(super) fn counted(&self, cut: &Cut) -> Vec<u32> {
        (0..self.len()).filter(|id| self.counts(cut, *id)).map(|id| id as u32).collect()
    }

    /// m arcs give m + 3n choices: arcs, then n starts, n loops, n ends. Rules are held as rows of members, O(m + n)
    /// memory.
    pub(super) fn new(points: usize, directed: bool, arcs: Vec<Arc>) -> Self {
        let (members, first) = (Vec::new(), Vec::new());
        let mut choices = Self { points, directed, arcs, cuts: Vec::new(), members, first, starts_rule: 0 };
        choices.starts_rule = if directed { 2 * points } else { points };
        let mut rules = vec![Vec::new(); choices.starts_rule + 2];
        for id in 0..choices.len() {
            choices.rules_of(id, |rule, _| rules[rule].push(id as u32));
        }
        for rule in rules {
            choices.first.push(choices.members.len() as u32);
            choices.members.extend(rule);
        }
        choices.first.push(choices.members.len() as u32);
        choices
    }

    /// All arcs of a problem, costs times `scale`.
    pub(super) fn all(arcs: &Arcs, scale: i64) -> Self {
        let n = arcs.points();
        let directed = !arcs.symmetric();
        let mut list = Vec::new();
        for from in 0..n {
            for to in if directed { 0 } else { from + 1 }..n {
                if let Some(cost) = arcs.cost(from, to).filter(|_| from != to) {
                    list.push(Arc { from: from as u32, to: to as u32, cost: cost * scale });
                }
            }
        }
        Self::new(n, directed, list)
    }

    /// With only the arcs that are among the `most` best of either of their points, by what multipliers leave of their
    /// costs.
    ///
    /// A smaller problem whose paths are paths of the whole, so good for finding; its bounds are none of the whole.
    /// O(n²).
    pub(super) fn near(arcs: &Arcs, scale: i64, multipliers: &[i64], most: usize) -> Self {
        let n = arcs.points();
        let directed = !arcs.symmetric();
        let mut kept = Vec::new();
        let mut row: Vec<(i64, u32)> = Vec::new();
        for point in 0..n {
            for turned in if directed { &[false, true][..] } else { &[false] } {
                let cost = |other: usize| if *turned { arcs.cost(other, point) } else { arcs.cost(point, other) };
                let others = (0..n).filter_map(|other| Some((multipliers[other] - cost(other)? * scale, other as u32)));
                row.clear();
                row.extend(others);
                if most < row.len() {
                    row.select_nth_unstable(most);
                    row.truncate(most);
                }
                let (point, swap) = (point as u32, |other: u32| *turned || !directed && other < point as u32);
                kept.extend(row.iter().map(|(_, other)| if swap(*other) { (*other, point) } else { (point, *other) }));
            }
        }
        kept.sort_unstable();
        kept.dedup();
        let cost = |from: u32, to: u32| arcs.raw(from as usize, to as usize) * scale;
        Self::new(n, directed, kept.into_iter().map(|(from, to)| Arc { from, to, cost: cost(from, to) }).collect())
    }

    /// One of each point, one of starts, one of each cut.
    pub(super) fn multipliers(&self) -> usize {
        self.points + 1 + self.cuts.len()
    }

    /// m + 3n.
    pub(super) fn len(&self) -> usize {
        self.arcs.len() + 3 * self.points
    }

    /// Number of the choice that the path begins at `point`.
    pub(super) fn start(&self, point: usize) -> usize {
        self.arcs.len() + point
    }

    /// Number of the choice that `point` is left out.
    pub(super) fn looped(&self, point: usize) -> usize {
        self.arcs.len() + self.points + point
    }

    /// Number of the choice that the path ends at `point`; ends are the last n choices.
    pub(super) fn end(&self, point: usize) -> usize {
        self.arcs.len() + 2 * self.points + point
    }

    pub(super) fn kind(&self, id: usize) -> Choice {
        let (m, n) = (self.arcs.len(), self.points);
        match id {
            _ if id < m => Choice::Arc(id),
            _ if id < m + n => Choice::Start(id - m),
            _ if id < m + 2 * n => Choice::Loop(id - m - n),
            _ => Choice::End(id - m - 2 * n),
        }
    }

    /// The number that a choice has in certificates, whatever arcs are here.
    ///
    /// i·n + j of the arc i→j, n² + point of its start, n² + n + point of its loop, n² + 2n + point of its end: it does
    /// not change as arcs are forgotten.
    pub(super) fn number(&self, id: usize) -> u64 {
        let n = self.points as u64;
        match self.kind(id) {
            Choice::Arc(arc) => u64::from(self.arcs[arc].from) * n + u64::from(self.arcs[arc].to),
            Choice::Start(point) => n * n + point as u64,
            Choice::Loop(point) => n * n + n + point as u64,
            Choice::End(point) => n * n + 2 * n + point as u64,
        }
    }

    /// Calls `rule(number, share)` for every rule that a choice has a share in.
    ///
    /// Shares are 1, but for an undirected loop, which is both of its point's two.
    fn rules_of(&self, id: usize, mut rule: impl FnMut(usize, i32)) {
        let leaves = |point: usize| point;
        let enters = |point: usize| if self.directed { self.points + point } else { point };
        match self.kind(id) {
            Choice::Arc(arc) => {
                let Arc { from, to, .. } = self.arcs[arc];
                rule(leaves(from as usize), 1);
                rule(enters(to as usize), 1);
            }
            Choice::Start(point) => {
                rule(enters(point), 1);
                rule(self.starts_rule, 1);
            }
            Choice::Loop(point) if self.directed => {
                rule(leaves(point), 1);
                rule(enters(point), 1);
            }
            Choice::Loop(point) => rule(point, 2),
            Choice::End(point) => {
                rule(leaves(point), 1);
                rule(self.starts_rule + 1, 1);
            }
        }
    }

    /// The choices that have a share in a rule, in the order of their numbers.
    fn members(&self, rule: usize) -> &[u32] {
        &self.members[self.first[rule] as usize..self.first[rule + 1] as usize]
    }

    /// What a rule's shares sum to.
    ///
    /// Directed: 1 out of and 1 into each point. Undirected: 2 at each point. 1 of starts and of ends.
    fn whole(&self, rule: usize) -> i32 {
        if self.directed || rule >= self.starts_rule { 1 } else { 2 }
    }
}

/// Choices made so far, closed under the rules.
///
/// Invariant after [`Made::follow`]: of every rule, 0 ≤ needs ≤ open. A copy is O(m + n), which is what a split costs.
#[derive(Clone)]
pub(super) struct Made {
    /// [`OPEN`], [`OUT`] or [`IN`] of each choice.
    pub(super) state: Vec<u8>,
    /// Shares that each rule still needs, and that are open.
    needs: Vec<i32>,
    open: Vec<i32>,
    /// Other end of the chosen chain that a point ends.
    other_end: Vec<u32>,
    /// Rules that may have something to say.
    waiting: Vec<u32>,
}

impl Made {
    /// Nothing chosen.
    pub(super) fn nothing(choices: &Choices) -> Self {
        let rules = choices.starts_rule + 2;
        let mut made = Self {
            state: vec![OPEN; choices.len()],
            needs: (0..rules).map(|rule| choices.whole(rule)).collect(),
            open: vec![0; rules],
            other_end: (0..choices.points as u32).collect(),
            waiting: (0..rules as u32).collect(),
        };
        for id in 0..choices.len() {
            choices.rules_of(id, |rule, share| made.open[rule] += share);
        }
        made
    }

    /// Nothing chosen but what the ends say; `None` if that contradicts itself.
    pub(super) fn new(choices: &Choices, ends: Ends) -> Option<Self> {
        let mut made = Self::nothing(choices);
        for point in 0..choices.points {
            if !ends.may_start(point) {
                made.choose(choices, choices.start(point), OUT)?;
            }
            if !ends.may_end(point) {
                made.choose(choices, choices.end(point), OUT)?;
            }
        }
        made.follow(choices)?;
        Some(made)
    }

    /// Makes a choice that is open, without its consequences; `None` if it closes a circle or breaks a rule.
    ///
    /// A choice that was made already is left alone, and contradicts another state. After `None` this is no problem any
    /// more and must be dropped.
    pub(super) fn choose(&mut self, choices: &Choices, id: usize, state: u8) -> Option<()> {
        if self.state[id] != OPEN {
            return (self.state[id] == state).then_some(());
        }
        self.state[id] = state;
        let mut holds = true;
        choices.rules_of(id, |rule, share| {
            self.open[rule] -= share;
            if state == IN {
                self.needs[rule] -= share;
            }
            holds &= self.needs[rule] >= 0 && self.open[rule] >= self.needs[rule];
            self.waiting.push(rule as u32);
        });
        if !holds {
            return None;
        }
        match choices.kind(id) {
            Choice::Arc(arc) if state == IN => self.join(choices, choices.arcs[arc]),
            _ => Some(()),
        }
    }

    /// Two chains become one: no arc may close it.
    ///
    /// Each chain's two ends know each other, so that joining is O(1) and the arc between the new ends, if there is
    /// one, goes out at once.
    fn join(&mut self, choices: &Choices, arc: Arc) -> Option<()> {
        // A chain's last point is the tail of `from`'s chain; directed chains run from first to last.
        let (first, last) = (self.other_end[arc.from as usize], self.other_end[arc.to as usize]);
        if first == arc.to {
            return None;
        }
        self.other_end[first as usize] = last;
        self.other_end[last as usize] = first;
        let rule = if choices.directed { last } else { first };
        let closing = choices.members(rule as usize).iter().copied().find(|id| {
            let closes = |arc: &Arc| {
                arc.from == last && arc.to == first || !choices.directed && arc.from == first && arc.to == last
            };
            choices.arcs.get(*id as usize).is_some_and(closes)
        });
        match closing {
            // Two single points are joined by the very arc that would close them.
            Some(id) if self.state[id as usize] == OPEN => self.choose(choices, id as usize, OUT),
            _ => Some(()),
        }
    }

    /// Makes all choices that follow; `None` if they contradict each other.
    ///
    /// To a fixed point: a rule is looked at again whenever one of its choices was made. O(m) over a whole descent of
    /// the tree, as a choice is made once.
    pub(super) fn follow(&mut self, choices: &Choices) -> Option<()> {
        while let Some(rule) = self.waiting.pop() {
            let rule = rule as usize;
            let (needs, open) = (self.needs[rule], self.open[rule]);
            if needs < 0 || open < needs {
                self.waiting.clear();
                return None;
            }
            if open == 0 {
                continue;
            }
            // A loop is both arcs of an undirected point: one arc beside it is of no use.
            let pair = !choices.directed && rule < choices.starts_rule;
            let lonely = pair && {
                let looped = choices.looped(rule);
                let loop_open = self.state[looped] == OPEN;
                loop_open && needs == 2 && open < 4
            };
            if needs > 0 && open > needs && !lonely && !(pair && needs == 1) {
                continue;
            }
            for at in choices.first[rule]..choices.first[rule + 1] {
                let id = choices.members[at as usize] as usize;
                if self.state[id] != OPEN {
                    continue;
                }
                let is_loop = pair && matches!(choices.kind(id), Choice::Loop(_));
                let share = if is_loop { 2 } else { 1 };
                let (needs, open) = (self.needs[rule], self.open[rule]);
                if share > needs || lonely && !is_loop {
                    self.choose(choices, id, OUT)?;
                } else if open == needs {
                    self.choose(choices, id, IN)?;
                }
            }
        }
        Some(())
    }
}
