//! An answer, and what its replay holds it to.

use std::time::Duration;

use hairpin::campaign::drive::drive_piece;
use hairpin::feasibility::steering::shooting::query::{Curvatures, Precision};
use hairpin::feasibility::steering::shooting::solve::Solution;
use hairpin::verification::{DriveClaim, DrivePiece, DriveReplay};
use hairpin_formats::steering::{Asked, Status};

/// An answer before it is put into a file or into words.
pub(super) struct Answered {
    pub(super) status: Status,
    /// Without one where the question has no answer.
    pub(super) drive: Option<(Solution, DriveReplay)>,
    pub(super) solving: Duration,
    /// What stands in the way; its excess in its unit.
    pub(super) limit: Option<(&'static str, Option<f64>)>,
    /// The bounds that were in force.
    pub(super) bounds: Curvatures,
    /// Curvatures that would be feasible, where those asked for are not.
    pub(super) nearest: Option<[f64; 2]>,
}

/// Share by which rounding may exceed a limit.
const ROUNDING: f64 = 1e-9;
/// Jump of curvature that is one, 1/m.
const JUMP: f64 = 1e-6;

/// What the replay holds a drive to.
pub(super) fn claim(asked: &Asked) -> DriveClaim {
    DriveClaim {
        start_curvature: asked.k0,
        crab: asked.direction,
        crab_rate: 0.0,
        end: asked.goal,
        end_curvature: asked.kf,
    }
}

/// A drive as plain numbers.
pub(in crate::commands) fn pieces(solution: &Solution) -> Vec<DrivePiece> {
    solution.segments.iter().map(drive_piece).collect()
}

/// The first limit that a replayed drive breaks, and by how much.
pub(super) fn broken(
    replay: &DriveReplay,
    bounds: &Curvatures,
    precision: &Precision,
) -> Option<(&'static str, Option<f64>)> {
    let [x, y, yaw] = replay.error;
    let found = [
        ("curvature_1_m", replay.max_curvature, bounds.most * (1.0 + ROUNDING)),
        ("curvature_rate_1_m2", replay.max_curvature_rate, bounds.most_rate * (1.0 + ROUNDING)),
        ("position_m", libm::hypot(x, y), precision.position),
        ("yaw_rad", yaw.abs(), precision.yaw),
        ("end_curvature_1_m", replay.error_curvature.abs(), precision.curvature),
        ("start_curvature_1_m", replay.start_error_curvature.abs(), JUMP),
        ("curvature_jump_1_m", replay.max_jump, JUMP),
    ];
    let over = found.into_iter().find(|(_, value, bound)| value.is_nan() || value > bound);
    over.map(|(name, value, bound)| (name, Some(value - bound)))
}
