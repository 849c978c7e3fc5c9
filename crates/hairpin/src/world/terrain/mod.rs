//! Ground as a height over the plane: what wheels stand on.

mod flat;
pub mod generate;
pub mod keep_out;
mod map;
pub mod rocks;
mod smooth;

#[cfg(test)]
mod tests;

pub use flat::{Flat, Function};
pub use keep_out::{KeepOut, KeepOutShape, KeepOuts};
pub use map::{ElevationMap, Grid, HoleRule, MapError};
pub use rocks::{Rock, Rocks, add_rocks};

use thiserror::Error;

/// Height of the ground at a point with its first and second derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Patch {
    /// h, m.
    pub height: f64,
    /// ∂h/∂x, ∂h/∂y.
    pub slope: [f64; 2],
    /// ∂²h/∂x², ∂²h/∂x∂y, ∂²h/∂y², 1/m.
    pub bend: [f64; 3],
}

/// Why there is no ground at a point.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum NoGround {
    /// Outside the map.
    #[error("({x:.3}, {y:.3}) m is outside the map")]
    OffMap {
        /// East, m.
        x: f64,
        /// North, m.
        y: f64,
    },
    /// The interpolation would touch a cell without data.
    #[error("({x:.3}, {y:.3}) m is at a cell without data")]
    Hole {
        /// East, m.
        x: f64,
        /// North, m.
        y: f64,
    },
}

/// Ground that can be asked for its height; world frame, metres, z up.
pub trait Terrain: Sync {
    /// Height and derivatives at (`x`, `y`).
    ///
    /// # Errors
    /// [`NoGround`] where nothing is known.
    fn patch(&self, x: f64, y: f64) -> Result<Patch, NoGround>;

    /// The height alone, to the bit, where there is a cheaper way to it.
    ///
    /// # Errors
    /// As [`Self::patch`].
    fn height(&self, x: f64, y: f64) -> Result<f64, NoGround> {
        self.patch(x, y).map(|patch| patch.height)
    }
}
