//! Where the search for a posture of an arm without a closed inverse begins: Newton's steps from one seed may lead
//! nowhere although the arm can stand there, so that there are others.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::Isometry3;

use super::Arm;
use super::joints::{AXES, Joints};

/// Seeds spread over the joints' bounds; of poses made from postures of three arms none took more than 19.
const SPREAD: u32 = 45;
/// Primes, one an axis.
const BASES: [u32; AXES] = [2, 3, 5, 7, 11, 13];

impl Arm {
    /// The first posture within the limits that Newton's steps find, its angles on whole turns within the bounds; else
    /// the first beyond them, if there is any.
    ///
    /// Seeds in this order: `near`, the same with axis 1 turned by 90°, 180° and 270°, then a fixed set all over the
    /// bounds. That none leads anywhere proves nothing, but for flanges farther off than the chain is long
    /// ([`super::Chain::is_beyond`]).
    pub(super) fn searched(&self, flange: &Isometry3<f64>, near: &Joints) -> Option<Joints> {
        if self.chain.is_beyond(&flange.translation.vector.into()) {
            return None;
        }
        let mut outside = None;
        for seed in self.seeds(near) {
            let Some(found) = self.chain.inverse_near(flange, &seed) else { continue };
            if let Some(inside) = self.turned_inside(&found.joints, near) {
                return Some(inside);
            }
            outside = outside.or(Some(found.joints));
        }
        outside
    }

    /// `q` where it keeps the bounds, else each axis on the turn within its bounds that is nearest to `near`.
    fn turned_inside(&self, q: &Joints, near: &Joints) -> Option<Joints> {
        if self.outside_limits(q).is_none() {
            return Some(*q);
        }
        let mut turned = *q;
        for (k, (angle, limit)) in turned.iter_mut().zip(&self.limits).enumerate() {
            let (least, most) = (((limit.lower - *angle) / TAU).ceil(), ((limit.upper - *angle) / TAU).floor());
            if least > most {
                return None;
            }
            *angle += TAU * ((near[k] - *angle) / TAU).round().clamp(least, most);
        }
        Some(turned)
    }

    fn seeds(&self, near: &Joints) -> impl Iterator<Item = Joints> {
        let [first, rest @ ..] = *near;
        let turned = (0..4).map(move |quarter| {
            let [second, third, fourth, fifth, sixth] = rest;
            [first + f64::from(quarter) * FRAC_PI_2, second, third, fourth, fifth, sixth]
        });
        turned.chain((1..=SPREAD).map(|number| self.spread(number)))
    }

    /// Halton's sequence in the joints' bounds, of which no more than a turn counts about their middle.
    ///
    /// (Halton, "On the efficiency of certain quasi-random sequences of points in evaluating multi-dimensional
    /// integrals", 1960.)
    fn spread(&self, number: u32) -> Joints {
        std::array::from_fn(|k| {
            let limit = &self.limits[k];
            let (middle, half) = (0.5 * (limit.lower + limit.upper), (0.5 * (limit.upper - limit.lower)).min(PI));
            middle + half * (2.0 * radical_inverse(number, BASES[k]) - 1.0)
        })
    }
}

/// The digits of `number` in base `base` mirrored at the point: in [0, 1).
fn radical_inverse(mut number: u32, base: u32) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0);
    while number > 0 {
        digit /= f64::from(base);
        value += digit * f64::from(number % base);
        number /= base;
    }
    value
}
