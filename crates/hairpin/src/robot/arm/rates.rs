//! Proven bounds of joint angles along a straight tool move, between samples: what makes collision and limit checks
//! sound.
//!
//! From a sample the pose moves on for `half` in the move's parameter either way. The wrist centre then stays within
//! V·half of where it was, so the margins of all three singularities have lower bounds, and with them the rates of all
//! joints have upper ones. The derivation is in docs/arms.md.

use nalgebra::{Isometry3, Matrix6};

use super::opw::Opw;
use super::singularity::{Margin, Singularity};
use super::{AXES, Arm, Joints, Kinematics};
use crate::math::power::square;

/// How fast the tool's point moves (m) and turns (rad) per unit of the move's parameter, at most, and where it sits on
/// the flange.
///
/// In m and rad per unit of the parameter s in [0, 1]: of a straight move its length and its turn.
#[derive(Debug, Clone, Copy)]
pub struct Sweep {
    /// Speed of the tool's point.
    pub speed: f64,
    /// Angular speed.
    pub turn: f64,
    /// `flange_from_tcp`.
    pub tcp: Isometry3<f64>,
}

/// What holds on a whole piece of a move.
///
/// On [s − half, s + half] of the move: q_k stays within `rates[k]` · half of the sample, and no singularity comes
/// nearer than `margin`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PieceBounds {
    /// Upper bounds of |dq_k/ds|, rad.
    pub rates: Joints,
    /// Lower bound of the least margin of any singularity.
    pub margin: Margin,
}

impl Arm {
    /// Bounds that hold within `half` (in the move's parameter) of a sample with joint angles `q`; `None` where a
    /// singularity cannot be excluded: halve the piece.
    ///
    /// O(1), one sample; sound up to rounding, since it bounds the exact inverse's derivative and not a sampled one.
    /// Narrower pieces get tighter bounds, so that halving ends.
    pub fn bounds_around(&self, q: &Joints, sweep: &Sweep, half: f64) -> Option<PieceBounds> {
        match &self.kinematics {
            Kinematics::Opw(opw) => of_opw(opw, q, sweep, half),
            Kinematics::Chain => self.of_chain(q, sweep, half),
        }
    }

    /// ‖J(q)⁻¹‖ grows by no more than ‖J⁻¹‖·L·‖Δq‖ at first order, L = √72 with lengths over the reach (docs/arms.md).
    ///
    /// With ‖J⁻¹‖ at most doubled on the piece, rates are at most twice those at the sample, and the margin no less
    /// than half of it: which the piece must be short enough for.
    fn of_chain(&self, q: &Joints, sweep: &Sweep, half: f64) -> Option<PieceBounds> {
        const GROWTH: f64 = 8.49;
        let inverse = 1.0 / self.chain_margin(q);
        let at_flange = sweep.speed + sweep.turn * sweep.tcp.translation.vector.norm();
        let twist = libm::hypot(at_flange / self.chain.reach(), sweep.turn);
        let rate = 2.0 * inverse * twist;
        (inverse.is_finite() && GROWTH * inverse * rate * half <= 0.5).then(|| PieceBounds {
            rates: [rate; AXES],
            margin: Margin { of: Singularity::Chain, value: 0.5 / inverse },
        })
    }

    /// 1/‖J⁻¹‖_F with lengths as shares of the reach: a lower bound of the smallest singular value; 0 where singular.
    pub(super) fn chain_margin(&self, q: &Joints) -> f64 {
        let frames = self.chain.frames(q);
        let flange = frames[AXES] * self.chain.flange;
        let mut jacobian: Matrix6<f64> = self.chain.jacobian(&frames, &flange.translation.vector.into());
        jacobian.fixed_view_mut::<3, 6>(0, 0).scale_mut(1.0 / self.chain.reach());
        jacobian.try_inverse().map_or(0.0, |inverse| 1.0 / inverse.norm())
    }
}

/// ```text
/// V = speed + turn |flange→tcp + c4 e_z|                       of the wrist's centre, m per unit of the parameter
/// |θ₁′| ≤ V/forward,   planar ≤ V √(1 + b²/forward²)           with the least `forward` of the piece
/// |θ₂′| ≤ planar/(c2 |sin e|),   |θ₃′| ≤ p_far planar/(c2 k |sin e|)
/// |θ₄′|, |θ₆′| ≤ relative/|sin θ₅|,   |θ₅′| ≤ relative = turn + hypot(θ₁′, planar/(k |sin e|))
/// ```
///
/// Sines are the least on the piece: the elbow's at the nearest and the farthest distance of the wrist from the
/// shoulder, the wrist's at θ₅ ± relative · half. `None` where one of the three may become 0.
fn of_opw(opw: &Opw, q: &Joints, sweep: &Sweep, half: f64) -> Option<PieceBounds> {
    let at = opw.wrist_centre(q);
    let k = opw.forearm();
    let arm = sweep.tcp.translation.vector + nalgebra::Vector3::new(0.0, 0.0, opw.c4);
    let speed = sweep.speed + sweep.turn * arm.norm();
    // Axis 1: ρ² = forward² + b², |θ1′| ≤ V / |forward|.
    let nearest = libm::hypot(at.forward, opw.b) - speed * half;
    let square_forward = square(nearest) - square(opw.b);
    if !(nearest > 0.0 && square_forward > 0.0) {
        return None;
    }
    let forward = square_forward.sqrt();
    let rate1 = speed / forward;
    // The two links: |p′| ≤ V √(1 + b²/forward²).
    let planar = speed * (1.0 + square(opw.b / forward)).sqrt();
    let distance = libm::hypot(at.from_shoulder[0], at.from_shoulder[1]);
    let cosine = |p: f64| (square(p) - square(opw.c2) - square(k)) / (2.0 * opw.c2 * k);
    let (near, far) = ((distance - planar * half).max(0.0), distance + planar * half);
    let (low, high) = (cosine(near), cosine(far));
    if !(low > -1.0 && high < 1.0) {
        return None;
    }
    let elbow = (1.0 - square(low)).min(1.0 - square(high)).max(0.0).sqrt();
    let rate2 = planar / (opw.c2 * elbow);
    let rate3 = far * planar / (opw.c2 * k * elbow);
    // The wrist turns against the forearm at most as fast as both together.
    let relative = sweep.turn + libm::hypot(rate1, planar / (k * elbow));
    let bend = libm::atan2(libm::sin(at.bend).abs(), libm::cos(at.bend));
    let (least, most) = (bend - relative * half, bend + relative * half);
    if !(least > 0.0 && most < std::f64::consts::PI) {
        return None;
    }
    let wrist = libm::sin(least).min(libm::sin(most));
    let margin = Margin::least([
        Margin { of: Singularity::Wrist, value: wrist },
        Margin { of: Singularity::Elbow, value: elbow },
        Margin { of: Singularity::Shoulder, value: forward / (opw.c2 + k) },
    ]);
    let rates = [rate1, rate2, rate3, relative / wrist, relative, relative / wrist];
    (margin.value > 0.0 && rates.iter().all(|rate| rate.is_finite())).then_some(PieceBounds { rates, margin })
}
