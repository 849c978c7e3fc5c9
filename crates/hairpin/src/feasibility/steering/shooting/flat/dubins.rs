//! Dubins' curves: what paths would be if curvature could jump. Their length bounds that of every path from below,
//! and their turns say which ways around there are.
//!
//! L. E. Dubins, On curves of minimal length with a constraint on average curvature, Amer. J. Math. 79 (1957).
//!
//! LSL, RSR, LSR, RSL, LRL, RLR. A path with |κ| ≤ κ_max is never shorter than the shortest word of radius 1/κ_max, so
//! that what a word's length refuses needs no solver.
//!
//! In units of the radius, angle and length of an arc are one number. Curvatures at the ends are ignored, as is what
//! steering takes: start values add that.

use std::f64::consts::{PI, TAU};

/// One of Dubins' words, such as left–straight–left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Word {
    /// Signs of the curvature on the three pieces: +1 left, 0 straight, −1 right.
    pub(super) signs: [f64; 3],
    /// Lengths of the pieces in units of the radius.
    pub(super) pieces: [f64; 3],
}

impl Word {
    /// Length in units of the radius.
    pub(super) fn length(&self) -> f64 {
        self.pieces.iter().sum()
    }

    /// Change of heading, rad.
    pub(super) fn turn(&self) -> f64 {
        self.signs.iter().zip(&self.pieces).map(|(sign, piece)| sign * piece).sum()
    }

    /// Mean of the heading along it, rad.
    ///
    /// (1/L) ∫ θ ds with θ = 0 at the start, not wrapped: what a start value of an arc is fitted to.
    pub(super) fn mean_heading(&self) -> f64 {
        let (mut heading, mut sum) = (0.0, 0.0);
        for (sign, piece) in self.signs.iter().zip(&self.pieces) {
            sum += piece * (heading + 0.5 * sign * piece);
            heading += sign * piece;
        }
        sum / self.length().max(1e-12)
    }
}

/// The words that lead from the origin to (x, y, yaw), lengths in units of the radius, shortest first; those that do
/// not are infinitely long.
///
/// `yaw` in rad, any number of turns. Angles within 10⁻⁹ below a full turn count as none.
pub(super) fn words(x: f64, y: f64, yaw: f64) -> [Word; 6] {
    // Centres of the circles to the left and right of the goal as seen from those of the start.
    let (sin, cos) = (libm::sin(yaw), libm::cos(yaw));
    let mut words = [
        same_side(1.0, x - sin, y + cos - 1.0, yaw),
        same_side(-1.0, x + sin, y - cos + 1.0, yaw),
        cross(1.0, x + sin, y - cos - 1.0, yaw),
        cross(-1.0, x - sin, y + cos + 1.0, yaw),
        three_turns(1.0, x - sin, y + cos - 1.0, yaw),
        three_turns(-1.0, x + sin, y - cos + 1.0, yaw),
    ];
    words.sort_unstable_by(|a, b| a.length().total_cmp(&b.length()));
    words
}

/// Turn, straight, turn to the same `side`; (dx, dy) from centre to centre.
///
/// Always exists: with (d, α) the polar form of the centres' difference, pieces side · α, d, side · (ψ − α), modulo 2π.
fn same_side(side: f64, dx: f64, dy: f64, yaw: f64) -> Word {
    let along = libm::atan2(dy, dx);
    Word {
        signs: [side, 0.0, side],
        pieces: [positive(side * along), libm::hypot(dx, dy), positive(side * (yaw - along))],
    }
}

/// Turn, straight, turn to the other side.
///
/// The straight touches both circles from inside: length √(d² − 4), which exists for d ≥ 2.
fn cross(side: f64, dx: f64, dy: f64, yaw: f64) -> Word {
    let squared = dx * dx + dy * dy - 4.0;
    let signs = [side, 0.0, -side];
    if squared < 0.0 {
        return Word { signs, pieces: [f64::INFINITY; 3] };
    }
    let straight = squared.sqrt();
    let along = libm::atan2(dy, dx) + side * libm::atan2(2.0, straight);
    Word { signs, pieces: [positive(side * along), straight, positive(side * (along - yaw))] }
}

/// Turn, more than half a turn to the other side, turn.
///
/// For d ≤ 4. The middle turn is π + 2 acos(d/4), the longer of the two that fit; the shorter is never part of a
/// shortest path.
fn three_turns(side: f64, dx: f64, dy: f64, yaw: f64) -> Word {
    let signs = [side, -side, side];
    let quarter = libm::hypot(dx, dy) / 4.0;
    if quarter > 1.0 {
        return Word { signs, pieces: [f64::INFINITY; 3] };
    }
    let along = libm::atan2(dy, dx);
    let opening = libm::acos(quarter);
    let first = positive(side * along + PI / 2.0 + opening);
    let middle = PI + 2.0 * opening;
    Word { signs, pieces: [first, middle, positive(side * yaw - first + middle)] }
}

/// The angle in [0, 2π); what rounding leaves just below 2π is none.
fn positive(angle: f64) -> f64 {
    let rest = angle - (angle / TAU).floor() * TAU;
    if rest > TAU - 1e-9 { 0.0 } else { rest }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    fn walk(word: &Word) -> (f64, f64, f64) {
        let (mut x, mut y, mut heading) = (0.0, 0.0, 0.0);
        for (&sign, &piece) in word.signs.iter().zip(&word.pieces) {
            let end: f64 = heading + sign * piece;
            if sign == 0.0 {
                x += piece * f64::cos(heading);
                y += piece * f64::sin(heading);
            } else {
                x += sign * (f64::sin(end) - f64::sin(heading));
                y -= sign * (f64::cos(end) - f64::cos(heading));
            }
            heading = end;
        }
        (x, y, heading)
    }

    #[test]
    fn every_finite_word_ends_at_the_goal() {
        let mut finite = [0; 2];
        for i in 0..2000_u64 {
            let [x, y, yaw] = [0, 1, 2].map(|k| crate::math::random::hashed_unit(41, &[i, k]) * 2.0 - 1.0);
            let (x, y, yaw) = (4.0 * x, 4.0 * y, PI * yaw);
            for word in words(x, y, yaw) {
                if !word.length().is_finite() {
                    continue;
                }
                finite[usize::from(word.signs[1] != 0.0)] += 1;
                let (ex, ey, heading) = walk(&word);
                let miss = (ex - x).abs() + (ey - y).abs() + (libm::remainder(heading - yaw, TAU)).abs();
                assert!(miss < 1e-7, "seed 41, query {i}, {word:?}: off by {miss:e}");
            }
        }
        assert!(finite.iter().all(|&n| n > 1000), "{finite:?}");
    }

    #[test]
    fn known_lengths() {
        assert!((words(3.0, 0.0, 0.0)[0].length() - 3.0).abs() < 1e-12);
        assert!((words(1.0, 1.0, PI / 2.0)[0].length() - PI / 2.0).abs() < 1e-9);
        // Around to the opposite heading on the spot: the three-turn curve of 7π/3.
        assert!((words(0.0, 0.0, PI)[0].length() - 7.0 * PI / 3.0).abs() < 1e-9);
    }
}
