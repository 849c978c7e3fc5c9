//! What scores see of step-wise legs, eight at a time.
//!
//! The turn's arc tangent is worked out in lanes too: the rational approximation of Cephes' `atan` (Moshier), within
//! two units of the last place. No product is fused with a sum: every SIMD level, and a leg alone, gives the same bits.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use nalgebra::Vector3;

use super::LegFeatures;
use crate::math::simd::{Simd, kernel};

/// Legs per block.
pub(super) const LANES: usize = 8;

/// What scores see of the displacement `leg` (m) after `before` (0 at the start), both flown in `step` s.
///
/// v = |leg|/step, turn = ∠(before, leg) in [0, π], slope = climb/length.
///
/// A leg or one before it without length has a turn of 0. `slope_in` is the sine of the elevation of the leg before, in
/// [−1, 1]; `ground` is 0, as nothing is known of it here.
#[inline]
pub(super) fn features(before: &Vector3<f64>, leg: &Vector3<f64>, step: f64) -> LegFeatures {
    let length_before = before.norm();
    let (length, turn) = length_and_turn([before.x, before.y, before.z], length_before, [leg.x, leg.y, leg.z]);
    let slope_in = slope(before.z, length_before);
    LegFeatures { v_in: length_before / step, v_out: length / step, turn, length, climb: leg.z, slope_in, ground: 0.0 }
}

/// [`features`] of eight displacements, one row per coordinate.
///
/// The same bits as eight single ones, at every level of SIMD.
#[inline]
pub(super) fn eight_features(
    simd: Simd,
    before: &Vector3<f64>,
    legs: &[[f64; LANES]; 3],
    step: f64,
) -> [LegFeatures; LANES] {
    let length_before = before.norm();
    let (mut lengths, mut turns) = ([0.0; LANES], [0.0; LANES]);
    lengths_and_turns(simd, [before.x, before.y, before.z], length_before, legs, &mut lengths, &mut turns);
    let slope_in = slope(before.z, length_before);
    std::array::from_fn(|lane| {
        let (length, turn) = (lengths[lane], turns[lane]);
        LegFeatures {
            v_in: length_before / step,
            v_out: length / step,
            turn,
            length,
            climb: legs[2][lane],
            slope_in,
            ground: 0.0,
        }
    })
}

/// Sine of the elevation of a leg that gains `height`; 0 if it has no length.
#[inline(always)]
fn slope(height: f64, length: f64) -> f64 {
    if length > 0.0 { height / length } else { 0.0 }
}

kernel! {
    fn lengths_and_turns(
        before: [f64; 3],
        length_before: f64,
        legs: &[[f64; LANES]; 3],
        lengths: &mut [f64; LANES],
        turns: &mut [f64; LANES],
    ) {
        for lane in 0..LANES {
            let leg = [legs[0][lane], legs[1][lane], legs[2][lane]];
            (lengths[lane], turns[lane]) = length_and_turn(before, length_before, leg);
        }
    }
}

/// Length of `leg`, and its angle to `before`, rad; 0 if either has no length.
///
/// atan2(|a × b|, a·b): well conditioned at all angles, where the arc cosine of a·b loses half of the digits near 0 and
/// π.
#[inline(always)]
fn length_and_turn(before: [f64; 3], length_before: f64, leg: [f64; 3]) -> (f64, f64) {
    let ([ax, ay, az], [bx, by, bz]) = (before, leg);
    let length = (bx * bx + by * by + bz * bz).sqrt();
    let (cx, cy, cz) = (ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx);
    let across = (cx * cx + cy * cy + cz * cz).sqrt();
    let angle = angle(across, ax * bx + ay * by + az * bz);
    (length, if (length_before > 0.0) & (length > 0.0) { angle } else { 0.0 })
}

/// The angle from the x axis to (`along`, `across`), `across` ≥ 0, rad in [0, π]; undefined at the origin.
///
/// atan2(across, along), folded into [0, π/8] by two halvings of the octant.
///
/// Within two units of the last place; O(1), one division for the octant and one for the rational function.
#[inline(always)]
fn angle(across: f64, along: f64) -> f64 {
    let size = along.abs();
    let steep = across > size;
    let (low, high) = if steep { (size, across) } else { (across, size) };
    // Above tan π/8 the angle from π/4 is approximated instead.
    let wide = low > 0.414_213_562_373_095_03 * high;
    let (top, bottom) = if wide { (low - high, low + high) } else { (low, high) };
    let x = top / bottom;
    let z = x * x;
    let p = -8.750_608_600_031_904e-1;
    let p = p * z - 1.615_753_718_733_365_2e1;
    let p = p * z - 7.500_855_792_314_705e1;
    let p = p * z - 1.228_866_684_490_136e2;
    let p = p * z - 6.485_021_904_942_025e1;
    let q = z + 2.485_846_490_142_306_4e1;
    let q = q * z + 1.650_270_098_316_988_6e2;
    let q = q * z + 4.328_810_604_912_902_6e2;
    let q = q * z + 4.853_903_996_359_137e2;
    let q = q * z + 1.945_506_571_482_614e2;
    let small = x * (z * p / q) + x;
    let octant = if wide { FRAC_PI_4 + small } else { small };
    let quadrant = if steep { FRAC_PI_2 - octant } else { octant };
    if along < 0.0 { PI - quadrant } else { quadrant }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_the_standard_library() {
        let mut worst: f64 = 0.0;
        for i in 0..=200_000 {
            let angle_in = PI * f64::from(i) / 200_000.0;
            for size in [1e-9, 0.7, 3.0, 4e8] {
                let (across, along) = (size * angle_in.sin().abs(), size * angle_in.cos());
                let expected = across.atan2(along);
                worst = worst.max((angle(across, along) - expected).abs() / expected.max(1e-3));
            }
        }
        assert!(worst < 5e-16, "{worst:e}");
        assert_eq!([angle(0.0, 2.0), angle(2.0, 0.0), angle(0.0, -2.0)], [0.0, FRAC_PI_2, PI]);
    }

    #[test]
    fn eight_legs_are_eight_times_one() {
        let before = Vector3::new(1.0, -2.0, 0.5);
        let legs = [
            [0.0, 1.0, -1.0, 3.0, 0.1, 2.0, -4.0, 1e-7],
            [0.0, -2.0, 2.0, 1.0, 0.0, 1.0, 9.0, 0.0],
            [0.0, 0.5, -0.5, 0.3, 0.0, -1.0, 1.0, 2.0],
        ];
        for start in [before, Vector3::zeros()] {
            let eight = eight_features(Simd::Widest, &start, &legs, 0.7);
            for lane in 0..LANES {
                let leg = Vector3::new(legs[0][lane], legs[1][lane], legs[2][lane]);
                assert_eq!(eight[lane], features(&start, &leg, 0.7));
            }
        }
    }
}
