//! The shooting: parameters and length for which the drive ends in its goal, least in what exceeds a bound and in how
//! much it bends.
//!
//! With unknowns z = (p, L), constraints c(z) = 0 (end position, turn, curvatures) and costs h(z), each step solves
//! ```text
//! [B  Jᵀ] [Δz]     [∇h]
//! [J  −μ] [ y] = − [ c ]        B ≈ ∇²h + λ D
//! ```
//! (Gauss-Newton for h, the exact J by variation of the path): Newton's method where there are as many unknowns as
//! constraints, else the step of least cost. λ rises until the merit ρ‖c‖ + h falls (Nocedal & Wright, Numerical
//! optimization, ch. 18).
//!
//! Rows of c, in order: x, y (least radii), turn (rad), κ at start and end, dκ/du at start and end; rows that a task
//! does not ask for stay 0, with a multiplier that −μ keeps at 0. Columns of J: eight parameters, then L. Size of the
//! system: 9 + 7 equations, solved densely.

use super::basis::{MOST, Row};
use super::grid::{Grid, Node};
use super::settings::Settings;
use crate::feasibility::steering::shooting::Curvatures;
use crate::feasibility::steering::shooting::flat::Cost;
use crate::math::linear::solve;

/// Unknowns: the parameters and the length.
const UNKNOWNS: usize = MOST + 1;
/// Constraints: x, y, turn, κ and κ̇ at both ends.
const CONSTRAINTS: usize = 7;
const SYSTEM: usize = UNKNOWNS + CONSTRAINTS;

/// What a drive is held to; its frame heads along the first direction of travel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task {
    /// Where it ends, m.
    pub(super) place: [f64; 2],
    /// Change of the body's heading, rad, not modulo 2π.
    pub(super) turn: f64,
    /// Change of the direction of travel in the body, rad.
    pub(super) swing: f64,
    /// κ at the start.
    pub(super) start: f64,
    /// κ at the end; `None` where it is as it comes.
    pub(super) end: Option<f64>,
    /// In the task's own units, where the largest curvature is 1.
    pub(super) bounds: Curvatures,
    /// What is lowered beside.
    pub(super) cost: Cost,
    /// What a drive of less cost may be at the longest, m.
    pub(super) longest: f64,
    /// Misses below which the goal is met, m, rad and 1/m.
    pub(super) tolerance: f64,
}

/// Parameters and length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Free {
    /// p; those beyond the family's count stay 0.
    pub(super) parameters: Row,
    /// L > 0.
    pub(super) length: f64,
}

/// How a descent ended.
///
/// In the task's units: lengths over the least radius, so that most = 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    /// The drive.
    pub(super) free: Free,
    /// Largest of the constraints' errors, m, rad, 1/m.
    pub(super) miss: f64,
    /// Largest |κ|/most or |κ′|/most_rate at the nodes.
    pub(super) bends: f64,
    /// Steps taken, polishing included.
    pub(super) iterations: u32,
}

impl Fit {
    /// Whether goal and bounds are met.
    ///
    /// miss ≤ `tolerance` and bends ≤ [`ENOUGH`], a little below 1 for what lies between nodes.
    pub(super) fn good(&self, tolerance: f64) -> bool {
        self.miss <= tolerance && self.bends <= ENOUGH
    }
}

/// Share of the bounds that is aimed at; the rest is for what lies between nodes.
const ROOM: f64 = 0.997;
/// What of them is left is kept between nodes, too.
const ENOUGH: f64 = 0.9985;
/// Weights of what exceeds the bounds, of κ′², and of a length other than at the start. The first grows if it does not
/// help.
const STRICT: f64 = 1.0;
const SMOOTH: f64 = 1e-4;
const NEAR: f64 = 1e-4;
/// Weight of a cost that is asked for: little against the bounds, much against what else draws a drive.
const CHEAP: f64 = 0.01;
/// Factors of the first.
const STRICTER: [f64; 3] = [1.0, 100.0, 1e4];
/// Longest step: of the curvature, as a share of its bound, and of the length, as a share of itself.
const BOLDEST: [f64; 2] = [0.6, 0.3];
/// Tries of one step, two with each damping.
const ATTEMPTS: u32 = 12;
/// What a miss costs beside its multipliers.
const PRICE: f64 = 0.1;
/// Last steps of a descent.
const POLISH: u32 = 4;
/// The least μ: constraints that contradict each other are met as nearly as they can be.
const SOFT: f64 = 1e-10;

