use nalgebra::Vector3;

use super::*;
use crate::math::random::{stream, unit};
use crate::world::terrain::generate::{Recipe, generate};
use crate::world::terrain::{Flat, Function, NoGround, Patch, Terrain};

fn shipped(name: &str) -> Rover {
    let path = format!("{}/../../data/robots/rover/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers")
}

/// h = a x + b y + c.
fn plane(a: f64, b: f64, c: f64) -> impl Terrain {
    Function(move |x: f64, y: f64| Patch { height: a * x + b * y + c, slope: [a, b], bend: [0.0; 3] })
}

/// Smooth hills.
fn hills() -> impl Terrain {
    Function(|x: f64, y: f64| {
        let (sx, cx) = (1.3 * x).sin_cos();
        let (sy, cy) = (0.9 * y + 0.4).sin_cos();
        Patch {
            height: 0.3 * sx * cy,
            slope: [0.39 * cx * cy, -0.27 * sx * sy],
            bend: [-0.507 * sx * cy, -0.351 * cx * sy, -0.243 * sx * cy],
        }
    })
}

#[test]
fn on_a_plane_of_any_tilt_the_body_has_the_planes_attitude() {
    for name in ["rocky7", "rocky8", "open-source-rover", "sojourner-like", "four-wheel"] {
        let rover = shipped(name);
        let level = rover.suspension.settle_cold(&Flat, [0.3, -0.2, 0.7]).expect("rest").0;
        for (a, b, yaw) in [(0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.0, 0.4, 0.0), (0.5, -0.3, 2.1), (-0.2, 0.6, -1.0)] {
            let settled = rover.suspension.settle_cold(&plane(a, b, 2.0), [1.0, 2.0, yaw]).expect("rest").0;
            // The plane's normal in the body frame is what it is on level ground.
            let normal = |s: &Settled, yaw: f64, n: Vector3<f64>| {
                nalgebra::Rotation3::from_euler_angles(s.roll, s.pitch, yaw).inverse() * n
            };
            let tilted = normal(&settled, yaw, Vector3::new(-a, -b, 1.0).normalize());
            let upright = normal(&level, 0.7, Vector3::z());
            assert!((tilted - upright).norm() < 1e-9, "{name} on ({a}, {b}): {tilted} instead of {upright}");
            assert!(settled.joints.iter().zip(&level.joints).all(|(p, q)| (p - q).abs() < 1e-9), "{name}: {settled:?}");
        }
    }
}

#[test]
fn signs_nose_up_on_a_climb_and_left_up_on_a_side_slope() {
    let rover = shipped("rocky8");
    let level = rover.suspension.settle_cold(&Flat, [0.0; 3]).expect("rest").0;
    let climbing = rover.suspension.settle_cold(&plane(0.3, 0.0, 0.0), [0.0; 3]).expect("rest").0;
    assert!((climbing.pitch - level.pitch + 0.3_f64.atan()).abs() < 1e-9, "θ > 0 is nose down: {climbing:?}");
    let across = rover.suspension.settle_cold(&plane(0.0, 0.3, 0.0), [0.0; 3]).expect("rest").0;
    assert!(across.roll > 0.25, "φ > 0 lifts the left side: {across:?}");
}

