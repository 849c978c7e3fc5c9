//! One classical Runge-Kutta step, which every simulation and every sampled reach set takes.
//!
//! One step method with a fixed step, and no error control: a run must have the same steps on every machine, and how
//! large they may be is settled by tests against halved steps. The proof (`verification`) integrates by collocation of
//! its own and never by this.

use nalgebra::SVector;

/// A fixed-size real vector: all that integrators and planners ask of states and controls.
///
/// Implemented for `SVector<f64, N>` alone; there is no reason to implement it for anything else.
pub trait Vector: Copy + Send + Sync + 'static {
    /// Number of components.
    const LEN: usize;
    /// The zero vector.
    fn zero() -> Self;
    /// `self + factor·other`.
    fn add_scaled(self, other: &Self, factor: f64) -> Self;
    /// The components, in order.
    fn as_slice(&self) -> &[f64];
    /// The components, to be written.
    fn as_mut_slice(&mut self) -> &mut [f64];
}

impl<const N: usize> Vector for SVector<f64, N> {
    const LEN: usize = N;
    fn zero() -> Self {
        Self::zeros()
    }
    fn add_scaled(self, other: &Self, factor: f64) -> Self {
        self + other * factor
    }
    fn as_slice(&self) -> &[f64] {
        self.as_slice()
    }
    fn as_mut_slice(&mut self) -> &mut [f64] {
        self.as_mut_slice()
    }
}

/// One step of length `h` (s) of the classical fourth-order Runge-Kutta method for x' = f(x).
///
/// Controls and time enter through the closure: `rk4_step(|x| robot.derivative(x, &u), &x, h)`. States on a manifold
/// (unit quaternions) are to be normalised afterwards.
pub fn rk4_step<V: Vector>(f: impl Fn(&V) -> V, x: &V, h: f64) -> V {
    let k1 = f(x);
    let k2 = f(&x.add_scaled(&k1, 0.5 * h));
    let k3 = f(&x.add_scaled(&k2, 0.5 * h));
    let k4 = f(&x.add_scaled(&k3, h));
    let inner = k2.add_scaled(&k3, 1.0);
    x.add_scaled(&k1, h / 6.0).add_scaled(&inner, h / 3.0).add_scaled(&k4, h / 6.0)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use nalgebra::Vector2;

    /// The harmonic oscillator x'' = −x from (1, 0): the error over 2 s must fall by 2⁴ when the step is halved.
    #[test]
    fn the_order_is_four() {
        let error = |steps: usize| {
            let h = 2.0 / steps as f64;
            let end = (0..steps).fold(Vector2::new(1.0, 0.0), |x, _| rk4_step(|x| Vector2::new(x[1], -x[0]), &x, h));
            (end - Vector2::new(2f64.cos(), -2f64.sin())).norm()
        };
        for steps in [16, 32, 64] {
            let order = (error(steps) / error(2 * steps)).log2();
            assert!((order - 4.0).abs() < 0.1, "order {order} at {steps} steps");
        }
    }

    #[test]
    fn a_cubic_in_time_is_integrated_exactly() {
        // t' = 1, y' = t³: the quadrature part of the method is Simpson's rule.
        let end = rk4_step(|x| Vector2::new(1.0, x[0].powi(3)), &Vector2::new(1.0, 0.0), 2.0);
        assert!((end[1] - 20.0).abs() < 1e-12);
    }
}
