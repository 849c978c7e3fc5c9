//! Links and tool against the cell and against one another, at a configuration and within bounds around it.

use nalgebra::{Isometry3, Point3, Vector3};

use crate::feasibility::reachability::Refusal;
use crate::math::segment::segment_distance;
use crate::robot::arm::{AXES, Arm, Capsule, Chain, Frames, Joints, Tool};
use crate::world::Bounds;
use crate::world::cell::{Cell, Region};

/// The tool's number among the bodies; 0 is the base, k the link that axis k moves.
pub const TOOL: usize = AXES + 1;

/// Bodies this many joints apart are held against one another; nearer ones are kept apart by the joints' limits.
const APART: usize = 3;
/// Room for the rounding of positions and distances, m.
const ROUNDING: f64 = 1e-9;

/// Everything of an arm that takes up room, and what stands around it.
///
/// Neighbours in the chain are not held against one another: joint limits keep them apart. The base is not held against
/// the cell.
#[derive(Debug)]
pub struct Bodies<'a> {
    arm: &'a Arm,
    cell: &'a Cell,
    capsules: Vec<(usize, Capsule)>,
    bounds: Vec<Option<Bounds>>,
    /// Pairs of indices into `capsules`.
    pairs: Vec<(usize, usize)>,
    clearance: f64,
}

/// What is known of a piece of a move.
pub(super) enum Contact {
    /// No body meets anything on the whole piece.
    Clear,
    /// At its middle one does.
    Met(Refusal),
    /// Neither; what would have to be excluded.
    Unknown(Refusal),
}

impl<'a> Bodies<'a> {
    /// Of an arm with a tool in a cell, everything to be kept `clearance` (m, ≥ 0) from the cell.
    ///
    /// The tool is a capsule from the flange's centre to its point, with its own radius.
    pub fn new(arm: &'a Arm, tool: &Tool, cell: &'a Cell, clearance: f64) -> Self {
        let links = arm.links.iter().enumerate();
        let mut capsules: Vec<(usize, Capsule)> =
            links.flat_map(|(link, body)| body.capsules.iter().map(move |capsule| (link, *capsule))).collect();
        // Without a tool the flange's centre is one: what users say in words holds for it.
        let in_link = |p: Point3<f64>| arm.chain.flange * p;
        let tip = in_link(tool.tcp.translation.vector.into());
        capsules.push((TOOL, Capsule { a: in_link(Point3::origin()), b: tip, radius: tool.radius }));
        let apart = |a: usize, b: usize| b.min(AXES) >= a + APART;
        let count = capsules.len();
        let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
        let pairs = pairs.filter(|&(i, j)| apart(capsules[i].0, capsules[j].0)).collect();
        let bounds = cell.parts.iter().map(|part| part.region.bounds()).collect();
        Self { arm, cell, capsules, bounds, pairs, clearance }
    }

