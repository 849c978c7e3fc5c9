//! Pieces as a Crazyflie's memory has them, in whole millimetres and milliseconds.

use hairpin::math::polynomial::control_points;
use nalgebra::Vector3;

use super::Piece;

/// Control points in mm are this near to a curve of lower degree, which is written then.
const ALIKE_MM: f64 = 0.2;
/// Samples of a piece at which it is held against what it stands for.
const SAMPLES: usize = 64;
/// Longest piece, ms, and farthest place, mm: what two bytes with a sign hold.
const MOST: f64 = i16::MAX as f64;

/// A trajectory in bytes.
#[derive(Debug, Clone, PartialEq)]
pub struct Compressed {
    /// What is written into the Crazyflie's memory.
    pub bytes: Vec<u8>,
    /// Largest distance from the pieces at the same share of a piece's duration, m.
    pub error: f64,
    /// Largest difference of when a piece begins or ends, s.
    pub clock: f64,
}

/// Compresses pieces of which each begins where the one before ends.
///
/// # Errors
/// A piece that is too long, or a place that is too far from the origin.
pub fn compress(pieces: &[Piece]) -> Result<Compressed, String> {
    let Some(first) = pieces.first() else { return Err("there are no pieces".into()) };
    let mut writer = Writer { bytes: Vec::new(), at: [0; 4] };
    for (axis, at) in writer.at.iter_mut().enumerate() {
        *at = whole(in_unit(axis, first.coefficients[axis][0]))?;
    }
    writer.bytes.extend(writer.at.iter().flat_map(|value| value.to_le_bytes()));
    let (mut error, mut clock) = (0.0_f64, 0.0_f64);
    let (mut end, mut written_ms) = (0.0, 0_i64);
    for piece in pieces {
        end += piece.duration;
        let duration_ms = (1e3 * end).round() as i64 - written_ms;
        if !(1..=MOST as i64).contains(&duration_ms) {
            return Err(format!("a piece of {:.4} s, must be from 0.001 to {} s", piece.duration, MOST / 1e3));
        }
        written_ms += duration_ms;
        clock = clock.max((1e-3 * written_ms as f64 - end).abs());
        error = error.max(writer.write(piece, duration_ms as i16)?);
    }
    Ok(Compressed { bytes: writer.bytes, error, clock })
}

struct Writer {
    bytes: Vec<u8>,
    /// Where the last piece ended, mm and 0.1°.
    at: [i16; 4],
}

impl Writer {
    /// Writes a piece; how far what is written is from it, m.
    fn write(&mut self, piece: &Piece, duration_ms: i16) -> Result<f64, String> {
        let mut kinds = 0_u8;
        let mut body = Vec::new();
        let mut curves: [Vec<f64>; 4] = Default::default();
        for (axis, coefficients) in piece.coefficients.iter().enumerate() {
            let points = control_points(coefficients, piece.duration).map(|p| in_unit(axis, p));
            let (kind, kept) = reduced(&points);
            let kept = kept.into_iter().skip(1).map(whole).collect::<Result<Vec<i16>, String>>()?;
            kinds |= kind << (2 * axis);
            curves[axis] = std::iter::once(self.at[axis]).chain(kept.iter().copied()).map(f64::from).collect();
            body.extend(kept.iter().flat_map(|value| value.to_le_bytes()));
            self.at[axis] = kept.last().copied().unwrap_or(self.at[axis]);
        }
        self.bytes.push(kinds);
        self.bytes.extend(duration_ms.to_le_bytes());
        self.bytes.extend(body);
        let apart = |k: usize| {
            let share = k as f64 / SAMPLES as f64;
            let meant = piece.at(share * piece.duration);
            Vector3::from_fn(|axis, _| meant[axis] - 1e-3 * on_curve(&curves[axis], share)).norm()
        };
        Ok((0..=SAMPLES).map(apart).fold(0.0, f64::max))
    }
}

/// The kind of the least degree that has the curve of these eight control points, and its own control points.
fn reduced(points: &[f64; 8]) -> (u8, Vec<f64>) {
    let [first, last] = [points[0], points[7]];
    // The ends and both tangents there make a cubic, whose control points raised to the seventh degree tell.
    let (a, b) = (first + (points[1] - first) * 7.0 / 3.0, last - (last - points[6]) * 7.0 / 3.0);
    let candidates = [(0, vec![first]), (1, vec![first, last]), (2, vec![first, a, b, last])];
    let is_alike = |kept: &Vec<f64>| raised(kept.clone()).iter().zip(points).all(|(a, b)| (a - b).abs() <= ALIKE_MM);
    candidates.into_iter().find(|(_, kept)| is_alike(kept)).unwrap_or_else(|| (3, points.to_vec()))
}

/// The same curve with eight control points.
fn raised(mut points: Vec<f64>) -> Vec<f64> {
    while points.len() < 8 {
        let degree = points.len() as f64;
        let inner = (1..points.len()).map(|i| {
            let share = i as f64 / degree;
            share * points[i - 1] + (1.0 - share) * points[i]
        });
        points = std::iter::once(points[0]).chain(inner).chain(points.last().copied()).collect();
    }
    points
}

/// The curve at a share of its duration, by de Casteljau.
fn on_curve(points: &[f64], share: f64) -> f64 {
    let mut points = points.to_vec();
    for last in (1..points.len()).rev() {
        for i in 0..last {
            points[i] += share * (points[i + 1] - points[i]);
        }
    }
    points[0]
}

/// m in mm, rad in 0.1°.
fn in_unit(axis: usize, value: f64) -> f64 {
    if axis < 3 { 1e3 * value } else { 10.0 * value.to_degrees() }
}

fn whole(value: f64) -> Result<i16, String> {
    let rounded = value.round();
    if rounded.abs() <= MOST {
        return Ok(rounded as i16);
    }
    Err(format!("a control point at {:.3} m, must be within {} m of the origin", 1e-3 * value, MOST / 1e3))
}
