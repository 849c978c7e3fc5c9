//! What an arm may have done between two samples of a log, by the accelerations and speeds of its joints.
//!
//! A joint with |q̈| ≤ α and |q̇| ≤ ω whose angles are known a time h apart stays within min(α h²/8, ω h/2) of the line
//! between them, and the tool's point within Σ of that times its distance from each axis of where the joints' lines put
//! it. Logs of poses are taken to joints first, along one branch; where that cannot be done the tool's own acceleration
//! is bounded, which is far more: |ẍ| ≤ Σ αₖ Lₖ + (Σ ωₖ)(Σ ωₖ Lₖ).

use nalgebra::{Isometry3, Point3};

use super::ArmSetup;
use crate::campaign::scenario::PathFrom;
use crate::judgement::moves::{Between, Hidden, MeasureSettings, Measured, Unseen, unseen};
use crate::math::segment::point_distance;
use crate::robot::arm::{AXES, Arm, Joints};
use crate::trajectory::{ATTITUDE_UNKNOWN, PlannedPath, Track};

/// Key of an arm's file whose absence makes accelerations estimates.
const ACCELERATIONS: &str = "joints.acceleration_deg_s2";

impl ArmSetup {
    /// What the log of a run does not show.
    ///
    /// `None` where the oracle cannot tell, as for a recording of one sample. `measured` is by the same `settings`:
    /// where an offset was taken off, arrivals are those of the plan's clock.
    pub(super) fn unseen(
        &self,
        programmed: &PlannedPath,
        recording: &Track,
        reference: Option<&Track>,
        measured: &Measured,
        settings: &MeasureSettings,
    ) -> Option<Unseen> {
        let (arm, spec) = (&self.station.arm, &self.scenario.spec);
        let between = Log::of(arm, &self.station.tool.tcp, &self.station.home, recording);
        let corner = match (spec.path.map(|limit| limit.from), reference) {
            (Some(PathFrom::Sharp), Some(reference)) => farthest(programmed.track(), reference),
            _ => 0.0,
        };
        let hidden = Hidden {
            path: spec.path.map(|limit| limit.max_mm * 1e-3),
            late: spec.arrival.map(|limit| limit.max_late_ms * 1e-3),
            corner,
            between: &between,
            estimated: arm.estimated.iter().map(String::as_str).find(|key| *key == ACCELERATIONS),
        };
        let mut unseen = unseen(programmed, recording, settings, &hidden, measured).ok()?;
        // What is open for the samples that are there is graver than what may be between them.
        unseen.open = self.other_posture(programmed, &measured.legs, recording).or(unseen.open);
        Some(unseen)
    }
}

/// How far the path is from another one at most, m.
///
/// max over the path's samples of the distance to the other's line; O(n m). 0 where either has no segment.
fn farthest(path: &Track, other: &Track) -> f64 {
    let nearest = |i: usize| {
        let point = path.position(i);
        let chord = |j: usize| (point_distance(&point, &other.position(j), &other.position(j + 1)), j);
        // Curves are looked at about the nearest chord alone.
        let (_, about) = (0..other.len().saturating_sub(1)).map(chord).min_by(|a, b| a.0.total_cmp(&b.0))?;
        let beside = about.saturating_sub(1)..(about + 2).min(other.len() - 1);
        Some(beside.map(|j| (point - other.nearest(j, &point)).norm()).fold(f64::INFINITY, f64::min))
    };
    (0..path.len()).filter_map(nearest).filter(|distance| distance.is_finite()).fold(0.0, f64::max)
}

/// A log with what is known of the arm.
struct Log<'a> {
    arm: &'a Arm,
    tcp: &'a Isometry3<f64>,
    recording: &'a Track,
    /// Angles at every sample, where they are known.
    joints: Option<Vec<Joints>>,
    /// Farthest that the tool's point can be from each axis, m.
    longest: Joints,
}

impl<'a> Log<'a> {
    /// Takes the angles from the channels `q1_rad` … `q6_rad` where the log has all six, else from its poses by
    /// inverse kinematics, unless its attitude is marked as unknown. L_k is the sum of all offsets between joint k + 1
    /// and the tool's point, m:
    ///
    /// ```text
    /// L_6 = |flange| + |tcp|,   L_k = L_(k+1) + |origin of joint k+1|       (triangle inequality: whatever the angles)
    /// ```
    fn of(arm: &'a Arm, tcp: &'a Isometry3<f64>, home: &Joints, recording: &'a Track) -> Self {
        let joints = recorded(recording).or_else(|| {
            let known = recording.channel(ATTITUDE_UNKNOWN).is_none();
            known.then(|| along_a_branch(arm, tcp, home, recording)).flatten()
        });
        let mut longest = [0.0; AXES];
        let mut beyond = arm.chain.flange.translation.vector.norm() + tcp.translation.vector.norm();
        for k in (0..AXES).rev() {
            longest[k] = beyond;
            beyond += arm.chain.joints[k].origin.translation.vector.norm();
        }
        Self { arm, tcp, recording, joints, longest }
    }

    /// h of interval i, between samples i and i + 1, s.
    fn seconds(&self, i: usize) -> f64 {
        self.recording.times()[i + 1] - self.recording.times()[i]
    }

