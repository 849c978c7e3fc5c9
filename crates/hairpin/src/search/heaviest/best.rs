//! The best paths found so far, pairwise different.

/// Up to so many paths, the heaviest first.
///
/// In the order of costs, ties as they came; costs unscaled.
#[derive(Clone)]
pub(super) struct Best {
    wanted: usize,
    /// Backwards is the same path.
    turns: bool,
    paths: Vec<(i64, Vec<usize>)>,
    /// Lighter ones are not wanted.
    least: i64,
}

impl Best {
    /// `wanted` of 0 is taken as 1; `turns`: costs are symmetric, and a path is held with its lesser end first.
    pub(super) fn new(wanted: usize, turns: bool, least: i64) -> Self {
        Self { wanted: wanted.max(1), turns, paths: Vec::new(), least }
    }

    /// Takes a path that is good enough and not there yet; whether it did.
    ///
    /// The caller answers for `cost` being the path's.
    pub(super) fn offer(&mut self, cost: i64, mut path: Vec<usize>) -> bool {
        if self.turns && path.first() > path.last() {
            path.reverse();
        }
        let place = self.paths.partition_point(|(other, _)| *other >= cost);
        if place >= self.wanted || self.paths.iter().any(|(other, known)| *other == cost && *known == path) {
            return false;
        }
        self.paths.insert(place, (cost, path));
        self.paths.truncate(self.wanted);
        true
    }

    /// What a further path must cost to be wanted.
    ///
    /// One more than the worst that is held once there are enough: branch and bound closes what cannot come to it, and
    /// so also closes what is only as good.
    pub(super) fn needed(&self) -> i64 {
        let beaten = if self.paths.len() == self.wanted { self.paths[self.wanted - 1].0 + 1 } else { 0 };
        beaten.max(self.least)
    }

    /// Where bounds should come to: the heaviest cost, or what is wanted if that is more.
    pub(super) fn aim(&self) -> i64 {
        self.cost().max(self.least - 1).max(0)
    }

    /// Wants paths of this cost; what was wanted before.
    pub(super) fn want(&mut self, least: i64) -> i64 {
        std::mem::replace(&mut self.least, least)
    }

    /// The heaviest cost, −1 without a path.
    pub(super) fn cost(&self) -> i64 {
        self.paths.first().map_or(-1, |(cost, _)| *cost)
    }

    /// (cost, points in order), heaviest first.
    pub(super) fn into_paths(self) -> Vec<(i64, Vec<usize>)> {
        self.paths
    }
}
