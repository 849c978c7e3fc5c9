//! Places to keep out of as files have them: `keep_out = [{ name = "lander", circle = { center_m = [21.0, 18.5],
//! radius_m = 0.6 } }]`, or `polygon = { points_m = [[x, y], …] }`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::scenario::Mistake;
use crate::world::terrain::{KeepOut, KeepOutShape, KeepOuts};

/// One keep-out: exactly one of the shapes, x and y of the map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KeepOutSection {
    /// Name in reports; its number in the list if not given.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// A disc, such as a rock's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circle: Option<CircleSection>,
    /// A polygon.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polygon: Option<PolygonSection>,
}

/// `circle = { center_m, radius_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CircleSection {
    /// Centre.
    pub center_m: [f64; 2],
    /// Radius.
    pub radius_m: f64,
}

/// `polygon = { points_m }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PolygonSection {
    /// Corners, in turn, three or more; the last is joined to the first.
    pub points_m: Vec<[f64; 2]>,
}

/// The places of a list.
///
/// # Errors
/// `keep_out[i]`: a place without a shape or with two, numbers that are no place.
pub fn keep_outs(sections: &[KeepOutSection]) -> Result<KeepOuts, Mistake> {
    let mut list = Vec::with_capacity(sections.len());
    for (index, section) in sections.iter().enumerate() {
        let shape = match (&section.circle, &section.polygon) {
            (Some(circle), None) => KeepOutShape::Circle { center_m: circle.center_m, radius_m: circle.radius_m },
            (None, Some(polygon)) => KeepOutShape::Polygon { points_m: polygon.points_m.clone() },
            (circle, _) => {
                let value = if circle.is_some() { "circle and polygon" } else { "no shape" };
                return Err(Mistake {
                    key: format!("keep_out[{index}]"),
                    value: value.into(),
                    bound: "exactly one of circle, polygon".into(),
                });
            }
        };
        let name = if section.name.is_empty() { format!("keep-out {index}") } else { section.name.clone() };
        list.push(KeepOut { name, shape });
    }
    KeepOuts::new(list).map_err(|error| Mistake { key: error.field, value: error.value, bound: error.bound })
}
