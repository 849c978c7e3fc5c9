//! What drives are held to: bounds with what steering leaves of them, and the first limit that a replay breaks.

use crate::feasibility::steering::shooting::{Curvatures, Precision};
use crate::robot::rover::Rover;
use crate::verification::DriveReplay;

/// Share by which rounding may exceed a limit.
///
/// Of the bounds of κ and κ′ alone; precisions are kept as they are.
const ROUNDING: f64 = 1e-9;
/// Jump of curvature that is one, 1/m.
///
/// Where two segments meet, and at the start: below it a jump is rounding of what was written.
const JUMP: f64 = 1e-6;

/// The bounds of curvature with what the steering of `rover` leaves of them at `speed`, m/s.
///
/// |δ̇| ≤ |dδ/dκ| |κ′| v, and dδ/dκ of the steered axle is at most its distance.
///
/// `bounds.most` in 1/m, `bounds.most_rate` in 1/m². A vehicle without a steering rate keeps what it is given.
///
/// ```text
/// κ  ≤ min(given, what the wheels can be steered to)
/// κ′ ≤ min(given, δ̇ / (L v), δ̇_w / (g v))
/// ```
///
/// L the distance of the steered axle (m), δ̇ its rate and δ̇_w that of the wheels (rad/s), g the gain of the steering
/// at the bound of κ (m). Conservative: the largest |dδ/dκ| of the range is taken for all curvatures.
pub fn steerable(bounds: &Curvatures, rover: &Rover, speed: f64) -> Curvatures {
    let most = bounds.most.min(rover.steerable_curvature());
    let by_axle = rover.response.steering_rate / (rover.response.steered_axle * speed);
    let by_wheels = rover.wheels.steer_rate / (rover.steering_gain(most) * speed);
    Curvatures { most, most_rate: bounds.most_rate.min(by_axle).min(by_wheels) }
}

/// Share of the wheels' bounds that legs are shaped with: joints, ground and rounding take of it.
const SHAPED: f64 = 0.95;
/// Curvature (1/m) and change of it (1/m²) that are none: what is left where there is nothing left.
const NONE: f64 = 1e-6;

/// `bounds` with what the wheels of `rover` leave of them at `speed` (m/s), where that changes by `acceleration` (m/s²)
/// at most; `bounds` themselves of wheels that nothing holds.
///
/// ```text
/// κ  ≤ min(given, what the wheels can be steered to, what the fastest one can roll)
/// κ′ ≤ min(given, δ̇_w/(g v), (r ω̇ − (1 + |κ| d) a)/(d v²))
/// ```
///
/// g the gain of the steering at the bound of κ (m), d the distance of the farthest wheel (m), r its radius (m); of
/// each bound of the wheels 95 %. It shapes legs; whether they keep the bounds is asked of each.
pub(super) fn rollable(bounds: &Curvatures, rover: &Rover, speed: f64, acceleration: f64) -> Curvatures {
    let wheels = &rover.wheels;
    if !wheels.are_held() {
        return *bounds;
    }
    let most = bounds.most.min(SHAPED * rover.steerable_curvature());
    let most = most.min(rover.rollable_curvature(speed, SHAPED * wheels.speed)).max(NONE);
    let by_joints = SHAPED * wheels.steer_rate / (rover.steering_gain(most) * speed);
    let (reach, radius) = (rover.wheel_reach(), rover.suspension.wheels(&[0.0; 3]).2);
    let left = SHAPED * wheels.acceleration * radius - (1.0 + most * reach) * acceleration;
    let by_wheels = if wheels.acceleration.is_finite() { left / (reach * speed * speed) } else { f64::INFINITY };
    Curvatures { most, most_rate: bounds.most_rate.min(by_joints).min(by_wheels).max(NONE) }
}

/// The first limit that a replayed drive breaks, by its name in answers, and by how much.
///
/// The excess is in the unit that the name ends with. NaN breaks, with a NaN excess. `None`: all are kept.
///
/// In the order of the code, so that one drive always breaks by the same name. Cost: O(1); the replay is given.
pub fn broken(replay: &DriveReplay, bounds: &Curvatures, precision: &Precision) -> Option<(&'static str, Option<f64>)> {
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
