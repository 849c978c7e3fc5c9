//! What a move costs: distance, a table, time, joint effort, work of a controller, and weighted sums of these.

use super::motion::Motion;
use crate::robot::arm::{AXES, Arm, Joints, Tool};

/// What is counted of a move; costs are whole numbers in [`Cost::unit`].
///
/// Each is of the free move alone, from rest to rest: what blends or speeds of a program make of it is not a graph's
/// business.
#[derive(Debug, Clone, PartialEq)]
pub enum Cost {
    /// Way of the tool's point, µm.
    ///
    /// Of joint moves by 32 chords, which errs low.
    Distance,
    /// Given numbers, row = from, taken as they are.
    Table(Vec<i64>),
    /// Time of the move under joint speeds and accelerations, from rest to rest, µs.
    Time,
    /// ∫ Σ τ² dt in N² m² µs where the arm has masses; else ∫ Σ q̈² dt in rad²/s⁴ ms.
    JointEffort,
    /// Interpolation steps of 4 ms and the Newton steps of the inverse kinematics at each, counted.
    ///
    /// Without a unit of time: for comparing moves with one another.
    ControllerLoad,
    /// Σ weight · cost, each in its own unit, rounded.
    Sum(Vec<(f64, Cost)>),
}

/// Samples of a move, one more than pieces.
const SAMPLES: usize = 33;
/// Interpolation period of the controller that work is counted of, s.
const PERIOD: f64 = 0.004;

/// A trapezoid over s from rest to rest: speed v, acceleration a, time T.
///
/// In the move's parameter s in [0, 1].
///
/// s(0) = 0, s(T) = 1, at rest at both; a triangle where the speed is not reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trapezoid {
    /// Largest ds/dt, 1/s.
    pub speed: f64,
    /// d²s/dt² of both ramps, 1/s².
    pub acceleration: f64,
    /// Time of the whole move, s.
    pub time: f64,
}

impl Trapezoid {
    /// The fastest one within a speed and an acceleration: T = 1/v + v/a, or 2/√a where the speed is not reached.
    ///
    /// 1/s and 1/s², both > 0.
    fn new(speed: f64, acceleration: f64) -> Self {
        let speed = speed.min(acceleration.sqrt());
        Self { speed, acceleration, time: 1.0 / speed + speed / acceleration }
    }

    /// When s is passed, s.
    ///
    /// `s` in 0 … 1; 0 at the start, `time` at the end.
    fn when(&self, s: f64) -> f64 {
        let ramp = self.speed * self.speed / (2.0 * self.acceleration);
        if s < ramp {
            (2.0 * s / self.acceleration).sqrt()
        } else if 1.0 - s < ramp {
            self.time - (2.0 * (1.0 - s).max(0.0) / self.acceleration).sqrt()
        } else {
            self.speed / self.acceleration + (s - ramp) / self.speed
        }
    }

    /// ds/dt and d²s/dt² at s: v² = 2 a s on the first ramp, 2 a (1 − s) on the last.
    fn at(&self, s: f64) -> (f64, f64) {
        let ramp = self.speed * self.speed / (2.0 * self.acceleration);
        if s < ramp {
            ((2.0 * self.acceleration * s).sqrt(), self.acceleration)
        } else if 1.0 - s < ramp {
            ((2.0 * self.acceleration * (1.0 - s)).max(0.0).sqrt(), -self.acceleration)
        } else {
            (self.speed, 0.0)
        }
    }
}

/// A move in joints at equal steps of s, with its first two derivatives.
struct Sampled {
    /// rad.
    q: Vec<Joints>,
    /// dq/ds and d²q/ds², rad.
    first: Vec<Joints>,
    second: Vec<Joints>,
}

