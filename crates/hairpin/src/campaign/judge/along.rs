//! What programs do along their planned paths, as legs, arrivals and violations.

use crate::judgement::moves::Measured;
use crate::judgement::{Late, Violation};
use crate::trajectory::{Channel, Track};

/// `track` with the legs that its samples have along the planned path, where it tells none itself: what moves in joints
/// bulges away from the straight lines between its waypoints, and another leg's may be the nearer one.
pub(super) fn with_legs(track: &Track, legs: &[usize], waypoints: usize) -> Option<Track> {
    if track.channel("leg").is_some() || legs.len() != track.len() {
        return None;
    }
    let last = waypoints.saturating_sub(2);
    let leg = Channel { name: "leg".into(), values: legs.iter().map(|leg| (*leg).min(last) as f64).collect() };
    let channels = track.channels().iter().cloned().chain([leg]).collect();
    Track::new(track.times().to_vec(), track.poses().to_vec(), channels).ok()
}

/// The first target on the way that an arm did not come to though its program's time was over and it ended where that
/// does: who stands at home has ended there. Whether it came to the last is told by how it ended.
pub(super) fn left_out(moves: &Measured) -> Option<Violation> {
    let (_, on_the_way) = moves.moves.split_last()?;
    let leg = on_the_way.iter().position(|one| one.arrived.is_none())?;
    Some(Violation {
        what: "unfinished".into(),
        value: (leg + 1) as f64,
        limit: (moves.moves.len() + 1) as f64,
        unit: "waypoints".into(),
        at: on_the_way[leg].planned,
        leg,
    })
}

/// Of violations by a recording: a late arrival stands only where the samples about it prove that, as the latest of
/// those.
pub(super) fn proven(violations: &mut Vec<Violation>, late: Option<usize>, measured: &Measured) {
    let late = late.and_then(|leg| Some((leg, measured.moves.get(leg)?)));
    violations.retain_mut(|violation| match (violation.what.as_str(), late) {
        ("late", None) => false,
        ("late", Some((leg, one))) => {
            violation.leg = leg;
            violation.value = one.late().unwrap_or(violation.value);
            violation.at = one.arrived.unwrap_or(violation.at);
            true
        }
        _ => true,
    });
}

/// The latest of all arrivals at points; `None` where it arrived nowhere.
pub(super) fn latest(measured: &Measured) -> Option<Late> {
    let arrivals = measured.moves.iter().enumerate();
    let late = arrivals.filter_map(|(leg, m)| Some(Late { by: m.late()?, at: m.arrived?, leg }));
    late.max_by(|a, b| a.by.total_cmp(&b.by))
}
