//! What every way comes to in the graphs of a feasible set, under one controller after the other.

use std::borrow::Cow;
use std::collections::HashMap;

use hairpin::campaign::learn::ScoreModel;
use hairpin::campaign::{Case, Optimum};
use hairpin::judgement::Stress;
use hairpin_jobs::{Problem, Watch};

use super::super::cell::{self, FLIGHT_GOGGLES, Set, text, with};
use super::super::lift::Flown;
use super::kinds::WayKind;
use super::lifts::Measured;
use super::size::{Graphs, Size};
use super::tables::Tables;
use super::ways::{Finds, Way, base, by_hand, sampling, ways};
use crate::experiment::watched::go_on;

/// What finds cases under one controller.
struct Controlled {
    /// The keys of all cells.
    base: Vec<Set>,
    /// The learned score, where a way needs it.
    model: Option<ScoreModel>,
    /// Its optima, where they are asked for.
    optima: Vec<Optimum>,
}

impl Controlled {
    fn new(
        size: &Size,
        graphs: &Graphs,
        controller: &str,
        needs_model: bool,
        watch: &dyn Watch,
    ) -> Result<Self, Problem> {
        let base = base(size, graphs, controller);
        let model = match needs_model {
            true => {
                let base = with(&base, &[sampling(graphs)]);
                Some(cell::learned(FLIGHT_GOGGLES, &base, size.training, size.seed, watch)?)
            }
            false => None,
        };
        let optima = match size.kinds.contains(&WayKind::Learned) {
            true => optima(&base, graphs, &[], model.as_ref(), watch)?,
            false => Vec::new(),
        };
        Ok(Self { base, model, optima })
    }

    /// The cases that a way with `sets` finds.
    fn cases(&self, way: &Way, sets: &[Set], watch: &dyn Watch) -> Result<Vec<Case>, Problem> {
        let model = self.model.as_ref().filter(|_| way.learned);
        cell::cases(&cell::setup(FLIGHT_GOGGLES, &with(&self.base, sets), model)?, watch)
    }
}

/// What every way comes to in `graphs`, under each controller.
pub(super) fn measure(
    size: &Size,
    graphs: Graphs,
    tables: &mut Tables,
    watch: &dyn Watch,
) -> Result<Measured, Problem> {
    let ways = ways(size, &graphs);
    let needs_model = ways.iter().any(|way| way.learned);
    let mut controllers = Vec::new();
    // Cases by way, of the ways that find the same for every controller.
    let mut shared: HashMap<&str, Vec<Case>> = HashMap::new();
    let by_hand = match size.controllers.first().filter(|_| size.kinds.contains(&WayKind::ByHand)) {
        Some(any) => optima(&base(size, &graphs, any), &graphs, &by_hand(), None, watch)?,
        None => Vec::new(),
    };
    for controller in &size.controllers {
        go_on(watch)?;
        let own = Controlled::new(size, &graphs, controller, needs_model, watch)?;
        let judge = cell::with_noise(FLIGHT_GOGGLES, &own.base, size.runs)?;
        if let Some(model) = &own.model {
            tables.learned(&graphs, controller, model);
        }
        let ceiling = ceiling(size, &own.base, watch)?;
        let mut flown: Vec<(&Way, Flown)> = Vec::new();
        for way in &ways {
            go_on(watch)?;
            let cases = match &way.finds {
                Finds::Optimum { score, aggregate } => {
                    let optima = if way.learned { &own.optima } else { &by_hand };
                    let wanted = |found: &&Optimum| found.score == *score && found.aggregate == *aggregate;
                    Cow::Borrowed(optima.iter().find(wanted).map_or(&[][..], |found| &found.cases))
                }
                Finds::Keys(sets) => match shared.get(&*way.name) {
                    Some(cases) => Cow::Borrowed(&**cases),
                    None => Cow::Owned(own.cases(way, sets, watch)?),
                },
            };
            let [came_to] = cell::flown(&judge, &cases, [Stress::MaxDeviation], watch)?;
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

/// The worst of many uniform trajectories, each executed once without noise.
fn ceiling(size: &Size, base: &[Set], watch: &dyn Watch) -> Result<Option<f64>, Problem> {
    if size.ceiling == 0 {
        return Ok(None);
    }
    let sets = [
        ("generate.search.method", text("uniform")),
        ("generate.search.cases", size.ceiling.to_string()),
        ("generate.search.per_graph", size.ceiling.div_ceil(size.graphs).to_string()),
    ];
    let setup = cell::setup(FLIGHT_GOGGLES, &with(base, &sets), None)?;
    let [flown] = cell::flown(&setup, &cell::cases(&setup, watch)?, [Stress::MaxDeviation], watch)?;
    Ok(flown.stresses.into_iter().reduce(f64::max))
}

/// The optima of the scores by hand called `names`, or of `model`, in the graphs of `base`.
fn optima(
    base: &[Set],
    graphs: &Graphs,
    names: &[&str],
    model: Option<&ScoreModel>,
    watch: &dyn Watch,
) -> Result<Vec<Optimum>, Problem> {
    cell::optima(&cell::setup(FLIGHT_GOGGLES, &with(base, &[sampling(graphs)]), model)?, names, watch)
}
