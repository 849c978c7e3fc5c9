//! `tracking`: follows the timed plan by feedback linearisation, with all three forces.
//!
//! With e = η_d − η in the world, the acceleration asked for is η̈_d + K_d ė + K_p e + K_i ∫e, and the forces are those
//! that the nominal boat needs for it at its measured velocity ν through the water (Fossen 2011, ch. 13):
//!
//! ```text
//! τ = M (R(ψ)ᵀ a + (r v, −r u, 0)) + C(ν) ν + D(ν) ν
//! ```

use nalgebra::{Vector2, Vector3};

use super::super::command::{BoatCommand, BoatState, turned};
use super::angle::wrap;
use crate::robot::boat::Boat;
use crate::simulation::controller::{Controller, Fault, Reference, Schedule};
use crate::trajectory::Profile;

/// K_p, K_d, K_i of the place, 1/s², 1/s, 1/s³, and of the heading. Fixed by the step responses of the tests.
const PLACE: [f64; 3] = [0.16, 0.7, 0.008];
const HEADING: [f64; 3] = [0.5, 1.2, 0.03];
/// Largest error that counts, m and rad: who is far from the plan must not throw the helm over.
const MOST: [f64; 2] = [1.0, 0.5];

/// See the file's first line.
#[derive(Debug, Clone)]
pub(in crate::simulation::boat) struct Tracking {
    boat: Boat,
    schedule: Option<Schedule>,
    /// ∫e, m s and rad s.
    sum: Vector3<f64>,
}

impl Tracking {
    pub(super) fn new(nominal: &Boat) -> Self {
        Self { boat: nominal.clone(), schedule: None, sum: Vector3::zeros() }
    }

    /// The acceleration asked for in the world, and takes note of the error. `wanted`: place, velocity, acceleration,
    /// with ψ as their third component.
    fn asked(&mut self, dt: f64, now: &BoatState, wanted: &[Vector3<f64>; 3]) -> Vector3<f64> {
        let [at, velocity, acceleration] = wanted;
        let over_ground = now.over_ground();
        let off = Vector2::new(at.x - now.position.x, at.y - now.position.y).cap_magnitude(MOST[0]);
        let turned = wrap(at.z - now.heading).clamp(-MOST[1], MOST[1]);
        let error = Vector3::new(off.x, off.y, turned);
        let rate = velocity - Vector3::new(over_ground.x, over_ground.y, now.velocity.z);
        let gains = |k: usize| Vector3::new(PLACE[k], PLACE[k], HEADING[k]);
        let proportional = gains(0).component_mul(&error) + gains(1).component_mul(&rate);
        let whole = acceleration + proportional + gains(2).component_mul(&self.sum);
        self.sum += error * dt;
        whole
    }

    /// The forces for the acceleration `asked` in the world.
    fn forces(&self, now: &BoatState, asked: &Vector3<f64>) -> Vector3<f64> {
        let nu = now.through_water;
        let along = turned(&Vector2::new(asked.x, asked.y), -now.heading);
        let rate = Vector3::new(along.x + nu.z * nu.y, along.y - nu.z * nu.x, asked.z);
        self.boat.inertia.times(&rate) + self.boat.inertia.coriolis(&nu) + self.boat.damping.force(&nu)
    }
}

/// Place, velocity and acceleration of `plan` at `t`; at its end it lies still.
fn sample(plan: &Profile, t: f64) -> Option<([Vector3<f64>; 3], Schedule)> {
    let (leg, motion) = plan.motion(t)?;
    Some((motion, Schedule { leg, over: t >= plan.duration() }))
}

impl Controller<Boat> for Tracking {
    fn reset(&mut self, reference: &Reference<Boat>) -> Result<(), Fault> {
        let plan = reference.plan.ok_or("it follows a timed plan, and there is none")?;
        self.schedule = sample(plan, 0.0).map(|(_, schedule)| schedule);
        Ok(())
    }

    fn control(&mut self, dt: f64, now: &BoatState, to: &Reference<Boat>) -> Result<BoatCommand, Fault> {
        let plan = to.plan.ok_or("it follows a timed plan, and there is none")?;
        let (wanted, schedule) = sample(plan, now.t).ok_or("its plan has no legs")?;
        self.schedule = Some(schedule);
        let asked = self.asked(dt, now, &wanted);
        Ok(self.forces(now, &asked).into())
    }

    fn schedule(&self) -> Option<Schedule> {
        self.schedule
    }
}
