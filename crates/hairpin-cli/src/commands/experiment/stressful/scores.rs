//! Figure 8: per controller, the largest deviation with each score relative to uniform feasible trajectories; and beyond it,
//! executions in the loop and waypoints moved freely.
//!
//! Every trajectory comes from a graph of its own (one best per graph), no waypoint is used twice on either side, and what is told are
//! fresh runs with noise, which no search has seen.

use std::borrow::Cow;
use std::collections::HashMap;

use hairpin::campaign::Case;
use hairpin::campaign::experiment::lift::{Flown, Lift, lift};
use hairpin::judgement::Stress;
use hairpin::math::random::named_seed;
use hairpin::search::Score;
use hairpin_formats::experiment::Sheet;
use hairpin_formats::figure::{Axis, Cell, Figure, Marks, Point, Scale, Series, Table};
use serde::Deserialize;

use super::super::{Outcome, go_on};
use super::cell::{self, FLIGHT_GOGGLES, Set, text, with};
use crate::problem::Problem;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Size {
    /// Trajectories per cell, each from a graph of its own.
    graphs: u64,
    /// Executions of other graphs' trajectories that scores are learned from.
    training: u64,
    /// Runs with noise of every trajectory.
    runs: u64,
    /// Executions per graph of the search in the loop.
    executions: u64,
    /// The same where waypoints are moved as well.
    executions_moved: u64,
    /// Executions under noise that those confirm a stress with: within a graph they cost more than they find.
    confirm_moved: u64,
    /// Uniform trajectories whose worst is the ceiling; 0: left out.
    ceiling: u64,
    length: u64,
    seed: u64,
    reach: Vec<String>,
    controllers: Vec<String>,
    /// What is measured beside the baselines.
    kinds: Vec<Kind>,
    /// What deviations are measured from: leg | nearest-leg.
    from: String,
}

#[derive(Debug, Deserialize)]
struct Printed {
    controllers: Vec<PrintedRow>,
    learned_mean_percent: f64,
}

#[derive(Debug, Deserialize)]
struct PrintedRow {
    controller: String,
    best_percent: f64,
}

/// A way to generate: its name, the kind that it counts among, and its keys.
struct Way {
    name: String,
    kind: Kind,
    sets: Vec<Set>,
    learned: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    #[serde(skip)]
    Baseline,
    ByHand,
    Learned,
    InLoop,
    InLoopLearned,
    Moved,
    MovedLearned,
}

impl Kind {
    /// Whether what is found depends on who will fly it.
    fn knows_controller(self) -> bool {
        !matches!(self, Self::Baseline | Self::ByHand)
    }
}

const KINDS: [(Kind, &str); 6] = [
    (Kind::ByHand, "best by hand"),
    (Kind::Learned, "learned"),
    (Kind::InLoop, "in the loop"),
    (Kind::InLoopLearned, "in the loop, from the learned"),
    (Kind::Moved, "in the loop, waypoints moved"),
    (Kind::MovedLearned, "in the loop, waypoints moved, from the learned"),
];

fn ways(size: &Size) -> Vec<Way> {
    let way = |name: &str, kind, method: &str, sets: &[Set]| {
        let mut all = vec![("generate.search.method", text(method))];
        all.extend_from_slice(sets);
        let learned = matches!(kind, Kind::Learned | Kind::InLoopLearned | Kind::MovedLearned);
        Way { name: name.to_owned(), kind, sets: all, learned }
    };
    let mut ways = vec![
        way("uniform", Kind::Baseline, "uniform", &[]),
        way("random beam", Kind::Baseline, "beam", &[("generate.score", text("random"))]),
    ];
    for aggregate in ["sum", "max"] {
        let aggregate_set = ("generate.search.aggregate", text(aggregate));
        for score in Score::NAMES.into_iter().filter(|name| *name != "random") {
            let sets = [("generate.score", text(score)), aggregate_set.clone()];
            ways.push(way(&format!("{score}, {aggregate}"), Kind::ByHand, "exact", &sets));
        }
        ways.push(way(&format!("learned, {aggregate}"), Kind::Learned, "exact", &[aggregate_set]));
    }
    let in_loop = |name: &str, executions: u64, kinds: [Kind; 2], sets: &[Set]| {
        let mut all = vec![("generate.search.executions", executions.to_string())];
        all.extend_from_slice(sets);
        let name = format!("{name}, {executions}");
        [way(&name, kinds[0], "in-loop", &all), way(&format!("{name}, from the learned"), kinds[1], "in-loop", &all)]
    };
    ways.extend(in_loop("in the loop", size.executions, [Kind::InLoop, Kind::InLoopLearned], &[]));
    let moved = [
        ("generate.search.move_waypoints", "true".into()),
        ("generate.search.confirm", size.confirm_moved.to_string()),
    ];
    let kinds = [Kind::Moved, Kind::MovedLearned];
    ways.extend(in_loop("in the loop and moved", size.executions_moved, kinds, &moved));
    ways.retain(|way| way.kind == Kind::Baseline || size.kinds.contains(&way.kind));
    ways
}

/// The keys of all cells of a feasible set and a controller.
fn base(size: &Size, reach: &str, controller: &str) -> Vec<Set> {
    vec![
        ("seed", size.seed.to_string()),
        ("task.length", size.length.to_string()),
        ("generate.reach", text(reach)),
        cell::resolution(reach),
        ("generate.search.cases", size.graphs.to_string()),
        ("execute.controller", text(controller)),
        ("execute.segment_times", text("sqrt-length")),
        ("spec.deviation.from", text(&size.from)),
    ]
}

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

