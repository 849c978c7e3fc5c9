//! What a random walk over waypoints keeps to, whatever its legs are.

/// Legs asked for, by those that a drive has, before other waypoints are tried.
const ASKED: u64 = 40;

/// What a walk over waypoints keeps to beside its reach set.
#[derive(Debug, Clone, Copy)]
pub(super) struct Walking {
    /// Waypoints of a trajectory.
    pub(super) length: usize,
    /// Number of the waypoint that it ends at, and at no other place passes; `None`: anywhere.
    pub(super) end: Option<u32>,
    /// Whether a waypoint may come twice.
    pub(super) revisits: bool,
}

impl Walking {
    /// Whether `waypoint` may follow the waypoints `passed`.
    ///
    /// With an end, that comes last and only then; without revisits no waypoint comes twice. O(waypoints passed).
    pub(super) fn may_follow(&self, passed: impl ExactSizeIterator<Item = u32>, waypoint: u32) -> bool {
        let is_last = passed.len() + 1 == self.length;
        let arrives = self.end.is_none_or(|end| (waypoint == end) == is_last);
        arrives && (self.revisits || !{ passed }.any(|before| before == waypoint))
    }

    /// Legs that are asked for at most.
    pub(super) fn most(&self) -> u64 {
        ASKED * (self.length as u64).max(1)
    }
}
