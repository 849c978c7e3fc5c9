//! Planes that stretch the ground: a metre of Mercator's is the cosine of the latitude of one.

use crate::epsg::definition;

/// Radius of the sphere, m; the ellipsoid's flattening changes the stretch by less than a hundredth.
const RADIUS: f64 = 6_378_137.0;
/// Shares by which a map's lengths may be off before it is another map.
const TOLERATED: f64 = 0.01;
/// Codes of the plane of web maps: EPSG's, its older one, Google's and Esri's.
const WEB: [u32; 5] = [3857, 3785, 900_913, 102_100, 102_113];
/// What it is called where it has no code.
const WEB_NAMES: [&str; 4] = ["pseudo-mercator", "web_mercator", "web mercator", "popular visualisation"];

/// A plane that stretches the ground, and where on Earth it does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretched {
    /// How long a metre of the ground is on it.
    pub(super) times: f64,
    /// Longitude and latitude, degrees.
    pub(super) at: [f64; 2],
}

/// Whether the plane of this code or name is one of Mercator's that stretches lengths at `place` (m) by more than a
/// hundredth; that of web maps always is taken for one.
pub(super) fn stretched(epsg: Option<u32>, name: &str, place: [f64; 2]) -> Option<Stretched> {
    let name = name.to_ascii_lowercase();
    let is_web = epsg.is_some_and(|code| WEB.contains(&code)) || WEB_NAMES.iter().any(|web| name.contains(web));
    let text = if is_web { "+proj=merc" } else { epsg.and_then(definition)? };
    let number = |key: &str| text.split_whitespace().find_map(|word| word.strip_prefix(key)?.parse::<f64>().ok());
    if !text.split_whitespace().any(|word| word == "+proj=merc") {
        return None;
    }
    let along = number("+k=").or(number("+k_0=")).unwrap_or(1.0);
    let along = number("+lat_ts=").map_or(along, |latitude| libm::cos(latitude.to_radians()));
    let of = |axis: usize, key: &str| (place[axis] - number(key).unwrap_or(0.0)) / (RADIUS * along);
    let (x, y) = (of(0, "+x_0="), of(1, "+y_0="));
    let times = along * libm::cosh(y);
    let at = [number("+lon_0=").unwrap_or(0.0) + x.to_degrees(), libm::atan(libm::sinh(y)).to_degrees()];
    (is_web || (times - 1.0).abs() > TOLERATED).then_some(Stretched { times, at })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_metre_of_web_maps_is_the_cosine_of_the_latitude_of_one() {
        // Zurich: 47.37° N, 8.54° E.
        let zurich = [950_668.0, 6_002_730.0];
        for (code, name) in [(Some(3857), ""), (Some(102_100), ""), (None, "WGS 84 / Pseudo-Mercator")] {
            let found = stretched(code, name, zurich).unwrap();
            assert!((found.times * libm::cos(47.37_f64.to_radians()) - 1.0).abs() < 1e-3, "{found:?}");
            assert!((found.at[0] - 8.54).abs() < 0.01 && (found.at[1] - 47.37).abs() < 0.01, "{found:?}");
        }
        assert!(stretched(Some(3395), "", zurich).is_some(), "the ellipsoid's Mercator");
        assert!(stretched(Some(3395), "", [0.0, 100_000.0]).is_none(), "near the equator it is true");
        for (code, name) in [(Some(32632), "WGS 84 / UTM zone 32N"), (None, "Transverse_Mercator"), (Some(3035), "")] {
            assert_eq!(stretched(code, name, [500_000.0, 5_250_000.0]), None);
        }
    }
}
