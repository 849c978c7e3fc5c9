//! Waypoints on Earth as CSV, one file a case: `lat_deg,lon_deg,alt_amsl_m,relative_alt_m`, start first.

use std::path::Path;

use nalgebra::Point3;

use crate::atomic::{self, WriteError};
use crate::placement::Placement;

/// What the files' names end with.
pub const ENDING: &str = ".geodetic.csv";
/// The columns that say where a waypoint is.
pub const PLACE: [&str; 3] = ["lat_deg", "lon_deg", "alt_amsl_m"];

/// The text of a list of waypoints of the world's frame, m. Ten decimals of a degree are 0.01 mm; `relative_alt_m` is
/// above the world's origin.
///
/// # Errors
/// A waypoint that the world's plane cannot show.
pub fn text(world: &Placement, waypoints: &[Point3<f64>]) -> Result<String, String> {
    let mut text = "lat_deg,lon_deg,alt_amsl_m,relative_alt_m\n".to_owned();
    for point in waypoints {
        let place = world.geodetic(point)?;
        let relative = world.relative_altitude(&place);
        text += &format!("{:.10},{:.10},{:.5},{relative:.5}\n", place.lat_deg, place.lon_deg, place.alt_amsl_m);
    }
    Ok(text)
}

/// Writes [`text`] of waypoints that could be placed.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, text: &str) -> Result<(), WriteError> {
    atomic::write(path, text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Geodetic;
    use hairpin::campaign::scenario::Origin;

    #[test]
    fn waypoints_come_back_from_their_file() {
        let cage = Placement::by_origin(&Origin {
            lat_deg: 47.3977,
            lon_deg: 8.5456,
            alt_amsl_m: 488.0,
            x_axis_heading_deg: 73.5,
        });
        let waypoints = [Point3::new(3.0, 4.0, 5.0), Point3::new(-21.5, 12.25, 0.5)];
        let text = text(&cage, &waypoints).unwrap();
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("lat_deg,lon_deg,alt_amsl_m,relative_alt_m"));
        for (line, waypoint) in lines.zip(&waypoints) {
            let cells: Vec<&str> = line.split(',').collect();
            assert!(cells[..2].iter().all(|cell| cell.split('.').nth(1).is_some_and(|decimals| decimals.len() >= 8)));
            let [lat_deg, lon_deg, alt_amsl_m, relative] = [0, 1, 2, 3].map(|i| cells[i].parse::<f64>().unwrap());
            let back = cage.from_geodetic(&Geodetic { lat_deg, lon_deg, alt_amsl_m }).unwrap();
            assert!((back - waypoint).norm() < 5e-5, "{back}");
            assert!((relative - waypoint.z).abs() < 1e-3 && (alt_amsl_m - 488.0 - relative).abs() < 2e-5);
        }
        assert_eq!(text.lines().count(), 3);
    }
}
