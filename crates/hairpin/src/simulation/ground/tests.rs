use super::plant::{Command, Lost, Plant};
use crate::robot::rover::{Response, Rover, RoverDescription, Slip};
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

const GO: Command = Command { speed: 0.1, curvature: 0.0, turn_rate: 0.0, direction: 0.0 };

#[test]
fn slip_on_planes_is_the_closed_form() {
    let sin_20 = 20_f64.to_radians().sin();
    for name in ["rocky8", "four-wheel"] {
        let vehicle = Rover { slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 }, ..shipped(name) };
        for (slope, sign) in [(0.3_f64, 1.0), (0.3, -1.0), (-0.2, 1.0)] {
            let angle = slope.atan();
            let command = Command { speed: sign * 0.1, ..GO };
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
    let command = Command { curvature: 0.8, ..GO };
    plant.advance(&command, 0.7).unwrap();
    let angle = 0.4_f64.atan() * (1.0 - (-1.4_f64).exp());
    assert!((plant.curvature() - angle.tan() / 0.5).abs() < 1e-12);
    vehicle.response.steering_rate = 0.1;
    let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    plant.advance(&command, 1.0).unwrap();
    assert!((plant.curvature() - 0.1_f64.tan() / 0.5).abs() < 1e-9, "{}", plant.curvature());
    // Never beyond what the wheels can.
    plant.advance(&Command { curvature: 9.0, ..GO }, 60.0).unwrap();
    assert!((plant.curvature() - vehicle.limits.curvature).abs() < 1e-9);
}

#[test]
fn speeds_follow_with_the_bounded_acceleration_and_turns_wait_for_a_stop() {
    let level = plane(0.0, 0.0);
    let mut vehicle = shipped("rocky8");
    vehicle.limits.acceleration = 0.05;
    vehicle.limits.speed = 0.2;
    let mut plant = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    plant.advance(&Command { speed: 1.0, ..GO }, 2.0).unwrap();
    // Half a t², the ramp's own area.
    assert!((plant.speed - 0.1).abs() < 1e-12 && (plant.x - 0.1).abs() < 1e-9, "{} {}", plant.speed, plant.x);
    plant.advance(&Command { speed: 1.0, ..GO }, 10.0).unwrap();
    assert_eq!(plant.speed, 0.2);
    let turn = Command { turn_rate: 0.3, ..Command::default() };
    plant.advance(&turn, 3.9).unwrap();
    assert!(plant.yaw == 0.0 && plant.speed > 0.0);
    plant.advance(&turn, 10.0).unwrap();
    assert!(plant.yaw > 1.0 && plant.speed == 0.0 && plant.turn_rate == 0.3);
    vehicle.limits.turns_in_place = false;
    let mut car = Plant::new(&vehicle, &level, 0.0, &Planar::default()).unwrap();
    car.advance(&turn, 5.0).unwrap();
    assert_eq!(car.yaw, 0.0);
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
