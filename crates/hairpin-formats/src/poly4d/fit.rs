//! Pieces of a planned motion: its own polynomials where it has some, cubics between samples where it has none.

use hairpin::math::power::power;
use hairpin::trajectory::{Profile, ProfileLeg, Track};
use nalgebra::Vector3;

use super::Piece;

/// How far pieces may be from the plan, m.
pub const TOLERANCE: f64 = 1e-3;
/// Shortest piece that is halved, s.
const SHORTEST: f64 = 0.01;
/// Samples of a piece at which it is held against the plan.
const SAMPLES: usize = 64;

/// Pieces, and how far they are from what they stand for at most, m.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// In their order.
    pub pieces: Vec<Piece>,
    /// In single precision, at the samples that were looked at, m.
    pub error: f64,
}

/// The polynomials of a flight themselves. A piece is halved while single precision keeps it farther than the tolerance
/// from them: long pieces have large terms that cancel.
pub fn fit_profile(profile: &Profile) -> Fitted {
    let mut fitted = Fitted { pieces: Vec::new(), error: 0.0 };
    for ProfileLeg { duration, coefficients: [x, y, z] } in &profile.legs {
        halved(Piece { duration: *duration, coefficients: [*x, *y, *z, [0.0; 8]] }, &mut fitted);
    }
    fitted
}

fn halved(piece: Piece, fitted: &mut Fitted) {
    let error = rounding(&piece);
    if error <= TOLERANCE || piece.duration < SHORTEST {
        fitted.pieces.push(piece);
        fitted.error = fitted.error.max(error);
        return;
    }
    let middle = 0.5 * piece.duration;
    halved(Piece { duration: middle, ..piece }, fitted);
    halved(Piece { duration: middle, coefficients: piece.coefficients.map(|c| shifted(&c, middle)) }, fitted);
}

/// Largest distance of a piece from itself in single precision, m.
fn rounding(piece: &Piece) -> f64 {
    let apart = |k: usize| {
        let tau = piece.duration * k as f64 / SAMPLES as f64;
        let (a, b) = (piece.at(tau), piece.single(tau));
        Vector3::new(a[0] - b[0], a[1] - b[1], a[2] - b[2]).norm()
    };
    (0..=SAMPLES).map(apart).fold(0.0, f64::max)
}

/// p(τ + by) in powers of τ, by Horner's rule on the polynomial itself.
fn shifted(c: &[f64; 8], by: f64) -> [f64; 8] {
    let mut out = [0.0; 8];
    for value in c.iter().rev() {
        for i in (1..8).rev() {
            out[i] = out[i] * by + out[i - 1];
        }
        out[0] = out[0] * by + value;
    }
    out
}

/// Cubics that have places and velocities (`vx_m_s`, …) of a track at their ends, as few as stay within the tolerance
/// of its samples; yaw is 0. `None` of a track without velocities or of fewer than two samples.
pub fn fit_track(track: &Track) -> Option<Fitted> {
    let columns = ["vx_m_s", "vy_m_s", "vz_m_s"].map(|name| track.channel(name));
    let [Some(vx), Some(vy), Some(vz)] = columns else { return None };
    let samples = Samples { track, velocities: [vx, vy, vz] };
    let last = track.len().checked_sub(1).filter(|last| *last > 0)?;
    let mut fitted = Fitted { pieces: Vec::new(), error: 0.0 };
    samples.fit(0, last, &mut fitted);
    Some(fitted)
}

struct Samples<'a> {
    track: &'a Track,
    velocities: [&'a [f64]; 3],
}

impl Samples<'_> {
    fn fit(&self, from: usize, to: usize, fitted: &mut Fitted) {
        let (piece, error) = self.cubic(from, to);
        if error <= TOLERANCE || to - from == 1 {
            fitted.pieces.push(piece);
            fitted.error = fitted.error.max(error);
            return;
        }
        let middle = (from + to) / 2;
        self.fit(from, middle, fitted);
        self.fit(middle, to, fitted);
    }

    fn cubic(&self, from: usize, to: usize) -> (Piece, f64) {
        let (times, poses) = (self.track.times(), self.track.poses());
        let duration = times[to] - times[from];
        let mut coefficients = [[0.0; 8]; 4];
        for (axis, own) in coefficients.iter_mut().take(3).enumerate() {
            let place = |i: usize| poses[i].translation.vector[axis];
            let (p, q) = (place(from), place(to));
            let (v, w) = (self.velocities[axis][from] * duration, self.velocities[axis][to] * duration);
            let cubic = [p, v, 3.0 * (q - p) - 2.0 * v - w, 2.0 * (p - q) + v + w];
            for (i, value) in cubic.into_iter().enumerate() {
                own[i] = value / power(duration, i);
            }
        }
        let piece = Piece { duration, coefficients };
        let apart = |i: usize| {
            let [x, y, z, _] = piece.single(times[i] - times[from]);
            (poses[i].translation.vector - Vector3::new(x, y, z)).norm()
        };
        (piece, (from..=to).map(apart).fold(0.0, f64::max))
    }
}
