//! Non-regression: each move of new runs against the spread of a baseline's repeats.
//!
//! A release is not judged against a number but against how much the earlier one differs from itself. Few repeats make
//! a wide band: that is what Student's t is for.

use super::MovesError;
use super::measure::{Measured, MoveMeasures};
use crate::judgement::statistics::student_quantile;
use crate::math::power::square;

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Metric {
    /// Time of the move, s.
    Duration,
    /// Largest distance from the path, m.
    Deviation,
}

/// The runs of a release.
#[derive(Debug, Clone, Copy)]
pub struct Release<'a> {
    /// As verdicts call it: `7.14`.
    pub name: &'a str,
    /// Repeats of one program.
    pub runs: &'a [Measured],
}

/// How wide a baseline's band is.
///
/// Below the floors nothing is told apart, whatever the spread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Standard deviations, were the spread known exactly.
    pub sigma: f64,
    /// Least half-width of deviations, m: what instruments cannot tell apart.
    pub least_deviation: f64,
    /// Least half-width of durations as a share of the time between samples.
    pub least_samples: f64,
}

impl Default for Band {
    /// 3 standard deviations, 0.02 mm, half a sample.
    fn default() -> Self {
        Self { sigma: 3.0, least_deviation: 2e-5, least_samples: 0.5 }
    }
}

/// Where new runs lie.
///
/// Better is told, and is no regression; it often means that something is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Within the band.
    Same,
    /// Slower or farther off than the band.
    Worse,
    /// Faster or nearer than the band.
    Better,
}

/// One move, one metric.
#[derive(Debug, Clone, PartialEq)]
pub struct MoveComparison {
    /// Its number, from 0.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// What is compared.
    pub metric: Metric,
    /// Mean of the baseline, s or m.
    pub baseline: f64,
    /// Mean of the new runs.
    pub new: f64,
    /// Half-width of the band about the baseline's mean.
    pub band: f64,
    /// Where the new mean lies.
    pub outcome: Outcome,
}

impl MoveComparison {
    /// New less baseline, s or m.
    pub fn difference(&self) -> f64 {
        self.new - self.baseline
    }
}

/// All moves of two releases.
///
/// Durations and deviations of every move; a move that is worse in both counts once.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Name of the baseline.
    pub baseline: String,
    /// Name of the new release.
    pub new: String,
    /// Runs of the baseline and of the new release.
    pub runs: [usize; 2],
    /// Moves of the program.
    pub moves: usize,
    /// Every move's metrics that both releases have, in order.
    pub compared: Vec<MoveComparison>,
    /// Moves that the baseline completes in every run and the new release does not.
    pub lost: Vec<usize>,
}

impl Comparison {
    /// Moves (each once) with an outcome. A move that is worse in anything is not counted as better.
    pub fn count(&self, outcome: Outcome) -> usize {
        let with = |outcome| self.compared.iter().filter(move |one| one.outcome == outcome).map(|one| one.index);
        let mut moves: Vec<usize> = with(outcome).collect();
        if outcome == Outcome::Better {
            moves.retain(|index| with(Outcome::Worse).chain(self.lost.iter().copied()).all(|worse| worse != *index));
        }
        if outcome == Outcome::Worse {
            moves.extend(&self.lost);
            moves.sort_unstable();
        }
        moves.dedup();
        moves.len()
    }

    /// The worse metric that is farthest beyond its band, as a multiple of it.
    pub fn worst(&self) -> Option<&MoveComparison> {
        let beyond = |one: &MoveComparison| one.difference() / one.band;
        let worse = self.compared.iter().filter(|one| one.outcome == Outcome::Worse);
        worse.max_by(|a, b| beyond(a).total_cmp(&beyond(b)))
    }
}

