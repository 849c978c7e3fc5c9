//! How moves change from release to release.
//!
//! What no single comparison shows: a move that grows by a millisecond with every release stays within each band.

use super::MovesError;
use super::compare::{Metric, Release, mean, same_moves, values};
use crate::judgement::statistics::rank_correlation;

/// One metric of one move over releases.
///
/// Theil-Sen is the median of slopes: one odd release does not bend it. Breakdown at 29 %.
#[derive(Debug, Clone, PartialEq)]
pub struct Trend {
    /// Its number, from 0.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// What is followed.
    pub metric: Metric,
    /// Mean of each release, s or m, in the order given; `None` where a run did not complete it.
    pub means: Vec<Option<f64>>,
    /// Median slope between all pairs of releases, s or m a release (Theil 1950, Sen 1968); `None` of fewer than two.
    pub slope: Option<f64>,
    /// Spearman's correlation with the number of the release; `None` of fewer than three, or where nothing changes.
    pub correlation: Option<f64>,
}

/// Every move's durations and deviations over `releases`, oldest first.
///
/// # Errors
/// A release without a run; runs of different programs.
pub fn trend(releases: &[Release]) -> Result<Vec<Trend>, MovesError> {
    for release in releases {
        if release.runs.is_empty() {
            return Err(MovesError::Runs { release: release.name.into(), found: 0, least: 1 });
        }
        same_moves(&releases[0].runs[0], release)?;
    }
    let Some(first) = releases.first() else { return Ok(Vec::new()) };
    let mut found = Vec::new();
    for (index, one) in first.runs[0].moves.iter().enumerate() {
        for metric in [Metric::Duration, Metric::Deviation] {
            let means: Vec<Option<f64>> =
                releases.iter().map(|release| values(release, index, metric).map(|all| mean(&all))).collect();
            let known = means.iter().enumerate().filter_map(|(number, mean)| Some((number as f64, (*mean)?)));
            let (numbers, values): (Vec<f64>, Vec<f64>) = known.unzip();
            let correlation = rank_correlation(&numbers, &values);
            let slope = slope(&numbers, &values);
            found.push(Trend { index, name: one.name.clone(), metric, means, slope, correlation });
        }
    }
    Ok(found)
}

fn slope(x: &[f64], y: &[f64]) -> Option<f64> {
    let mut slopes = Vec::new();
    for i in 0..x.len() {
        slopes.extend((0..i).map(|j| (y[i] - y[j]) / (x[i] - x[j])));
    }
    slopes.sort_unstable_by(f64::total_cmp);
    let half = slopes.len() / 2;
    match slopes.len() {
        0 => None,
        n if n % 2 == 0 => Some(0.5 * (slopes[half - 1] + slopes[half])),
        _ => Some(slopes[half]),
    }
}
