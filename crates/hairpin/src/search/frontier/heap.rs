//! A priority queue with two ends: the best is taken to be expanded, the worst dropped to keep memory bounded.
//!
//! O(log n) to push and to take from either end; no pointers, so that the frontier is one allocation.
//!
//! Van Leeuwen and Wood, "Interval heaps", The Computer Journal 36(3), 1993. The order is a closure given at every
//! call: entries are small numbers into a tree of trajectories, and what they compare by lives there. Every call on one
//! heap must give the same order.

use std::cmp::Ordering;

/// An interval heap (van Leeuwen & Wood, 1993): items 2i and 2i + 1 are the least and the greatest of the subtree of
/// pair i. The order comes with every call, because it needs what the items only point to.
#[derive(Debug, Clone, Default)]
pub(in crate::search) struct IntervalHeap<T> {
    items: Vec<T>,
}

impl<T: Copy> IntervalHeap<T> {
    /// An empty heap, without an allocation.
    pub(in crate::search) fn new() -> Self {
        Self { items: Vec::new() }
    }

    /// Number of items.
    pub(in crate::search) fn len(&self) -> usize {
        self.items.len()
    }

    /// All items, in no order.
    pub(in crate::search) fn items(&self) -> &[T] {
        &self.items
    }

    /// O(log n) comparisons along the side of the heap that the item belongs to.
    ///
    /// Equal items may lie in any order: an order that tells all items apart makes what is taken independent of how
    /// they came.
    pub(in crate::search) fn push(&mut self, item: T, order: impl Fn(&T, &T) -> Ordering) {
        self.items.push(item);
        let at = self.items.len() - 1;
        if at % 2 == 1 {
            if order(&self.items[at], &self.items[at - 1]).is_lt() {
                self.items.swap(at, at - 1);
                self.raise_low(at - 1, order);
            } else {
                self.raise_high(at, order);
            }
        } else if at > 0 {
            if order(&self.items[at], &self.items[low_of_parent(at)]).is_lt() {
                self.raise_low(at, order);
            } else {
                self.raise_high(at, order);
            }
        }
    }

    /// Takes the greatest item.
    ///
    /// `None` when empty. O(log n).
    pub(in crate::search) fn pop_best(&mut self, order: impl Fn(&T, &T) -> Ordering) -> Option<T> {
        let last = self.items.pop()?;
        match self.items.len() {
            0 => return Some(last),
            1 => return Some(last),
            _ => {}
        }
        let best = std::mem::replace(&mut self.items[1], last);
        let (mut at, n) = (1, self.items.len());
        loop {
            if at % 2 == 0 {
                break; // a pair with one item has no children
            }
            if order(&self.items[at], &self.items[at - 1]).is_lt() {
                self.items.swap(at, at - 1);
            }
            let left = 2 * at + 1;
            let high = |low: usize| if low + 1 < n { low + 1 } else { low };
            let mut child = match left - 1 {
                low if low < n => high(low),
                _ => break,
            };
            if left + 1 < n && order(&self.items[high(left + 1)], &self.items[child]).is_gt() {
                child = high(left + 1);
            }
            if order(&self.items[child], &self.items[at]).is_le() {
                break;
            }
            self.items.swap(child, at);
            at = child;
        }
        Some(best)
    }

    /// Takes the least item.
    ///
    /// `None` when empty. O(log n).
    pub(in crate::search) fn pop_worst(&mut self, order: impl Fn(&T, &T) -> Ordering) -> Option<T> {
        let last = self.items.pop()?;
        let n = self.items.len();
        if n == 0 {
            return Some(last);
        }
        let worst = std::mem::replace(&mut self.items[0], last);
        let mut at = 0;
        loop {
            if at + 1 < n && order(&self.items[at], &self.items[at + 1]).is_gt() {
                self.items.swap(at, at + 1);
            }
            let left = 2 * at + 2;
            if left >= n {
                break;
            }
            let mut child = left;
            if left + 2 < n && order(&self.items[left + 2], &self.items[left]).is_lt() {
                child = left + 2;
            }
            if order(&self.items[child], &self.items[at]).is_ge() {
                break;
            }
            self.items.swap(child, at);
            at = child;
        }
        Some(worst)
    }

    /// Up the lows while the item is less than its parent's low: item `at` ≥ 2 has its parent in the pair (⌊at/2⌋ −
    /// 1)/2.
    fn raise_low(&mut self, mut at: usize, order: impl Fn(&T, &T) -> Ordering) {
        while at > 1 {
            let parent = low_of_parent(at);
            if order(&self.items[at], &self.items[parent]).is_ge() {
                break;
            }
            self.items.swap(at, parent);
            at = parent;
        }
    }

    fn raise_high(&mut self, mut at: usize, order: impl Fn(&T, &T) -> Ordering) {
        while at > 1 {
            let parent = low_of_parent(at) + 1;
            if order(&self.items[at], &self.items[parent]).is_le() {
                break;
            }
            self.items.swap(at, parent);
            at = parent;
        }
    }
}

/// Index of the low item of the parent of the pair that item `at` ≥ 2 is in; the pair's high item is the next.
fn low_of_parent(at: usize) -> usize {
    (at / 2 - 1) / 2 * 2
}

#[cfg(feature = "unit-tests")]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::math::random::stream;

    #[test]
    fn agrees_with_a_sorted_list() {
        for seed in 0..200 {
            let mut rng = stream(seed);
            let (mut heap, mut sorted) = (IntervalHeap::new(), Vec::<u32>::new());
            for _ in 0..400 {
                match rng.random_range(0..5) {
                    0 => assert_eq!(heap.pop_best(u32::cmp), sorted.pop(), "seed {seed}"),
                    1 => {
                        let worst = (!sorted.is_empty()).then(|| sorted.remove(0));
                        assert_eq!(heap.pop_worst(u32::cmp), worst, "seed {seed}");
                    }
                    _ => {
                        let item = rng.random_range(0..60);
                        heap.push(item, u32::cmp);
                        sorted.insert(sorted.partition_point(|&x| x < item), item);
                    }
                }
                assert_eq!(heap.len(), sorted.len());
            }
            while let Some(item) = heap.pop_best(u32::cmp) {
                assert_eq!(Some(item), sorted.pop(), "seed {seed}");
            }
            assert!(sorted.is_empty(), "seed {seed}");
        }
    }
}
