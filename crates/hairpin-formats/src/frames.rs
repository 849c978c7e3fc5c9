//! Frames of other programs, and the only place where they are converted: cage ↔ ENU ↔ geodetic, ENU/FLU ↔ NED/FRD.
//!
//! | frame | world axes | body axes | yaw |
//! | --- | --- | --- | --- |
//! | cage | the origin's heading, its left, up; at a floor corner | forward, left, up | from x, counter-clockwise |
//! | ENU | east, north, up; at the same point | forward, left, up | from east, counter-clockwise |
//! | NED | north, east, down; at the same point | forward, right, down | from north, clockwise |
//! | geodetic | WGS 84 latitude and longitude, altitude | | |
//!
//! Each pose has its own type, so that a conversion can neither be forgotten nor be done twice. Altitudes above mean
//! sea level stand in for ellipsoidal heights: no geoid is modelled, so differences of altitude are exact, and 100 m of
//! geoid move a point 100 m away by 1.6 mm sideways.

use std::f64::consts::FRAC_PI_2;

use hairpin::campaign::scenario::Origin;
use hairpin::math::power::power;
use hairpin::math::rotation::from_rotation_vector;
use nalgebra::{Isometry3, Matrix3, Point3, Quaternion, Rotation3, UnitQuaternion, Vector3};
use serde::Serialize;

/// WGS 84: semi-major axis, m, and flattening (NGA.STND.0036, 2014).
const SEMI_MAJOR: f64 = 6_378_137.0;
const FLATTENING: f64 = 1.0 / 298.257_223_563;
/// Square of the first eccentricity.
const ECCENTRICITY_2: f64 = FLATTENING * (2.0 - FLATTENING);

/// A place on Earth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Geodetic {
    /// Latitude, WGS 84.
    pub lat_deg: f64,
    /// Longitude, −180 … 180.
    pub lon_deg: f64,
    /// Altitude above mean sea level.
    pub alt_amsl_m: f64,
}

/// `world_from_body` in east, north, up with a body of forward, left, up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnuFlu(pub Isometry3<f64>);

/// `world_from_body` in north, east, down with a body of forward, right, down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NedFrd(pub Isometry3<f64>);

/// (x, y, z) → (y, x, −z) for positions, and for attitudes R_ned = P R_enu B with the world's P (axes swapped) and the
/// body's B (half a turn about forward). As quaternions: q_ned = p q_enu b, p = (0, 1, 1, 0)/√2, b = (0, 1, 0, 0).
impl From<EnuFlu> for NedFrd {
    fn from(EnuFlu(pose): EnuFlu) -> Self {
        Self(swapped(&pose))
    }
}

/// The same the other way: both turns are their own inverses.
impl From<NedFrd> for EnuFlu {
    fn from(NedFrd(pose): NedFrd) -> Self {
        Self(swapped(&pose))
    }
}

fn swapped(pose: &Isometry3<f64>) -> Isometry3<f64> {
    let p = pose.translation.vector;
    let root = std::f64::consts::FRAC_1_SQRT_2;
    let world = UnitQuaternion::new_unchecked(Quaternion::new(0.0, root, root, 0.0));
    let body = UnitQuaternion::new_unchecked(Quaternion::new(0.0, 1.0, 0.0, 0.0));
    Isometry3::from_parts(ned_of_enu(&p).into(), world * pose.rotation * body)
}

/// Yaw of NED (from north, clockwise) of a yaw of ENU (from east, counter-clockwise), and the reverse: 90° − yaw, rad,
/// in (−π, π].
pub fn other_yaw(yaw: f64) -> f64 {
    let (sin, cos) = libm::sincos(FRAC_PI_2 - yaw);
    libm::atan2(sin, cos)
}

/// (x, y, z) → (y, x, −z): a vector of east, north, up as north, east, down.
pub(crate) fn ned_of_enu(v: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(v.y, v.x, -v.z)
}

/// A turn about up, counter-clockwise, rad.
pub(crate) fn turned(yaw: f64) -> UnitQuaternion<f64> {
    from_rotation_vector(&(Vector3::z() * yaw))
}

