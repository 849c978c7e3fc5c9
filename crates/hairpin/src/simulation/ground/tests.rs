use nalgebra::Vector3;

use super::command::DriveCommand;
use super::plant::{Lost, Plant};
use crate::robot::rover::{Response, Rims, Rover, RoverDescription, Slip, Suspension, Weight, Wheels};
use crate::trajectory::drive::Planar;
use crate::world::terrain::{ElevationMap, Grid, HoleRule};

fn shipped(name: &str) -> Rover {
    let path = format!("{}/../../data/robots/rover/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers")
}

/// h = a x + b y on ±8 m.
fn plane(a: f64, b: f64) -> ElevationMap {
    let grid = Grid { columns: 33, rows: 33, first_center: [-8.0, -8.0], cell: [0.5, 0.5] };
    let height = |i: usize| a * (0.5 * (i % 33) as f64 - 8.0) + b * (8.0 - 0.5 * (i / 33) as f64);
    let heights: Vec<f32> = (0..33 * 33).map(|i| height(i) as f32).collect();
    ElevationMap::new(grid, &heights, HoleRule::Error).expect("a map")
}

const GO: DriveCommand = DriveCommand { speed: 0.1, curvature: 0.0, turn_rate: 0.0, direction: 0.0 };

#[test]
fn slip_on_planes_is_the_closed_form() {
    let sin_20 = 20_f64.to_radians().sin();
    for name in ["rocky8", "four-wheel"] {
        let vehicle = Rover { slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 }, ..shipped(name) };
        for (slope, sign) in [(0.3_f64, 1.0), (0.3, -1.0), (-0.2, 1.0)] {
            let angle = slope.atan();
            let command = DriveCommand { speed: sign * 0.1, ..GO };
            let up = plane(slope, 0.0);
            let mut plant = Plant::new(&vehicle, &up, 0.0, &Planar::default()).unwrap();
            plant.advance(&command, 50.0).unwrap();
            let way = 5.0 * angle.cos() * (sign - 0.3 * angle.sin() / sin_20);
            // Heights are single precision, a few 1e-8 of the slope.
            assert!((plant.x - way).abs() < 1e-6 && plant.y.abs() < 1e-9, "{name} {slope} {sign}: {}", plant.x);
            assert!((plant.slip() - sign * 0.3 * angle.sin() / sin_20).abs() < 1e-6, "{}", plant.slip());
            let v = plant.velocity();
            assert!((v.x - way / 50.0).abs() < 1e-7 && (v.z - slope * v.x).abs() < 1e-7);
            let across = plane(0.0, slope);
            let mut plant = Plant::new(&vehicle, &across, 0.0, &Planar::default()).unwrap();
            plant.advance(&command, 50.0).unwrap();
            let drift = -5.0 * 0.15 * angle.sin() / sin_20 * angle.cos();
            assert!((plant.y - drift).abs() < 1e-6 && (plant.x - sign * 5.0).abs() < 1e-6, "{name}: {}", plant.y);
        }
    }
}

#[test]
fn steering_lags_by_its_time_constant_and_rate() {
    let level = plane(0.0, 0.0);
    let mut vehicle = shipped("rocky8");
    vehicle.response = Response { steering_time_constant: 0.5, steered_axle: 0.5, ..Response::default() };
    let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    let command = DriveCommand { curvature: 0.8, ..GO };
    plant.advance(&command, 0.7).unwrap();
    let angle = 0.4_f64.atan() * (1.0 - (-1.4_f64).exp());
    assert!((plant.curvature() - angle.tan() / 0.5).abs() < 1e-12);
    vehicle.response.steering_rate = 0.1;
    let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    plant.advance(&command, 1.0).unwrap();
    assert!((plant.curvature() - 0.1_f64.tan() / 0.5).abs() < 1e-9, "{}", plant.curvature());
    // Never beyond what the wheels can.
    plant.advance(&DriveCommand { curvature: 9.0, ..GO }, 60.0).unwrap();
    assert!((plant.curvature() - vehicle.limits.curvature).abs() < 1e-9);
}

