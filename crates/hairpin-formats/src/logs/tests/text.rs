//! TUM and CSV.

use hairpin::trajectory::{ATTITUDE_UNKNOWN, Channel, Track};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::{csv, tum};

fn track() -> Track {
    let pose = |i: f64| {
        let turn = UnitQuaternion::from_euler_angles(0.3, -0.45, 2.1 + i);
        Isometry3::from_parts(Translation3::new(3.0 + i, -7.0, 11.0 - 0.1 * i), turn)
    };
    let channel = |name: &str, values: [f64; 3]| Channel { name: name.into(), values: values.to_vec() };
    let channels = vec![
        channel("leg", [0.0, 0.0, 1.0]),
        channel("vx_m_s", [1.0, 2.0, 3.0]),
        channel("vy_m_s", [0.0, -1.0, 0.5]),
        channel("vz_m_s", [0.25, 0.0, -2.0]),
    ];
    Track::new(vec![0.0, 0.01, 0.03], (0..3).map(|i| pose(f64::from(i))).collect(), channels).unwrap()
}

fn assert_poses(logged: &Logged, track: &Track) {
    let [motion] = &logged.motions[..] else { panic!("{logged:?}") };
    assert_eq!(motion.samples.len(), track.times().len());
    for ((sample, pose), time) in motion.samples.iter().zip(track.poses()).zip(track.times()) {
        assert_eq!((sample.t_s, sample.p_m), (*time, Point3::from(pose.translation.vector)));
        assert!(sample.attitude.unwrap().angle_to(&pose.rotation) < 1e-7);
    }
}

#[test]
fn what_hairpin_writes_is_read_as_it_was() {
    let track = track();
    let tum = read_bytes(tum::text(&track).as_bytes(), "a.tum").unwrap();
    assert_eq!((tum.format, tum.clock, &tum.frame), ("TUM", Clock::File, &LogFrame::Untold));
    assert_poses(&tum, &track);
    assert_poses(&read_bytes(tum::text(&track).as_bytes(), "a.txt").unwrap(), &track);
    let csv = read_bytes(csv::text(&track).as_bytes(), "0000-0.csv").unwrap();
    assert_eq!((csv.format, &csv.notes[..]), ("CSV", &[][..]));
    assert_poses(&csv, &track);
    assert_eq!(csv.motions[0].samples[1].v_m_s, Some(Vector3::new(2.0, -1.0, 0.0)));
    let progress = |t_s, item| Progress { t_s, item, of: None, target_m: None };
    assert_eq!(csv.progress, [progress(0.0, 1), progress(0.03, 2)]);
}

#[test]
fn level_attitudes_that_nobody_knows_are_none() {
    let level = Channel { name: ATTITUDE_UNKNOWN.into(), values: vec![1.0] };
    let track = Track::new(vec![0.0], vec![Isometry3::identity()], vec![level]).unwrap();
    assert_eq!(read_bytes(csv::text(&track).as_bytes(), "a.csv").unwrap().motions[0].samples[0].attitude, None);
}

#[test]
fn headers_of_others_are_read_by_their_units() {
    let euroc = "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], \
                 v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1]\n\
                 1403636580000000000,4.5,-1.5,0.75,0.6,0,0.8,0,0.5,1,-2,0.001\n\
                 1403636580005000000,4.5,-1.5,0.75,0.6,0,0.8,0,0.5,1,-2,0.001\n";
    let read = read_bytes(euroc.as_bytes(), "data.csv").unwrap();
    let sample = read.motions[0].samples[1];
    assert!((sample.t_s - read.motions[0].samples[0].t_s - 0.005).abs() < 1e-6);
    assert_eq!((sample.p_m, sample.v_m_s), (Point3::new(4.5, -1.5, 0.75), Some(Vector3::new(0.5, 1.0, -2.0))));
    assert_eq!(sample.attitude.unwrap().coords, nalgebra::Vector4::new(0.0, 0.8, 0.0, 0.6));
    assert_eq!(read.notes, ["columns that are not read: b_w_RS_S_x [rad s^-1]"]);

    let rover = "timestamp_ms;pos_x (mm);pos_y (mm);yaw_deg;mode\n1000;2500;-500;90;auto\n1500;2600;-400;90;auto\n";
    let read = read_bytes(rover.as_bytes(), "rover.log").unwrap();
    let sample = read.motions[0].samples[1];
    assert_eq!((sample.t_s, sample.p_m), (1.5, Point3::new(2.6, -0.4, 0.0)));
    assert!((sample.attitude.unwrap() * Vector3::x() - Vector3::y()).norm() < 1e-12);
    assert_eq!(read.notes.len(), 3, "{:?}", read.notes);
    assert_eq!(read.motions[0].no_heights.as_deref(), Some("no column of z; columns that are not read: mode"));

    let tabs = read_bytes(rover.replace(';', "\t").as_bytes(), "rover.log").unwrap();
    assert_eq!(tabs.motions[0].samples, read.motions[0].samples);

    let arm = "t_s,q2_deg,q1_rad\n0,180,0.5\n0.1,90,0.25\n";
    let read = read_bytes(arm.as_bytes(), "arm.csv").unwrap();
    let [joints] = &read.joints[..] else { panic!("{read:?}") };
    assert_eq!(joints.joints, ["joint_1", "joint_2"]);
    assert_eq!(joints.positions_rad[1], [0.25, std::f64::consts::FRAC_PI_2]);
    assert!(read.motions.is_empty());
}