/// The cage on Earth.
#[derive(Debug, Clone)]
pub struct Cage {
    origin: Origin,
    /// Turns cage axes into east, north, up.
    enu_from_cage: UnitQuaternion<f64>,
    /// The origin in the Earth-centred frame, m.
    center: Vector3<f64>,
    /// Turns east, north, up at the origin into the Earth-centred frame.
    ecef_from_enu: Rotation3<f64>,
}

impl Cage {
    /// The frame of a scenario's `world.origin`, within the bounds that the scenario's check holds it to.
    pub fn new(origin: &Origin) -> Self {
        let yaw = other_yaw(origin.x_axis_heading_deg.to_radians());
        let (lat, lon) = (origin.lat_deg.to_radians(), origin.lon_deg.to_radians());
        let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (libm::sincos(lat), libm::sincos(lon));
        let east = Vector3::new(-sin_lon, cos_lon, 0.0);
        let north = Vector3::new(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat);
        let up = Vector3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
        let place = Geodetic { lat_deg: origin.lat_deg, lon_deg: origin.lon_deg, alt_amsl_m: origin.alt_amsl_m };
        Self {
            origin: *origin,
            enu_from_cage: turned(yaw),
            center: ecef(&place),
            ecef_from_enu: Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[east, north, up])),
        }
    }

    /// A pose of the cage's frame in east, north, up at the cage's origin.
    pub fn enu(&self, cage: &Isometry3<f64>) -> EnuFlu {
        EnuFlu(self.enu_from_cage * cage)
    }

    /// The reverse of [`Cage::enu`].
    pub fn from_enu(&self, EnuFlu(enu): &EnuFlu) -> Isometry3<f64> {
        self.enu_from_cage.inverse() * enu
    }

    /// Where on Earth a point of the cage is: through the plane tangent at the origin and the Earth-centred frame.
    pub fn geodetic(&self, point: &Point3<f64>) -> Geodetic {
        let enu = self.enu_from_cage * point.coords;
        geodetic(&(self.center + self.ecef_from_enu * enu))
    }

    /// The reverse of [`Cage::geodetic`].
    pub fn from_geodetic(&self, place: &Geodetic) -> Point3<f64> {
        let enu = self.ecef_from_enu.inverse() * (ecef(place) - self.center);
        Point3::from(self.enu_from_cage.inverse() * enu)
    }

    /// Altitude above the cage's origin, m: what `relative_alt_m` is relative to.
    pub fn relative_altitude(&self, place: &Geodetic) -> f64 {
        place.alt_amsl_m - self.origin.alt_amsl_m
    }
}

/// Earth-centred, Earth-fixed coordinates, m: x to (0°, 0°), z to the north pole.
fn ecef(place: &Geodetic) -> Vector3<f64> {
    let ((sin_lat, cos_lat), (sin_lon, cos_lon)) =
        (libm::sincos(place.lat_deg.to_radians()), libm::sincos(place.lon_deg.to_radians()));
    let normal = SEMI_MAJOR / (1.0 - ECCENTRICITY_2 * sin_lat * sin_lat).sqrt();
    let across = (normal + place.alt_amsl_m) * cos_lat;
    let along = (normal * (1.0 - ECCENTRICITY_2) + place.alt_amsl_m) * sin_lat;
    Vector3::new(across * cos_lon, across * sin_lon, along)
}

