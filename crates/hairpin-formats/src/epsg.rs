//! What codes of the EPSG registry stand for, from the definitions of the `crs-definitions` crate.

use proj4rs::Proj;

/// The coordinates that a code stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum System {
    /// A plane.
    Plane {
        /// Its unit, m.
        metres: f64,
    },
    /// Longitude and latitude, or the Earth's centre.
    Angles,
    /// No definition of it is known here.
    Unknown,
}

/// What `code` stands for.
pub fn system(code: u32) -> System {
    let Some(text) = definition(code) else { return System::Unknown };
    let of = |key: &str| text.split_whitespace().find_map(|word| word.strip_prefix(key));
    if matches!(of("+proj="), Some("longlat" | "latlong" | "geocent")) {
        return System::Angles;
    }
    let metres = of("+to_meter=").and_then(|metres| metres.parse().ok()).or(match of("+units=") {
        None | Some("m") => Some(1.0),
        Some("us-ft") => Some(1200.0 / 3937.0),
        Some("ft") => Some(0.3048),
        Some("km") => Some(1000.0),
        Some(_) => None,
    });
    // A unit that is spelled otherwise is known to the library if anywhere.
    let metres = metres.or_else(|| Proj::from_proj_string(text).ok().map(|plane| plane.to_meter()));
    metres.map_or(System::Unknown, |metres| System::Plane { metres })
}

/// The definition of `code` as PROJ writes it.
pub(crate) fn definition(code: u32) -> Option<&'static str> {
    Some(crs_definitions::from_code(u16::try_from(code).ok()?)?.proj4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_have_units() {
        assert_eq!(system(32632), System::Plane { metres: 1.0 });
        assert_eq!(system(3035), System::Plane { metres: 1.0 });
        assert_eq!(system(2263), System::Plane { metres: 1200.0 / 3937.0 });
        assert_eq!((system(4326), system(4978), system(1), system(70_000)), {
            (System::Angles, System::Angles, System::Unknown, System::Unknown)
        });
    }
}