/// The drive of some parameters, with its derivatives.
///
/// Everything that a step needs, from one pass over the grid.
struct Shot {
    /// c: what is had less what is wanted.
    constraints: [f64; CONSTRAINTS],
    /// ∂c/∂z.
    jacobian: [[f64; UNKNOWNS]; CONSTRAINTS],
    /// h, with ∇h and its Gauss-Newton matrix in the next two.
    cost: f64,
    gradient: [f64; UNKNOWNS],
    hessian: [[f64; UNKNOWNS]; UNKNOWNS],
    bends: f64,
}

impl Shot {
    /// max |c|; infinite where one is no number.
    fn miss(&self) -> f64 {
        self.constraints.iter().fold(0.0, |most: f64, c| if c.is_nan() { f64::INFINITY } else { most.max(c.abs()) })
    }

    /// ‖c‖.
    fn norm(&self) -> f64 {
        self.constraints.iter().map(|c| c * c).sum::<f64>().sqrt()
    }
}

/// Σ aᵢ bᵢ.
fn dot(a: &Row, b: &Row) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// One pass over the grid: end position x = L Σ w cos θ, y = L Σ w sin θ with θ(u) = L p·I(u) (and the swing of the
/// wheels' direction), turn L p·I(1), end curvatures p·B, and end slopes p·B′ = 0 where a clock rests. The Jacobian is
/// exact: ∂x/∂pᵢ = −L² Σ w sin θ Iᵢ, ∂x/∂L = Σ w cos θ − Σ w L p·I sin θ. Excesses over bounds are looked at at the
/// same nodes and the two ends.
///
/// `from` is the length that a drive without a cost is held near, `strict` the weight of what exceeds the bounds.
fn shoot(grid: &Grid, task: &Task, free: &Free, from: f64, strict: f64) -> Shot {
    let Free { parameters: p, length } = free;
    let (length, last) = (*length, UNKNOWNS - 1);
    let mut shot = Shot {
        constraints: [0.0; CONSTRAINTS],
        jacobian: [[0.0; UNKNOWNS]; CONSTRAINTS],
        cost: 0.0,
        gradient: [0.0; UNKNOWNS],
        hessian: [[0.0; UNKNOWNS]; UNKNOWNS],
        bends: 0.0,
    };
    let mut squares = Squares::default();
    let (mut x, mut y) = (0.0, 0.0);
    let mut by = [[0.0; UNKNOWNS]; 2];
    for node in grid.nodes() {
        let heading = length * dot(p, &node.integral);
        let (sin, cos) = libm::sincos(heading + task.swing * node.share);
        let (along, across) = (node.weight * cos, node.weight * sin);
        x += along;
        y += across;
        for (i, integral) in node.integral.iter().enumerate() {
            by[0][i] -= across * length * integral;
            by[1][i] += along * length * integral;
        }
        by[0][last] -= across * heading / length;
        by[1][last] += along * heading / length;
        shot.look(task, free, node, strict);
        squares.add(p, if task.cost == Cost::Curvature { &node.value } else { &node.slope }, node.weight);
    }
    for end in &grid.ends {
        shot.look(task, free, end, strict);
    }
    shot.charge(task, &squares, length, from);
    shot.constraints[0] = length * x - task.place[0];
    shot.constraints[1] = length * y - task.place[1];
    for (row, (by, sum)) in shot.jacobian.iter_mut().zip(by.iter().zip([x, y])) {
        for (value, by) in row.iter_mut().zip(by) {
            *value = length * by;
        }
        row[last] += sum;
    }
    let whole = dot(p, &grid.ends[1].integral);
    shot.constraints[2] = length * whole - task.turn;
    shot.jacobian[2][last] = whole;
    for i in 0..MOST {
        shot.jacobian[2][i] = length * grid.ends[1].integral[i];
    }
    let rows = [
        Some((&grid.ends[0].value, task.start)),
        task.end.map(|end| (&grid.ends[1].value, end)),
        grid.rests[0].then_some((&grid.end_slopes[0], 0.0)),
        grid.rests[1].then_some((&grid.end_slopes[1], 0.0)),
    ];
    for (index, row) in rows.into_iter().enumerate() {
        let Some((row, wanted)) = row else { continue };
        shot.constraints[3 + index] = dot(p, row) - wanted;
        shot.jacobian[3 + index][..MOST].copy_from_slice(row);
    }
    shot
}

