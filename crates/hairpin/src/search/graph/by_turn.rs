//! The dynamic program of scores that see how a leg is entered by its turn alone ([`Scoring::worth_by_turn`]), on
//! nodes that share their rows.
//!
//! A graph of millions of legs has a few hundred thousand rows' places and as few turns: all velocities of two
//! waypoints share them. So what a place is worth but for its turn is kept once, and what a turn is worth for every
//! two waypoints, worked out eight at a time; no leg's score is. A row's legs are looked at in the order of what they
//! can be worth, until no other can be worth more:
//!
//! ```text
//! V_s(v) = max over legs v→w of (plain + turning · (1 − |α − best|/best)) ⊕ V_{s−1}(w),    1 − |α − best|/best ≤ 1
//! ```
//!
//! Sums and turns are those of [`super::value`] to the bit: rounding is monotonic, so no bound is below what it bounds.

use super::super::objective::{Aggregate, ByTurn};
use super::rows::Groups;
use super::scoring::Scoring;
use super::value::{NO_WALK, Values};
use super::{LegGraph, OWN};
use crate::math::arc_tangent::arc_tangent;
use crate::math::simd::at_every_level;

/// Legs that are looked at together.
const LANES: usize = 8;
/// A place must be shared by so many nodes on the average.
const SHARED: usize = 4;
/// The number of legs from which on walks are many enough for their order to be that of longer ones.
const MANY: usize = 3;

/// One number of each of eight legs.
type Eight = [f64; LANES];

/// Eight legs of a row. Of places that are none the place is NaN.
#[derive(Debug, Clone, Copy)]
struct Legs {
    plain: Eight,
    turning: Eight,
    place: Eight,
    /// Waypoints.
    next: [u32; LANES],
    /// Nodes.
    to: [u32; LANES],
}

const NO_LEGS: Legs =
    Legs { plain: [0.0; LANES], turning: [0.0; LANES], place: [f64::NAN; LANES], next: [0; LANES], to: [0; LANES] };

/// Of eight legs what is to come after them, NaN where no walk does, and the most that these and all behind them can be
/// worth.
type Ahead = (Eight, f64);

/// 1 − |α − best|/best for the turns from the way into every node to every waypoint.
struct Turns {
    /// Of every node the number of its row: nodes of the same two waypoints have the same.
    of: Vec<u32>,
    width: usize,
    rows: Vec<f64>,
}

/// The places of all rows.
struct Parts {
    /// The turn that scores most, rad.
    best: f64,
    /// Row r is `begin[r]..begin[r + 1]` of `legs`.
    begin: Vec<usize>,
    legs: Vec<Legs>,
}

