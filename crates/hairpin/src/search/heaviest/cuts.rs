//! Cuts that the relaxed problem lacks where points may be left out.
//!
//! Of a set S and one of its points k, a path that meets k has in S at most as many arcs as it meets points there, less
//! one; one that does not meet k leaves it out. So in both cases
//!
//! Σ arcs inside S + Σ loops of S but k's ≤ |S| − 1.
//!
//! A tree alone keeps to this without the loops. Two far clusters can each be half of a path then, with half a point
//! left out in each, and be worth the sum of both. A price π ≥ 0 for each cut takes π from what is inside, and adds π
//! (|S| − 1). Subtour elimination for tours that choose their points: Fischetti, Salazar & Toth, "A branch-and-cut
//! algorithm for the symmetric generalized traveling salesman problem" (Operations Research 45, 1997).

use super::choices::Choices;
use super::cut::Cut;

/// More are not priced at once: steps with many are slow and go nowhere.
const MOST: usize = 128;
/// So many are taken at a time, the most violated ones.
const AT_A_TIME: usize = 32;
/// Violated by less is as good as kept.
const VIOLATED: f64 = 0.03;
/// What is in a smaller share of the relaxed solutions joins no sets.
const JOINS: f64 = 0.02;

/// Points that arcs join, the ones in most relaxed solutions first.
struct Set {
    points: Vec<u32>,
    /// Shares of the arcs inside, summed.
    arcs: f64,
}

/// Cuts that a mean of relaxed solutions violates, those that are priced already aside; none where there are enough.
///
/// Sets are those that arise as arcs are joined by their shares in the mean: clusters, and what hangs together. O(n²)
/// beside sorting.
pub(super) fn violated(choices: &Choices, shares: &[f64]) -> Vec<Cut> {
    let n = choices.points;
    let mut between = vec![0.0; n * n];
    for (arc, share) in choices.arcs.iter().zip(shares) {
        between[arc.from as usize * n + arc.to as usize] = *share;
        between[arc.to as usize * n + arc.from as usize] = *share;
    }
    let mut order: Vec<usize> = (0..choices.arcs.len()).filter(|id| shares[*id] > JOINS).collect();
    order.sort_by(|a, b| shares[*b].total_cmp(&shares[*a]).then(a.cmp(b)));
    let mut sets: Vec<Set> = (0..n as u32).map(|point| Set { points: vec![point], arcs: 0.0 }).collect();
    let mut set_of: Vec<usize> = (0..n).collect();
    let mut found: Vec<(f64, Cut)> = Vec::new();
    for arc in order.into_iter().map(|id| choices.arcs[id]) {
        let (mut into, mut from) = (set_of[arc.from as usize], set_of[arc.to as usize]);
        if into == from {
            continue;
        }
        if sets[into].points.len() < sets[from].points.len() {
            (into, from) = (from, into);
        }
        let moved = std::mem::replace(&mut sets[from], Set { points: Vec::new(), arcs: 0.0 });
        let pairs = moved.points.iter().flat_map(|a| sets[into].points.iter().map(|b| (*a as usize, *b as usize)));
        let across: f64 = pairs.map(|(a, b)| between[a * n + b]).sum();
        moved.points.iter().for_each(|point| set_of[*point as usize] = into);
        sets[into].points.extend(moved.points);
        sets[into].arcs += moved.arcs + across;
        cuts_of(&sets[into], choices, shares, &mut found);
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let new = found.into_iter().map(|(_, cut)| cut).filter(|cut| !choices.cuts.contains(cut));
    new.take(AT_A_TIME.min(MOST.saturating_sub(choices.cuts.len()))).collect()
}

/// The violated cuts of one set, with by how much.
fn cuts_of(set: &Set, choices: &Choices, shares: &[f64], found: &mut Vec<(f64, Cut)>) {
    let loop_of = |point: &u32| shares[choices.looped(*point as usize)];
    let room = set.points.len() - 1;
    let loops: f64 = set.points.iter().map(loop_of).sum();
    for except in &set.points {
        let too_many = set.arcs + loops - loop_of(except) - room as f64;
        if too_many > VIOLATED {
            let mut inside = vec![false; choices.points];
            set.points.iter().for_each(|point| inside[*point as usize] = true);
            found.push((too_many, Cut { inside, except: *except, room: room as i64 }));
        }
    }
}
