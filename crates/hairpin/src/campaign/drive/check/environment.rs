//! Bounds of `generate.environment`, and what it goes with.

use crate::campaign::check::Findings;
use crate::campaign::scenario::{DriveEnvironmentSection, DriveScenario, Keys, PlacedDiscsSection};
use crate::judgement::Stress;
use crate::robot::rover::Rover;
use crate::world::terrain::ElevationMap;

/// The largest force that may be searched, N.
const MOST_FORCE: f64 = 1e6;

/// Robot and map where they could be read: what depends on them is not told without.
///
/// What a search looks for (`stress`) is measured on drives: no effort of joints, no saturation, no lateness. A force
/// that is searched is not given by `[execute]` or drawn by `[vary]` as well, or a case would not say which one it met.
pub(super) fn check(scenario: &DriveScenario, rover: Option<&Rover>, map: Option<&ElevationMap>, found: &mut Findings) {
    let search = scenario.generate.search.section();
    let placed = scenario.generate.environment.and_then(|environment| environment.obstacles);
    let near = placed.is_some() || !scenario.world.keep_out.is_empty();
    let measured = |stress| !matches!(stress, Stress::JointEffort | Stress::Saturation | Stress::Lateness);
    found.sought(&scenario.head(), &measured, ("drive", "keep-outs", near));
    let Some(environment) = &scenario.generate.environment else { return };
    let DriveEnvironmentSection { obstacles, external_force_n } = *environment;
    found.environment(&search, obstacles.is_some() || external_force_n.is_some(), "obstacles or external_force_n");
    if let Some(placed) = obstacles {
        found.placed(&search, placed.count, "drive");
        check_radius(placed, map, found);
    }
    if let Some(force) = external_force_n {
        let (key, own) = ("generate.environment.external_force_n", "execute.external_force_n");
        found.above(key, force, 0.0, MOST_FORCE, " N");
        let given = scenario.execute.external_force_n.is_some() || scenario.vary.keys().any(|key| key.starts_with(own));
        found.searched_alone(key, force, given, "[execute]");
        let weighs = rover.is_none_or(|rover| rover.weight.is_some());
        found.require(
            weighs,
            key,
            force,
            "left out, or robot.mass_kg and robot.forces given: it acts against a weight",
        );
    }
}

/// 0 < 2 r < the map's shorter side.
fn check_radius(placed: PlacedDiscsSection, map: Option<&ElevationMap>, found: &mut Findings) {
    let side = map.map_or(f64::INFINITY, |map| {
        let (low, high) = map.extent();
        (high[0] - low[0]).min(high[1] - low[1])
    });
    let key = "generate.environment.obstacles.radius_m";
    let fits = placed.radius_m > 0.0 && placed.radius_m.is_finite() && 2.0 * placed.radius_m < side;
    let across = if side.is_finite() { format!(", which is {side} m across") } else { String::new() };
    found.require(fits, key, placed.radius_m, &format!("> 0 and less than half the map{across}"));
}
