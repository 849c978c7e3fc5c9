//! The rims of two driven wheels along a drive as it was written: do they keep their speed and their acceleration?
//!
//! A wheel h beside the middle goes at v (1 ± κ h); between two knots v² is linear, so that v̇ is constant, and the rim
//! speeds up by v̇ ± h (v̇ κ + v² κ′).
//!
//! ```text
//! |v_rim| ≤ v (1 + h |κ|)                          the outer of both
//! |a_rim| = max over ± of |v̇ ± h (v̇ κ + v² κ′)| = |v̇| + h |v̇ κ + v² κ′|
//! ```
//!
//! h is half of the track, m; κ and κ′ = dκ/ds are the piece's polynomial and its slope. On a part of half-length d
//! around its middle |κ| ≤ |κ_m| + d max|κ′| and |κ′| ≤ |κ′_m| + d max|κ″|: bounds that hold for the whole part, and
//! halve with it. What is told as beyond is a value that is taken somewhere, never only a bound; what 20 halvings
//! leave undecided counts as kept.

use super::drive::DrivePiece;
use super::peak::peak;

/// Two driven wheels on one axle, as plain numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelRims {
    /// Distance of each from the middle, m.
    pub half_track_m: f64,
    /// Largest speed of a rim, m/s.
    pub speed_m_s: f64,
    /// Largest acceleration of a rim, m/s².
    pub acceleration_m_s2: f64,
}

/// What a rim is asked for beyond what it can.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RimBreach {
    /// m/s or m/s².
    pub value: f64,
    /// What it may be.
    pub bound: f64,
    /// Metres driven before.
    pub after_m: f64,
}

/// Bounds are kept up to this share of them.
const ROUNDING: f64 = 1e-6;
/// Halvings of a stretch before what is not decided counts as kept: it is beyond by less than that share of it.
const DEPTH: u32 = 20;

/// The first speed and the first acceleration of a rim along `pieces` that are beyond `rims`; `None`: kept everywhere.
///
/// `knots` are metres of the drive, rising from 0, with the speed there, m/s: v² is linear between, and as at the ends
/// beyond. Turns in place go at `turn_rate` rad/s, however they come to it. Between looks everything is bounded, by the
/// peaks of the polynomials' slopes, and halved until it is decided. NaN is beyond.
pub fn rim_breaches(
    pieces: &[DrivePiece],
    knots: &[[f64; 2]],
    turn_rate: f64,
    rims: &WheelRims,
) -> [Option<RimBreach>; 2] {
    let mut found = [None; 2];
    let mut driven = 0.0;
    for piece in pieces {
        match *piece {
            DrivePiece::Turn { angle_rad } => {
                let value = if angle_rad == 0.0 { 0.0 } else { turn_rate.abs() * rims.half_track_m };
                keep(&mut found[0], value, rims.speed_m_s, driven);
            }
            DrivePiece::Arc { length_m, curvature, .. } => {
                let way = Way::new(curvature, length_m, rims.half_track_m);
                for stretch in stretches(knots, driven, length_m) {
                    let bounds = [rims.speed_m_s, rims.acceleration_m_s2];
                    for (which, bound) in bounds.into_iter().enumerate() {
                        if let Some((value, s)) = way.beyond(&stretch, which, bound, DEPTH) {
                            keep(&mut found[which], value, bound, driven + s);
                        }
                    }
                }
            }
        }
        driven += piece.length();
    }
    found
}

/// Notes the first value that is beyond `bound`, or none.
fn keep(found: &mut Option<RimBreach>, value: f64, bound: f64, after_m: f64) {
    let kept = value <= bound * (1.0 + ROUNDING);
    if found.is_none() && !kept {
        *found = Some(RimBreach { value, bound, after_m });
    }
}

/// Metres of a piece between two knots, with v² at both.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    from: f64,
    to: f64,
    squares: [f64; 2],
}

