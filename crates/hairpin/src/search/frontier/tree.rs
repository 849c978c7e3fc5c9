//! Partial trajectories as a tree: each is its last leg and a link to what came before, so that growing one costs no
//! allocation, and dropping one gives back every beginning that nothing else shares.
//!
//! A frontier of a hundred thousand trajectories of fifty waypoints would hold five million waypoints; sharing
//! beginnings leaves one entry for each extension, freed when its last extension goes.

use std::cmp::Ordering;

/// A partial trajectory: its last node and the one before.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) struct Partial {
    /// Number of the search's node.
    pub(in crate::search) node: u32,
    /// Its waypoint.
    pub(in crate::search) waypoint: u32,
    /// Number of waypoints so far.
    pub(in crate::search) length: u32,
    /// Aggregated score so far.
    pub(in crate::search) score: f64,
    /// Planned duration of the last leg, s.
    pub(in crate::search) duration: f64,
    parent: u32,
    children: u32,
}

/// No parent.
const ROOT: u32 = u32::MAX;

/// All partial trajectories that are alive, and their memories. Slots are used again: memory is as large as the largest
/// number alive at once.
#[derive(Debug, Clone)]
pub(in crate::search) struct Tree<M> {
    partials: Vec<Partial>,
    memories: Vec<M>,
    free: Vec<u32>,
}

impl<M: Clone> Tree<M> {
    /// A tree with its root, number 0: `node` at `waypoint`, length 1.
    pub(in crate::search) fn new(node: u32, waypoint: u32, score: f64, memory: M) -> Self {
        let root = Partial { node, waypoint, length: 1, score, duration: 0.0, parent: ROOT, children: 0 };
        Self { partials: vec![root], memories: vec![memory], free: Vec::new() }
    }

    /// The partial trajectory of a number that was not released.
    pub(in crate::search) fn get(&self, id: u32) -> &Partial {
        &self.partials[id as usize]
    }

    /// What the score carries along it: a value of its own for each partial trajectory, as siblings differ in it.
    pub(in crate::search) fn memory(&self, id: u32) -> &M {
        &self.memories[id as usize]
    }

    /// Number of slots: alive or free.
    #[cfg(feature = "unit-tests")]
    pub(in crate::search) fn slots(&self) -> usize {
        self.partials.len()
    }

    /// A new partial trajectory: `parent` and one more leg.
    ///
    /// Returns its number, which may be one that was given back. `parent` keeps its own and can be extended any number
    /// of times. O(1).
    pub(in crate::search) fn grow(
        &mut self,
        parent: u32,
        (node, waypoint): (u32, u32),
        duration: f64,
        score: f64,
        memory: M,
    ) -> u32 {
        let before = &mut self.partials[parent as usize];
        before.children += 1;
        let length = before.length + 1;
        let partial = Partial { node, waypoint, length, score, duration, parent, children: 0 };
        match self.free.pop() {
            Some(id) => {
                self.partials[id as usize] = partial;
                self.memories[id as usize] = memory;
                id
            }
            None => {
                self.partials.push(partial);
                self.memories.push(memory);
                (self.partials.len() - 1) as u32
            }
        }
    }

    /// Gives back `id`, unless others continue it, and every beginning of it that nothing else needs.
    ///
    /// Amortised O(1): each slot is freed once. The caller must not use `id` again.
    pub(in crate::search) fn release(&mut self, mut id: u32) {
        while self.partials[id as usize].children == 0 {
            self.free.push(id);
            id = self.partials[id as usize].parent;
            if id == ROOT {
                return;
            }
            self.partials[id as usize].children -= 1;
        }
    }

    /// The partial trajectories from `id` back to the start.
    ///
    /// `id` itself first, the root last.
    pub(in crate::search) fn backwards(&self, id: u32) -> impl Iterator<Item = &Partial> {
        let mut next = id;
        std::iter::from_fn(move || {
            let partial = self.partials.get(next as usize)?;
            next = partial.parent;
            Some(partial)
        })
    }

    /// Waypoint indices from the start to `id`.
    pub(in crate::search) fn waypoints(&self, id: u32) -> Vec<u32> {
        let mut list: Vec<u32> = self.backwards(id).map(|p| p.waypoint).collect();
        list.reverse();
        list
    }

    /// Lexicographic order of the waypoint lists, then of the nodes where lists are equal.
    ///
    /// From the leaves towards the common beginning, at which it stops: what differs earliest is met last and
    /// overwrites. A list that begins another comes first.
    pub(in crate::search) fn lexicographic(&self, a: u32, b: u32) -> Ordering {
        let (mut a, mut b) = (a, b);
        let (long_a, long_b) = (self.get(a).length, self.get(b).length);
        while self.get(a).length > long_b {
            a = self.get(a).parent;
        }
        while self.get(b).length > long_a {
            b = self.get(b).parent;
        }
        let (mut by_waypoint, mut by_node) = (Ordering::Equal, Ordering::Equal);
        while a != b {
            let (left, right) = (self.get(a), self.get(b));
            by_waypoint = left.waypoint.cmp(&right.waypoint).then(by_waypoint);
            by_node = left.node.cmp(&right.node).then(by_node);
            (a, b) = (left.parent, right.parent);
        }
        by_waypoint.then(long_a.cmp(&long_b)).then(by_node)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    fn grow(tree: &mut Tree<()>, parent: u32, waypoint: u32) -> u32 {
        tree.grow(parent, (waypoint, waypoint), 1.0, 0.0, ())
    }

    #[test]
    fn what_nothing_shares_is_given_back() {
        let mut tree = Tree::new(0, 0, 0.0, ());
        let a = grow(&mut tree, 0, 1);
        let ab = grow(&mut tree, a, 2);
        let ac = grow(&mut tree, a, 3);
        tree.release(ab);
        assert_eq!(tree.waypoints(ac), [0, 1, 3]);
        tree.release(ac); // takes a and the root with it
        assert_eq!((tree.free.len(), tree.slots()), (4, 4));
    }

    #[test]
    fn lists_are_ordered_as_words_are() {
        let mut tree = Tree::new(0, 0, 0.0, ());
        let (a, b) = (grow(&mut tree, 0, 1), grow(&mut tree, 0, 2));
        let (a9, a3, b1) = (grow(&mut tree, a, 9), grow(&mut tree, a, 3), grow(&mut tree, b, 1));
        let a91 = grow(&mut tree, a9, 1);
        let mut ids = [b1, a91, b, a3, a, a9];
        ids.sort_by(|&x, &y| tree.lexicographic(x, y));
        assert_eq!(ids, [a, a3, a9, a91, b, b1]);
    }
}
