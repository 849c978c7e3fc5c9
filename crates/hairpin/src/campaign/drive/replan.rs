//! Other waypoints for a case, on the claim that the case stands on.

use nalgebra::Point3;

use super::DriveSetup;
use super::solve::DriveSolver;
use super::stepwise::Stepwise;
use crate::campaign::Case;
use crate::trajectory::Passing;
use crate::world::terrain::Terrain;

/// `case` over `points` (m; heights are the ground's), of which the k-th was its waypoint number `indices[k]` and is
/// passed as that was, if that is feasible as the case is: each leg solved again within the limits where it has drives,
/// by the same reach set, from the task's start, where that was all. Of waypoints made elsewhere nothing was claimed
/// but that they lie on the map. `None`: it is not.
pub(super) fn replan(setup: &DriveSetup, case: &Case, indices: &[usize], points: &[Point3<f64>]) -> Option<Case> {
    let on_ground = |p: &Point3<f64>| Some(Point3::new(p.x, p.y, setup.map.patch(p.x, p.y).ok()?.height));
    let waypoints: Vec<Point3<f64>> = points.iter().map(on_ground).collect::<Option<_>>()?;
    let undriven = |leg_times| Case { waypoints: waypoints.clone(), leg_times, bound: None, ..case.clone() };
    if let Some(drive) = case.commands() {
        let passings: Vec<Passing> = indices
            .iter()
            .zip(&waypoints)
            .map(|(index, p)| Some(drive.passing(*index)?.moved_to(p)))
            .collect::<Option<_>>()?;
        let drive = DriveSolver::new(setup).ok()?.through(case.graph, &passings)?;
        let leg_times = (0..drive.legs.len()).map(|leg| drive.leg_time(leg)).collect();
        return Some(Case { witness: Some(drive.into()), ..undriven(leg_times) });
    }
    if case.leg_times.is_empty() {
        return Some(undriven(Vec::new()));
    }
    let set = Stepwise::new(setup).ok()?;
    let feasible = waypoints.first() == case.waypoints.first() && set.follows(&waypoints).is_some();
    feasible.then(|| undriven(vec![set.step(); waypoints.len() - 1]))
}
