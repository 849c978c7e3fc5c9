//! Replay of a ground vehicle's drive on flat ground: what was written, integrated again, against what was asked.

use super::peak::{largest, peak};
use super::quadrature::Heading;

/// One piece of a drive as it was written.
///
/// Again apart from `trajectory`'s segments, so that reading a drive and proving it share no code.
///
/// κ is that of the path of the body's origin, left positive, whatever the gear; s counts driven metres from 0 in each
/// piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DrivePiece {
    /// κ(s) = Σ aᵢ sⁱ for s from 0 to `length_m`; ψ̇ = direction · v · κ.
    Arc {
        /// Metres, ≥ 0.
        length_m: f64,
        /// a₀ … a₅, 1/m^(i+1).
        curvature: [f64; 6],
        /// +1 forward, −1 in reverse.
        direction: f64,
    },
    /// In place: the wheels may stand anyhow before, and straight after it.
    Turn {
        /// Radians, left positive.
        angle_rad: f64,
    },
}

/// What a drive was asked to do, in the frame of the start: x forward, y left.
///
/// The replay begins at (0, 0, 0).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveClaim {
    /// κ at the start, 1/m.
    pub start_curvature: f64,
    /// Direction of travel in the body where the drive begins, rad: 0 along x, left positive.
    pub crab: f64,
    /// Its change along the drive, rad/m.
    pub crab_rate: f64,
    /// x (m), y (m), yaw (rad) to end in.
    pub end: [f64; 3],
    /// κ to end with, 1/m.
    pub end_curvature: f64,
}

/// What the drive does.
///
/// Errors are signed; NaN in, NaN out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveReplay {
    /// Where it ends less where it should, in the start's frame: x, y (m), yaw (rad, in (−π, π]).
    pub error: [f64; 3],
    /// Curvature at the end less what it should be, 1/m.
    pub error_curvature: f64,
    /// Curvature at the start less what it should be, 1/m.
    pub start_error_curvature: f64,
    /// Largest |κ|, 1/m.
    pub max_curvature: f64,
    /// Largest |dκ/ds|, 1/m².
    pub max_curvature_rate: f64,
    /// Largest jump of κ between pieces of one direction, 1/m.
    pub max_jump: f64,
    /// Metres driven.
    pub length: f64,
    /// Changes of direction.
    pub reversals: usize,
    /// Panels of the quadrature.
    pub steps: usize,
    /// What they leave out of the end's place at most, m, rounding aside.
    pub left_out: f64,
}

/// Parts of a bent piece that is drawn.
const TRACED: usize = 60;
/// What the panels of a whole drive may leave out of its end's place, m.
const LEFT_OUT: f64 = 1e-12;