impl Cost {
    /// What one unit is.
    pub fn unit(&self) -> &'static str {
        match self {
            Self::Distance => "µm",
            Self::Time => "µs",
            Self::JointEffort => "effort",
            Self::ControllerLoad => "steps",
            Self::Table(_) | Self::Sum(_) => "1",
        }
    }

    /// Of the free move `motion` from the joint angles `start`; `entry` is its place in a table. Never negative.
    ///
    /// `start` are the joint angles (rad) that the move begins at, `entry` = from · n + to. Rounded to the nearest
    /// whole unit.
    pub fn of_move(&self, arm: &Arm, tool: &Tool, motion: &Motion, start: &Joints, entry: usize) -> i64 {
        self.value(arm, tool, motion, start, entry).round() as i64
    }

    /// The same before rounding, in the unit.
    fn value(&self, arm: &Arm, tool: &Tool, motion: &Motion, start: &Joints, entry: usize) -> f64 {
        match self {
            Self::Distance => 1e6 * distance(arm, tool, motion),
            Self::Table(costs) => costs.get(entry).map_or(0.0, |cost| *cost as f64),
            Self::Time => 1e6 * timing(arm, &sample(arm, tool, motion, start)).time,
            Self::JointEffort => effort(arm, tool, &sample(arm, tool, motion, start)),
            Self::ControllerLoad => load(arm, tool, motion, start),
            Self::Sum(terms) => terms
                .iter()
                .map(|(weight, cost)| weight * cost.value(arm, tool, motion, start, entry))
                .sum::<f64>()
                .max(0.0),
        }
    }
}

/// Time law of a free move from rest to rest under the joints' speeds and accelerations.
///
/// With q̇ = q′ ṡ and q̈ = q′ s̈ + q″ ṡ² the speed is the largest at which every joint keeps its speed and spends at
/// most half of its acceleration on q″; the ramps get what then is left. Sampled at 33 places.
///
/// Bounds hold at the samples; between them a joint may exceed its own by what 33 samples do not see.
pub fn time_law(arm: &Arm, tool: &Tool, motion: &Motion, start: &Joints) -> Trapezoid {
    timing(arm, &sample(arm, tool, motion, start))
}

/// The trapezoid over s ∈ [0, 1] that keeps every joint's bounds at all samples: with q̇ = q′ṡ and q̈ = q″ṡ² + q′s̈,
/// speed ṡ ≤ min(q̇_max/|q′|, √(q̈_max/2|q″|)), half of the acceleration being left to bends, and s̈ ≤ (q̈_max −
/// |q″|ṡ²)/|q′|.
///
/// Joints that do not move do not bind. At most 10⁶ 1/s and 10¹² 1/s².
fn timing(arm: &Arm, sampled: &Sampled) -> Trapezoid {
    let all = || {
        sampled
            .first
            .iter()
            .zip(&sampled.second)
            .flat_map(|(first, second)| (0..AXES).map(|k| (k, first[k].abs(), second[k].abs())))
    };
    // A move in place takes no time worth telling; a pure number keeps it finite.
    let mut speed: f64 = 1e6;
    for (k, first, second) in all() {
        let limit = &arm.limits[k];
        speed = speed.min(limit.speed / first).min((0.5 * limit.acceleration / second).sqrt());
    }
    let left = all().map(|(k, first, second)| (arm.limits[k].acceleration - second * speed * speed) / first);
    Trapezoid::new(speed, left.fold(1e12, f64::min))
}

