//! The steady force that is searched beside the waypoints, as numbers between −1 and 1.

use crate::campaign::graph::Plan;
use crate::campaign::scenario::DriveEnvironmentSection;

/// How many numbers there are: east and north.
pub(super) fn coordinates(asked: &DriveEnvironmentSection) -> usize {
    2 * usize::from(asked.external_force_n.is_some())
}

/// `plan` under the force at `place`, as shares of its bound east and north.
///
/// (F east, F north, 0) in N, F the bound; a place within the unit disc is a force within it.
pub(super) fn put(asked: &DriveEnvironmentSection, plan: &Plan, place: &[f64]) -> Plan {
    let mut environment = plan.environment.clone().unwrap_or_default();
    if let (Some(most), [east, north]) = (asked.external_force_n, place) {
        environment.external_force_n = Some([most * east, most * north, 0.0]);
    }
    Plan { environment: Some(environment), ..plan.clone() }
}
