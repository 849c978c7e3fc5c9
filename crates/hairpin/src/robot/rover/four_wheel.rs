//! Four wheels on a rigid body: three unknowns (z, φ, θ), four contacts, least squares by Gauss-Newton.
//!
//! min over (z, φ, θ) of Σ F_i²: four wheels on a rigid body touch four points in a plane only by luck, so that the
//! rest is the plane nearest to all four contacts, and wheels may stand millimetres over the ground or in it.
//! Gauss-Newton: JᵀJ Δ = −JᵀF.

use nalgebra::Vector3;

use super::contact::contact;
use super::rest::{Attitude, Gradient, Settled, Unsettled};
use crate::math::linear::reduce;
use crate::world::terrain::Terrain;

/// Places of the wheels' centres in the body frame, m.
///
/// Any four places; files give the left side and mirror it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FourWheel {
    /// Front left, front right, rear left, rear right.
    pub wheels: [Vector3<f64>; 4],
    /// Radius of every wheel.
    pub wheel_radius: f64,
}

/// Gauss-Newton steps; a warm start takes three.
const MOST_STEPS: usize = 50;
/// Steps after which each is half as long as the one before: where the rest lies on a kink of the map, steps lead to it
/// from both of its sides and grow no shorter by themselves.
const SWINGING: usize = 20;
/// Least squares converges linearly where gaps remain: steps of this share of a coarse gap end the iteration.
const SHORT: f64 = 0.01;
/// Longest step, m and rad.
const LONGEST_STEP: f64 = 0.35;

impl FourWheel {
    /// Height of the body's origin over level ground, m.
    pub(super) fn ride_height(&self) -> f64 {
        self.wheel_radius - self.wheels.iter().map(|w| w.z).sum::<f64>() / 4.0
    }

    /// The pose that minimises Σ F_i² over the four gaps, from `guess`.
    ///
    /// `at` = x, y, ψ in m, m, rad. Ends where a step is below 1 % of `coarse` (m and rad alike). The gradient is that
    /// of the last linearisation: J drops second derivatives of the gaps, so that it is exact only where they vanish.
    ///
    /// # Errors
    /// [`Unsettled`]: a wheel off the map, wheels that do not determine the pose, or no end within 50 steps.
    pub(super) fn settle<T: Terrain>(
        &self,
        terrain: &T,
        at: [f64; 3],
        guess: &Settled,
        coarse: f64,
    ) -> Result<(Settled, Gradient), Unsettled> {
        let mut pose = *guess;
        let mut last = f64::INFINITY;
        let mut damping = 1.0;
        for number in 0..MOST_STEPS {
            let mut rows = self.normal_equations(terrain, at, &pose)?;
            if !reduce(&mut rows) {
                return Err(Unsettled::Singular);
            }
            let step = [rows[0][3], rows[1][3], rows[2][3]];
            let longest = step.iter().fold(0.0_f64, |most, s| most.max(s.abs()));
            let mut scale = if longest > LONGEST_STEP { LONGEST_STEP / longest } else { 1.0 };
            // Kinks of the map can make the steps swing: half of one is then nearer to the rest.
            if longest > 0.7 * last {
                scale *= 0.5;
            }
            last = longest;
            if number >= SWINGING {
                damping *= 0.5;
                scale *= damping;
            }
            pose = pose.moved(&[scale * step[0], scale * step[1], scale * step[2], 0.0, 0.0, 0.0]);
            if damping * longest <= SHORT * coarse {
                let mut gradient = Gradient::default();
                for (by_place, row) in gradient.by_place.iter_mut().zip(&rows) {
                    by_place.copy_from_slice(&row[4..7]);
                }
                return Ok((pose, gradient));
            }
        }
        Err(Unsettled::NotConverged { gap: last })
    }

    /// JᵀJ (z, φ, θ) with the right-hand sides −Jᵀ(F, F_x, F_y, F_ψ).
    ///
    /// Rows z, φ, θ; columns the three unknowns, then −JᵀF, −JᵀF_x, −JᵀF_y, −JᵀF_ψ.
    fn normal_equations<T: Terrain>(
        &self,
        terrain: &T,
        at: [f64; 3],
        pose: &Settled,
    ) -> Result<[[f64; 7]; 3], Unsettled> {
        let attitude = Attitude::new(pose.roll, pose.pitch, at[2]);
        let origin = Vector3::new(at[0], at[1], pose.z);
        let mut rows = [[0.0; 7]; 3];
        for wheel in &self.wheels {
            let center = origin + attitude.world_from_body * wheel;
            let contact = contact(terrain, &center, self.wheel_radius)?;
            let normal = attitude.world_from_body.transpose() * contact.gradient;
            let [by_roll, by_pitch, by_yaw] = attitude.by_angles(&wheel.cross(&normal));
            let by = [1.0, by_roll, by_pitch];
            let right = [-contact.gap, -contact.gradient.x, -contact.gradient.y, -by_yaw];
            for (row, b) in rows.iter_mut().zip(&by) {
                for (value, a) in row.iter_mut().zip(by.iter().chain(&right)) {
                    *value += a * b;
                }
            }
        }
        Ok(rows)
    }
}
