//! The modes that a vehicle was in: which flew its mission, and which did not.

use super::log::{Event, EventKind};

/// Changes of each kind at most.
const MOST: usize = 100_000;

/// Changes of mode in the order of time.
#[derive(Debug, Default)]
pub(super) struct Modes {
    flies: bool,
    missions: Vec<Event>,
    others: Vec<Event>,
}

impl Modes {
    /// At `t_s` it went into a mode that flies a mission, or into another: `words`.
    pub(super) fn change(&mut self, t_s: f64, flies: bool, words: String) {
        let event = |kind: EventKind| Event { t_s, kind, words: words.clone() };
        if std::mem::replace(&mut self.flies, flies) {
            push(&mut self.missions, event(EventKind::MissionEnds));
        }
        match flies {
            true => push(&mut self.missions, event(EventKind::MissionBegins)),
            false => push(&mut self.others, event(EventKind::OtherMode)),
        }
    }

    /// Where missions begin and end; of a vehicle that flew none, what it did instead.
    pub(super) fn into_events(self) -> Vec<Event> {
        if self.missions.is_empty() { self.others } else { self.missions }
    }
}

fn push(events: &mut Vec<Event>, event: Event) {
    if events.len() < MOST {
        events.push(event);
    }
}
