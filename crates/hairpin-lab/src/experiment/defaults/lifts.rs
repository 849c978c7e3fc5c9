//! From records to lifts.

use hairpin::judgement::holm;
use hairpin::math::random::named_seed;

use super::record::{CellRecord, Kept, RunRecord, ends};
use super::statistics::{Lift, Sides, a12, exceeded_by, geometric_mean, interval, lift, middle, resampled};
use super::ways::Way;

/// Share of random trajectories that break the limit whose first violation is told.
const BREAK: f64 = 0.05;

/// What all cells came to.
#[derive(Debug)]
pub(super) struct Lifts {
    pub(super) cells: Vec<CellLifts>,
    pub(super) means: Vec<Mean>,
}

/// What one cell came to.
#[derive(Debug)]
pub(super) struct CellLifts {
    pub(super) name: String,
    pub(super) drawn_how: String,
    /// Random trajectories, each by itself.
    pub(super) single: Side,
    /// The best of as many random executions.
    pub(super) best: Side,
    /// How many those are, at most.
    pub(super) best_of: usize,
    pub(super) ways: Vec<WayLifts>,
    /// The default over other ways.
    pub(super) behind: Vec<(Way, Option<Lift>)>,
    /// Default runs ahead of ten times their executions by chance, and of how many.
    pub(super) pairs: [usize; 2],
    /// Median number of the first execution that breaks the limit: the default's, and by chance; infinite: never.
    pub(super) first_violation: Option<[f64; 2]>,
    /// Processor time of the default search over that of as many random executions, and of what it kept.
    pub(super) cost: Option<[f64; 2]>,
}

/// What one side came to.
#[derive(Debug)]
pub(super) struct Side {
    /// Geometric mean of its cases.
    pub(super) level: f64,
    pub(super) cases: usize,
    /// Shares of crashes and of time-outs.
    pub(super) ends: [f64; 2],
}

/// What one way came to.
#[derive(Debug)]
pub(super) struct WayLifts {
    pub(super) way: Way,
    pub(super) side: Side,
    /// Executions for a case.
    pub(super) executions: f64,
    pub(super) over_best: Option<Lift>,
    /// Over flights that end by themselves alone.
    pub(super) over_best_ended: Option<Lift>,
    pub(super) over_single: Option<Lift>,
    pub(super) over_single_ended: Option<Lift>,
    /// The chance that a case of its is ahead of a best one.
    pub(super) a12: f64,
    /// Of `over_best`, Holm over all cells.
    pub(super) p: Option<f64>,
    pub(super) refused: Option<String>,
}

/// The mean of the lifts of several cells.
#[derive(Debug)]
pub(super) struct Mean {
    pub(super) name: String,
    pub(super) cells: usize,
    pub(super) way: Way,
    /// Over single random trajectories: the lift and its interval.
    pub(super) over_single: [f64; 3],
    /// The same over flights that end by themselves.
    pub(super) over_single_ended: [f64; 3],
}

/// Some of what a run kept.
type Part<'a> = &'a dyn Fn(&RunRecord) -> &[Kept];

impl Lifts {
    /// What `records` come to; `seed` draws the resamples.
    pub(super) fn of(records: &[CellRecord], seed: u64) -> Self {
        let mut cells: Vec<CellLifts> = records.iter().map(|record| of_cell(record, seed)).collect();
        for way in [Way::Cmaes, Way::InLoop, Way::InLoopMoves, Way::WorstInGraph, Way::Worst] {
            let own = cells.iter_mut().flat_map(|cell| &mut cell.ways).filter(|own| own.way == way);
            let mut own: Vec<(&mut WayLifts, f64)> =
                own.filter_map(|own| own.over_best.map(|lift| lift.p).map(|p| (own, p))).collect();
            let p: Vec<f64> = own.iter().map(|(_, p)| *p).collect();
            own.iter_mut().zip(holm(&p)).for_each(|((own, _), p)| own.p = Some(p));
        }
        Self { cells, means: means(records, seed) }
    }
}

