//! What driving takes: the force along the way, and the torque that each wheel has a share of it to turn with.
//!
//! Quasi-static: no inertia but that along the way, no transfer of load between wheels. A necessary condition, then:
//! what is refused for torque could not be driven by any sharing of it, what is accepted may still spin a wheel that
//! carries little.

use nalgebra::Vector3;

use super::{Rover, Settled};

/// What the wheels do for a motion, quasi-static.
///
/// Torque is about the axle of one wheel, τ = F r/n; power is traction times speed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Along the way, N; negative where they brake.
    pub traction: f64,
    /// Of each wheel, N·m; it pushes where it is positive.
    pub torque: f64,
}

impl Rover {
    /// What the wheels do for a body that stands as `pose`, travels with `sign` (±1) along the direction δ
    /// (`direction`: sine and cosine) of it, gains `acceleration` (m/s²) along its way, and is pulled by `pull` (body
    /// axes, as a share of its weight); `None` without a weight.
    ///
    /// ```text
    /// F = m g (sin(climb) − pull · way) + c N + m a     N = m g max(0, cosφ cosθ − pull · z)     τ = F r / n
    /// ```
    ///
    /// with n wheels, all driven, of radius r, that share F evenly: no other shares of F do with less than the largest
    /// of these. What turning wheels on the spot and scrubbing take is left out.
    ///
    /// Infinite or NaN without wheels, which a weight excludes. `pull` is subtracted from the vertical in body axes, as
    /// a tilted gravity would be.
    pub fn effort(
        &self,
        pose: &Settled,
        direction: (f64, f64),
        sign: f64,
        acceleration: f64,
        pull: &Vector3<f64>,
    ) -> Option<Effort> {
        let weight = self.weight.as_ref()?;
        let ((sin_roll, cos_roll), (sin_pitch, cos_pitch)) = (libm::sincos(pose.roll), libm::sincos(pose.pitch));
        // The vertical, and so the weight, in the body.
        let up = Vector3::new(-sin_pitch, cos_pitch * sin_roll, cos_pitch * cos_roll) - pull;
        let climb = sign * (direction.1 * up.x + direction.0 * up.y);
        let resistance = weight.rolling_resistance * up.z.max(0.0);
        let traction = weight.newtons() * (climb + resistance) + weight.mass * acceleration;
        let (_, count, radius) = self.suspension.wheels(&[0.0; 3]);
        Some(Effort { traction, torque: traction * radius / count as f64 })
    }

