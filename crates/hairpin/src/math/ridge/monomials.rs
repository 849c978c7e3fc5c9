//! Monomials of standardised inputs, evaluated as runs.
//!
//! ```text
//! count of monomials of total degree 1 … p in k inputs = C(k + p, p) − 1
//! ```
//!
//! A block of one degree is made of products of the block before, so that a monomial costs one product. The order is
//! fixed: weights in files depend on it.

use crate::math::simd::{Simd, kernel};

/// Monomials at most: their products are kept as one matrix per fold.
///
/// 500² products of 8 bytes are 2 MB a fold.
pub(super) const MOST_MONOMIALS: usize = 500;
/// Inputs at most.
pub(super) const MOST_INPUTS: usize = 32;

/// z = clamp((x − c)/s, least, greatest), 0 for an input without a scale. NaN stays NaN.
pub(super) fn standardised(x: f64, centre: f64, scale: f64, [least, greatest]: [f64; 2]) -> f64 {
    if scale > 0.0 { ((x - centre) / scale).clamp(least, greatest) } else { 0.0 }
}

/// Puts the inputs of rows that are looked at together into `z`, standardised, those without a scale left out; how many
/// there are.
///
/// Row by row of `z` one input, lane by lane of a row one of those looked at together; in the order of the inputs.
pub(super) fn standardise<const L: usize>(
    inputs: [&[f64]; L],
    centre: &[f64],
    scale: &[f64],
    range: &[[f64; 2]],
    z: &mut [[f64; L]],
) -> usize {
    let mut count = 0;
    for i in (0..centre.len()).filter(|&i| scale[i] > 0.0) {
        z[count] = inputs.map(|inputs| standardised(inputs[i], centre[i], scale[i], range[i]));
        count += 1;
    }
    count
}

/// All monomials of total degree 1 to `degree` in the first `count` numbers of `out`, which are the standardised
/// inputs, in the order of [`monomials_of`]; how many. Those of one degree are, input after input, the input times
/// those of the degree before that have no earlier input: a run at the end of their block.
///
/// `out` holds at least as many numbers as there are monomials; `count` ≤ 32, `degree` ≥ 1. O(monomials), products
/// alone.
#[inline(always)]
pub(super) fn monomials<const L: usize>(count: usize, degree: u32, out: &mut [[f64; L]]) -> usize {
    let mut starts: [usize; MOST_INPUTS] = std::array::from_fn(|i| i);
    let mut end = count;
    for _ in 1..degree {
        let (known, new) = out.split_at_mut(end);
        let mut length = 0;
        for i in 0..count {
            let z = known[i];
            let run = &known[starts[i]..];
            starts[i] = end + length;
            for (out, monomial) in new[length..].iter_mut().zip(run) {
                for lane in 0..L {
                    out[lane] = z[lane] * monomial[lane];
                }
            }
            length += run.len();
        }
        end += length;
    }
    end
}

/// Rows whose values are told together: a lane each.
pub const LANES: usize = 4;

/// Σ w_j m_j(z) of every lane; the first `count` of `buffer` are z, the others are written to.
///
/// The same bits for each lane alone, whatever stands in the others.
pub(super) fn polynomials(count: usize, degree: u32, weights: &[f64], buffer: &mut [[f64; LANES]]) -> [f64; LANES] {
    let mut sums = [0.0; LANES];
    weighted(Simd::Widest, count, degree, weights, buffer, &mut sums);
    sums
}

kernel! {
    /// Σ w_j m_j(z) of every lane, the first `count` of `out` being z, in four sums.
    fn weighted(count: usize, degree: u32, weights: &[f64], out: &mut [[f64; LANES]], sums: &mut [f64; LANES]) {
        let end = monomials(count, degree, out);
        let mut parts = [[0.0; LANES]; 4];
        let mut rows = out[..end].chunks_exact(4);
        let mut of_rows = weights[..end].chunks_exact(4);
        for (rows, weights) in rows.by_ref().zip(of_rows.by_ref()) {
            for part in 0..4 {
                for lane in 0..LANES {
                    parts[part][lane] += weights[part] * rows[part][lane];
                }
            }
        }
        for (row, weight) in rows.remainder().iter().zip(of_rows.remainder()) {
            for lane in 0..LANES {
                parts[0][lane] += weight * row[lane];
            }
        }
        for lane in 0..LANES {
            sums[lane] = (parts[0][lane] + parts[1][lane]) + (parts[2][lane] + parts[3][lane]);
        }
    }
}

/// a·b in eight sums, the same on every machine.
///
/// Up to the length of the shorter: lanes of eight, and what is left over last.
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

/// Powers of all monomials of total degree 1 to `degree` in the inputs that differ (`scale` above 0), lower degrees
/// first and the first input's higher powers first; `None` of more than 500.
///
/// Each entry has as many powers as there are inputs, 0 for those without a scale. O(monomials · inputs).
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

/// Depth first: the powers of the inputs from `input` on that add up to `left`.
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

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};

    #[test]
    fn every_simd_level_gives_the_same_bits() {
        let mut random = stream(2);
        let mut numbers = |count: usize| -> Vec<f64> { (0..count).map(|_| 2.0 * unit(&mut random) - 1.0).collect() };
        for (count, degree, end) in [(8, 4, 494), (7, 3, 119), (1, 1, 1), (3, 2, 9)] {
            let weights = numbers(end);
            let mut buffer = vec![[0.0; LANES]; end];
            buffer[..count].as_flattened_mut().copy_from_slice(&numbers(count * LANES));
            let told = [Simd::Widest, Simd::Portable].map(|simd| {
                let mut sums = [0.0; LANES];
                weighted(simd, count, degree, &weights, &mut buffer.clone(), &mut sums);
                sums
            });
            assert_eq!(told[0].map(f64::to_bits), told[1].map(f64::to_bits), "{count} inputs, degree {degree}");
            // Lane by lane it is the sum over the monomials of that lane alone.
            let lane: Vec<[f64; 1]> = buffer.iter().map(|row| [row[2]]).collect();
            let mut alone = lane.clone();
            assert_eq!(monomials(count, degree, &mut alone), end);
            let sum: f64 = alone.iter().zip(&weights).map(|([monomial], weight)| monomial * weight).sum();
            assert!((told[0][2] - sum).abs() < 1e-12 * end as f64, "{} {sum}", told[0][2]);
            let (a, b) = (numbers(end), numbers(end));
            let dots = [Simd::Widest, Simd::Portable].map(|simd| {
                let mut sum = 0.0;
                sum_of_products(simd, &a, &b, &mut sum);
                sum.to_bits()
            });
            assert_eq!(dots[0], dots[1]);
        }
    }
}