/// The parts of a piece of `length` m, which begins `driven` m after the start, between knots.
///
/// `knots` count metres of the whole drive, a stretch's `from` and `to` those of the piece. Before the first knot and
/// after the last the speed is constant. Without knots the one stretch has speeds that are no number, which is beyond
/// every bound. Knots at one place make no stretch.
fn stretches(knots: &[[f64; 2]], driven: f64, length: f64) -> Vec<Stretch> {
    let ends = [knots.first(), knots.last()].map(|knot| knot.copied().unwrap_or([0.0, f64::NAN]));
    let mut all = Vec::with_capacity(knots.len() + 1);
    let mut add = |[s, v]: [f64; 2], [t, w]: [f64; 2]| {
        let (from, to) = ((s - driven).max(0.0), (t - driven).min(length));
        let slope = if t.is_finite() && s.is_finite() { (w * w - v * v) / (t - s) } else { 0.0 };
        let square = |at: f64| if slope == 0.0 { v * v } else { v * v + slope * (at + driven - s) };
        if to > from {
            all.push(Stretch { from, to, squares: [square(from), square(to)] });
        }
    };
    add([f64::NEG_INFINITY, ends[0][1]], ends[0]);
    knots.windows(2).for_each(|pair| add(pair[0], pair[1]));
    add(ends[1], [f64::INFINITY, ends[1][1]]);
    all
}

impl Stretch {
    fn halves(&self) -> [Self; 2] {
        let (middle, square) = (0.5 * (self.from + self.to), 0.5 * (self.squares[0] + self.squares[1]));
        let half = |from, to, squares| Self { from, to, squares };
        [half(self.from, middle, [self.squares[0], square]), half(middle, self.to, [square, self.squares[1]])]
    }

    /// v̇, m/s²: half of what v² changes by per metre.
    fn acceleration(&self) -> f64 {
        0.5 * (self.squares[1] - self.squares[0]) / (self.to - self.from)
    }
}

/// A piece's curvature, and by how much it and its slope change per metre at most.
///
/// `steepest` holds max|κ′| (1/m²) and max|κ″| (1/m³) over the whole piece, from the polynomials' peaks.
struct Way {
    curvature: [f64; 6],
    slope: [f64; 6],
    steepest: [f64; 2],
    half_track: f64,
}

impl Way {
    fn new(curvature: [f64; 6], length: f64, half_track: f64) -> Self {
        let derived = |p: &[f64; 6]| std::array::from_fn(|i| p.get(i + 1).map_or(0.0, |a| (i + 1) as f64 * a));
        let slope: [f64; 6] = derived(&curvature);
        let steepest = [peak(&slope, length), peak(&derived(&slope), length)];
        Self { curvature, slope, steepest, half_track }
    }

    /// A value of `stretch` beyond `bound`, and where: of rims' speed (`which` 0) or acceleration (1).
    ///
    /// `None` where all of the stretch keeps the bound, or where `depth` halvings leave it open. The place is the
    /// middle of the part that is beyond, metres of the piece. The first along the way that is found, by halves from
    /// the left: 2^`depth` parts at most.
    fn beyond(&self, stretch: &Stretch, which: usize, bound: f64, depth: u32) -> Option<(f64, f64)> {
        let [most, there] = self.at_most(stretch, which);
        let bound_kept = bound * (1.0 + ROUNDING);
        if most <= bound_kept {
            return None;
        }
        if there.is_nan() || there > bound_kept {
            return Some((there, 0.5 * (stretch.from + stretch.to)));
        }
        if depth == 0 {
            return None;
        }
        stretch.halves().iter().find_map(|half| self.beyond(half, which, bound, depth - 1))
    }