    /// The force along the way that all wheels bring about with all their torque, N; infinite without a bound.
    ///
    /// n τ_max/r; friction with the ground may allow less, which is not asked.
    pub fn most_traction(&self) -> f64 {
        let (_, count, radius) = self.suspension.wheels(&[0.0; 3]);
        if self.wheels.torque.is_finite() { self.wheels.torque * count as f64 / radius } else { f64::INFINITY }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::super::weight::{GRAVITY, Weight};
    use super::super::{RoverDescription, RoverError};
    use super::*;
    use crate::world::terrain::{Function, Patch};

    fn described(keys: &str, wheels: &str) -> Result<Rover, RoverError> {
        let text = format!(
            "kind = \"rover\"\nname = \"test\"\nsteering = \"all-wheel\"\n{keys}\n\
             suspension = {{ kind = \"four-wheel\", wheel_radius_m = 0.1, front_m = [0.4, 0.3, 0.0], rear_m = [-0.4, 0.3, 0.0] }}\n\
             limits = {{ curvature_1_m = 1.0 }}\n[wheels]\n{wheels}"
        );
        toml::from_str::<RoverDescription>(&text).expect("its keys").build()
    }

    const MARS: &str = "mass_kg = 50\nload_kg = 10\nforces = { gravity_m_s2 = 3.71, rolling_resistance = 0.05 }";

    /// On a plane of slope α the force up it is m g (sin α + c cos α) + m a, along the contour line c m g cos α,
    /// whichever way the body looks.
    #[test]
    fn traction_on_planes_is_the_closed_form() {
        let rover = described(MARS, "").expect("its numbers");
        let (weight, none) = (60.0 * 3.71, Vector3::zeros());
        for slope in [0.0_f64, 0.2, 0.5] {
            let angle = slope.atan();
            let plane =
                Function(move |x: f64, _: f64| Patch { height: slope * x, slope: [slope, 0.0], bend: [0.0; 3] });
            for yaw in [0.0, 0.7, 2.0, -1.5] {
                let pose = rover.suspension.settle_cold(&plane, [1.0, 2.0, yaw]).expect("rest").0;
                // Towards x whatever the heading: over the plane the way to the slope's foot is not −yaw but as its
                // vectors are.
                let body = nalgebra::Rotation3::from_euler_angles(pose.roll, pose.pitch, yaw);
                let towards = |way: nalgebra::Vector3<f64>| {
                    let way = body.inverse() * way;
                    assert!(way.z.abs() < 1e-9, "on the plane");
                    (way.y, way.x)
                };
                let (up, along) = (nalgebra::Vector3::new(angle.cos(), 0.0, angle.sin()), nalgebra::Vector3::y());
                let rolls = 0.05 * weight * angle.cos();
                for (sign, expected) in [(1.0, weight * angle.sin() + rolls), (-1.0, rolls - weight * angle.sin())] {
                    let effort = rover.effort(&pose, towards(up), sign, 0.25, &none).expect("a weight");
                    assert!(
                        (effort.traction - expected - 60.0 * 0.25).abs() < 1e-6,
                        "{slope} {yaw} {sign}: {effort:?}"
                    );
                    assert!((effort.torque - effort.traction * 0.1 / 4.0).abs() < 1e-12);
                }
                let across = rover.effort(&pose, towards(along), 1.0, 0.0, &none).expect("a weight");
                assert!((across.traction - rolls).abs() < 1e-6, "{across:?}");
            }
        }
    }

    /// On the level a force backwards of sin α, with what it lifts of the weight, is a slope of α.
    #[test]
    fn a_pull_is_gravity_that_leans() {
        let rover = described(MARS, "").expect("its numbers");
        let angle = 0.3_f64;
        let pull = Vector3::new(-angle.sin(), 0.0, 1.0 - angle.cos());
        let nose_up = Settled { pitch: -angle, ..Settled::default() };
        let pulled = rover.effort(&Settled::default(), (0.0, 1.0), 1.0, 0.0, &pull).expect("a weight");
        let climbing = rover.effort(&nose_up, (0.0, 1.0), 1.0, 0.0, &Vector3::zeros()).expect("a weight");
        assert!((pulled.traction - climbing.traction).abs() < 1e-9, "{pulled:?} {climbing:?}");
        // What is lifted off the ground rolls without resistance.
        let lifted = rover.effort(&Settled::default(), (0.0, 1.0), 1.0, 0.0, &Vector3::new(0.0, 0.0, 2.0));
        assert_eq!(lifted.expect("a weight").traction, 0.0);
    }

    #[test]
    fn weights_are_told_only_where_they_are_asked_for_and_need_a_mass() {
        assert_eq!(described("mass_kg = 50", "").expect("its numbers").weight, None);
        let bounded = described("mass_kg = 50", "torque_n_m = 4").expect("its numbers");
        assert_eq!(bounded.weight, Some(Weight { mass: 50.0, gravity: GRAVITY, rolling_resistance: 0.0 }));
        assert!((bounded.most_traction() - 160.0).abs() < 1e-12 && bounded.wheels.bounded());
        assert_eq!(described(MARS, "").expect("its numbers").most_traction(), f64::INFINITY);
        for (keys, wheels, field) in [
            ("", "torque_n_m = 4", "wheels.torque_n_m"),
            ("forces = {}", "", "forces"),
            ("mass_kg = 50", "torque_n_m = -4", "wheels.torque_n_m"),
            ("mass_kg = 50\nforces = { gravity_m_s2 = 0 }", "", "forces.gravity_m_s2"),
            ("mass_kg = 50\nforces = { rolling_resistance = nan }", "", "forces.rolling_resistance"),
        ] {
            let error = described(keys, wheels).expect_err(field);
            assert_eq!(error.field, field);
        }
        let point = "kind = \"rover\"\nname = \"p\"\nmass_kg = 1\nforces = {}\nlimits = { curvature_1_m = 1.0 }";
        let error = toml::from_str::<RoverDescription>(point).expect("its keys").build().expect_err("no wheels");
        assert!(error.field == "forces" && error.bound.contains("suspension"), "{error}");
    }
}
