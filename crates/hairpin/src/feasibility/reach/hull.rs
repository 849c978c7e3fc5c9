//! `hull`: convex hull of the end points of constant rotor-speed runs; `published`: the same of one Euler step each.
//!
//! Thrust does not depend on velocity, and attitude and rates are reset at every waypoint, so with linear isotropic
//! drag at most the end of a run is x0 + v0·φ(Δt) + R(u), R the same for every state: one polytope serves a whole
//! campaign. Quadratic drag and aerodynamic moment are left out, and must be said to be. What breaks the identity is in
//! [`super::brute_force`]. Neither sound nor complete: a convex hull of end points is not a set of reachable points.
//!
//! ```text
//! end = x₀ + v₀ φ(Δt) + R(u)        K = conv {R(u) : u in Res⁴ rotor speeds}        φ(Δt) = Δt without drag
//! ```
//!
//! From the paper's "Full KD" (Hildebrandt et al., ISSTA 2020), with the integration done to 5 mm in place of its one
//! Euler step.

use nalgebra::{Vector3, Vector4};
use rand::RngExt;
use thiserror::Error;

use super::polytope::{NoPolytope, Polytope};
use super::sampling;
use super::step::StepSet;
use crate::math::integrate::rk4_step;
use crate::math::random::{named_seed, stream};
use crate::math::simd::Simd;
use crate::robot::quadrotor::published::single_step;
use crate::robot::quadrotor::{EulerState, Quadrotor, QuadrotorState, level_rest};

/// How a hull is sampled.
///
/// Res⁴ runs: 625 at the default, 14 641 at Res 11. Every sampled hull lies in that of all constant speeds, and fills
/// it only slowly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullSettings {
    /// Rotor speeds per rotor (Res), 2 to 12.
    pub resolution: usize,
    /// Duration of a run Δt, s.
    pub step: f64,
    /// Version of the kernels that sample, build and ask the hull.
    pub simd: Simd,
}

impl Default for HullSettings {
    fn default() -> Self {
        Self { resolution: 5, step: 1.0, simd: Simd::default() }
    }
}

/// Why there is no hull.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NoHull {
    /// A setting out of bounds.
    #[error("{field} = {value}: must be {bound}")]
    Setting {
        /// Name of the setting.
        field: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// The end points span no polytope.
    #[error(transparent)]
    Points(#[from] NoPolytope),
    /// The self-check failed: the constant polytope and the simulated model disagree.
    #[error("the reach set fails its self-check: a simulated run ends {error_m} m from where the set puts it")]
    SelfCheck {
        /// Distance, m.
        error_m: f64,
    },
}

/// The polytope K and what goes with it.
///
/// ```
/// use hairpin::feasibility::reach::{Hull, HullSettings};
/// use hairpin::robot::quadrotor::QuadrotorDescription;
/// use nalgebra::Vector3;
///
/// let file = serde_json::json!({
///     "kind": "quadrotor", "name": "toy", "mass_kg": 1.0, "thrust_to_weight": 2.0,
///     "rotors": [{ "x_m": 0.1, "y_m": 0.1, "spin": 1.0 }, { "x_m": -0.1, "y_m": 0.1, "spin": -1.0 },
///                { "x_m": -0.1, "y_m": -0.1, "spin": 1.0 }, { "x_m": 0.1, "y_m": -0.1, "spin": -1.0 }],
/// });
/// let robot = serde_json::from_value::<QuadrotorDescription>(file)?.build()?;
/// let hull = Hull::new(&robot, &HullSettings { resolution: 3, ..HullSettings::default() })?;
/// assert!(hull.contains(&Vector3::zeros())); // between falling and climbing
/// assert!(!hull.contains(&Vector3::new(0.0, 0.0, 9.0))); // ½ · g up is all there is in 1 s
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    polytope: Polytope,
    samples: Vec<Vector3<f64>>,
    carry: f64,
    step: f64,
    simd: Simd,
}

impl Hull {
    /// Samples the robot's constant rotor-speed runs and takes their hull.
    ///
    /// Rotor speeds are even between the robot's limits; runs begin level and at rest. Linear drag acts, quadratic drag
    /// and aerodynamic moment do not.
    ///
    /// # Errors
    /// [`NoHull`]: settings out of bounds, a flat set, or a failed [`Self::self_check`].
    pub fn new(robot: &Quadrotor, settings: &HullSettings) -> Result<Self, NoHull> {
        check(settings)?;
        let speeds = sampling::constant_speeds(robot, settings.resolution);
        let steps = sampling::steps(robot, settings.step);
        let samples = sampling::end_points(settings.simd, robot, &speeds, settings.step, steps);
        let hull = Self::of(samples, sampling::carry(robot, settings.step), settings)?;
        hull.self_check(robot, &speeds)?;
        Ok(hull)
    }

    /// The set of the paper's program: every run is one explicit Euler step of the whole `step`, without drag.
    ///
    /// # Errors
    /// [`NoHull`]: settings out of bounds or a flat set.
    pub fn published(robot: &Quadrotor, settings: &HullSettings) -> Result<Self, NoHull> {
        check(settings)?;
        let run = |speeds: Vector4<f64>| {
            let end = single_step(robot, &EulerState::zeros(), &speeds, settings.step);
            Vector3::new(end[0], end[1], end[2])
        };
        let samples = sampling::constant_speeds(robot, settings.resolution).into_iter().map(run).collect();
        Self::of(samples, settings.step, settings)
    }

    /// The hull of end points; `carry` is φ(Δt), s.
    fn of(samples: Vec<Vector3<f64>>, carry: f64, settings: &HullSettings) -> Result<Self, NoHull> {
        let HullSettings { step, simd, .. } = *settings;
        Ok(Self { polytope: Polytope::hull(simd, &samples)?, samples, carry, step, simd })
    }