#[test]
fn a_step_under_one_wheel_turns_rocker_and_bogie_as_by_hand() {
    // A platform under the left rear wheel alone; level elsewhere, and level on it, so the contacts are point heights.
    let rover = shipped("rocky7");
    let Suspension::RockerBogie(body) = rover.suspension else { panic!("rocky7 has a rocker-bogie") };
    let step = 0.02;
    let ground = Function(move |x: f64, y: f64| {
        let height = if x < -0.02 && y > 0.0 { step } else { 0.0 };
        Patch { height, ..Patch::default() }
    });
    let (settled, _) = rover.suspension.settle_cold(&ground, [0.0; 3]).expect("rest");
    // By hand: each wheel's height is known, so the chain of bars must reach them.
    let attitude = nalgebra::Rotation3::from_euler_angles(settled.roll, settled.pitch, 0.0);
    for (i, wheel) in body.wheels(&settled.joints).iter().enumerate() {
        let z = (attitude * wheel).z + settled.z;
        let expected = body.wheel_radius + if i == 2 { step } else { 0.0 };
        assert!((z - expected).abs() < 1e-9, "wheel {i} at {z}, not {expected}");
    }
    // The left bogie stands on two points 138 mm apart, one 20 mm higher: in its side plane it leans by their slope
    // against the one it has on level ground, whatever the body does.
    let level = rover.suspension.settle_cold(&Flat, [0.0; 3]).expect("rest").0;
    let lean = |s: &Settled| s.pitch + s.joints[0] + s.joints[1];
    let expected = (step / 0.138_f64).asin();
    assert!(
        (lean(&settled) - lean(&level) - expected).abs() < 1e-3,
        "{} not {expected}",
        lean(&settled) - lean(&level)
    );
    // The right bogie keeps its ground, so its lean does not change beyond the body's small roll.
    let right = |s: &Settled| s.pitch - s.joints[0] + s.joints[2];
    assert!((right(&settled) - right(&level)).abs() < 1e-3);
    // The differential shares the lifted joint (half the step) between the rockers: body pitch takes half of the angle.
    let rise = (0.5 * step) / (0.288 + 0.1208);
    assert!((settled.pitch - level.pitch - 0.5 * rise).abs() < 2e-3, "{settled:?} {level:?}");
    assert!((settled.joints[0] - level.joints[0] - 0.5 * rise).abs() < 2e-3, "{settled:?} {level:?}");
}

#[test]
fn a_body_that_falls_over_an_edge_finds_the_rest_that_there_is() {
    let rover = shipped("rocky8");
    let suspension = &rover.suspension;
    let mut random = stream(7);
    let (mut falls, mut lost) = (0, 0);
    // Cells of 5 cm with rocks: the wheels' contacts have edges.
    let recipe = Recipe { size_m: 20.0, cell_m: 0.05, relief_m: 0.5, rock_cover: 0.1, seed: 3, ..Recipe::default() };
    let yard = generate(&recipe).expect("a yard");
    for _ in 0..100 {
        let [x, y] = [(); 2].map(|()| 3.0 + 14.0 * unit(&mut random));
        let yaw = 2.0 * std::f64::consts::PI * unit(&mut random);
        let Ok((mut rest, _)) = suspension.settle_cold(&yard, [x, y, yaw]) else { continue };
        for step in 1..1000 {
            let s = 0.002 * f64::from(step);
            let at = [x + s * yaw.cos(), y + s * yaw.sin(), yaw];
            let last = rest;
            match suspension.carry_on(&yard, at, &last, 2e-3) {
                Ok((found, _)) => rest = found,
                Err(Unsettled::OnItsHead) => break,
                Err(why) => {
                    let mut guess = || {
                        let mut by = |most: f64| most * (2.0 * unit(&mut random) - 1.0);
                        let joints = [last.joints[0] + by(0.6), last.joints[1] + by(1.0), last.joints[2] + by(1.0)];
                        Settled { z: last.z + by(0.1), roll: last.roll + by(0.3), pitch: last.pitch + by(0.3), joints }
                    };
                    let other = (0..200).find_map(|_| suspension.settle(&yard, at, &guess(), 1e-6).ok());
                    if let Some((other, _)) = other {
                        lost += 1;
                        println!("at {at:?}: {why}, but {other:?} rests, after {last:?}");
                        rest = other;
                    }
                }
            }
            falls += usize::from((0..3).any(|i| (rest.joints[i] - last.joints[i]).abs() > 0.1));
        }
    }
    println!("{falls} falls, {lost} rests not found");
    assert!(falls >= 10 && lost == 0, "{falls} falls, {lost} rests not found");
}

