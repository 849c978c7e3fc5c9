//! Residuals with what each takes over from those before it taken out.
//!
//! ```text
//! r_i = φ₁ r_{i−1} + φ₂ r_{i−2} + e_i        γ_k = Σ r_i r_{i−k}/n within legs        φ by Yule and Walker
//! ```
//!
//! A filter of residuals, the same for all parameters, leaves output error consistent and brings it near to the
//! estimate of the least variance (Ljung, System Identification, 2nd ed., 14.4; Prais and Winsten 1954 for a leg's
//! first samples). What it leaves of colour the spread of stretches takes up.

/// Of an output, of order two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Filter {
    /// Of a leg's first sample: what makes its variance that of the others.
    first: f64,
    /// Of the second: from the first, and all of it.
    second: [f64; 2],
    /// From the sample before, and the one before that.
    both: [f64; 2],
}

impl Filter {
    /// That passes everything.
    pub(super) const NONE: Self = Self { first: 1.0, second: [0.0, 1.0], both: [0.0, 0.0] };

    /// Of a process with these autocovariances at lags 0, 1 and 2.
    fn of([g0, g1, g2]: [f64; 3]) -> Self {
        let rho = g1 / g0;
        let determinant = g0 * g0 - g1 * g1;
        let both = [(g1 * g0 - g1 * g2) / determinant, (g2 * g0 - g1 * g1) / determinant];
        let (one, two) = (g0 * (1.0 - rho * rho), g0 - both[0] * g1 - both[1] * g2);
        let (first, scale) = ((two / g0).sqrt(), (two / one).sqrt());
        let whole = Self { first, second: [rho * scale, scale], both };
        let finite = [first, scale, both[0], both[1]].iter().all(|c| c.is_finite());
        if finite && two > 0.0 { whole } else { Self::NONE }
    }

    fn passed(&self, before: [Option<f64>; 2], now: f64) -> f64 {
        match before {
            [None, _] => self.first * now,
            [Some(one), None] => self.second[1] * now - self.second[0] * one,
            [Some(one), Some(two)] => now - self.both[0] * one - self.both[1] * two,
        }
    }
}

/// Samples of one leg each: residuals of all outputs, sample by sample.
pub(super) type Leg<'a> = &'a [Vec<f64>];

/// The filter of each of `numbers` outputs, from the legs' residuals; with each leg stands which number its columns
/// have. Legs of logs that have other outputs count for those that they have.
pub(super) fn filters(legs: &[(Leg, &[usize])], numbers: usize) -> Vec<Filter> {
    let mut covariances = vec![[0.0; 3]; numbers];
    for (leg, outputs) in legs {
        for (column, &number) in outputs.iter().enumerate() {
            for (lag, sum) in covariances[number].iter_mut().enumerate() {
                *sum += leg.iter().zip(leg.iter().skip(lag)).map(|(a, b)| a[column] * b[column]).sum::<f64>();
            }
        }
    }
    covariances.into_iter().map(Filter::of).collect()
}

/// The residuals of a leg, filtered, in the order of samples.
pub(super) fn whitened(leg: Leg, outputs: &[usize], filters: &[Filter], into: &mut Vec<f64>) {
    for (i, sample) in leg.iter().enumerate() {
        for (column, &number) in outputs.iter().enumerate() {
            let before = [1, 2].map(|back| i.checked_sub(back).map(|before| leg[before][column]));
            into.push(filters[number].passed(before, sample[column]));
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{standard_normals, stream};

    /// Of a process of order two what is left is what drove it.
    #[test]
    fn what_drives_a_process_is_left_of_it() {
        let mut random = stream(4);
        let (mut leg, mut drives) = (vec![vec![0.0], vec![0.0]], vec![0.0, 0.0]);
        for i in 2..20_000 {
            let drive = standard_normals::<1>(&mut random)[0];
            leg.push(vec![1.6 * leg[i - 1][0] - 0.7 * leg[i - 2][0] + drive]);
            drives.push(drive);
        }
        let filters = filters(&[(&leg, &[0])], 1);
        let mut left = Vec::new();
        whitened(&leg, &[0], &filters, &mut left);
        let off: f64 = left.iter().zip(&drives).skip(2).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / 2e4;
        assert!(off < 0.01, "{off}, {filters:?}");
    }

    /// A log of fewer outputs takes nothing from what the others say of theirs, wherever it stands.
    #[test]
    fn logs_of_other_outputs_leave_filters_as_they_were() {
        let both: Vec<Vec<f64>> = (0..50).map(|i| vec![f64::from(i).sin(), f64::from(i).cos()]).collect();
        let one: Vec<Vec<f64>> = (0..50).map(|i| vec![f64::from(i * i).sin()]).collect();
        let second = |legs: &[(Leg, &[usize])]| format!("{:?}", filters(legs, 2)[1]);
        let alone = second(&[(&both, &[0, 1])]);
        assert_eq!(second(&[(&both, &[0, 1]), (&one, &[0])]), alone);
        assert_eq!(second(&[(&one, &[0]), (&both, &[0, 1])]), alone);
    }
}
