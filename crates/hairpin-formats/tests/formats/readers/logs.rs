//! Logs of vehicles: PX4's, ROS 2's, TUM, tables.

use std::path::Path;

use hairpin_formats::logs;
use mcap::Compression;

use super::write_bag::{Cdr, bag};
use super::write_ulog::{POSITION, Position, Ulog, singles};
use super::{Answer, Sample};

/// What is read of a log but for what is only said of it.
fn read(bytes: &[u8], name: &str) -> Answer {
    let folder = tempfile::tempdir().expect("a folder of our own");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("a file of our own");
    match logs::read(Path::new(&path)) {
        Ok(read) => Answer::Read(format!("{:?}", logs::Logged { notes: Vec::new(), ..read })),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

fn of_tum(text: &str) -> Answer {
    read(text.as_bytes(), "a.tum")
}

fn of_table(text: &str) -> Answer {
    read(text.as_bytes(), "a.csv")
}

/// A ULog of three positions with what is named in it.
fn of_ulog(what: &str) -> Answer {
    let at = |step: u64| Position { t_us: 100_000 * step, ned: [step as f32, 0.0, 0.0], ..Position::STILL };
    let last = match what {
        "reset" => Position { counters: [1, 0, 0], delta: [1.0, 0.0, 0.0, 0.0], ..at(2) },
        "reference" => Position { reference: [47.3977, 8.546, 488.0], ..at(2) },
        "dead reckoning" => Position { dead_reckoning: true, ..at(2) },
        "accuracy" => Position { accuracy: [2.5, 0.5], ..at(2) },
        _ => at(2),
    };
    let mut log = Ulog::new();
    log.message(b'F', POSITION.as_bytes());
    if what == "no motion" {
        return read(&log.0, "a.ulg");
    }
    if what == "other topics" {
        log.message(b'F', b"cpuload:uint64_t timestamp;float load;");
        log.subscribe(0, 5, "cpuload");
    }
    log.subscribe(0, 0, "vehicle_local_position");
    for sample in [at(0), at(1), last] {
        log.data(0, &[&sample.bytes()]);
    }
    if what == "twice" {
        log.subscribe(0, 6, "vehicle_local_position");
        [at(0), at(1), at(2)].iter().for_each(|sample| log.data(6, &[&sample.bytes()]));
    }
    match what {
        "dropout" => log.message(b'O', &120_u16.to_le_bytes()),
        "cut" => log.0.extend([40, 0, b'D', 0]),
        "newer" => log.0[16 + 3 + 8] = 4,
        _ => {}
    }
    read(&log.0, "a.ulg")
}

/// A ULog of two poses in one frame, and those of `more` frames.
fn of_odometry(more: &str) -> Answer {
    let mut log = Ulog::new();
    log.message(b'F', b"vehicle_visual_odometry:uint64_t timestamp;float[3] position;uint8_t pose_frame;");
    log.subscribe(0, 0, "vehicle_visual_odometry");
    let frames = [1, 1].into_iter().chain(more.bytes().map(|digit| digit - b'0'));
    for (step, frame) in (0_u64..).zip(frames) {
        log.data(0, &[&(100_000 * step).to_le_bytes(), &singles([step as f32, 0.0, 0.0]), &[frame]]);
    }
    read(&log.0, "a.ulg")
}

/// A bag of three poses with what is named in it.
fn of_bag(what: &str) -> Answer {
    let pose = |step: u32, frame: &str| {
        let place = [f64::from(step), 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let body = Cdr::new(true).header(100 + step, 0, frame).numbers(&place).bytes();
        ("/pose", "geometry_msgs/msg/PoseStamped", u64::from(step), body)
    };
    let mut messages: Vec<(&str, &str, u64, Vec<u8>)> = (0..3).map(|step| pose(step, "map")).collect();
    match what {
        "another frame" => messages.push(pose(3, "odom")),
        "other types" => messages.push(("/rosout", "rcl_interfaces/msg/Log", 3, vec![0, 1, 0, 0])),
        "joints" => {
            let joints = |step: u32| Cdr::new(true).header(100 + step, 0, "").u32(1).text("a").u32(1).numbers(&[0.5]);
            let body = |step: u32| joints(step).u32(0).u32(0).bytes();
            messages.extend([0, 1].map(|step| ("/joint_states", "sensor_msgs/msg/JointState", 4, body(step))));
        }
        _ => {}
    }
    read(&bag(&messages, (what == "packed").then_some(Compression::Zstd)), "a.mcap")
}

const TUM: &str = "0 1 2 3 0 0 0 1\n0.1 2 2 3 0 0 0 1\n";
const TABLE: &str = "t_s,x_m,y_m,z_m\n0,1,2,3\n0.1,2,2,3\n";

/// What the page's rows are about.
pub(crate) fn samples() -> Vec<Sample> {
    let row = |row, read: fn(&str) -> Answer, without: &str, with: &str| Sample {
        row,
        read,
        without: without.into(),
        with: with.into(),
    };
    vec![
        row("ulog.resets", of_ulog, "", "reset"),
        row("ulog.reference", of_ulog, "", "reference"),
        row("ulog.dead-reckoning", of_ulog, "", "dead reckoning"),
        row("ulog.accuracy", of_ulog, "", "accuracy"),
        row("ulog.dropouts", of_ulog, "", "dropout"),
        row("ulog.other-topics", of_ulog, "", "other topics"),
        row("ulog.cut", of_ulog, "", "cut"),
        row("ulog.newer", of_ulog, "", "newer"),
        row("ulog.no-motion", of_ulog, "", "no motion"),
        row("ulog.twice", of_ulog, "", "twice"),
        row("ulog.frames", of_odometry, "", "2"),
        row("bag.joints", of_bag, "", "joints"),
        row("bag.frames", of_bag, "", "another frame"),
        row("bag.other-types", of_bag, "", "other types"),
        row("bag.packed", of_bag, "", "packed"),
        row("bag.ros1", of_table, TABLE, "#ROSBAG V2.0\n"),
        row("tum.stamps", of_tum, TUM, "0 1 2 3 0 0 0 1\n0 2 2 3 0 0 0 1\n"),
        row("tum.quaternions", of_tum, TUM, "0 1 2 3 0 0 0 1\n0.1 2 2 3 0 0 0 2\n"),
        row("tum.comments", of_tum, TUM, "# t x y z qx qy qz qw\n0 1 2 3 0 0 0 1\n0.1 2 2 3 0 0 0 1\n"),
        row("table.units", of_table, TABLE, "t_s,x,y,z\n0,1,2,3\n0.1,2,2,3\n"),
        row("table.other-columns", of_table, TABLE, "t_s,x_m,y_m,z_m,temp\n0,1,2,3,5\n0.1,2,2,3,5\n"),
        row("table.legs", of_table, TABLE, "t_s,x_m,y_m,z_m,leg\n0,1,2,3,0\n0.1,2,2,3,1\n"),
        row("table.yaw", of_table, TABLE, "t_s,x_m,y_m,z_m,yaw_deg\n0,1,2,3,90\n0.1,2,2,3,90\n"),
        row(
            "table.velocity",
            of_table,
            TABLE,
            "t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s\n0,1,2,3,9,0,0\n0.1,2,2,3,9,0,0\n",
        ),
        row("table.joints", of_table, TABLE, "t_s,x_m,y_m,z_m,q1_rad\n0,1,2,3,0.5\n0.1,2,2,3,0.5\n"),
        row("table.time-back", of_table, TABLE, "t_s,x_m,y_m,z_m\n0,1,2,3\n0,2,2,3\n"),
        row("table.not-finite", of_table, TABLE, "t_s,x_m,y_m,z_m\n0,1,2,3\n0.1,nan,2,3\n"),
    ]
}
