//! What must hold at the waypoints themselves: the polynomials meet them and each other, level and without rates.
//!
//! These conditions tie every coefficient: c_i enters the position at the leg's end as c_i T^i, the velocity as
//! i c_i T^(i−1) and so on, and each of those is compared with a number that does not contain it.
//!
//! The tolerance is of sums: each derivative's own terms say how much rounding it may carry.

use super::body::Body;
use super::claim::{Claim, Leg};
use super::demand::drag;
use super::jet::{Jet, JetVector};
use crate::math::power::power;

/// A derivative of the position at a leg's end, and the sum of the magnitudes of its terms, which bounds its rounding.
type Derivative = [(f64, f64); 3];

/// How far a knot is from what it must be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mismatch {
    /// Order of the derivative: 0 position … 3 jerk.
    pub(super) order: usize,
    /// The leg whose end it is.
    pub(super) leg: usize,
    /// Whether it is the leg's end rather than its start.
    pub(super) at_end: bool,
    /// Largest difference over the axes, m/s^order.
    pub(super) difference: f64,
    /// What the difference may be.
    pub(super) allowed: f64,
}

/// Relative rounding that the polynomials' maker is granted, of the sum of the terms' magnitudes.
const ROUNDING: f64 = 1e-12;

/// All conditions at all legs' ends, within `absolute` (SI) plus rounding: start and end position, velocity against
/// the leg before (rest at the flight's ends), thrust equal to the weight and pointing up (m v̇ + D(v) = 0), and not
/// turning (m v̈ + dD/dt = 0).
///
/// Eight a leg: four orders at either end, each the worst of its axes by difference/allowed. Velocities at a leg's
/// start are compared with the leg before, at its end only the flight's last must be at rest.
///
/// Position is compared with the waypoint, whose own size counts towards the rounding. NaN counts as an infinite
/// difference.
pub(super) fn mismatches(body: &Body, claim: &Claim, absolute: f64) -> Vec<Mismatch> {
    let mut found = Vec::with_capacity(8 * claim.legs.len());
    let still: Derivative = [(0.0, 0.0); 3];
    let mut velocity_before = still;
    for (number, leg) in claim.legs.iter().enumerate() {
        for at_end in [false, true] {
            let tau = if at_end { leg.duration } else { 0.0 };
            let knot: [Derivative; 4] = std::array::from_fn(|order| derivative(leg, tau, order));
            let waypoint = claim.waypoints[number + usize::from(at_end)].map(|c| (c, c.abs()));
            let (acceleration, jerk) = level(body, &knot);
            let velocity = match (at_end, number + 1 == claim.legs.len()) {
                (false, _) => velocity_before,
                (true, true) => still,
                (true, false) => knot[1],
            };
            for (order, wanted) in [waypoint, velocity, acceleration, jerk].iter().enumerate() {
                let (difference, allowed) = compare(&knot[order], wanted, absolute);
                found.push(Mismatch { order, leg: number, at_end, difference, allowed });
            }
            velocity_before = knot[1];
        }
    }
    found
}

/// Σ c_i i!/(i−order)! τ^(i−order) and the sum of the magnitudes, per axis.
fn derivative(leg: &Leg, tau: f64, order: usize) -> Derivative {
    leg.coefficients.map(|c| {
        let (mut sum, mut size) = (0.0, 0.0);
        for (i, c) in c.iter().enumerate().skip(order) {
            let falling: f64 = (i + 1 - order..=i).map(|k| k as f64).product();
            let term = c * falling * power(tau, i - order);
            sum += term;
            size += term.abs();
        }
        (sum, size)
    })
}

/// Acceleration and jerk at which the body is level and does not turn, for the knot's velocity and acceleration.
///
/// ```text
/// v̇ = −D(v)/m,   v̈ = −(dD/dt)/m,   D(v) = (c₁ + c₂|v|) v
/// ```
///
/// With them the thrust is m g e₃ and stands still. The second numbers are sizes that rounding is a share of: the
/// value's own, and an upper estimate of |∂D/∂v|/m times the largest terms of velocity and acceleration.
fn level(body: &Body, knot: &[Derivative; 4]) -> (Derivative, Derivative) {
    let velocity: JetVector = std::array::from_fn(|axis| Jet([knot[1][axis].0, knot[2][axis].0, 0.0]));
    let drag = drag(body, &velocity);
    let wanted = |order: usize| {
        std::array::from_fn(|axis| {
            let value = -drag[axis].0[order] / body.mass;
            // Rounding of the velocity and acceleration that the drag is computed from.
            let from = knot[1].iter().chain(&knot[2]).map(|(_, size)| size).fold(0.0f64, |a, b| a.max(*b));
            let slope = (body.drag_linear + body.drag_quadratic * (1.0 + 2.0 * from)).abs() / body.mass;
            (value, value.abs() + slope * from)
        })
    };
    (wanted(0), wanted(1))
}

/// (difference, allowed) of the axis where their ratio is largest.
fn compare(found: &Derivative, wanted: &Derivative, absolute: f64) -> (f64, f64) {
    let mut worst = (0.0, absolute);
    let mut ratio = -1.0;
    for (found, wanted) in found.iter().zip(wanted) {
        let difference = (found.0 - wanted.0).abs();
        let allowed = absolute + ROUNDING * (found.1 + wanted.1);
        // A difference that is not a number is the worst of all.
        let own = if difference.is_nan() { f64::INFINITY } else { difference / allowed };
        if own > ratio {
            (worst, ratio) = ((if difference.is_nan() { f64::INFINITY } else { difference }, allowed), own);
        }
    }
    worst
}