/// ∫q² dσ of a quantity that is linear in the parameters, halves of its gradient and of its second derivatives.
#[derive(Default)]
struct Squares {
    whole: f64,
    image: Row,
    matrix: [Row; MOST],
}

impl Squares {
    /// One node's share of the sums.
    ///
    /// With q = p·row: whole += w q², image += w q row, matrix += w row rowᵀ.
    fn add(&mut self, parameters: &Row, row: &Row, weight: f64) {
        let value = dot(parameters, row);
        self.whole += weight * value * value;
        for i in 0..MOST {
            self.image[i] += weight * value * row[i];
            for j in 0..MOST {
                self.matrix[i][j] += weight * row[i] * row[j];
            }
        }
    }
}

impl Shot {
    /// Adds half the cost f(L) ∫q² dσ: L for ∫κ² ds, 1/L for ∫κ′² ds; without one a little of both smoothness and the
    /// length at the start. The last second derivative is as large as makes all of them a convex function's.
    fn charge(&mut self, task: &Task, squares: &Squares, length: f64, from: f64) {
        let last = UNKNOWNS - 1;
        let (factor, by_length, bent) = match task.cost {
            Cost::Any => (SMOOTH / (task.bounds.most * task.bounds.most), 0.0, 0.0),
            Cost::Curvature => (CHEAP * length, CHEAP, CHEAP / length),
            Cost::Rate => {
                let share = CHEAP / length;
                (share, -share / length, share / (length * length))
            }
        };
        self.cost += 0.5 * factor * squares.whole;
        self.gradient[last] += 0.5 * by_length * squares.whole;
        self.hessian[last][last] += bent * squares.whole;
        for i in 0..MOST {
            self.gradient[i] += factor * squares.image[i];
            self.hessian[i][last] += by_length * squares.image[i];
            self.hessian[last][i] += by_length * squares.image[i];
            for j in 0..MOST {
                self.hessian[i][j] += factor * squares.matrix[i][j];
            }
        }
        // Longer drives bend less without an end: beyond the longest they cost.
        let (stretch, unit, weight) = if task.cost == Cost::Any {
            ((length - from) / from, from, NEAR)
        } else {
            ((length / task.longest - 1.0).max(0.0), task.longest, STRICT)
        };
        if stretch != 0.0 {
            self.cost += 0.5 * weight * stretch * stretch;
            self.gradient[last] += weight * stretch / unit;
            self.hessian[last][last] += weight / (unit * unit);
        }
    }

