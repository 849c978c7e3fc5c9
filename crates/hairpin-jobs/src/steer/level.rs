//! What a map must be where a vehicle without a suspension drives on it: there, and level.
//!
//! Such a vehicle is a point that drives over any map as over a plane. How it stands on a slope its file does not say,
//! so that what is steeper than a plane's slack is no ground for it.

use hairpin::campaign::drive::{LEVEL_GROUND, Site};
use hairpin::feasibility::steering::shooting::rough::Steps;
use hairpin::robot::rover::Suspension;
use hairpin::trajectory::drive::{Planar, Segment};
use hairpin::world::terrain::{NoGround, Terrain};

/// Share of a cell that is looked at, and the longest and shortest of such steps, m.
const SHARE: f64 = 0.25;
const LONGEST: f64 = 0.06;
const SHORTEST: f64 = 2e-3;

/// Why a map is no plane along a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Uneven {
    /// It ends, or has no data, after so many metres.
    NoGround { place: NoGround, after_m: f64 },
    /// It is steeper than level by so many rad somewhere.
    Steep(f64),
}

impl Uneven {
    /// By how much the ground is too steep, rad.
    pub(super) fn steeper_by(&self) -> Option<f64> {
        match self {
            Self::Steep(by) => Some(*by),
            Self::NoGround { .. } => None,
        }
    }
}

/// What of the map below the way of `segments` from `start` to `goal` a vehicle without a suspension cannot take for a
/// plane; a missing place goes before the steepest. `None` for a vehicle that stands on its wheels.
pub(super) fn uneven(site: &Site<'_>, start: &Planar, goal: &Planar, segments: &[Segment]) -> Option<Uneven> {
    if site.rover.suspension != Suspension::Level {
        return None;
    }
    let [east, north] = site.map.grid().cell;
    let steps = Steps { length: (SHARE * east.min(north)).clamp(SHORTEST, LONGEST), ..Steps::default() };
    let way = site.way(start, segments, steps);
    let length = way.last().map_or(0.0, |(s, _)| *s);
    let mut steepest = 0.0_f64;
    for (after_m, at) in [(0.0, *start)].into_iter().chain(way).chain([(length, *goal)]) {
        match site.map.patch(at.x, at.y) {
            Ok(ground) => steepest = steepest.max(libm::atan(libm::hypot(ground.slope[0], ground.slope[1]))),
            Err(place) => return Some(Uneven::NoGround { place, after_m }),
        }
    }
    (steepest > LEVEL_GROUND).then_some(Uneven::Steep(steepest - LEVEL_GROUND))
}
