//! ArduPilot's local metres are degrees times a constant (`AP_Common/Location.cpp`): undone before positions meet
//! places.

use hairpin::campaign::scenario::Origin;
use nalgebra::Vector3;

use crate::frames::{Cage, Geodetic};

/// `LOCATION_SCALING_FACTOR`, metres of a degree of latitude: a sphere of 6378.1 km.
pub(super) const METRES: f64 = 0.011_131_884_502_145_034 * 1e7;

/// Latitude, longitude in degrees and altitude in m, where they are a place; 0, 0 is how a receiver says that it has
/// none.
pub(super) fn geodetic([lat_deg, lon_deg, alt_amsl_m]: [f64; 3]) -> Option<Geodetic> {
    let place = Geodetic { lat_deg, lon_deg, alt_amsl_m };
    is_place(&place).then_some(place)
}

pub(super) fn is_place(place: &Geodetic) -> bool {
    let known = place.lat_deg != 0.0 || place.lon_deg != 0.0;
    known && place.lat_deg.abs() < 90.0 && place.lon_deg.abs() <= 180.0 && place.alt_amsl_m.abs() < 1e5
}

/// The place of a local position about `origin`: longitudes by the mean of both latitudes.
pub(super) fn local(origin: &Geodetic, [north, east, down]: [f64; 3]) -> Geodetic {
    let lat_deg = origin.lat_deg + north / METRES;
    let share = libm::cos(((origin.lat_deg + lat_deg) / 2.0).to_radians()).max(0.01);
    Geodetic { lat_deg, lon_deg: origin.lon_deg + east / (METRES * share), alt_amsl_m: origin.alt_amsl_m - down }
}

/// The plane tangent to WGS 84 at a place: east, north, up.
pub(super) fn plane(place: &Geodetic) -> Cage {
    Cage::new(&Origin {
        lat_deg: place.lat_deg,
        lon_deg: place.lon_deg,
        alt_amsl_m: place.alt_amsl_m,
        x_axis_heading_deg: 90.0,
    })
}

/// From one place to another in the plane about the first.
pub(super) fn between(from: &Geodetic, to: &Geodetic) -> Vector3<f64> {
    plane(from).from_geodetic(to).coords
}
