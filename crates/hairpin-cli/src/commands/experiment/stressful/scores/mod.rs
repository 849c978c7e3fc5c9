//! Figure 8: per controller, the largest deviation with each score relative to uniform feasible trajectories; and beyond it,
//! executions in the loop and waypoints moved freely.
//!
//! Every trajectory comes from a graph of its own (one best per graph), no waypoint is used twice on either side, and what is told are
//! fresh runs with noise, which no search has seen.

mod kinds;
mod lifts;
mod size;
mod tables;
mod ways;

use std::borrow::Cow;
use std::collections::HashMap;

use hairpin::campaign::experiment::lift::Flown;
use hairpin::campaign::learn::ScoreModel;
use hairpin::campaign::{Case, Optimum};
use hairpin::judgement::Stress;
use hairpin_formats::experiment::Sheet;

use super::super::{Outcome, go_on};
use super::cell::{self, FLIGHT_GOGGLES, Set, text, with};
use crate::problem::Problem;
use kinds::Kind;
use lifts::{Measured, figure, summary};
use size::{Graphs, Printed, Size};
use tables::Tables;
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
fn optima(base: &[Set], graphs: &Graphs, names: &[&str], model: Option<&ScoreModel>) -> Result<Vec<Optimum>, Problem> {
    cell::optima(&cell::setup(FLIGHT_GOGGLES, &with(base, &[sampling(graphs)]), model)?, names)
}

/// What every way comes to in `graphs`, under each controller.
fn measure(size: &Size, graphs: Graphs, tables: &mut Tables) -> Result<Measured, Problem> {
    let ways = ways(size, &graphs);
    let mut controllers = Vec::new();
    // Cases by way, of the ways that find the same for every controller.
    let mut shared: HashMap<&str, Vec<Case>> = HashMap::new();
    let by_hand = match size.controllers.first().filter(|_| size.kinds.contains(&Kind::ByHand)) {
        Some(any) => optima(&base(size, &graphs, any), &graphs, &by_hand(), None)?,
        None => Vec::new(),
    };
    for controller in &size.controllers {
        go_on()?;
        let base = base(size, &graphs, controller);
        let judge = cell::with_noise(FLIGHT_GOGGLES, &base, size.runs)?;
        let model = match ways.iter().any(|way| way.learned) {
            true => {
                let base = with(&base, &[sampling(&graphs)]);
                Some(cell::learned(FLIGHT_GOGGLES, &base, size.training, size.seed)?)
            }
            false => None,
        };
        if let Some(model) = &model {
            tables.learned(&graphs, controller, model);
        }
        let learned = match size.kinds.contains(&Kind::Learned) {
            true => optima(&base, &graphs, &[], model.as_ref())?,
            false => Vec::new(),
        };
        let ceiling = ceiling(size, &base)?;
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
        let lifts = tables.flown(size, &graphs, controller, &flown, ceiling);
        controllers.push((controller.clone(), lifts));
    }
    Ok(Measured { graphs, controllers })
}

/// Per controller, the largest deviation with each score relative to no score, beside the paper's.
pub(in super::super) fn scores(sheet: &Sheet) -> Result<Outcome, Problem> {
    let (size, printed): (Size, Printed) = (sheet.size()?, sheet.printed()?);
    let mut tables = Tables::new();
    let measured: Vec<Measured> =
        size.graphs().map(|graphs| measure(&size, graphs, &mut tables)).collect::<Result<_, _>>()?;
    let summary = summary(&size, &printed, &measured);
    let figures = measured.iter().map(|measured| (measured.graphs.name(), figure(measured, &printed))).collect();
    let notes = vec![
        format!(
            "Deviation from `{}`, length {}, {} graphs a cell, each trajectory flown {} times with noise; lifts are of means over uniform \
             feasible trajectories, with 95 % bootstrap intervals; scores are learned from {} executions in other graphs.",
            size.from, size.length, size.graphs, size.runs, size.training
        ),
        "Waypoints are spread by `sampling` where graphs are searched, and uniformly under the baselines; none is used twice, on either side. \
         Minimum snap has times by the square root of the leg's length."
            .into(),
    ];
    Ok(Outcome {
        tables: vec![("summary", summary), ("lifts", tables.lifts), ("models", tables.models)],
        figures,
        notes,
    })
}
