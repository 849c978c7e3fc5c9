//! Reach by simulating every sampled run from the node's own state: the oracle of `hull`, and what is used where the
//! identity behind `hull` breaks: quadratic drag, or an attitude or rates that are carried over a waypoint.
//!
//! What is carried is put into cells, and a run starts from its cell's middle: a cell's hull depends on nothing else,
//! so it may be simulated once and remembered, or forgotten and simulated again, with the same result.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard};

use nalgebra::{Point3, UnitQuaternion, Vector3, Vector4};

use super::features::features;
use super::hull::{HullSettings, NoHull, check, simulate};
use super::polytope::Polytope;
use super::sampling;
use super::step::StepSettings;
use super::{Leg, Reach};
use crate::math::rotation::{from_rotation_vector, rotation_vector, unit_quaternion};
use crate::robot::quadrotor::{Quadrotor, QuadrotorState, level_rest};

/// A step-wise node with what the robot carries over its waypoint. The start is (0, 0, 0s).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CarriedNode {
    /// The waypoint before; equal to `current` at the start.
    pub previous: u32,
    /// The current waypoint.
    pub current: u32,
    /// Cell of the attitude's rotation vector, in edges of [`BruteForceSettings::attitude_bin`], and of the rates, in
    /// edges of [`BruteForceSettings::rate_bin`]; all 0: level, at rest.
    pub carried: [i32; 6],
}

/// What is carried and what is simulated.
///
/// What is not carried is reset at each waypoint, as the hull's identity has it; with nothing carried and no quadratic
/// drag this is the hull, and a test holds both to each other.
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
    /// Edge of the cells of carried attitude, as a rotation vector, rad: 1e-6 to 1.
    pub attitude_bin: f64,
    /// Edge of the cells of carried rates, rad/s: at least 1e-5.
    pub rate_bin: f64,
    /// Hulls remembered at once, at least 1. One of resolution 5 takes 70 kB.
    pub remembered: usize,
}

impl Default for BruteForceSettings {
    fn default() -> Self {
        Self {
            hull: HullSettings::default(),
            step: StepSettings::default(),
            keep_attitude: false,
            keep_rates: false,
            full_drag: false,
            velocity_bin: 0.5,
            attitude_bin: 0.1,
            rate_bin: 1.0,
            remembered: 1024,
        }
    }
}

/// Cell of what is carried, and of the entry velocity.
type Key = ([i32; 6], [i64; 3]);

/// The ends of all runs from one cell, and their hull (`None` if flat: then nothing is in reach).
struct Bin {
    velocity: Vector3<f64>,
    ends: Vec<QuadrotorState>,
    polytope: Option<Polytope>,
}

/// Reach by brute force; `legs` simulates on first sight of a cell.
///
/// Far dearer than a hull until its cells are known; its use is to be the oracle, and to say what the hull's
/// assumptions cost.
///
/// Shared between threads behind a lock; what is remembered changes the time and never the answer.
pub struct BruteForce {
    model: Quadrotor,
    speeds: Vec<Vector4<f64>>,
    settings: BruteForceSettings,
    carry: f64,
    bins: Mutex<BTreeMap<Key, Arc<Bin>>>,
}

impl BruteForce {
    /// For `robot`, under these settings.
    ///
    /// Nothing is simulated yet.
    ///
    /// # Errors
    /// [`NoHull::Setting`]: a setting out of bounds.
    pub fn new(robot: &Quadrotor, settings: BruteForceSettings) -> Result<Self, NoHull> {
        checked(&settings)?;
        let mut model = robot.clone();
        if !settings.full_drag {
            (model.drag_quadratic, model.aerodynamic_moment) = (0.0, 0.0);
        }
        let speeds = sampling::constant_speeds(robot, settings.hull.resolution);
        let carry = sampling::carry(robot, settings.hull.step);
        Ok(Self { model, speeds, settings, carry, bins: Mutex::default() })
    }

