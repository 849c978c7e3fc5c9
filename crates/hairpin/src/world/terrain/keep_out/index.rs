//! A tree of boxes: which of many shapes is nearest, without asking all.
//!
//! Branch and bound over boxes: a box at distance d holds no shape nearer than d, and a box around the point none
//! deeper than half of its shapes' shorter sides.

/// Shapes of a leaf at most.
const LEAF: usize = 4;

/// Boxes around ever smaller groups of shapes.
#[derive(Debug, Clone, Default)]
pub(super) struct Index {
    /// Shapes, group by group, with their boxes.
    members: Vec<Member>,
    /// Depth first; the first is around all.
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
struct Member {
    shape: usize,
    bounds: [[f64; 2]; 2],
}

#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: [[f64; 2]; 2],
    /// No point is deeper than this in any of its shapes, m.
    deepest: f64,
    /// First of its members.
    from: usize,
    /// One past the last.
    to: usize,
    /// The node after this one and all that are inside it.
    next: usize,
}

impl Index {
    /// A tree over shapes with these boxes, by their numbers.
    pub(super) fn new(bounds: Vec<[[f64; 2]; 2]>) -> Self {
        let members = bounds.into_iter().enumerate().map(|(shape, bounds)| Member { shape, bounds }).collect();
        let mut index = Self { members, nodes: Vec::new() };
        if !index.members.is_empty() {
            index.grow(0, index.members.len());
        }
        index
    }

    /// Splits at the median along the longer axis until [`LEAF`] members are left; nodes lie in preorder, `next` behind
    /// the whole subtree, so that a walk needs no stack. O(n log² n).
    fn grow(&mut self, from: usize, to: usize) {
        let members = &mut self.members[from..to];
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut deepest: f64 = 0.0;
        for Member { bounds: [least, most], .. } in members.iter() {
            for axis in 0..2 {
                (low[axis], high[axis]) = (low[axis].min(least[axis]), high[axis].max(most[axis]));
            }
            deepest = deepest.max(0.5 * (most[0] - least[0]).min(most[1] - least[1]));
        }
        let node = self.nodes.len();
        self.nodes.push(Node { bounds: [low, high], deepest, from, to, next: 0 });
        if to - from > LEAF {
            let axis = usize::from(high[1] - low[1] > high[0] - low[0]);
            let center = |m: &Member| m.bounds[0][axis] + m.bounds[1][axis];
            members.sort_unstable_by(|a, b| center(a).total_cmp(&center(b)).then(a.shape.cmp(&b.shape)));
            let middle = from.midpoint(to);
            self.grow(from, middle);
            self.grow(middle, to);
        }
        self.nodes[node].next = self.nodes.len();
    }

    /// The shape with the least `distance` from somewhere within `reach` of `at`, and that distance; the first of
    /// equals.
    ///
    /// `distance` must be no less than the distance of `at` to the shape's box less `reach`. Without shapes `None`.
    pub(super) fn least(&self, at: [f64; 2], reach: f64, distance: impl Fn(usize) -> f64) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        // Equals are asked as well, for the first of them.
        let beaten = |best: &Option<(usize, f64)>, bound: f64| best.is_some_and(|(_, least)| bound - reach > least);
        let mut at_node = 0;
        while let Some(node) = self.nodes.get(at_node) {
            let beyond = outside(at, &node.bounds);
            if beaten(&best, if beyond > 0.0 { beyond } else { -node.deepest }) {
                at_node = node.next;
                continue;
            }
            at_node += 1;
            if node.to - node.from > LEAF {
                continue;
            }
            for member in &self.members[node.from..node.to] {
                let beyond = outside(at, &member.bounds);
                if beyond > 0.0 && beaten(&best, beyond) {
                    continue;
                }
                let found = distance(member.shape);
                if best.is_none_or(|(shape, least)| found < least || (found == least && member.shape < shape)) {
                    best = Some((member.shape, found));
                }
            }
        }
        best
    }
}

/// Distance of a point to a box, m; 0 inside.
fn outside(at: [f64; 2], [low, high]: &[[f64; 2]; 2]) -> f64 {
    let beyond = |axis: usize| (low[axis] - at[axis]).max(at[axis] - high[axis]).max(0.0);
    libm::hypot(beyond(0), beyond(1))
}
