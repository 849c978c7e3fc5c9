//! Joint torques of a motion: the recursive Newton-Euler algorithm.
//!
//! Masses are seldom public: where a file has none, costs that would take torques say that they take accelerations
//! instead.

use nalgebra::{Point3, Vector3};

use super::{AXES, Arm, Joints, Tool};

/// Acceleration of gravity, m/s².
const GRAVITY: f64 = 9.80665;

impl Arm {
    /// Whether all moving links have masses, so that torques can be told.
    pub fn has_masses(&self) -> bool {
        self.links[1..].iter().all(|link| link.mass.is_some())
    }

    /// Torques (N m) that the motion q, q̇, q̈ takes with `tool` on the flange, gravity against [`Arm::up`]:
    /// τ = M(q) q̈ + C(q, q̇) q̇ + g(q), without friction and motors' inertia. `None` without masses.
    ///
    /// Outwards velocities and accelerations of the links, inwards forces and moments; O(n). (Luh, Walker, Paul,
    /// "On-line computational scheme for mechanical manipulators", 1980.)
    ///
    /// q in rad, q̇ in rad/s, q̈ in rad/s². The tool is a point mass at its centre of mass; links have whole tensors of
    /// inertia.
    ///
    /// ```text
    /// outwards   α_k = α_(k−1) + a_k q̈_k + ω_(k−1) × a_k q̇_k,   ω_k = ω_(k−1) + a_k q̇_k
    ///            ẍ_k = ẍ_(k−1) + α × r + ω × (ω × r),   ẍ_0 = g · up
    ///            f_k = m_k ẍ_centre,   n_k = I_k α_k + ω_k × I_k ω_k
    /// inwards    τ_k = a_k · Σ_{j ≥ k} [n_j + (c_j − o_k) × f_j],   the tool's force as one more
    /// ```
    ///
    /// All in the base frame; a_k and o_k are axis k's direction and origin, r leads from one axis' origin to the
    /// next. Motion of the base and friction are none.
    pub fn torques(&self, tool: &Tool, q: &Joints, speed: &Joints, acceleration: &Joints) -> Option<Joints> {
        let frames = self.chain.frames(q);
        let axes = self.chain.axes(&frames);
        // All vectors in the base; the base accelerates upwards instead of everything being pulled down.
        let (mut spin, mut turning, mut origin, mut linear) =
            (Vector3::zeros(), Vector3::zeros(), Point3::origin(), self.up * GRAVITY);
        let mut forces = [Vector3::zeros(); AXES];
        let mut moments = [Vector3::zeros(); AXES];
        let mut centres = [Point3::origin(); AXES];
        for k in 0..AXES {
            let (here, axis) = axes[k];
            linear += acceleration_at(&turning, &spin, &(here - origin));
            origin = here;
            turning += axis * acceleration[k] + spin.cross(&axis) * speed[k];
            spin += axis * speed[k];
            let mass = self.links[k + 1].mass?;
            let rotation = frames[k + 1].rotation.to_rotation_matrix();
            let inertia = rotation.matrix() * mass.inertia * rotation.matrix().transpose();
            centres[k] = frames[k + 1] * mass.centre;
            forces[k] = (linear + acceleration_at(&turning, &spin, &(centres[k] - origin))) * mass.mass;
            moments[k] = inertia * turning + spin.cross(&(inertia * spin));
        }
        // The tool is a point mass on the last link.
        let tool_at = frames[AXES] * self.chain.flange * tool.centre_of_mass;
        let tool_force = (linear + acceleration_at(&turning, &spin, &(tool_at - origin))) * tool.mass;
        let mut torques = [0.0; AXES];
        let (mut force, mut moment, mut about) = (tool_force, Vector3::zeros(), tool_at);
        for k in (0..AXES).rev() {
            let here = axes[k].0;
            moment += (about - here).cross(&force) + moments[k] + (centres[k] - here).cross(&forces[k]);
            force += forces[k];
            about = here;
            torques[k] = moment.dot(&axes[k].1);
        }
        Some(torques)
    }
}

