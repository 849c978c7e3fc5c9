//! Waypoints moved freely, as far as trajectories stay feasible: what a graph of sampled points cannot find.
//!
//! A (1+1) evolution strategy: a few neighbouring waypoints are moved by a normal step, what is not feasible costs nothing and is drawn
//! again, what is executed and no less stressful is kept. The step grows by half on success and shrinks so that one success in
//! five keeps it. Source: Rechenberg, Evolutionsstrategie, 1973.

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::Trial;
use crate::math::random::{standard_normals, stream, unit};

/// Draws for one execution at most; where none is feasible the step is halved.
const DRAWS: u32 = 60;
/// Steps are taken back to their first size below this share of it.
const SMALLEST: f64 = 1e-3;
const GROWTH: f64 = 1.5;

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct ShiftSettings {
    /// Executions at most.
    pub executions: u64,
    /// First step of each coordinate, m.
    pub step: f64,
    /// Whether the last waypoint may move, too; the first never does.
    pub free_end: bool,
}

/// The answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Shifted<P> {
    /// The most stressful plan, if one was better than the first.
    pub plan: Option<P>,
    /// Its execution, or the first one's.
    pub trial: Trial,
    /// The largest stress after each execution.
    pub best_so_far: Vec<f64>,
}

/// Moves `points`, whose execution came to `trial`. `feasible` plans through given waypoints; `execute` carries a plan out.
pub fn shift<P>(
    points: &[Point3<f64>],
    trial: Trial,
    seed: u64,
    settings: &ShiftSettings,
    mut feasible: impl FnMut(&[Point3<f64>]) -> Option<P>,
    mut execute: impl FnMut(&P) -> Option<Trial>,
) -> Shifted<P> {
    let mut rng = stream(seed);
    let mut best = Shifted { plan: None, trial, best_so_far: Vec::new() };
    let mut points = points.to_vec();
    let last = points.len() - usize::from(!settings.free_end);
    if last < 2 {
        return best;
    }
    let shrink = libm::pow(GROWTH, -0.25);
    let mut step = settings.step;
    while (best.best_so_far.len() as u64) < settings.executions {
        let mut drawn = None;
        for _ in 0..DRAWS {
            // Waypoints 1 … last − 1 may move; those at the worst leg mostly do.
            let count = rng.random_range(1..=3usize).min(last - 1);
            let begin = if unit(&mut rng) < 0.7 {
                let around = best.trial.worst_leg + rng.random_range(0..=3usize);
                around.saturating_sub(2).clamp(1, last - count)
            } else {
                rng.random_range(1..=last - count)
            };
            let mut moved = points.clone();
            for point in &mut moved[begin..begin + count] {
                *point += Vector3::from(standard_normals::<3>(&mut rng)) * step;
            }
            if let Some(plan) = feasible(&moved) {
                drawn = Some((moved, plan));
                break;
            }
        }
        let Some((moved, plan)) = drawn else {
            step *= 0.5;
            if step < SMALLEST * settings.step {
                break;
            }
            continue;
        };
        let trial = execute(&plan).filter(|trial| !trial.stress.is_nan());
        match trial {
            Some(trial) if trial.stress >= best.trial.stress => {
                (best.plan, best.trial, points) = (Some(plan), trial, moved);
                step *= GROWTH;
            }
            _ => step *= shrink,
        }
        step = step.min(2.0 * settings.step);
        if step < SMALLEST * settings.step {
            step = settings.step;
        }
        best.best_so_far.push(best.trial.stress);
    }
    best
}
