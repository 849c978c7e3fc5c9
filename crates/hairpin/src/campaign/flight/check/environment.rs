//! Bounds of `generate.environment`, and what it goes with.

use super::world::vector;
use crate::campaign::check::Findings;
use crate::campaign::scenario::{EnvironmentSection, FlightScenario, Keys, PlacedSection};
use crate::judgement::Stress;

/// Winds and gusts up to 100 m/s, searched only where none is given or varied; obstacles only for the stress
/// `clearance`, and that only where there are some.
///
/// The gust's duration is bounded even where no gust is searched. NaN is refused everywhere.
pub(super) fn check(scenario: &FlightScenario, found: &mut Findings) {
    let search = &scenario.generate.search;
    let placed = scenario.generate.environment.and_then(|environment| environment.obstacles);
    let near = placed.is_some() || !scenario.world.obstacles.is_empty();
    // A program's flights have no rotors to look at.
    let measured = |stress| match stress {
        Stress::JointEffort | Stress::Lateness => false,
        Stress::Saturation => scenario.execute.command.is_none(),
        _ => true,
    };
    found.sought(&scenario.head(), &measured, ("flight", "obstacles", near));
    let Some(environment) = &scenario.generate.environment else { return };
    let key = "generate.environment";
    let EnvironmentSection { wind_m_s, gust_m_s, gust_s, obstacles } = *environment;
    let some = wind_m_s.is_some() || gust_m_s.is_some() || obstacles.is_some();
    found.environment(search, some, "wind_m_s, gust_m_s or obstacles");
    found.above(&format!("{key}.gust_s"), gust_s, 0.0, 1000.0, " s");
    let varied = |fixed: &str| scenario.vary.keys().any(|varied| varied.starts_with(fixed));
    if let Some(wind) = wind_m_s {
        let key = format!("{key}.wind_m_s");
        found.above(&key, wind, 0.0, 100.0, " m/s");
        let given = scenario.world.wind_m_s.is_some() || varied("world.wind_m_s");
        found.searched_alone(&key, wind, given, "[world]");
    }
    if let Some(gust) = gust_m_s {
        let key = format!("{key}.gust_m_s");
        found.above(&key, gust, 0.0, 100.0, " m/s");
        let given = scenario.world.discrete_gust.is_some() || varied("world.discrete_gust");
        found.searched_alone(&key, gust, given, "[world]");
    }
    if let Some(placed) = &obstacles {
        check_obstacles(scenario, placed, found);
    }
}

/// A ball (2 r less than every side of the world) or a box (every edge less than the shortest).
///
/// Exactly one of both sizes is given; they are compared with the whole world, margin included.
fn check_obstacles(scenario: &FlightScenario, placed: &PlacedSection, found: &mut Findings) {
    let key = "generate.environment.obstacles";
    found.placed(&scenario.generate.search, placed.count, "flight");
    let one = placed.radius_m.is_some() != placed.size_m.is_some();
    found.require(one, key, "a table", "exactly one of radius_m and size_m");
    let size = scenario.world.size_m.unwrap_or([f64::INFINITY; 3]);
    let bound = "> 0 and less than the world's size";
    if let Some(radius) = placed.radius_m {
        let fits = radius > 0.0 && size.iter().all(|size| 2.0 * radius < *size);
        found.require(fits, &format!("{key}.radius_m"), radius, bound);
    }
    if let Some(edges) = placed.size_m {
        let least = size.iter().copied().fold(f64::INFINITY, f64::min);
        vector(&format!("{key}.size_m"), edges, found, |edge| edge > 0.0 && edge < least, bound);
    }
}
