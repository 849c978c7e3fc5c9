//! The order of half-spaces by which a point outside is refused soonest.
//!
//! A point outside of a convex set breaks some half-space; asked in a good order it is refused after a few products.
//! Points inside have to be asked of all: nothing is saved for them.

use nalgebra::Vector3;

use super::cloud::Plane;
use crate::math::simd::{Simd, kernel};

/// Points in the bounding box by which half-spaces are judged, in words of 64.
const WORDS: usize = 2;
const WORD: usize = 64;

/// Points in words, one row per coordinate.
///
/// 128 points.
type Probes = [[[f64; WORD]; 3]; WORDS];

/// Numbers of `planes` such that each cuts off most of what those before it left of the box from `min` to `max`,
/// counted on evenly spread points; those that cut off nothing more keep their order.
///
/// A permutation; membership does not depend on it, only how soon a point outside is refused.
///
/// O(planes · 128) once, and O(planes) for each one that is chosen. The box should hold what is asked about: its points
/// are what counts as usual.
pub(super) fn refusal_order(simd: Simd, planes: &[Plane], min: &Vector3<f64>, max: &Vector3<f64>) -> Vec<u32> {
    let mut cuts = vec![[0; WORDS]; planes.len()];
    let mut order = Vec::with_capacity(planes.len());
    choose(simd, planes, &probes(min, max), &mut cuts, &mut order);
    let mut chosen = vec![false; planes.len()];
    for number in &order {
        chosen[*number as usize] = true;
    }
    order.extend((0u32..).zip(chosen).filter(|(_, chosen)| !chosen).map(|(number, _)| number));
    order
}

/// Evenly spread points of a box: the additive recurrence R3 (Roberts 2018), whose steps are the powers of 1/g with
/// g⁴ = g + 1.
///
/// Deterministic; the i-th is frac(½ + i a) along each axis.
fn probes(min: &Vector3<f64>, max: &Vector3<f64>) -> Probes {
    let steps = [0.819_172_513_396_164_5, 0.671_043_606_703_789_3, 0.549_700_477_901_970_4];
    let mut probes = [[[0.0; WORD]; 3]; WORDS];
    for i in 0..WORDS * WORD {
        for axis in 0..3 {
            let along = 0.5 + i as f64 * steps[axis];
            let share = along - f64::from(along as u32);
            probes[i / WORD][axis][i % WORD] = min[axis] + share * (max[axis] - min[axis]);
        }
    }
    probes
}

kernel! {
    /// Greedy cover (Johnson 1974): next is the half-space that cuts off most of the probes not yet cut off, until none
    /// cuts any more. Probes are bits of words, 64 at a step.
    fn choose(planes: &[Plane], probes: &Probes, cuts: &mut [[u64; WORDS]], order: &mut Vec<u32>) {
        for (&[nx, ny, nz, b], cuts) in planes.iter().zip(&mut *cuts) {
            for ([x, y, z], cut) in probes.iter().zip(cuts) {
                let mut found = 0;
                for i in 0..WORD {
                    found |= u64::from(nx * x[i] + ny * y[i] + nz * z[i] > b) << i;
                }
                *cut = found;
            }
        }
        let mut uncut = [u64::MAX; WORDS];
        loop {
            let (mut most, mut next) = (0, 0);
            for (number, cuts) in cuts.iter().enumerate() {
                let gain: u32 = cuts.iter().zip(&uncut).map(|(cut, uncut)| (cut & uncut).count_ones()).sum();
                if gain > most {
                    (most, next) = (gain, number);
                }
            }
            if most == 0 {
                return;
            }
            order.push(next as u32);
            for (uncut, cut) in uncut.iter_mut().zip(&cuts[next]) {
                *uncut &= !cut;
            }
        }
    }
}
