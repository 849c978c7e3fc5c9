//! A row for every way under every controller, and one for every model.

use hairpin::campaign::learn::ScoreModel;
use hairpin::math::random::named_seed;
use hairpin_formats::figure::{Cell, Table};

use super::super::lift::{Flown, Lift, lift};
use super::kinds::WayKind;
use super::size::{Graphs, Size};
use super::ways::Way;

/// The tables that grow with every controller of every feasible set.
pub(super) struct Tables {
    pub(super) lifts: Table,
    pub(super) models: Table,
}

/// What every row says of its graphs: feasible set, waypoints, and how those are spread that are searched.
pub(super) const OF_GRAPHS: [&str; 3] = ["reach", "waypoints", "sampling"];

/// The cells of [`OF_GRAPHS`].
pub(super) fn of_graphs(graphs: &Graphs) -> [Cell; 3] {
    [graphs.reach.as_str().into(), (graphs.waypoints as usize).into(), graphs.sampling.as_str().into()]
}

impl Tables {
    pub(super) fn new() -> Self {
        let table = |own: &[&str]| Table::new(&[&OF_GRAPHS[..], &["controller"], own].concat());
        Self {
            lifts: table(&[
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
            ]),
            models: table(&["legs", "degree", "penalty", "r2", "held_out_r2", "held_out_error_m", "held_out_rank"]),
        }
    }

    /// What was learned of a controller.
    pub(super) fn learned(&mut self, graphs: &Graphs, controller: &str, model: &ScoreModel) {
        self.models.push(row(
            graphs,
            controller,
            [
                model.legs.into(),
                (model.polynomial.degree as usize).into(),
                model.polynomial.penalty.into(),
                model.validation.r2.into(),
                model.held_out.r2.into(),
                model.held_out.rmse.into(),
                model.held_out.rank_correlation.into(),
            ],
        ));
    }

    /// What every way came to under a controller, the two baselines first; the lifts over the first.
    pub(super) fn flown(
        &mut self,
        size: &Size,
        graphs: &Graphs,
        controller: &str,
        flown: &[(&Way, Flown)],
        ceiling: Option<f64>,
    ) -> Vec<(WayKind, Lift)> {
        let [uniform, beam] = [0, 1].map(|baseline: usize| &*flown[baseline].1.stresses);
        let mut lifts = Vec::new();
        for (number, (way, came_to)) in flown.iter().enumerate() {
            let seed = named_seed(size.seed, "bootstrap", number as u64);
            let over = lift(&came_to.stresses, uniform, seed);
            let over_beam = lift(&came_to.stresses, beam, seed);
            lifts.push((way.kind, over));
            let [value, low, high] = over.percent();
            self.lifts.push(row(
                graphs,
                controller,
                [
                    way.name.as_str().into(),
                    came_to.stresses.len().into(),
                    came_to.mean().into(),
                    came_to.median().into(),
                    value.into(),
                    low.into(),
                    high.into(),
                    (100.0 * over_beam.value).into(),
                    (100.0 * came_to.crashed).into(),
                    (100.0 * came_to.timed_out).into(),
                    if number == 0 { ceiling.into() } else { Cell::Empty },
                ],
            ));
        }
        lifts
    }
}

fn row<const N: usize>(graphs: &Graphs, controller: &str, own: [Cell; N]) -> Vec<Cell> {
    of_graphs(graphs).into_iter().chain([controller.into()]).chain(own).collect()
}
