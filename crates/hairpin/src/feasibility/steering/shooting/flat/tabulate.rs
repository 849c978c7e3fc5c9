//! The table of start values that the solver itself computes.

use super::forward::{self, Curve};
use super::settings::Settings;
use super::start_table::steering;
use crate::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use crate::trajectory::start_table::{
    APART, BEHIND, ENTRIES, NODES, NONE, StartTable, StartTableError, TURN, checked_steering,
};

impl StartTable {
    /// The arcs that the solver finds by itself within `bounds`, one for each node.
    ///
    /// Lengths in units of the least radius; only the left half plane, the right one being its mirror image. Entries
    /// are c₀, c₁, c₂, length and turn; nodes that only a chain reaches stay empty. One solve for each of 8976 nodes.
    ///
    /// # Errors
    /// [`StartTableError::Steering`] where `bounds` are no vehicle's.
    pub fn generate(bounds: &Curvatures) -> Result<Self, StartTableError> {
        let steering = checked_steering(steering(bounds))?;
        let unit = Curvatures { most: 1.0, most_rate: steering };
        let mut entries = vec![NONE; ENTRIES];
        for (index, entry) in entries.iter_mut().enumerate() {
            let query = Query { start_curvature: 0.0, goal: goal(index) };
            let settings = Settings { iterations: 40, ..Settings::default() };
            if let Some(Curve::Arc(ends, free)) = forward::best(&query, &unit, &settings) {
                let [c0, c1, c2] = free.shape;
                *entry = [c0, c1, c2, free.length, ends.turn].map(|value| value as f32);
            }
        }
        Self::new(steering, entries)
    }
}

/// The goal of a node, in radii.
///
/// Heading fastest, then y, then x.
fn goal(index: usize) -> Goal {
    let (heading, place) = (index % NODES[2], index / NODES[2]);
    let (row, column) = (place % NODES[1], place / NODES[1]);
    Goal {
        x: column as f64 * APART - BEHIND,
        y: row as f64 * APART,
        yaw: (heading as f64 - 0.5 * NODES[2] as f64) * TURN,
        curvature: 0.0,
    }
}
