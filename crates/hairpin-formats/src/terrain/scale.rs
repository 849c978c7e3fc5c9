//! Planes that stretch the ground: how long a metre of it is on them, by direction. Mercator's is the cosine of the
//! latitude of one in all directions, an equirectangular one's in one of two.

use nalgebra::Vector3;
use proj4rs::Proj;
use proj4rs::transform::transform;

/// Shares by which a map's lengths may be off before it is another map.
const TOLERATED: f64 = 0.01;
/// Codes of the plane of web maps: EPSG's, its older one, Google's and Esri's.
const WEB: [u32; 5] = [3857, 3785, 900_913, 102_100, 102_113];
/// What it is called where it has no code.
const WEB_NAMES: [&str; 4] = ["pseudo-mercator", "web_mercator", "web mercator", "popular visualisation"];
const WEB_PLANE: &str = "+proj=merc +a=6378137 +b=6378137";
/// Points this far to both sides are looked at, m: inverses are right to a millimetre.
const STEP: f64 = 100.0;

/// How long a metre of the ground is on a plane at a place of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Along the plane's x and its y.
    pub along: [f64; 2],
    /// In the direction in which it is shortest, and in the one in which it is longest.
    pub extremes: [f64; 2],
}

/// A plane's scale at a place, and where on Earth, or on the body, that is: longitude and latitude, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct At {
    pub(super) scale: Scale,
    pub(super) at: [f64; 2],
    /// Whether it is the plane of web maps.
    pub(super) is_web: bool,
}

impl Scale {
    /// Whether any length differs from the ground's by more than a hundredth.
    fn is_stretched(&self) -> bool {
        self.extremes.iter().any(|times| (times - 1.0).abs() > TOLERATED)
    }

    /// `1.466 long`, `1.466 long along x and 1.000 along y`, with what other directions have where it is more.
    pub(super) fn in_words(&self) -> String {
        let [x, y] = self.along;
        let [least, most] = self.extremes;
        let are_alike = |a: f64, b: f64| (a - b).abs() < 5e-4;
        let are_axes = are_alike(least, x.min(y)) && are_alike(most, x.max(y));
        match (are_axes, are_alike(x, y)) {
            (true, true) => format!("{x:.3} long"),
            (true, false) => format!("{x:.3} long along x and {y:.3} along y"),
            _ => format!("{x:.3} long along x, {y:.3} along y, and {least:.3} to {most:.3} by direction"),
        }
    }
}

impl At {
    /// Whether the plane may not be taken for the ground; that of web maps never may.
    pub(super) fn is_stretched(&self) -> bool {
        self.is_web || self.scale.is_stretched()
    }
}

/// The scale of a plane at `place` (m): of web maps' by its code or name, else of what PROJ calls `text`; `None` where
/// nobody here can compute it.
pub(super) fn scale(epsg: Option<u32>, name: &str, text: Option<&str>, place: [f64; 2]) -> Option<At> {
    let name = name.to_ascii_lowercase();
    let is_web = epsg.is_some_and(|code| WEB.contains(&code)) || WEB_NAMES.iter().any(|web| name.contains(web));
    let ground = Ground::of(if is_web { WEB_PLANE } else { text? })?;
    let (_, at) = ground.at(place)?;
    // Ground per metre of the plane, by central differences: J has it along x and y.
    let along = |axis: usize| {
        let mut ends = [place, place];
        (ends[0][axis], ends[1][axis]) = (place[axis] - STEP, place[axis] + STEP);
        let [(from, _), (to, _)] = [ground.at(ends[0])?, ground.at(ends[1])?];
        Some((to - from) / (2.0 * STEP))
    };
    let [u, v] = [along(0)?, along(1)?];
    // Singular values of J: the square roots of JᵀJ's eigenvalues.
    let (e, f, g) = (u.norm_squared(), u.dot(&v), v.norm_squared());
    let (mean, apart) = (0.5 * (e + g), libm::hypot(0.5 * (e - g), f));
    let extremes = [mean + apart, mean - apart].map(|squared| 1.0 / squared.max(0.0).sqrt());
    let scale = Scale { along: [1.0 / u.norm(), 1.0 / v.norm()], extremes };
    scale.along.iter().chain(&extremes).all(|times| !times.is_nan()).then_some(At { scale, at, is_web })
}

/// From a plane to the ellipsoid that it is of.
struct Ground {
    plane: Proj,
    angles: Proj,
    /// Semi-major axis, m.
    a: f64,
    /// Square of the eccentricity.
    es: f64,
}

impl Ground {
    /// Without a shift of datums, which moves places and stretches nothing.
    fn of(text: &str) -> Option<Self> {
        let begins = |word: &str, keys: &[&str]| keys.iter().any(|key| word.starts_with(key));
        let shifts = ["+towgs84", "+nadgrids"];
        let words: Vec<&str> = text.split_whitespace().filter(|word| !begins(word, &shifts)).collect();
        let plane = Proj::from_proj_string(&words.join(" ")).ok()?;
        if plane.is_latlong() || plane.is_geocent() || !plane.has_inverse() {
            return None;
        }
        let body = ["+a=", "+b=", "+R=", "+rf=", "+f=", "+es=", "+ellps=", "+datum="];
        let of_body = words.iter().copied().filter(|word| begins(word, &body));
        let angles: Vec<&str> = std::iter::once("+proj=longlat").chain(of_body).collect();
        let angles = Proj::from_proj_string(&angles.join(" ")).ok()?;
        let (a, b) = plane.ellipse_parameters();
        Some(Self { plane, angles, a, es: 1.0 - (b / a) * (b / a) })
    }

