//! Places to keep out of as TOML, the list that scenarios have under `[world]`:
//! `keep_out = [{ name = "lander", circle = { center_m = [21.0, 18.5], radius_m = 0.6 } }]`, or `polygon = { points_m = [[x, y], …] }`.

use hairpin::world::WorldError;
use hairpin::world::terrain::{KeepOut, KeepOutShape, KeepOuts};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// One place: exactly one of the shapes, x and y of the map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KeepOutSection {
    /// Name in reports; its number in the list if not given.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// All points within a radius, such as a rock's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circle: Option<CircleSection>,
    /// The inside of a closed line.
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
    /// Corners, three or more, the last joined to the first.
    pub points_m: Vec<[f64; 2]>,
}

/// A file of nothing else.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    keep_out: Vec<KeepOutSection>,
}

/// Why a text is no list of places.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum KeepOutError {
    /// Its keys or values are not those of a list.
    #[error("{0}")]
    Text(String),
    /// A place has none of the shapes, or two.
    #[error("keep_out[{index}]: must have either circle or polygon")]
    Shape {
        /// Which one, from 0.
        index: usize,
    },
    /// Numbers that are no place.
    #[error(transparent)]
    Place(#[from] WorldError),
}

/// The places of a TOML text.
///
/// # Errors
/// Unknown keys, wrong types, a place without a shape or with two, numbers that are no place.
pub fn read_keep_outs(text: &str) -> Result<KeepOuts, KeepOutError> {
    let file: File = toml::from_str(text).map_err(|error| KeepOutError::Text(error.to_string()))?;
    keep_outs(&file.keep_out)
}

/// The places of a list.
///
/// # Errors
/// A place without a shape or with two, numbers that are no place.
pub fn keep_outs(sections: &[KeepOutSection]) -> Result<KeepOuts, KeepOutError> {
    let place = |(index, section): (usize, &KeepOutSection)| {
        let shape = match (&section.circle, &section.polygon) {
            (Some(CircleSection { center_m, radius_m }), None) => {
                KeepOutShape::Circle { center_m: *center_m, radius_m: *radius_m }
            }
            (None, Some(PolygonSection { points_m })) => KeepOutShape::Polygon { points_m: points_m.clone() },
            _ => return Err(KeepOutError::Shape { index }),
        };
        let name = if section.name.is_empty() { format!("keep_out[{index}]") } else { section.name.clone() };
        Ok(KeepOut { name, shape })
    };
    let list: Result<Vec<KeepOut>, KeepOutError> = sections.iter().enumerate().map(place).collect();
    Ok(KeepOuts::new(list?)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_and_polygons_are_read_and_named() {
        let text = "keep_out = [\n  { name = \"lander\", circle = { center_m = [21.0, 18.5], radius_m = 0.6 } },\n  \
                    { polygon = { points_m = [[0, 0], [2.0, 0.0], [2.0, 2.0]] } },\n]\n";
        let places = read_keep_outs(text).unwrap();
        let names: Vec<&str> = places.list().iter().map(|place| place.name.as_str()).collect();
        assert_eq!(names, ["lander", "keep_out[1]"]);
        assert!((places.distance(21.0, 19.5) - 0.4).abs() < 1e-12 && places.distance(1.5, 0.5) < 0.0);
        assert!(read_keep_outs("").unwrap().is_empty());
    }

    #[test]
    fn what_is_no_list_is_refused_by_name() {
        for (text, told) in [
            ("keepout = []", "keepout"),
            ("keep_out = [{ name = \"a\" }]", "keep_out[0]: must have either circle or polygon"),
            (
                "keep_out = [{ circle = { center_m = [0, 0], radius_m = 1 }, polygon = { points_m = [] } }]",
                "keep_out[0]: must have either",
            ),
            ("keep_out = [{ circle = { center_m = [0, 0], radius = 1 } }]", "radius"),
            ("keep_out = [{ circle = { center_m = [0, 0], radius_m = -1 } }]", "keep_out[0].circle.radius_m = -1"),
            ("keep_out = [{ polygon = { points_m = [[0, 0], [1, 0]] } }]", "keep_out[0].polygon.points_m = 2 points"),
        ] {
            let error = read_keep_outs(text).unwrap_err().to_string();
            assert!(error.contains(told), "{text}: {error}");
        }
    }
}
