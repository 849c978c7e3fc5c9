//! In which gear the legs of a drive are planned, and what a mission says of it.

use hairpin::trajectory::drive::{Gear, Motion, Segment};
use hairpin_formats::qgc::mission::Autopilot;

/// Of each leg whether it is planned backwards; `None` where both occur on it.
pub(super) fn backwards<'a>(legs: impl Iterator<Item = &'a [Segment]>) -> Vec<Option<bool>> {
    let has = |leg: &[Segment], gear: Gear| {
        leg.iter().any(|segment| segment.gear == gear && matches!(segment.motion, Motion::Arc { .. }))
    };
    let one = |leg: &[Segment]| {
        let back = has(leg, Gear::Reverse);
        (!(back && has(leg, Gear::Forward))).then_some(back)
    };
    legs.map(one).collect()
}

/// What the user has to know of legs that are not driven forwards; `None` where there are none.
pub(super) fn told(backwards: &[Option<bool>], autopilot: Autopilot) -> Option<String> {
    let of = |gear: Option<bool>| -> Vec<String> {
        let legs = backwards.iter().enumerate().filter(|(_, leg)| **leg == gear);
        legs.map(|(leg, _)| format!("{leg}→{}", leg + 1)).collect()
    };
    let (back, both) = (of(Some(true)), of(None));
    let planned = [(&back, "backwards"), (&both, "in both gears")];
    let words: Vec<String> = planned
        .iter()
        .filter(|(legs, _)| !legs.is_empty())
        .map(|(legs, gear)| format!("{} {gear}", legs.join(", ")))
        .collect();
    let says = match autopilot {
        Autopilot::Px4 => "missions of PX4 have no gear: the vehicle turns as its mode has it",
        Autopilot::ArduPilot if both.is_empty() => "DO_SET_REVERSE says so",
        Autopilot::ArduPilot => "DO_SET_REVERSE says so of whole legs; where both occur on one, no mission can",
    };
    (!words.is_empty()).then(|| format!("legs planned {}: {says}", words.join("; ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn legs_have_the_gear_that_they_are_driven_in() {
        let arc = |gear: Gear| Segment { motion: Motion::Arc { length_m: 1.0, curvature: [0.0; 6] }, gear };
        let turn = Segment { motion: Motion::Turn { angle_rad: 1.0 }, gear: Gear::Forward };
        let (ahead, back) = (arc(Gear::Forward), arc(Gear::Reverse));
        let legs = [&[ahead][..], &[turn, back], &[ahead, back], &[turn]];
        let gears = backwards(legs.into_iter());
        assert_eq!(gears, [Some(false), Some(true), None, Some(false)]);
        let words = told(&gears[..3], Autopilot::ArduPilot).expect("backwards");
        assert!(words.starts_with("legs planned 1→2 backwards; 2→3 in both gears: DO_SET_REVERSE"), "{words}");
        assert_eq!(told(&gears[..1], Autopilot::Px4), None);
    }
}
