use super::*;

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

/// v (1 + κ b/2) and v̇ (1 + κ b/2) + ½ b v² κ′ at the outer rim, whatever the speed and its change.
#[test]
fn bounds_follow_the_speed_that_is_driven() {
    let drive = drive();
    let vehicle = drive.vehicle();
    assert_eq!(vehicle.limits_at(vehicle.default_speed, 0.0), vehicle.limits, "its own at its default speed");
    for share in [0.1, 0.3, 0.5, 0.8, 0.99] {
        let v = share * drive.wheel_speed;
        let a = vehicle.planned_acceleration(v);
        for a in [0.0, a] {
            let limits = vehicle.limits_at(v, a);
            let outer = 1.0 + 0.5 * drive.track * limits.curvature;
            assert!(v * outer <= drive.wheel_speed * (1.0 + 1e-12) && limits.curvature > 0.0, "{v}: {limits:?}");
            let rim = a * outer + 0.5 * drive.track * v * v * limits.curvature_rate;
            assert!(rim <= drive.wheel_acceleration * (1.0 + 1e-12) && limits.curvature_rate > 0.0, "{v}: {rim}");
        }
    }
    assert_eq!(vehicle.limits_at(drive.wheel_speed, 0.0).curvature, 0.0, "straight ahead at most");
    let car = car();
    let fast = car.vehicle().limits_at(2.0 * car.default_speed, 0.0);
    assert!((fast.curvature_rate - 0.5 * car.vehicle().limits.curvature_rate).abs() < 1e-12);
    assert_eq!(car.vehicle().limits_at(0.1, 0.0), car.vehicle().limits);
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
