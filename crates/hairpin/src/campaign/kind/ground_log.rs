//! Logs of motions over the ground, as fits look at them.

/// A log of a motion over the ground: when, s from its begin, and x, y (m) and ψ (rad, not wrapped) then.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::campaign) struct GroundLog {
    pub(in crate::campaign) times: Vec<f64>,
    pub(in crate::campaign) places: Vec<[f64; 3]>,
}

impl GroundLog {
    /// Where it is at `t` (s), linear between two samples; beyond its ends as there. It has two samples at least.
    pub(in crate::campaign) fn between(&self, t: f64) -> [f64; 3] {
        let Self { times, places } = self;
        let next = times.partition_point(|s| *s < t).clamp(1, times.len() - 1);
        let share = ((t - times[next - 1]) / (times[next] - times[next - 1])).clamp(0.0, 1.0);
        [0, 1, 2].map(|k| places[next - 1][k] + share * (places[next][k] - places[next - 1][k]))
    }
}