/// Whoever commands more than the wheels can is slowed on the bend, which comes as the speed falls.
#[test]
fn the_outer_rim_keeps_its_speed_whatever_is_commanded() {
    let level = plane(0.0, 0.0);
    let rims = Rims { track: 0.16, speed: 0.22, acceleration: 2.5 };
    let mut vehicle = shipped("rocky8");
    (vehicle.rims, vehicle.suspension, vehicle.response) = (Some(rims), Suspension::Level, Response::default());
    (vehicle.limits.speed, vehicle.limits.curvature, vehicle.limits.acceleration) = (0.2178, 9.0, 1.0);
    let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    let rim = |plant: &Plant| plant.speed.abs() * (1.0 + 0.08 * plant.curvature().abs());
    for (speed, curvature) in [(0.22, 0.0), (0.22, 9.0), (0.22, -9.0), (-0.22, 4.0)] {
        for _ in 0..200 {
            plant.advance(&DriveCommand { speed, curvature, ..GO }, 5e-3).unwrap();
            assert!(rim(&plant) <= 0.22 + 1e-9, "{} m/s at {speed}, {curvature}", rim(&plant));
        }
        let wanted = 0.2178_f64.min(0.22 / (1.0 + 0.08 * curvature.abs()));
        assert!((plant.speed.abs() - wanted).abs() < 1e-6, "{} {wanted}", plant.speed);
        assert!((plant.curvature() - curvature).abs() < 1e-6, "the bend is driven: {}", plant.curvature());
    }
}

/// x = s v (t − T (1 − e^(−t/T))) of a speed that lags by T on a scale s; a circle of the scaled curvature; and a wheel
/// that is told to stand comes to stand.
#[test]
fn speeds_lag_and_the_ground_makes_less_of_the_wheels() {
    let level = plane(0.0, 0.0);
    let mut vehicle = shipped("rocky8");
    vehicle.response = Response { speed_time_constant: 0.5, speed_scale: 0.9, turn_scale: 0.8, ..Response::default() };
    let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    plant.advance(&GO, 2.0).unwrap();
    let (gained, way) = (1.0 - (-4.0_f64).exp(), 0.09 * (2.0 - 0.5 * (1.0 - (-4.0_f64).exp())));
    assert!((plant.speed - 0.1 * gained).abs() < 1e-12, "{}", plant.speed);
    assert!((plant.x - way).abs() < 1e-3 * way && (plant.slip() - 0.1).abs() < 1e-12, "{} {way}", plant.x);
    assert!((plant.velocity().x - 0.09 * gained).abs() < 1e-12);
    plant.advance(&DriveCommand { speed: 0.0, ..GO }, 3.0).unwrap();
    assert_eq!(plant.speed, 0.0);
    vehicle.response = Response { speed_scale: 0.9, turn_scale: 0.8, ..Response::default() };
    let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    plant.advance(&DriveCommand { curvature: 0.5, ..GO }, 10.0).unwrap();
    let yaw = 0.4 * 0.9;
    assert!((plant.yaw - yaw).abs() < 1e-9 && (plant.x - yaw.sin() / 0.4).abs() < 1e-5, "{} {}", plant.yaw, plant.x);
    let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    plant.advance(&DriveCommand { turn_rate: 0.3, ..DriveCommand::default() }, 2.0).unwrap();
    assert!((plant.yaw - 0.6 * 0.72).abs() < 1e-9, "{}", plant.yaw);
}

#[test]
fn speeds_follow_with_the_bounded_acceleration_and_turns_wait_for_a_stop() {
    let level = plane(0.0, 0.0);
    let mut vehicle = shipped("rocky8");
    vehicle.limits.acceleration = 0.05;
    vehicle.limits.speed = 0.2;
    let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    plant.advance(&DriveCommand { speed: 1.0, ..GO }, 2.0).unwrap();
    // Half a t², the ramp's own area.
    assert!((plant.speed - 0.1).abs() < 1e-12 && (plant.x - 0.1).abs() < 1e-9, "{} {}", plant.speed, plant.x);
    plant.advance(&DriveCommand { speed: 1.0, ..GO }, 10.0).unwrap();
    assert_eq!(plant.speed, 0.2);
    let turn = DriveCommand { turn_rate: 0.3, ..DriveCommand::default() };
    plant.advance(&turn, 3.9).unwrap();
    assert!(plant.yaw == 0.0 && plant.speed > 0.0);
    plant.advance(&turn, 10.0).unwrap();
    assert!(plant.yaw > 1.0 && plant.speed == 0.0 && plant.turn_rate == 0.3);
    vehicle.limits.turns_in_place = false;
    let mut car = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    car.advance(&turn, 5.0).unwrap();
    assert_eq!(car.yaw, 0.0);
}

/// Of 50 kg on Mars, its wheels as strong as `torque` says.
fn heavy(torque: f64, rolling_resistance: f64) -> Rover {
    let rover = shipped("four-wheel");
    let weight = Some(Weight { mass: 50.0, gravity: 3.71, rolling_resistance });
    Rover { weight, wheels: Wheels { torque, ..rover.wheels }, ..rover }
}