    /// Adds what exceeds the bounds at `node`.
    ///
    /// Half `weight` times the square of what |κ|/most and |κ′|/most_rate are over 0.997, κ′ = p·B_σ/L. Nodes weigh by
    /// their share of the way, the two ends by 0.01.
    fn look(&mut self, task: &Task, free: &Free, node: &Node, strict: f64) {
        let last = UNKNOWNS - 1;
        let Curvatures { most, most_rate } = task.bounds;
        let curvature = dot(&free.parameters, &node.value) / most;
        let rate = dot(&free.parameters, &node.slope) / (most_rate * free.length);
        self.bends = self.bends.max(curvature.abs()).max(rate.abs());
        let weight = strict * if node.weight > 0.0 { node.weight } else { 0.01 };
        for (value, row, unit, by_length) in
            [(curvature, &node.value, most, 0.0), (rate, &node.slope, most_rate * free.length, -rate / free.length)]
        {
            let excess = value.abs() - ROOM;
            if excess <= 0.0 {
                continue;
            }
            let sign = value.signum();
            let mut by = [0.0; UNKNOWNS];
            for (by, value) in by.iter_mut().zip(row) {
                *by = sign * value / unit;
            }
            by[last] = sign * by_length;
            self.cost += 0.5 * weight * excess * excess;
            for i in 0..UNKNOWNS {
                self.gradient[i] += weight * excess * by[i];
                for j in 0..UNKNOWNS {
                    self.hessian[i][j] += weight * by[i] * by[j];
                }
            }
        }
    }
}

/// Descends from `start`, as many steps as `settings` say at most; `observe` sees the miss and the bends after each.
///
/// At most three descents in a row, each with a hundredfold weight on what exceeds the bounds, from where the last one
/// ended.
///
/// Merit of a step: price · ‖c‖ + h with price = 2‖y‖ + 0.1, which exceeds the multipliers y, so that the step goes
/// down it; taken as soon as it falls. Ends after two steps in a row of hardly any gain, at the step limit, or where
/// twelve tries do not lower it; then up to four whole Newton steps on the constraints alone.
pub(super) fn descend(
    grid: &Grid,
    task: &Task,
    start: Free,
    settings: &Settings,
    observe: &mut dyn FnMut(u32, &Free, f64, f64),
) -> Fit {
    let from = start.length;
    let mut free = start;
    let mut iterations = 0;
    let mut best: Option<Fit> = None;
    for factor in STRICTER {
        let strict = STRICT * factor;
        let mut shot = shoot(grid, task, &free, from, strict);
        let (mut damping, mut settled) = (1e-6, 0);
        while iterations < settings.iterations && settled < 2 {
            iterations += 1;
            let mut moved = false;
            for attempt in 0..ATTEMPTS {
                // A step along the goal's conditions that bends them more than it gains is tried again across them
                // alone.
                let aim = if attempt % 2 == 0 { Aim::Both } else { Aim::Goal };
                let tried = step(grid, task, &shot, &free, damping, aim).and_then(|(step, multipliers)| {
                    let next = taken(grid, &free, &step, settings.step_scale)?;
                    Some((shoot(grid, task, &next, from, strict), next, 2.0 * multipliers + PRICE))
                });
                if let Some((tried, next, price)) = tried {
                    let (before, after) = (price * shot.norm() + shot.cost, price * tried.norm() + tried.cost);
                    if after < before {
                        let gain = before - after;
                        let little = if tried.miss() < 0.1 * task.tolerance { 1e-4 } else { 1e-9 };
                        settled = if gain <= little * before { settled + 1 } else { 0 };
                        (free, shot) = (next, tried);
                        damping = (0.2 * damping).max(1e-9);
                        moved = true;
                        break;
                    }
                }
                damping *= if attempt % 2 == 0 { 1.0 } else { 30.0 };
            }
            observe(iterations, &free, shot.miss(), shot.bends);
            if !moved {
                break;
            }
        }
        // Near the goal whole steps of Newton's method make its conditions exact, whatever little they cost.
        for _ in 0..POLISH {
            let step = step(grid, task, &shot, &free, 0.0, Aim::Goal).filter(|_| shot.miss() < 10.0 * task.tolerance);
            let Some(next) = step.and_then(|(step, _)| taken(grid, &free, &step, 1.0)) else { break };
            let tried = shoot(grid, task, &next, from, strict);
            if tried.miss() >= 0.5 * shot.miss() || tried.bends > shot.bends.max(1.0) + 1e-3 {
                break;
            }
            (free, shot) = (next, tried);
            iterations += 1;
        }
        let fit = Fit { free, miss: shot.miss(), bends: shot.bends, iterations };
        if fit.good(task.tolerance) {
            return fit;
        }
        if best.is_none_or(|best| grade(&fit, task) < grade(&best, task)) {
            best = Some(fit);
        }
        if fit.miss > task.tolerance {
            break;
        }
    }
    let lost = f64::INFINITY;
    let best = best.unwrap_or(Fit { free, miss: lost, bends: lost, iterations });
    Fit { iterations, ..best }
}

