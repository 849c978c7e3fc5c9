//! QGC WPL 110: a row an item, twelve fields with tabs between; the first row is home. It has no room for a comment.

use super::mission::{Mission, degrees, number};

/// What the files' names end with.
pub const ENDING: &str = ".waypoints";
/// The first line.
pub const HEAD: &str = "QGC WPL 110";

/// The text of a mission. What a `.plan` leaves to the vehicle is 0 here.
pub fn text(mission: &Mission) -> String {
    let home = &mission.home;
    let home = [degrees(home.lat_deg), degrees(home.lon_deg), number(home.alt_amsl_m)];
    let mut text = format!("{HEAD}\n0\t1\t0\t16\t0\t0\t0\t0\t{}\t1\n", home.join("\t"));
    for (index, item) in mission.items().iter().enumerate() {
        let [lat, lon, height] = item.place.unwrap_or_default();
        let numbers = item.numbers.map(|value| number(value.unwrap_or(0.0))).join("\t");
        text += &format!(
            "{}\t0\t{}\t{}\t{numbers}\t{}\t{}\t{}\t1\n",
            index + 1,
            item.frame,
            item.command,
            degrees(lat),
            degrees(lon),
            number(height)
        );
    }
    text
}
