//! Keep-outs for the verification room.

use crate::verification::FlatPlace;
use crate::world::terrain::{KeepOutShape, KeepOuts};

/// `keep_outs` as plain numbers, in their order, m.
pub(in crate::campaign) fn flat_places(keep_outs: &KeepOuts) -> Vec<FlatPlace> {
    let place = |shape: &KeepOutShape| match shape {
        KeepOutShape::Circle { center_m, radius_m } => FlatPlace::Disc(*center_m, *radius_m),
        KeepOutShape::Polygon { points_m } => FlatPlace::Polygon(points_m.clone()),
    };
    keep_outs.list().iter().map(|keep_out| place(&keep_out.shape)).collect()
}
