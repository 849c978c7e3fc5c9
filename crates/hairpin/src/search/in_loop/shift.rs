//! Waypoints moved freely, as far as trajectories stay feasible: what a graph of sampled points cannot find.
//!
//! A (1+1) evolution strategy: a few neighbouring waypoints are moved by a normal step, what is not feasible costs
//! nothing and is drawn again, what is executed and no less stressful is kept. The step grows by half on success and
//! shrinks so that one success in five keeps it. Source: Rechenberg, Evolutionsstrategie, 1973.
//!
//! Steps alone end at the peak that is next. So most changes put one waypoint anew about a neighbour instead, in any
//! direction, or draw a few towards one, at distances that are even in their logarithm: legs of every length, turns of
//! every angle and waypoints that crowd are tried.

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::step::after;
use super::{Rank, Trial};
use crate::math::random::{Stream, standard_normals, stream, unit};

/// Draws for one execution at most; where none is feasible the step is halved.
const DRAWS: u32 = 60;
/// Steps are taken back to half of the largest below this share of it.
const SMALLEST: f64 = 1e-3;
/// Share of changes that put a waypoint somewhere else about a neighbour, and of those that draw a few towards one.
const PLACED: f64 = 0.5;
const DRAWN_TOGETHER: f64 = 0.2;
/// Smallest factor of a distance: of the longest leg where a waypoint is put anew, of the present one where waypoints
/// are drawn towards another.
const LEAST_FACTOR: f64 = 0.05;
/// Share of changes around the worst leg.
const AROUND_WORST: f64 = 0.7;

/// What is asked for.
///
/// `step` is where σ begins and `largest` where it ends growing; both of the order of a leg.
#[derive(Debug, Clone, PartialEq)]
pub struct ShiftSettings {
    /// Executions at most.
    pub executions: u64,
    /// Executions of one trial at most.
    pub per_trial: u64,
    /// First step of each coordinate, m.
    pub step: f64,
    /// Largest step, m.
    pub largest: f64,
    /// Whether the last waypoint may move, too; the first never does.
    pub free_end: bool,
}

/// The answer.
///
/// `best_so_far` never falls and has one entry for each execution; it is empty where no waypoint may move.
#[derive(Debug, Clone, PartialEq)]
pub struct Shifted<P> {
    /// The gravest plan, if one was as grave as the first.
    pub plan: Option<P>,
    /// Its execution, or the first one's.
    pub trial: Trial,
    /// Step to go on with, m.
    pub step: f64,
    /// The largest stress after each execution.
    pub best_so_far: Vec<f64>,
}

