//! What was measured, as a table and a figure.

use hairpin_formats::figure::{Axis, Cell, Figure, Marks, Point, Scale, Series, Table};

use super::super::lift::Lift;
use super::kinds::{KINDS, WayKind};
use super::size::{Graphs, Printed, Size};
use super::tables::{OF_GRAPHS, of_graphs};

/// Lifts of one feasible set: per controller, per way.
pub(super) struct Measured {
    pub(super) graphs: Graphs,
    /// By controller: ways with their lift over uniform trajectories.
    pub(super) controllers: Vec<(String, Vec<(WayKind, Lift)>)>,
}

impl Measured {
    /// The best lift of a kind per controller, and their mean.
    fn best(&self, kind: WayKind) -> (Vec<Option<Lift>>, f64) {
        let best = |ways: &Vec<(WayKind, Lift)>| {
            let own = ways.iter().filter(|(other, _)| *other == kind).map(|(_, lift)| *lift);
            own.reduce(|best, lift| if lift.value > best.value { lift } else { best })
        };
        let all: Vec<Option<Lift>> = self.controllers.iter().map(|(_, ways)| best(ways)).collect();
        let mean = all.iter().flatten().map(|lift| lift.value).sum::<f64>() / all.len() as f64;
        (all, mean)
    }
}

/// Mean lifts over the controllers, the best way of a kind for each.
pub(super) fn summary(size: &Size, printed: &Printed, measured: &[Measured]) -> Table {
    let columns: Vec<String> = OF_GRAPHS
        .into_iter()
        .chain(["kind"])
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
            let mut row = Vec::from(of_graphs(&measured.graphs));
            row.push(name.into());
            row.extend(best.iter().map(|lift| Cell::from(lift.map(|lift| 100.0 * lift.value))));
            row.push((100.0 * mean).into());
            row.push(match kind {
                WayKind::ByHand => by_hand.into(),
                WayKind::Learned => printed.learned_mean_percent.into(),
                _ => Cell::Empty,
            });
            table.push(row);
        }
    }
    table
}

/// The lifts as bars, the paper's among them.
pub(super) fn figure(measured: &Measured, printed: &Printed) -> Figure {
    let names = measured.controllers.iter().map(|(controller, _)| controller.clone()).collect();
    let mut series: Vec<Series> = KINDS
        .iter()
        .map(|(kind, name)| {
            let (best, _) = measured.best(*kind);
            let point = |(place, lift): (usize, &Option<Lift>)| {
                let [value, low, high] = (*lift)?.percent();
                Some(Point::between(place as f64, value, low, high))
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
        title: format!("Largest deviation over that of uniform trajectories, feasible set `{}`", measured.graphs.reach),
        x: Axis { label: "controller".into(), scale: Scale::Names(names) },
        y: Axis { label: "lift of the mean, %".into(), scale: Scale::Linear },
        series,
    }
}
