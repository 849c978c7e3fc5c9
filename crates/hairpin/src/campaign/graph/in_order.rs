//! A list of waypoints that is there already, held to a reach set.

use nalgebra::Point3;

use crate::campaign::SeenLeg;
use crate::feasibility::reach::Reach;

/// What a search would see of the legs from every point to the one after it; `None` where `reach` lacks one.
///
/// One leg fewer than points. Of several legs to one waypoint the reach set's first is taken.
pub(in crate::campaign) fn in_order<N: Copy, R: Reach<N>>(
    reach: R,
    start: N,
    points: &[Point3<f64>],
) -> Option<Vec<SeenLeg>> {
    let (mut node, mut legs) = (start, Vec::new());
    (1..points.len())
        .map(|next| {
            legs.clear();
            reach.legs(&node, points, &mut legs);
            let leg = legs.iter().find(|leg| leg.waypoint as usize == next)?;
            node = leg.to;
            Some(SeenLeg { features: leg.features, duration: leg.duration })
        })
        .collect()
}
