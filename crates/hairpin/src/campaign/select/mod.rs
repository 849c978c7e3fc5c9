//! A few of many cases: the most stressful, the most different ones, or those that exercise most.
//!
//! The most stressful trajectory and 99 near copies of it are one test. How far two cases are apart is the mean of how
//! far their ways are apart and how far what came of them is, each 0 … 1 over the campaign.
//!
//! | choice | maximises | known of it |
//! | --- | --- | --- |
//! | stress | stress, the worst first | the best |
//! | diverse | ½ stress + distance, over pairs | at least half of the best |
//! | coverage | cells that are met | at least 1 − 1/e of the best |
//!
//! What ended badly is worse than all that ended well, in the order of reports; where stress is weighed it counts as
//! much as the largest. Of what ended well the largest deviation counts alone, whatever limits were broken.

mod greedy;

use std::cmp::Ordering;
use std::collections::BTreeSet;

use serde::Serialize;

use super::gravity::Standing;
use super::{Case, CaseNumber, CaseResult};
use crate::judgement::Measures;
use crate::search::worst::{Crowd, Placed, Scale, Trace};
use crate::trajectory::Route;

/// What a choice is for.
///
/// All three are deterministic; ties go to the first candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum By {
    /// The most stressful.
    Stress,
    /// Stress and distance from each other.
    Diverse,
    /// Cells of the grid of motion that are met.
    Coverage,
}

impl By {
    /// What is known of how good a choice is.
    pub fn guarantee(self) -> &'static str {
        match self {
            Self::Stress => "the best there is",
            Self::Diverse => {
                "greedy: mean stress plus mean distance at least half of the best (Borodin, Lee, Ye 2012: max-sum dispersion in a \
                 metric)"
            }
            Self::Coverage => {
                "greedy: at least 63 % of the most cells (Nemhauser, Wolsey, Fisher 1978: maximum coverage)"
            }
        }
    }
}

/// A case to choose from.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Its number.
    pub case: CaseNumber,
    /// Its largest deviation over all runs, m, or where it was not executed its score.
    ///
    /// Executed cases without measures count by their score as well.
    pub stress: f64,
    /// Where it stands by what came of it; `None` where nothing was measured.
    standing: Option<Standing>,
    /// Its way, and what came of it; that is empty where it was not executed.
    trace: Trace,
    /// Cells of the grid of motion that it met.
    ///
    /// By their numbers in the grid; read for a choice by coverage alone.
    pub cells: BTreeSet<usize>,
}

impl Candidate {
    /// The candidate that `case` is, with what its worst run came to and the cells that it met.
    ///
    /// `case` has at least one waypoint.
    pub fn new(case: &Case, result: Option<&CaseResult>, cells: BTreeSet<usize>) -> Self {
        let measures = result.and_then(CaseResult::measured);
        Self {
            case: case.number,
            stress: measures.map_or(case.score, |measures| measures.max_deviation),
            standing: result.filter(|result| result.measures.is_some()).map(Standing::of),
            trace: Trace {
                route: Route::along(&case.waypoints),
                behaviour: measures.map_or_else(Vec::new, Measures::behaviour),
            },
            cells,
        }
    }

    /// Whether its worst run crashed, or ended short of its last waypoint: its deviation was cut off there.
    pub fn ended_badly(&self) -> bool {
        self.standing.as_ref().is_some_and(Standing::ended_badly)
    }

    /// Greater is worse.
    fn against(&self, other: &Self) -> Ordering {
        let by_runs = match (&self.standing, &other.standing) {
            (Some(one), Some(other)) if one.ended_badly() && other.ended_badly() => one.against(other),
            (Some(one), Some(other)) => one.ended_badly().cmp(&other.ended_badly()),
            (one, other) => one.is_some().cmp(&other.is_some()),
        };
        by_runs.then(self.stress.total_cmp(&other.stress))
    }
}

/// Whether all of `candidates` were executed and measured: their stress is a deviation, m, then.
///
/// One that was not makes all of them compared by their ways alone.
pub fn measured(candidates: &[Candidate]) -> bool {
    candidates.iter().all(|candidate| !candidate.trace.behaviour.is_empty())
}

/// How stressful cases are and how far apart, each 0 … 1 over all of them. Distances are computed where they are asked
/// for: those of all pairs of ten thousand cases would take a gigabyte.
///
/// Stress and distances are relative to the candidates given: two campaigns' choices are not on one scale.
#[derive(Debug, Clone)]
pub struct Choice<'a> {
    candidates: &'a [Candidate],
    stress: Vec<f64>,
    crowd: Crowd,
}

/// How good a choice is.
///
/// To compare choices of one [`Choice`] with each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    /// Cases.
    pub cases: usize,
    /// Mean of the cases' stress in its own unit.
    pub stress: f64,
    /// Largest of them.
    ///
    /// Negative infinity of no case.
    pub worst: f64,
    /// How many of them crashed, or ended short of their last waypoints: their deviations end there too.
    pub ended_badly: usize,
    /// Mean distance between two cases, 0 … 1.
    pub spread: f64,
    /// Least distance between two cases.
    ///
    /// 0 where there are fewer than two.
    pub nearest: f64,
    /// Cells of the grid of motion that are met; `None` where nothing was executed, which alone meets cells.
    pub cells: Option<usize>,
}

