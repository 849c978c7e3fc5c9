//! The waters that a claim is about.

use crate::world::terrain::KeepOuts;

/// The waters that boats move in: [0, size], places to keep out of, and a steady current.
///
/// World frame, origin in the south-west corner, x east, y north.
#[derive(Debug, Clone)]
pub struct BoatWaters {
    /// Edge lengths, east and north, m.
    pub size: [f64; 2],
    /// How far inside the edges the origin of the hull stays, m.
    pub keep_in: f64,
    /// Where the hull's disc must not come.
    pub keep_outs: KeepOuts,
    /// Velocity of the water, m/s, east and north.
    pub current: [f64; 2],
}
