//! The modes that a vehicle was in: which flew its mission, and which did not.

use super::log::{Event, EventKind};

/// What is flown in a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Flies {
    /// What was uploaded.
    Uploaded,
    /// What is sent from outside.
    Sent,
    /// No mission.
    Other,
}

/// Changes of the mode among all that is told.
#[derive(Debug, Default)]
pub(super) struct Modes {
    /// The event that stands for it, and what is flown from there on.
    changes: Vec<(usize, Flies)>,
}

impl Modes {
    /// From now on it is in another mode: its event is the next of `events`.
    pub(super) fn go(&mut self, events: &[Event], flies: Flies) {
        self.changes.push((events.len(), flies));
    }

    /// `events` with the beginnings and ends of the mission in place of changes of the mode.
    ///
    /// Where a log has both it is the uploaded one: who is sent somewhere before is on the way to its start.
    pub(super) fn settle(self, events: Vec<Event>) -> Vec<Event> {
        let is_uploaded = self.changes.iter().any(|(_, flies)| *flies == Flies::Uploaded);
        let mission = if is_uploaded { Flies::Uploaded } else { Flies::Sent };
        let (mut settled, mut flying) = (Vec::with_capacity(events.len()), false);
        let mut changes = self.changes.into_iter().peekable();
        for (index, event) in events.into_iter().enumerate() {
            let Some((_, flies)) = changes.next_if(|(at, _)| *at == index) else {
                settled.push(event);
                continue;
            };
            if flying {
                settled.push(Event { kind: EventKind::MissionEnds, ..event.clone() });
            }
            flying = flies == mission;
            let kind = if flying { EventKind::MissionBegins } else { EventKind::OtherMode };
            settled.push(Event { kind, ..event });
        }
        settled
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_uploaded_is_the_mission_where_both_are_flown() {
        let events = |flown: &[(f64, Flies)]| {
            let (mut modes, mut events) = (Modes::default(), Vec::new());
            for (t_s, flies) in flown {
                modes.go(&events, *flies);
                events.push(Event { t_s: *t_s, kind: EventKind::OtherMode, words: String::new() });
                events.push(Event { t_s: *t_s, kind: EventKind::TookOff, words: String::new() });
            }
            let all = in_order(modes.settle(events)).into_iter().map(|event| (event.t_s, event.kind));
            all.filter(|(_, kind)| *kind != EventKind::TookOff).collect::<Vec<_>>()
        };
        let (begins, ends) = (EventKind::MissionBegins, EventKind::MissionEnds);
        let (sent, uploaded, other) = (Flies::Sent, Flies::Uploaded, Flies::Other);
        // Sent to the start, and flown from there.
        assert_eq!(events(&[(1.0, sent), (2.0, uploaded), (9.0, other)]), [(2.0, begins), (9.0, ends)]);
        assert_eq!(events(&[(1.0, uploaded), (2.0, sent), (9.0, other)]), [(1.0, begins), (2.0, ends)]);
        // Alone it is the mission.
        assert_eq!(events(&[(0.0, other), (1.0, sent), (9.0, other)]), [(1.0, begins), (9.0, ends)]);
        assert_eq!(events(&[(0.0, other)]), [(0.0, EventKind::OtherMode)]);
    }
}
