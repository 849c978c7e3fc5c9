//! The smoothest curve through given points at given times, which planners and trackers both start from.
//!
//! Richter, Bry, Roy, "Polynomial trajectory planning for aggressive quadrotor flight in dense indoor environments"
//! (ISRR 2013), unconstrained form: the unknowns are not coefficients but the free derivatives at the interior points.
//!
//! Per axis and segment the cost is a quadratic form of the end data d = (p, v, a, j at both ends):
//!
//! ```text
//! J = ∫₀ᵀ (p⁗)² dt = dᵀ Q(T) d,     Q(T)_ij = q_ij T^(m_i + m_j − 7),   m = (0, 1, 2, 3, 0, 1, 2, 3)
//! ```
//!
//! Positions are given and the ends are at rest, so that v, a, j at the n − 2 interior points are all that is free:
//! ∂J/∂(v, a, j)_k = 0 is a system of 3 × 3 blocks, each tied to its neighbours alone, with one right-hand side per
//! axis. The stationary curve is the interpolating spline of degree 7 and class C⁶. Times are not optimised here.

use nalgebra::{Matrix3, Point3, SMatrix};
use thiserror::Error;

use super::power::power;

/// One segment: `c[axis][i]` in m/s^i, p_axis(τ) = Σ c_i τ^i, τ ∈ [0, T].
///
/// τ runs from 0 at the segment's own start. World frame; axes x, y, z.
pub type SegmentCoefficients = [[f64; 8]; 3];

/// Why there is no minimum-snap curve.
///
/// All but `IllConditioned` are mistakes of the caller, found before anything is computed.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum MinimumSnapError {
    /// At least two points, and one time per segment.
    #[error("{points} points and {times} segment times: needs at least 2 points and one time less than points")]
    Count {
        /// Points given.
        points: usize,
        /// Times given.
        times: usize,
    },
    /// A time that is not positive and finite.
    #[error("segment time {index} = {value} s: must be finite and > 0")]
    Time {
        /// Number of the segment.
        index: usize,
        /// Its time, s.
        value: f64,
    },
    /// A point that is not finite.
    #[error("point {index} is not finite")]
    Point {
        /// Number of the point.
        index: usize,
    },
    /// Segment times so unequal that doubles cannot hold the solution.
    #[error("segment times differ too much to be solved for")]
    IllConditioned,
}

/// The piecewise 7th-order polynomial from rest to rest through `points` (m) that minimises ∫‖p⁗‖² dt, for segment
/// times `times` (s); three derivatives are zero at both ends, and six are continuous in between.
///
/// The velocity at point k is `c[axis][1]` of the segment that starts there. Block-tridiagonal elimination: linear
/// time.
///
/// Elimination without pivoting between blocks: they are principal blocks of a positive definite matrix. Scaling by the
/// mean segment time keeps them comparable; what ratios of times beyond that do to the digits is seen at the end, as
/// coefficients that are not finite.
///
/// ```
/// use hairpin::math::minimum_snap::minimum_snap;
/// use nalgebra::Point3;
///
/// let corner = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [4.0, 4.0, 1.0]].map(Point3::from);
/// let curve = minimum_snap(&corner, &[2.0, 2.0])?;
/// assert_eq!((curve[0][0][0], curve[0][0][1]), (0.0, 0.0)); // at the start, at rest
/// let through = curve[1]; // by symmetry the corner is passed at 45°
/// assert!((through[0][0] - 4.0).abs() < 1e-9 && (through[0][1] - through[1][1]).abs() < 1e-9);
/// # Ok::<(), hairpin::math::minimum_snap::MinimumSnapError>(())
/// ```
///
/// # Errors
/// Wrong counts, times that are not positive, points that are not finite, times too unequal.
pub fn minimum_snap(points: &[Point3<f64>], times: &[f64]) -> Result<Vec<SegmentCoefficients>, MinimumSnapError> {
    check(points, times)?;
    // In units of the mean segment time all blocks are of comparable size.
    let unit = times.iter().sum::<f64>() / times.len() as f64;
    let scaled: Vec<f64> = times.iter().map(|t| t / unit).collect();
    let derivatives = solve(points, &scaled);
    let mut segments = Vec::with_capacity(times.len());
    for (k, &time) in scaled.iter().enumerate() {
        let mut segment = [[0.0; 8]; 3];
        for (axis, coefficients) in segment.iter_mut().enumerate() {
            let start = end_data(points[k][axis], &derivatives[k], axis, time);
            let end = end_data(points[k + 1][axis], &derivatives[k + 1], axis, time);
            *coefficients = hermite(&start, &end);
            let mut power = 1.0;
            for c in coefficients.iter_mut() {
                *c *= power;
                power /= times[k];
            }
        }
        segments.push(segment);
    }
    if segments.iter().flatten().flatten().all(|c| c.is_finite()) {
        Ok(segments)
    } else {
        Err(MinimumSnapError::IllConditioned)
    }
}