impl<N: Copy> LegGraph<'_, N> {
    /// [`Self::values`] of a score that is given `by_turn`; `None` where it is not, or where nodes do not share their
    /// rows.
    pub(in crate::search) fn values_by_turn(
        &self,
        length: usize,
        score: &dyn Scoring,
        aggregate: Aggregate,
        near_start: &[Vec<u32>],
    ) -> Option<Values> {
        let mut parts = self.parts(score)?;
        let turns = self.turns(parts.best)?;
        let at_end = |node| if self.at_end(node) { aggregate.neutral() } else { NO_WALK };
        let mut rest: Vec<Vec<f64>> = vec![(0..self.nodes() as u32).map(at_end).collect()];
        let all = self.rows.groups(0..self.nodes() as u32);
        while rest.len() < length {
            if rest.len() == MANY {
                parts.put_in_order(&rest[rest.len() - 1]);
            }
            let few = near_start.get(length - 1 - rest.len());
            let few = few.map(|nodes| self.rows.groups(nodes.iter().copied()));
            let nodes = few.as_ref().unwrap_or(&all);
            let layer = self.layer_by_turn(&rest[rest.len() - 1], (&parts, &turns), nodes, aggregate);
            rest.push(layer);
        }
        Some(Values::of_legs_alone(aggregate, rest))
    }

    /// `None` where it does not pay or is not known.
    fn parts(&self, score: &dyn Scoring) -> Option<Parts> {
        if self.legs() / SHARED < self.rows.to.len() || self.previous.contains(&OWN) {
            return None;
        }
        let mut parts = Parts { best: f64::NAN, begin: vec![0], legs: Vec::new() };
        parts.legs.reserve(self.rows.to.len() / LANES + self.rows.count() as usize);
        for (row, nodes) in self.rows.groups(0..self.nodes() as u32).iter() {
            parts.begin.resize(row as usize + 1, parts.legs.len());
            for (number, place) in self.rows.kept(row).enumerate() {
                let view = self.kept_view(nodes[0], place);
                let ByTurn { best, plain, turning } = score.worth_by_turn(&view)?;
                let is_finite = plain.is_finite() && turning.is_finite() && best > 0.0;
                if !is_finite || turning < 0.0 || (!parts.best.is_nan() && best.to_bits() != parts.best.to_bits()) {
                    return None;
                }
                parts.best = best;
                if number % LANES == 0 {
                    parts.legs.push(NO_LEGS);
                }
                let (last, lane) = (parts.legs.len() - 1, number % LANES);
                let legs = &mut parts.legs[last];
                (legs.plain[lane], legs.turning[lane], legs.place[lane]) = (plain, turning, place as f64);
                (legs.next[lane], legs.to[lane]) = (view.to, self.rows.to[place]);
            }
        }
        parts.begin.resize(self.rows.count() as usize + 1, parts.legs.len());
        Some(parts)
    }

    /// `None` where they are more than the legs.
    fn turns(&self, best: f64) -> Option<Turns> {
        let (many, mut pairs) = (self.candidates.len(), Vec::new());
        let mut numbers = vec![u32::MAX; many * many];
        let of = |node| {
            let pair = [self.previous[node as usize], self.waypoint(node)];
            let number = &mut numbers[pair[0] as usize * many + pair[1] as usize];
            if *number == u32::MAX {
                *number = pairs.len() as u32;
                pairs.push(pair);
            }
            *number
        };
        let of = (0..self.nodes() as u32).map(of).collect();
        let width = many.next_multiple_of(LANES);
        if pairs.len() * width > self.legs() {
            return None;
        }
        let eight = |begin: usize| [0, 1, 2].map(|axis| std::array::from_fn(|lane| self.point(begin + lane)[axis]));
        let points: Vec<[Eight; 3]> = (0..width).step_by(LANES).map(eight).collect();
        let mut rows = vec![0.0; pairs.len() * width];
        for (&[before, here], row) in pairs.iter().zip(rows.chunks_exact_mut(width)) {
            let [before_that, here_that] = [before, here].map(|waypoint| self.point(waypoint as usize));
            let incoming = (before != here).then(|| [0, 1, 2].map(|axis| here_that[axis] - before_that[axis]));
            sharpness(&points, here_that, incoming, best, row);
        }
        Some(Turns { of, width, rows })
    }

    /// Coordinates of a waypoint; beyond the last those of the last.
    fn point(&self, waypoint: usize) -> [f64; 3] {
        self.candidates[waypoint.min(self.candidates.len() - 1)].coords.into()
    }

    /// The layer of walks that are one leg longer than those of `after`, of the `nodes` given.
    fn layer_by_turn(
        &self,
        after: &[f64],
        (parts, turns): (&Parts, &Turns),
        nodes: &Groups,
        aggregate: Aggregate,
    ) -> Vec<f64> {
        let (mut layer, mut ahead) = (vec![NO_WALK; self.nodes()], Vec::new());
        for (row, nodes) in nodes.iter() {
            let legs = parts.row(row as usize);
            parts.look_ahead(legs, after, aggregate, &mut ahead);
            if ahead.first().is_none_or(|(_, most)| most.is_nan()) {
                continue;
            }
            for &node in nodes {
                let (gap, begin) = (self.rows.gap(node), turns.of[node as usize] as usize * turns.width);
                let (gap, sharp) = ([gap.start as f64, gap.end as f64], &turns.rows[begin..begin + turns.width]);
                layer[node as usize] = best_of(legs, &ahead, sharp, gap, aggregate == Aggregate::Max);
            }
        }
        layer
    }
}

impl Parts {
    fn row(&self, row: usize) -> &[Legs] {
        &self.legs[self.begin[row]..self.begin[row + 1]]
    }

    /// What is to come after the legs of a row, and what they can be worth.
    fn look_ahead(&self, legs: &[Legs], after: &[f64], aggregate: Aggregate, ahead: &mut Vec<Ahead>) {
        ahead.clear();
        ahead.extend(legs.iter().map(|legs| {
            let rest = legs.to.map(|to| after[to as usize]);
            let most = (0..LANES).map(|lane| legs.most(lane, rest[lane], aggregate));
            (rest, most.fold(f64::NAN, f64::max))
        }));
        let mut most = f64::NAN;
        for (_, here) in ahead.iter_mut().rev() {
            most = here.max(most);
            *here = most;
        }
    }

