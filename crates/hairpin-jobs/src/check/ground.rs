//! A flight that is checked without a world, held to the only ground that is known of: its home's.
//!
//! A mission may go down into a valley or along a cliff below its home, so that nothing is proven by it; but nobody
//! looked whether there is one.

use hairpin::campaign::{Broken, Certainty, Passage};
use hairpin_formats::missions::{Frame, Mission};
use hairpin_formats::placement::Placement;
use nalgebra::Point3;

use crate::Problem;

/// Heights as near as this to home's ground are on it, m: missions have altitudes in centimetres.
const ON_IT_M: f64 = 1e-3;

/// Altitudes of `waypoints` above the mission's own home, m; none where it has none.
///
/// # Errors
/// A point that is nowhere on Earth.
pub(super) fn above_home(mission: &Mission, waypoints: &[Point3<f64>]) -> Result<Vec<f64>, Problem> {
    let Frame::Home(home) = &mission.frame else { return Ok(Vec::new()) };
    // Not the height over the home's tangent plane, which the Earth falls below with the distance.
    let about = Placement::about(home);
    let altitude = |place: &Point3<f64>| about.geodetic(place).map(|there| there.alt_amsl_m - home.alt_amsl_m);
    waypoints.iter().map(altitude).collect::<Result<_, String>>().map_err(|why| Problem::of_file(&mission.path, why))
}

/// Adds to `passage` each waypoint that is not above home's ground, by its altitude over it (m); who rests there at
/// either end stands on it.
pub(super) fn hold(altitudes: &[f64], passage: &mut Passage) {
    let last = altitudes.len().saturating_sub(1);
    for (waypoint, altitude) in altitudes.iter().enumerate() {
        let stands = (waypoint == 0 || waypoint == last) && *altitude >= -ON_IT_M;
        if *altitude > ON_IT_M || stands {
            continue;
        }
        let below = -altitude;
        let words = match below > ON_IT_M {
            true => format!("it lies {below:.2} m below its home's ground"),
            false => "it lies on its home's ground, 0.00 m above it".into(),
        };
        let broken = Broken {
            waypoint,
            leg: None,
            limit: "ground",
            unit: "m",
            excess: (below > ON_IT_M).then_some(below),
            certainty: Certainty::NotFound,
            words: format!(
                "{words}, and no other is known without --world: more than 0 m above it is looked at as free"
            ),
        };
        let Some(leg) = passage.legs.get_mut(waypoint.saturating_sub(1)) else { continue };
        leg.broken.get_or_insert(broken);
        passage.witness = None;
    }
}
