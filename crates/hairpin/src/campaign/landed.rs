//! A run that has landed, measured while all of its rows are there, and the rows of it that must stay.
//!
//! Recording every row of every run takes most of a folder. What is measured is measured before rows are left out,
//! and is written beside the run; rows around what the measures rest on are kept, so that figures and re-judging by
//! other limits see them.

use std::collections::BTreeSet;

use nalgebra::Vector3;

use super::coverage::Grid;
use super::full_rate::FullRate;
use super::hidden::sampled;
use super::judge::{Drawn, look, reference, settings};
use super::scenario::DeviationFrom;
use super::{Case, Run, Setup};
use crate::judgement::{Limits, Measures, Settings, deviation_of_samples};
use crate::trajectory::Track;

/// Measures `run` as the judge would, and marks the rows that matter to it: the worst moments, and both sides of every
/// crossing of a limit (of an overshoot the largest alone). `None` where it was not flown or cannot be judged, and of
/// programs, which are measured move by move: of those all rows are needed.
///
/// Indices of rows count from 0. Measures are those of the scenario's present terms; a judgement by others measures
/// the rows that stand ([`super::judge::is_at_full_rate`]).
pub fn at_full_rate(setup: &Setup, case: &Case, run: &Run) -> Option<(FullRate, BTreeSet<usize>)> {
    let flight = run.outcome.as_ref().ok()?;
    if setup.has_programs() {
        return None;
    }
    let around = setup.around(case).ok()?;
    let Drawn { own, terms } = Drawn::of(&around, run).ok()?;
    let path = (terms.from == DeviationFrom::Path).then(|| reference(&around, case, None)).flatten();
    let clearance = own.kind().clearance();
    let settings = settings(&terms, path.as_ref(), clearance.as_deref());
    let measures = sampled(&own, &flight.track, &case.waypoints, &settings).ok()?;
    let marked = marked(&flight.track, case, &measures, (&terms.limits, &settings));
    let met = Grid::of(setup).met(setup, &case.waypoints, run);
    let implausible = look(&own, case, flight);
    Some((FullRate { from: terms.from, corner: terms.corner, measures, met, implausible }, marked))
}

fn marked(track: &Track, case: &Case, found: &Measures, (limits, settings): (&Limits, &Settings)) -> BTreeSet<usize> {
    let moments = [found.t_worst, found.t_acceleration, found.t_overshoot, found.t_clearance];
    let moments = moments.into_iter().chain([found.t_tip_over_margin, found.t_tilt]);
    let mut marked: BTreeSet<usize> =
        moments.filter_map(|t| track.times().iter().position(|time| *time >= t)).collect();
    let mut crossings = |beyond: &dyn Fn(usize) -> bool| {
        for row in 1..track.len() {
            if beyond(row - 1) != beyond(row) {
                marked.extend([row - 1, row]);
            }
        }
    };
    if let Some(most) = limits.deviation
        && let Ok(off) = deviation_of_samples(track, &case.waypoints, settings)
    {
        crossings(&|row| off[row].is_some_and(|off| off > most));
    }
    if let (Some(least), Some(clearance)) = (limits.clearance, settings.clearance) {
        let short: Vec<bool> = (0..track.len()).map(|row| clearance(&track.position(row)) < least).collect();
        crossings(&|row| short[row]);
    }
    if let (Some(least), Some(margins)) = (limits.tip_over_margin, track.channel("tip_over_margin_deg")) {
        crossings(&|row| margins[row] < least);
    }
    let velocity = ["vx_m_s", "vy_m_s", "vz_m_s"].map(|name| track.channel(name));
    if let (Some(most), [Some(x), Some(y), Some(z)]) = (limits.acceleration, velocity) {
        crossings(&|row| {
            let (a, b) = (row.saturating_sub(1), (row + 1).min(track.len() - 1));
            let changed = Vector3::new(x[b] - x[a], y[b] - y[a], z[b] - z[a]).norm();
            b > a && changed > most * (track.times()[b] - track.times()[a])
        });
    }
    marked
}
