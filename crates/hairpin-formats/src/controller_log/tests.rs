//! Logs in the dialects that controllers and people write, and what is wrong with some.

use std::f64::consts::FRAC_PI_2;
use std::fs;

use hairpin::robot::arm::ArmDescription;
use nalgebra::Point3;

use super::*;

fn read(text: &str) -> Result<ControllerLog, ControllerLogError> {
    parse(Path::new("log.csv"), text, None)
}

fn fails(text: &str) -> String {
    read(text).unwrap_err().to_string()
}

fn arm() -> Arm {
    let path = format!("{}/../../data/robots/arm/irb120.toml", env!("CARGO_MANIFEST_DIR"));
    let description: ArmDescription = toml::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    description.build().unwrap()
}

#[test]
fn dialects_read_alike() {
    let ours = "t,x_m,y_m,z_m,qw,qx,qy,qz,move\n0,0.3,-0.1,0.25,0,0,1,0,0\n0.004,0.301,-0.1,0.25,0,0,1,0,1\n";
    let abb = "time_ms;X_mm;Y_mm;Z_mm;q1;q2;q3;q4;MOVE;note\n0;300,0;-100;250;0;0;1;0;0;a\n4,0;301,0;-1,0e2;250;0;0;1;0;1;b\n";
    let tabs = "t_s\tz_mm\ty_mm\tx_mm\trx_deg\try_deg\trz_deg\tmove\n0\t250\t-100\t300\t0\t180\t0\t0\n0,004\t250\t-100\t301\t0\t180\t0\t1\n";
    let (ours, abb, tabs) = (read(ours).unwrap(), read(abb).unwrap(), read(tabs).unwrap());
    for other in [&abb, &tabs] {
        assert!(other.orientation_known && !other.from_joints);
        assert_eq!(other.track.channel("move"), Some(&[0.0, 1.0][..]));
        for i in 0..2 {
            assert!((other.track.times()[i] - ours.track.times()[i]).abs() < 1e-15);
            assert!((other.track.position(i) - ours.track.position(i)).norm() < 1e-15);
            assert!(other.track.poses()[i].rotation.angle_to(&ours.track.poses()[i].rotation) < 1e-7);
        }
    }
}

#[test]
fn euler_angles_turn_about_fixed_x_then_y_then_z() {
    let log = read("t,x_m,y_m,z_m,rx_deg,ry_deg,rz_rad\n0,0,0,0,90,0,1.5707963267948966\n1,0,0,0,90,0,0\n").unwrap();
    let turned = log.track.poses()[0].rotation * Point3::new(0.0, 1.0, 0.0);
    // About x: y to z; about z: z stays.
    assert!((turned - Point3::new(0.0, 0.0, 1.0)).norm() < 1e-12, "{turned}");
    assert!((log.track.poses()[1].rotation.angle() - FRAC_PI_2).abs() < 1e-12);
}

#[test]
fn what_is_written_reads_back() {
    let log =
        read("t,x_m,y_m,z_m,qw,qx,qy,qz,move\n0,0.3,-0.1,0.25,0.6,0,0.8,0,0\n0.01,0.31,-0.1,0.25,0.6,0,0.8,0,1\n")
            .unwrap();
    let again = read(&crate::csv::text(&log.track)).unwrap();
    assert_eq!(again.track.channel("move"), log.track.channel("move"));
    for i in 0..2 {
        assert!((again.track.position(i) - log.track.position(i)).norm() < 1e-15);
        assert!(again.track.poses()[i].rotation.angle_to(&log.track.poses()[i].rotation) < 1e-7);
    }
}

#[test]
fn joints_go_through_the_arm() {
    let (arm, tcp) = (arm(), Isometry3::translation(0.0, 0.0, 0.12));
    let text = "time_s,joint_1_deg,joint_2_deg,joint_3_deg,joint_4_deg,joint_5_deg,joint_6_deg\n0,10,20,-30,40,50,60\n0.1,11,20,-30,40,50,60\n";
    let log = parse(Path::new("log.csv"), text, Some((&arm, &tcp))).unwrap();
    assert!(log.from_joints && log.orientation_known);
    let q = [10.0f64, 20.0, -30.0, 40.0, 50.0, 60.0].map(f64::to_radians);
    let expected = arm.forward(&q) * tcp;
    assert!((log.track.poses()[0].translation.vector - expected.translation.vector).norm() < 1e-12);
    assert!((log.track.channel("q1_rad").unwrap()[1] - 11f64.to_radians()).abs() < 1e-15);
    assert!(fails(text).contains("joints without positions need an arm"));
}

