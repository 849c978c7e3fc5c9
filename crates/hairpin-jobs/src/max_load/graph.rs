//! The graph that was asked about, in the unit of its file.

use std::path::Path;

use hairpin::search::heaviest::Arcs;
use hairpin_formats::costs::{self, Costs};
use serde_json::Value;

use crate::Problem;

/// Costs as whole numbers, and what they stand for.
pub struct Graph {
    /// The arcs with their costs.
    pub arcs: Arcs,
    costs: Costs,
}

impl Graph {
    /// Reads a table of costs.
    ///
    /// # Errors
    /// The file cannot be read, or is none.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        let costs = costs::read(path).map_err(Problem::input)?;
        let arcs = Arcs::new(costs.points, &costs.costs);
        let arcs = arcs.map_err(|error| {
            let scale = costs.scale();
            let scaled = if scale > 1 { format!(" (costs × {scale})") } else { String::new() };
            Problem::of_file(path, format!("{error}{scaled}"))
        })?;
        Ok(Self { arcs, costs })
    }

    /// The power of ten that makes all costs whole.
    pub fn scale(&self) -> i64 {
        self.costs.scale()
    }

    /// A cost as people read it.
    pub fn text(&self, cost: i64) -> String {
        self.costs.text(cost)
    }

    /// A cost as machines read it.
    pub fn value(&self, cost: i64) -> Value {
        if self.scale() == 1 {
            return cost.into();
        }
        // The nearest number: JSON readers have no decimals.
        self.text(cost).parse::<f64>().map_or(Value::Null, Value::from)
    }

    /// The smallest whole cost that is at least `text`.
    pub(super) fn at_least(&self, text: &str) -> Result<i64, Problem> {
        let least = self.costs.at_least(text);
        least.ok_or_else(|| Problem::input(format!("--min-cost `{text}`, must be a decimal number ≥ 0 within 64 bits")))
    }
}