    /// Compares four runs from random velocities with the full model (quadratic drag and aerodynamic moment off) by
    /// the plain integrator: the ends must agree to 1 cm, and the polytope must hold all its samples.
    ///
    /// `speeds` must be those that were sampled, in their order. Seeded: the same four runs every time.
    ///
    /// # Errors
    /// [`NoHull::SelfCheck`] with the worst distance.
    pub fn self_check(&self, robot: &Quadrotor, speeds: &[Vector4<f64>]) -> Result<(), NoHull> {
        let model = Quadrotor { drag_quadratic: 0.0, aerodynamic_moment: 0.0, ..robot.clone() };
        let mut rng = stream(named_seed(0, "reach self-check", speeds.len() as u64));
        let mut worst: f64 = 0.0;
        for _ in 0..4 {
            let run = rng.random_range(0..speeds.len());
            let velocity = Vector3::from_fn(|_, _| rng.random_range(-5.0..5.0));
            let mut start = level_rest();
            start.fixed_rows_mut::<3>(7).copy_from(&velocity);
            let end = simulate(&model, start, &speeds[run], self.step);
            let end = Vector3::new(end[0], end[1], end[2]);
            worst = worst.max((end - velocity * self.carry - self.samples[run]).norm());
        }
        let kept = self.samples.iter().all(|sample| self.polytope.contains(sample));
        // NaN must not pass.
        if worst <= 0.01 && kept { Ok(()) } else { Err(NoHull::SelfCheck { error_m: worst }) }
    }

    /// The set as half-spaces.
    pub fn polytope(&self) -> &Polytope {
        &self.polytope
    }

    /// Ends of the sampled runs from rest at the origin, m.
    pub fn samples(&self) -> &[Vector3<f64>] {
        &self.samples
    }

    /// Distance of the farthest sampled end, m; v_max of the scores is this ÷ step.
    ///
    /// From rest: max |R(u)|.
    pub fn farthest(&self) -> f64 {
        self.samples.iter().map(|sample| sample.norm()).fold(0.0, f64::max)
    }

    /// Duration of a step, s.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Whether w₂ − 2 w₁ + w₀ = `second_difference` (m) is feasible at average velocities without drag: whether it
    /// lies in K.
    pub fn contains(&self, second_difference: &Vector3<f64>) -> bool {
        self.polytope.contains(second_difference)
    }

    /// Whether `end` may still be reached in `steps` legs after the leg `before` (m) that ended at `current`: the
    /// necessary condition by convexity, end ∈ current + Σ ρ^i·before + Σ Σ … K, with ρ = carry ÷ step (1 without
    /// drag, where it reads current + n·before + n(n+1)/2·K). Velocities are taken as averages.
    ///
    /// The same half-spaces scaled: O(facets).
    ///
    /// Necessary, not sufficient: the waypoints in between may be missing. With no steps left the end must be here, to
    /// 1 nm.
    pub fn may_reach(&self, current: &Vector3<f64>, before: &Vector3<f64>, end: &Vector3<f64>, steps: u32) -> bool {
        let ratio = self.carry / self.step;
        let (mut leg, mut drift, mut scale) = (0.0, 0.0, 0.0);
        let mut power = 1.0;
        if ratio == 1.0 {
            // The sums in closed form: a search asks this for every partial trajectory that it makes.
            (drift, scale) = (f64::from(steps), 0.5 * f64::from(steps) * (f64::from(steps) + 1.0));
        } else {
            for _ in 0..steps {
                power *= ratio;
                leg = leg * ratio + 1.0;
                drift += power;
                scale += leg;
            }
        }
        let d = end - current - before * drift;
        if scale == 0.0 { d.norm() < 1e-9 } else { self.polytope.contains(&(d / scale)) }
    }
}

impl StepSet for Hull {
    fn bounding_box(&self) -> (Vector3<f64>, Vector3<f64>) {
        self.polytope.bounding_box()
    }
    #[inline]
    fn contains(&self, d: &Vector3<f64>) -> bool {
        self.polytope.contains(d)
    }
    #[inline]
    fn select(&self, from: &Vector3<f64>, points: &[Vector3<f64>], bits: &mut [u64]) {
        self.polytope.select(self.simd, from, points, bits);
    }
    fn carry(&self) -> f64 {
        self.carry
    }
}

/// End of a run of the full model from `start`: RK4 at half a radian a step of the fastest rates.
pub(super) fn simulate(model: &Quadrotor, start: QuadrotorState, speeds: &Vector4<f64>, time: f64) -> QuadrotorState {
    let u = model.wrench(speeds);
    let spin = Vector3::new(start[10], start[11], start[12]).norm();
    let fastest = spin + Vector3::new(u[1], u[2], u[3]).component_div(&model.inertia).norm() * time;
    let steps = ((2.0 * fastest * time).ceil() as usize).clamp(50, 100_000);
    let mut state = start;
    for _ in 0..steps {
        state = rk4_step(|x| model.derivative(x, speeds), &state, time / steps as f64);
        model.normalize(&mut state);
    }
    state
}

/// Whether the settings are within bounds.
pub(super) fn check(settings: &HullSettings) -> Result<(), NoHull> {
    if !(2..=12).contains(&settings.resolution) {
        let value = settings.resolution as f64;
        return Err(NoHull::Setting { field: "resolution", value, bound: "2 to 12 rotor speeds per rotor" });
    }
    if !(settings.step > 0.0 && settings.step <= 10.0) {
        return Err(NoHull::Setting { field: "step_s", value: settings.step, bound: "above 0 and at most 10 s" });
    }
    Ok(())
}
