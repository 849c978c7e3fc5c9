//! Draws, executions and fresh executions in one cell: what all sides have alike.

use hairpin::campaign::generate::Space;
use hairpin::campaign::judge::measures_of;
use hairpin::campaign::{Case, Setup, execute_again, execute_run};
use hairpin::judgement::Stress;
use hairpin_formats::scenario::setup_for;
use hairpin_jobs::{Problem, Watch};
use rayon::prelude::*;

use super::record::{Fresh, Kept};
use super::size::Cell;
use crate::experiment::watched::go_on;

/// Draws that are tried for one that is feasible.
const TRIES: u64 = 50;
/// Draws between two questions whether to go on.
const BATCH: u64 = 64;

/// The scenario of `cell` under `seed` with `more` keys.
pub(super) fn setup(cell: &Cell, seed: u64, more: &[(&str, String)]) -> Result<Setup, Problem> {
    let mut sets = cell.sets.clone();
    // Numbers in TOML have a sign.
    sets.push(("seed".into(), (seed >> 1).to_string()));
    sets.extend(more.iter().map(|(key, value)| ((*key).to_owned(), value.clone())));
    Ok(setup_for(&cell.scenario, &sets)?)
}

/// Executes the trajectories of one setup.
#[derive(Clone, Copy)]
pub(super) struct Field<'a> {
    pub(super) setup: &'a Setup,
    pub(super) stress: Stress,
    /// Fresh executions of what is kept.
    pub(super) fresh: usize,
}

/// Random trajectories that were executed.
#[derive(Debug, Default, Clone)]
pub(super) struct Drawn {
    /// Number of the graph that each was drawn from.
    pub(super) graphs: Vec<u64>,
    /// What each came to, nominally.
    pub(super) stresses: Vec<Option<f64>>,
}

impl Drawn {
    /// Place of the most stressful one among those from `first` on, `count` at most; `None` where none was measured.
    pub(super) fn most(&self, first: usize, count: usize) -> Option<usize> {
        let last = self.stresses.len().min(first + count);
        let measured = (first..last).filter_map(|place| Some((place, self.stresses[place]?)));
        measured.reduce(|most, one| if one.1 > most.1 { one } else { most }).map(|(place, _)| place)
    }
}

impl Field<'_> {
    /// What `case` comes to in its nominal execution.
    pub(super) fn nominal(&self, case: &Case) -> Option<f64> {
        let measures = measures_of(self.setup, case, &execute_run(self.setup, case, 0))?;
        self.stress.of(&measures).filter(|stress| stress.is_finite())
    }

    /// `case` with what it comes to in fresh executions, under noise and with values of `[vary]` that no search saw.
    pub(super) fn kept(&self, case: &Case) -> Kept {
        let again = |number: usize| {
            let run = execute_again(self.setup, case, 1 + number, number);
            let measures = measures_of(self.setup, case, &run);
            let stress = measures.and_then(|measures| self.stress.of(&measures)).filter(|stress| stress.is_finite());
            Fresh { stress, ended: run.outcome.map_or("failed", |flight| flight.ended.word()).to_owned() }
        };
        Kept { found: self.nominal(case), fresh: (0..self.fresh).map(again).collect() }
    }

    /// The same of many.
    pub(super) fn all_kept(&self, cases: &[Case], watch: &dyn Watch) -> Result<Vec<Kept>, Problem> {
        go_on(watch)?;
        Ok(cases.par_iter().map(|case| self.kept(case)).collect())
    }

    /// `wanted` random trajectories of `space`, from graph number `first` on, each executed nominally.
    ///
    /// # Errors
    /// None can be drawn.
    pub(super) fn drawn(&self, space: &Space, first: u64, wanted: usize, watch: &dyn Watch) -> Result<Drawn, Problem> {
        let mut drawn = Drawn::default();
        let (mut next, last) = (first, first + TRIES * wanted as u64);
        let mut why = String::from("no trajectory was drawn");
        while drawn.graphs.len() < wanted && next < last {
            go_on(watch)?;
            let count = BATCH.min((wanted - drawn.graphs.len()) as u64);
            let flown: Vec<_> = (next..next + count)
                .into_par_iter()
                .map(|graph| space.draw(graph, 0).map(|case| (graph, self.nominal(&case))))
                .collect();
            next += count;
            for one in flown {
                match one {
                    Ok((graph, stress)) => {
                        drawn.graphs.push(graph);
                        drawn.stresses.push(stress);
                    }
                    Err(reason) => why = reason,
                }
            }
        }
        if drawn.stresses.iter().all(Option::is_none) { Err(Problem::input(why)) } else { Ok(drawn) }
    }
}
