use nalgebra::{SVector, Vector2};

use super::*;
use crate::math::integrate::rk4_step;
use crate::robot::{Dynamics, Vector};

fn text(name: &str) -> String {
    let path = format!("{}/../../data/robots/ground/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("a shipped robot")
}

fn car() -> Car {
    toml::from_str::<CarDescription>(&text("car")).expect("its keys").build().expect("its numbers")
}

fn drive() -> DifferentialDrive {
    let text = text("differential-drive");
    toml::from_str::<DifferentialDriveDescription>(&text).expect("its keys").build().expect("its numbers")
}

/// The state after `time` s in `steps` steps.
fn integrated<D: Dynamics<State = SVector<f64, 5>>>(
    robot: &D,
    start: [f64; 5],
    control: &D::Control,
    time: f64,
    steps: usize,
    euler: bool,
) -> SVector<f64, 5> {
    let h = time / steps as f64;
    (0..steps).fold(SVector::from(start), |x, _| {
        if euler {
            x.add_scaled(&robot.derivative(&x, control), h)
        } else {
            rk4_step(|x| robot.derivative(x, control), &x, h)
        }
    })
}

#[test]
fn constant_steering_is_a_circle_of_the_bicycles_radius() {
    let car = car();
    let (v, steering, time) = (2.0, 0.3_f64, 1.7);
    let radius = car.wheelbase / steering.tan();
    let end = integrated(&car, [0.0, 0.0, 0.0, v, steering], &Vector2::zeros(), time, 200, false);
    let turned = v * time / radius;
    assert!((end[0] - radius * turned.sin()).abs() < 1e-6 && (end[1] - radius * (1.0 - turned.cos())).abs() < 1e-6);
    assert!((end[2] - turned).abs() < 1e-12);
    // Backwards round the same circle.
    let back = integrated(&car, [0.0, 0.0, 0.0, -v, steering], &Vector2::zeros(), time, 200, false);
    assert!((back[0] + end[0]).abs() < 1e-9 && (back[1] - end[1]).abs() < 1e-9 && (back[2] + end[2]).abs() < 1e-12);
}

#[test]
fn spirals_turn_by_the_integral_of_their_rates() {
    // Steering at a constant rate: ψ = −v/(L δ̇) ln cos(δ̇ t).
    let car = car();
    let (v, rate, time) = (1.5, 0.5, 0.7);
    let end = integrated(&car, [0.0, 0.0, 0.0, v, 0.0], &Vector2::new(0.0, rate), time, 400, false);
    let turned = -v / (car.wheelbase * rate) * (rate * time).cos().ln();
    assert!((end[2] - turned).abs() < 1e-9, "{} {turned}", end[2]);
    // A differential drive with constant accelerations: ψ = ω t + α t²/2, a clothoid if v is constant.
    let drive = drive();
    let (w, alpha, time) = (0.3, 0.8, 1.5);
    let end = integrated(&drive, [0.0, 0.0, 0.0, 0.1, w], &Vector2::new(0.0, alpha), time, 300, false);
    assert!((end[2] - (w * time + 0.5 * alpha * time * time)).abs() < 1e-12);
    let n = 20_000;
    let place = (0..n).fold([0.0, 0.0], |p: [f64; 2], i| {
        let t = (f64::from(i) + 0.5) * time / f64::from(n);
        let yaw = w * t + 0.5 * alpha * t * t;
        [p[0] + 0.1 * yaw.cos() * time / f64::from(n), p[1] + 0.1 * yaw.sin() * time / f64::from(n)]
    });
    assert!((end[0] - place[0]).abs() < 1e-9 && (end[1] - place[1]).abs() < 1e-9);
}

#[test]
fn eulers_steps_come_to_the_runge_kutta_end_in_proportion() {
    let car = car();
    let control = Vector2::new(0.8, -0.4);
    let start = [0.5, -0.3, 1.0, 1.0, 0.2];
    let fine = integrated(&car, start, &control, 1.0, 1000, false);
    let error = |steps| (integrated(&car, start, &control, 1.0, steps, true) - fine).norm();
    let (coarse, half) = (error(500), error(1000));
    assert!(half < 2e-3 && (coarse / half - 2.0).abs() < 0.02, "{coarse} {half}");
}

#[test]
fn limits_of_state_stop_it_and_wheels_bound_together() {
    let car = car();
    let mut state = SVector::from([0.0, 0.0, 0.0, 99.0, -2.0]);
    car.normalize(&mut state);
    assert_eq!((state[3], state[4]), (car.speed, -car.steering));
    let drive = drive();
    let mut state = SVector::from([0.0, 0.0, 0.0, drive.wheel_speed, 0.5 * drive.turn_rate()]);
    drive.normalize(&mut state);
    let (left, right) = (state[3] - 0.5 * drive.track * state[4], state[3] + 0.5 * drive.track * state[4]);
    assert!((right - drive.wheel_speed).abs() < 1e-15 && (left - 0.5 * drive.wheel_speed).abs() < 1e-15);
}

#[test]
fn outlines_hold_what_was_given_and_estimates_are_told() {
    let (car, drive) = (car(), drive());
    let belly = car.vehicle().body.belly;
    assert!((belly.front - belly.rear - 0.58).abs() < 1e-12 && (belly.half_width - 0.155).abs() < 1e-12);
    assert!((0.5 * (belly.front + belly.rear) - 0.5 * car.wheelbase).abs() < 1e-12);
    assert_eq!((drive.vehicle().body.belly.front, car.estimated.len()), (0.149, 0));
    let bare = text("car").replace("length_m = 0.58\n", "").replace("width_m = 0.31\n", "");
    let bare = toml::from_str::<CarDescription>(&bare).expect("its keys").build().expect("its numbers");
    assert_eq!(bare.estimated, ["length_m", "width_m"]);
    assert!(bare.length > bare.wheelbase);
}

#[test]
fn vehicles_for_the_generator_keep_the_limits() {
    let car = car();
    let vehicle = car.vehicle();
    assert!(!vehicle.limits.turns_in_place && vehicle.suspension == Suspension::Level);
    assert!((libm::atan(vehicle.limits.curvature * car.wheelbase) - car.steering).abs() < 1e-12);
    // The steering rate that the largest κ′ asks for at the default speed, at any curvature.
    for share in [0.0, 0.5, 1.0] {
        let bend = share * vehicle.limits.curvature * car.wheelbase;
        let rate = car.wheelbase * vehicle.limits.curvature_rate * vehicle.default_speed / (1.0 + bend * bend);
        assert!(rate <= car.steering_rate * (1.0 + 1e-12), "{rate}");
    }
    let drive = drive();
    let vehicle = drive.vehicle();
    let v = vehicle.default_speed;
    assert!((v + 0.5 * drive.track * vehicle.limits.curvature * v - drive.wheel_speed).abs() < 1e-12);
    assert!(vehicle.limits.turns_in_place);
}

#[test]
fn numbers_that_make_no_robot_are_refused_by_key() {
    let text_of = text("car");
    for (from, to, key) in [
        ("wheelbase_m = 0.3302", "wheelbase_m = -1", "wheelbase_m"),
        ("steering_deg = 24.0", "steering_deg = 90", "limits.steering_deg"),
        ("length_m = 0.58", "length_m = 0.2", "length_m"),
        ("name = \"car\"", "name = \" \"", "name"),
        ("speed_m_s = 2.0", "speed_m_s = 60", "speed_m_s"),
    ] {
        let broken = text_of.replacen(from, to, 1);
        assert_ne!(broken, text_of, "{from}");
        let error = toml::from_str::<CarDescription>(&broken).expect("its keys").build().expect_err(key);
        assert_eq!(error.field, key, "{error}");
    }
    let text_of = text("differential-drive");
    for (from, to, key) in [
        ("track_m = 0.160", "track_m = nan", "track_m"),
        ("radius_m = 0.149", "radius_m = 0.05", "radius_m"),
        ("wheel_speed_m_s = 0.22", "wheel_speed_m_s = 0", "limits.wheel_speed_m_s"),
        ("speed_m_s = 0.11", "speed_m_s = 0.22", "speed_m_s"),
    ] {
        let broken = text_of.replacen(from, to, 1);
        assert_ne!(broken, text_of, "{from}");
        let description = toml::from_str::<DifferentialDriveDescription>(&broken).expect("its keys");
        assert_eq!(description.build().expect_err(key).field, key);
    }
    assert!(toml::from_str::<CarDescription>(&text("car").replace("[limits]", "[limit]")).is_err());
}
