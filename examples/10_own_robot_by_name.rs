//! The whole command line with a robot of one's own in it, known by its name wherever a shipped one is:
//! `cargo run --example 10_own_robot_by_name -- new camera-racer`, or `-- stress camera-racer`.

use std::process::ExitCode;

use hairpin_cli::Extra;

/// A racing drone that carries 0.3 kg of camera in its middle: a robot's file, as `my_robot.toml` would be.
const CAMERA_RACER: &str = r#"
kind = "quadrotor"
name = "camera-racer"
source = "data/robots/quadrotor/flightgoggles.toml, and a camera"
mass_kg = 1.3
inertia_kg_m2 = [0.0052, 0.0052, 0.0071]
thrust_coefficient_n_s2 = 1.91e-6
moment_coefficient_n_m_s2 = 2.6e-7
rotor_speed_rad_s = [0, 2200]
rotor_time_constant_s = 0.02
drag_quadratic_n_s2_m2 = 0.13
max_speed_m_s = 16
clearance_radius_m = 0.23
gravity_m_s2 = 9.81
rotors = [
  { x_m = 0.08, y_m = 0.08, spin = -1 },
  { x_m = -0.08, y_m = 0.08, spin = 1 },
  { x_m = -0.08, y_m = -0.08, spin = -1 },
  { x_m = 0.08, y_m = -0.08, spin = 1 },
]
"#;

fn main() -> ExitCode {
    let extra = Extra { robots: vec![("camera-racer", CAMERA_RACER)], ..Extra::default() };
    hairpin_cli::run_with(std::env::args_os(), extra).into()
}
