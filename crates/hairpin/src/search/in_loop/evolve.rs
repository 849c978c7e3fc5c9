//! Evolution of waypoint sequences within the legs of a graph.
//!
//! A pool holds the gravest trajectories executed so far. A child takes its parent's beginning, a stretch of
//! legs grown anew, and the rest from the same parent or another one of the pool; or it puts one of its parent's
//! waypoints to a place nearby. Most changes lie around the leg that the parent owes its stress to. Each child is
//! feasible, for every leg is one of the graph, and is executed once.

use std::collections::HashSet;

use rand::RngExt;

use super::nearby::nearby;
use super::regrow::{Goal, Regrow};
use super::{Rank, Trial};
use crate::math::random::{Stream, stream, unit};
use crate::search::graph::LegGraph;
use crate::search::task::Found;

/// Trials in a row that may give nothing new before a graph counts as used up.
const FRUITLESS: u32 = 300;
/// Share of stretches that are laid around the worst leg.
const AROUND_WORST: f64 = 0.6;
/// Share of children whose rest comes from another parent.
const CROSSED: f64 = 0.25;
/// Share of children with one waypoint of their parent put to another place nearby.
const NEARBY: f64 = 0.4;

/// What is asked for.
///
/// `executions` counts failed ones too, so that it bounds the time.
///
/// `length` is at least 2. Where a trial may take several executions (repetitions of what leads), the last ones may
/// stay unused: none is begun that could go beyond the budget.
#[derive(Debug, Clone, PartialEq)]
pub struct EvolveSettings {
    /// Waypoints of a trajectory, both ends included.
    pub length: usize,
    /// Executions at most, those of the first trajectories included.
    pub executions: u64,
    /// Executions of one trial at most.
    pub per_trial: u64,
    /// Trajectories that may have children.
    /// 0 is taken as 1. Small pools converge, large ones spend executions on what is not stressful.
    pub pool: usize,
    /// Whether a waypoint may be used twice.
    pub revisits: bool,
}

impl Default for EvolveSettings {
    fn default() -> Self {
        Self { length: 10, executions: 200, per_trial: 1, pool: 12, revisits: false }
    }
}

/// A trajectory and what its execution came to.
///
/// `trial.worst_leg` counts legs of `found` from 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Tested<N> {
    /// The trajectory; its score is the stress.
    pub found: Found<N>,
    /// The execution.
    pub trial: Trial,
}

/// The answer.
///
/// `pool` has at most [`EvolveSettings::pool`] entries, pairwise different in their legs; `best_so_far` one for each
/// execution.
#[derive(Debug, Clone, PartialEq)]
pub struct Evolved<N> {
    /// The pool, the gravest first.
    pub pool: Vec<Tested<N>>,
    /// The largest stress after each execution.
    pub best_so_far: Vec<f64>,
}

/// `legs` are numbers of the graph's legs, from the start on.
struct Member {
    legs: Vec<u32>,
    trial: Trial,
}

struct Evolution<'g, 'a, N, F> {
    graph: &'g LegGraph<'a, N>,
    settings: &'g EvolveSettings,
    execute: F,
    rng: Stream,
    known: HashSet<Vec<u32>>,
    pool: Vec<Member>,
    most: f64,
    best_so_far: Vec<f64>,
}

/// Evolves trajectories of `graph` from `first` (repetitions are executed once). `execute` gives `None` where an
/// execution failed, which counts against the budget; it is told the rank that the pool's last has.
///
/// `first` is executed in its order; of the budget what is left goes to children. `best_so_far` never falls and has one
/// entry for each execution.
///
/// One execution a child, no generations: steady-state evolution with truncation. Parents are drawn by u² over the pool
/// in the order of rank, so that its first quarter has half of the children. Ends when the budget does, or when 300
/// children in a row were known or could not be made.
pub fn evolve<N, F>(
    graph: &LegGraph<'_, N>,
    first: &[Found<N>],
    seed: u64,
    settings: &EvolveSettings,
    execute: F,
) -> Evolved<N>
where
    N: Copy + Eq,
    F: FnMut(&Found<N>, Rank) -> Option<Trial>,
{
    let mut evolution = Evolution {
        graph,
        settings,
        execute,
        rng: stream(seed),
        known: HashSet::new(),
        pool: Vec::new(),
        most: f64::NEG_INFINITY,
        best_so_far: Vec::new(),
    };
    for found in first {
        if let Some(legs) = graph.legs_along(&found.nodes) {
            evolution.test(legs);
        }
    }
    let mut fruitless = 0;
    while evolution.goes_on() && fruitless < FRUITLESS {
        fruitless += 1;
        if let Some(child) = evolution.child()
            && evolution.test(child)
        {
            fruitless = 0;
        }
    }
    let Evolution { pool, best_so_far, .. } = evolution;
    let tested = |Member { legs, trial }: Member| Tested { found: graph.found(&legs, trial.stress), trial };
    Evolved { pool: pool.into_iter().map(tested).collect(), best_so_far }
}

