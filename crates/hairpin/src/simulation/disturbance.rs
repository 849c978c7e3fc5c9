//! What disturbs a flight: wind, gusts, and force and moment noise, the same for the same seed.
//!
//! Streams are named by the run's seed: gusts without noise are the same gusts as with it. Constant wind and the
//! discrete gust draw nothing.

use nalgebra::Vector3;

use super::SimulationError;
use super::plant::Plant;
use crate::math::random::{Stream, named_seed, standard_normals, stream};
use crate::robot::quadrotor::Quadrotor;

/// Gusts on top of the wind: an Ornstein-Uhlenbeck process per axis, in its stationary distribution from the start.
///
/// a_{k+1} = e^(−h/τ) a_k + σ √(1 − e^(−2h/τ)) n: exact for any step, stationary from the first sample on. First order,
/// where Dryden's lateral filters are second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gusts {
    /// Standard deviation per axis, m/s.
    pub std: f64,
    /// Correlation time, s; 0: independent from step to step.
    pub correlation: f64,
}

/// One gust: the air's velocity changes by `velocity` (1 − cos 2π(t − start)/duration)/2 for `duration`.
///
/// Source: the discrete gust of MIL-F-8785C, one whole "1 − cosine".
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscreteGust {
    /// At its middle, m/s.
    pub velocity: Vector3<f64>,
    /// When it begins, s.
    pub start: f64,
    /// How long it takes, s, > 0.
    pub duration: f64,
}

impl DiscreteGust {
    /// m/s, world frame; none before and after.
    fn at(&self, t: f64) -> Vector3<f64> {
        let share = (t - self.start) / self.duration;
        if share > 0.0 && share < 1.0 {
            self.velocity * (0.5 * (1.0 - libm::cos(std::f64::consts::TAU * share)))
        } else {
            Vector3::zeros()
        }
    }
}

/// Air and noise of a run.
///
/// World frame; wind is where the air goes to. The default is still air without noise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Conditions {
    /// Constant velocity of the air, m/s.
    pub wind: Vector3<f64>,
    /// Gusts on top of it.
    pub gusts: Option<Gusts>,
    /// One gust more.
    pub discrete_gust: Option<DiscreteGust>,
    /// Whether the robot's own force and moment noise acts.
    pub noise: bool,
}

impl Conditions {
    /// Everything finite, deviations and correlation times ≥ 0, a gust's duration > 0; the field names what is not.
    pub(super) fn check(&self) -> Result<(), SimulationError> {
        if !self.wind.iter().all(|c| c.is_finite()) {
            return Err(SimulationError::new("wind", format!("{:?}", self.wind.as_slice()), "finite"));
        }
        let gusts = self.gusts.unwrap_or(Gusts { std: 0.0, correlation: 0.0 });
        for (field, value) in [("gusts.std", gusts.std), ("gusts.correlation", gusts.correlation)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(SimulationError::new(field, value.to_string(), "finite and ≥ 0"));
            }
        }
        if let Some(gust) = self.discrete_gust {
            if !(gust.velocity.iter().all(|c| c.is_finite()) && gust.start.is_finite()) {
                let value = format!("{:?} from {} s", gust.velocity.as_slice(), gust.start);
                return Err(SimulationError::new("discrete_gust", value, "finite"));
            }
            if !(gust.duration.is_finite() && gust.duration > 0.0) {
                return Err(SimulationError::new(
                    "discrete_gust.duration",
                    gust.duration.to_string(),
                    "finite and > 0",
                ));
            }
        }
        Ok(())
    }
}

/// The disturbances of one run, drawn step by step.
///
/// Noise of density S (N²·s) is held for a step of h: standard deviation √(S/h), so that its effect on velocity does
/// not depend on h.
#[derive(Debug, Clone)]
pub struct Disturbances {
    wind: Vector3<f64>,
    gusts: Option<GustProcess>,
    /// And the time that the next step begins, in steps of so many seconds.
    discrete_gust: Option<(DiscreteGust, u64, f64)>,
    noise: Option<Noise>,
}

/// The velocity that acts during the next step, and how it is renewed after it.
#[derive(Debug, Clone)]
struct GustProcess {
    stream: Stream,
    velocity: Vector3<f64>,
    /// e^(−h/τ).
    keep: f64,
    /// σ √(1 − e^(−2h/τ)).
    renew: f64,
}

#[derive(Debug, Clone)]
struct Noise {
    stream: Stream,
    /// √(S/h) of force and moment: white noise of density S held for a step.
    force: f64,
    moment: f64,
}

impl Disturbances {
    /// Those of a run with steps of `h` s. Gusts and noise have streams of their own, so one does not change the other.
    pub fn new(robot: &Quadrotor, conditions: &Conditions, h: f64, seed: u64) -> Self {
        let gusts = conditions.gusts.filter(|gusts| gusts.std > 0.0).map(|gusts| {
            let mut stream = stream(named_seed(seed, "gusts", 0));
            let velocity = Vector3::from(standard_normals(&mut stream)) * gusts.std;
            let keep = if gusts.correlation > 0.0 { libm::exp(-h / gusts.correlation) } else { 0.0 };
            GustProcess { stream, velocity, keep, renew: gusts.std * (1.0 - keep * keep).sqrt() }
        });
        let noise = (conditions.noise && (robot.force_noise > 0.0 || robot.moment_noise > 0.0)).then(|| Noise {
            stream: stream(named_seed(seed, "noise", 0)),
            force: (robot.force_noise / h).sqrt(),
            moment: (robot.moment_noise / h).sqrt(),
        });
        let discrete_gust = conditions.discrete_gust.filter(|gust| gust.velocity != Vector3::zeros());
        Self { wind: conditions.wind, gusts, discrete_gust: discrete_gust.map(|gust| (gust, 0, h)), noise }
    }

    /// Whether nothing ever disturbs: still air and no noise.
    #[inline(always)]
    pub(super) fn none(&self) -> bool {
        self.gusts.is_none() && self.discrete_gust.is_none() && self.noise.is_none() && self.wind == Vector3::zeros()
    }

    /// Sets what acts on the plant during the next step.
    ///
    /// Air in m/s, force in N and moment in N·m; draws three normals a step for gusts and six for noise. To be called
    /// once before each step.
    #[inline(always)]
    pub fn act_on(&mut self, plant: &mut Plant) {
        plant.air = self.wind;
        if let Some(gusts) = &mut self.gusts {
            plant.air += gusts.velocity;
            let fresh = Vector3::from(standard_normals(&mut gusts.stream));
            gusts.velocity = gusts.velocity * gusts.keep + fresh * gusts.renew;
        }
        if let Some((gust, steps, h)) = &mut self.discrete_gust {
            plant.air += gust.at(*steps as f64 * *h);
            *steps += 1;
        }
        if let Some(noise) = &mut self.noise {
            let drawn: [f64; 6] = standard_normals(&mut noise.stream);
            plant.force = Vector3::new(drawn[0], drawn[1], drawn[2]) * noise.force;
            plant.moment = Vector3::new(drawn[3], drawn[4], drawn[5]) * noise.moment;
        }
    }
}