    /// Puts the legs of every row in the order of what they can be worth before walks worth `after`.
    fn put_in_order(&mut self, after: &[f64]) {
        let mut order: Vec<(f64, usize)> = Vec::new();
        let mut old: Vec<Legs> = Vec::new();
        for ends in self.begin.windows(2) {
            let legs = &mut self.legs[ends[0]..ends[1]];
            old.clear();
            old.extend_from_slice(legs);
            order.clear();
            for number in 0..LANES * old.len() {
                let (legs, lane) = (&old[number / LANES], number % LANES);
                let most = legs.most(lane, after[legs.to[lane] as usize], Aggregate::Sum);
                // What has no walk yet comes last.
                order.push((if most.is_nan() { f64::NEG_INFINITY } else { most }, number));
            }
            order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            for (number, &(_, from)) in order.iter().enumerate() {
                let (from, to) = ((&old[from / LANES], from % LANES), (&mut legs[number / LANES], number % LANES));
                to.0.put(to.1, from);
            }
        }
    }
}

impl Legs {
    /// What a leg and `rest` are worth together at the best turn; NaN if there is no such leg or rest.
    fn most(&self, lane: usize, rest: f64, aggregate: Aggregate) -> f64 {
        let own = self.plain[lane] + self.turning[lane];
        if rest.is_nan() || self.place[lane].is_nan() { f64::NAN } else { aggregate.add(rest, own) }
    }

    fn put(&mut self, lane: usize, (legs, from): (&Legs, usize)) {
        (self.plain[lane], self.turning[lane]) = (legs.plain[from], legs.turning[from]);
        (self.place[lane], self.next[lane], self.to[lane]) = (legs.place[from], legs.next[from], legs.to[from]);
    }
}

at_every_level! {
    /// 1 − |α − best|/best for the turns α from the way `incoming` to `here`, if there is one, to all of `points`.
    fn sharpness(points: &[[Eight; 3]], here: [f64; 3], incoming: Option<[f64; 3]>, best: f64, sharp: &mut [f64]) {
        let [ax, ay, az] = incoming.unwrap_or([0.0; 3]);
        for ([x, y, z], sharp) in points.iter().zip(sharp.chunks_exact_mut(LANES)) {
            let (mut across, mut along) = ([0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                let (bx, by, bz) = (x[lane] - here[0], y[lane] - here[1], z[lane] - here[2]);
                let (cx, cy, cz) = (ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx);
                across[lane] = (cx * cx + cy * cy + cz * cz).sqrt();
                along[lane] = ax * bx + ay * by + az * bz;
            }
            let turn = if incoming.is_some() { arc_tangent(&across, &along) } else { [0.0; LANES] };
            for (sharp, turn) in sharp.iter_mut().zip(turn) {
                *sharp = 1.0 - (turn - best).abs() / best;
            }
        }
    }
}

at_every_level! {
    /// The best of a row's legs outside of the places `gap`, whose turns are `sharp` by the waypoint that they lead to,
    /// with what is `ahead` of them; of the sum, or the worst leg if `is_max`.
    ///
    /// NaN where no walk is ahead.
    fn best_of(legs: &[Legs], ahead: &[Ahead], sharp: &[f64], gap: [f64; 2], is_max: bool) -> f64 {
        let (mut best, mut bests) = (f64::NEG_INFINITY, [f64::NEG_INFINITY; LANES]);
        for (legs, (rest, most)) in legs.iter().zip(ahead) {
            // NaN, behind the last walk, is not above either.
            let is_above = *most > best;
            if !is_above {
                break;
            }
            let mut sharpness = [0.0; LANES];
            for lane in 0..LANES {
                sharpness[lane] = sharp[legs.next[lane] as usize];
            }
            for lane in 0..LANES {
                let (own, rest) = (legs.plain[lane] + legs.turning[lane] * sharpness[lane], rest[lane]);
                let worst = if own > rest { own } else { rest };
                let both = if is_max { worst } else { rest + own };
                let is_leg = (legs.place[lane] < gap[0]) | (legs.place[lane] >= gap[1]);
                let worth = if is_leg & !rest.is_nan() { both } else { f64::NEG_INFINITY };
                bests[lane] = if worth > bests[lane] { worth } else { bests[lane] };
            }
            // In pairs: one after the other waits for the one before.
            let more = |a: f64, b: f64| if a > b { a } else { b };
            let [a, b, c, d, e, f, g, h] = bests;
            best = more(more(more(a, e), more(c, g)), more(more(b, f), more(d, h)));
        }
        if best == f64::NEG_INFINITY { NO_WALK } else { best }
    }
}
