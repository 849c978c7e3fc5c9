//! Which forces a polynomial demands: the rates of the momenta of hull and water, by arithmetic on series.

use super::claim::{BoatClaim, BoatHull, BoatLeg};
use super::series::{Angle, Series};
use crate::math::outward::Interval;

/// Forces and the square of the speed over ground at one moment, or on a stretch of time: values, and what they change
/// by per second.
#[derive(Debug, Clone, Copy)]
pub(super) struct Demand<N> {
    /// X, Y, N: N, N, N·m.
    pub(super) forces: [[N; 2]; 3],
    /// (m/s)².
    pub(super) speed_squared: [N; 2],
}

/// Derivatives of order 0 … 3 over k!, of x, y and ψ.
pub(super) type Taylor<N> = [[N; 4]; 3];

/// Those of `leg` on all of `time`: shifted to its middle, where Horner's rule has little to overestimate.
///
/// The coefficients at every moment of `time` at once: Σ_i c_i C(i, k) (t − m)^(i−k) over the interval, after a shift
/// to m. Intervals are rounded outwards.
pub(super) fn taylor_over(leg: &BoatLeg, time: Interval) -> Taylor<Interval> {
    let m = Interval::point(time.middle());
    let around = time - m;
    leg.coefficients.map(|c| {
        let mut c = c.map(Interval::point);
        for k in 0..8 {
            for i in (k..7).rev() {
                c[i] = c[i] + m * c[i + 1];
            }
        }
        // Coefficient k of the same polynomial about any moment of `time`.
        std::array::from_fn(|k| {
            (k..8).rev().fold(Interval::point(0.0), |sum, i| sum * around + c[i] * Interval::point(choose(i, k)))
        })
    })
}

/// Binomial coefficients.
fn choose(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, j| product * (n - j) as f64 / (j + 1) as f64)
}

/// The demand of a motion with these derivatives in the claim's current.
///
/// ```text
/// ν = (u, v, r):  (u, v) = Rot(ψ)ᵀ (ẋ − current),  r = ψ̇           relative to the water, body frame
/// p = M ν,   X = ṗ_u − r p_v + D_X,   Y = ṗ_v + r p_u + D_Y,   N = ṗ_r + u p_v − v p_u + D_N
/// ```
///
/// The current is even and steady. Values and first derivatives are told; the third coefficients of their series are
/// unknown and left out.
pub(super) fn demand<N: Angle>(hull: &BoatHull, claim: &BoatClaim, taylor: &Taylor<N>) -> Demand<N> {
    let scaled = |c: N, factor: f64| c * N::constant(factor);
    let rate = |axis: usize| {
        let [_, first, second, third] = taylor[axis];
        Series([first, scaled(second, 2.0), scaled(third, 3.0)])
    };
    let [psi, psi_1, psi_2, _] = taylor[2];
    let (sin, cos) = Series([psi, psi_1, psi_2]).sine_and_cosine();
    let (over_x, over_y, r) = (rate(0), rate(1), rate(2));
    let (x, y) = (over_x - Series::constant(claim.current[0]), over_y - Series::constant(claim.current[1]));
    let (u, v) = (cos * x + sin * y, cos * y - sin * x);
    let [surge, sway, yaw] = momenta(hull, [u, v, r]);
    let [d_x, d_y, d_n] = damping(hull, [u, v, r]);
    let forces =
        [surge.rate() - r * sway + d_x, sway.rate() + r * surge + d_y, yaw.rate() + u * sway - v * surge + d_n];
    let speed_squared = over_x * over_x + over_y * over_y;
    let two = |series: Series<N>| [series.0[0], series.0[1]];
    Demand { forces: forces.map(two), speed_squared: two(speed_squared) }
}

/// M ν.
fn momenta<N: Angle>(hull: &BoatHull, [u, v, r]: [Series<N>; 3]) -> [Series<N>; 3] {
    let [a, b, c, d] = hull.mass;
    [u.scaled(a), v.scaled(b) + r.scaled(c), v.scaled(c) + r.scaled(d)]
}

/// What the water takes, X, Y, N.
///
/// ```text
/// D_X = −(X_u + X_|u|u |u| + X_uuu u²) u
/// D_Y = −(Y_v + Y_|v|v |v| + Y_|r|v |r|) v − (Y_r + Y_|v|r |v| + Y_|r|r |r|) r
/// ```
///
/// and D_N with N's as D_Y. Coefficients have their published signs, so that minus the sum is what the water takes.
/// Values and first derivatives only: |·| has no second one.
pub(super) fn damping<N: Angle>(hull: &BoatHull, [u, v, r]: [Series<N>; 3]) -> [Series<N>; 3] {
    let (ahead, drift, turn) = (u.abs(), v.abs(), r.abs());
    let part = |k: &[f64; 3], first: Series<N>, second: Series<N>| {
        -(Series::constant(k[0]) + first.scaled(k[1]) + second.scaled(k[2]))
    };
    [
        part(&hull.surge, ahead, u * u) * u,
        part(&hull.sway_by_sway, drift, turn) * v + part(&hull.sway_by_yaw, drift, turn) * r,
        part(&hull.yaw_by_sway, drift, turn) * v + part(&hull.yaw_by_yaw, drift, turn) * r,
    ]
}