/// Compares the moves of `new` with those of `baseline`.
///
/// With k and m runs, means b and n and pooled variance s² of the two, a move is worse where n − b > h,
/// h = max(t·s·√(1/k + 1/m), floor): t is Student's quantile of as rare an excess as `sigma` standard deviations, with
/// k + m − 2 degrees of freedom, for few runs know their spread badly.
///
/// # Errors
/// Fewer than two runs of the baseline, no new run, runs of different programs, settings out of bounds.
pub fn compare(baseline: &Release, new: &Release, band: &Band) -> Result<Comparison, MovesError> {
    for (field, value) in
        [("band_sigma", band.sigma), ("least_deviation", band.least_deviation), ("least_samples", band.least_samples)]
    {
        if !(value >= 0.0 && value.is_finite()) {
            return Err(MovesError::Setting { field, value, bound: "at least 0" });
        }
    }
    for (release, least) in [(baseline, 2), (new, 1)] {
        let found = release.runs.len();
        if found < least {
            return Err(MovesError::Runs { release: release.name.into(), found, least });
        }
        same_moves(&baseline.runs[0], release)?;
    }
    let moves = baseline.runs[0].moves.len();
    let floor = |metric: Metric| match metric {
        Metric::Deviation => band.least_deviation,
        Metric::Duration => {
            let samples = baseline.runs.iter().chain(new.runs).map(|run| run.sample);
            band.least_samples * samples.fold(0.0, f64::max)
        }
    };
    let floors = [Metric::Duration, Metric::Deviation].map(|metric| (metric, floor(metric)));
    let (mut compared, mut lost) = (Vec::with_capacity(2 * moves), Vec::new());
    for index in 0..moves {
        for (metric, floor) in floors {
            let (Some(before), Some(after)) = (values(baseline, index, metric), values(new, index, metric)) else {
                if metric == Metric::Duration && values(baseline, index, metric).is_some() {
                    lost.push(index);
                }
                continue;
            };
            let half = (width(&before, &after, band.sigma)).max(floor);
            let (old, now) = (mean(&before), mean(&after));
            let outcome = match now - old {
                more if more > half => Outcome::Worse,
                less if less < -half => Outcome::Better,
                _ => Outcome::Same,
            };
            let name = baseline.runs[0].moves[index].name.clone();
            compared.push(MoveComparison { index, name, metric, baseline: old, new: now, band: half, outcome });
        }
    }
    let runs = [baseline.runs.len(), new.runs.len()];
    Ok(Comparison { baseline: baseline.name.into(), new: new.name.into(), runs, moves, compared, lost })
}

/// Of every run; `None` where one has none.
pub(super) fn values(release: &Release, index: usize, metric: Metric) -> Option<Vec<f64>> {
    let of = |one: &MoveMeasures| match metric {
        Metric::Duration => one.duration,
        Metric::Deviation => one.deviation,
    };
    release.runs.iter().map(|run| of(&run.moves[index])).collect()
}

pub(super) fn same_moves(first: &Measured, release: &Release) -> Result<(), MovesError> {
    for (run, measured) in release.runs.iter().enumerate() {
        let most = first.moves.len().max(measured.moves.len());
        let name = |moves: &[MoveMeasures], i: usize| moves.get(i).map_or(String::new(), |one| one.name.clone());
        let differs = (0..most).find(|i| name(&first.moves, *i) != name(&measured.moves, *i));
        if let Some(index) = differs.or((first.moves.len() != measured.moves.len()).then_some(most - 1)) {
            let (found, expected) = (name(&measured.moves, index), name(&first.moves, index));
            return Err(MovesError::Moves { release: release.name.into(), run, index, found, expected });
        }
    }
    Ok(())
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Half-width of what the difference of two means may be by chance.
fn width(before: &[f64], after: &[f64], sigma: f64) -> f64 {
    let squares = |values: &[f64]| {
        let mean = mean(values);
        values.iter().map(|x| square(x - mean)).sum::<f64>()
    };
    let freedom = before.len() + after.len() - 2;
    let variance = (squares(before) + squares(after)) / freedom as f64;
    let shares = 1.0 / before.len() as f64 + 1.0 / after.len() as f64;
    student_quantile(freedom as f64, sigma) * (variance * shares).sqrt()
}