/// The reverse of [`ecef`] by Bowring's iteration on the reduced latitude (Survey Review 23, 1976): each pass gains
/// about five digits near the ground, so four reach the last.
fn geodetic(point: &Vector3<f64>) -> Geodetic {
    let semi_minor = SEMI_MAJOR * (1.0 - FLATTENING);
    let second = ECCENTRICITY_2 / (1.0 - ECCENTRICITY_2);
    let across = libm::hypot(point.x, point.y);
    let (mut sin, mut cos) = unit(point.z * SEMI_MAJOR, across * semi_minor);
    let mut lat = (0.0, 1.0);
    for _ in 0..4 {
        lat = unit(point.z + second * semi_minor * power(sin, 3), across - ECCENTRICITY_2 * SEMI_MAJOR * power(cos, 3));
        (sin, cos) = unit((1.0 - FLATTENING) * lat.0, lat.1);
    }
    let (sin_lat, cos_lat) = lat;
    Geodetic {
        lat_deg: libm::atan2(sin_lat, cos_lat).to_degrees(),
        lon_deg: libm::atan2(point.y, point.x).to_degrees(),
        alt_amsl_m: across * cos_lat + point.z * sin_lat
            - SEMI_MAJOR * (1.0 - ECCENTRICITY_2 * sin_lat * sin_lat).sqrt(),
    }
}

/// Sine and cosine of the angle with this tangent.
fn unit(sine: f64, cosine: f64) -> (f64, f64) {
    let norm = libm::hypot(sine, cosine);
    (sine / norm, cosine / norm)
}

#[cfg(test)]
mod tests {
    use nalgebra::Translation3;

    use super::*;

    fn origin(heading: f64) -> Origin {
        Origin { lat_deg: 47.3977, lon_deg: 8.5456, alt_amsl_m: 488.0, x_axis_heading_deg: heading }
    }

    /// Climbing (a place off the ground), turning (yaw) and tilted: nothing about it is zero, equal or symmetric.
    fn pose() -> Isometry3<f64> {
        Isometry3::from_parts(Translation3::new(3.0, -7.0, 11.0), UnitQuaternion::from_euler_angles(0.3, -0.45, 2.1))
    }

    /// The worked example of the EPSG Guidance Note 7-2: methods 9602 (geographic/geocentric) and 9837
    /// (geographic/topocentric), WGS 84.
    #[test]
    fn published_places() {
        let lat_deg = 53.0 + 48.0 / 60.0 + 33.82 / 3600.0;
        let lon_deg = 2.0 + 7.0 / 60.0 + 46.38 / 3600.0;
        let place = Geodetic { lat_deg, lon_deg, alt_amsl_m: 73.0 };
        let center = ecef(&place);
        assert!((center - Vector3::new(3_771_793.968, 140_253.342, 5_124_304.349)).norm() < 2e-3, "{center}");
        let cage = Cage::new(&Origin { lat_deg: 55.0, lon_deg: 5.0, alt_amsl_m: 200.0, x_axis_heading_deg: 90.0 });
        let enu = cage.from_geodetic(&place);
        assert!((enu - Point3::new(-189_013.869, -128_642.040, -4_220.171)).norm() < 2e-3, "{enu}");
        let back = cage.geodetic(&enu);
        assert!((back.lat_deg - lat_deg).abs() < 1e-12 && (back.lon_deg - lon_deg).abs() < 1e-12, "{back:?}");
        assert!((back.alt_amsl_m - 73.0).abs() < 1e-6);
    }

    #[test]
    fn a_metre_north_in_a_cage_that_looks_elsewhere() {
        // x heads 73.5°: a metre north is cos 73.5° along x and sin 73.5° along y, which is x's left.
        let cage = Cage::new(&origin(73.5));
        let north = Point3::new(73.5_f64.to_radians().cos(), 73.5_f64.to_radians().sin(), 0.0);
        assert!(
            (cage.enu(&Isometry3::from_parts(north.into(), UnitQuaternion::identity())).0.translation.vector
                - Vector3::y())
            .norm()
                < 1e-12
        );
        let place = cage.geodetic(&north);
        // One metre over the meridian's radius of curvature.
        let sin = origin(0.0).lat_deg.to_radians().sin();
        let root = (1.0 - ECCENTRICITY_2 * sin * sin).sqrt();
        let radius = SEMI_MAJOR * (1.0 - ECCENTRICITY_2) / root.powi(3) + 488.0;
        assert!((place.lat_deg - 47.3977 - (1.0 / radius).to_degrees()).abs() < 1e-13, "{place:?}");
        assert!((place.lon_deg - 8.5456).abs() < 1e-12);
        // Along x itself: north cos, east sin.
        let ahead = cage.geodetic(&Point3::new(1.0, 0.0, 0.0));
        let share = (ahead.lat_deg - 47.3977) / (place.lat_deg - 47.3977);
        assert!((share - 73.5_f64.to_radians().cos()).abs() < 1e-6 && ahead.lon_deg > 8.5456, "{ahead:?}");
        // 90°: x is east and y is north, so the cage is ENU.
        assert!((Cage::new(&origin(90.0)).enu(&pose()).0.to_homogeneous() - pose().to_homogeneous()).norm() < 1e-12);
    }

