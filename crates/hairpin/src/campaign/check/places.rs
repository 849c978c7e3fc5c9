//! Whether places to keep out of lie where anything moves.
//!
//! A place that lies elsewhere is nearly always one of another frame or unit: it would keep nobody out, and all runs
//! would seem clear of it.

use super::Findings;
use crate::campaign::digits::number;
use crate::world::terrain::KeepOuts;

/// A place outside of all that can be driven or sailed keeps nobody out: its coordinates are another frame's.
///
/// Each must have a part within `low` … `high` (m), which is called `what`.
///
/// One mistake for each place that does not reach the box, with both extents in its words.
pub(in crate::campaign) fn check_places_within(
    places: &KeepOuts,
    [low, high]: [[f64; 2]; 2],
    what: &str,
    found: &mut Findings,
) {
    let bound = format!("at least in part {what}, {}, or left out; another frame, or another unit?", extent(low, high));
    for (index, place) in places.list().iter().enumerate() {
        let [least, most] = place.shape.bounds();
        let value = format!("`{}`, {}", place.name, extent(least, most));
        found.require(place.shape.reaches(low, high), &format!("world.keep_out[{index}]"), value, &bound);
    }
}

/// Both sides in m, from west to east and from south to north.
fn extent(low: [f64; 2], high: [f64; 2]) -> String {
    let side = |axis: usize| format!("{} … {}", number(Some(low[axis])), number(Some(high[axis])));
    format!("x {}, y {} m", side(0), side(1))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::world::terrain::{KeepOut, KeepOutShape};

    #[test]
    fn places_off_the_map_are_told_by_their_number() {
        let polygon = |x: f64| KeepOutShape::Polygon { points_m: vec![[x, 1.0], [x + 2.0, 1.0], [x, 3.0]] };
        let circle = |x: f64, radius_m| KeepOutShape::Circle { center_m: [x, x], radius_m };
        let shapes = [polygon(9.0), polygon(11.0), circle(11.0, 1.3), circle(11.0, 1.5), circle(500_000.0, 1.0)];
        let list = shapes.map(|shape| KeepOut { name: "rock".into(), shape });
        let mut found = Findings::default();
        let places = KeepOuts::new(list.into()).expect("places");
        check_places_within(&places, [[0.0; 2], [10.0; 2]], "on the map", &mut found);
        let told: Vec<String> = found.0.iter().map(ToString::to_string).collect();
        assert_eq!(
            found.0.iter().map(|one| one.key.as_str()).collect::<Vec<_>>(),
            ["world.keep_out[1]", "world.keep_out[2]", "world.keep_out[4]"]
        );
        assert!(
            told[0].contains("`rock`, x 11.00 … 13.00") && told[0].contains("on the map, x 0.00 … 10.00"),
            "{told:?}"
        );
    }
}
