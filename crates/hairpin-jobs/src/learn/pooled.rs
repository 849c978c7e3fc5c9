//! The samples of several campaigns as if all were one.
//!
//! A model is tested on trajectories that it has not seen. One that comes again would stand on both sides of that test,
//! so that it tells itself: executed anew it keeps its number, and executed to the same numbers it is refused.

use std::collections::HashMap;

use hairpin::campaign::learn::{LegSample, MoveSample};
use hairpin::campaign::samples::{leg_samples, move_samples};
use hairpin::campaign::scenario::SearchMethod;
use hairpin::campaign::{Case, Run, Setup};
use hairpin::judgement::Stress;
use rayon::prelude::*;

use crate::Problem;
use crate::execute::runs_to_judge;
use crate::work::Work;

/// An executed part of a trajectory.
pub(super) trait Sample: Copy + PartialEq + Send {
    /// Those of one case.
    fn of(setup: &Setup, case: &Case, runs: &[Run], stress: Stress) -> Vec<Self>;

    /// The same of trajectory number `number`.
    fn numbered(self, number: usize) -> Self;
}

impl Sample for LegSample {
    fn of(setup: &Setup, case: &Case, runs: &[Run], stress: Stress) -> Vec<Self> {
        leg_samples(setup, case, runs, stress)
    }

    fn numbered(self, trajectory: usize) -> Self {
        Self { trajectory, ..self }
    }
}

impl Sample for MoveSample {
    fn of(setup: &Setup, case: &Case, runs: &[Run], stress: Stress) -> Vec<Self> {
        move_samples(setup, case, runs, stress)
    }

    fn numbered(self, program: usize) -> Self {
        Self { program, ..self }
    }
}

/// The samples of all of `works`, their trajectories numbered on and together; every folder has some.
pub(super) fn pooled<S: Sample>(works: &[Work], stress: Stress) -> Result<Vec<S>, Problem> {
    let (mut pool, mut before) = (Pool::new(), 0);
    for (place, work) in works.iter().enumerate() {
        if !work.folder.has_cases() {
            return Err(ungenerated(work));
        }
        let cases = work.folder.read_cases()?;
        let of_case = |case: &Case| {
            let runs = runs_to_judge(work, case)?.runs;
            Ok(S::of(&work.setup, case, &runs, stress))
        };
        let samples = cases.par_iter().map(of_case).collect::<Result<Vec<Vec<S>>, Problem>>()?;
        if samples.iter().all(Vec::is_empty) {
            return Err(nothing(work, &cases, !work.folder.has_runs(), stress));
        }
        for (case, samples) in cases.iter().zip(samples) {
            pool.take((place, case), before + case.number.0, samples)
                .map_err(|(first, met)| twice(&works[first], &met, work, &case.id()))?;
        }
        before += cases.iter().map(|case| case.number.0 + 1).max().unwrap_or_default();
    }
    Ok(pool.trajectories.into_iter().flat_map(|trajectory| trajectory.samples).collect())
}

/// Trajectories in the order in which they are met.
struct Pool<S> {
    trajectories: Vec<Trajectory<S>>,
    known: HashMap<Vec<u64>, usize>,
}

/// A trajectory, and all that was executed of it.
struct Trajectory<S> {
    number: usize,
    /// The folder's place and the case that it was met in first.
    met: (usize, String),
    samples: Vec<S>,
}

impl<S: Sample> Pool<S> {
    fn new() -> Self {
        Self { trajectories: Vec::new(), known: HashMap::new() }
    }

    /// Takes the samples of a case in the folder at `place`; `number` is its trajectory's if that is a new one.
    ///
    /// # Errors
    /// Where another folder has it to the same numbers: that folder's place, and the case.
    fn take(&mut self, (place, case): (usize, &Case), number: usize, samples: Vec<S>) -> Result<(), (usize, String)> {
        let at = *self.known.entry(way(case)).or_insert(self.trajectories.len());
        if at == self.trajectories.len() {
            self.trajectories.push(Trajectory { number, met: (place, case.id()), samples: Vec::new() });
        }
        let Trajectory { number, met, samples: before } = &mut self.trajectories[at];
        let samples: Vec<S> = samples.into_iter().map(|sample| sample.numbered(*number)).collect();
        if met.0 != place && is_the_same(before, &samples) {
            return Err(met.clone());
        }
        before.extend(samples);
        Ok(())
    }
}

/// What tells trajectories apart, as in a campaign: their waypoints, to the bit.
fn way(case: &Case) -> Vec<u64> {
    case.waypoints.iter().flat_map(|point| point.coords.iter().map(|coordinate| coordinate.to_bits())).collect()
}