/// The polynomial on [0, 1] with the given value and first three derivatives at either end.
///
/// `start` and `end` are (p, p′, p″, p‴) with respect to σ ∈ [0, 1]: of a segment of T seconds (p, T v, T² a, T³ j).
/// Coefficients in powers of σ.
pub fn hermite(start: &[f64; 4], end: &[f64; 4]) -> [f64; 8] {
    let low = [start[0], start[1], start[2] / 2.0, start[3] / 6.0];
    // What the low orders leave undone at the far end.
    let r = [
        end[0] - low[0] - low[1] - low[2] - low[3],
        end[1] - low[1] - 2.0 * low[2] - 3.0 * low[3],
        end[2] - 2.0 * low[2] - 6.0 * low[3],
        end[3] - 6.0 * low[3],
    ];
    let high = HIGH_ORDERS.map(|row| row.iter().zip(&r).map(|(a, b)| a * b).sum::<f64>());
    [low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]]
}

/// Inverse of the values and first three derivatives of τ⁴ … τ⁷ at τ = 1.
pub(crate) const HIGH_ORDERS: [[f64; 4]; 4] = [
    [35.0, -15.0, 2.5, -1.0 / 6.0],
    [-84.0, 39.0, -7.0, 0.5],
    [70.0, -34.0, 6.5, -0.5],
    [-20.0, 10.0, -2.0, 1.0 / 6.0],
];

/// Velocity, acceleration, jerk (rows) per axis (columns) at one point.
type Derivatives = Matrix3<f64>;

fn check(points: &[Point3<f64>], times: &[f64]) -> Result<(), MinimumSnapError> {
    if points.len() < 2 || times.len() + 1 != points.len() {
        return Err(MinimumSnapError::Count { points: points.len(), times: times.len() });
    }
    if let Some(index) = points.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        return Err(MinimumSnapError::Point { index });
    }
    match times.iter().position(|t| !(t.is_finite() && *t > 0.0)) {
        Some(index) => Err(MinimumSnapError::Time { index, value: times[index] }),
        None => Ok(()),
    }
}

/// (p, T v, T² a, T³ j) of one axis: end data on the unit interval.
fn end_data(position: f64, derivatives: &Derivatives, axis: usize, time: f64) -> [f64; 4] {
    let d = derivatives.column(axis);
    [position, time * d[0], time * time * d[1], time * time * time * d[2]]
}

/// ∫₀¹ (p⁗)² as a quadratic form in the end data (value and three derivatives at 0, then at 1).
fn unit_cost() -> SMatrix<f64, 8, 8> {
    const FALLING: [f64; 4] = [24.0, 120.0, 360.0, 840.0];
    let gram = SMatrix::<f64, 4, 4>::from_fn(|i, j| FALLING[i] * FALLING[j] / (i + j + 1) as f64);
    let high = SMatrix::<f64, 4, 8>::from_fn(|row, column| {
        let mut data = [0.0; 8];
        data[column] = 1.0;
        hermite(&[data[0], data[1], data[2], data[3]], &[data[4], data[5], data[6], data[7]])[4 + row]
    });
    high.transpose() * gram * high
}

