//! The path that a mean of relaxed solutions is close to.
//!
//! A mean knows which arcs belong together where local search does not: in narrow clusters all tours of one kind cost
//! nearly the same, and those of another kind are many moves away. The arcs that it is surest of are joined first.

use super::choices::{Arc, Choice, Choices};

const NOBODY: u32 = u32::MAX;

/// Chains of points and the dummy, point number n, on the way to a closed tour.
struct Chains {
    directed: bool,
    /// The points before and after each; undirected, in the order in which they came.
    beside: Vec<[u32; 2]>,
    /// The other end of a chain, at its ends.
    other_end: Vec<u32>,
}

impl Chains {
    fn new(points: usize, directed: bool) -> Self {
        let all = 0..points as u32 + 1;
        Self { directed, beside: all.clone().map(|_| [NOBODY; 2]).collect(), other_end: all.collect() }
    }

    /// Which place beside a point an arc takes that leaves it, or enters it.
    fn place(&self, point: u32, leaves: bool) -> usize {
        let beside = self.beside[point as usize];
        usize::from(if self.directed { leaves } else { beside[0] != NOBODY })
    }

    /// Joins two chains by an arc, unless one of its points is inside its chain or both are of one.
    fn join(&mut self, from: u32, to: u32) {
        let places = [self.place(from, true), self.place(to, false)];
        let free = self.beside[from as usize][places[0]] == NOBODY && self.beside[to as usize][places[1]] == NOBODY;
        if from == to || !free || self.other_end[from as usize] == to {
            return;
        }
        self.beside[from as usize][places[0]] = to;
        self.beside[to as usize][places[1]] = from;
        let (first, last) = (self.other_end[from as usize], self.other_end[to as usize]);
        self.other_end[first as usize] = last;
        self.other_end[last as usize] = first;
    }

    /// All points that `kept` says, chain by chain.
    fn order(&self, kept: impl Fn(u32) -> bool) -> Vec<u32> {
        let mut seen = vec![false; self.beside.len()];
        let mut order = Vec::new();
        for first in (0..self.beside.len() as u32).filter(|point| kept(*point)) {
            // Chains are walked from an end, directed ones from the first point.
            // Undirected, the second place stays free at an end.
            let begins = self.beside[first as usize][usize::from(!self.directed)] == NOBODY;
            let (mut at, mut before) = (first, NOBODY);
            while begins && at != NOBODY && !seen[at as usize] {
                seen[at as usize] = true;
                order.push(at);
                let [one, other] = self.beside[at as usize];
                (at, before) = (if self.directed || one == before { other } else { one }, at);
            }
        }
        order
    }
}

/// Points in the order of a path, joined by the arcs of the largest `shares`, then by the heaviest that are left.
///
/// Points that are left out in more than half of the solutions are left out. Between chains that no arc joins the path
/// passes nevertheless: that is for local search to mend. O(m log m).
pub(super) fn rounded(choices: &Choices, shares: &[f64]) -> Vec<usize> {
    let dummy = choices.points as u32;
    let kept = |point: u32| point == dummy || shares[choices.looped(point as usize)] <= 0.5;
    let mut joins: Vec<(f64, i64, u32, u32)> = Vec::new();
    for (id, share) in shares.iter().enumerate() {
        let (cost, from, to) = match choices.kind(id) {
            Choice::Arc(arc) => {
                let Arc { from, to, cost } = choices.arcs[arc];
                (cost, from, to)
            }
            Choice::Start(point) => (0, dummy, point as u32),
            Choice::End(point) => (0, point as u32, dummy),
            Choice::Loop(_) => continue,
        };
        if kept(from) && kept(to) {
            joins.push((*share, cost, from, to));
        }
    }
    joins.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)).then((a.2, a.3).cmp(&(b.2, b.3))));
    let mut chains = Chains::new(choices.points, choices.directed);
    joins.into_iter().for_each(|(_, _, from, to)| chains.join(from, to));
    let mut order = chains.order(kept);
    let at = order.iter().position(|point| *point == dummy).unwrap_or(0);
    order.rotate_left(at);
    order[1..].iter().map(|point| *point as usize).collect()
}

#[cfg(feature = "unit-tests")]
mod tests {
    use rand::Rng;

    use super::super::problem::Arcs;
    use super::*;
    use crate::math::random::{stream, unit};

    fn random_choices(n: usize, directed: bool, seed: u64) -> Choices {
        let mut random = stream(seed);
        let mut costs = vec![None; n * n];
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).filter(|(i, j)| i != j) {
            let known = if directed { None } else { costs[j * n + i] };
            costs[i * n + j] = known.or(Some((unit(&mut random) * 1000.0) as i64));
        }
        // One cost on its own makes a table directed.
        Choices::all(&Arcs::new(n, &costs).unwrap(), 1)
    }

    #[test]
    fn a_path_is_its_own_mean() {
        for directed in [false, true] {
            let choices = random_choices(7, directed, 1);
            assert_eq!(choices.directed, directed);
            let path = [4, 0, 6, 1, 3];
            let mut shares = vec![0.0; choices.len()];
            for leg in path.windows(2) {
                let joins = |arc: &Arc| {
                    let (from, to) = (arc.from as usize, arc.to as usize);
                    (from, to) == (leg[0], leg[1]) || !directed && (to, from) == (leg[0], leg[1])
                };
                shares[choices.arcs.iter().position(joins).unwrap()] = 1.0;
            }
            for id in [choices.start(4), choices.end(3), choices.looped(2), choices.looped(5)] {
                shares[id] = 1.0;
            }
            let mut found = rounded(&choices, &shares);
            if !directed && found[0] == 3 {
                found.reverse();
            }
            assert_eq!(found, path);
        }
    }

    #[test]
    fn whatever_the_shares_every_point_comes_once_or_is_left_out() {
        for seed in 0..50 {
            let mut random = stream(seed);
            let n = 1 + (random.next_u64() % 9) as usize;
            let choices = random_choices(n, seed % 2 == 0, seed);
            let shares: Vec<f64> = (0..choices.len()).map(|_| unit(&mut random)).collect();
            let mut found = rounded(&choices, &shares);
            found.sort_unstable();
            let kept: Vec<usize> = (0..n).filter(|point| shares[choices.looped(*point)] <= 0.5).collect();
            assert_eq!(found, kept, "seed {seed}");
        }
    }
}
