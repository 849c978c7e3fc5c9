//! Monomials of standardised inputs, evaluated as runs.

use crate::math::simd::{Simd, kernel};

/// Monomials at most: their products are kept as one matrix per fold.
pub(super) const MOST_MONOMIALS: usize = 500;
/// Inputs at most.
pub(super) const MOST_INPUTS: usize = 32;

pub(super) fn standardised(x: f64, centre: f64, scale: f64, [least, greatest]: [f64; 2]) -> f64 {
    if scale > 0.0 { ((x - centre) / scale).clamp(least, greatest) } else { 0.0 }
}

/// All monomials of total degree 1 to `degree` in the standardised inputs, in the order of [`monomials_of`]. Those of one degree are,
/// input after input, the input times those of the degree before that have no earlier input: a run at the end of their block.
pub(super) fn monomials<'m>(
    inputs: &[f64],
    centre: &[f64],
    scale: &[f64],
    range: &[[f64; 2]],
    degree: u32,
    out: &'m mut [f64],
) -> &'m [f64] {
    let mut count = 0;
    for i in (0..inputs.len()).filter(|&i| scale[i] > 0.0) {
        out[count] = standardised(inputs[i], centre[i], scale[i], range[i]);
        count += 1;
    }
    let mut starts = [0; MOST_INPUTS];
    (0..count).for_each(|i| starts[i] = i);
    let mut end = count;
    for _ in 1..degree {
        let (known, new) = out.split_at_mut(end);
        let mut length = 0;
        for i in 0..count {
            let z = known[i];
            let run = &known[starts[i]..];
            starts[i] = end + length;
            for (out, monomial) in new[length..].iter_mut().zip(run) {
                *out = z * monomial;
            }
            length += run.len();
        }
        end += length;
    }
    &out[..end]
}

/// a·b in eight sums, the same on every machine.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = 0.0;
    sum_of_products(Simd::Widest, a, b, &mut sum);
    sum
}

kernel! {
    fn sum_of_products(a: &[f64], b: &[f64], sum: &mut f64) {
        let mut lanes = [0.0; 8];
        let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
        let rest = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum::<f64>();
        for (a, b) in a.zip(b) {
            for lane in 0..8 {
                lanes[lane] += a[lane] * b[lane];
            }
        }
        *sum = lanes.iter().sum::<f64>() + rest;
    }
}

/// Powers of all monomials of total degree 1 to `degree` in the inputs that differ (`scale` above 0), lower degrees first and the first
/// input's higher powers first; `None` of more than 500.
pub fn monomials_of(scale: &[f64], degree: u32) -> Option<Vec<Vec<u32>>> {
    let mut all = Vec::new();
    for total in 1..=degree {
        let mut powers = vec![0; scale.len()];
        each(scale, total, 0, &mut powers, &mut all);
        if all.len() > MOST_MONOMIALS || total as usize > MOST_MONOMIALS {
            return None;
        }
    }
    Some(all)
}

fn each(scale: &[f64], left: u32, input: usize, powers: &mut Vec<u32>, all: &mut Vec<Vec<u32>>) {
    if left == 0 {
        all.push(powers.clone());
        return;
    }
    if input == scale.len() || all.len() > MOST_MONOMIALS {
        return;
    }
    let most = if scale[input] > 0.0 { left } else { 0 };
    for power in (0..=most).rev() {
        powers[input] = power;
        each(scale, left - power, input + 1, powers, all);
    }
    powers[input] = 0;
}
