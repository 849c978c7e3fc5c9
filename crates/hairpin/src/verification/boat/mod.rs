//! The proof of a boat's witness: polynomials for x, y and ψ that are to take it from waypoint to waypoint.
//!
//! By other means than those that found it. Forces come from Kirchhoff's equations for the momenta of hull and water,
//! differentiated as truncated series in time (`series`, `demand`); the bounds between samples are intervals with
//! outward rounding in mean value form (`bound`), where the claim has Taylor models rounded to nearest; and the boat is
//! sailed under these forces by Gauss collocation of its momenta (`replay`).
//!
//! ```text
//! p = M ν      ṗ_u = X + r p_v − D_X      ṗ_v = Y − r p_u − D_Y      ṗ_r = N − u p_v + v p_u − D_N
//! ```

mod bound;
mod claim;
mod demand;
mod knots;
mod places;
mod proof;
mod replay;
mod rows;
mod series;
#[cfg(feature = "unit-tests")]
mod tests;

pub use claim::{BoatClaim, BoatHull, BoatLeg};
pub use proof::{boat_with_lag, verify_boat};
pub use rows::verify_boat_rows;
