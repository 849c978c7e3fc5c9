//! Figure 8: per controller, the largest deviation with each score relative to uniform feasible trajectories; and beyond it,
//! executions in the loop and waypoints moved freely.
//!
//! Every trajectory comes from a graph of its own (one best per graph), no waypoint is used twice on either side, and what is told are
//! fresh runs with noise, which no search has seen.

mod kinds;
mod lifts;
mod size;
mod ways;

use std::borrow::Cow;
use std::collections::HashMap;

use hairpin::campaign::experiment::lift::{Flown, lift};
use hairpin::campaign::learn::ScoreModel;
use hairpin::campaign::{Case, Optimum};
use hairpin::judgement::Stress;
use hairpin::math::random::named_seed;
use hairpin_formats::experiment::Sheet;
use hairpin_formats::figure::{Cell, Table};

use super::super::{Outcome, go_on};
use super::cell::{self, FLIGHT_GOGGLES, Set, text, with};
use crate::problem::Problem;
use kinds::Kind;
use lifts::{Measured, figure, figure_name, summary};
use size::{Printed, Size};
use ways::{Finds, Way, base, by_hand, sampling, ways};

/// The worst of many uniform trajectories, each executed once without noise.
fn ceiling(size: &Size, base: &[Set]) -> Result<Option<f64>, Problem> {
    if size.ceiling == 0 {
        return Ok(None);
    }
    let sets = [
        ("generate.search.method", text("uniform")),
        ("generate.search.cases", size.ceiling.to_string()),
        ("generate.search.per_graph", size.ceiling.div_ceil(size.graphs).to_string()),
    ];
    let setup = cell::setup(FLIGHT_GOGGLES, &with(base, &sets), None)?;
    let [flown] = cell::flown(&setup, &cell::cases(&setup)?, [Stress::MaxDeviation])?;
    Ok(flown.stresses.into_iter().reduce(f64::max))
}

/// The optima of the scores by hand called `names`, or of `model`, in the graphs of `base`.
fn optima(base: &[Set], size: &Size, names: &[&str], model: Option<&ScoreModel>) -> Result<Vec<Optimum>, Problem> {
    cell::optima(&cell::setup(FLIGHT_GOGGLES, &with(base, &[sampling(size)]), model)?, names)
}