/// Lifts of one feasible set: per controller, per way.
struct Measured {
    reach: String,
    /// By controller: ways with their lift over uniform trajectories.
    controllers: Vec<(String, Vec<(Kind, Lift)>)>,
}

impl Measured {
    /// The best lift of a kind per controller, and their mean.
    fn best(&self, kind: Kind) -> (Vec<Option<Lift>>, f64) {
        let best = |ways: &Vec<(Kind, Lift)>| {
            let own = ways.iter().filter(|(other, _)| *other == kind).map(|(_, lift)| *lift);
            own.reduce(|best, lift| if lift.value > best.value { lift } else { best })
        };
        let all: Vec<Option<Lift>> = self.controllers.iter().map(|(_, ways)| best(ways)).collect();
        let mean = all.iter().flatten().map(|lift| lift.value).sum::<f64>() / all.len() as f64;
        (all, mean)
    }
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
    let mut measured = Vec::new();
    for reach in &size.reach {
        let mut controllers = Vec::new();
        // Cases by way, of the ways that find the same for every controller.
        let mut shared: HashMap<String, Vec<Case>> = HashMap::new();
        for controller in &size.controllers {
            go_on()?;
            let base = base(&size, reach, controller);
            let judge = cell::with_noise(FLIGHT_GOGGLES, &base, size.runs)?;
            let model = match ways(&size).iter().any(|way| way.learned) {
                true => Some(cell::learned(FLIGHT_GOGGLES, &base, size.training, size.seed)?),
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
            let ceiling = ceiling(&size, &base)?;
            let mut flown: Vec<(Way, Flown)> = Vec::new();
            for way in ways(&size) {
                go_on()?;
                let generated = || {
                    let model = model.as_ref().filter(|_| way.learned);
                    cell::cases(&cell::setup(FLIGHT_GOGGLES, &with(&base, &way.sets), model)?)
                };
                let cases = match shared.get(&way.name) {
                    Some(cases) => Cow::Borrowed(cases),
                    None => Cow::Owned(generated()?),
                };
                let [came_to] = cell::flown(&judge, &cases, [Stress::MaxDeviation])?;
                if let (Cow::Owned(cases), false) = (cases, way.kind.knows_controller()) {
                    shared.insert(way.name.clone(), cases);
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
        "No waypoint is used twice, on either side; minimum snap has times by the square root of the leg's length."
            .into(),
    ];
    Ok(Outcome { tables: vec![("summary", summary), ("lifts", rows), ("models", quality)], figures, notes })
}

/// Mean lifts over the controllers, the best way of a kind for each.
fn summary(size: &Size, printed: &Printed, measured: &[Measured]) -> Table {
    let columns: Vec<String> = ["reach", "kind"]
        .into_iter()
        .map(str::to_owned)
        .chain(size.controllers.iter().map(|controller| format!("{}_percent", controller.replace('-', "_"))))
        .chain(["mean_percent".to_owned(), "paper_mean_percent".to_owned()])
        .collect();
    let mut table = Table::new(&columns.iter().map(String::as_str).collect::<Vec<_>>());
    let by_hand = printed.controllers.iter().map(|row| row.best_percent);
    let by_hand = by_hand.clone().sum::<f64>() / by_hand.count() as f64;
    for measured in measured {
        for (kind, name) in KINDS {
            let (best, mean) = measured.best(kind);
            if best.iter().all(Option::is_none) {
                continue;
            }
            let mut row: Vec<Cell> = vec![measured.reach.as_str().into(), name.into()];
            row.extend(best.iter().map(|lift| Cell::from(lift.map(|lift| 100.0 * lift.value))));
            row.push((100.0 * mean).into());
            row.push(match kind {
                Kind::ByHand => by_hand.into(),
                Kind::Learned => printed.learned_mean_percent.into(),
                _ => Cell::Empty,
            });
            table.push(row);
        }
    }
    table
}

fn figure_name(reach: &str) -> &'static str {
    match reach {
        "published" => "published",
        "hull" => "hull",
        "witness" => "witness",
        _ => "lifts",
    }
}

fn figure(measured: &Measured, printed: &Printed) -> Figure {
    let names = measured.controllers.iter().map(|(controller, _)| controller.clone()).collect();
    let mut series: Vec<Series> = KINDS
        .iter()
        .map(|(kind, name)| {
            let (best, _) = measured.best(*kind);
            let point = |(place, lift): (usize, &Option<Lift>)| {
                let lift = (*lift)?;
                let [low, high] = lift.interval.map(|end| 100.0 * end);
                Some(Point::between(place as f64, 100.0 * lift.value, low, high))
            };
            let points = best.iter().enumerate().filter_map(point).collect();
            Series { name: (*name).into(), marks: Marks::Bars(points) }
        })
        .collect();
    let of_paper = measured.controllers.iter().enumerate().filter_map(|(place, (controller, _))| {
        let row = printed.controllers.iter().find(|row| row.controller == *controller)?;
        Some(Point::new(place as f64, row.best_percent))
    });
    series.push(Series { name: "paper: best by hand".into(), marks: Marks::Bars(of_paper.collect()) });
    Figure {
        title: format!("Largest deviation over that of uniform trajectories, feasible set `{}`", measured.reach),
        x: Axis { label: "controller".into(), scale: Scale::Names(names) },
        y: Axis { label: "lift of the mean, %".into(), scale: Scale::Linear },
        series,
    }
}