/// v = (F/m − g (sin α + c cos α)) t with F = n τ / r; what is too steep for that is not climbed at all.
#[test]
fn torque_leaves_the_acceleration_that_climbing_and_rolling_do_not_take() {
    for slope in [0.0_f64, 0.15, 0.3, -0.2] {
        let angle = slope.atan();
        let hill = plane(slope, 0.0);
        for torque in [0.8, 1.5, 2.5] {
            let vehicle = heavy(torque, 0.05);
            let mut plant = Plant::new(&vehicle, &hill, 0.0, &Planar { x: -2.0, ..Planar::default() }).unwrap();
            let spare = 4.0 * torque / 0.12 / 50.0 - 3.71 * (angle.sin() + 0.05 * angle.cos());
            plant.advance(&DriveCommand { speed: 0.4, ..GO }, 0.2).unwrap();
            let expected = (spare * 0.2).clamp(0.0, 0.4);
            assert!((plant.speed - expected).abs() < 1e-6, "{slope} {torque}: {} m/s, {expected}", plant.speed);
            let told = plant.torque().expect("a weight");
            assert!(told <= torque + 1e-6 && (spare <= 0.0) == (told == 0.0), "{slope} {torque}: {told} N·m");
            if (0.0..0.4).contains(&expected) && expected > 0.0 {
                assert!((told - torque).abs() < 1e-6, "all that there is: {told} of {torque}");
            }
            plant.advance(&DriveCommand { speed: 0.4, ..GO }, 5.0).unwrap();
            let steady = plant.torque().expect("a weight");
            let needed = 50.0 * 3.71 * (angle.sin() + 0.05 * angle.cos()) * 0.12 / 4.0;
            assert!(spare <= 0.0 || (steady - needed).abs() < 1e-6, "{slope} {torque}: {steady}, not {needed}");
        }
    }
    // Carried on at speed onto what is too steep for it, it comes to rest, and stays.
    let (hill, vehicle) = (plane(0.3, 0.0), heavy(0.8, 0.0));
    let mut plant = Plant::new(&vehicle, &hill, 0.0, &Planar::default()).unwrap();
    plant.speed = 0.4;
    plant.advance(&DriveCommand { speed: 0.4, ..GO }, 10.0).unwrap();
    let spare = 4.0 * 0.8 / 0.12 / 50.0 - 3.71 * 0.3_f64.atan().sin();
    let way = 0.4_f64.powi(2) / (-2.0 * spare) * 0.3_f64.atan().cos();
    assert!(plant.speed == 0.0 && (plant.x - way).abs() < 2e-3, "{} m, not {way}", plant.x);
}

/// A pull of sin 20° of the weight slips as 20° do, ahead and aside, and tips by as much as it leans gravity.
#[test]
fn a_steady_force_is_a_tilt_of_gravity() {
    let (level, pull) = (plane(0.0, 0.0), 20_f64.to_radians().sin());
    let vehicle = Rover { slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 }, ..heavy(f64::INFINITY, 0.0) };
    let run = |pull: [f64; 3]| {
        let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
        let free = plant.stands().unwrap().margin;
        plant.pull = Vector3::from(pull);
        plant.advance(&GO, 20.0).unwrap();
        (plant.x, plant.y, plant.slip(), plant.torque().expect("a weight"), plant.stands().unwrap().margin, free)
    };
    let (x, y, slip, torque, ..) = run([-pull, 0.0, 0.0]);
    assert!((x - 2.0 * 0.7).abs() < 1e-9 && y.abs() < 1e-9 && (slip - 0.3).abs() < 1e-9, "{x} {y} {slip}");
    assert!((torque - pull * 50.0 * 3.71 * 0.12 / 4.0).abs() < 1e-9, "{torque}");
    let (x, y, slip, torque, margin, free) = run([0.0, pull, 0.0]);
    assert!((x - 2.0).abs() < 1e-9 && (y - 2.0 * 0.15).abs() < 1e-9 && slip == 0.0 && torque == 0.0, "{x} {y}");
    assert!((margin - (free - pull.atan())).abs() < 1e-9, "{margin} of {free}");
}

#[test]
fn no_ground_is_said() {
    let level = plane(0.0, 0.0);
    for name in ["rocky8", "generic"] {
        let vehicle = shipped(name);
        let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar { x: 6.0, ..Planar::default() }).unwrap();
        assert_eq!(plant.advance(&GO, 100.0), Err(Lost::NoGround), "{name}");
        assert!(plant.x < 8.01);
    }
}