/// Per controller, the largest deviation with each score relative to no score, beside the paper's.
pub(in super::super) fn scores(sheet: &Sheet) -> Result<Outcome, Problem> {
    let (size, printed): (Size, Printed) = (sheet.size()?, sheet.printed()?);
    let mut rows = Table::new(&[
        "reach",
        "controller",
        "way",
        "trajectories",
        "mean_m",
        "median_m",
        "lift_percent",
        "low_percent",
        "high_percent",
        "over_random_beam_percent",
        "crashed_percent",
        "timed_out_percent",
        "ceiling_m",
    ]);
    let mut quality = Table::new(&[
        "reach",
        "controller",
        "legs",
        "degree",
        "penalty",
        "r2",
        "held_out_r2",
        "held_out_error_m",
        "held_out_rank",
    ]);
    let ways = ways(&size);
    let mut measured = Vec::new();
    for reach in &size.reach {
        let mut controllers = Vec::new();
        // Cases by way, of the ways that find the same for every controller.
        let mut shared: HashMap<&str, Vec<Case>> = HashMap::new();
        let by_hand = match size.controllers.first().filter(|_| size.kinds.contains(&Kind::ByHand)) {
            Some(any) => optima(&base(&size, reach, any), &size, &by_hand(), None)?,
            None => Vec::new(),
        };
        for controller in &size.controllers {
            go_on()?;
            let base = base(&size, reach, controller);
            let judge = cell::with_noise(FLIGHT_GOGGLES, &base, size.runs)?;
            let model = match ways.iter().any(|way| way.learned) {
                true => {
                    let base = with(&base, &[sampling(&size)]);
                    Some(cell::learned(FLIGHT_GOGGLES, &base, size.training, size.seed)?)
                }
                false => None,
            };
            if let Some(model) = &model {
                quality.push(vec![
                    reach.as_str().into(),
                    controller.as_str().into(),
                    model.legs.into(),
                    (model.polynomial.degree as usize).into(),
                    model.polynomial.penalty.into(),
                    model.validation.r2.into(),
                    model.held_out.r2.into(),
                    model.held_out.rmse.into(),
                    model.held_out.rank_correlation.into(),
                ]);
            }
            let learned = match size.kinds.contains(&Kind::Learned) {
                true => optima(&base, &size, &[], model.as_ref())?,
                false => Vec::new(),
            };
            let ceiling = ceiling(&size, &base)?;
            let mut flown: Vec<(&Way, Flown)> = Vec::new();
            for way in &ways {
                go_on()?;
                let cases = match &way.finds {
                    Finds::Optimum { score, aggregate } => {
                        let optima = if way.learned { &learned } else { &by_hand };
                        let own = |found: &&Optimum| found.score == *score && found.aggregate == *aggregate;
                        Cow::Borrowed(optima.iter().find(own).map_or(&[][..], |found| &found.cases))
                    }
                    Finds::Keys(sets) => match shared.get(&*way.name) {
                        Some(cases) => Cow::Borrowed(&**cases),
                        None => {
                            let model = model.as_ref().filter(|_| way.learned);
                            Cow::Owned(cell::cases(&cell::setup(FLIGHT_GOGGLES, &with(&base, sets), model)?)?)
                        }
                    },
                };
                let [came_to] = cell::flown(&judge, &cases, [Stress::MaxDeviation])?;
                if let (Cow::Owned(cases), false) = (cases, way.kind.knows_controller()) {
                    shared.insert(&way.name, cases);
                }
                flown.push((way, came_to));
            }
            let (uniform, beam) = (flown[0].1.stresses.clone(), flown[1].1.stresses.clone());
            let mut lifts = Vec::new();
            for (number, (way, came_to)) in flown.iter().enumerate() {
                let seed = named_seed(size.seed, "bootstrap", number as u64);
                let over = lift(&came_to.stresses, &uniform, seed);
                let over_beam = lift(&came_to.stresses, &beam, seed);
                lifts.push((way.kind, over));
                rows.push(vec![
                    reach.as_str().into(),
                    controller.as_str().into(),
                    way.name.as_str().into(),
                    came_to.stresses.len().into(),
                    came_to.mean().into(),
                    came_to.median().into(),
                    (100.0 * over.value).into(),
                    (100.0 * over.interval[0]).into(),
                    (100.0 * over.interval[1]).into(),
                    (100.0 * over_beam.value).into(),
                    (100.0 * came_to.crashed).into(),
                    (100.0 * came_to.timed_out).into(),
                    if number == 0 { ceiling.into() } else { Cell::Empty },
                ]);
            }
            controllers.push((controller.clone(), lifts));
        }
        measured.push(Measured { reach: reach.clone(), controllers });
    }
    let summary = summary(&size, &printed, &measured);
    let figures = measured.iter().map(|measured| (figure_name(&measured.reach), figure(measured, &printed))).collect();
    let notes = vec![
        format!(
            "Deviation from `{}`, length {}, {} graphs a cell, each trajectory flown {} times with noise; lifts are of means over uniform \
             feasible trajectories, with 95 % bootstrap intervals; scores are learned from {} executions in other graphs.",
            size.from, size.length, size.graphs, size.runs, size.training
        ),
        format!(
            "A graph has {} waypoints, {} where it is searched and uniform under the baselines; none is used twice, on either side. Minimum \
             snap has times by the square root of the leg's length.",
            size.waypoints, size.sampling
        ),
    ];
    Ok(Outcome { tables: vec![("summary", summary), ("lifts", rows), ("models", quality)], figures, notes })
}
