//! Which core of which filter the vehicle flew by: `PI` of XKF4 and NKF4.

use std::collections::BTreeMap;

use super::super::log::{LoggedMotion, Source};
use super::super::turns::by_turns;

/// A core of a filter: the message that its positions are in, and its number.
type Core = (String, u32);

/// Cores, and from when on (s) which of a filter's was the primary one.
#[derive(Debug, Default)]
pub(super) struct Cores {
    /// By the names of motions.
    seen: BTreeMap<String, Core>,
    primary: BTreeMap<String, Vec<(f64, u32)>>,
}

impl Cores {
    /// A position of the motion `name` is of a core of the filter whose positions are in `message`.
    pub(super) fn seen(&mut self, name: &str, message: &str, core: f64) {
        if !self.seen.contains_key(name) {
            self.seen.insert(name.to_owned(), (message.to_owned(), core as u32));
        }
    }

    /// The filter whose positions are in `message` names its primary core; whether that is another than before.
    pub(super) fn name(&mut self, message: &str, t_s: f64, core: f64) -> bool {
        // More cores there are not: before it runs a filter has none.
        if !(0.0..16.0).contains(&core) {
            return false;
        }
        let primary = self.primary.entry(message.to_owned()).or_default();
        let is_new = primary.last().is_none_or(|(_, before)| *before != core as u32);
        if is_new {
            primary.push((t_s, core as u32));
        }
        is_new
    }

    /// Puts what the vehicle flew by before other cores of `motions`. Where nobody tells it, none of the filters'
    /// counts as the vehicle's own estimate.
    pub(super) fn settle(&self, motions: &mut Vec<LoggedMotion>, notes: &mut Vec<String>) {
        // POS is the estimate that the vehicle took, whichever core it was of.
        if motions.iter().any(|motion| motion.name == "POS" && motion.samples.len() > 1) {
            return;
        }
        let core = |(place, motion): (usize, &LoggedMotion)| Some((place, self.seen.get(&motion.name)?));
        let own: Vec<(usize, &Core)> = motions.iter().enumerate().filter_map(core).collect();
        let Some((first, (message, core))) = own.first().copied() else { return };
        let is_one_filter = own.iter().all(|(_, (other, _))| other == message);
        match self.primary.get(message).map(Vec::as_slice).filter(|_| is_one_filter) {
            None | Some([]) if own.len() == 1 => {}
            None | Some([]) => {
                notes.push("no word of which core of which filter (XKF4.PI) the vehicle flew by".into());
                let estimates = motions.iter_mut().filter(|motion| motion.source == Source::Estimate);
                estimates.for_each(|motion| motion.source = Source::Untold);
            }
            Some([(_, primary)]) if own.len() == 1 && primary == core => {}
            Some(primary) => {
                let places: BTreeMap<u32, usize> = own.iter().map(|(place, (_, core))| (*core, *place)).collect();
                if let Some((_, missing)) = primary.iter().find(|(_, core)| !places.contains_key(core)) {
                    let why = format!("the vehicle flew by core {missing}, whose positions are not in the log");
                    notes.push(format!("{message}: {why}"));
                    own.iter().for_each(|(place, _)| motions[*place].unfit = Some(why.clone()));
                    return;
                }
                let flown = match primary {
                    [(_, core)] => motions.remove(places[core]),
                    _ => {
                        let own = places.iter().map(|(core, place)| (*core, &motions[*place])).collect();
                        by_turns(&format!("{message}[primary]"), primary, &own)
                    }
                };
                notes.push(format!("{} is what the vehicle flew by (XKF4.PI)", flown.name));
                motions.insert(first, flown);
            }
        }
    }
}
