//! Rotor speeds against the robot's limits, all along a leg.
//!
//! A grid of [`Tolerances::grid`] and golden sections where an extreme comes within 2 % of a limit (of squared speed):
//! what the claim proved by enclosures is looked for again by samples.

use super::claim::Leg;
use super::finding::{Collector, Proof, Tolerances, Worst, note};
use super::replay::{Flyer, Trouble};

/// Rotor speeds against their limits on a grid, refined around each rotor's extremes where they come near a limit.
///
/// Findings `rotorK.max` and `rotorK.min`, K from 1, rad/s, beyond 10⁻⁹ of the largest squared speed; the proof's
/// slowest and fastest rotor are kept in any case.
pub(super) fn check_rotors(
    proof: &mut Proof,
    flyer: &Flyer,
    leg: &Leg,
    number: usize,
    began: f64,
    tolerances: &Tolerances,
) -> Result<(), Trouble> {
    let (slowest, fastest) = flyer.body.rotor_speed;
    let (lowest, highest) = (slowest * slowest, fastest * fastest);
    let intervals = (leg.duration / tolerances.grid).ceil().clamp(1.0, 1e6) as usize;
    let h = leg.duration / intervals as f64;
    let mut extremes = [[(f64::INFINITY, 0.0), (f64::NEG_INFINITY, 0.0)]; 4];
    for i in 0..=intervals {
        let tau = i as f64 * h;
        for ([low, high], square) in extremes.iter_mut().zip(flyer.squares(leg, tau)?) {
            if square < low.0 {
                *low = (square, tau);
            }
            if square > high.0 {
                *high = (square, tau);
            }
        }
    }
    let margin = 0.02 * highest;
    for (rotor, [low, high]) in extremes.iter_mut().enumerate() {
        if low.0 < lowest + margin {
            *low = refine(flyer, leg, rotor, -1.0, *low, h)?;
        }
        if high.0 > highest - margin {
            *high = refine(flyer, leg, rotor, 1.0, *high, h)?;
        }
        let (low_speed, high_speed) = (signed_root(low.0), signed_root(high.0));
        if low_speed < proof.slowest_rotor.value {
            proof.slowest_rotor = Worst { value: low_speed, leg: number, at: began + low.1 };
        }
        note(&mut proof.fastest_rotor, high_speed, number, began + high.1);
        let rounding = 1e-9 * highest;
        let (name, unit) = (format!("rotor{}", rotor + 1), "rad/s");
        if high.0 > highest + rounding {
            let mut found = Collector::on_leg(&mut proof.findings, number, began + high.1);
            found.above(format_args!("{name}.max"), high_speed, fastest, unit);
        }
        let mut found = Collector::on_leg(&mut proof.findings, number, began + low.1);
        let slow = low.0 < lowest - rounding;
        found.unless(!slow, format_args!("{name}.min"), low_speed, slowest, unit);
    }
    Ok(())
}

/// The extreme of one rotor's squared speed within a grid interval of `from`, by golden-section search.
///
/// `from` is (squared speed, τ), `sign` +1 for a maximum and −1 for a minimum. 24 sections narrow two grid intervals
/// to 2 · 0.618²⁴ ≈ 2 · 10⁻⁵ of one; the value there is off by the square of that. It finds the extreme where the
/// squared speed has one within the two intervals.
fn refine(flyer: &Flyer, leg: &Leg, rotor: usize, sign: f64, from: (f64, f64), h: f64) -> Result<(f64, f64), Trouble> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = ((from.1 - h).max(0.0), (from.1 + h).min(leg.duration));
    let mut best = from;
    for _ in 0..24 {
        let (left, right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let (at_left, at_right) = (flyer.squares(leg, left)?[rotor], flyer.squares(leg, right)?[rotor]);
        for (square, tau) in [(at_left, left), (at_right, right)] {
            if sign * square > sign * best.0 {
                best = (square, tau);
            }
        }
        if sign * at_left > sign * at_right { high = right } else { low = left }
    }
    Ok(best)
}

/// √|w²| with the sign of w²: a rotor that would have to pull has a negative speed.
fn signed_root(square: f64) -> f64 {
    square.abs().sqrt().copysign(square)
}