fn of_cell(record: &CellRecord, seed: u64) -> CellLifts {
    let runs = &record.runs;
    let seed = named_seed(seed, &record.settings.cell, 1);
    let best: Part = &|run| &run.best;
    let single: Part = &|run| &run.single;
    let over = |part: Part, other: Part, ended: bool| lift(&sides(runs, part, other, ended), seed);
    let way = |way: Way| {
        let own = of(way);
        let records = || runs.iter().flat_map(|run| &run.ways).filter(|own| own.way == way);
        let cases = records().map(|own| own.kept.len()).sum::<usize>();
        WayLifts {
            way,
            side: side(runs, &own),
            executions: records().map(|own| own.executions).sum::<u64>() as f64 / cases.max(1) as f64,
            over_best: over(&own, best, false),
            over_best_ended: over(&own, best, true),
            over_single: over(&own, single, false),
            over_single_ended: over(&own, single, true),
            a12: a12(&values(runs, &own), &values(runs, best)),
            p: None,
            refused: records().find_map(|own| own.refused.clone()),
        }
    };
    let measured: Vec<Way> = runs.first().map_or_else(Vec::new, |run| run.ways.iter().map(|own| own.way).collect());
    let others = measured.iter().copied().filter(|way| *way != Way::Worst);
    let behind = others.map(|other| (other, over(&of(Way::Worst), &of(other), false))).collect();
    let pairs = || record.pairs.iter().flatten();
    let ahead = pairs().filter(|pair| pair.worst.mean(false) > pair.chance.mean(false)).count();
    CellLifts {
        name: record.settings.cell.clone(),
        drawn_how: record.drawn_how.clone(),
        single: side(runs, single),
        best: side(runs, best),
        best_of: runs.iter().map(|run| run.best_of).max().unwrap_or(0),
        ways: measured.into_iter().map(way).collect(),
        behind,
        pairs: [ahead, pairs().count()],
        first_violation: first_violation(runs),
        cost: cost(runs),
    }
}

/// What `way` kept in each run.
fn of(way: Way) -> impl Fn(&RunRecord) -> &[Kept] {
    move |run| kept_by(run, way)
}

/// What `way` kept in `run`.
fn kept_by(run: &RunRecord, way: Way) -> &[Kept] {
    run.ways.iter().find(|own| own.way == way).map_or(&[], |own| &own.kept)
}

/// Means of fresh executions, run by run, of two parts.
fn sides(runs: &[RunRecord], part: Part, other: Part, ended: bool) -> Vec<Sides> {
    let means = |kept: &[Kept]| kept.iter().filter_map(|kept| kept.mean(ended)).collect();
    runs.iter().map(|run| [means(part(run)), means(other(run))]).collect()
}

fn values(runs: &[RunRecord], part: Part) -> Vec<f64> {
    runs.iter().flat_map(part).filter_map(|kept| kept.mean(false)).collect()
}

fn side(runs: &[RunRecord], part: Part) -> Side {
    let values = values(runs, part);
    let kept: Vec<&Kept> = runs.iter().flat_map(part).collect();
    Side { level: geometric_mean(&values), cases: values.len(), ends: ends(&kept) }
}

/// Medians over runs, each with the limit that 5 % of its own random executions break.
fn first_violation(runs: &[RunRecord]) -> Option<[f64; 2]> {
    let of_run = |run: &RunRecord| -> Option<[f64; 2]> {
        let measured: Vec<f64> = run.uniform.iter().flatten().copied().collect();
        let limit = exceeded_by(&measured, BREAK)?;
        let own = run.ways.iter().find(|own| own.way == Way::Worst && !own.rises.is_empty())?;
        let breaks = own.rises.iter().find(|(_, stress)| *stress > limit);
        let by_chance = run.uniform.iter().position(|stress| stress.is_some_and(|stress| stress > limit));
        let places = [breaks.map(|(at, _)| *at as f64), by_chance.map(|place| place as f64 + 1.0)];
        Some(places.map(|at| at.unwrap_or(f64::INFINITY)))
    };
    let all: Vec<[f64; 2]> = runs.iter().filter_map(of_run).collect();
    let [own, by_chance] = [0, 1].map(|side| middle(all.iter().map(|both| both[side]).collect()));
    Some([own?, by_chance?])
}

