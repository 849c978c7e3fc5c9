//! Where multipliers begin: each point's, in turn, where the bound without connectedness is least.
//!
//! Coordinate descent on the assignment bound: cheap, and closer to the end than zero.
//!
//! Held and Karp begin at 0; here each coordinate moves to (undirected: half of the way to) the middle of the interval
//! where the relaxation without trees is least, so that neighbours do not overshoot together. The tree's own ascent
//! goes on from there.

use super::problem::{Arcs, NONE};

/// Times that every point has its turn.
const TURNS: usize = 12;

/// One multiplier a point, and one for starts; costs count `scale` times.
pub(super) fn first_multipliers(arcs: &Arcs, scale: i64) -> Vec<i64> {
    if arcs.symmetric() { undirected(arcs, scale) } else { directed(arcs, scale) }
}

/// Two arcs at each point: Σ 2λ + Σ (c − λᵢ − λⱼ)⁺ is least in λᵢ between the second and the third of c(i, j) − λⱼ.
fn undirected(arcs: &Arcs, scale: i64) -> Vec<i64> {
    let n = arcs.points();
    let mut multipliers = vec![arcs.largest() * scale / 2; n];
    for _ in 0..TURNS {
        for i in 0..n {
            let mut top = [None; 3];
            for j in (0..n).filter(|j| arcs.raw(i, *j) != NONE) {
                sift(&mut top, arcs.raw(i, j) * scale - multipliers[j]);
            }
            let wanted = top[2].map_or(0, |third| (top[1].unwrap_or(third) + third) / 2);
            multipliers[i] = (multipliers[i] + wanted) / 2;
        }
    }
    let mut sorted = multipliers.clone();
    sorted.sort_unstable();
    multipliers.push(-sorted[1.min(n - 1)]);
    multipliers
}

/// One arc out of each point and one into it: u is between the first and the second of c(i, j) − vⱼ, v of c(i, j) − uᵢ.
fn directed(arcs: &Arcs, scale: i64) -> Vec<i64> {
    let n = arcs.points();
    let (mut out, mut into) = (vec![0; n], vec![0; n]);
    let between = |weights: &mut dyn Iterator<Item = i64>| {
        let mut top = [None; 2];
        weights.for_each(|weight| sift(&mut top, weight));
        top[1].map_or(0, |second| (top[0].unwrap_or(second) + second) / 2)
    };
    for _ in 0..TURNS {
        for (i, out) in out.iter_mut().enumerate() {
            let others = (0..n).filter(|j| arcs.raw(i, *j) != NONE);
            *out = between(&mut others.map(|j| arcs.raw(i, j) * scale - into[j]));
        }
        for (j, into) in into.iter_mut().enumerate() {
            let others = (0..n).filter(|i| arcs.raw(*i, j) != NONE);
            *into = between(&mut others.map(|i| arcs.raw(i, j) * scale - out[i]));
        }
    }
    out.push(0);
    out
}

/// Keeps the largest, in order.
fn sift<const N: usize>(top: &mut [Option<i64>; N], mut weight: i64) {
    for place in top {
        match place {
            Some(held) if *held >= weight => {}
            Some(held) => std::mem::swap(held, &mut weight),
            None => {
                *place = Some(weight);
                return;
            }
        }
    }
}
