//! `[world]`: the waters, where to keep out of, and their current.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::scenario::{KeepOutSection, Mistake, Origin, keep_outs};
use crate::world::terrain::KeepOuts;

/// `[world]`: m, x east, y north, origin at the south-western corner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WatersSection {
    /// Edge lengths, east and north.
    pub size_m: [f64; 2],
    /// Waypoints and planned paths stay this far inside.
    #[serde(default)]
    pub keep_in_margin_m: f64,
    /// Islands, piers, buoys: where the hull's disc must not come.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub keep_out: Vec<KeepOutSection>,
    /// Velocity of the water, east and north; still if not given. Plans know it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub current_m_s: Option<[f64; 2]>,
    /// Where on Earth the waters lie: used by geodetic exports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
}

impl WatersSection {
    /// Velocity of the water, m/s.
    ///
    /// (0, 0) where none is given.
    pub(in crate::campaign::boat) fn current(&self) -> [f64; 2] {
        self.current_m_s.unwrap_or_default()
    }

    /// The places of `keep_out`.
    ///
    /// # Errors
    /// The key that is out of bounds.
    pub(in crate::campaign::boat) fn keep_outs(&self) -> Result<KeepOuts, Mistake> {
        keep_outs(&self.keep_out).map_err(|mistake| Mistake { key: format!("world.{}", mistake.key), ..mistake })
    }
}
