//! The cylinder around a waypoint in which that counts as reached.

use hairpin::campaign::Mission;

/// How far above or below a waypoint counts as reached, m.
pub(super) fn height(mission: &Mission) -> f64 {
    mission.accept
}
