//! Start values looked up in a table of arcs.

use super::arc::Free;
use super::ends::Ends;
use crate::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use crate::trajectory::start_table::{APART, BEHIND, NODES, StartTable, TURN};

/// Lengths of neighbours that are of one kind differ by less than this, in radii.
const ALIKE: f64 = 1.5;

/// most_rate/most²: how fast the bend may change, in units of the tightest circle.
///
/// Without unit: 1 means that the curvature comes to its bound along one least radius.
pub fn steering(bounds: &Curvatures) -> f64 {
    bounds.most_rate / (bounds.most * bounds.most)
}

impl StartTable {
    /// The start value for `query`, which leans to the left: between the eight arcs around its goal where they are of
    /// one kind, else the nearest; `None` beyond the grid and where there is no arc.
    ///
    /// Trilinear in x, y and heading, all in units of the least radius. An arc is of another kind where its length
    /// differs by 1.5 radii or more or its turn by two steps of the heading, and its corner then counts as the nearest
    /// arc itself. Bends at the ends, which the table does not have, are made up for in c₀; c₁ and c₂ are left.
    pub(super) fn start(&self, query: &Query, bounds: &Curvatures) -> Option<(Ends, Free)> {
        let Goal { x, y, yaw, .. } = query.goal;
        let place = [(x * bounds.most + BEHIND) / APART, y * bounds.most / APART];
        let heading = libm::remainder(yaw, std::f64::consts::TAU) / TURN + 0.5 * NODES[2] as f64;
        let inside = |at: f64, nodes: usize| at >= 0.0 && at <= (nodes - 1) as f64;
        if !(inside(place[0], NODES[0]) && inside(place[1], NODES[1])) {
            return None;
        }
        let at = [place[0], place[1], heading];
        let low = [(at[0] as usize).min(NODES[0] - 2), (at[1] as usize).min(NODES[1] - 2), at[2] as usize];
        let share = [at[0] - low[0] as f64, at[1] - low[1] as f64, at[2] - low[2] as f64];
        let entry = |corner: usize| {
            let [i, j, k] = [corner & 1, corner >> 1 & 1, corner >> 2];
            let turned = low[2] + k;
            // Around past π the same arc has turned as far; its number is what it is.
            let index = turned % NODES[2] + NODES[2] * ((low[1] + j) + NODES[1] * (low[0] + i));
            self.entries()[index].map(f64::from)
        };
        let nearest = (0..3).fold(0, |corner, axis| corner | usize::from(share[axis] >= 0.5) << axis);
        let first = entry(nearest);
        if first[3] <= 0.0 {
            return None;
        }
        let mut sum = [0.0; 5];
        for corner in 0..8 {
            let weight = (0..3).fold(1.0, |weight, axis| {
                weight * if corner >> axis & 1 == 1 { share[axis] } else { 1.0 - share[axis] }
            });
            let other = entry(corner);
            let alike =
                other[3] > 0.0 && (other[3] - first[3]).abs() < ALIKE && (other[4] - first[4]).abs() < 2.0 * TURN;
            let used = if alike { other } else { first };
            for (sum, value) in sum.iter_mut().zip(used) {
                *sum += weight * value;
            }
        }
        let whole = ((sum[4] - yaw) / std::f64::consts::TAU).round();
        let ends = Ends {
            x,
            y,
            turn: yaw + whole * std::f64::consts::TAU,
            start: query.start_curvature,
            end: query.goal.curvature,
        };
        let length = sum[3] / bounds.most;
        // Ends that are bent change the mean heading by L(κ₀ − κ_f)/12, which c₀/60 takes back.
        let bent = 5.0 * length * (ends.start - ends.end);
        Some((ends, Free { shape: [sum[0] - bent, sum[1], sum[2]], length }))
    }
}
