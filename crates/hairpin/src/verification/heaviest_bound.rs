//! Bounds at given multipliers, recomputed: Prim 1957 for undirected arcs, Edmonds 1967 for directed ones.
//!
//! The equations are those of `docs/heaviest-paths.md`; a probe is one more choice that is tried.
//!
//! Slow on purpose: O(n²) for a tree, O(n³) for an arborescence, whatever the table, without the search's keys, orders
//! or warm starts.
//!
//! ```text
//! undirected  L = 2 Σ λ_i + λ_s + Σ_cuts price (|S| − 1) + MST(w′) + max over ends of −λ_e
//!     w′(i, j)     = scale · w_ij − λ_i − λ_j − cuts       start i:  −λ_i − λ_s       loop i:  −2 λ_i − cuts
//! directed    L =   Σ λ_i + λ_s + arborescence(w′) + max over ends of −λ_e
//!     w′(i → j)    = scale · w_ij − λ_i                    start:    −λ_s             loop i:  −λ_i
//! ```
//!
//! λ_i are the multipliers of the points, λ_s that of the start, MST and arborescence those of largest weight over the
//! n points and a dummy, to which starts and loops lead. Any λ gives a bound: a bad one only proves less.

use super::heaviest_choices::{Chosen, IN, Layout, OUT};
use super::heaviest_claim::{CutClaim, StepClaim};

/// What a step prices: degrees, and cuts.
///
/// Only of undirected trees there are cuts; `taken` is then as long as there are choices.
pub(super) struct Prices<'a> {
    multipliers: &'a [i64],
    /// What cuts take from each choice, by number; nothing where there are none.
    taken: Vec<i128>,
    /// What they add.
    room: i128,
}

impl<'a> Prices<'a> {
    /// In words what is wrong with them.
    ///
    /// n + 1 multipliers of at most 2⁶⁰; cuts of rising points with a price from 0 to 2⁶⁰.
    ///
    /// # Errors
    /// What is wrong with them, in words.
    pub(super) fn of(layout: &Layout<'_>, step: &'a StepClaim) -> Result<Self, String> {
        let (n, multipliers) = (layout.points, &step.multipliers[..]);
        if multipliers.len() != n + 1 || multipliers.iter().any(|m| m.unsigned_abs() > 1 << 60) {
            return Err(format!("{} multipliers, or one beyond 60 bits", multipliers.len()));
        }
        let (mut taken, mut room) = (Vec::new(), 0);
        for CutClaim { points, except, price } in &step.cuts {
            let increasing = points.windows(2).all(|pair| pair[0] < pair[1]);
            let those_there_are = points.last().is_some_and(|last| *last < n);
            if layout.directed
                || !(0..=1 << 60).contains(price)
                || !increasing
                || !those_there_are
                || !points.contains(except)
            {
                return Err(format!("a cut of {} points at {price} is none", points.len()));
            }
            let price = i128::from(*price);
            taken.resize(layout.len(), 0);
            room += price * (points.len() as i128 - 1);
            for (at, point) in points.iter().enumerate() {
                points[at + 1..].iter().for_each(|other| taken[layout.arc(*point, *other)] += price);
                if point != except {
                    taken[layout.looped(*point)] += price;
                }
            }
        }
        Ok(Self { multipliers, taken, room })
    }

    /// 0 of what no cut counts.
    ///
    /// Of a choice inside several cuts the sum of their prices, in units of cost / scale.
    fn taken(&self, choice: usize) -> i128 {
        self.taken.get(choice).copied().unwrap_or(0)
    }
}

/// No path that keeps the choices (and the probe) costs more, scaled; `None` if there is none.
///
/// `multipliers` are n of the points and one of the start, in units of cost / scale; L of this file's equations with
/// every choice that is in taken and every one that is out left away. Exact in 128 bits.
pub(super) fn bound(
    layout: &Layout<'_>,
    chosen: &Chosen,
    prices: &Prices<'_>,
    probe: Option<(usize, u8)>,
) -> Option<i128> {
    let (n, multipliers) = (layout.points, prices.multipliers);
    let state = |choice: usize| match probe {
        Some((probed, state)) if probed == choice => state,
        _ => chosen.state[choice],
    };
    let price = |point: usize| i128::from(multipliers[point]);
    let ends = (0..n).filter(|point| state(layout.end(*point)) != OUT);
    let forced = (0..n).find(|point| state(layout.end(*point)) == IN);
    let end = match probe {
        Some((probed, IN)) if probed >= layout.end(0) => Some(-price(probed - layout.end(0))),
        _ => forced.map_or_else(|| ends.map(|point| -price(point)).max(), |point| Some(-price(point))),
    }?;
    let times = if layout.directed { 1 } else { 2 };
    let constant: i128 = (0..n).map(|point| times * price(point)).sum::<i128>() + price(n);
    let hung =
        if layout.directed { arborescence(layout, multipliers, &state, probe)? } else { tree(layout, prices, &state)? };
    Some(constant + prices.room + hung + end)
}