/// Of a point at `arm` on a body that turns: α × r + ω × (ω × r).
fn acceleration_at(turning: &Vector3<f64>, spin: &Vector3<f64>, arm: &Vector3<f64>) -> Vector3<f64> {
    turning.cross(arm) + spin.cross(&spin.cross(arm))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{named_seed, stream, unit};
    use crate::robot::arm::{ArmDescription, MassDescription};

    fn heavy() -> (Arm, Tool) {
        let path = format!("{}/../../data/robots/arm/irb120.toml", env!("CARGO_MANIFEST_DIR"));
        let mut description: ArmDescription = toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        description.masses = (1..=6)
            .map(|link| MassDescription {
                link,
                mass_kg: 7.0 - link as f64,
                centre_mm: [10.0 * link as f64, -5.0, 40.0],
                inertia_kg_m2: [0.02, 0.03, 0.01 * link as f64],
                products_kg_m2: [0.004, -0.003, 0.002],
            })
            .collect();
        let tool = Tool::new("t", [0.0, 0.0, 100.0], [1.0, 0.0, 0.0, 0.0], 0.0, 1.5, [20.0, 0.0, 60.0]).unwrap();
        (description.build().unwrap(), tool)
    }

    /// Kinetic and potential energy, from positions alone: velocities by differences.
    fn energy(arm: &Arm, tool: &Tool, q: impl Fn(f64) -> Joints, t: f64) -> f64 {
        let h = 1e-5;
        let [before, now, after] = [t - h, t, t + h].map(|t| arm.chain.frames(&q(t)));
        let mut sum = 0.0;
        let mut point = |mass: f64, link: usize, at: Point3<f64>| {
            let velocity = (after[link] * at - before[link] * at) / (2.0 * h);
            sum += mass * (0.5 * velocity.norm_squared() + GRAVITY * (now[link] * at).z);
        };
        for (link, body) in arm.links.iter().enumerate() {
            if let Some(mass) = body.mass {
                point(mass.mass, link, mass.centre);
            }
        }
        point(tool.mass, AXES, arm.chain.flange * tool.centre_of_mass);
        for (link, body) in arm.links.iter().enumerate() {
            if let Some(mass) = body.mass {
                let turn = now[link].rotation.inverse()
                    * (after[link].rotation * before[link].rotation.inverse())
                    * now[link].rotation;
                let spin = turn.scaled_axis() / (2.0 * h);
                sum += 0.5 * spin.dot(&(mass.inertia * spin));
            }
        }
        sum
    }

    /// The joints' power is what the energy grows by.
    #[test]
    fn power_is_the_growth_of_energy() {
        let (arm, tool) = heavy();
        let mut random = stream(named_seed(1, "dynamics", 0));
        for case in 0..50 {
            let mut numbers = || -> Joints { std::array::from_fn(|_| 2.0 * unit(&mut random) - 1.0) };
            let (a, b, c) = (numbers(), numbers(), numbers());
            let q = |t: f64| -> Joints { std::array::from_fn(|k| a[k] + 2.0 * b[k] * t + 3.0 * c[k] * t * t) };
            let (t, h) = (0.3, 1e-4);
            let speed = std::array::from_fn(|k| 2.0 * b[k] + 6.0 * c[k] * t);
            let torques = arm.torques(&tool, &q(t), &speed, &c.map(|c| 6.0 * c)).unwrap();
            let power: f64 = torques.iter().zip(&speed).map(|(torque, speed)| torque * speed).sum();
            let growth = (energy(&arm, &tool, q, t + h) - energy(&arm, &tool, q, t - h)) / (2.0 * h);
            assert!((power - growth).abs() < 1e-3 * (10.0 + power.abs()), "case {case}: {power} {growth}");
        }
    }

    #[test]
    fn a_level_arm_is_held_against_gravity() {
        let (arm, tool) = heavy();
        let still = [0.0; AXES];
        let torques = arm.torques(&tool, &[0.3, 0.4, 0.1, 0.0, 0.2, 0.0], &still, &still).unwrap();
        assert!(torques[0].abs() < 1e-12 && torques[1] < -5.0, "{torques:?}");
        // From the ceiling it pulls the other way; on a wall axis 1 holds it too.
        let hanging = Arm { up: -Vector3::z(), ..arm.clone() };
        let turned = hanging.torques(&tool, &[0.3, 0.4, 0.1, 0.0, 0.2, 0.0], &still, &still).unwrap();
        assert!(turned.iter().zip(&torques).all(|(a, b)| (a + b).abs() < 1e-12), "{turned:?}");
        let aside = Arm { up: Vector3::y(), ..arm.clone() };
        let turned = aside.torques(&tool, &[0.3, 0.4, 0.1, 0.0, 0.2, 0.0], &still, &still).unwrap();
        assert!(turned[0].abs() > 5.0, "{turned:?}");
        let weightless = Arm { links: Default::default(), ..arm };
        assert!(weightless.torques(&tool, &still, &still, &still).is_none() && !weightless.has_masses());
    }
}
