//! Reach by simulating every sampled run from the node's own state: the oracle of `hull`, and what is used where the
//! identity behind `hull` breaks: quadratic drag, or an attitude or rates that are carried over a waypoint.
//!
//! A node names its carried attitude and rates by an index into an arena of the reach set; equal ones (to 1e-6) share
//! an index. One hull per carried state and velocity bin is simulated once and remembered.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard};

use nalgebra::{Point3, Vector3, Vector4};

use super::hull::{HullSettings, simulate};
use super::polytope::Polytope;
use super::sampling;
use super::step::{StepSettings, features};
use super::{Leg, Reach};
use crate::robot::quadrotor::{Quadrotor, QuadrotorState, level_rest};

/// A step-wise node with what the robot carries over its waypoint. The start is (0, 0, 0).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CarriedNode {
    /// The waypoint before; equal to `current` at the start.
    pub previous: u32,
    /// The current waypoint.
    pub current: u32,
    /// Index of attitude and rates in the arena of the reach set; 0: level, at rest.
    pub carried: u32,
}

/// What is carried and what is simulated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BruteForceSettings {
    /// Sampling of the runs.
    pub hull: HullSettings,
    /// Step, velocity estimate, cap; its `step` is that of `hull`.
    pub step: StepSettings,
    /// Whether the attitude at a waypoint is that of the run which ended nearest; else level.
    pub keep_attitude: bool,
    /// Whether the rates are; else zero.
    pub keep_rates: bool,
    /// Whether quadratic drag and aerodynamic moment act.
    pub full_drag: bool,
    /// Edge of the cells of entry velocity that share a hull under quadratic drag, m/s; 0: every velocity its own.
    pub velocity_bin: f64,
}

/// The ends of all runs of one bin, and their hull (`None` if flat: then nothing is in reach).
struct Bin {
    velocity: Vector3<f64>,
    ends: Vec<QuadrotorState>,
    polytope: Option<Polytope>,
}

#[derive(Default)]
struct Memory {
    carried: Vec<[f64; 7]>,
    index: BTreeMap<[i64; 7], u32>,
    bins: BTreeMap<(u32, [i64; 3]), Arc<Bin>>,
}

/// Reach by brute force; `legs` simulates on first sight of a bin.
pub struct BruteForce {
    model: Quadrotor,
    speeds: Vec<Vector4<f64>>,
    settings: BruteForceSettings,
    carry: f64,
    memory: Mutex<Memory>,
}

impl BruteForce {
    /// For `robot`, under settings that [`super::Hull::new`] would take.
    pub fn new(robot: &Quadrotor, settings: BruteForceSettings) -> Self {
        let mut model = robot.clone();
        if !settings.full_drag {
            (model.drag_quadratic, model.aerodynamic_moment) = (0.0, 0.0);
        }
        let speeds = sampling::constant_speeds(robot, settings.hull.resolution);
        let memory = Memory { carried: vec![[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]], ..Memory::default() };
        let carry = sampling::carry(robot, settings.hull.step);
        Self { model, speeds, settings, carry, memory: Mutex::new(memory) }
    }

    /// Attitude (w, x, y, z) and rates (rad/s) of index `carried`; level and at rest for one that was never given out.
    pub fn carried_state(&self, carried: u32) -> [f64; 7] {
        let memory = self.lock();
        memory.carried.get(carried as usize).copied().unwrap_or(memory.carried[0])
    }

    /// A panic of another thread leaves the memory whole: entries are only ever added complete.
    fn lock(&self) -> MutexGuard<'_, Memory> {
        self.memory.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn bin(&self, carried: u32, velocity: &Vector3<f64>) -> Arc<Bin> {
        let edge = if self.settings.velocity_bin > 0.0 { self.settings.velocity_bin } else { 1e-9 };
        // Without quadratic drag velocity is carried on by a constant factor: one bin, at rest.
        let cell =
            if self.settings.full_drag { [0, 1, 2].map(|i| (velocity[i] / edge).round() as i64) } else { [0; 3] };
        if let Some(bin) = self.lock().bins.get(&(carried, cell)) {
            return bin.clone();
        }
        let mut start = level_rest();
        start.fixed_rows_mut::<4>(3).copy_from_slice(&self.carried_state(carried)[..4]);
        start.fixed_rows_mut::<3>(10).copy_from_slice(&self.carried_state(carried)[4..]);
        let centre = Vector3::from(cell.map(|c| c as f64 * edge));
        start.fixed_rows_mut::<3>(7).copy_from(&centre);
        let run = |speeds: &Vector4<f64>| simulate(&self.model, start, speeds, self.settings.hull.step);
        let ends: Vec<QuadrotorState> = self.speeds.iter().map(run).collect();
        let points: Vec<Vector3<f64>> = ends.iter().map(place).collect();
        let bin = Arc::new(Bin { velocity: centre, ends, polytope: Polytope::hull(&points).ok() });
        self.lock().bins.insert((carried, cell), bin.clone());
        bin
    }

    /// The index of what the run that ended nearest to `d` carries on.
    fn kept(&self, bin: &Bin, d: &Vector3<f64>) -> u32 {
        let BruteForceSettings { keep_attitude, keep_rates, .. } = self.settings;
        let nearest = bin.ends.iter().min_by(|a, b| (place(a) - d).norm().total_cmp(&(place(b) - d).norm()));
        let (Some(end), true) = (nearest, keep_attitude || keep_rates) else { return 0 };
        let mut state = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        if keep_attitude {
            state[..4].copy_from_slice(&end.as_slice()[3..7]);
        }
        if keep_rates {
            state[4..].copy_from_slice(&end.as_slice()[10..]);
        }
        let key = state.map(|c| (c * 1e6).round() as i64);
        let mut memory = self.lock();
        if let Some(&known) = memory.index.get(&key) {
            return known;
        }
        let new = memory.carried.len() as u32;
        memory.carried.push(state);
        memory.index.insert(key, new);
        new
    }
}

fn place(state: &QuadrotorState) -> Vector3<f64> {
    Vector3::new(state[0], state[1], state[2])
}

impl Reach<CarriedNode> for BruteForce {
    fn legs(&self, from: &CarriedNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<CarriedNode>>) {
        let step = self.settings.hull.step;
        let here = candidates[from.current as usize];
        let before = here - candidates[from.previous as usize];
        let velocity = if self.settings.step.average_velocity { before / step } else { Vector3::zeros() };
        let bin = self.bin(from.carried, &velocity);
        let Some(polytope) = &bin.polytope else { return };
        let drift = (velocity - bin.velocity) * self.carry;
        for (waypoint, there) in (0u32..).zip(candidates) {
            let leg = there - here;
            let d = leg - drift;
            let fast = leg.norm() > self.settings.step.max_speed * step;
            if waypoint != from.current && !fast && polytope.contains(&d) {
                let carried = self.kept(&bin, &d);
                let to = CarriedNode { previous: from.current, current: waypoint, carried };
                out.push(Leg { to, waypoint, duration: step, features: features(&before, &leg, step) });
            }
        }
    }
}
