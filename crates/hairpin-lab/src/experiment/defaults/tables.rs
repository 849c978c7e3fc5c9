//! Lifts as tables: one that sums up, and all numbers behind it.

use hairpin_formats::figure::{Cell, Table};

use super::lifts::{CellLifts, Lifts, WayLifts};
use super::statistics::Lift;
use super::ways::Way;

/// What a cell must reach: the lift over the best of as many, and how often a case is ahead of one.
const LEAST_LIFT: f64 = 0.15;
const LEAST_A12: f64 = 0.65;

/// All tables; the first one sums up.
pub(super) fn tables(lifts: &Lifts) -> Vec<(&'static str, Table)> {
    let mut all = vec![("summary", summary(lifts)), ("ways", ways(lifts))];
    all.extend([("behind", behind(lifts)), ("default-run", default_run(lifts)), ("means", means(lifts))]);
    all
}

/// The default of `cell`, with moves if that was measured.
pub(super) fn default_of(cell: &CellLifts) -> Option<&WayLifts> {
    let of = |way: Way| cell.ways.iter().find(|own| own.way == way);
    of(Way::Worst).or_else(|| of(Way::WorstInGraph))
}

/// Whether the default reaches what it must over the best of as many random executions.
pub(super) fn met(own: &WayLifts) -> bool {
    let lifted = own.over_best.is_some_and(|lift| lift.value >= LEAST_LIFT && lift.interval[0] > 0.0);
    lifted && own.a12 >= LEAST_A12
}

fn in_percent(share: f64) -> Cell {
    (100.0 * share).into()
}

/// Lift and interval, %.
fn percent(lift: Option<Lift>) -> [Cell; 3] {
    match lift {
        Some(Lift { value, interval: [low, high], .. }) => [value, low, high].map(in_percent),
        None => [Cell::Empty, Cell::Empty, Cell::Empty],
    }
}

fn summary(lifts: &Lifts) -> Table {
    let mut table = Table::new(&[
        "cell",
        "single",
        "best_of_as_many",
        "default",
        "lift_percent",
        "low_percent",
        "high_percent",
        "p_holm",
        "a12",
        "met",
    ]);
    for cell in &lifts.cells {
        let own = default_of(cell);
        let mut row: Vec<Cell> = vec![cell.name.as_str().into(), cell.single.level.into(), cell.best.level.into()];
        row.push(own.map(|own| own.side.level).into());
        row.extend(percent(own.and_then(|own| own.over_best)));
        row.push(own.and_then(|own| own.p).into());
        row.push(own.map(|own| own.a12).into());
        row.push(own.map(|own| if met(own) { "yes" } else { "no" }).into());
        table.push(row);
    }
    table
}

fn ways(lifts: &Lifts) -> Table {
    let mut columns =
        vec!["cell", "way", "executions_a_case", "cases", "level", "crashed_percent", "timed_out_percent"];
    columns.extend(["over_best_percent", "over_best_low", "over_best_high", "over_best_p_holm", "a12"]);
    columns.extend(["over_best_ended_percent", "over_best_ended_low", "over_best_ended_high"]);
    columns.extend(["over_single_percent", "over_single_low", "over_single_high"]);
    columns.extend(["over_single_ended_percent", "over_single_ended_low", "over_single_ended_high", "refused"]);
    let mut table = Table::new(&columns);
    let empty = |count: usize| std::iter::repeat_n(Cell::Empty, count);
    for cell in &lifts.cells {
        let random = [("single", 1.0, &cell.single), ("best of as many", cell.best_of as f64, &cell.best)];
        for (way, executions, side) in random {
            let mut row: Vec<Cell> = vec![cell.name.as_str().into(), way.into(), executions.into(), side.cases.into()];
            row.push(side.level.into());
            row.extend(side.ends.map(in_percent));
            row.extend(empty(columns.len() - row.len()));
            table.push(row);
        }
        for own in &cell.ways {
            let mut row: Vec<Cell> = vec![cell.name.as_str().into(), own.way.word().into()];
            row.extend([Cell::from(own.executions), own.side.cases.into(), own.side.level.into()]);
            row.extend(own.side.ends.map(in_percent));
            row.extend(percent(own.over_best));
            row.extend([Cell::from(own.p), own.a12.into()]);
            let others = [own.over_best_ended, own.over_single, own.over_single_ended];
            others.into_iter().for_each(|lift| row.extend(percent(lift)));
            row.push(own.refused.clone().into());
            table.push(row);
        }
    }
    table
}

fn behind(lifts: &Lifts) -> Table {
    let mut table = Table::new(&["cell", "over", "percent", "low_percent", "high_percent"]);
    for cell in &lifts.cells {
        for (other, lift) in &cell.behind {
            let [value, low, high] = percent(*lift);
            table.push(vec![cell.name.as_str().into(), other.word().into(), value, low, high]);
        }
    }
    table
}

fn default_run(lifts: &Lifts) -> Table {
    let mut table = Table::new(&[
        "cell",
        "ahead_of_ten_times_by_chance",
        "pairs",
        "first_violation_at",
        "by_chance_at",
        "time_over_random_executions",
        "time_over_kept_executions",
        "drawn",
    ]);
    for cell in &lifts.cells {
        let [ahead, pairs] = cell.pairs;
        let mut row: Vec<Cell> = vec![cell.name.as_str().into(), ahead.into(), pairs.into()];
        row.extend([0, 1].map(|side| Cell::from(cell.first_violation.map(|both| both[side]))));
        row.extend([0, 1].map(|side| Cell::from(cell.cost.map(|both| both[side]))));
        row.push(cell.drawn_how.as_str().into());
        table.push(row);
    }
    table
}

fn means(lifts: &Lifts) -> Table {
    let mut table = Table::new(&[
        "mean",
        "cells",
        "way",
        "over_single_percent",
        "low_percent",
        "high_percent",
        "ended_percent",
        "ended_low_percent",
        "ended_high_percent",
    ]);
    for mean in &lifts.means {
        let mut row: Vec<Cell> = vec![mean.name.as_str().into(), mean.cells.into(), mean.way.word().into()];
        row.extend([mean.over_single, mean.over_single_ended].concat().into_iter().map(in_percent));
        table.push(row);
    }
    table
}
