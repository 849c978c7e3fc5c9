//! What must hold at the waypoints themselves: polynomials meet them and each other, at rest at both ends of the trip.

use super::claim::{BoatClaim, BoatLeg};
use crate::math::power::power;

/// How far a knot is from what it must be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mismatch {
    /// Order of the derivative: 0 place … 3.
    pub(super) order: usize,
    /// Whether it is the heading rather than the place.
    pub(super) heading: bool,
    /// The leg whose end it is.
    pub(super) leg: usize,
    /// Whether it is the leg's end rather than its start.
    pub(super) at_end: bool,
    /// Largest difference over the axes, m/s^order or rad/s^order.
    pub(super) difference: f64,
    /// What the difference may be.
    pub(super) allowed: f64,
}

/// Relative rounding that the polynomials' maker is granted, of the sum of the terms' magnitudes.
const ROUNDING: f64 = 1e-12;

/// A derivative and the sum of the magnitudes of its terms.
type Value = (f64, f64);

/// All conditions at all legs' ends, within `absolute` (SI) plus rounding: places at waypoints; velocity, acceleration
/// and jerk against the leg before, and none at the trip's ends; the same of the heading, which may differ by whole
/// turns.
pub(super) fn mismatches(claim: &BoatClaim, absolute: f64) -> Vec<Mismatch> {
    let mut found = Vec::with_capacity(16 * claim.legs.len());
    let mut before: Option<[[Value; 3]; 4]> = None;
    for (number, leg) in claim.legs.iter().enumerate() {
        for at_end in [false, true] {
            let knot: [[Value; 3]; 4] = std::array::from_fn(|order| derivative(leg, at_end, order));
            let last = at_end && number + 1 == claim.legs.len();
            let waypoint = claim.waypoints[number + usize::from(at_end)];
            let mut note = |order: usize, heading: bool, pairs: &[(Value, Value)]| {
                let (difference, allowed) = worst(pairs, heading && order == 0, absolute);
                found.push(Mismatch { order, heading, leg: number, at_end, difference, allowed });
            };
            note(0, false, &[0, 1].map(|axis| (knot[0][axis], (waypoint[axis], waypoint[axis].abs()))));
            let other = match (at_end, &before) {
                (false, Some(before)) => Some(*before),
                (false, None) => None,
                (true, _) if last => None,
                (true, _) => Some(knot),
            };
            if let Some(other) = &other {
                note(0, true, &[(knot[0][2], other[0][2])]);
            }
            for order in 1..4 {
                let wanted = other.map_or([(0.0, 0.0); 3], |other| other[order]);
                note(order, false, &[0, 1].map(|axis| (knot[order][axis], wanted[axis])));
                note(order, true, &[(knot[order][2], wanted[2])]);
            }
            before = Some(knot);
        }
    }
    found
}

/// Σ c_i i!/(i−order)! τ^(i−order) and the sum of the magnitudes, per axis.
fn derivative(leg: &BoatLeg, at_end: bool, order: usize) -> [Value; 3] {
    let tau = if at_end { leg.duration } else { 0.0 };
    leg.coefficients.map(|c| {
        c.iter().enumerate().skip(order).fold((0.0, 0.0), |(sum, size), (i, c)| {
            let falling: f64 = (i + 1 - order..=i).map(|k| k as f64).product();
            let term = c * falling * power(tau, i - order);
            (sum + term, size + term.abs())
        })
    })
}

/// Of all pairs the difference that is largest beside what it may be. `turns`: differences by whole turns are none.
fn worst(pairs: &[(Value, Value)], turns: bool, absolute: f64) -> (f64, f64) {
    let mut worst = (0.0, absolute);
    for (found, wanted) in pairs {
        let mut difference = (found.0 - wanted.0).abs();
        if turns {
            difference = libm::remainder(difference, std::f64::consts::TAU).abs();
        }
        let difference = if difference.is_nan() { f64::INFINITY } else { difference };
        let allowed = absolute + ROUNDING * (found.1 + wanted.1);
        if difference / allowed >= worst.0 / worst.1 {
            worst = (difference, allowed);
        }
    }
    worst
}
