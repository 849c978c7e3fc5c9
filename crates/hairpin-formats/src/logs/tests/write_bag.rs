//! ROS 2 bags, message by message.

use std::io::Cursor;

use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions};

/// A message of either byte order, aligned behind its head.
pub(crate) struct Cdr {
    bytes: Vec<u8>,
    little: bool,
}

impl Cdr {
    pub(crate) fn new(little: bool) -> Self {
        Self { bytes: vec![0, u8::from(little), 0, 0], little }
    }

    fn put<const N: usize>(mut self, mut bytes: [u8; N]) -> Self {
        while !(self.bytes.len() - 4).is_multiple_of(N) {
            self.bytes.push(0xee);
        }
        if !self.little {
            bytes.reverse();
        }
        self.bytes.extend(bytes);
        self
    }

    pub(crate) fn u32(self, value: u32) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(crate) fn numbers(self, values: &[f64]) -> Self {
        values.iter().fold(self, |cdr, value| cdr.put(value.to_le_bytes()))
    }

    pub(crate) fn text(self, text: &str) -> Self {
        let mut cdr = self.u32(text.len() as u32 + 1);
        cdr.bytes.extend(text.as_bytes());
        cdr.bytes.push(0);
        cdr
    }

    pub(crate) fn header(self, seconds: u32, nanoseconds: u32, frame: &str) -> Self {
        self.u32(seconds).u32(nanoseconds).text(frame)
    }

    pub(crate) fn bytes(self) -> Vec<u8> {
        self.bytes
    }
}

/// A bag of messages: topic, type, when it was recorded (ns), what is in it.
pub(crate) fn bag(messages: &[(&str, &str, u64, Vec<u8>)], packed: Option<Compression>) -> Vec<u8> {
    let options = WriteOptions::new().profile("ros2").compression(packed).chunk_size(Some(2_000));
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    for (sequence, (topic, kind, time, data)) in (0..).zip(messages) {
        let schema = writer.add_schema(kind, "ros2msg", b"").unwrap();
        let channel_id = writer.add_channel(schema, topic, "cdr", &Default::default()).unwrap();
        let header = MessageHeader { channel_id, sequence, log_time: *time, publish_time: *time };
        writer.write_to_known_channel(&header, data).unwrap();
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

/// Odometry and joints of a rover with an arm, twenty samples 0.1 s apart.
pub(crate) fn drive(little: bool, packed: Option<Compression>) -> Vec<u8> {
    let mut messages = Vec::new();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    for step in 0..20_u32 {
        let (at, received) = (f64::from(step), 5_000_000_000 + u64::from(step) * 100_000_000);
        let mut covariance = [0.0; 36];
        [covariance[0], covariance[7], covariance[14]] = [0.01, 0.04, 0.25];
        let odometry = Cdr::new(little)
            .header(100 + step / 10, step % 10 * 100_000_000, "odom")
            .text("base_link")
            .numbers(&[at, 2.0, 0.5]);
        let odometry =
            odometry.numbers(&[0.0, 0.0, half, half]).numbers(&covariance).numbers(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.1]);
        messages.push(("/odom", "nav_msgs/msg/Odometry", received, odometry.numbers(&covariance).bytes()));
        let names = if step % 2 == 0 { ["q_b", "q_a"] } else { ["q_a", "q_b"] };
        let values = if step % 2 == 0 { [2.0 * at, at] } else { [at, 2.0 * at] };
        let joints =
            Cdr::new(little).header(100 + step / 10, step % 10 * 100_000_000, "").u32(2).text(names[0]).text(names[1]);
        let joints = joints.u32(2).numbers(&values).u32(0).u32(0);
        messages.push(("/joint_states", "sensor_msgs/msg/JointState", received + 1_000, joints.bytes()));
    }
    messages.push(("/rosout", "rcl_interfaces/msg/Log", 8_000_000_000, vec![0, 1, 0, 0]));
    bag(&messages, packed)
}