/// Whether one of both says nothing that the other does not.
fn is_the_same<S: Sample>(a: &[S], b: &[S]) -> bool {
    let (few, many) = if a.len() < b.len() { (a, b) } else { (b, a) };
    !few.is_empty() && few.iter().all(|sample| many.contains(sample))
}

fn twice(first: &Work, met: &str, work: &Work, case: &str) -> Problem {
    let first = first.folder.path().display();
    let why =
        format!("case {case} is case {met} of {first}, executed to the same numbers: what it says would count twice");
    Problem::of_file(work.folder.path(), why)
}

fn ungenerated(work: &Work) -> Problem {
    let place = work.folder.path().display();
    Problem::input(format!(
        "{place}: nothing to learn from: no case was generated: hairpin stress SCENARIO --out {place} --resume"
    ))
}

/// What is learned of, in a word.
pub(super) fn what(arm: bool) -> &'static str {
    if arm { "move" } else { "leg" }
}

/// Why a campaign has nothing to learn from.
fn nothing(work: &Work, cases: &[Case], unflown: bool, stress: Stress) -> Problem {
    let (place, arm) = (work.folder.path().display(), work.setup.has_programs());
    let missing = if unflown {
        format!("nothing was executed: hairpin execute {place}")
    } else if !arm && cases.iter().all(|case| case.seen.is_empty()) {
        unseen(work)
    } else {
        format!("{} was measured on none of them", stress.word())
    };
    Problem::input(format!("{place}: no {} to learn from: {missing}", what(arm)))
}

/// Why no search saw the legs of its cases, and what helps.
fn unseen(work: &Work) -> String {
    let scenario = &work.setup.scenario;
    let helps = "give `learn` a campaign whose trajectories are draws of graphs: hairpin stress SCENARIO --out flown --set \
                 generate.search.method=uniform";
    if work.folder.read_tally().is_ok_and(|tally| !tally.missions.is_empty()) {
        format!("its missions were made elsewhere, and no search saw their legs; {helps}")
    } else if scenario.search().method == SearchMethod::Worst {
        format!("the method `worst` proves their legs one by one, and `learn` knows those of graphs; {helps}")
    } else {
        format!("no search saw the legs of its cases; {helps}")
    }
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::CaseNumber;
    use hairpin::campaign::learn::MoveFeatures;
    use nalgebra::Point3;

    use super::*;

    fn case(number: usize, x: f64) -> Case {
        Case::bare(CaseNumber(number), 0, vec![Point3::origin(), Point3::new(x, 0.0, 0.0)])
    }

    fn sample(stress: f64) -> MoveSample {
        let features =
            MoveFeatures { length: 1.0, climb: 0.0, turn: 0.0, speed: 1.0, largest: 0.1, turns: 0.1, duration: 1.0 };
        MoveSample { program: 99, features, stress }
    }

    /// Trajectories of one number are together, so that no test of a model has one on both of its sides.
    #[test]
    fn what_is_executed_anew_is_one_trajectory_and_the_same_numbers_are_refused() {
        let mut pool = Pool::new();
        let mut take = |place: usize, case: &Case, number: usize, stresses: &[f64]| {
            pool.take((place, case), number, stresses.iter().copied().map(sample).collect())
        };
        assert_eq!(take(0, &case(0, 1.0), 0, &[0.1, 0.2]), Ok(()));
        assert_eq!(take(0, &case(1, 2.0), 1, &[0.3]), Ok(()));
        assert_eq!(take(0, &case(2, 1.0), 2, &[0.1]), Ok(()), "one campaign's own draws");
        assert_eq!(take(1, &case(0, 1.0), 3, &[0.15, 0.2]), Ok(()), "executed anew");
        let copies: [&[f64]; 2] = [&[0.3], &[0.3, 0.31]];
        for copy in copies {
            assert_eq!(take(1, &case(1, 2.0), 4, copy), Err((0, "0001".into())));
        }
        assert_eq!(take(1, &case(5, 3.0), 8, &[0.3]), Ok(()));
        let all = pool.trajectories.iter().flat_map(|trajectory| &trajectory.samples);
        let told: Vec<(usize, f64)> = all.map(|sample| (sample.program, sample.stress)).collect();
        assert_eq!(told, [(0, 0.1), (0, 0.2), (0, 0.1), (0, 0.15), (0, 0.2), (1, 0.3), (8, 0.3)]);
    }
}
