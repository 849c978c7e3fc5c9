//! A list of waypoints that is there already, held to a reach set.

use nalgebra::Point3;

use crate::feasibility::reach::Reach;

/// Whether `reach` has a leg from every point to the one after it.
pub(in crate::campaign) fn in_order<N: Copy, R: Reach<N>>(reach: R, start: N, points: &[Point3<f64>]) -> bool {
    let (mut node, mut legs) = (start, Vec::new());
    (1..points.len()).all(|next| {
        legs.clear();
        reach.legs(&node, points, &mut legs);
        let leg = legs.iter().find(|leg| leg.waypoint as usize == next);
        leg.map(|leg| node = leg.to).is_some()
    })
}
