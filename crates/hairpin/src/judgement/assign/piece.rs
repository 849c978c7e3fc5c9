//! Straight parts of a path.

use nalgebra::Point3;

/// A straight part of a path, and what it belongs to.
#[derive(Debug, Clone, Copy)]
pub(in crate::judgement) struct Piece {
    /// First end.
    pub(in crate::judgement) from: Point3<f64>,
    /// Other end.
    pub(in crate::judgement) to: Point3<f64>,
    /// The leg, or the first segment of the path, that it stands for.
    pub(in crate::judgement) owner: usize,
}

/// Parts that legs are cut into in all, at least: progress along a leg must be monotone too, or a path that goes back
/// and forth could not be told from one that stays.
const PIECES: f64 = 256.0;

/// The legs between `waypoints`, cut into parts of about equal length.
pub(in crate::judgement) fn leg_pieces(waypoints: &[Point3<f64>]) -> Vec<Piece> {
    let total: f64 = waypoints.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
    let mut pieces = Vec::new();
    for (owner, leg) in waypoints.windows(2).enumerate() {
        let share = if total > 0.0 { (leg[1] - leg[0]).norm() / total } else { 0.0 };
        let parts = (PIECES * share).ceil().max(1.0);
        let at = |k: usize| leg[0] + (leg[1] - leg[0]) * (k as f64 / parts);
        pieces.extend((0..parts as usize).map(|k| Piece { from: at(k), to: at(k + 1), owner }));
    }
    pieces
}
