//! Six wheels on a rocker-bogie with a differential: six unknowns (z, φ, θ, rocker, two bogies), six contacts.
//!
//! Equations (q = (z, φ, θ, β, ρ_l, ρ_r), side s = +1 left, −1 right):
//! rocker: Ry(sβ) about the differential's pivot D_s; bogie: Ry(ρ_s) more about its joint;
//! F_i(q) = p_z − c(p_x, p_y) = 0 for each wheel's centre p. Newton with the exact Jacobian; each bogie angle meets
//! only its own two wheels and is eliminated by hand, which leaves four equations. Geometry: Balaram, Ohm & Ivlev 1996;
//! Tarokh & McDermott 2005.

use nalgebra::Vector3;

use super::contact::contact;
use super::rest::{Attitude, Gradient, Settled, Unsettled};
use crate::math::linear::reduce;
use crate::world::terrain::Terrain;

/// Geometry of the left side, m; the right one is its mirror image.
///
/// The differential makes the rockers turn equal and opposite: β left, −β right. Six wheels, six unknowns: on ground
/// without kinks the rest is isolated and Newton converges quadratically.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RockerBogie {
    /// Pivot of the rocker on the body.
    pub pivot: Vector3<f64>,
    /// Centre of the rocker's own wheel, from the pivot.
    pub rocker_wheel: Vector3<f64>,
    /// The bogie's joint, from the pivot.
    pub bogie_joint: Vector3<f64>,
    /// Centres of the bogie's wheels, from its joint.
    pub bogie_wheels: [Vector3<f64>; 2],
    /// Radius of every wheel.
    pub wheel_radius: f64,
}

/// Newton steps; a warm start takes two.
const MOST_STEPS: usize = 30;
/// Longest step of an angle, rad, and of the height, m: where the linear model still says something.
const LONGEST_STEP: f64 = 0.35;

/// One side's wheels in the body frame and their derivatives by the rocker's and the bogie's angle.
struct Side {
    at: [Vector3<f64>; 3],
    /// m/rad.
    by_rocker: [Vector3<f64>; 3],
    by_bogie: [Vector3<f64>; 3],
}

/// Ry(angle) v for given cosine and sine, and its derivative by the angle.
fn turn(v: &Vector3<f64>, cos: f64, sin: f64) -> (Vector3<f64>, Vector3<f64>) {
    let (x, z) = (cos * v.x + sin * v.z, cos * v.z - sin * v.x);
    (Vector3::new(x, v.y, z), Vector3::new(z, 0.0, -x))
}

impl RockerBogie {
    /// The wheels of the side `s` (+1 left, −1 right): the rocker's own, then the bogie's.
    ///
    /// x and z only move with the joints; y stays.
    fn side(&self, s: f64, rocker: f64, bogie: f64) -> Side {
        let mirror = |v: &Vector3<f64>| Vector3::new(v.x, s * v.y, v.z);
        let pivot = mirror(&self.pivot);
        let (sin, cos) = libm::sincos(s * rocker);
        let (own, own_by) = turn(&mirror(&self.rocker_wheel), cos, sin);
        let (joint, joint_by) = turn(&mirror(&self.bogie_joint), cos, sin);
        let (bogie_sin, bogie_cos) = libm::sincos(s * rocker + bogie);
        let zero = Vector3::zeros();
        let mut side = Side { at: [pivot + own, zero, zero], by_rocker: [s * own_by, zero, zero], by_bogie: [zero; 3] };
        for (i, wheel) in self.bogie_wheels.iter().enumerate() {
            let (arm, arm_by) = turn(&mirror(wheel), bogie_cos, bogie_sin);
            side.at[i + 1] = pivot + joint + arm;
            side.by_rocker[i + 1] = s * (joint_by + arm_by);
            side.by_bogie[i + 1] = arm_by;
        }
        side
    }

    /// Centres of the six wheels in the body frame: left rocker wheel and bogie wheels, then right.
    ///
    /// `joints` = [β, ρ_left, ρ_right], rad; m.
    pub fn wheels(&self, joints: &[f64; 3]) -> [Vector3<f64>; 6] {
        let (left, right) = (self.side(1.0, joints[0], joints[1]), self.side(-1.0, joints[0], joints[2]));
        [left.at[0], left.at[1], left.at[2], right.at[0], right.at[1], right.at[2]]
    }

