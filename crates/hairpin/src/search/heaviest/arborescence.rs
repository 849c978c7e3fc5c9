//! The bound of directed problems: a maximal arborescence from the dummy, on which points that are left out hang.
//!
//! L(μ) = Σᵢ μᵢ + μ_s + max over arborescences A of Σ_A w + max over allowed ends t of −μ_t, with w(i→j) = c(i, j) −
//! μᵢ, w(start i) = −μ_s, w(loop i) = −μᵢ. Any path with loops for what it leaves out is such an arborescence with an
//! end, and leaves each point and the start once; so it costs no more than L(μ), whatever the signs of μ. Edmonds 1967,
//! by rounds of contracting all circles at once; the weights that are left are reduced costs: forcing an arc costs at
//! least its own.
//!
//! All circles of best arcs are contracted at once, O(m) a round.
//!
//! Edmonds, "Optimum branchings" (J. Res. NBS 71B, 1967). Weights are 64-bit integers throughout, costs times a power
//! of two, so that sums, reduced costs and the bound are exact and a certificate can be checked to the last bit.

use super::choices::{Choice, Choices, Made, OPEN, OUT};
use super::relaxation::{Relaxation, best_ends};

/// An arc that is in no contracted circle yet; `weight` is what of it is left after the rounds so far.
#[derive(Clone, Copy)]
struct Live {
    id: u32,
    /// Contracted points.
    from: u32,
    to: u32,
    weight: i64,
}

/// One round: the contracted point of each point, and the arc that each contracted point took.
#[derive(Default)]
struct Round {
    label: Vec<u32>,
    taken: Vec<u32>,
}

/// Edmonds' algorithm.
pub(super) struct Arborescence {
    /// Choices that are not out, but for ends: number, tail, head.
    arcs: Vec<(u32, u32, u32)>,
    live: Vec<Live>,
    rounds: Vec<Round>,
    /// Reduced cost of each choice, at most 0.
    reduced: Vec<i64>,
    used: Vec<u32>,
    /// Of the round: best arc into each contracted point, and where a walk along them has been.
    best: Vec<(i64, u32)>,
    seen: Vec<u32>,
    next_label: Vec<u32>,
    entering: Vec<u32>,
}

const NOBODY: u32 = u32::MAX;

impl Arborescence {
    /// The point that a choice leads into: an arc's end, and the point itself for its start, its loop and its end.
    fn head(choices: &Choices, id: u32) -> usize {
        match choices.kind(id as usize) {
            Choice::Arc(arc) => choices.arcs[arc].to as usize,
            Choice::Start(point) | Choice::Loop(point) | Choice::End(point) => point,
        }
    }

    /// Contracts until no circle is left; the sum of what the points took, `None` if one cannot be entered.
    ///
    /// A round takes the best arc into each point but the root and lessens every arc by the best into its end; all
    /// circles that best arcs close become one point each. What an arc has left when it vanishes into a circle, or in
    /// the end, is its reduced cost (≤ 0). At most n rounds, O(m) each.
    fn contract(&mut self, points: usize) -> Option<i64> {
        let (mut count, mut total, mut number) = (points as u32 + 1, 0, 0);
        let mut root = points as u32;
        loop {
            if self.rounds.len() == number {
                self.rounds.push(Round::default());
            }
            self.best.clear();
            self.best.resize(count as usize, (i64::MIN, NOBODY));
            for (at, arc) in self.live.iter().enumerate() {
                let best = &mut self.best[arc.to as usize];
                if arc.weight > best.0 {
                    *best = (arc.weight, at as u32);
                }
            }
            let round = &mut self.rounds[number];
            round.taken.clear();
            round.taken.resize(count as usize, NOBODY);
            for point in (0..count).filter(|point| *point != root) {
                let (weight, at) = self.best[point as usize];
                if at == NOBODY {
                    return None;
                }
                total += weight;
                round.taken[point as usize] = self.live[at as usize].id;
            }
            // Walks backwards along the arcs taken: each that meets itself has found a circle.
            self.seen.clear();
            self.seen.resize(count as usize, NOBODY);
            self.next_label.clear();
            self.next_label.resize(count as usize, NOBODY);
            let mut labels = 0;
            self.seen[root as usize] = root;
            for begin in 0..count {
                let mut at = begin;
                while self.seen[at as usize] == NOBODY {
                    self.seen[at as usize] = begin;
                    at = self.live[self.best[at as usize].1 as usize].from;
                }
                if at != root && self.seen[at as usize] == begin && self.next_label[at as usize] == NOBODY {
                    let circle = at;
                    loop {
                        self.next_label[at as usize] = labels;
                        at = self.live[self.best[at as usize].1 as usize].from;
                        if at == circle {
                            break;
                        }
                    }
                    labels += 1;
                }
            }
            if labels == 0 {
                for arc in &self.live {
                    let taken = self.best[arc.to as usize].0;
                    self.reduced[arc.id as usize] = if arc.to == root { 0 } else { arc.weight - taken };
                }
                self.rounds.truncate(number + 1);
                return Some(total);
            }
            for label in &mut self.next_label {
                if *label == NOBODY {
                    *label = labels;
                    labels += 1;
                }
            }
            let (best, next_label, reduced) = (&self.best, &self.next_label, &mut self.reduced);
            self.live.retain_mut(|arc| {
                arc.weight -= best[arc.to as usize].0;
                (arc.from, arc.to) = (next_label[arc.from as usize], next_label[arc.to as usize]);
                if arc.from == arc.to {
                    reduced[arc.id as usize] = arc.weight;
                }
                arc.from != arc.to
            });
            number += 1;
            if self.rounds.len() == number {
                self.rounds.push(Round::default());
            }
            let (before, after) = self.rounds.split_at_mut(number);
            after[0].label.clear();
            after[0].label.extend(before[number - 1].label.iter().map(|label| next_label[*label as usize]));
            root = next_label[root as usize];
            count = labels;
        }
    }