/// The heaviest spanning tree with all that is in.
///
/// Prim over n + 1 points, the dummy being n: what is in comes first, then the heaviest. `None` where the points do not
/// hang together, or what is in closes a circle. O(n²).
fn tree(layout: &Layout<'_>, prices: &Prices<'_>, state: &dyn Fn(usize) -> u8) -> Option<i128> {
    let n = layout.points;
    let price = |point: usize| i128::from(prices.multipliers[point]);
    // Chosen ones first, then by weight.
    let weigh = |choice: usize, weight: i128| (state(choice) != OUT).then(|| (state(choice) == IN, weight));
    let between = |a: usize, b: usize| {
        let (a, b) = (a.min(b), a.max(b));
        if b == n {
            let start = weigh(layout.start(a), -price(a) - price(n));
            let looped = layout.looped(a);
            return start.max(weigh(looped, -2 * price(a) - prices.taken(looped)));
        }
        let arc = layout.arc(a, b);
        weigh(arc, layout.cost(arc)? - price(a) - price(b) - prices.taken(arc))
    };
    let mut reach: Vec<Option<(bool, i128)>> = (0..n).map(|point| between(point, n)).collect();
    let mut inside = vec![false; n];
    let (mut total, mut kept) = (0, 0);
    for _ in 0..n {
        let next = (0..n).filter(|point| !inside[*point]).max_by_key(|point| reach[*point])?;
        let (chosen, weight) = reach[next]?;
        inside[next] = true;
        total += weight;
        kept += usize::from(chosen);
        for point in (0..n).filter(|point| !inside[*point]) {
            reach[point] = reach[point].max(between(next, point));
        }
    }
    // A chosen arc beside the tree closes a circle of chosen ones.
    let wanted = (0..layout.end(0)).filter(|choice| state(*choice) == IN).count();
    (kept == wanted).then_some(total)
}

/// An arc between contracted points.
///
/// `weight` is what is left of it after the contractions so far.
#[derive(Clone, Copy)]
struct Way {
    from: usize,
    to: usize,
    weight: i128,
}

/// The heaviest arborescence from the dummy with all that is in.
///
/// Edmonds, one circle at a time, O(n³). What is in is kept by leaving out whatever else enters the same point.
///
/// A step in which a chosen arc and a better one enter the same point is no contradiction here: what the choices
/// exclude is out already ([`Chosen::closed`]), so that only a probe has to be kept in.
fn arborescence(
    layout: &Layout<'_>,
    multipliers: &[i64],
    state: &dyn Fn(usize) -> u8,
    probe: Option<(usize, u8)>,
) -> Option<i128> {
    let n = layout.points;
    let price = |point: usize| i128::from(multipliers[point]);
    let mut ways = Vec::new();
    let head = |choice: usize| if choice < n * n { choice % n } else { (choice - n * n) % n };
    for choice in (0..layout.end(0)).filter(|choice| state(*choice) != OUT) {
        // Whatever else enters a point that a probe enters is out.
        if probe.is_some_and(|(tried, tried_state)| {
            tried_state == IN && tried < layout.end(0) && tried != choice && head(tried) == head(choice)
        }) {
            continue;
        }
        let way = match choice {
            _ if choice < n * n => {
                Way { from: choice / n, to: choice % n, weight: layout.cost(choice)? - price(choice / n) }
            }
            _ if choice < layout.looped(0) => Way { from: n, to: head(choice), weight: -price(n) },
            _ => Way { from: n, to: head(choice), weight: -price(head(choice)) },
        };
        ways.push(way);
    }
    let mut total = 0;
    let (mut count, mut alive) = (n + 1, vec![true; n + 1]);
    loop {
        let mut best: Vec<Option<Way>> = vec![None; count];
        for way in &ways {
            if best[way.to].is_none_or(|held| way.weight > held.weight) {
                best[way.to] = Some(*way);
            }
        }
        let Some(circle) = first_circle(&best, &alive, n)? else {
            let sum: i128 =
                (0..count).filter(|at| *at != n && alive[*at]).filter_map(|at| Some(best[at]?.weight)).sum();
            return Some(total + sum);
        };
        // The circle becomes one new point: what enters it costs what it takes the place of.
        let merged = count;
        count += 1;
        alive.push(true);
        let mut inside = vec![None; count];
        for at in &circle {
            let taken = best[*at]?.weight;
            total += taken;
            inside[*at] = Some(taken);
            alive[*at] = false;
        }
        ways.retain_mut(|way| {
            let (from, to) = (inside[way.from].is_some(), inside[way.to]);
            if let Some(taken) = to {
                way.weight -= taken;
                way.to = merged;
            }
            if from {
                way.from = merged;
            }
            !(from && to.is_some())
        });
    }
}

/// Points of a circle among the best ways in; the outer `None` if a point cannot be entered.
///
/// In the order of points, so that the sum has one order too. O(n).
fn first_circle(best: &[Option<Way>], alive: &[bool], root: usize) -> Option<Option<Vec<usize>>> {
    let mut seen = vec![usize::MAX; best.len()];
    for begin in (0..best.len()).filter(|at| alive[*at] && *at != root) {
        let mut at = begin;
        while at != root && seen[at] == usize::MAX {
            seen[at] = begin;
            at = best[at]?.from;
        }
        if at != root && seen[at] == begin {
            let mut circle = vec![at];
            let mut next = best[at]?.from;
            while next != at {
                circle.push(next);
                next = best[next]?.from;
            }
            return Some(Some(circle));
        }
    }
    Some(None)
}
