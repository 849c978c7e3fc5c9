//! Ground as a height over the plane: what wheels stand on.
//!
//! Ground is a function z = h(x, y): no overhangs. Wheels need h and its slope for contact and the second derivatives
//! for how a rest changes along the way; all three come from one look ([`Terrain::patch`]). Maps are C¹: slopes are
//! continuous, second derivatives jump where cells meet, and who differentiates twice must expect it.
//!
//! [`Flat`] and [`Function`] are ground by formula, [`ElevationMap`] from a raster, [`generate::generate`] from a seed.
//! [`KeepOuts`] lie over any of them.

mod flat;
pub mod generate;
mod holes;
pub mod keep_out;
mod map;
mod rationed;
pub mod rocks;
mod smooth;

#[cfg(feature = "unit-tests")]
mod tests;

pub use flat::{Flat, Function};
pub use keep_out::{KeepOut, KeepOutShape, KeepOuts};
pub use map::{ElevationMap, Grid, HoleRule, MapError};
pub use rationed::Rationed;
pub use rocks::{Rock, Rocks, add_rocks};

use thiserror::Error;

/// Height of the ground at a point with its first and second derivatives.
///
/// The upward normal of the ground is (−∂h/∂x, −∂h/∂y, 1)/√(1 + ‖slope‖²).
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
///
/// An answer, not an accident: a wheel that leaves the map ends a prediction, and the place is told.
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
///
/// For a stranger's ground as well: whoever implements it owes `slope` and `bend` that are the derivatives of `height`.
///
/// ```
/// use hairpin::world::terrain::{Function, Patch, Terrain};
///
/// // A slope of 10 % to the east.
/// let ramp = Function(|x: f64, _: f64| Patch { height: 0.1 * x, slope: [0.1, 0.0], bend: [0.0; 3] });
/// assert!((ramp.height(4.0, 0.0)? - 0.4).abs() < 1e-12);
/// # Ok::<(), hairpin::world::terrain::NoGround>(())
/// ```
pub trait Terrain: Sync {
    /// Height and derivatives at (`x`, `y`).
    ///
    /// m in the world frame. The same place must give the same answer: searches rely on it.
    ///
    /// # Errors
    /// [`NoGround`] where nothing is known.
    fn patch(&self, x: f64, y: f64) -> Result<Patch, NoGround>;

    /// Height and slope without the bend, to the bit, where there is a cheaper way to them.
    ///
    /// # Errors
    /// As [`Self::patch`].
    fn tangent(&self, x: f64, y: f64) -> Result<(f64, [f64; 2]), NoGround> {
        self.patch(x, y).map(|patch| (patch.height, patch.slope))
    }

    /// The height alone, to the bit, where there is a cheaper way to it.
    ///
    /// # Errors
    /// As [`Self::patch`].
    fn height(&self, x: f64, y: f64) -> Result<f64, NoGround> {
        self.patch(x, y).map(|patch| patch.height)
    }
}