    /// A place of the plane, m, from the body's centre, m, and its longitude and latitude, degrees.
    fn at(&self, place: [f64; 2]) -> Option<(Vector3<f64>, [f64; 2])> {
        let metres = self.plane.to_meter();
        let mut moved = (place[0] / metres, place[1] / metres, 0.0);
        transform(&self.plane, &self.angles, &mut moved).ok()?;
        let (lon, lat, _) = moved;
        if !lon.is_finite() || !lat.is_finite() {
            return None;
        }
        let (sin, cos) = (libm::sin(lat), libm::cos(lat));
        let across = self.a / (1.0 - self.es * sin * sin).sqrt();
        let p = [across * cos * libm::cos(lon), across * cos * libm::sin(lon), across * (1.0 - self.es) * sin];
        Some((Vector3::from(p), [lon.to_degrees(), lat.to_degrees()]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::epsg::definition;

    fn by_code(code: u32, place: [f64; 2]) -> At {
        scale(Some(code), "", definition(code), place).unwrap()
    }

    #[test]
    fn a_metre_of_web_maps_is_the_cosine_of_the_latitude_of_one() {
        // Zurich: 47.37° N, 8.54° E.
        let zurich = [950_668.0, 6_002_730.0];
        for (code, name) in [(Some(3857), ""), (Some(102_100), ""), (None, "WGS 84 / Pseudo-Mercator")] {
            let found = scale(code, name, None, zurich).unwrap();
            let cos = libm::cos(47.37_f64.to_radians());
            assert!(found.scale.along.iter().all(|times| (times * cos - 1.0).abs() < 1e-3), "{found:?}");
            assert!((found.at[0] - 8.54).abs() < 0.01 && (found.at[1] - 47.37).abs() < 0.01, "{found:?}");
        }
        assert!(scale(Some(3857), "", None, [0.0, 0.0]).unwrap().is_stretched(), "web maps' always is");
        assert!(by_code(3395, zurich).is_stretched(), "the ellipsoid's Mercator");
        assert!(!by_code(3395, [0.0, 100_000.0]).is_stretched(), "near the equator it is true");
        assert!(!by_code(32632, [500_000.0, 5_250_000.0]).is_stretched());
        assert!(!by_code(3035, [4_321_000.0, 3_210_000.0]).is_stretched(), "near its centre it is true");
        assert!(by_code(3035, [500_000.0, 5_250_000.0]).is_stretched(), "and 4000 km away it is not");
        assert_eq!(scale(None, "a yard", None, zurich), None);
    }

    /// 8.5° E, 47° N, by the closed forms of the sphere or of the ellipsoid's radii of curvature.
    #[test]
    fn planes_that_are_not_conformal_are_stretched_in_one_direction() {
        let (lat, es) = (47_f64.to_radians(), 0.006_694_379_990_14);
        let w = (1.0 - es * lat.sin() * lat.sin()).sqrt();
        // Along a parallel and along a meridian: a over the radii of curvature there.
        let (east, north) = (w / lat.cos(), w * w * w / (1.0 - es));
        for code in [4087, 32662] {
            let metres = [8.5_f64, 47.0].map(|angle| 6_378_137.0 * angle.to_radians());
            let found = by_code(code, metres);
            let [x, y] = found.scale.along;
            // A degree of latitude is one of the plane's, or the length of the meridian.
            assert!((x - east).abs() < 0.01 && (y - 1.0).abs() < 0.01, "{code}: {found:?}, {east}, {north}");
            assert!(found.is_stretched());
        }
        let mars = Some("+proj=eqc +lat_ts=0 +lat_0=0 +lon_0=0 +R=3396190 +units=m");
        let at = [8.5_f64, 47.0].map(|angle| 3_396_190.0 * angle.to_radians());
        let found = scale(None, "unknown", mars, at).unwrap();
        assert!((found.scale.along[0] - 1.0 / lat.cos()).abs() < 1e-5, "{found:?}");
        assert!((found.scale.along[1] - 1.0).abs() < 1e-5 && (found.at[1] - 47.0).abs() < 1e-6, "{found:?}");
        assert_eq!(found.scale.in_words(), "1.466 long along x and 1.000 along y");
        let sinusoidal = Some("+proj=sinu +lon_0=0 +R=6371007.181 +units=m");
        let at = [6_371_007.181 * 8.5_f64.to_radians() * lat.cos(), 6_371_007.181 * lat];
        let found = scale(None, "unknown", sinusoidal, at).unwrap();
        // Its axes are nearly true and lie askew: areas are, lengths are not.
        let skew = 8.5_f64.to_radians() * lat.sin();
        let most = 0.5 * (skew + (4.0 + skew * skew).sqrt());
        assert!((found.scale.extremes[1] - most).abs() < 1e-4, "{found:?}, {most}");
        assert!(found.is_stretched() && found.scale.in_words().contains("by direction"), "{found:?}");
        for (code, lat) in [(6933, 30.0), (3413, 70.0)] {
            // True along their standard parallels.
            let at = if code == 6933 { [0.0, 3_667_000.0] } else { [0.0, -2_187_000.0] };
            let found = by_code(code, at);
            assert!(!found.is_stretched() && (found.at[1] - lat).abs() < 1.0, "{code}: {found:?}");
        }
        for (code, at) in [(3410, [0.0, 5_000_000.0]), (3571, [0.0, -4_000_000.0]), (8857, [0.0, 5_800_000.0])] {
            assert!(by_code(code, at).is_stretched(), "{code}");
        }
    }
}
