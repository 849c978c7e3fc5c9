//! A path from one stop to the next as numbers: nodes with joint angles, and a cubic between each two.
//!
//! Nodes are inverse kinematics, what is between them Hermite cubics with slopes by differences: on a straight line the
//! tool is off by less than a micrometre (test).

use nalgebra::Isometry3;

use crate::robot::arm::{AXES, Joints};

/// What holds between two nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    /// The move that it belongs to.
    pub(super) order: usize,
    /// Largest rate ṡ that the programmed speeds allow.
    pub(super) limit: f64,
    /// Metres of the tool's way per unit of s, at most.
    pub(super) way: f64,
    /// Radians of the tool's turn per unit of s, at most.
    pub(super) turn: f64,
}

/// The path between two stops over its parameter s, m: joint angles and tool poses at nodes.
///
/// `s`, `joints`, `slopes` and `poses` are of one length n, `spans` of n − 1. Without a span it is a place to stand in.
#[derive(Debug, Clone, Default)]
pub(super) struct Section {
    /// Parameter, from 0.
    pub(super) s: Vec<f64>,
    /// Joint angles, rad.
    pub(super) joints: Vec<Joints>,
    /// dq/ds.
    pub(super) slopes: Vec<Joints>,
    /// `base_from_tcp`.
    pub(super) poses: Vec<Isometry3<f64>>,
    /// One less than nodes.
    pub(super) spans: Vec<Span>,
    /// First node of every smooth piece, and the last node.
    pub(super) joins: Vec<usize>,
    /// Moves, and the node at which each passes its target.
    pub(super) marks: Vec<(usize, usize)>,
}

/// Slope and curvature of the joint angles over s.
pub(super) struct Jet {
    /// dq/ds, rad/m.
    pub(super) slope: Joints,
    /// d²q/ds², rad/m².
    pub(super) bend: Joints,
}

impl Section {
    /// Nothing but where it begins.
    pub(super) fn from(joints: Joints, pose: Isometry3<f64>) -> Self {
        Self { s: vec![0.0], joints: vec![joints], poses: vec![pose], joins: vec![0], ..Self::default() }
    }

    /// Number of the last node.
    pub(super) fn last(&self) -> usize {
        self.s.len() - 1
    }

    /// Length in s.
    pub(super) fn length(&self) -> f64 {
        self.s[self.last()]
    }

    /// A node `step` farther in s, and the span that leads to it.
    ///
    /// The span holds for the whole way from the last node; slopes are missing until [`Section::shape`].
    pub(super) fn push(&mut self, step: f64, joints: Joints, pose: Isometry3<f64>, span: Span) {
        self.s.push(self.length() + step);
        self.joints.push(joints);
        self.poses.push(pose);
        self.spans.push(span);
    }

    /// The nodes from the last join on are one smooth piece.
    pub(super) fn join(&mut self) {
        if self.joins.last() != Some(&self.last()) {
            self.joins.push(self.last());
        }
    }

    /// Slopes at the nodes by differences of third and fourth order within each piece, the mean of both sides where
    /// pieces join.
    ///
    /// Nodes of a piece are evenly spaced. A piece has 2 spans at least, or its chord for a slope.
    pub(super) fn shape(&mut self) {
        let mut slopes = vec![[0.0; AXES]; self.s.len()];
        let pieces = self.joins.len() - 1;
        for (number, piece) in self.joins.windows(2).enumerate() {
            let (first, last) = (piece[0], piece[1]);
            let h = (self.s[last] - self.s[first]) / (last - first) as f64;
            for (i, slope) in slopes.iter_mut().enumerate().take(last + 1).skip(first) {
                let weight = if (i == first && number > 0) || (i == last && number + 1 < pieces) { 0.5 } else { 1.0 };
                for (k, slope) in slope.iter_mut().enumerate() {
                    let chord = |i: usize| (self.joints[i + 1][k] - self.joints[i][k]) / h;
                    *slope += weight * slope_at(i - first, last - first, |i| chord(first + i));
                }
            }
        }
        self.slopes = slopes;
    }

