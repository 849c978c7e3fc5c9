//! How programs are planned and run; every number is a stand-in for a controller whose own is not public.

use crate::robot::arm::{AXES, Joints};
use crate::simulation::SimulationError;

/// How speed rises and falls.
///
/// s_f(t) = (1/T) ∫ s over (t − T, t): jerk along the path at most 2a/T.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// At constant acceleration where the limits do not change.
    Trapezoid,
    /// The trapezoid's progress averaged over this time, s: jerk is bounded, the path stays the path, every stop comes
    /// that much later.
    SCurve(f64),
}

/// How a path and its time law are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanSettings {
    /// How speed rises and falls.
    pub shape: Shape,
    /// Largest acceleration of the tool's point along the path, m/s².
    pub acceleration: f64,
    /// Largest angular acceleration of the tool along the path, rad/s².
    pub turn_acceleration: f64,
    /// How long the arm waits at a fine point, s.
    pub settle: f64,
    /// Along lines and arcs the arm stops where a singularity's margin falls below this.
    pub singularity: f64,
}

impl Default for PlanSettings {
    /// A trapezoid, 10 m/s², 100 rad/s², 50 ms at fine points, margin 0.01.
    fn default() -> Self {
        Self { shape: Shape::Trapezoid, acceleration: 10.0, turn_acceleration: 100.0, settle: 0.05, singularity: 0.01 }
    }
}

/// How servos follow and what is measured.
///
/// At constant speed v the tool is v · lag behind: 5 mm at 1 m/s with the default.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunSettings {
    /// Time between samples, s.
    pub sample: f64,
    /// Time between set points of the servos, s; rounded so that samples are whole multiples.
    pub interpolation: f64,
    /// Time constant of each joint's lag, s. What is left after a controller's feed-forward.
    pub lags: Joints,
    /// What differs from run to run.
    pub noise: Noise,
}

impl Default for RunSettings {
    /// Samples every 10 ms, set points every 2 ms, a lag of 5 ms, no noise.
    fn default() -> Self {
        Self { sample: 0.01, interpolation: 0.002, lags: [0.005; AXES], noise: Noise::default() }
    }
}

/// Standard deviations of what differs from run to run; 0 is none.
///
/// Normal, independent from sample to sample; `pause` is uniform. One seed, one recording.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Noise {
    /// Of each coordinate of the measured position, m.
    pub position: f64,
    /// Of each component of the measured orientation's rotation vector, rad.
    pub orientation: f64,
    /// Of each measured joint angle, rad.
    pub joints: f64,
    /// Longest extra wait at a fine point, uniform from 0, s.
    pub pause: f64,
}

impl PlanSettings {
    /// Windows to 1 s, accelerations above 0 to 10⁶, waits to 3600 s, margins in 0 … 1.
    pub(super) fn check(&self) -> Result<(), SimulationError> {
        if let Shape::SCurve(width) = self.shape {
            positive("shape.s_curve", width, 1.0)?;
        }
        positive("acceleration", self.acceleration, 1e6)?;
        positive("turn_acceleration", self.turn_acceleration, 1e6)?;
        at_least_0("settle", self.settle, 3600.0)?;
        at_least_0("singularity", self.singularity, 1.0)
    }
}

impl RunSettings {
    /// Samples above 0 to 10 s, set points no farther apart than samples, lags to 10 s.
    pub(super) fn check(&self) -> Result<(), SimulationError> {
        positive("sample", self.sample, 10.0)?;
        positive("interpolation", self.interpolation, self.sample)?;
        self.lags.iter().try_for_each(|lag| at_least_0("lags", *lag, 10.0))?;
        at_least_0("noise.position", self.noise.position, 1.0)?;
        at_least_0("noise.orientation", self.noise.orientation, 1.0)?;
        at_least_0("noise.joints", self.noise.joints, 1.0)?;
        at_least_0("noise.pause", self.noise.pause, 3600.0)
    }
}

fn positive(field: &'static str, value: f64, most: f64) -> Result<(), SimulationError> {
    if value > 0.0 && value <= most {
        Ok(())
    } else {
        Err(SimulationError::new(field, value.to_string(), "more than 0, and no more than is of use"))
    }
}

fn at_least_0(field: &'static str, value: f64, most: f64) -> Result<(), SimulationError> {
    if (0.0..=most).contains(&value) {
        Ok(())
    } else {
        Err(SimulationError::new(field, value.to_string(), "at least 0, and no more than is of use"))
    }
}
