//! Targets that a recording has not come to, in sentences: arrivals at them are none, or are not known.

use super::measure::{Measured, MoveMeasures};
use crate::math::decimals::that_differ;

impl Measured {
    /// Why arrivals are none: the first target that the recording was never near, whether it counts as arrived at along
    /// the path or is where it ended. Where the path `is_limited` its limit says how near positions have to come.
    pub fn beside(&self, is_limited: bool) -> Option<String> {
        // What was passed before the recording begins is not seen.
        let moves = self.moves.iter().enumerate().filter(|(_, one)| one.after.is_some());
        let mut approaches = moves.filter_map(|(index, one)| Some((index, one, one.approach?)));
        approaches.find_map(|(index, one, near)| {
            let passed = if one.arrived.is_some() { "passed and never" } else { "never" };
            let least = |most: &str, within: String, of: &str| {
                let target = target(index, one);
                Some(format!("{target} was {passed} come to: {most} at the nearest, {within} taken for there ({of})"))
            };
            if !is_limited && near.distance > near.distance_within {
                let [most, within] = [near.distance, near.distance_within].map(|m| format!("{:.1} mm", 1e3 * m));
                return least(
                    &most,
                    within,
                    "a tenth of the longer move beside it; no limit of the path says how near",
                );
            }
            if near.turn > near.turn_within {
                let [most, within] = [near.turn, near.turn_within].map(|rad| format!("{:.1}°", rad.to_degrees()));
                return least(&most, within, "a tenth of the larger turn beside it, or 0.02 rad");
            }
            None
        })
    }

    /// Why it is not known how late arrivals are: the first target that was never arrived at, as who rests a little
    /// before it for good does not.
    pub fn unarrived(&self) -> Option<String> {
        let (index, one) = self.moves.iter().enumerate().find(|(_, one)| one.left.is_some())?;
        let [left, within] = one.left?.map(|m| 1e3 * m);
        let decimals = that_differ(left, within, 1..=6);
        Some(format!(
            "{} was never arrived at: {left:.decimals$} mm of the way left in the end (1° counts as 1.7 mm), at \
             {within:.decimals$} mm it counts as there; how late that is nobody knows",
            target(index, one)
        ))
    }
}

/// `the target of move 3 (p02→p00)`.
fn target(index: usize, one: &MoveMeasures) -> String {
    format!("the target of move {} ({})", index + 1, one.name)
}