#[test]
fn an_accuracy_that_is_told_of_one_counts_for_both() {
    let read = read_bytes(b"t_s,x_m,y_m,z_m,eph_m\n0,1,2,3,5\n1,1,2,3,4\n", "a.csv").unwrap();
    assert_eq!(read.motions[0].samples[1].accuracy_m, Some([4.0; 2]));
    assert_eq!(read.notes, ["no column of epv: `eph_m` counts for both"]);
    let told = refusal(b"t_s,x_m,y_m,z_m,eph_m\n0,1,2,3,-5\n", "a.csv");
    assert_eq!(told, ", line 2: column `eph_m` is `-5`, must be a finite number, 0 or more");
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let row = "t,x_m,y_m,z_m\n0,1,2,3\n";
    for (text, name, told) in [
        ("# a\n1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "a.tum", ", line 3: stamp 1 s after 1 s: stamps must rise"),
        (
            "0 0 0 0 0 0 0 1\n1e-160 0 0 0 0 0 0 1\n",
            "a.tum",
            ", line 2: stamp 1e-160 s is 1e-160 s after the one before: must be at least 5e-10 s",
        ),
        ("1 0 0 0 0 0 0\n", "a.tum", ", line 1: 7 numbers, must be the eight of `t x y z qx qy qz qw`"),
        ("1 0 nan 0 0 0 0 1\n", "a.tum", ", line 1: y is `nan`, must be a finite number"),
        ("1 0 0 0 0 0 0 0.5\n", "a.tum", ", line 1: a quaternion of length 0.5000, must be 1"),
        ("", "a.tum", ": a TUM log without any motion"),
        (&format!("{row}\n-1,1,2,3\n"), "a.csv", ", line 4: stamp -1 s after 0 s: stamps must rise"),
        (&format!("{row}1,1,2\n"), "a.csv", ", line 3: 3 values, the header has 4"),
        (
            &format!("{row}1,1,x,3\n"),
            "a.csv",
            ", line 3: column `y_m` is `x`, must be a finite number within 10 000 km",
        ),
        (
            "t,x,y,z\n",
            "a.csv",
            ", line 1: column `x`: its unit is not in its name, must be one of `x_m`, `x_cm`, `x_mm`",
        ),
        (
            "t,x_m,y_m,z_ft\n",
            "a.csv",
            ", line 1: column `z_ft`: `ft` is no unit that is read, must be one of `z_m`, `z_cm`, `z_mm`",
        ),
        (
            "t,x [ft],y [ft],z [m]\n",
            "a.csv",
            ", line 1: column `x [ft]`: `ft` is no unit that is read, must be one of `x_m`, `x_cm`, `x_mm`",
        ),
        (
            "t,x [],y [],z []\n",
            "a.csv",
            ", line 1: column `x []`: its unit is not in its name, must be one of `x_m`, `x_cm`, `x_mm`",
        ),
        (
            "t,x_ft,y_ft,z_m\n",
            "a.csv",
            ", line 1: column `x_ft`: `ft` is no unit that is read, must be one of `x_m`, `x_cm`, `x_mm`",
        ),
        (
            "timestamp,x_m,y_m\n",
            "a.csv",
            ", line 1: column `timestamp`: its unit is not in its name, must be one of \
          `timestamp_s`, `timestamp_sec`, `timestamp_ms`, `timestamp_us`, `timestamp_ns`",
        ),
        ("t,x_m,y_m,x_mm\n", "a.csv", ", line 1: columns `x_m` and `x_mm` are the same thing twice"),
        ("t,y_m\n", "a.csv", ", line 1: no column of each of x, y (and z): `x_m`, `y_m`, `z_m`"),
        ("t,q1_rad,q1_deg\n", "a.csv", ", line 1: column `q1_deg`: joint 1 twice"),
    ] {
        assert_eq!(refusal(text.as_bytes(), name), told, "{text:?}");
    }
    assert_eq!(refusal(b"t,x_m,y_m\n0,1,2\n1,\xff,2\n", "a.csv"), ", line 3: no UTF-8 text");
    assert!(refusal(b"\x89PNG\0", "a.png").contains("no format that is known"));
    assert!(read(Path::new("/nowhere/a.tum")).unwrap_err().to_string().starts_with("cannot read /nowhere/a.tum: "));
}
