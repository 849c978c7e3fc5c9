//! Three missions in a row without an answer end it: a program that hangs costs three times its limit, not its limit
//! times the missions.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Missions in a row, in their order, after which a program counts as hanging.
const MOST: usize = 3;

/// What became of each of many missions.
pub(super) struct Patience {
    heard: Mutex<Vec<Heard>>,
    over: AtomicBool,
}

/// What became of one mission.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Heard {
    /// Nothing yet.
    Nothing,
    /// It was answered, well or not.
    Answered,
    /// Its time was over.
    TimedOut,
    /// There was no mission to ask for.
    NotAsked,
}

impl Patience {
    /// Of `count` missions.
    pub(super) fn new(count: usize) -> Self {
        Self { heard: Mutex::new(vec![Heard::Nothing; count]), over: AtomicBool::new(false) }
    }

    /// What became of mission number `index`.
    pub(super) fn note(&self, index: usize, heard: Heard) {
        let mut all = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        all[index] = heard;
        if heard == Heard::TimedOut && hangs(&all) {
            self.over.store(true, Ordering::Relaxed);
        }
    }

    /// Whether the program hangs.
    pub(super) fn is_over(&self) -> bool {
        self.over.load(Ordering::Relaxed)
    }

    /// The missions of which nothing was heard.
    pub(super) fn unheard(&self) -> Vec<usize> {
        let all = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        (0..all.len()).filter(|index| all[*index] == Heard::Nothing).collect()
    }
}

/// Whether so many in a row timed out, with none that was answered between.
fn hangs(all: &[Heard]) -> bool {
    let mut row = 0;
    all.iter().any(|heard| {
        row = match heard {
            Heard::TimedOut => row + 1,
            Heard::NotAsked => row,
            Heard::Answered | Heard::Nothing => 0,
        };
        row >= MOST
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_in_a_row_are_enough() {
        let patience = Patience::new(6);
        for (index, heard) in [(0, Heard::TimedOut), (1, Heard::Answered), (3, Heard::TimedOut), (5, Heard::TimedOut)] {
            patience.note(index, heard);
        }
        assert!(!patience.is_over());
        patience.note(2, Heard::NotAsked);
        patience.note(4, Heard::TimedOut);
        assert!(patience.is_over() && patience.unheard().is_empty());
        let open = Patience::new(4);
        (0..3).for_each(|index| open.note(index, Heard::TimedOut));
        assert_eq!((open.is_over(), open.unheard()), (true, vec![3]));
    }
}