/// Integrates x' = direction·cos(ψ + δ), y' = direction·sin(ψ + δ), ψ' = direction·κ(s), δ = crab + crab_rate · metres,
/// over every piece: headings in closed form, for they are polynomials, and places by Gauss-Legendre panels that leave
/// out 10⁻¹² m of a drive at most. Peaks of curvature and of its rate are those of the polynomials. Numbers that are
/// none give errors that are none, and so does a piece that a hundred thousand panels do not do for.
///
/// Turns in place add to ψ and leave the wheels straight: a jump of κ counts only between pieces of one direction
/// without a turn between them. No pieces are a drive that stays.
///
/// ```
/// use hairpin::verification::{DriveClaim, DrivePiece, replay_drive};
///
/// // A quarter of a circle of 2 m to the left ends at (2, 2), heading left.
/// let quarter = std::f64::consts::FRAC_PI_2;
/// let piece = DrivePiece::Arc { length_m: 2.0 * quarter, curvature: [0.5, 0.0, 0.0, 0.0, 0.0, 0.0], direction: 1.0 };
/// let claim =
///     DriveClaim { start_curvature: 0.5, crab: 0.0, crab_rate: 0.0, end: [2.0, 2.0, quarter], end_curvature: 0.5 };
/// let replay = replay_drive(&[piece], &claim);
/// assert!(replay.error.iter().all(|e| e.abs() < 1e-12) && replay.steps == 1);
/// ```
pub fn replay_drive(pieces: &[DrivePiece], claim: &DriveClaim) -> DriveReplay {
    // The sum of nothing is −0.
    let total = pieces.iter().map(DrivePiece::length).sum::<f64>() + 0.0;
    let mut state = [0.0; 3];
    let mut replay = DriveReplay {
        error: [0.0; 3],
        error_curvature: 0.0,
        start_error_curvature: 0.0,
        max_curvature: 0.0,
        max_curvature_rate: 0.0,
        max_jump: 0.0,
        length: total,
        reversals: 0,
        steps: 0,
        left_out: LEFT_OUT,
    };
    // Curvature and direction at the end of the piece before; a turn in place leaves the wheels straight and no
    // direction.
    let mut before: (f64, Option<f64>) = (claim.start_curvature, None);
    let mut last_direction = None;
    let mut driven = 0.0;
    for (i, piece) in pieces.iter().enumerate() {
        let DrivePiece::Arc { length_m, curvature, direction } = *piece else {
            let DrivePiece::Turn { angle_rad } = *piece else { continue };
            state[2] += angle_rad;
            before = (0.0, None);
            continue;
        };
        let bend = |s: f64| curvature.iter().rev().fold(0.0, |sum, a| sum * s + a);
        if i == 0 {
            replay.start_error_curvature = bend(0.0) - claim.start_curvature;
        } else if before.1 == Some(direction) {
            replay.max_jump = largest(replay.max_jump, (bend(0.0) - before.0).abs());
        }
        if last_direction.is_some_and(|last| last != direction) {
            replay.reversals += 1;
        }
        last_direction = Some(direction);
        let way = Way::new(&curvature, direction, claim.crab_after(driven));
        replay.steps += way.follow(&mut state, 0.0, length_m, LEFT_OUT / total);
        driven += length_m;
        let slope = std::array::from_fn(|i| curvature.get(i + 1).map_or(0.0, |a| (i + 1) as f64 * a));
        replay.max_curvature = largest(replay.max_curvature, peak(&curvature, length_m));
        replay.max_curvature_rate = largest(replay.max_curvature_rate, peak(&slope, length_m));
        before = (bend(length_m), Some(direction));
    }
    let yaw = state[2] - claim.end[2];
    replay.error = [state[0] - claim.end[0], state[1] - claim.end[1], libm::atan2(libm::sin(yaw), libm::cos(yaw))];
    replay.error_curvature = before.0 - claim.end_curvature;
    replay
}

/// Poses along a drive, x, y (m), yaw (rad) in the start's frame, for drawing: for each piece that moves its direction
/// and its poses, both ends included.
///
/// Straight pieces have two poses, others 61; turns in place have none and show as a jump of ψ.
pub fn trace_drive(pieces: &[DrivePiece], claim: &DriveClaim) -> Vec<(f64, Vec<[f64; 3]>)> {
    let mut state = [0.0; 3];
    let mut traced = Vec::new();
    let mut driven = 0.0;
    for piece in pieces {
        match *piece {
            DrivePiece::Turn { angle_rad } => state[2] += angle_rad,
            DrivePiece::Arc { length_m, curvature, direction } => {
                let straight = curvature == [0.0; 6] && claim.crab_rate == 0.0;
                let parts = if straight { 1 } else { TRACED };
                let mut poses = vec![state];
                let way = Way::new(&curvature, direction, claim.crab_after(driven));
                let yaw = state[2];
                for part in 0..parts {
                    let [from, to] = [part, part + 1].map(|part| length_m * part as f64 / parts as f64);
                    state[2] = yaw;
                    way.follow(&mut state, from, to, LEFT_OUT / length_m);
                    poses.push(state);
                }
                driven += length_m;
                traced.push((direction, poses));
            }
        }
    }
    traced
}