    /// The span that `s` lies in, searched from `from` on.
    ///
    /// O(spans between the two); the first or the last for an `s` outside.
    pub(super) fn span(&self, s: f64, from: usize) -> usize {
        let last = self.spans.len() - 1;
        let mut i = from.min(last);
        while i > 0 && s < self.s[i] {
            i -= 1;
        }
        while i < last && s > self.s[i + 1] {
            i += 1;
        }
        i
    }

    /// Where in span `i` the parameter is: 0 at its first node, 1 at its last.
    pub(super) fn share(&self, i: usize, s: f64) -> f64 {
        (s - self.s[i]) / (self.s[i + 1] - self.s[i])
    }

    /// The cubic of span `i` at `s`.
    ///
    /// q(u) = q₀ + p (q₁ − q₀) + u(1 − u)² h m₀ + u²(u − 1) h m₁, p = u²(3 − 2u); C¹ across nodes.
    pub(super) fn joints_at(&self, i: usize, s: f64) -> Joints {
        let h = self.s[i + 1] - self.s[i];
        let u = ((s - self.s[i]) / h).clamp(0.0, 1.0);
        let (a, b) = (u * (1.0 - u) * (1.0 - u) * h, u * u * (u - 1.0) * h);
        let (p, q) = (u * u * (3.0 - 2.0 * u), &self.joints);
        std::array::from_fn(|k| {
            q[i][k] + p * (q[i + 1][k] - q[i][k]) + a * self.slopes[i][k] + b * self.slopes[i + 1][k]
        })
    }

    /// The cubic of span `i` at the share `u` of it, with its derivatives.
    ///
    /// ```text
    /// q′ = 6u(1 − u) chord + (1 − u)(1 − 3u) m₀ + u(3u − 2) m₁
    /// q″ = [6(1 − 2u) chord + (6u − 4) m₀ + (6u − 2) m₁]/h
    /// ```
    ///
    /// q′ is continuous across nodes, q″ jumps there: limits are asked from both sides.
    pub(super) fn jet(&self, i: usize, u: f64) -> Jet {
        let h = self.s[i + 1] - self.s[i];
        let chord: Joints = std::array::from_fn(|k| (self.joints[i + 1][k] - self.joints[i][k]) / h);
        let (m0, m1) = (&self.slopes[i], &self.slopes[i + 1]);
        let along = |[c, a, b]: [f64; 3]| -> Joints { std::array::from_fn(|k| c * chord[k] + a * m0[k] + b * m1[k]) };
        Jet {
            slope: along([6.0 * u * (1.0 - u), (1.0 - u) * (1.0 - 3.0 * u), u * (3.0 * u - 2.0)]),
            bend: along([6.0 * (1.0 - 2.0 * u), 6.0 * u - 4.0, 6.0 * u - 2.0]).map(|bend| bend / h),
        }
    }
}

/// The slope at node `i` of `spans` equal spans, from their chords: exact for cubics inside and at the ends.
///
/// Weights by how far the node is from a piece's end, chords being (q_(i+1) − q_i)/h: (7, 7, −1, −1)/12 inside
/// (fourth order), (11, −7, 2)/6 at the end and (2, 5, −1)/6 beside it (third order), (3, −1)/2 and the mean of
/// pieces of two spans (second).
fn slope_at(i: usize, spans: usize, chord: impl Fn(usize) -> f64) -> f64 {
    let from_end = |i: usize, chord: &dyn Fn(usize) -> f64| match i {
        0 => (11.0 * chord(0) - 7.0 * chord(1) + 2.0 * chord(2)) / 6.0,
        _ => (2.0 * chord(0) + 5.0 * chord(1) - chord(2)) / 6.0,
    };
    match (i, spans) {
        (_, 1) => chord(0),
        (0, 2) => 1.5 * chord(0) - 0.5 * chord(1),
        (1, 2) => 0.5 * (chord(0) + chord(1)),
        (_, 2) => 1.5 * chord(1) - 0.5 * chord(0),
        _ if i < 2 && spans - i > 1 => from_end(i, &chord),
        _ if spans - i < 2 => from_end(spans - i, &|j| chord(spans - 1 - j)),
        _ => (7.0 * (chord(i - 1) + chord(i)) - chord(i - 2) - chord(i + 1)) / 12.0,
    }
}
