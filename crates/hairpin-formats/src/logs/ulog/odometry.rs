//! `vehicle_mocap_odometry` and `vehicle_visual_odometry`: poses that were measured from outside, as they came in.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::super::accuracy::{both, half, known};
use super::super::axes::{enu_attitude, enu_point, enu_vector};
use super::super::error::Fault;
use super::super::invalid::Invalid;
use super::super::log::{LoggedMotion, Reset, Sample, Source};
use super::super::samples::Budget;
use super::formats::Slot;
use super::position::contradiction;
use super::topic::{Finder, seconds};

/// No robot is further from where it began, m.
const FARTHEST_M: f64 = 1e7;

/// Axes of a pose or a velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Axes {
    Ned,
    /// Forward, right, down, with a heading of its own.
    Frd,
    Body,
    Unknown,
}

/// What was read of one instance.
#[derive(Debug)]
pub(super) struct Odometry {
    sample: Option<Slot>,
    p: [Slot; 3],
    q: Option<[Slot; 4]>,
    v: Option<[Slot; 3]>,
    variance: Option<[Slot; 3]>,
    pose_frame: Option<Slot>,
    velocity_frame: Option<Slot>,
    counter: Option<Slot>,
    /// Percent, 0 where it is not told, and −1 where the odometry has failed.
    quality: Option<Slot>,
    /// Frames are numbered from 1 since `pose_frame` is there (PX4 1.14), before from 0 (`local_frame`).
    first: f64,
    samples: Vec<Sample>,
    resets: Vec<Reset>,
    count: Option<f64>,
    invalid: Invalid,
    /// Poses in axes that nobody knows.
    unknown: usize,
    /// Axes of the first pose: those of others are turned against them by what nobody tells.
    axes: Option<Axes>,
    /// Poses in other axes than the first.
    elsewhere: usize,
    skipped: usize,
    halves: usize,
    unfit: Option<String>,
}

impl Odometry {
    pub(super) fn of(finder: &Finder) -> Result<Self, String> {
        let new = finder.slot("pose_frame");
        Ok(Self {
            sample: finder.slot("timestamp_sample"),
            p: finder.array("position", ["x", "y", "z"]).ok_or_else(|| format!("`{}` has no position", finder.name))?,
            q: finder.array("q", [""; 4]),
            v: finder.array("velocity", ["vx", "vy", "vz"]),
            variance: finder.array("position_variance", [""; 3]),
            pose_frame: new.or_else(|| finder.slot("local_frame")),
            velocity_frame: finder.slot("velocity_frame"),
            counter: finder.slot("reset_counter"),
            quality: finder.slot("quality"),
            first: if new.is_some() { 1.0 } else { 0.0 },
            samples: Vec::new(),
            resets: Vec::new(),
            count: None,
            invalid: Invalid::default(),
            unknown: 0,
            axes: None,
            elsewhere: 0,
            skipped: 0,
            halves: 0,
            unfit: None,
        })
    }

    fn axes_of(&self, slot: Option<Slot>, data: &[u8]) -> Axes {
        match slot.and_then(|slot| slot.read(data)).map(|number| number - self.first) {
            Some(0.0) => Axes::Ned,
            Some(1.0) => Axes::Frd,
            Some(3.0) if self.first == 0.0 => Axes::Body,
            Some(2.0) if self.first == 1.0 => Axes::Body,
            _ => Axes::Unknown,
        }
    }