    /// Which arc enters each point in the end: what a circle was entered by stands for one arc of it.
    fn expand(&mut self, choices: &Choices) {
        let points = choices.points;
        let last = self.rounds.len() - 1;
        self.entering.clear();
        self.entering.extend_from_slice(&self.rounds[last].taken);
        for number in (0..last).rev() {
            let (inner, outer) = (&self.rounds[number], &self.rounds[number + 1]);
            let mut entering = inner.taken.clone();
            for id in self.entering.iter().filter(|id| **id != NOBODY) {
                entering[inner.label[Self::head(choices, *id)] as usize] = *id;
            }
            debug_assert_eq!(inner.label.len(), outer.label.len(), "every round labels every point");
            self.entering = entering;
        }
        self.used.clear();
        self.used.extend(self.entering[..points].iter().copied());
    }
}

impl Relaxation for Arborescence {
    fn new(choices: &Choices) -> Self {
        Self {
            arcs: Vec::new(),
            live: Vec::new(),
            rounds: Vec::new(),
            reduced: vec![0; choices.len()],
            used: Vec::new(),
            best: Vec::new(),
            seen: Vec::new(),
            next_label: Vec::new(),
            entering: Vec::new(),
        }
    }

    fn solve(&mut self, choices: &Choices, made: &Made, multipliers: &[i64], renew: bool) -> Option<i64> {
        let (points, dummy) = (choices.points, choices.points as u32);
        if renew {
            self.arcs.clear();
            for id in (0..choices.end(0)).filter(|id| made.state[*id] != OUT) {
                self.arcs.push(match choices.kind(id) {
                    Choice::Arc(arc) => (id as u32, choices.arcs[arc].from, choices.arcs[arc].to),
                    Choice::Start(point) | Choice::Loop(point) | Choice::End(point) => (id as u32, dummy, point as u32),
                });
            }
        }
        self.live.clear();
        let (first_loop, first_end) = (choices.looped(0), choices.end(0));
        for (id, from, to) in self.arcs.iter().copied() {
            let at = id as usize;
            let weight = match () {
                () if at < choices.arcs.len() => choices.arcs[at].cost - multipliers[from as usize],
                () if at < first_loop => -multipliers[points],
                () if at < first_end => -multipliers[to as usize],
                () => continue,
            };
            self.live.push(Live { id, from, to, weight });
        }
        self.rounds.truncate(1);
        if self.rounds.is_empty() {
            self.rounds.push(Round::default());
        }
        self.rounds[0].label.clear();
        self.rounds[0].label.extend(0..=dummy);
        let arborescence = self.contract(points)?;
        self.expand(choices);
        let (end, id) = best_ends(choices, made, multipliers)[0]?;
        self.used.push(id as u32);
        Some(arborescence + end + multipliers.iter().sum::<i64>())
    }

    fn used(&self) -> &[u32] {
        &self.used
    }

    fn excess(&self, choices: &Choices, excess: &mut [i32]) {
        excess.fill(-1);
        for id in &self.used {
            match choices.kind(*id as usize) {
                Choice::Arc(arc) => excess[choices.arcs[arc].from as usize] += 1,
                Choice::Start(_) => excess[choices.points] += 1,
                Choice::Loop(point) | Choice::End(point) => excess[point] += 1,
            }
        }
    }

    /// Out is what would bring the bound below the threshold by its reduced cost, and the ends that the best one leads
    /// by as much. Nothing is decided in: that takes the second best arborescence for each arc.
    fn decided(
        &mut self,
        choices: &Choices,
        made: &Made,
        multipliers: &[i64],
        bound: i64,
        threshold: i64,
        decided: &mut Vec<(u32, u8)>,
    ) {
        let out = |id: u32| made.state[id as usize] == OPEN && bound + self.reduced[id as usize] < threshold;
        decided.extend(self.arcs.iter().map(|(id, ..)| *id).filter(|id| out(*id)).map(|id| (id, OUT)));
        let [Some((best, _)), _] = best_ends(choices, made, multipliers) else { return };
        for (point, multiplier) in multipliers[..choices.points].iter().enumerate() {
            let id = choices.end(point);
            if made.state[id] == OPEN && bound - best - multiplier < threshold {
                decided.push((id as u32, OUT));
            }
        }
    }
}
