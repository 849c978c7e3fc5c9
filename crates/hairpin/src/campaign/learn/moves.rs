//! What a search sees of an arm's move, and moves that were executed.

use nalgebra::Isometry3;

use super::Feature;
use crate::math::rotation::rotation_vector;
use crate::robot::arm::{AXES, Arm, Joints};

/// What programs that ask for all that the arm can count as, m/s: the largest speed that has a name.
const FASTEST: f64 = 7.0;

/// Number of features of a move.
const FEATURES: usize = 7;

/// A straight move, or one in joints, between two points, as it is known before it is executed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoveFeatures {
    /// Way of the tool's point if it is straight, m.
    pub length: f64,
    /// Its rise, m.
    pub climb: f64,
    /// Angle between the orientations at both ends, rad.
    ///
    /// 0 to π.
    pub turn: f64,
    /// Programmed speed of the tool's point, m/s.
    ///
    /// At most 7: [`Self::speed_of`].
    pub speed: f64,
    /// Largest turn of a joint, rad.
    ///
    /// maxₖ |Δqₖ|.
    pub largest: f64,
    /// All turns of joints together, rad.
    ///
    /// Σₖ |Δqₖ|.
    pub turns: f64,
    /// The longest that a joint takes at its largest speed, s.
    ///
    /// maxₖ |Δqₖ| / q̇ₖ,ₘₐₓ: a lower bound of any move between the two.
    pub duration: f64,
}

impl MoveFeatures {
    /// The speed that a programmed one counts as, m/s; as fast as the arm can is infinite.
    pub fn speed_of(programmed: f64) -> f64 {
        programmed.min(FASTEST)
    }

    /// Between two poses `base_from_tcp` that `arm` meets with the angles `from` and `to` (rad), at `speed` m/s.
    pub fn of(arm: &Arm, poses: [&Isometry3<f64>; 2], from: &Joints, to: &Joints, speed: f64) -> Self {
        let [start, end] = poses;
        let shift = end.translation.vector - start.translation.vector;
        let turns: [f64; AXES] = std::array::from_fn(|k| (to[k] - from[k]).abs());
        let times = turns.iter().zip(&arm.limits).map(|(turn, limit)| turn / limit.speed);
        Self {
            length: shift.norm(),
            climb: shift.z,
            turn: rotation_vector(&(start.rotation.inverse() * end.rotation)).norm(),
            speed: Self::speed_of(speed),
            largest: turns.iter().copied().fold(0.0, f64::max),
            turns: turns.iter().sum(),
            duration: times.fold(0.0, f64::max),
        }
    }

    /// Names and units, in the order of [`Self::inputs`].
    pub(super) fn named() -> Vec<Feature> {
        let named: [(&str, &str); FEATURES] = [
            ("length", "m"),
            ("climb", "m"),
            ("turn", "rad"),
            ("speed", "m/s"),
            ("largest_joint_turn", "rad"),
            ("joint_turns", "rad"),
            ("joint_duration", "s"),
        ];
        named.into_iter().map(|(name, unit)| Feature { name: name.into(), unit: unit.into() }).collect()
    }

    pub(super) fn inputs(&self) -> [f64; FEATURES] {
        [self.length, self.climb, self.turn, self.speed, self.largest, self.turns, self.duration]
    }
}

/// A move that was executed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoveSample {
    /// Number of its program: moves of one program are never on both sides of a fold.
    pub program: usize,
    /// What a search sees of it.
    pub features: MoveFeatures,
    /// Its stress.
    pub stress: f64,
}
