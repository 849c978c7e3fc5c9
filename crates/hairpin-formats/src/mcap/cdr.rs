//! Messages of ROS 2 as Common Data Representation, little endian (OMG DDSI-RTPS 2.3, 10.5).

use nalgebra::Isometry3;

/// A message that grows; numbers stand at multiples of their size behind the head.
#[derive(Debug)]
pub(super) struct Cdr(Vec<u8>);

const HEAD: [u8; 4] = [0, 1, 0, 0];

impl Cdr {
    pub(super) fn new() -> Self {
        Self(HEAD.to_vec())
    }

    fn put<const N: usize>(&mut self, bytes: [u8; N]) {
        let length = (self.0.len() - HEAD.len()).next_multiple_of(N);
        self.0.resize(HEAD.len() + length, 0);
        self.0.extend(bytes);
    }

    pub(super) fn u32(&mut self, value: u32) {
        self.put(value.to_le_bytes());
    }

    pub(super) fn f64(&mut self, value: f64) {
        self.put(value.to_le_bytes());
    }

    pub(super) fn string(&mut self, text: &str) {
        self.u32(text.len() as u32 + 1);
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    pub(super) fn doubles(&mut self, values: &[f64]) {
        self.u32(values.len() as u32);
        values.iter().for_each(|value| self.f64(*value));
    }

    /// Seconds and nanoseconds of a stamp or a duration.
    pub(super) fn time(&mut self, time_ns: u64) {
        self.u32((time_ns / 1_000_000_000) as u32);
        self.u32((time_ns % 1_000_000_000) as u32);
    }

    pub(super) fn header(&mut self, time_ns: u64, frame: &str) {
        self.time(time_ns);
        self.string(frame);
    }

    /// Position, and attitude with w last.
    pub(super) fn pose(&mut self, pose: &Isometry3<f64>) {
        let (p, q) = (pose.translation.vector, pose.rotation);
        [p.x, p.y, p.z, q.i, q.j, q.k, q.w].into_iter().for_each(|value| self.f64(value));
    }

    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.0
    }
}