    /// What can be said of all configurations within `turns` (rad a joint) of `q`, `at` the share of the move. Counts
    /// questions.
    ///
    /// Distances at `q` against radius + clearance + displacement, where a body's displacement is at most Σ_k turn_k ·
    /// (its distance from axis k).
    pub(super) fn contact(&self, q: &Joints, turns: &Joints, at: f64, queries: &mut u64) -> Contact {
        let frames = self.arm.chain.frames(q);
        let axes = self.arm.chain.axes(&frames);
        let placed: Vec<(usize, Point3<f64>, Point3<f64>, f64)> =
            self.capsules.iter().map(|(body, capsule)| place(*body, capsule, &frames)).collect();
        let mut unknown = None;
        for &(body, a, b, radius) in &placed {
            let moved = Chain::displacement(&axes, body.min(AXES), &[a, b], turns);
            let least = radius + self.clearance;
            let room = least + moved + ROUNDING;
            let own = Bounds { min: a.inf(&b), max: a.sup(&b) };
            for (part, (named, bounds)) in self.cell.parts.iter().zip(&self.bounds).enumerate() {
                // The base does not move: where it stands is the user's choice, unless nothing else stands there.
                // Users' words are about where the tool may be: around the base they would forbid the arm itself.
                let of_tool = matches!(named.region, Region::Words(_));
                if body == 0
                    || (of_tool && body != TOOL)
                    || bounds.is_some_and(|bounds| own.distance_to(&bounds) > room)
                {
                    continue;
                }
                *queries += 1;
                if named.region.is_clear(&a, &b, room) {
                    continue;
                }
                let refused = |undecided| Refusal::Collides { link: body, part, at, undecided };
                if named.region.meets(&a, &b, least) {
                    return Contact::Met(refused(false));
                }
                unknown = unknown.or(Some(refused(true)));
            }
        }
        for &(i, j) in &self.pairs {
            let ((low, a, b, r), (high, c, d, s)) = (placed[i], placed[j]);
            *queries += 1;
            let distance = segment_distance(&a, &b, &c, &d);
            // Seen from the lower body, only the joints between the two move the higher one.
            let between: Joints = std::array::from_fn(|k| if k < low { 0.0 } else { turns[k] });
            if distance > r + s + Chain::displacement(&axes, high.min(AXES), &[c, d], &between) + ROUNDING {
                continue;
            }
            let refused = |undecided| Refusal::SelfCollides { links: [low, high], at, undecided };
            if distance <= r + s {
                return Contact::Met(refused(false));
            }
            unknown = unknown.or(Some(refused(true)));
        }
        unknown.map_or(Contact::Clear, Contact::Unknown)
    }

    /// Why the arm cannot stand at `q`; `None` where it can. `at` is told.
    ///
    /// What is undecided is refused as well.
    pub fn standing(&self, q: &Joints, at: f64) -> Option<Refusal> {
        match self.contact(q, &[0.0; AXES], at, &mut 0) {
            Contact::Clear => None,
            Contact::Met(refusal) | Contact::Unknown(refusal) => Some(refusal),
        }
    }

    /// Whether the triangle between three points of the tool's way is free of the cell, grown by the tool's own radius,
    /// the clearance and `deviation` (m): what the tool's point may pass through where a corner is rounded. The part
    /// that is not, otherwise.
    pub fn corner(&self, corners: &[Vector3<f64>; 3], tool_radius: f64, deviation: f64) -> Option<usize> {
        let room = tool_radius + self.clearance + deviation;
        self.cell.parts.iter().position(|part| !triangle_clear(&part.region, corners, room, 0))
    }
}

/// Deepest halving of a triangle.
const DEEPEST: usize = 16;

/// Halved across its longest edge until each part lies so near to that edge that room around the edge proves it.
fn triangle_clear(region: &Region, corners: &[Vector3<f64>; 3], room: f64, depth: usize) -> bool {
    let [a, b, c] = corners;
    // Put the longest edge first.
    let (ab, bc, ca) = ((b - a).norm(), (c - b).norm(), (a - c).norm());
    let (a, b, c) = if ab >= bc && ab >= ca {
        (a, b, c)
    } else if bc >= ca {
        (b, c, a)
    } else {
        (c, a, b)
    };
    let edge = b - a;
    let height = edge.cross(&(c - a)).norm() / edge.norm().max(f64::MIN_POSITIVE);
    // Every point of the triangle lies within its height of the longest edge.
    if region.is_clear(&(*a).into(), &(*b).into(), room + height + ROUNDING) {
        return true;
    }
    if depth == DEEPEST || region.meets(&(*a).into(), &(*b).into(), room) {
        return false;
    }
    let middle = (a + b) * 0.5;
    triangle_clear(region, &[*a, middle, *c], room, depth + 1)
        && triangle_clear(region, &[middle, *b, *c], room, depth + 1)
}

/// A capsule in the base: number, both ends (m), radius (m).
fn place(body: usize, capsule: &Capsule, frames: &Frames) -> (usize, Point3<f64>, Point3<f64>, f64) {
    let frame: &Isometry3<f64> = &frames[body.min(AXES)];
    (body, frame * capsule.a, frame * capsule.b, capsule.radius)
}