impl<'a> Choice<'a> {
    /// Among `candidates`.
    ///
    /// O(n²) comparisons of outlines on all threads, O(n) memory. The stress of each is (s − min) / (max − min); 1 of
    /// what ended badly.
    pub fn new(candidates: &'a [Candidate]) -> Self {
        let mut stress = unit(&candidates.iter().map(|c| c.stress).collect::<Vec<_>>());
        for (stress, candidate) in stress.iter_mut().zip(candidates) {
            *stress = if candidate.ended_badly() { 1.0 } else { *stress };
        }
        let traces: Vec<Trace> = candidates.iter().map(|c| c.trace.clone()).collect();
        let scale = Scale::of(&traces);
        let placed: Vec<Placed> = traces.iter().map(|trace| scale.place(trace)).collect();
        Self { candidates, stress, crowd: Crowd::new(&scale, &placed) }
    }

    /// `count` of the candidates, as their places in the list, in the order in which they are chosen.
    ///
    /// At most as many as there are. [`By::guarantee`] says how good they are.
    pub fn best(&self, count: usize, by: By) -> Vec<usize> {
        match by {
            By::Stress => {
                let mut order: Vec<usize> = (0..self.candidates.len()).collect();
                // The first of equals.
                order.sort_by(|a, b| self.candidates[*b].against(&self.candidates[*a]));
                order.truncate(count);
                order
            }
            By::Diverse => greedy::dispersed(&self.stress, |one| self.crowd.from(one), count),
            By::Coverage => {
                let cells: Vec<&BTreeSet<usize>> = self.candidates.iter().map(|candidate| &candidate.cells).collect();
                greedy::covering(&cells, &self.stress, count)
            }
        }
    }

    /// How good a choice of places is.
    ///
    /// Of places as [`Self::best`] gives them, which met so many `cells`; O(k²) comparisons for k of them.
    pub fn measure(&self, chosen: &[usize], cells: Option<usize>) -> Measured {
        let stress = || chosen.iter().map(|place| self.candidates[*place].stress);
        // All of them are not gathered anew: that would take as much memory again.
        let are_all = chosen.iter().copied().eq(0..self.candidates.len());
        let (spread, nearest) = if are_all { self.crowd.spread() } else { self.crowd.some(chosen).spread() };
        Measured {
            cases: chosen.len(),
            stress: if chosen.is_empty() { 0.0 } else { stress().sum::<f64>() / chosen.len() as f64 },
            worst: stress().fold(f64::NEG_INFINITY, f64::max),
            ended_badly: chosen.iter().filter(|place| self.candidates[**place].ended_badly()).count(),
            spread,
            nearest,
            cells,
        }
    }
}

/// `values` as shares of their range; all 0 where they are equal.
fn unit(values: &[f64]) -> Vec<f64> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let range = values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low;
    values.iter().map(|value| if range > 0.0 { (value - low) / range } else { 0.0 }).collect()
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::campaign::Status;

    fn candidate(case: usize, stress: f64, x: f64, cells: &[usize]) -> Candidate {
        let way = [Point3::origin(), Point3::new(x, 1.0, 0.0), Point3::new(2.0 * x, 0.0, 0.0)];
        Candidate {
            case: CaseNumber(case),
            stress,
            standing: None,
            trace: Trace { route: Route::along(&way), behaviour: vec![stress, x] },
            cells: cells.iter().copied().collect(),
        }
    }

    #[test]
    fn near_copies_are_one_test() {
        // Five near copies of the most stressful, and two others.
        let mut all: Vec<Candidate> =
            (0..5).map(|i| candidate(i, 1.0 - 0.01 * i as f64, 1.0 + 0.001 * i as f64, &[1])).collect();
        all.push(candidate(5, 0.6, 5.0, &[2, 3]));
        all.push(candidate(6, 0.5, -5.0, &[3, 4, 5]));
        let choice = Choice::new(&all);
        assert_eq!(choice.best(3, By::Stress), [0, 1, 2]);
        let mut diverse = choice.best(3, By::Diverse);
        diverse.sort_unstable();
        assert!(diverse[0] < 5 && diverse[1..] == [5, 6], "{diverse:?}");
        let (alike, apart) = (choice.measure(&[0, 1, 2], Some(1)), choice.measure(&diverse, Some(5)));
        assert!(apart.spread > 3.0 * alike.spread && apart.stress < alike.stress && alike.nearest < 0.02);
        assert_eq!(choice.best(2, By::Coverage), [6, 0]);
        assert_eq!(choice.best(99, By::Diverse).len(), 7);
    }

    /// Crashes end early, and so with small deviations.
    #[test]
    fn what_ended_badly_is_worse_than_all_that_ended_well() {
        let result = |number: usize, ended: &str, max_deviation| CaseResult {
            measures: Some(Measures { max_deviation, ..Measures::default() }),
            ended: ended.into(),
            ..CaseResult::bare(CaseNumber(number), Status::Unjudged)
        };
        let results = [("done", 2.0), ("wall", 0.1), ("done", 1.0), ("time", 0.2), ("done", 3.0)];
        let all: Vec<Candidate> = (0..)
            .zip(results)
            .map(|(number, (ended, deviation))| {
                let case = Case::bare(CaseNumber(number), 1, vec![Point3::origin(), Point3::new(1.0, 0.0, 0.0)]);
                Candidate::new(&case, Some(&result(number, ended, deviation)), BTreeSet::new())
            })
            .collect();
        let choice = Choice::new(&all);
        assert_eq!(choice.best(5, By::Stress), [3, 1, 4, 0, 2]);
        assert_eq!((choice.measure(&[3, 1], None).ended_badly, choice.measure(&[4, 0], None).ended_badly), (2, 0));
        // Alone, what weighs most is chosen.
        assert_eq!(choice.best(1, By::Diverse), [1]);
    }
}
