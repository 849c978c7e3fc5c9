//! The gap between simulation and logs, log by log.

use super::simulate::Loops;

/// How far a simulation is from a log: distance of positions, leg by leg from where each began.
///
/// Over the compared samples: not the log's own, and without its first leg where that is not compared.
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
    let Some(distances) = loops.distances(theta, at) else {
        return Deviation { rmse_m: f64::INFINITY, max_m: f64::INFINITY };
    };
    let sum: f64 = distances.iter().map(|far| far * far).sum();
    let max_m = distances.iter().copied().fold(0.0, f64::max);
    Deviation { rmse_m: (sum / distances.len().max(1) as f64).sqrt(), max_m }
}
