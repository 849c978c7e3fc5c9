//! The gap between simulation and logs, log by log.

use super::simulate::Loops;
use crate::math::power::square;
use crate::trajectory::Track;

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

/// How far places scatter from sample to sample in the first `axes` of the world, m.
///
/// ```text
/// σ² = Σ over axes of the mean of (p_(i+3) − 3 p_(i+2) + 3 p_(i+1) − p_i)²/20
/// ```
///
/// Third differences are √20 σ of independent noise; of a motion they are its jerk times the third power of the step,
/// a millimetre at 50 m/s³ and 35 Hz. 0 of fewer than four samples.
pub(super) fn scatter(track: &Track, axes: usize) -> f64 {
    let count = track.len().saturating_sub(3);
    let third = |i: usize| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| track.position(i + k).coords);
        d - c * 3.0 + b * 3.0 - a
    };
    let sum: f64 = (0..count).map(|i| third(i).iter().take(axes).map(|part| square(*part)).sum::<f64>()).sum();
    (sum / (20.0 * count.max(1) as f64)).sqrt()
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Isometry3;

    use super::*;
    use crate::math::random::{stream, unit};

    #[test]
    fn scatter_is_that_of_noise_and_not_of_the_motion() {
        let mut random = stream(5);
        let times: Vec<f64> = (0..4000).map(|i| f64::from(i) * 0.02).collect();
        let mut track = |noise: f64| {
            let poses = times.iter().map(|t| {
                let [x, y, z] = [(); 3].map(|()| noise * (unit(&mut random) - 0.5) * 12_f64.sqrt());
                Isometry3::translation(5.0 * (0.5 * t).sin() + x, 3.0 * t + y, z)
            });
            Track::new(times.clone(), poses.collect(), Vec::new()).unwrap()
        };
        let (still, noisy) = (track(0.0), track(0.01));
        assert!(scatter(&still, 3) < 1e-5, "{}", scatter(&still, 3));
        assert!((scatter(&noisy, 3) - 0.01 * 3_f64.sqrt()).abs() < 1e-3, "{}", scatter(&noisy, 3));
        assert!((scatter(&noisy, 2) - 0.01 * 2_f64.sqrt()).abs() < 1e-3, "{}", scatter(&noisy, 2));
    }
}