/// What a piece does to a pose.
struct Way {
    /// The gear's sign.
    direction: f64,
    /// What ψ changes by from the piece's start.
    turned: Heading,
    /// δ₀ (rad) and δ₁ (rad/m).
    crab: [f64; 2],
}

impl Way {
    /// ∫ ±κ ds of κ(s) = Σ aᵢ sⁱ.
    fn new(curvature: &[f64; 6], direction: f64, crab: [f64; 2]) -> Self {
        let mut turned = [0.0; 7];
        for (i, a) in curvature.iter().enumerate() {
            turned[i + 1] = direction * a / (i + 1) as f64;
        }
        Self { direction, turned: Heading(turned), crab }
    }

    /// Moves the place in `state`, whose ψ is that of the piece's start, on from `from` to `to` metres, ψ to that at
    /// `to`; the panels that it takes to be off by `allowed` m/m at most.
    fn follow(&self, state: &mut [f64; 3], from: f64, to: f64, allowed: f64) -> usize {
        let mut heading = self.turned;
        heading.0[0] = state[2] + self.crab[0];
        heading.0[1] += self.crab[1];
        let travelled = heading.travelled(from, to, allowed);
        state[0] += self.direction * travelled.place[0];
        state[1] += self.direction * travelled.place[1];
        state[2] += self.turned.at(to);
        travelled.panels
    }
}

impl DriveClaim {
    /// Direction of travel in the body after `driven` metres, and its change with every one.
    fn crab_after(&self, driven: f64) -> [f64; 2] {
        [self.crab + self.crab_rate * driven, self.crab_rate]
    }
}

