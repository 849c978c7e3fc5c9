//! Start values by table: arcs to goals on a grid, computed once for a vehicle, as the rover generators of 2006 looked
//! theirs up.
//!
//! Lengths are in units of the tightest circle, so that one table serves all vehicles with the same most_rate/most²:
//! what steering takes of that circle. Goals to the right are the mirror images of those to the left, so that half of
//! the plane is enough. The ends' curvatures are zero in the table; of others the mean heading is taken care of. Where
//! no arc keeps the bounds the entry says so.
//!
//! ```text
//! entry (17 i + j) · 16 + k:  x = −4 + 0.5 i (i = 0 … 32),  y = 0.5 j (j = 0 … 16),  ψ = −π + 2πk/16 (k = 0 … 15)
//! ```
//!
//! x, y in radii 1/most of the tightest circle, in the start's frame (x forward, y left). Single precision is enough:
//! what a table gives is where iterations begin, never an answer.

use thiserror::Error;

/// Goals along x, along y and of headings.
pub const NODES: [usize; 3] = [33, 17, 16];

/// The least x, and the distance between nodes, in radii.
pub(crate) const BEHIND: f64 = 4.0;
pub(crate) const APART: f64 = 0.5;

/// Between headings, rad; the first is −π.
pub(crate) const TURN: f64 = std::f64::consts::TAU / NODES[2] as f64;

/// c₀, c₁, c₂ (rad), length in radii, turn (rad); [`NONE`] where there is no arc.
pub type Entry = [f32; 5];

/// No arc.
pub const NONE: Entry = [0.0; 5];

/// Entries of a whole table.
pub const ENTRIES: usize = NODES[0] * NODES[1] * NODES[2];

/// A table of arcs; 180 kB.
///
/// Saves nothing over Dubins' words (docs/rover-generator.md, "Start values"), and is therefore off; kept since the
/// source's user guide has one.
///
/// `entries` has [`ENTRIES`] = 33 · 17 · 16 = 8976 rows of five single-precision numbers.
#[derive(Clone, PartialEq)]
pub struct StartTable {
    steering: f64,
    entries: Vec<Entry>,
}

impl std::fmt::Debug for StartTable {
    /// Without its numbers.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("StartTable").field("steering", &self.steering).finish_non_exhaustive()
    }
}

/// Why numbers are no table.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum StartTableError {
    /// Another number of entries than [`ENTRIES`].
    #[error("{found} entries: must be {ENTRIES}")]
    Count {
        /// Entries given.
        found: usize,
    },
    /// A number that no arc has.
    #[error("entry {entry}, {field} = {value}: must be {bound}")]
    Entry {
        /// Which entry, from 0; headings go first, then y, then x.
        entry: usize,
        /// The number's name.
        field: &'static str,
        /// Its value.
        value: f32,
        /// What it must be.
        bound: &'static str,
    },
    /// most_rate/most² that no vehicle has.
    #[error("steering = {value}: must be finite and from 1e-6 to 1e6")]
    Steering {
        /// The value.
        value: f64,
    },
}

impl StartTable {
    /// A table that was written: most_rate/most², and the entries in the order of [`Self::entries`].
    ///
    /// # Errors
    /// [`StartTableError`]: another number of entries, numbers that are no arc's.
    pub fn new(steering: f64, entries: Vec<Entry>) -> Result<Self, StartTableError> {
        if entries.len() != ENTRIES {
            return Err(StartTableError::Count { found: entries.len() });
        }
        for (index, entry) in entries.iter().enumerate() {
            let bounded = [
                ("c0", entry[0], 1e4, "finite and within ±10000"),
                ("c1", entry[1], 1e4, "finite and within ±10000"),
                ("c2", entry[2], 1e4, "finite and within ±10000"),
                ("turn", entry[4], 20.0, "finite and within ±20 rad"),
            ];
            let wrong = |field, value, bound| StartTableError::Entry { entry: index, field, value, bound };
            if let Some((field, value, _, bound)) =
                bounded.into_iter().find(|(_, value, most, _)| value.is_nan() || value.abs() > *most)
            {
                return Err(wrong(field, value, bound));
            }
            if !(0.0..=100.0).contains(&entry[3]) {
                return Err(wrong("length", entry[3], "from 0 to 100 radii"));
            }
        }
        Ok(Self { steering: checked_steering(steering)?, entries })
    }

    /// most_rate/most² of the vehicles that it is for.
    pub fn steering(&self) -> f64 {
        self.steering
    }

    /// Its entries: headings from −π, then y from 0, then x from −4 radii.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }
}

/// most_rate/most² that a vehicle may have.
///
/// # Errors
/// [`StartTableError::Steering`].
pub(crate) fn checked_steering(value: f64) -> Result<f64, StartTableError> {
    if (1e-6..=1e6).contains(&value) { Ok(value) } else { Err(StartTableError::Steering { value }) }
}