#[test]
fn the_gradient_is_that_of_the_settled_pose() {
    for name in ["rocky8", "four-wheel", "open-source-rover", "sojourner-like"] {
        let rover = shipped(name);
        let hills = hills();
        let settle = |at: [f64; 3]| rover.suspension.settle_cold(&hills, at).expect("rest");
        for i in 0..40 {
            let at = [0.11 * f64::from(i), 3.0 - 0.17 * f64::from(i), 0.3 * f64::from(i)];
            let (settled, gradient) = settle(at);
            for axis in 0..3 {
                let h = 1e-5;
                let (mut ahead, mut behind) = (at, at);
                ahead[axis] += h;
                behind[axis] -= h;
                let (p, q) = (settle(ahead).0, settle(behind).0);
                if name != "four-wheel" {
                    let z = gradient.by_place[0][axis];
                    assert!((z - (p.z - q.z) / (2.0 * h)).abs() < 1e-5, "{name} {at:?} {axis}");
                    for joint in 0..3 {
                        let by = gradient.by_place[3 + joint][axis];
                        let difference = (p.joints[joint] - q.joints[joint]) / (2.0 * h);
                        assert!((by - difference).abs() < 1e-5, "{name} {at:?} {axis} {joint} {settled:?}");
                    }
                }
                // Gauss-Newton's gradient leaves out what the gaps bend, which four wheels on hills have.
                let close = if name == "four-wheel" { 2e-2 } else { 1e-5 };
                assert!((gradient.roll()[axis] - (p.roll - q.roll) / (2.0 * h)).abs() < close, "{name} {at:?} {axis}");
                assert!(
                    (gradient.pitch()[axis] - (p.pitch - q.pitch) / (2.0 * h)).abs() < close,
                    "{name} {at:?} {axis}"
                );
            }
        }
    }
}

#[test]
fn a_mirrored_ground_gives_the_mirrored_pose() {
    let rover = shipped("rocky8");
    let hills = hills();
    let mirrored = Function(|x: f64, y: f64| {
        let patch = hills.patch(x, -y).expect("hills everywhere");
        Patch {
            height: patch.height,
            slope: [patch.slope[0], -patch.slope[1]],
            bend: [patch.bend[0], -patch.bend[1], patch.bend[2]],
        }
    });
    let a = rover.suspension.settle_cold(&hills, [0.4, 0.8, 0.5]).expect("rest").0;
    let b = rover.suspension.settle_cold(&mirrored, [0.4, -0.8, -0.5]).expect("rest").0;
    assert!((a.z - b.z).abs() < 1e-9 && (a.roll + b.roll).abs() < 1e-9 && (a.pitch - b.pitch).abs() < 1e-9);
    assert!((a.joints[0] + b.joints[0]).abs() < 1e-9 && (a.joints[1] - b.joints[2]).abs() < 1e-9);
}

#[test]
fn no_ground_below_a_wheel_is_said() {
    struct Cliff;
    impl Terrain for Cliff {
        fn patch(&self, x: f64, y: f64) -> Result<Patch, NoGround> {
            if x > 0.5 { Err(NoGround::OffMap { x, y }) } else { Ok(Patch::default()) }
        }
    }
    let error = shipped("rocky8").suspension.settle_cold(&Cliff, [0.2, 0.0, 0.0]).expect_err("a cliff");
    assert!(matches!(error, Unsettled::NoGround(NoGround::OffMap { .. })), "{error:?}");
}

#[test]
fn rates_on_level_ground_are_the_plane_ones_and_slip_acts_downhill() {
    let (flat, straight) = (Settled::default(), (0.0, 1.0));
    let r = rates(&flat, straight, -1.0, 0.3, &Slip::default());
    assert_eq!((r.ahead, r.left, r.yaw), (-1.0, 0.0, -0.3));
    let crab = rates(&flat, 0.5_f64.sin_cos(), 1.0, 0.3, &Slip::default());
    assert!((crab.left - 0.5_f64.sin()).abs() < 1e-15 && (crab.ahead - 0.5_f64.cos()).abs() < 1e-15);
    // 20° nose up: 30 % of the way is lost.
    let up = Settled { pitch: -20.0_f64.to_radians(), ..flat };
    let slip = Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 };
    let r = rates(&up, straight, 1.0, 0.0, &slip);
    assert!((r.ahead - 0.7 * 20.0_f64.to_radians().cos()).abs() < 1e-12, "{r:?}");
    // Left side up: drifts to the right, forwards and in reverse.
    let across = Settled { roll: 20.0_f64.to_radians(), ..flat };
    for sign in [1.0, -1.0] {
        let r = rates(&across, straight, sign, 0.0, &slip);
        assert!((r.left + 0.15 * 20.0_f64.to_radians().cos()).abs() < 1e-12 && (r.ahead - sign).abs() < 1e-12, "{r:?}");
    }
}

