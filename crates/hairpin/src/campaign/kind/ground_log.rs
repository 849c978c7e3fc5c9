//! Logs of motions over the ground, as fits look at them.

/// A log of a motion over the ground: when, s from its begin, and x, y (m) and ψ (rad, not wrapped) then.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::campaign) struct GroundLog {
    pub(in crate::campaign) times: Vec<f64>,
    pub(in crate::campaign) places: Vec<[f64; 3]>,
}
