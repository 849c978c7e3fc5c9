//! The gap between simulation and logs, log by log.

use super::simulate::Loops;

/// How far a simulation is from a log: distance of positions, leg by leg from where each began.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Root of the mean square, m.
    pub rmse_m: f64,
    /// Largest, m.
    pub max_m: f64,
}

/// A log's gap.
#[derive(Debug, Clone, PartialEq)]
pub struct Gap {
    /// The log.
    pub log: String,
    /// Its mission.
    pub mission: String,
    /// With the robot as it was given.
    pub before: Deviation,
    /// As fitted.
    pub after: Deviation,
    /// As fitted to other logs alone; `None` where it was not asked.
    pub unseen: Option<Deviation>,
}

/// The deviation from log number `at` with `theta`; infinite where the mission is not flown with it.
pub(super) fn deviation(loops: &Loops, theta: &[f64], at: usize) -> Deviation {
    let Some(residuals) = loops.residuals(theta, &[at]) else {
        return Deviation { rmse_m: f64::INFINITY, max_m: f64::INFINITY };
    };
    let samples = &residuals[0];
    let squares = samples.iter().map(|r| r[..3].iter().map(|r| r * r).sum::<f64>());
    let (sum, most) = squares.fold((0.0, 0.0f64), |(sum, most), square| (sum + square, most.max(square)));
    Deviation { rmse_m: (sum / samples.len().max(1) as f64).sqrt(), max_m: most.sqrt() }
}