    pub(super) fn push(&mut self, stamp: f64, data: &[u8], budget: &mut Budget) -> Result<(), Fault> {
        let read = |slot: Slot| slot.read(data).unwrap_or(f64::NAN);
        let t_s = seconds(stamp, self.sample.map(read));
        let frame = self.axes_of(self.pose_frame, data);
        if matches!(frame, Axes::Unknown | Axes::Body) {
            self.unknown += 1;
            return Ok(());
        }
        if self.axes.is_some_and(|first| first != frame) {
            self.elsewhere += 1;
            return Ok(());
        }
        let ned = self.p.map(read);
        let rises = self.samples.last().is_none_or(|last| last.t_s < t_s);
        let is_number = ned.iter().all(|p| p.is_finite() && p.abs() < FARTHEST_M);
        let failed = self.quality.map(read).is_some_and(|quality| quality < 0.0);
        if !rises || !is_number {
            self.skipped += 1;
            if is_number && !failed && self.unfit.is_none() {
                self.unfit = contradiction(&self.samples, t_s, &enu_point(ned));
            }
            return Ok(());
        }
        budget.take()?;
        self.axes = Some(frame);
        let attitude = self.q.map(|q| q.map(read)).and_then(attitude);
        let v = self.v.map(|v| v.map(read)).filter(|v| v.iter().all(|v| v.is_finite()));
        let v_m_s = v.and_then(|v| match self.axes_of(self.velocity_frame, data) {
            Axes::Body => attitude.map(|turn| turn * body(v)),
            Axes::Unknown => None,
            axes => (axes == frame).then(|| enu_vector(v)),
        });
        // Of x and y the one that is told, where only one is.
        let variance = self.variance.map(|variance| variance.map(read));
        let deviations = variance.map(|[x, y, z]| [x.max(y), z].map(|of| known(of.sqrt())));
        let (accuracy_m, is_half) = both(deviations.unwrap_or_default());
        self.halves += usize::from(is_half);
        let count = self.counter.map(read);
        if self.count.is_some() && self.count != count {
            self.resets.push(Reset { t_s, by_m: None });
        }
        self.count = count;
        self.samples.push(Sample { t_s, p_m: enu_point(ned), attitude, v_m_s, accuracy_m });
        self.invalid.settle(t_s, failed);
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// Whether the heading of its axes is its own.
    pub(super) fn is_frd(&self) -> bool {
        self.axes == Some(Axes::Frd)
    }

    pub(super) fn motion(self, name: &str, source: Source) -> (Option<LoggedMotion>, Vec<String>) {
        let mut notes = Vec::new();
        if self.unknown > 0 {
            notes.push(format!("{name}: {} poses in a frame that is not told are not read", self.unknown));
        }
        if self.elsewhere > 0 {
            notes.push(format!("{name}: {} poses in another frame than the first are not read", self.elsewhere));
        }
        if self.skipped > 0 {
            notes.push(format!("{name}: {} samples without numbers or with stamps that do not rise", self.skipped));
        }
        if self.is_frd() {
            notes.push(format!("{name}: its frame has a heading of its own (FRD); its x is taken for north"));
        }
        let Self { samples, resets, invalid, halves, unfit, .. } = self;
        let invalid = invalid.until(samples.last().map(|last| last.t_s));
        notes.extend(half(name, halves));
        notes.extend(unfit.iter().map(|why| format!("{name}: {why}")));
        let motion = LoggedMotion { resets, invalid, unfit, ..LoggedMotion::of(name, source, samples) };
        ((!motion.samples.is_empty()).then_some(motion), notes)
    }
}

/// A vector of a body of forward, right, down in one of forward, left, up: the inverse of the body's turn in
/// [`enu_attitude`], which is its own.
fn body(frd: [f64; 3]) -> Vector3<f64> {
    enu_attitude(UnitQuaternion::identity()).inverse() * enu_vector(frd)
}

/// `world_from_body` of w, x, y, z between FRD and NED; `None` where they are no turn.
pub(super) fn attitude([w, x, y, z]: [f64; 4]) -> Option<UnitQuaternion<f64>> {
    let q = Quaternion::new(w, x, y, z);
    let length = q.norm();
    // Singles: 1e-3 is a hundred times what they lose.
    (length.is_finite() && (length - 1.0).abs() < 1e-2).then(|| enu_attitude(UnitQuaternion::from_quaternion(q)))
}