    /// What each joint may have turned aside, rad.
    ///
    /// min(α h²/8, ω h/2), one per joint.
    fn aside(&self, seconds: f64) -> Joints {
        let limits = &self.arm.limits;
        std::array::from_fn(|k| (limits[k].acceleration * seconds * seconds / 8.0).min(limits[k].speed * seconds / 2.0))
    }

    /// The tool's point at these angles, and its distance from each axis.
    fn stands(&self, q: &Joints) -> (Point3<f64>, Joints) {
        let frames = self.arm.chain.frames(q);
        let point = Point3::from((frames[AXES] * self.arm.chain.flange * self.tcp).translation.vector);
        let axes = self.arm.chain.axes(&frames);
        (point, std::array::from_fn(|k| axes[k].1.cross(&(point - axes[k].0)).norm()))
    }
}

/// The angles that the log itself tells.
///
/// One row of six angles (rad) a sample; `None` where a channel is missing. They are the log's own and are not held
/// against its poses.
pub(super) fn recorded(recording: &Track) -> Option<Vec<Joints>> {
    let channels: Vec<&[f64]> =
        (1..=AXES).map(|k| recording.channel(&format!("q{k}_rad"))).collect::<Option<Vec<_>>>()?;
    Some((0..recording.len()).map(|i| std::array::from_fn(|k| channels[k][i])).collect())
}

/// The angles that put the tool where the log has it, each nearest to those before.
///
/// `None` where one pose has no inverse within the bounds. The first is the nearest to home, by Σ|Δq|.
fn along_a_branch(arm: &Arm, tcp: &Isometry3<f64>, home: &Joints, recording: &Track) -> Option<Vec<Joints>> {
    let distance = |a: &Joints, b: &Joints| (0..AXES).map(|k| (a[k] - b[k]).abs()).sum::<f64>();
    let (flange_from_tcp, mut before, mut all) = (tcp.inverse(), *home, Vec::with_capacity(recording.len()));
    for pose in recording.poses() {
        let solutions = arm.inverse(&(pose * flange_from_tcp), &before);
        before = solutions.into_iter().min_by(|a, b| distance(a, &before).total_cmp(&distance(b, &before)))?;
        all.push(before);
    }
    Some(all)
}

impl Between for Log<'_> {
    /// Farthest (m) that the tool's point can be from where the joints' lines put it, within interval i. From the last
    /// axis to the first:
    ///
    /// ```text
    /// a_k = min(α_k h²/8, ω_k h/2)                              aside, rad
    /// d_k = min(max(d_k(i), d_k(i+1)) + b_k, L_k)               distance from axis k, at most
    /// b_k = Σ_{j>k} (|Δq_j|/2 + a_j) L_j                        what joints beyond axis k add to it
    /// hidden = Σ_k a_k d_k
    /// ```
    ///
    /// Without angles it is bounded as a point of its own: min(|ẍ| h²/8, |ẋ| h/2), with |ẋ| = Σ ωₖ Lₖ and |ẍ| as in
    /// the head of this file. An upper bound either way, as far as the limits are the arm's.
    fn hidden(&self, i: usize) -> f64 {
        let seconds = self.seconds(i);
        let aside = self.aside(seconds);
        let Some(joints) = &self.joints else {
            let limits = &self.arm.limits;
            let sum = |of: &dyn Fn(usize) -> f64| (0..AXES).map(of).sum::<f64>();
            let speed = sum(&|k| limits[k].speed * self.longest[k]);
            let acceleration = sum(&|k| limits[k].acceleration * self.longest[k]) + sum(&|k| limits[k].speed) * speed;
            return (acceleration * seconds * seconds / 8.0).min(speed * seconds / 2.0);
        };
        let [(_, before), (_, after)] = [i, i + 1].map(|k| self.stands(&joints[k]));
        // Joints beyond an axis carry the point away from it, by half their way and by what they turn aside.
        let (mut beyond, mut most) = (0.0, 0.0);
        for k in (0..AXES).rev() {
            let distance = (before[k].max(after[k]) + beyond).min(self.longest[k]);
            most += aside[k] * distance;
            beyond += (0.5 * (joints[i + 1][k] - joints[i][k]).abs() + aside[k]) * self.longest[k];
        }
        most
    }

    /// Half of how far the tool's point comes within interval i at most (m) where joints turn evenly: ½ Σ |Δq_k| L_k;
    /// of a log of poses half of the chord.
    fn half(&self, i: usize) -> f64 {
        match &self.joints {
            Some(joints) => {
                0.5 * (0..AXES).map(|k| (joints[i + 1][k] - joints[i][k]).abs() * self.longest[k]).sum::<f64>()
            }
            None => 0.5 * (self.recording.position(i + 1) - self.recording.position(i)).norm(),
        }
    }

    /// `count` + 1 places (m, base frame) of the tool's point along interval i, evenly in time, both samples included:
    /// by forward kinematics of joints that turn evenly, or along the straight line between two poses. `count` is at
    /// least 1.
    fn chord(&self, i: usize, count: usize) -> Vec<Point3<f64>> {
        let point = |n: usize| {
            let share = n as f64 / count as f64;
            match &self.joints {
                Some(joints) => {
                    let (a, b) = (&joints[i], &joints[i + 1]);
                    self.stands(&std::array::from_fn(|k| a[k] + share * (b[k] - a[k]))).0
                }
                None => {
                    let (a, b) = (self.recording.position(i), self.recording.position(i + 1));
                    a + (b - a) * share
                }
            }
        };
        (0..=count).map(point).collect()
    }
}
