//! Which legs of a log were gone backwards: a deviation is of places, which the gear does not change, and so this is
//! told beside it.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::DriveSetup;
use crate::campaign::Case;
use crate::trajectory::drive::{Gear, Motion};
use crate::trajectory::{ATTITUDE_UNKNOWN, Track};

/// Way against the heading that is none but noise, m.
const LEAST: f64 = 0.1;

/// In words, plan and log beside each other; `None` where headings are not known or say nothing of the gear, as of what
/// goes sideways, and where no leg was gone backwards.
///
/// Signed way of each leg: Σ Δp · x̂, x̂ the body's forward axis; below −0.1 m it was gone backwards.
pub(super) fn backwards(setup: &DriveSetup, case: &Case, track: &Track) -> Option<String> {
    if track.channel(ATTITUDE_UNKNOWN).is_some() || setup.directions() != [0.0; 2] {
        return None;
    }
    let legs = track.channel("leg")?;
    let mut ways: BTreeMap<usize, f64> = BTreeMap::new();
    for (leg, pair) in legs.iter().skip(1).zip(track.poses().windows(2)) {
        let way = pair[1].translation.vector - pair[0].translation.vector;
        *ways.entry(*leg as usize).or_default() += way.dot(&(pair[0].rotation * Vector3::x()));
    }
    let gone: Vec<usize> = ways.into_iter().filter(|(_, way)| *way < -LEAST).map(|(leg, _)| leg).collect();
    let numbers = |legs: &[usize]| legs.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let (planned, unplanned): (Vec<usize>, Vec<usize>) = gone.iter().partition(|leg| is_in_reverse(case, **leg));
    let against = match (case.commands(), unplanned.is_empty(), planned.is_empty()) {
        (None, ..) => "",
        (Some(_), true, _) => ", as planned",
        (Some(_), false, true) => ", where the plan goes forward",
        (Some(_), false, false) => ", not all as planned",
    };
    let told = format!(
        "gone backwards: legs {}{against}; deviations are of places, which the gear does not change",
        numbers(&gone)
    );
    (!gone.is_empty()).then_some(told)
}

/// Whether leg `leg` of the plan goes more way in reverse than forward.
///
/// By metres, not by time: Σ length of forward arcs less those in reverse is below 0.
fn is_in_reverse(case: &Case, leg: usize) -> bool {
    let way = |gear: Gear, length: f64| if gear == Gear::Reverse { -length } else { length };
    let planned = case.commands().and_then(|drive| drive.legs.get(leg));
    let ways = planned.iter().flat_map(|leg| &leg.segments).map(|segment| match segment.motion {
        Motion::Arc { length_m, .. } => way(segment.gear, length_m),
        Motion::Turn { .. } => 0.0,
    });
    ways.sum::<f64>() < 0.0
}
