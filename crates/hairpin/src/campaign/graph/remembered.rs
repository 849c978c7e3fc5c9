//! What rounds of an adaptive campaign leave to each other.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Bytes that are kept at most, about; what is beyond is found anew in every round.
const MOST_BYTES: usize = 512 << 20;

/// What is dear to find and was found of graphs, by their numbers, as long as it is little enough together.
///
/// A cache that changes no answer: legs are functions of their graph.
pub(in crate::campaign) struct Remembered<T> {
    kept: Mutex<Kept<T>>,
}

struct Kept<T> {
    graphs: HashMap<u64, (T, usize)>,
    bytes: usize,
}

impl<T> Default for Remembered<T> {
    fn default() -> Self {
        Self { kept: Mutex::new(Kept { graphs: HashMap::new(), bytes: 0 }) }
    }
}

impl<T> Remembered<T> {
    /// What is known of graph number `graph`; whoever takes it gives it back.
    pub(in crate::campaign) fn take(&self, graph: u64) -> Option<T> {
        let mut kept = self.kept();
        let (found, bytes) = kept.graphs.remove(&graph)?;
        kept.bytes -= bytes;
        Some(found)
    }

    /// Keeps what was found of graph number `graph`, which takes so many bytes, if there is room.
    ///
    /// Half a GiB in all: what finds no room is dropped.
    pub(in crate::campaign) fn keep(&self, graph: u64, found: T, bytes: usize) {
        let mut kept = self.kept();
        if kept.bytes + bytes <= MOST_BYTES {
            kept.bytes += bytes;
            kept.graphs.insert(graph, (found, bytes));
        }
    }

    fn kept(&self) -> MutexGuard<'_, Kept<T>> {
        // Nothing that can panic is done while it is held.
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_much_is_forgotten() {
        let remembered = Remembered::default();
        remembered.keep(1, "one", MOST_BYTES / 2);
        remembered.keep(2, "two", MOST_BYTES / 2);
        remembered.keep(3, "three", 1);
        assert_eq!([1, 2, 3, 1].map(|graph| remembered.take(graph)), [Some("one"), Some("two"), None, None]);
        remembered.keep(3, "three", MOST_BYTES);
        assert_eq!(remembered.take(3), Some("three"));
    }
}
