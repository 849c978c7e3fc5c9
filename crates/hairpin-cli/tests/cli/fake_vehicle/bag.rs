//! What a robot with ROS 2 records: odometry of a rover, joints of an arm.

use super::Row;
use super::write_bag::{Cdr, bag};

/// The recorder's clock is behind the headers' by so much, ns.
const DELAY_NS: u64 = 4_000_000;
/// The first row's stamp: any day, s.
const EPOCH_S: f64 = 1_700_000_000.0;

fn stamp(t: f64) -> (u32, u32, u64) {
    let nanoseconds = ((EPOCH_S + t) * 1e3).round() as u64 * 1_000_000;
    let (s, ns) = (nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000);
    (s as u32, ns as u32, nanoseconds + DELAY_NS)
}

/// `nav_msgs/msg/Odometry` of `rows` in `frame`, with a standard deviation of 1 mm.
pub(crate) fn odometry(rows: &[Row], frame: &str) -> Vec<u8> {
    let mut covariance = [0.0; 36];
    [covariance[0], covariance[7], covariance[14]] = [1e-6; 3];
    let message = |row: &Row| {
        let (s, ns, received) = stamp(row.t);
        // Of ROS, x y z w; the twist is the body's.
        let (q, v) = (row.q, row.q.inverse() * row.v);
        let cdr = Cdr::new(true).header(s, ns, frame).text("base_link").numbers(row.p.coords.as_slice());
        let cdr = cdr.numbers(&[q.i, q.j, q.k, q.w]).numbers(&covariance);
        let data = cdr.numbers(&[v.x, v.y, v.z, 0.0, 0.0, 0.0]).numbers(&covariance).bytes();
        ("/odom", "nav_msgs/msg/Odometry", received, data)
    };
    bag(&rows.iter().map(message).collect::<Vec<_>>(), None)
}

/// `sensor_msgs/msg/JointState` of the joints of `rows` (rad), called `names`, in the order that `order` gives: its
/// first joint is the arm's joint `order[0]`, from 0.
pub(crate) fn joint_states(rows: &[Row], names: [&str; 6], order: [usize; 6]) -> Vec<u8> {
    let message = |row: &Row| {
        let (s, ns, received) = stamp(row.t);
        let cdr = order.iter().fold(Cdr::new(true).header(s, ns, "").u32(6), |cdr, joint| cdr.text(names[*joint]));
        let data = cdr.u32(6).numbers(&order.map(|joint| row.joints[joint])).u32(0).u32(0).bytes();
        ("/joint_states", "sensor_msgs/msg/JointState", received, data)
    };
    bag(&rows.iter().map(message).collect::<Vec<_>>(), None)
}
