//! `generate.direction_deg`: one direction of travel, or the range that waypoints draw theirs from.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Direction of travel in the body, deg, left positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum DirectionDeg {
    /// The same all along.
    All(f64),
    /// `[least, greatest]` at waypoints.
    Between([f64; 2]),
}

impl DirectionDeg {
    /// Least and greatest, deg.
    pub fn bounds(&self) -> [f64; 2] {
        match *self {
            Self::All(direction) => [direction; 2],
            Self::Between(bounds) => bounds,
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn it_is_a_number_or_two() {
        let read = |text: &str| serde_json::from_str::<DirectionDeg>(text);
        for (text, bounds) in [("20", [20.0, 20.0]), ("-7.5", [-7.5, -7.5]), ("[-30, 30.5]", [-30.0, 30.5])] {
            let direction = read(text).expect(text);
            assert_eq!(direction.bounds(), bounds);
            let back = serde_json::to_string(&direction).expect("numbers");
            assert_eq!(read(&back).expect(&back), direction);
        }
        for wrong in ["[1]", "[1, 2, 3]", "\"left\"", "[1, \"a\"]", "{}"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
