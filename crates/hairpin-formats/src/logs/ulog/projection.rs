//! PX4's local position is a projection of the globe onto a plane, not metres along the ground: positions and places
//! on Earth meet only if it is undone. Its sphere of 6371 km is 0.3 % too small for east and west at 47° north, 14 cm
//! in 50 m.

use hairpin::campaign::scenario::Origin;
use nalgebra::Point3;

use crate::frames::{Cage, Geodetic};

/// `CONSTANTS_RADIUS_OF_EARTH` of PX4's `lib/geo`, m.
const RADIUS: f64 = 6_371_000.0;

/// The plane tangent to WGS 84 at a place: east, north, up.
pub(super) fn tangent(place: &Geodetic) -> Cage {
    Cage::new(&Origin {
        lat_deg: place.lat_deg,
        lon_deg: place.lon_deg,
        alt_amsl_m: place.alt_amsl_m,
        x_axis_heading_deg: 90.0,
    })
}

/// Where on Earth PX4 says a local position is, of axes east, north, up: azimuthal equidistant about `reference`, on a
/// sphere (Snyder, Map Projections: A Working Manual, USGS 1987, equations 20-14 and 20-15).
pub(super) fn place(reference: &Geodetic, local: &Point3<f64>) -> Geodetic {
    let (north, east) = (local.y / RADIUS, local.x / RADIUS);
    let (sin_lat, cos_lat) = libm::sincos(reference.lat_deg.to_radians());
    let angle = libm::hypot(north, east);
    let (sin, cos) = libm::sincos(angle);
    // sin c / c, which is 1 at the reference.
    let share = if angle > 0.0 { sin / angle } else { 1.0 };
    let lat = libm::asin((cos * sin_lat + north * share * cos_lat).clamp(-1.0, 1.0));
    let lon = libm::atan2(east * share, cos_lat * cos - north * sin_lat * share);
    Geodetic {
        lat_deg: lat.to_degrees(),
        lon_deg: reference.lon_deg + lon.to_degrees(),
        alt_amsl_m: reference.alt_amsl_m + local.z,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ZURICH: Geodetic = Geodetic { lat_deg: 47.3977, lon_deg: 8.5456, alt_amsl_m: 488.0 };

    /// Arcs of great circles on the sphere, by their closed forms: due north the latitude alone grows; due east, the
    /// right-angled spherical triangle.
    #[test]
    fn places_lie_on_great_circles() {
        let north = place(&ZURICH, &Point3::new(0.0, 1000.0, 5.0));
        assert!((north.lat_deg - 47.3977 - (1000.0_f64 / 6.371e6).to_degrees()).abs() < 1e-12);
        assert!((north.lon_deg - 8.5456).abs() < 1e-12 && north.alt_amsl_m == 493.0);
        let east = place(&ZURICH, &Point3::new(1000.0, 0.0, 0.0));
        let (lat, arc) = (47.3977_f64.to_radians(), 1000.0_f64 / 6.371e6);
        let difference = (arc.tan() / lat.cos()).atan().to_degrees();
        assert!((east.lon_deg - 8.5456 - difference).abs() < 1e-12, "{east:?}");
        assert!((east.lat_deg - (lat.sin() * arc.cos()).asin().to_degrees()).abs() < 1e-12);
        let here = place(&ZURICH, &Point3::origin());
        assert!((here.lat_deg - 47.3977).abs() < 1e-13 && (here.lon_deg, here.alt_amsl_m) == (8.5456, 488.0));
    }

    /// On the ellipsoid a degree of longitude at 47.4° is longer than on PX4's sphere: N cos φ against R cos φ.
    #[test]
    fn its_metres_are_shorter_than_those_of_the_ground() {
        let local = Point3::new(50.0, 0.0, 0.0);
        let on_ground = tangent(&ZURICH).from_geodetic(&place(&ZURICH, &local));
        let e2 = 0.006_694_379_990_14;
        let normal = 6_378_137.0 / (1.0 - e2 * 47.3977_f64.to_radians().sin().powi(2)).sqrt() + 488.0;
        assert!((on_ground.x - 50.0 * normal / 6.371e6).abs() < 1e-5, "{on_ground}");
        assert!(on_ground.x > 50.13 && on_ground.y.abs() < 1e-3);
    }
}