/// Places and joints of one row that contradict each other leave nobody knowing which of them is true.
#[test]
fn places_are_held_against_the_joints_beside_them() {
    let (arm, tcp) = (arm(), Isometry3::translation(0.0, 0.0, 0.12));
    let written = |aside: f64, still: bool, turned: f64| {
        let mut text = "t,x_mm,y_mm,z_mm,qw,qx,qy,qz,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n".to_owned();
        for i in 0..20 {
            let q = [10.0 + f64::from(i), 20.0, -30.0, 40.0, 50.0, 60.0];
            let at = arm.forward(&q.map(f64::to_radians)) * tcp;
            let (p, r) = (1e3 * at.translation.vector, at.rotation);
            let [_, q2, q3, q4, q5, q6] = q;
            let (q1, q6) = (if still { 10.0 } else { q[0] } + aside, q6 + turned);
            text += &format!("{},{},{},{},{},{},{},{},", f64::from(i) * 0.1, p.x, p.y, p.z, r.w, r.i, r.j, r.k);
            text += &format!("{q1},{q2},{q3},{q4},{q5},{q6}\n");
        }
        parse(Path::new("log.csv"), &text, Some((&arm, &tcp))).map_err(|error| error.to_string())
    };
    assert!(written(0.0, false, 0.0).is_ok());
    // The next row's joints, as of who writes both a moment apart.
    assert!(written(1.0, false, 0.0).is_ok());
    for (aside, still, turned) in [(3.5, false, 0.0), (0.0, true, 0.0), (0.0, false, 10.0)] {
        let told = written(aside, still, turned).unwrap_err();
        assert!(told.contains("from where the joints of the same line put it"), "{told}");
    }
    assert!(written(0.0, true, 0.0).unwrap_err().starts_with("log.csv, line 21: "));
}

#[test]
fn columns_of_joints_are_told_and_so_are_those_beyond_the_six() {
    let text = "t,q7_rad,Q2_rad,q1_deg,q3_rad,q4_rad,q5_rad,q6_rad,joint_9_deg,qw_rad\n0,0,0,0,0,0,0,0,0,0\n1,0,0,0,0,0,0,0,0,0\n";
    let joints = parse(Path::new("log.csv"), text, Some((&arm(), &Isometry3::identity()))).unwrap().joints.unwrap();
    assert_eq!(joints.axes, ["q1_deg", "q2_rad", "q3_rad", "q4_rad", "q5_rad", "q6_rad"]);
    assert_eq!(joints.order, ["q2_rad", "q1_deg", "q3_rad", "q4_rad", "q5_rad", "q6_rad"]);
    assert_eq!(joints.others, ["q7_rad", "joint_9_deg"]);
    assert_eq!(read("t,x_mm,y_mm,z_mm\n0,1,2,3\n0.01,1,2,4\n").unwrap().joints, None);
}

#[test]
fn positions_alone_leave_orientation_unknown() {
    let log = read("t,x_mm,y_mm,z_mm\n0,1,2,3\n0.01,1,2,4\n").unwrap();
    assert!(!log.orientation_known);
}

#[test]
fn mistakes_are_told_with_line_and_column() {
    let start = "t_s,x_mm,y_mm,z_mm\n0,1,2,3\n";
    for (text, told) in [
        (
            format!("{start}0.01,1,oops,3\n"),
            "log.csv, line 3, column `y_mm`: `oops`: must be a finite number, within 100 m",
        ),
        (format!("{start}\n0.01,1,2\n"), "log.csv, line 4: 3 values, the header has 4"),
        (format!("{start}0,1,2,3\n"), "log.csv, line 3, column `t_s`: `0`: must be later than 0 s, the row before"),
        (format!("{start}0.01,1,2,NaN\n"), "line 3, column `z_mm`: `NaN`"),
        (format!("{start}0.01,1,2,3e8\n"), "line 3, column `z_mm`: `3e8`"),
        (start.into(), "log.csv: 1 samples, must be at least 2"),
        (String::new(), "line 1: no column of times"),
        ("t,x,y,z\n0,1,2,3\n".into(), "no `x_m`, `y_m`, `z_m` (or `_mm`)"),
        ("t,x_m,y_m\n".into(), "only `x_m`, `y_m` of three coordinates"),
        ("t,t_ms,time_s,x_m,y_m,z_m\n".into(), "`t_ms` and `time_s` say the same"),
        ("t,x_m,x_m,y_m,z_m\n".into(), "column `x_m` twice"),
        ("t,q1_deg,q2_deg\n".into(), "2 joints: six or none"),
        (
            "t,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,0.5,0,0,0\n".into(),
            "line 2, column `qw`: `0.5`: must be of a quaternion of length 1, not 0.5000",
        ),
        ("t,x_m,y_m,z_m,move\n0,0,0,0,-1\n".into(), "line 2, column `move`: `-1`"),
    ] {
        let found = fails(&text);
        assert!(found.contains(told), "{found}");
    }
    let missing = super::read(Path::new("no such file"), None).unwrap_err().to_string();
    assert!(missing.starts_with("cannot read no such file: "), "{missing}");
}
