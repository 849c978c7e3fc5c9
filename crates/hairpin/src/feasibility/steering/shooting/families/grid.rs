//! A family on a drive, tabulated where it is integrated and where its bounds are looked at.
//!
//! The heading at a node is L p·I with I the integral of the basis up to it, so that one pass of multiplications gives
//! position and all derivatives without integrating again. Made once for a family, a clock and a length; parameters
//! change, the table does not.

use super::basis::{Basis, MOST, Row};
use super::clock::Clock;
use crate::math::quadrature::Gauss;

/// Points a panel.
const POINTS: usize = 8;
/// Panels at most; without kinks and knots there are [`EVEN`].
const PANELS: usize = 24;
const EVEN: f64 = 16.0;

/// One place of a drive, by the share σ of its metres.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    /// Weight of ∫ … dσ; 0 where it is only looked at.
    pub(super) weight: f64,
    /// σ.
    pub(super) share: f64,
    /// Bᵢ.
    pub(super) value: Row,
    /// dBᵢ/dσ.
    pub(super) slope: Row,
    /// ∫₀ Bᵢ dσ.
    pub(super) integral: Row,
}

/// The table.
///
/// A fixed table on the stack: [`PANELS`] panels of 8 nodes.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    /// The first `len` of them are meant.
    nodes: [Node; POINTS * PANELS],
    len: usize,
    /// Beginning and end.
    pub(super) ends: [Node; 2],
    /// dBᵢ/du there.
    pub(super) end_slopes: [Row; 2],
    /// Whether the vehicle stands there and the controls go on with time.
    pub(super) rests: [bool; 2],
    /// Parameters.
    pub(super) count: usize,
}

impl Grid {
    /// Panels of Gauss-Legendre nodes between all places where family or clock have a kink, about [`EVEN`] panels over
    /// the whole, so that every panel's integrand is smooth.
    ///
    /// Weights sum to 1. More than 24 panels would be left out by [`Self::add_panel`]; knots and kinks together make
    /// fewer.
    pub(super) fn new(basis: &Basis, clock: &Clock) -> Self {
        let empty = Node { weight: 0.0, share: 0.0, value: [0.0; MOST], slope: [0.0; MOST], integral: [0.0; MOST] };
        let rests = clock.rests();
        let mut grid = Self {
            nodes: [empty; POINTS * PANELS],
            len: 0,
            ends: [empty; 2],
            end_slopes: [[0.0; MOST]; 2],
            rests,
            count: basis.count(),
        };
        let mut integral = [0.0; MOST];
        let mut from = 0.0;
        let kinks = clock.kinks();
        let stops = basis.breaks().iter().chain(kinks.iter().filter(|kink| **kink > 1e-9 && **kink < 1.0 - 1e-9));
        for &to in stops.chain(&[1.0]) {
            let panels = (EVEN * (to - from)).round().max(1.0);
            let width = (to - from) / panels;
            for panel in 0..panels as usize {
                grid.add_panel(basis, clock, from + panel as f64 * width, width, &mut integral);
            }
            from = to;
        }
        for (index, u) in [0.0, 1.0].into_iter().enumerate() {
            let (value, by_u) = basis.at(u);
            let pace = clock.pace(u);
            let slope = if rests[index] { [0.0; MOST] } else { by_u.map(|slope| slope / pace) };
            let integral = if index == 0 { [0.0; MOST] } else { integral };
            grid.ends[index] = Node { weight: 0.0, share: u, value, slope, integral };
            grid.end_slopes[index] = by_u;
        }
        grid
    }

    /// Nodes of one panel: weight of dσ = pace du, value B, slope dB/dσ = B_u / pace and the integral of B dσ from the
    /// drive's start to the node, by the rule that integrates the panel's interpolating polynomial up to each node.
    /// `integral` becomes that at the panel's end.
    ///
    /// Gauss' eight points integrate polynomials of order 15 exactly, their partial integrals those of order 7.
    fn add_panel(&mut self, basis: &Basis, clock: &Clock, from: f64, width: f64, integral: &mut Row) {
        if self.len + POINTS > self.nodes.len() {
            return;
        }
        let rule = Gauss::<POINTS>::RULE;
        let panel = &mut self.nodes[self.len..self.len + POINTS];
        let mut by_u = [[0.0; MOST]; POINTS];
        for ((node, by_u), (at, weight)) in panel.iter_mut().zip(&mut by_u).zip(rule.nodes.iter().zip(&rule.weights)) {
            let u = from + at * width;
            let pace = clock.pace(u);
            let (value, slope) = basis.at(u);
            *by_u = value.map(|b| b * pace * width);
            *node = Node {
                weight: weight * pace * width,
                share: clock.share(u),
                value,
                slope: slope.map(|slope| slope / pace.max(1e-12)),
                integral: *integral,
            };
        }
        for (node, row) in panel.iter_mut().zip(&PARTIAL) {
            for (by_u, weight) in by_u.iter().zip(row) {
                for (sum, value) in node.integral.iter_mut().zip(by_u) {
                    *sum += weight * value;
                }
            }
        }
        for (by_u, weight) in by_u.iter().zip(&rule.weights) {
            for (sum, value) in integral.iter_mut().zip(by_u) {
                *sum += weight * value;
            }
        }
        self.len += POINTS;
    }

    /// The nodes, in their order.
    ///
    /// σ rises along them.
    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes[..self.len]
    }
}

/// `A_jk = ∫₀^{c_j} ℓ_k dt` of Lagrange's polynomials ℓ through Gauss' points c: integrals from a panel's beginning.
const PARTIAL: [[f64; POINTS]; POINTS] = partial();

/// With `ℓ_k = w_k Σ_n (2n + 1) P_n(x_k) P_n`, x = 2c − 1, and `∫ P_n dx = (P_{n+1} − P_{n−1})/(2n + 1)`.
const fn partial() -> [[f64; POINTS]; POINTS] {
    let rule = Gauss::<POINTS>::RULE;
    let mut tables = [[0.0; POINTS + 1]; POINTS];
    let mut j = 0;
    while j < POINTS {
        let x = 2.0 * rule.nodes[j] - 1.0;
        tables[j][0] = 1.0;
        tables[j][1] = x;
        let mut n = 2;
        while n <= POINTS {
            let m = n as f64;
            tables[j][n] = ((2.0 * m - 1.0) * x * tables[j][n - 1] - (m - 1.0) * tables[j][n - 2]) / m;
            n += 1;
        }
        j += 1;
    }
    let mut partial = [[0.0; POINTS]; POINTS];
    j = 0;
    while j < POINTS {
        let mut k = 0;
        while k < POINTS {
            let mut sum = 0.5 * (tables[j][1] + 1.0);
            let mut n = 1;
            while n < POINTS {
                sum += 0.5 * tables[k][n] * (tables[j][n + 1] - tables[j][n - 1]);
                n += 1;
            }
            partial[j][k] = rule.weights[k] * sum;
            k += 1;
        }
        j += 1;
    }
    partial
}
