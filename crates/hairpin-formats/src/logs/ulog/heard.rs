//! Subscriptions under which one instance of a topic was logged: one, or one after another. Of several at one time
//! nobody knows which is the vehicle's.

use std::collections::BTreeSet;

/// The subscriptions that an instance was heard of by.
#[derive(Debug, Default)]
pub(super) struct Heard {
    ids: BTreeSet<u16>,
    now: Option<u16>,
    /// The latest stamp, µs.
    until: f64,
    mixed: bool,
}

impl Heard {
    /// A message of the subscription `id`, with its stamp in µs.
    pub(super) fn hear(&mut self, id: u16, stamp: f64) {
        if self.now.is_some_and(|now| now != id) {
            // It goes on under another number where that begins behind all that was before.
            self.mixed |= self.ids.contains(&id) || stamp <= self.until;
        }
        self.ids.insert(id);
        self.now = Some(id);
        self.until = self.until.max(stamp);
    }

    /// Why nothing is to be judged by it, where that is so.
    pub(super) fn unfit(&self) -> Option<String> {
        self.mixed.then(|| {
            let count = self.ids.len();
            format!("{count} subscriptions to this one instance at one time: nobody knows which is the vehicle's")
        })
    }
}
