//! Files of places to keep out of: TOML with the list that scenarios have under `[world]`.

use hairpin::campaign::scenario::{KeepOutSection, Mistake, keep_outs};
use serde::Deserialize;
use thiserror::Error;

use crate::bounds::check_values;

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
    /// Numbers that are no place.
    #[error(transparent)]
    Place(#[from] Mistake),
}

/// The places of a TOML text, each of them one: [`keep_outs`] makes them ready for use, with others or without.
///
/// # Errors
/// Unknown keys, wrong types, a place without a shape or with two, numbers that are no place.
pub fn read_keep_outs(text: &str) -> Result<Vec<KeepOutSection>, KeepOutError> {
    check_values(text).map_err(KeepOutError::Text)?;
    let file: File = toml::from_str(text).map_err(|error| KeepOutError::Text(error.to_string()))?;
    keep_outs(&file.keep_out)?;
    Ok(file.keep_out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_and_polygons_are_read_and_named() {
        let text = "keep_out = [\n  { name = \"lander\", circle = { center_m = [21.0, 18.5], radius_m = 0.6 } },\n  \
                    { polygon = { points_m = [[0, 0], [2.0, 0.0], [2.0, 2.0]] } },\n]\n";
        let places = keep_outs(&read_keep_outs(text).unwrap()).unwrap();
        let names: Vec<&str> = places.list().iter().map(|place| place.name.as_str()).collect();
        assert_eq!(names, ["lander", "keep-out 1"]);
        assert!((places.distance(21.0, 19.5) - 0.4).abs() < 1e-12 && places.distance(1.5, 0.5) < 0.0);
        assert!(read_keep_outs("").unwrap().is_empty());
    }

    #[test]
    fn what_is_no_list_is_refused_by_name() {
        for (text, told) in [
            ("keepout = []", "keepout"),
            ("keep_out = [{ name = \"a\" }]", "keep_out[0] = no shape: must be exactly one of circle, polygon"),
            (
                "keep_out = [{ circle = { center_m = [0, 0], radius_m = 1 }, polygon = { points_m = [] } }]",
                "keep_out[0] = circle and polygon: must be exactly one",
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