impl<N: Copy, F: FnMut(&Found<N>, Rank) -> Option<Trial>> Evolution<'_, '_, N, F> {
    /// Whether there are executions left for another trial.
    fn goes_on(&self) -> bool {
        self.best_so_far.len() as u64 + self.settings.per_trial.max(1) <= self.settings.executions
    }

    /// Executes the trajectory along `legs` unless it was before; whether it was new.
    fn test(&mut self, legs: Vec<u32>) -> bool {
        if !self.goes_on() || self.known.contains(&legs) {
            return false;
        }
        let most = self.settings.pool.max(1);
        let least = self.pool.get(most - 1).map_or(Rank::LEAST, |member| member.trial.rank());
        let trial = (self.execute)(&self.graph.found(&legs, 0.0), least);
        let executions = trial.map_or(1, |trial| trial.executions);
        let trial = trial.filter(|trial| !trial.stress.is_nan());
        self.known.insert(legs.clone());
        if let Some(trial) = trial {
            self.most = self.most.max(trial.stress);
            let place = self.pool.partition_point(|member| member.trial.reaches(trial.rank()));
            self.pool.insert(place, Member { legs, trial });
            self.pool.truncate(most);
        }
        self.best_so_far.extend((0..executions).map(|_| self.most));
        true
    }

    /// A trajectory that differs from its parents in one stretch, or is grown anew where there are no parents.
    ///
    /// Stretches have 2 … 5 legs. `None` where none could be grown, or a waypoint came twice and must not.
    fn child(&mut self) -> Option<Vec<u32>> {
        let count = self.settings.length - 1;
        let mut taken = vec![false; if self.settings.revisits { 0 } else { self.graph.candidates().len() }];
        if self.pool.is_empty() {
            return self.stretch(&mut taken, &[], count, &[]);
        }
        let parent = self.parent();
        if unit(&mut self.rng) < NEARBY {
            return self.nearby(parent);
        }
        let donor = if unit(&mut self.rng) < CROSSED { self.parent() } else { parent };
        // One leg cannot be grown anew between fixed nodes, and two can only where nodes do not remember the waypoint
        // before.
        let steps = self.rng.random_range(2.min(count)..=count.min(5));
        let begin = if unit(&mut self.rng) < AROUND_WORST {
            let worst = self.pool[parent].trial.worst_leg.min(count - 1);
            (worst + 2).saturating_sub(self.rng.random_range(0..=steps)).min(count - steps)
        } else {
            self.rng.random_range(0..=count - steps)
        };
        let (head, tail) = (self.pool[parent].legs[..begin].to_vec(), self.pool[donor].legs[begin + steps..].to_vec());
        let child = self.stretch(&mut taken, &head, steps, &tail)?;
        // A donor's rest may use what the parent's beginning has.
        let mut used = vec![false; self.graph.candidates().len()];
        used[0] = true;
        let once = |&leg: &u32| {
            let waypoint = self.graph.waypoint(self.graph.target(leg as usize)) as usize;
            !std::mem::replace(&mut used[waypoint], true)
        };
        (self.settings.revisits || child.iter().all(once)).then_some(child)
    }

    /// `parent` with one waypoint, mostly one at its worst leg, put to one of the places near it.
    fn nearby(&mut self, parent: usize) -> Option<Vec<u32>> {
        let Member { legs, trial } = &self.pool[parent];
        // Waypoint k + 1 lies between the legs k and k + 1; the end stays.
        let inner = legs.len().saturating_sub(1);
        if inner == 0 {
            return None;
        }
        let moved = if unit(&mut self.rng) < AROUND_WORST {
            (trial.worst_leg.min(inner) + self.rng.random_range(0..3usize)).saturating_sub(2).min(inner - 1)
        } else {
            self.rng.random_range(0..inner)
        };
        nearby(self.graph, legs, moved, &mut self.rng)
    }

    /// One of the pool, better ones more often.
    ///
    /// u² of the pool: the first quarter has half of the children.
    fn parent(&mut self) -> usize {
        let u = unit(&mut self.rng);
        ((u * u) * self.pool.len() as f64) as usize
    }

    /// `head`, `steps` legs grown anew, `tail`.
    ///
    /// `taken` is empty where waypoints may come twice; else it is marked with what head and tail use. With a tail the
    /// stretch must lead into the tail's first node, without one to the end.
    fn stretch(&mut self, taken: &mut [bool], head: &[u32], steps: usize, tail: &[u32]) -> Option<Vec<u32>> {
        let target = |leg: u32| self.graph.target(leg as usize);
        let from = head.last().map_or(0, |&leg| target(leg));
        let goal = match tail.first() {
            Some(&leg) => Goal::Node(self.graph.source(leg)),
            None => Goal::End,
        };
        if !taken.is_empty() {
            taken[0] = true;
            for &leg in head.iter().chain(tail) {
                taken[self.graph.waypoint(target(leg)) as usize] = true;
            }
        }
        let mut legs = head.to_vec();
        let mut regrow = Regrow::new(self.graph, goal, taken, &mut self.rng);
        if !regrow.grow(from, steps, &mut legs) {
            return None;
        }
        legs.extend_from_slice(tail);
        Some(legs)
    }
}
