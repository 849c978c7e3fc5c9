//! Which of several instances of a topic the vehicle flew by: `primary_instance` of `estimator_selector_status`, for
//! the estimates; of all others nobody says.

use std::collections::BTreeMap;

use super::super::error::Fault;
use super::super::log::{LoggedMotion, Source};
use super::super::samples::Budget;
use super::super::turns::by_turns;
use super::formats::Slot;
use super::topic::Finder;

/// The topic.
pub(super) const TOPIC: &str = "estimator_selector_status";
/// What is chosen from.
const ESTIMATE: &str = "vehicle_local_position";
/// More instances there are not.
const MOST: f64 = 16.0;

/// From when on (s) which instance was chosen.
#[derive(Debug)]
pub(super) struct Selector {
    primary: Slot,
    chosen: Vec<(f64, u32)>,
}

impl Selector {
    /// `None` of a topic without the field.
    pub(super) fn of(finder: &Finder) -> Option<Self> {
        Some(Self { primary: finder.slot("primary_instance")?, chosen: Vec::new() })
    }

    pub(super) fn push(&mut self, t_s: f64, data: &[u8], budget: &mut Budget) -> Result<(), Fault> {
        // Before any is healthy none is chosen, and the number is 255.
        let Some(instance) = self.primary.read(data).filter(|instance| (0.0..MOST).contains(instance)) else {
            return Ok(());
        };
        if self.chosen.last().is_none_or(|(_, before)| *before != instance as u32) {
            budget.take()?;
            self.chosen.push((t_s, instance as u32));
        }
        Ok(())
    }

    pub(super) fn into_chosen(self) -> Vec<(f64, u32)> {
        self.chosen
    }
}

/// Puts what the vehicle flew by before other instances, of the best rank that there is: what it `chosen` of its own
/// estimates. Where nobody says which is meant, neither these nor what ranks after them is known to be what moved.
pub(super) fn settle(chosen: &[(f64, u32)], moved: &mut Vec<(LoggedMotion, u8)>, notes: &mut Vec<String>) {
    let usable = moved.iter().filter(|(motion, _)| motion.samples.len() > 1);
    let Some(best) = usable.map(|(motion, _)| motion.source).min() else { return };
    let is_own = |motion: &LoggedMotion| motion.source == best && motion.samples.len() > 1;
    let places: BTreeMap<u32, usize> =
        moved.iter().enumerate().filter(|(_, (m, _))| is_own(m)).map(|(at, (_, i))| (u32::from(*i), at)).collect();
    let names: Vec<String> = places.values().map(|at| moved[*at].0.name.clone()).collect();
    let Some(first) = places.values().min().copied().filter(|_| names.len() > 1) else { return };
    if best != Source::Estimate || chosen.is_empty() {
        let who = if best == Source::Estimate { format!(" (no {TOPIC})") } else { String::new() };
        notes.push(format!("no word of which of {} is of the vehicle{who}", names.join(", ")));
        let after = moved.iter_mut().filter(|(motion, _)| (best..Source::Untold).contains(&motion.source));
        after.for_each(|(motion, _)| motion.source = Source::Untold);
        return;
    }
    if let Some((_, missing)) = chosen.iter().find(|(_, instance)| !places.contains_key(instance)) {
        let why = format!("the vehicle flew by instance {missing}, whose positions are not in the log");
        notes.push(format!("{ESTIMATE}: {why} ({TOPIC})"));
        places.values().for_each(|at| moved[*at].0.unfit = Some(why.clone()));
        return;
    }
    let flown = match chosen {
        [(_, instance)] => moved.remove(places[instance]),
        _ => {
            let own: BTreeMap<u32, &LoggedMotion> =
                places.iter().map(|(instance, at)| (*instance, &moved[*at].0)).collect();
            (by_turns(&format!("{ESTIMATE}[primary]"), chosen, &own), 0)
        }
    };
    notes.push(format!("{} is what the vehicle flew by ({TOPIC})", flown.0.name));
    moved.insert(first, flown);
}
