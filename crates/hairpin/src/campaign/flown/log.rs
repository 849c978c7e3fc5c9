//! A log as it is judged.

use crate::judgement::Resolution;
use crate::trajectory::Flight;

/// What of a log is judged.
///
/// SI units, world frame: the door has turned frames and stamps, and says what it cut out.
#[derive(Debug, Clone)]
pub struct Log {
    /// What was flown, world frame, with the channel `leg`; [`judge_flown`](super::judge_flown) looks for the
    /// moment it left the world.
    pub flight: Flight,
    /// Samples before which something was cut out.
    /// Rising indices of samples; nothing is concluded over a break.
    pub breaks: Vec<usize>,
    /// Horizontal and vertical standard deviation of every sample's position, m; empty where nothing is said of any.
    /// As the estimator claims (`eph`, `epv`); `None` where it claims nothing, which counts as exact.
    pub accuracy: Vec<Option<[f64; 2]>>,
    /// The steps in which it tells its places and velocities.
    pub resolution: Resolution,
    /// Whether the world is known that it moved in: where it is not, neither obstacles nor bounds are judged.
    pub in_world: bool,
}

impl Log {
    /// Horizontal and vertical standard deviation of the position of sample `i`, m; 0 where nothing is claimed.
    pub(super) fn sigma(&self, i: usize) -> [f64; 2] {
        self.accuracy.get(i).copied().flatten().unwrap_or([0.0; 2])
    }

    /// Both of them in one, m: √(σ_h² + σ_v²).
    pub(super) fn radius(&self, i: usize) -> f64 {
        let [across, up] = self.sigma(i);
        libm::hypot(across, up)
    }
}
