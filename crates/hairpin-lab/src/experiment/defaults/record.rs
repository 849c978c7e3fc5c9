//! What was measured in a cell, as it is kept: numbers of runs, from which all that is told follows.

use std::path::Path;

use hairpin_formats::bounds;
use hairpin_jobs::Problem;
use serde::{Deserialize, Serialize};

use super::size::{Cell, Settings};
use super::ways::Way;

/// A record of a thousand runs of a thousand draws has some ten million bytes.
const MOST_BYTES: u64 = 1 << 30;
/// The end of a run that ends by itself.
const DONE: &str = "done";
/// The end of one that its time limit ends.
const TIME: &str = "time";

/// One cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct CellRecord {
    pub(super) settings: Settings,
    /// How random trajectories were drawn, in a sentence's part.
    pub(super) drawn_how: String,
    /// The mean that it is part of.
    pub(super) mean: Option<String>,
    pub(super) runs: Vec<RunRecord>,
    /// `None` where one side found nothing.
    pub(super) pairs: Vec<Option<PairRecord>>,
}

/// One independent run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct RunRecord {
    /// What each random trajectory came to nominally, in the order drawn.
    pub(super) uniform: Vec<Option<f64>>,
    /// Executions that one best of them is the best of.
    pub(super) best_of: usize,
    /// Random trajectories, each by itself.
    pub(super) single: Vec<Kept>,
    /// The best of as many random ones as each way executed for a case.
    pub(super) best: Vec<Kept>,
    pub(super) ways: Vec<WayRecord>,
    /// What the default search cost.
    pub(super) cost: Option<Cost>,
}

/// What one way found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct WayRecord {
    pub(super) way: Way,
    /// All executions, those of what was discarded included.
    pub(super) executions: u64,
    pub(super) kept: Vec<Kept>,
    /// Where the largest stress so far rose, of one pool: number of the execution, from 1, and the stress.
    pub(super) rises: Vec<(u64, f64)>,
    /// Why there is nothing.
    pub(super) refused: Option<String>,
}

/// A trajectory that was kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Kept {
    /// What it came to nominally.
    pub(super) found: Option<f64>,
    pub(super) fresh: Vec<Fresh>,
}

/// A fresh execution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Fresh {
    pub(super) stress: Option<f64>,
    /// The word of its end.
    pub(super) ended: String,
}

/// Processor time of all threads, s.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Cost {
    /// Of the search.
    pub(super) search: f64,
    /// Of as many executions of random trajectories.
    pub(super) uniform: f64,
    /// Of as many executions of what it kept.
    pub(super) kept: f64,
}

/// The worst of a default run, and the worst of many more executions by chance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct PairRecord {
    pub(super) worst: Kept,
    pub(super) chance: Kept,
}

impl CellRecord {
    /// The record of `cell` in `file`, as far as it was measured; one of nothing where there is none.
    ///
    /// # Errors
    /// A file that is none; one that was measured with other settings.
    pub(super) fn read(file: &Path, cell: &Cell, settings: Settings) -> Result<Self, Problem> {
        if !file.exists() {
            let (drawn_how, mean) = (String::new(), cell.mean.clone());
            return Ok(Self { settings, drawn_how, mean, runs: Vec::new(), pairs: Vec::new() });
        }
        let text = bounds::read_text(file, MOST_BYTES).map_err(|error| Problem::of_file(file, error))?;
        let record: Self = serde_json::from_str(&text).map_err(|error| Problem::of_file(file, error))?;
        if record.settings == settings {
            return Ok(record);
        }
        Err(Problem::of_file(file, "was measured with other settings; name another --out, or remove it"))
    }
}

impl Kept {
    /// Mean over its fresh executions; those that ended by themselves alone, if so asked. Deviations end where a
    /// crash does, so that no crash counts for more than what led to it.
    pub(super) fn mean(&self, ended_alone: bool) -> Option<f64> {
        let wanted = self.fresh.iter().filter(|fresh| !ended_alone || fresh.ended == DONE);
        let values: Vec<f64> = wanted.filter_map(|fresh| fresh.stress).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }
}

/// Shares of fresh executions of `kept` that crashed and that the time limit ended.
pub(super) fn ends(kept: &[&Kept]) -> [f64; 2] {
    let all = || kept.iter().flat_map(|kept| &kept.fresh).filter(|fresh| fresh.stress.is_some());
    let count = all().count();
    let share = |number: usize| if count == 0 { f64::NAN } else { number as f64 / count as f64 };
    let timed_out = all().filter(|fresh| fresh.ended == TIME).count();
    let crashed = all().filter(|fresh| fresh.ended != TIME && fresh.ended != DONE).count();
    [share(crashed), share(timed_out)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_counted_and_left_out() {
        let fresh = |stress, ended: &str| Fresh { stress: Some(stress), ended: ended.into() };
        let kept = Kept { found: None, fresh: vec![fresh(1.0, "done"), fresh(3.0, "wall"), fresh(5.0, "time")] };
        assert_eq!((kept.mean(true), kept.mean(false)), (Some(1.0), Some(3.0)));
        let lost = Kept { found: None, fresh: vec![Fresh { stress: None, ended: "failed".into() }] };
        assert_eq!((lost.mean(false), ends(&[&lost])[0].is_nan()), (None, true));
        let [crashed, timed_out] = ends(&[&kept, &lost]);
        assert!((crashed - 1.0 / 3.0).abs() < 1e-12 && (timed_out - 1.0 / 3.0).abs() < 1e-12);
    }
}
