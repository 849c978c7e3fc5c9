//! The modes that a vehicle was in: which flew its mission, and which did not.

use super::log::{Event, EventKind};

/// The mode that it is in.
#[derive(Debug, Default)]
pub(super) struct Modes {
    flies: bool,
}

impl Modes {
    /// What it means that it goes into a mode that flies a mission, or into another.
    pub(super) fn change(&mut self, flies: bool) -> impl Iterator<Item = EventKind> + use<> {
        let ends = std::mem::replace(&mut self.flies, flies).then_some(EventKind::MissionEnds);
        let begins = if flies { EventKind::MissionBegins } else { EventKind::OtherMode };
        ends.into_iter().chain([begins])
    }
}

/// Events in the order of time. Modes that flew no mission are told where none did.
pub(super) fn in_order(mut events: Vec<Event>) -> Vec<Event> {
    if events.iter().any(|event| event.kind == EventKind::MissionBegins) {
        events.retain(|event| event.kind != EventKind::OtherMode);
    }
    events.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    events
}
