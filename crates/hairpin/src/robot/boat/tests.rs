//! The model against what is known of it: published matrices, energy, and a file's mistakes.

use nalgebra::{Matrix3, Vector3};

use super::*;
use crate::math::random::{stream, unit};

/// CyberShip II, as `data/robots/boat/cybership-ii.toml` has it.
pub(crate) fn cybership() -> Boat {
    description().build().expect("a boat")
}

fn description() -> BoatDescription {
    let file = serde_json::json!({
        "kind": "boat", "name": "cybership-ii", "mass_kg": 23.8, "yaw_inertia_kg_m2": 1.76,
        "centre_of_gravity_m": 0.046, "length_m": 1.255, "beam_m": 0.29,
        "hydrodynamics": {
            "x_du_kg": -2.0, "y_dv_kg": -10.0, "n_dr_kg_m2": -1.0,
            "x_u_kg_s": -0.72253, "x_uu_kg_m": -1.32742, "x_uuu_kg_s_m2": -5.86643,
            "y_v_kg_s": -0.88965, "y_vv_kg_m": -36.47287, "y_rv_kg": -0.805,
            "y_r_kg_m_s": -7.25, "y_vr_kg": -0.845, "y_rr_kg_m": -3.45,
            "n_v_kg_m_s": 0.0313, "n_vv_kg": 3.95645, "n_rv_kg_m": 0.13,
            "n_r_kg_m2_s": -1.9, "n_vr_kg_m": 0.08, "n_rr_kg_m2": -0.75,
        },
        "thrust": { "ahead_n": 2.0, "sway_n": 1.5, "yaw_n_m": 1.5, "time_constant_s": 0.3 },
    });
    serde_json::from_value(file).expect("a description")
}

/// The paper's matrices, written out as there, in its axes (y to starboard, z down).
#[test]
fn the_model_is_the_published_one_in_other_axes() {
    let boat = cybership();
    let (m, xg) = (23.8, 0.046);
    let mass = Matrix3::new(m + 2.0, 0.0, 0.0, 0.0, m + 10.0, m * xg, 0.0, m * xg, 1.76 + 1.0);
    let mut random = stream(1);
    for _ in 0..500 {
        let mut draw = |most: f64| most * (2.0 * unit(&mut random) - 1.0);
        let (nu, tau) = (Vector3::new(draw(0.6), draw(0.3), draw(0.5)), Vector3::new(draw(2.0), draw(1.5), draw(1.5)));
        let [u, v, r] = [nu.x, -nu.y, -nu.z];
        let rigid = Matrix3::new(0.0, 0.0, -m * (xg * r + v), 0.0, 0.0, m * u, m * (xg * r + v), -m * u, 0.0);
        let added = Matrix3::new(0.0, 0.0, -10.0 * v, 0.0, 0.0, 2.0 * u, 10.0 * v, -2.0 * u, 0.0);
        let damping = Matrix3::new(
            0.72253 + 1.32742 * u.abs() + 5.86643 * u * u,
            0.0,
            0.0,
            0.0,
            0.88965 + 36.47287 * v.abs() + 0.805 * r.abs(),
            7.25 + 0.845 * v.abs() + 3.45 * r.abs(),
            0.0,
            -0.0313 - 3.95645 * v.abs() - 0.13 * r.abs(),
            1.9 - 0.08 * v.abs() + 0.75 * r.abs(),
        );
        let theirs = Vector3::new(u, v, r);
        let force = Vector3::new(tau.x, -tau.y, -tau.z) - (rigid + added + damping) * theirs;
        let wanted = mass.try_inverse().expect("an inertia") * force;
        let found = boat.acceleration(&nu, &tau);
        assert!((found - Vector3::new(wanted.x, -wanted.y, -wanted.z)).norm() < 1e-12, "{found} {wanted}");
    }
}

/// C(ν) ν does no work: what is not damped keeps its energy.
#[test]
fn coriolis_forces_do_no_work_and_masses_are_solved_for() {
    let boat = cybership();
    let mut random = stream(2);
    for _ in 0..200 {
        let nu = Vector3::from_fn(|_, _| 2.0 * unit(&mut random) - 1.0);
        assert!(boat.inertia.coriolis(&nu).dot(&nu).abs() < 1e-12);
        assert!((boat.inertia.solve(&boat.inertia.times(&nu)) - nu).norm() < 1e-12);
    }
}

#[test]
fn the_top_speed_is_where_thrust_and_resistance_meet() {
    let boat = cybership();
    assert!((boat.damping.resistance(boat.top_speed) - 2.0).abs() < 1e-9);
    assert!((0.57..0.58).contains(&boat.top_speed), "{}", boat.top_speed);
    assert_eq!(boat.default_speed, 0.5 * boat.top_speed);
    assert!((boat.radius - 0.644).abs() < 1e-3);
    assert_eq!(boat.estimated, ["radius_m", "speed_m_s", "thrust.astern_n"]);
}

#[test]
fn mistakes_are_named_with_their_key() {
    let told = |change: fn(&mut BoatDescription)| {
        let mut file = description();
        change(&mut file);
        file.build().expect_err("a mistake").field
    };
    assert_eq!(told(|file| file.mass_kg = f64::NAN), "mass_kg");
    assert_eq!(told(|file| file.beam_m = 2.0), "beam_m");
    assert_eq!(told(|file| file.hydrodynamics.y_v_kg_s = 1.0), "hydrodynamics.y_v_kg_s");
    assert_eq!(told(|file| file.hydrodynamics.n_vv_kg = f64::INFINITY), "hydrodynamics.n_vv_kg");
    assert_eq!(told(|file| file.thrust.sway_n = 0.0), "thrust.sway_n");
    assert_eq!(told(|file| file.speed_m_s = Some(0.7)), "speed_m_s");
    assert_eq!(told(|file| file.name = " ".into()), "name");
    assert_eq!(told(|file| file.centre_of_gravity_m = 0.6), "yaw_inertia_kg_m2");
    let still = |file: &mut BoatDescription| {
        (file.hydrodynamics.x_u_kg_s, file.hydrodynamics.x_uu_kg_m, file.hydrodynamics.x_uuu_kg_s_m2) = (0.0, 0.0, 0.0);
    };
    assert_eq!(told(still), "hydrodynamics.x_u_kg_s");
}
