//! Residuals of logs in the order of an objective: filtered leg by leg, in stretches that count as nearly independent.

use super::compare::Compared;
use super::simulate::Loops;
use super::whiten::{Filter, Leg, filters, whitened};
use crate::math::output_error::Objective;

/// The objective on the logs `which`, by the residuals' function.
///
/// A stretch has `stretch`/`period` samples at least; where stretches are of whole legs it ends at the next leg's
/// begin. The last one of a log may be shorter. Residuals are numbered sample by sample, output by output.
///
/// Blocks that do not follow the one before are marked, as correlations of neighbours do not reach from log to log.
pub(super) fn objective<'a>(
    loops: &Loops,
    which: &[usize],
    residuals: &'a (dyn Fn(&[f64]) -> Option<Vec<f64>> + Sync),
) -> Objective<'a> {
    let sampling = &loops.rule.sampling;
    let (mut output, mut block, mut begins) = (Vec::new(), Vec::new(), Vec::new());
    for &log in which {
        let compared = &loops.compared[log];
        let (mut leg, mut since, mut first) = (usize::MAX, 0usize, true);
        let stretch = (sampling.stretch / sampling.period).round() as usize;
        for (own, _) in &compared.samples {
            // Of whole legs, or after their time.
            let by_legs = sampling.whole_legs && !loops.rule.timed;
            let next = since >= stretch && (*own != leg || !by_legs);
            if first || next {
                begins.push(first);
                (since, first) = (0, false);
            }
            leg = *own;
            since += 1;
            output.extend(&compared.outputs);
            block.extend(compared.outputs.iter().map(|_| begins.len() - 1));
        }
    }
    Objective { residuals, output, block, begins, parameters: loops.parameters().collect() }
}

/// Residuals of the logs `which`, filtered leg by leg; `None` where one is not simulated.
pub(super) fn residuals(loops: &Loops, theta: &[f64], which: &[usize], filters: &[Filter]) -> Option<Vec<f64>> {
    let logs = loops.residuals(theta, which)?;
    let mut all = Vec::new();
    for (log, residuals) in which.iter().zip(&logs) {
        let compared = &loops.compared[*log];
        legs(compared, residuals).for_each(|leg| whitened(leg, &compared.outputs, filters, &mut all));
    }
    Some(all)
}

/// The filters that leave residuals of `theta` without memory.
/// `None` where one is not simulated.
pub(super) fn colour(loops: &Loops, theta: &[f64], which: &[usize]) -> Option<Vec<Filter>> {
    let logs = loops.residuals(theta, which)?;
    let legs: Vec<(Leg, &[usize])> = which
        .iter()
        .zip(&logs)
        .flat_map(|(log, residuals)| {
            let compared = &loops.compared[*log];
            legs(compared, residuals).map(|leg| (leg, &compared.outputs[..]))
        })
        .collect();
    Some(filters(&legs, loops.rule.deviations()))
}

/// The residuals of a log, leg by leg.
///
/// Neighbouring samples of one leg number; a leg flown twice is two.
fn legs<'a>(compared: &'a Compared, residuals: &'a [Vec<f64>]) -> impl Iterator<Item = Leg<'a>> {
    let mut from = 0;
    compared.samples.chunk_by(|(a, _), (b, _)| a == b).map(move |leg| {
        from += leg.len();
        &residuals[from - leg.len()..from]
    })
}