impl DrivePiece {
    /// Metres; 0 of a turn in place.
    pub(super) fn length(&self) -> f64 {
        match self {
            Self::Arc { length_m, .. } => *length_m,
            Self::Turn { .. } => 0.0,
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    const CLAIM: DriveClaim =
        DriveClaim { start_curvature: 0.0, crab: 0.0, crab_rate: 0.0, end: [0.0; 3], end_curvature: 0.0 };

    fn arc(length_m: f64, curvature: [f64; 6], direction: f64) -> DrivePiece {
        DrivePiece::Arc { length_m, curvature, direction }
    }

    fn near(replay: &DriveReplay, end: [f64; 3]) {
        for (found, expected) in replay.error.iter().zip(end) {
            assert!((found - expected).abs() < 1e-9, "{replay:?}, not {end:?}");
        }
    }

    #[test]
    fn lines_circles_and_turns_end_where_geometry_says() {
        let half = |direction| replay_drive(&[arc(PI / 2.0, [2.0, 0.0, 0.0, 0.0, 0.0, 0.0], direction)], &CLAIM);
        near(&half(1.0), [0.0, 1.0, PI]);
        near(&half(-1.0), [0.0, 1.0, -PI]);
        let line = replay_drive(&[arc(3.0, [0.0; 6], -1.0)], &CLAIM);
        near(&line, [-3.0, 0.0, 0.0]);
        assert!(line.steps == 1 && line.length == 3.0);
        let there = [DrivePiece::Turn { angle_rad: -PI / 2.0 }, arc(2.0, [0.0; 6], 1.0)];
        near(&replay_drive(&there, &CLAIM), [0.0, -2.0, -PI / 2.0]);
        let crab = DriveClaim { crab: PI / 2.0, ..CLAIM };
        near(&replay_drive(&[arc(1.0, [0.0; 6], 1.0)], &crab), [0.0, 1.0, 0.0]);
        // Turned evenly by half a circle to the body, the direction itself is what bends the way: a circle of radius 1.
        let swing = DriveClaim { crab_rate: 1.0, ..CLAIM };
        let pieces = [arc(PI / 4.0, [0.0; 6], 1.0), arc(3.0 * PI / 4.0, [0.0; 6], 1.0)];
        near(&replay_drive(&pieces, &swing), [0.0, 2.0, 0.0]);
        // A whole turn is no error of the heading.
        let round = replay_drive(&[arc(2.0 * PI, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], 1.0)], &CLAIM);
        near(&round, [0.0; 3]);
    }

    #[test]
    fn a_clothoid_ends_at_the_fresnel_integrals() {
        // κ = πs: x = C(1), y = S(1) of Abramowitz and Stegun, table 7.7, ψ = π/2.
        let clothoid = replay_drive(&[arc(1.0, [0.0, PI, 0.0, 0.0, 0.0, 0.0], 1.0)], &CLAIM);
        assert!((clothoid.error[0] - 0.779_893_4).abs() < 1e-7 && (clothoid.error[1] - 0.438_259_1).abs() < 1e-7);
        assert!((clothoid.error[2] - PI / 2.0).abs() < 1e-9);
        assert!((clothoid.max_curvature - PI).abs() < 1e-12 && (clothoid.max_curvature_rate - PI).abs() < 1e-12);
        assert!((clothoid.error_curvature - PI).abs() < 1e-12);
    }

    #[test]
    fn peaks_between_samples_and_jumps_are_found() {
        // 4 s (L − s)/L² has its largest value, 1, at L/2, with L no multiple of the step.
        let length = 0.777;
        let curvature = [0.0, 4.0 / length, -4.0 / (length * length), 0.0, 0.0, 0.0];
        let hill = replay_drive(&[arc(length, curvature, 1.0)], &CLAIM);
        assert!((hill.max_curvature - 1.0).abs() < 1e-12, "{hill:?}");
        assert!((hill.max_curvature_rate - 4.0 / length).abs() < 1e-12);
        let (left, right) = ([1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [-0.5, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let jump = replay_drive(&[arc(1.0, left, 1.0), arc(1.0, right, 1.0)], &CLAIM);
        assert_eq!(
            (jump.max_jump, jump.start_error_curvature, jump.error_curvature, jump.reversals),
            (1.5, 1.0, -0.5, 0)
        );
        // Where the vehicle stands its wheels may swing: at cusps and at turns in place, not at zero lengths.
        let cusp = replay_drive(&[arc(1.0, left, 1.0), arc(1.0, right, -1.0)], &CLAIM);
        assert_eq!((cusp.max_jump, cusp.reversals), (0.0, 1));
        let turn = [arc(1.0, left, 1.0), DrivePiece::Turn { angle_rad: 1.0 }, arc(1.0, right, 1.0)];
        assert_eq!(replay_drive(&turn, &CLAIM).max_jump, 0.0);
        assert_eq!(replay_drive(&turn[..2], &CLAIM).error_curvature, 0.0);
        assert_eq!(replay_drive(&[arc(0.0, left, 1.0), arc(1.0, right, 1.0)], &CLAIM).max_jump, 1.5);
    }

    #[test]
    fn traces_end_where_replays_do() {
        let bent = [0.3, -0.2, 0.05, 0.0, 0.0, 0.0];
        let drive =
            [arc(2.0, bent, 1.0), DrivePiece::Turn { angle_rad: 0.4 }, arc(1.0, [0.0; 6], -1.0), arc(1.5, bent, -1.0)];
        let claim = DriveClaim { crab: 0.2, crab_rate: -0.3, ..CLAIM };
        let traced = trace_drive(&drive, &claim);
        let end = traced[2].1.last().unwrap();
        near(&replay_drive(&drive, &claim), *end);
        assert_eq!(traced.iter().map(|(direction, _)| *direction).collect::<Vec<_>>(), [1.0, -1.0, -1.0]);
        assert!((traced[1].1[0][2] - traced[0].1.last().unwrap()[2] - 0.4).abs() < 1e-15);
    }

    #[test]
    fn numbers_that_are_none_are_never_a_success() {
        let broken = replay_drive(&[arc(1.0, [f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0], 1.0)], &CLAIM);
        assert!(broken.error[0].is_nan() && broken.max_curvature.is_nan() && broken.error_curvature.is_nan());
        assert!(replay_drive(&[arc(f64::NAN, [0.0; 6], 1.0)], &CLAIM).error[0].is_nan());
        assert_eq!(replay_drive(&[], &CLAIM).error, [0.0; 3]);
    }
}