/// [`SAMPLES`] equal steps in s, one branch throughout; q′ and q″ by central differences, those at the ends taken from
/// the neighbours. Where the inverse has no answer the joints before are kept.
fn sample(arm: &Arm, tool: &Tool, motion: &Motion, start: &Joints) -> Sampled {
    let (mut q, mut last) = (Vec::with_capacity(SAMPLES), *start);
    let branch = arm.branch(start);
    for i in 0..SAMPLES {
        let s = i as f64 / (SAMPLES - 1) as f64;
        last = match (motion, motion.pose(s)) {
            (Motion::Joint { start, end }, _) => std::array::from_fn(|k| start[k] + s * (end[k] - start[k])),
            (_, Some(pose)) => {
                arm.inverse_in(&(pose * tool.tcp.inverse()), branch, &last).map_or(last, |found| found.joints)
            }
            (_, None) => last,
        };
        q.push(last);
    }
    let h = 1.0 / (SAMPLES - 1) as f64;
    let at = |i: usize, k: usize| q[i][k];
    // Central differences; at the ends those of the neighbours.
    let inner = |i: usize| i.clamp(1, SAMPLES - 2);
    let first = (0..SAMPLES)
        .map(|i| std::array::from_fn(|k| (at(inner(i) + 1, k) - at(inner(i) - 1, k)) / (2.0 * h)))
        .collect();
    let second = (0..SAMPLES)
        .map(|i| std::array::from_fn(|k| (at(inner(i) + 1, k) - 2.0 * at(inner(i), k) + at(inner(i) - 1, k)) / (h * h)))
        .collect();
    Sampled { q, first, second }
}

/// m; of joint moves the sum of 32 chords.
fn distance(arm: &Arm, tool: &Tool, motion: &Motion) -> f64 {
    match motion {
        Motion::Joint { start, end } => {
            let at = |s: f64| {
                let q: Joints = std::array::from_fn(|k| start[k] + s * (end[k] - start[k]));
                (arm.forward(&q) * tool.tcp).translation.vector
            };
            let pieces = SAMPLES - 1;
            (0..pieces).map(|i| (at((i + 1) as f64 / pieces as f64) - at(i as f64 / pieces as f64)).norm()).sum()
        }
        _ => motion.sweep(&tool.tcp).speed,
    }
}

/// By the midpoint rule over s, each piece with the time that it takes.
///
/// Torques by [`Arm::torques`], N·m, where masses are known; accelerations otherwise. Pieces on which the speed is 0 at
/// an end take their time from the law itself, so that no quotient by a speed occurs.
fn effort(arm: &Arm, tool: &Tool, sampled: &Sampled) -> f64 {
    let law = timing(arm, sampled);
    let h = 1.0 / (SAMPLES - 1) as f64;
    let masses = arm.has_masses();
    let mut sum = 0.0;
    for i in 0..SAMPLES - 1 {
        let (rate, push) = law.at((i as f64 + 0.5) * h);
        let middle = |all: &[Joints]| -> Joints { std::array::from_fn(|k| 0.5 * (all[i][k] + all[i + 1][k])) };
        let (first, second) = (middle(&sampled.first), middle(&sampled.second));
        let speed: Joints = first.map(|first| first * rate);
        let acceleration: Joints = std::array::from_fn(|k| first[k] * push + second[k] * rate * rate);
        let load = arm.torques(tool, &middle(&sampled.q), &speed, &acceleration).unwrap_or(acceleration);
        sum += load.iter().map(|x| x * x).sum::<f64>() * (law.when((i + 1) as f64 * h) - law.when(i as f64 * h));
    }
    sum * if masses { 1e6 } else { 1e3 }
}

/// Counts what a controller does: a step every 4 ms, and at each the Newton steps of the inverse from the step before.
///
/// Where the inverse has no answer a step costs 1.
fn load(arm: &Arm, tool: &Tool, motion: &Motion, start: &Joints) -> f64 {
    let law = time_law(arm, tool, motion, start);
    let steps = (law.time / PERIOD).ceil().max(1.0) as usize;
    let (mut last, mut count) = (*start, 0u64);
    for i in 1..=steps {
        count += 1;
        let Some(pose) = motion.pose(i as f64 / steps as f64) else { continue };
        if let Some(found) = arm.chain.inverse_near(&(pose * tool.tcp.inverse()), &last) {
            count += u64::from(found.iterations);
            last = found.joints;
        }
    }
    count as f64
}
