//! An axis of the grid that motion is counted on.

use serde::{Deserialize, Serialize};

/// One axis of the grid.
///
/// `edges` rises and has one more entry than there are cells, at least two entries. `words`, where there are any, has
/// one for each cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// What is counted: `speed`.
    pub name: String,
    /// Its unit; empty where values are numbered.
    pub unit: String,
    /// Bounds of the cells, rising, one more than there are; what lies beyond belongs to the outermost.
    pub edges: Vec<f64>,
    /// Names of the cells, where these are no ranges.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub words: Vec<String>,
}

impl Axis {
    /// Cells of one width.
    pub(in crate::campaign) fn even(name: &str, unit: &str, from: f64, to: f64, cells: usize) -> Self {
        let edges = (0..=cells).map(|i| from + (to - from) * i as f64 / cells as f64).collect();
        Self { name: name.into(), unit: unit.into(), edges, words: Vec::new() }
    }

    /// Cells between `edges`.
    pub(in crate::campaign) fn of(name: &str, unit: &str, edges: &[f64]) -> Self {
        Self { name: name.into(), unit: unit.into(), edges: edges.to_vec(), words: Vec::new() }
    }

    /// Cells with names.
    pub(in crate::campaign) fn worded(name: &str, words: &[&str]) -> Self {
        let edges = (0..=words.len()).map(|i| i as f64).collect();
        Self { name: name.into(), unit: String::new(), edges, words: words.iter().map(|word| (*word).into()).collect() }
    }

    /// `1.2 … 2.4`, or the word of cell number `place`.
    ///
    /// # Panics
    /// If an axis without words has no cell number `place`.
    pub fn in_words(&self, place: usize) -> String {
        match self.words.get(place) {
            Some(word) => word.clone(),
            None => format!("{} … {}", rounded(self.edges[place]), rounded(self.edges[place + 1])),
        }
    }

    /// Cells along it.
    ///
    /// At least 1.
    pub fn cells(&self) -> usize {
        self.edges.len() - 1
    }

    /// The cell that `value` lies in.
    ///
    /// Half-open from below: `edges[c]` ≤ value < `edges[c + 1]`; what lies beyond, and NaN, goes to an outermost
    /// cell.
    pub(in crate::campaign) fn cell(&self, value: f64) -> usize {
        self.edges.partition_point(|edge| *edge <= value).saturating_sub(1).min(self.cells() - 1)
    }
}

/// To three decimals, without zeros behind.
fn rounded(edge: f64) -> f64 {
    (1e3 * edge).round() / 1e3
}