    /// Attitude (world from body) and rates (rad/s) in the middle of a cell.
    pub fn carried_state(&self, carried: &[i32; 6]) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let middle = |first: usize, edge: f64| Vector3::from_fn(|i, _| f64::from(carried[first + i]) * edge);
        let attitude = from_rotation_vector(&middle(0, self.settings.attitude_bin));
        (attitude, middle(3, self.settings.rate_bin))
    }

    /// Number of hulls in memory.
    pub fn remembered(&self) -> usize {
        self.lock().len()
    }

    /// A panic of another thread leaves the memory whole: entries are only ever added complete.
    fn lock(&self) -> MutexGuard<'_, BTreeMap<Key, Arc<Bin>>> {
        self.bins.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// The end points of all sampled runs from the cell's middle, and their hull; simulated once, then looked up, until
    /// more than `remembered` cells make it forget them all.
    fn bin(&self, carried: &[i32; 6], velocity: &Vector3<f64>) -> Arc<Bin> {
        let edge = if self.settings.velocity_bin > 0.0 { self.settings.velocity_bin } else { 1e-9 };
        // Without quadratic drag velocity is carried on by a constant factor: one cell, at rest.
        let cell =
            if self.settings.full_drag { [0, 1, 2].map(|i| (velocity[i] / edge).round() as i64) } else { [0; 3] };
        let key = (*carried, cell);
        if let Some(bin) = self.lock().get(&key) {
            return bin.clone();
        }
        let velocity = Vector3::from(cell.map(|c| c as f64 * edge));
        let (attitude, rates) = self.carried_state(carried);
        let mut start = level_rest();
        start.fixed_rows_mut::<4>(3).copy_from_slice(&[attitude.w, attitude.i, attitude.j, attitude.k]);
        start.fixed_rows_mut::<3>(7).copy_from(&velocity);
        start.fixed_rows_mut::<3>(10).copy_from(&rates);
        let run = |speeds: &Vector4<f64>| simulate(&self.model, start, speeds, self.settings.hull.step);
        let ends: Vec<QuadrotorState> = self.speeds.iter().map(run).collect();
        let points: Vec<Vector3<f64>> = ends.iter().map(place).collect();
        let bin = Arc::new(Bin { velocity, ends, polytope: Polytope::hull(self.settings.hull.simd, &points).ok() });
        let mut bins = self.lock();
        if bins.len() >= self.settings.remembered {
            bins.clear();
        }
        bins.insert(key, bin.clone());
        bin
    }

    /// The cell of what the run that ended nearest to `d` carries on.
    ///
    /// Rounded to the nearest cell; 0 for what is not to be kept.
    fn kept(&self, bin: &Bin, d: &Vector3<f64>) -> [i32; 6] {
        let BruteForceSettings { keep_attitude, keep_rates, attitude_bin, rate_bin, .. } = self.settings;
        if !keep_attitude && !keep_rates {
            return [0; 6];
        }
        let nearest = bin.ends.iter().min_by(|a, b| (place(a) - d).norm().total_cmp(&(place(b) - d).norm()));
        let Some(end) = nearest else { return [0; 6] };
        let attitude = rotation_vector(&unit_quaternion(&end.as_slice()[3..7]));
        let cell = |value: f64, edge: f64, keep: bool| if keep { (value / edge).round() as i32 } else { 0 };
        std::array::from_fn(|i| match i {
            0..3 => cell(attitude[i], attitude_bin, keep_attitude),
            _ => cell(end[7 + i], rate_bin, keep_rates),
        })
    }
}

/// Position of a state, m.
fn place(state: &QuadrotorState) -> Vector3<f64> {
    Vector3::new(state[0], state[1], state[2])
}

/// The first setting out of bounds, by name.
fn checked(settings: &BruteForceSettings) -> Result<(), NoHull> {
    check(&settings.hull)?;
    let bounds: [(&'static str, f64, bool, &'static str); 6] = [
        ("step_s", settings.step.step, settings.step.step == settings.hull.step, "the step of the hull"),
        ("max_speed_m_s", settings.step.max_speed, settings.step.max_speed > 0.0, "above 0"),
        ("velocity_bin_m_s", settings.velocity_bin, (0.0..1e3).contains(&settings.velocity_bin), "0 to 1000 m/s"),
        ("attitude_bin_rad", settings.attitude_bin, (1e-6..=1.0).contains(&settings.attitude_bin), "1e-6 to 1 rad"),
        ("rate_bin_rad_s", settings.rate_bin, (1e-5..=1e3).contains(&settings.rate_bin), "1e-5 to 1000 rad/s"),
        ("remembered", settings.remembered as f64, settings.remembered > 0, "at least 1 hull"),
    ];
    match bounds.into_iter().find(|(_, _, holds, _)| !holds) {
        Some((field, value, _, bound)) => Err(NoHull::Setting { field, value, bound }),
        None => Ok(()),
    }
}

impl Reach<CarriedNode> for BruteForce {
    fn legs(&self, from: &CarriedNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<CarriedNode>>) {
        let step = self.settings.hull.step;
        let here = candidates[from.current as usize];
        let before = here - candidates[from.previous as usize];
        let velocity = if self.settings.step.average_velocity { before / step } else { Vector3::zeros() };
        let bin = self.bin(&from.carried, &velocity);
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