    #[test]
    fn places_round_trip_at_any_heading_and_latitude() {
        for heading in [73.5, 0.0, 90.0, 200.25, 359.0] {
            for (lat_deg, lon_deg) in [(47.3977, 8.5456), (-33.9, 179.999_99), (89.9999, -120.0), (0.0, 0.0)] {
                let cage = Cage::new(&Origin { lat_deg, lon_deg, ..origin(heading) });
                for point in [Point3::new(3.0, -7.0, 11.0), Point3::new(2500.0, 900.0, -30.0), Point3::origin()] {
                    let place = cage.geodetic(&point);
                    let back = cage.from_geodetic(&place);
                    assert!((back - point).norm() < 1e-7, "heading {heading}, lat {lat_deg}: {back}");
                    let sag = point.coords.xy().norm_squared() / 2.0 / 6.3e6;
                    assert!((cage.relative_altitude(&place) - point.z - sag).abs() < 0.02 * sag + 1e-8);
                }
            }
        }
    }

    #[test]
    fn poses_round_trip_and_once_is_not_twice() {
        let cage = Cage::new(&origin(73.5));
        let enu = cage.enu(&pose());
        let ned = NedFrd::from(enu);
        let back = cage.from_enu(&EnuFlu::from(ned));
        assert!((back.to_homogeneous() - pose().to_homogeneous()).norm() < 1e-12);
        // What was converted is another pose, and neither half of the conversion alone gives it.
        let (EnuFlu(enu), NedFrd(ned)) = (enu, ned);
        assert!(
            ned.rotation.angle_to(&enu.rotation) > 0.1
                && (ned.translation.vector - enu.translation.vector).norm() > 1.0
        );
        let body_only = enu.rotation * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
        let swap = Rotation3::from_matrix_unchecked(Matrix3::new(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0));
        let world_only = UnitQuaternion::from_rotation_matrix(&swap) * enu.rotation;
        assert!(ned.rotation.angle_to(&body_only) > 0.1 && ned.rotation.angle_to(&world_only) > 0.1);
    }

    #[test]
    fn directions_stay_where_they_are() {
        let EnuFlu(enu) = EnuFlu(pose());
        let NedFrd(ned) = EnuFlu(pose()).into();
        let to_ned = |v: Vector3<f64>| Vector3::new(v.y, v.x, -v.z);
        // Nose, right side and belly point to the same places in both.
        for (flu, frd) in [(Vector3::x(), Vector3::x()), (-Vector3::y(), Vector3::y()), (-Vector3::z(), Vector3::z())] {
            assert!((to_ned(enu.rotation * flu) - ned.rotation * frd).norm() < 1e-12);
        }
        let (roll, pitch, yaw) = enu.rotation.euler_angles();
        let (ned_roll, ned_pitch, ned_yaw) = ned.rotation.euler_angles();
        assert!((ned_yaw - other_yaw(yaw)).abs() < 1e-12 && (other_yaw(other_yaw(yaw)) - yaw).abs() < 1e-12);
        // Nose up is a negative pitch in FLU and a positive one in FRD; roll keeps its sign.
        assert!((ned_pitch + pitch).abs() < 1e-12 && (ned_roll - roll).abs() < 1e-12 && ned_pitch > 0.4);
        assert!((other_yaw(0.0) - FRAC_PI_2).abs() < 1e-15);
    }
}