/// Medians over runs.
fn cost(runs: &[RunRecord]) -> Option<[f64; 2]> {
    let all: Vec<_> = runs.iter().filter_map(|run| run.cost).filter(|cost| cost.uniform.min(cost.kept) > 0.0).collect();
    let uniform = middle(all.iter().map(|cost| cost.search / cost.uniform).collect())?;
    Some([uniform, middle(all.iter().map(|cost| cost.search / cost.kept).collect())?])
}

/// The means that cells are part of, for each way that all of them measured.
fn means(records: &[CellRecord], seed: u64) -> Vec<Mean> {
    let mut means = Vec::new();
    let mut names: Vec<&String> = records.iter().filter_map(|record| record.mean.as_ref()).collect();
    names.dedup();
    for name in names {
        let own: Vec<&CellRecord> = records.iter().filter(|record| record.mean.as_ref() == Some(name)).collect();
        for way in [Way::WorstInGraph, Way::Worst] {
            let mean = |ended: bool| -> Option<[f64; 3]> {
                let of = |record: &&CellRecord| {
                    let runs = sides(&record.runs, &|run| kept_by(run, way), &|run| &run.single, ended);
                    let seed = named_seed(seed, &record.settings.cell, 2);
                    Some((lift(&runs, seed)?.value, resampled(&runs, seed)))
                };
                let lifts: Vec<(f64, Vec<f64>)> = own.iter().map(of).collect::<Option<_>>()?;
                let count = lifts.len() as f64;
                let draws = lifts.iter().map(|(_, draws)| draws.len()).min()?;
                let drawn = |draw: usize| lifts.iter().map(|(_, draws)| draws[draw]).sum::<f64>() / count;
                let [low, high] = interval((0..draws).map(drawn).collect());
                Some([lifts.iter().map(|(value, _)| value).sum::<f64>() / count, low, high])
            };
            if let (Some(over_single), Some(over_single_ended)) = (mean(false), mean(true)) {
                means.push(Mean { name: name.clone(), cells: own.len(), way, over_single, over_single_ended });
            }
        }
    }
    means
}

#[cfg(test)]
mod tests {
    use super::super::record::{Cost, Fresh, WayRecord};
    use super::*;

    fn kept(stress: f64) -> Kept {
        Kept { found: Some(stress), fresh: vec![Fresh { stress: Some(stress), ended: "done".into() }] }
    }

    #[test]
    fn first_violations_and_costs_are_medians_over_runs() {
        let uniform: Vec<Option<f64>> = (1..=40).map(|i| Some(f64::from(i))).collect();
        let own = |rises: Vec<(u64, f64)>| WayRecord {
            way: Way::Worst,
            executions: 40,
            kept: vec![kept(50.0)],
            rises,
            refused: None,
        };
        let cost = Some(Cost { search: 2.0, uniform: 1.0, kept: 4.0 });
        let run = |rises| RunRecord { uniform: uniform.clone(), ways: vec![own(rises)], cost, ..RunRecord::default() };
        // The limit is 38, which the 39th is the first to break.
        let runs = [run(vec![(1, 3.0), (7, 38.5)]), run(vec![(2, 39.0)]), run(vec![(1, 1.0)])];
        assert_eq!(first_violation(&runs), Some([7.0, 39.0]));
        assert_eq!(super::cost(&runs), Some([2.0, 0.5]));
        assert_eq!(first_violation(&[]), None);
    }
}