    /// What a rim's speed or acceleration is at most along `stretch`, and what it is in its middle.
    ///
    /// \[bound, value in the middle\], both in m/s (`which` 0) or m/s² (1); the bound is never below what any place
    /// of the stretch has, but for rounding. v² at the middle is the mean of both ends, since it is linear.
    fn at_most(&self, stretch: &Stretch, which: usize) -> [f64; 2] {
        let (middle, half) = (0.5 * (stretch.from + stretch.to), 0.5 * (stretch.to - stretch.from));
        let at = |p: &[f64; 6]| p.iter().rev().fold(0.0, |sum, a| sum * middle + a);
        let (bend, rate) = (at(&self.curvature), at(&self.slope));
        let (most_bend, most_rate) = (bend.abs() + half * self.steepest[0], rate.abs() + half * self.steepest[1]);
        let [a, b] = stretch.squares;
        let (square, most_square) = (0.5 * (a + b), a.max(b));
        let h = self.half_track;
        if which == 0 {
            return [most_square.sqrt() * (1.0 + h * most_bend), square.sqrt() * (1.0 + h * bend.abs())];
        }
        let gain = stretch.acceleration();
        let most = gain.abs() * (1.0 + h * most_bend) + h * most_square * most_rate;
        [most, gain.abs() + h * (gain * bend + square * rate).abs()]
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    const RIMS: WheelRims = WheelRims { half_track_m: 0.08, speed_m_s: 0.22, acceleration_m_s2: 2.5 };

    fn arc(length_m: f64, a0: f64, a1: f64) -> DrivePiece {
        DrivePiece::Arc { length_m, curvature: [a0, a1, 0.0, 0.0, 0.0, 0.0], direction: 1.0 }
    }

    #[test]
    fn the_outer_wheel_of_a_bend_is_the_fast_one() {
        // 0.22 (1 + 12.5 · 0.08) = 0.44 m/s.
        let [speed, acceleration] = rim_breaches(&[arc(0.25, 12.5, 0.0)], &[[0.0, 0.22]], 1.0, &RIMS);
        assert!((speed.unwrap().value - 0.44).abs() < 1e-12 && acceleration.is_none());
        assert_eq!(rim_breaches(&[arc(0.25, -12.5, 0.0)], &[[0.0, 0.11]], 1.0, &RIMS), [None; 2], "at its limit");
        // It becomes too fast on the way: 0.11 (1 + 0.08 · 13) at 0.5 m.
        let [speed, _] = rim_breaches(&[arc(0.2, 0.0, 0.0), arc(0.6, 0.0, 26.0)], &[[0.0, 0.11]], 1.0, &RIMS);
        let told = speed.unwrap();
        assert!(told.value > 0.22 && (0.68..0.8).contains(&told.after_m), "{told:?}");
        // Where it is fast is not where it bends.
        let slows = [[0.0, 0.2], [0.5, 0.2], [0.55, 0.05], [1.0, 0.05]];
        assert!(rim_breaches(&[arc(0.55, 0.0, 0.0), arc(0.45, 12.5, 0.0)], &slows, 1.0, &RIMS)[0].is_none());
        assert!(rim_breaches(&[arc(0.5, 0.0, 0.0), arc(0.5, 12.5, 0.0)], &slows, 1.0, &RIMS)[0].is_some());
    }

    #[test]
    fn speeding_up_and_steering_add_up_at_a_rim() {
        let up = |a: f64, length: f64| [[0.0, 0.0], [length, (2.0 * a * length).sqrt()]];
        assert!(rim_breaches(&[arc(0.002, 0.0, 0.0)], &up(2.5, 0.002), 1.0, &RIMS)[1].is_none());
        // v̇ (1 + κ h): 2 · 2 m/s².
        let [_, bent] = rim_breaches(&[arc(0.002, 12.5, 0.0)], &up(2.0, 0.002), 1.0, &RIMS);
        assert!((bent.unwrap().value - 4.0).abs() < 1e-9);
        // h v² κ′ = 0.08 · 0.0121 · 2583 at 0.11 m/s is all that a rim has.
        let clothoid = |rate: f64| rim_breaches(&[arc(0.004, 0.0, rate)], &[[0.0, 0.11]], 1.0, &RIMS)[1];
        assert!(clothoid(2582.0).is_none() && clothoid(2584.0).is_some());
    }

    #[test]
    fn turns_count_and_numbers_that_are_none_are_never_kept() {
        let turn = [DrivePiece::Turn { angle_rad: 1.0 }];
        assert!(rim_breaches(&turn, &[[0.0, 0.1]], 2.75, &RIMS)[0].is_none());
        assert!(rim_breaches(&turn, &[[0.0, 0.1]], 2.76, &RIMS)[0].is_some());
        assert!(rim_breaches(&[arc(1.0, f64::NAN, 0.0)], &[[0.0, 0.1]], 1.0, &RIMS)[0].is_some());
        assert!(rim_breaches(&[arc(1.0, 0.0, 0.0)], &[], 1.0, &RIMS)[0].is_some());
    }
}
