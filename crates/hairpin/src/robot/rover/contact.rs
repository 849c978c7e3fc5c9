//! One rule of contact for every wheel: a sphere on the tangent plane of the ground below its centre.
//!
//! The wheel is a ball: its centre lies on the offset surface z = c(x, y) = h + r √(1 + h_x² + h_y²) over the point
//! below it. Sharp edges are smoothed by the map, not by the wheel; on the Mars Yard the rule differs from "the point
//! under the axle" by 10 mm in the mean, so that there is one rule for all.

use nalgebra::Vector3;

use crate::world::terrain::{NoGround, Terrain};

/// How far a wheel's centre is over the ground's offset surface, with what Newton needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    /// F = z − c(x, y), m, with c = h + r √(1 + h_x² + h_y²).
    pub(super) gap: f64,
    /// ∇F = (−c_x, −c_y, 1).
    pub(super) gradient: Vector3<f64>,
}

/// The gap of a wheel of `radius` (m) with its centre at `center` (world, m).
///
/// c_x = h_x + r (h_x h_xx + h_y h_xy)/√(1 + h_x² + h_y²), and c_y alike. The derivatives jump where the map's second
/// ones do.
///
/// # Errors
/// [`NoGround`] below the centre.
pub(super) fn contact<T: Terrain>(terrain: &T, center: &Vector3<f64>, radius: f64) -> Result<Contact, NoGround> {
    let ground = terrain.patch(center.x, center.y)?;
    let [hx, hy] = ground.slope;
    let [hxx, hxy, hyy] = ground.bend;
    let stretch = (1.0 + hx * hx + hy * hy).sqrt();
    let lean = radius / stretch;
    Ok(Contact {
        gap: center.z - ground.height - radius * stretch,
        gradient: Vector3::new(-(hx + lean * (hx * hxx + hy * hxy)), -(hy + lean * (hx * hxy + hy * hyy)), 1.0),
    })
}