/// Moves `points`, whose execution came to `trial`. `feasible` plans through given waypoints; `execute` carries a plan
/// out, and is told the rank of the best so far.
///
/// Only feasible plans are executed; drawing them is free. Accepted where the rank is no less, so that plateaus are
/// walked.
///
/// x′ = x + σ n for 1 … 3 waypoints in a row (3 of 10 changes); one waypoint anew at neighbour + f · longest leg in a
/// uniform direction (5 of 10); or 1 … 3 drawn towards a neighbour by the factor f (2 of 10), f = 0.05^u, u uniform. σ
/// at the end is handed back, so that a search can be gone on with. `trial.worst_leg` says where to look.
///
/// `points` have both ends, m; the first never moves, the last only with `free_end`. With no waypoint that may move,
/// or no execution, the first trial is the answer and `plan` is `None`.
///
/// ```
/// use hairpin::search::in_loop::{ShiftSettings, Trial, shift};
/// use nalgebra::Point3;
///
/// // One waypoint between two ends, in a box of 2 m: the longest way goes by one of its corners.
/// let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]].map(|[x, y]| Point3::new(x, y, 0.0));
/// let inside = |p: &[Point3<f64>]| p.iter().all(|p| (p.x - 1.0).abs() <= 1.0 && p.y.abs() <= 1.0 && p.z == 0.0);
/// let flat = |p: &[Point3<f64>]| p.iter().map(|p| Point3::new(p.x, p.y, 0.0)).collect::<Vec<_>>();
/// let length = |p: &[Point3<f64>]| p.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum::<f64>();
/// let trial = |stress| Trial { stress, fails: false, worst_leg: 0, executions: 1 };
/// let settings = ShiftSettings { executions: 200, per_trial: 1, step: 0.2, largest: 1.0, free_end: false };
/// let feasible = |p: &[Point3<f64>]| inside(&flat(p)).then(|| flat(p));
/// let moved = shift(&points, trial(length(&points)), 1, &settings, feasible, |plan, _| Some(trial(length(plan))));
/// assert!(moved.trial.stress > 3.0); // 1 + √5 = 3.24 m at a corner, 2 m straight on
/// ```
pub fn shift<P>(
    points: &[Point3<f64>],
    trial: Trial,
    seed: u64,
    settings: &ShiftSettings,
    mut feasible: impl FnMut(&[Point3<f64>]) -> Option<P>,
    mut execute: impl FnMut(&P, Rank) -> Option<Trial>,
) -> Shifted<P> {
    let mut rng = stream(seed);
    let mut best = Shifted { plan: None, trial, step: settings.step, best_so_far: Vec::new() };
    let mut most = trial.stress;
    let mut points = points.to_vec();
    let last = points.len() - usize::from(!settings.free_end);
    if last < 2 {
        return best;
    }
    while best.best_so_far.len() as u64 + settings.per_trial.max(1) <= settings.executions {
        let mut drawn = None;
        for _ in 0..DRAWS {
            let moved = moved(&points, best.trial.worst_leg, last, best.step, &mut rng);
            if let Some(plan) = feasible(&moved) {
                drawn = Some((moved, plan));
                break;
            }
        }
        let Some((moved, plan)) = drawn else {
            best.step *= 0.5;
            if best.step < SMALLEST * settings.largest {
                break;
            }
            continue;
        };
        let trial = execute(&plan, best.trial.rank());
        let executions = trial.map_or(1, |trial| trial.executions);
        most = most.max(trial.map_or(f64::NAN, |trial| trial.stress));
        match trial {
            Some(trial) if trial.reaches(best.trial.rank()) => {
                (best.plan, best.trial, points) = (Some(plan), trial, moved);
                best.step = after(best.step, true);
            }
            _ => best.step = after(best.step, false),
        }
        best.step = best.step.min(settings.largest);
        if best.step < SMALLEST * settings.largest {
            best.step = 0.5 * settings.largest;
        }
        best.best_so_far.extend((0..executions).map(|_| most));
    }
    best
}

/// `points` with one or a few of those before `last` changed, the first never; mostly those at the worst leg.
///
/// `last` is the first index that must stay, or the number of points.
///
/// The same three changes as those of [`crate::search::worst`], with σ in m and the last waypoint free on request.
fn moved(points: &[Point3<f64>], worst_leg: usize, last: usize, step: f64, rng: &mut Stream) -> Vec<Point3<f64>> {
    let kind = unit(rng);
    let places = kind < PLACED;
    let count = if places { 1 } else { rng.random_range(1..=3usize).min(last - 1) };
    let begin = if unit(rng) < AROUND_WORST {
        let around = worst_leg + rng.random_range(0..=3usize);
        around.saturating_sub(2).clamp(1, last - count)
    } else {
        rng.random_range(1..=last - count)
    };
    let mut moved = points.to_vec();
    let changed = &mut moved[begin..begin + count];
    if kind >= PLACED + DRAWN_TOGETHER {
        changed.iter_mut().for_each(|point| *point += Vector3::from(standard_normals::<3>(rng)) * step);
        return moved;
    }
    let after = begin + count < points.len() && unit(rng) < 0.5;
    let neighbour = points[if after { begin + count } else { begin - 1 }];
    let factor = libm::pow(LEAST_FACTOR, unit(rng));
    if places {
        let longest = points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).fold(0.0, f64::max);
        let way = Vector3::from(standard_normals::<3>(rng));
        changed[0] = neighbour + way * (factor * longest / way.norm().max(f64::MIN_POSITIVE));
    } else {
        changed.iter_mut().for_each(|point| *point = neighbour + (*point - neighbour) * factor);
    }
    moved
}