/// The derivatives at every point: zero at both ends, those of least cost in between.
fn solve(points: &[Point3<f64>], times: &[f64]) -> Vec<Derivatives> {
    let (unit_cost, n) = (unit_cost(), points.len());
    let costs: Vec<SMatrix<f64, 8, 8>> = times
        .iter()
        .map(|&t| {
            let scale = [1.0, t, t * t, t * t * t];
            unit_cost.map_with_location(|i, j, q| q * scale[i % 4] * scale[j % 4] / power(t, 7))
        })
        .collect();
    let mut derivatives = vec![Derivatives::zeros(); n];
    // Forward elimination over the interior points; `ahead[k]` and `known[k]` give d_k = known − ahead·d_{k+1}.
    let (mut ahead, mut known) = (vec![Matrix3::zeros(); n], vec![Derivatives::zeros(); n]);
    for k in 1..n - 1 {
        let (before, after) = (&costs[k - 1], &costs[k]);
        let mut diagonal: Matrix3<f64> = before.fixed_view::<3, 3>(5, 5) + after.fixed_view::<3, 3>(1, 1);
        let mut right = Derivatives::from_fn(|row, axis| {
            let (p, q, r) = (points[k - 1][axis], points[k][axis], points[k + 1][axis]);
            // A common shift costs nothing; taking it out keeps the digits.
            -(before[(5 + row, 0)] * (p - q) + after[(1 + row, 4)] * (r - q))
        });
        let to_previous: Matrix3<f64> = before.fixed_view::<3, 3>(5, 1).into_owned();
        if k > 1 {
            diagonal -= to_previous * ahead[k - 1];
            right -= to_previous * known[k - 1];
        }
        let lu = diagonal.lu();
        // A singular block can only come from overflow; NaN then reaches the caller's finiteness check.
        let nan = Matrix3::repeat(f64::NAN);
        ahead[k] = lu.solve(&after.fixed_view::<3, 3>(1, 5).into_owned()).unwrap_or(nan);
        known[k] = lu.solve(&right).unwrap_or(nan);
    }
    for k in (1..n - 1).rev() {
        derivatives[k] = if k == n - 2 { known[k] } else { known[k] - ahead[k] * derivatives[k + 1] };
    }
    derivatives
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{Stream, named_seed, stream};
    use rand::RngExt;

    fn derivative(c: &[f64; 8], t: f64, order: usize) -> f64 {
        (order..8).rev().fold(0.0, |value, i| value * t + c[i] * (0..order).map(|k| (i - k) as f64).product::<f64>())
    }

    /// ∫ (p⁗)² over all segments and axes, by 4-point Gauss-Legendre (exact to degree 7).
    fn cost(segments: &[SegmentCoefficients], times: &[f64]) -> f64 {
        let nodes =
            [(0.861_136_311_594_052_6, 0.347_854_845_137_453_9), (0.339_981_043_584_856_3, 0.652_145_154_862_546_1)];
        let mut sum = 0.0;
        for (segment, &t) in segments.iter().zip(times) {
            for c in segment {
                for (x, w) in nodes.iter().flat_map(|&(x, w)| [(x, w), (-x, w)]) {
                    sum += 0.5 * t * w * derivative(c, 0.5 * t * (1.0 + x), 4).powi(2);
                }
            }
        }
        sum
    }

    fn course(rng: &mut Stream, n: usize) -> (Vec<Point3<f64>>, Vec<f64>) {
        let points = (0..n).map(|_| Point3::from([0, 1, 2].map(|_| rng.random_range(0.0..30.0)))).collect();
        (points, (1..n).map(|_| rng.random_range(0.4..4.0)).collect())
    }

    #[test]
    fn one_segment_is_the_known_polynomial() {
        let [segment] = minimum_snap(&[Point3::origin(), Point3::new(1.0, -2.0, 0.0)], &[2.0]).unwrap()[..] else {
            panic!("one segment")
        };
        let unit = [0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0];
        for i in 0..8 {
            let expected = unit[i] / 2f64.powi(i as i32);
            assert!((segment[0][i] - expected).abs() < 1e-12 && (segment[1][i] + 2.0 * expected).abs() < 1e-12);
            assert_eq!(segment[2][i], 0.0);
        }
    }

    #[test]
    fn passes_the_points_smoothly_from_rest_to_rest() {
        for case in 0..100 {
            let mut rng = stream(named_seed(1, "minimum-snap", case));
            let n = rng.random_range(2..60);
            let (points, times) = course(&mut rng, n);
            let segments = minimum_snap(&points, &times).unwrap();
            for axis in 0..3 {
                for (k, &t) in times.iter().enumerate() {
                    assert!((derivative(&segments[k][axis], 0.0, 0) - points[k][axis]).abs() < 1e-9, "case {case}");
                    assert!((derivative(&segments[k][axis], t, 0) - points[k + 1][axis]).abs() < 1e-7, "case {case}");
                    // Optimality makes six derivatives continuous, two more than were asked for.
                    for order in 1..=6 {
                        let end = derivative(&segments[k][axis], t, order);
                        let next = match segments.get(k + 1) {
                            Some(next) => derivative(&next[axis], 0.0, order),
                            None if order <= 3 => 0.0,
                            None => continue,
                        };
                        let size = (0..8).map(|i| segments[k][axis][i].abs() * t.powi(i as i32)).sum::<f64>();
                        let scale = size / t.min(1.0).powi(order as i32);
                        assert!((end - next).abs() < 1e-7 * (1.0 + scale), "case {case} segment {k} order {order}");
                    }
                }
                assert!((1..4).all(|order| derivative(&segments[0][axis], 0.0, order).abs() < 1e-9));
            }
        }
    }

    #[test]
    fn no_perturbation_of_the_free_derivatives_is_cheaper() {
        for case in 0..50 {
            let mut rng = stream(named_seed(2, "minimum-snap", case));
            let (points, times) = course(&mut rng, 6);
            let best = minimum_snap(&points, &times).unwrap();
            let least = cost(&best, &times);
            let end = |c: &[f64; 8], t: f64| [0, 1, 2, 3].map(|order| derivative(c, t, order));
            for _ in 0..20 {
                let (k, axis) = (rng.random_range(1..5), rng.random_range(0..3));
                let mut data = end(&best[k][axis], 0.0);
                for d in &mut data[1..] {
                    *d += rng.random_range(-1.0..1.0);
                }
                let mut other = best.clone();
                for (segment, a, b) in
                    [(k - 1, end(&best[k - 1][axis], 0.0), data), (k, data, end(&best[k][axis], times[k]))]
                {
                    let t = times[segment];
                    let unit = |d: [f64; 4]| [d[0], d[1] * t, d[2] * t * t, d[3] * t * t * t];
                    let c = hermite(&unit(a), &unit(b));
                    other[segment][axis] = std::array::from_fn(|i| c[i] / t.powi(i as i32));
                }
                assert!(cost(&other, &times) > least, "case {case}");
            }
        }
    }

    #[test]
    fn refuses_what_has_no_solution() {
        let points = [Point3::origin(), Point3::new(1.0, 0.0, 0.0)];
        assert!(matches!(minimum_snap(&points[..1], &[]), Err(MinimumSnapError::Count { .. })));
        assert!(matches!(minimum_snap(&points, &[1.0, 1.0]), Err(MinimumSnapError::Count { .. })));
        assert!(matches!(minimum_snap(&points, &[0.0]), Err(MinimumSnapError::Time { .. })));
        assert!(matches!(minimum_snap(&points, &[f64::NAN]), Err(MinimumSnapError::Time { .. })));
        let bad = [Point3::origin(), Point3::new(f64::NAN, 0.0, 0.0)];
        assert!(matches!(minimum_snap(&bad, &[1.0]), Err(MinimumSnapError::Point { index: 1 })));
    }
}