    /// The pose in which all six wheels touch the ground, from `guess`.
    ///
    /// Steps longer than 0.35 (m or rad, any component) are scaled as a whole; a step after which the largest gap has
    /// grown is halved back. Ends with the step from gaps of at most `coarse`, m.
    ///
    /// # Errors
    /// [`Unsettled`]: a wheel off the map, a singular system, or no end within 30 looks.
    pub(super) fn settle<T: Terrain>(
        &self,
        terrain: &T,
        at: [f64; 3],
        guess: &Settled,
        coarse: f64,
    ) -> Result<(Settled, Gradient), Unsettled> {
        let mut pose = *guess;
        let mut largest = f64::INFINITY;
        let mut step = [0.0_f64; 6];
        for look in 0..MOST_STEPS {
            let system = self.linearise(terrain, at, &pose)?;
            let gap = system.largest;
            // A step that made things worse is taken back by halves; the map's kinks can ask for that.
            if look > 0 && gap > largest.max(1e-9) && step.iter().any(|s| s.abs() > 1e-9) {
                step = step.map(|s| 0.5 * s);
                pose = pose.moved(&step.map(|s| -s));
                continue;
            }
            largest = gap;
            let Some((newton, gradient)) = system.solve() else { return Err(Unsettled::Singular) };
            let longest = newton.iter().fold(0.0_f64, |most, s| most.max(s.abs()));
            let scale = if longest > LONGEST_STEP { LONGEST_STEP / longest } else { 1.0 };
            step = newton.map(|s| scale * s);
            pose = pose.moved(&step);
            if gap <= coarse && scale == 1.0 {
                return Ok((pose, gradient));
            }
        }
        Err(Unsettled::NotConverged { gap: largest })
    }

    /// Rows: left rocker wheel, left bogie, right rocker wheel, right bogie, the bogies' two wheels combined so that
    /// their own angle drops out.
    fn linearise<T: Terrain>(&self, terrain: &T, at: [f64; 3], pose: &Settled) -> Result<System, Unsettled> {
        let attitude = Attitude::new(pose.roll, pose.pitch, at[2]);
        let origin = Vector3::new(at[0], at[1], pose.z);
        let mut system = System { rows: [[0.0; 8]; 4], bogies: [[0.0; 9]; 2], largest: 0.0 };
        for (index, s) in [1.0, -1.0].into_iter().enumerate() {
            let side = self.side(s, pose.joints[0], pose.joints[1 + index]);
            let mut wheels = [[0.0; 9]; 3];
            for (i, wheel) in wheels.iter_mut().enumerate() {
                let center = origin + attitude.world_from_body * side.at[i];
                let contact = contact(terrain, &center, self.wheel_radius)?;
                let normal = attitude.world_from_body.transpose() * contact.gradient;
                let [by_roll, by_pitch, by_yaw] = attitude.by_angles(&side.at[i].cross(&normal));
                // z, φ, θ, β | −F, −F_x, −F_y, −F_ψ | ρ
                *wheel = [
                    1.0,
                    by_roll,
                    by_pitch,
                    normal.dot(&side.by_rocker[i]),
                    -contact.gap,
                    -contact.gradient.x,
                    -contact.gradient.y,
                    -by_yaw,
                    normal.dot(&side.by_bogie[i]),
                ];
                system.largest = system.largest.max(contact.gap.abs());
            }
            system.rows[2 * index].copy_from_slice(&wheels[0][..8]);
            for column in 0..8 {
                system.rows[2 * index + 1][column] =
                    wheels[1][column] * wheels[2][8] - wheels[2][column] * wheels[1][8];
            }
            let steeper = if wheels[1][8].abs() > wheels[2][8].abs() { wheels[1] } else { wheels[2] };
            system.bogies[index] = steeper;
        }
        Ok(system)
    }
}

/// Four equations in (z, φ, θ, β) with the right-hand sides −(F, F_x, F_y, F_ψ), and of each bogie the wheel that
/// gives its angle back.
struct System {
    rows: [[f64; 8]; 4],
    bogies: [[f64; 9]; 2],
    largest: f64,
}

impl System {
    /// The Newton step of (z, φ, θ, β, ρ_l, ρ_r), and dq/d(x, y, ψ).
    ///
    /// `None` where the system is singular, or where a bogie's angle moves neither of its wheels up or down.
    fn solve(mut self) -> Option<([f64; 6], Gradient)> {
        if !reduce(&mut self.rows) {
            return None;
        }
        // Column 0 is the step, 1 to 3 are the gradient by x, y and ψ.
        let mut solution = [[0.0; 4]; 6];
        for (unknown, row) in solution.iter_mut().zip(&self.rows) {
            unknown.copy_from_slice(&row[4..8]);
        }
        for (i, row) in self.bogies.iter().enumerate() {
            if row[8].is_nan() || row[8].abs() <= 1e-12 {
                return None;
            }
            for column in 0..4 {
                let known: f64 = (0..4).map(|j| row[j] * solution[j][column]).sum();
                solution[4 + i][column] = (row[4 + column] - known) / row[8];
            }
        }
        let gradient = Gradient { by_place: solution.map(|row| [row[1], row[2], row[3]]) };
        Some((solution.map(|row| row[0]), gradient))
    }
}