/// Less is better: whether the goal is met counts before the bounds.
pub(super) fn grade(fit: &Fit, task: &Task) -> (bool, f64) {
    let met = fit.miss <= task.tolerance;
    (!met, if met { fit.bends } else { fit.miss })
}

/// What a step is for.
///
/// The last steps of a descent aim at the goal alone, where convergence is quadratic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Aim {
    /// The goal's conditions and less cost.
    Both,
    /// The conditions alone, by the least change.
    Goal,
}

/// The step from `shot` and the size of the constraints' multipliers; `None` where the system is singular.
///
/// Cut to 0.6 of the curvature bound (the sum over all parameters) and to 0.3 of the length. μ = 10⁻¹⁰, plus the
/// damping once that is above 10⁻⁴.
fn step(grid: &Grid, task: &Task, shot: &Shot, free: &Free, damping: f64, aim: Aim) -> Option<([f64; UNKNOWNS], f64)> {
    // The equations, their right-hand sides in the last column.
    let mut rows = [[0.0; SYSTEM + 1]; SYSTEM];
    let scale = [1.0 / (task.bounds.most * task.bounds.most), 1.0 / (free.length * free.length)];
    for (i, row) in rows[..UNKNOWNS].iter_mut().enumerate() {
        row[..UNKNOWNS].copy_from_slice(&shot.hessian[i]);
        let unit = if i < MOST { scale[0] } else { scale[1] };
        // Parameters that the family does not have stay as they are.
        let idle = i >= grid.count && i < MOST;
        row[i] += if idle { 1.0 } else { (damping + 1e-9) * unit };
        row[SYSTEM] = if aim == Aim::Both { -shot.gradient[i] } else { 0.0 };
    }
    for (c, row) in shot.jacobian.iter().enumerate() {
        for (i, value) in row.iter().enumerate() {
            rows[UNKNOWNS + c][i] = *value;
            rows[i][UNKNOWNS + c] = *value;
        }
        // Soft with the damping: far from the goal a step need not go the whole way.
        rows[UNKNOWNS + c][UNKNOWNS + c] = -(SOFT + if damping > 1e-4 { damping } else { 0.0 });
        rows[UNKNOWNS + c][SYSTEM] = -shot.constraints[c];
    }
    let solution = solve(&mut rows)?;
    let mut step = [0.0; UNKNOWNS];
    step.copy_from_slice(&solution[..UNKNOWNS]);
    let multipliers = solution[UNKNOWNS..].iter().map(|y| y * y).sum::<f64>().sqrt();
    let curvature = step[..MOST].iter().fold(0.0, |sum: f64, p| sum + p.abs()) / task.bounds.most;
    let shrink = (BOLDEST[0] / curvature).min(BOLDEST[1] * free.length / step[MOST].abs()).min(1.0);
    step.iter_mut().for_each(|value| *value *= shrink);
    Some((step, multipliers))
}

/// The unknowns after `step`, if they are numbers and the length stays more than 0.
fn taken(grid: &Grid, free: &Free, step: &[f64; UNKNOWNS], scale: f64) -> Option<Free> {
    let mut next = *free;
    for (parameter, step) in next.parameters[..grid.count].iter_mut().zip(step) {
        *parameter += scale * step;
    }
    next.length += scale * step[MOST];
    (next.length > 1e-9 && next.length.is_finite() && next.parameters.iter().all(|p| p.is_finite())).then_some(next)
}
