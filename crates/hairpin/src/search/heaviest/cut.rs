//! A cut, and what counts in it. Which ones are priced is for `cuts` to find.

/// S and k.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct Cut {
    /// Whether a point is in S.
    pub(super) inside: Vec<bool>,
    /// k.
    pub(super) except: u32,
    /// |S| − 1.
    pub(super) room: i64,
}

impl Cut {
    /// Whether an arc counts.
    pub(super) fn has_arc(&self, from: u32, to: u32) -> bool {
        self.inside[from as usize] && self.inside[to as usize]
    }

    /// Whether a point counts as left out.
    pub(super) fn has_loop(&self, point: usize) -> bool {
        point as u32 != self.except && self.inside[point]
    }

    /// S in the order of its points, and k.
    pub(super) fn named(&self) -> (Vec<usize>, usize) {
        let points = (0..self.inside.len()).filter(|point| self.inside[*point]).collect();
        (points, self.except as usize)
    }
}