#[test]
fn numbers_that_make_no_rover_are_refused_by_key() {
    let path = format!("{}/../../data/robots/rover/rocky8.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    for (from, to, key) in [
        ("wheel_radius_m = 0.13", "wheel_radius_m = -0.13", "suspension.wheel_radius_m"),
        ("pivot_m = [0.2415, 0.40", "pivot_m = [0.2415, -0.40", "rocker_wheel_m"),
        ("[[0.138, 0.0, -0.04], [-0.138", "[[0.138, 0.0, -0.04], [0.138", "bogie_wheels_m"),
        ("curvature_1_m = 1.0", "curvature_1_m = nan", "limits.curvature_1_m"),
        ("tilt_deg = 45", "tilt_deg = -1", "limits.tilt_deg"),
        ("side_slip_at_20_deg = 0", "side_slip_at_20_deg = 2", "side_slip_at_20_deg"),
    ] {
        let broken = text.replace(from, to);
        assert_ne!(broken, text, "{from}");
        let error = toml::from_str::<RoverDescription>(&broken).expect("its keys").build().expect_err(key);
        assert!(error.field.contains(key), "{error}");
    }
}

#[test]
fn slip_grows_with_the_load() {
    let path = format!("{}/../../data/robots/rover/rocky8.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    let text = text.replace("side_slip_at_20_deg = 0", "side_slip_at_20_deg = 0.1");
    let text = text.replace("\nslip_at_20_deg = 0", "\nslip_at_20_deg = 0.3");
    let with = |keys: &str| {
        let text = text.replace("\n[suspension]", &format!("\n{keys}\n[suspension]"));
        toml::from_str::<RoverDescription>(&text).expect("its keys").build()
    };
    let slip = |keys: &str| with(keys).expect("its numbers").slip;
    assert_eq!(slip(""), Slip { at_20_deg: 0.3, side_at_20_deg: 0.1 });
    assert_eq!(slip("mass_kg = 60"), slip(""));
    let half_again = slip("mass_kg = 60\nload_kg = 30");
    assert!((half_again.at_20_deg - 0.45).abs() < 1e-15 && (half_again.side_at_20_deg - 0.15).abs() < 1e-15);
    let rooted = slip("mass_kg = 60\nload_kg = 30\nslip_load_exponent = 0.5");
    assert!((rooted.at_20_deg - 0.3 * 1.5_f64.sqrt()).abs() < 1e-15);
    for (keys, field, bound) in [
        ("load_kg = 30", "load_kg", "mass_kg"),
        ("mass_kg = 60\nload_kg = 180", "load_kg", "it would be 1.200"),
        ("mass_kg = 0", "mass_kg", "0.001"),
        ("mass_kg = 60\nload_kg = -1", "load_kg", "0"),
        ("slip_load_exponent = nan", "slip_load_exponent", "10"),
    ] {
        let error = with(keys).unwrap_err();
        assert!(error.field == field && error.bound.contains(bound), "{keys}: {error}");
    }
}

/// On rough ground four wheels rest where slopes jump as well: from cold everywhere, and carried on in a plant's small
/// steps.
#[test]
fn four_wheels_find_rest_on_the_kinks_of_a_map() {
    let body = shipped("four-wheel").suspension;
    let map = generate(&Recipe { cell_m: 0.2, seed: 1, ..Recipe::default() }).unwrap();
    let mut random = stream(11);
    let (mut stood, mut lost) = (0, 0);
    for _ in 0..400 {
        let [x, y, yaw] = [10.0 + 40.0 * unit(&mut random), 10.0 + 40.0 * unit(&mut random), 6.3 * unit(&mut random)];
        let Ok((mut pose, mut gradient)) = body.settle_cold(&map, [x, y, yaw]) else { continue };
        for i in 1..400 {
            let (sin, cos) = yaw.sin_cos();
            let at = [x + 0.005 * cos * f64::from(i), y + 0.005 * sin * f64::from(i), yaw];
            let guess = pose.moved(&gradient.over([0.005 * cos, 0.005 * sin, 0.0]));
            match body.carry_on(&map, at, &guess, 1e-4) {
                Ok(found) => (pose, gradient) = found,
                Err(_) => {
                    lost += 1;
                    break;
                }
            }
        }
        stood += 1;
    }
    assert!(stood == 400 && lost == 0, "{stood} stood, {lost} were lost");
}
