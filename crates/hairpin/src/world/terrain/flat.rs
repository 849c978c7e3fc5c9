//! Ground given by a formula.

use super::{NoGround, Patch, Terrain};

/// Level ground at height 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Flat;

impl Terrain for Flat {
    fn patch(&self, _x: f64, _y: f64) -> Result<Patch, NoGround> {
        Ok(Patch::default())
    }
}

/// Ground by an analytic function of (x, y) with its derivatives.
///
/// Defined everywhere. That the derivatives are those of the height is not checked.
#[derive(Debug, Clone, Copy)]
pub struct Function<F>(pub F);

impl<F: Fn(f64, f64) -> Patch + Sync> Terrain for Function<F> {
    fn patch(&self, x: f64, y: f64) -> Result<Patch, NoGround> {
        Ok((self.0)(x, y))
    }
}
