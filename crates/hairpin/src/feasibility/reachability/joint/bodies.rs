//! Links and tool against the cell and against one another, at a configuration and within bounds around it.
//!
//! ```text
//! clear of a region    gap(hull, region) > radius + clearance + displacement + 1 nm
//! clear of a body      gap(hull a, hull b) > r_a + r_b + displacement of b seen from a + 1 nm
//! met                  the same without displacement and room, at the middle
//! ```
//!
//! Conservative by the displacement, which bounds each joint's part by its own lever: halving a piece halves it.

use std::ops::Range;

use nalgebra::{Isometry3, Point3, Vector3};

use crate::feasibility::reachability::Refusal;
use crate::robot::arm::{APART, AXES, Arm, Chain, Frames, Joints, Tool};
use crate::world::Bounds;
use crate::world::cell::{Cell, Region, hulls_gap};

/// The tool's number among the bodies; 0 is the base, k the link that axis k moves.
pub const TOOL: usize = AXES + 1;

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
    bodies: Vec<Body>,
    /// Of all bodies, each in its link's frame.
    points: Vec<Point3<f64>>,
    bounds: Vec<Option<Bounds>>,
    /// Pairs of indices into `bodies`.
    pairs: Vec<(usize, usize)>,
    clearance: f64,
}

/// All points within a radius of a hull of points, two of a capsule.
#[derive(Debug)]
struct Body {
    /// 0 the base, 1 to 6 a link, 7 the tool.
    of: usize,
    /// Its points among those of all.
    points: Range<usize>,
    /// m, ≥ 0.
    radius: f64,
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
        let (mut bodies, mut points) = (Vec::new(), Vec::new());
        let mut add = |of: usize, own: &[Point3<f64>], radius: f64| {
            bodies.push(Body { of, points: points.len()..points.len() + own.len(), radius });
            points.extend_from_slice(own);
        };
        for (link, body) in arm.links.iter().enumerate() {
            body.capsules.iter().for_each(|capsule| add(link, &[capsule.a, capsule.b], capsule.radius));
            body.hulls.iter().for_each(|hull| add(link, &hull.points, hull.radius));
        }
        // Without a tool the flange's centre is one: what users say in words holds for it.
        let in_link = |p: Point3<f64>| arm.chain.flange * p;
        let tip = in_link(tool.tcp.translation.vector.into());
        add(TOOL, &[in_link(Point3::origin()), tip], tool.radius);
        let apart = |a: usize, b: usize| b.min(AXES) >= a + APART && !arm.excluded.contains(&[a, b]);
        let count = bodies.len();
        let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
        let pairs = pairs.filter(|&(i, j)| apart(bodies[i].of, bodies[j].of)).collect();
        let bounds = cell.parts.iter().map(|part| part.region.bounds()).collect();
        Self { arm, cell, bodies, points, bounds, pairs, clearance }
    }

    /// Parted by what their findings are worth: without the pairs of bodies of which neither is known, and, where there
    /// are any, these pairs alone and nothing of the cell.
    pub fn parted(self, is_known: impl Fn(usize) -> bool) -> (Self, Option<Self>) {
        let known = |(i, j): &(usize, usize)| is_known(self.bodies[*i].of) || is_known(self.bodies[*j].of);
        let (sure, doubtful): (Vec<_>, Vec<_>) = self.pairs.iter().copied().partition(known);
        let nothing = &NOTHING;
        let alone = (!doubtful.is_empty()).then(|| Self {
            arm: self.arm,
            cell: nothing,
            bodies: self.bodies.iter().map(Body::again).collect(),
            points: self.points.clone(),
            bounds: Vec::new(),
            pairs: doubtful,
            clearance: 0.0,
        });
        (Self { pairs: sure, ..self }, alone)
    }

    /// What can be said of all configurations within `turns` (rad a joint) of `q`, `at` the share of the move. Counts
    /// questions.
    ///
    /// Distances at `q` against radius + clearance + displacement, where a body's displacement is at most Σ_k turn_k ·
    /// (its distance from axis k).
    ///
    /// Cost: every body against every part whose boxes are near enough, then every pair of bodies; O(bodies · parts).
    /// `Met` ends it at once, `Unknown` tells the first that could not be excluded. The clearance is kept to the cell,
    /// not between links.
    pub(super) fn contact(&self, q: &Joints, turns: &Joints, at: f64, queries: &mut u64) -> Contact {
        let frames = self.arm.chain.frames(q);
        let axes = self.arm.chain.axes(&frames);
        let points = self.placed(&frames);
        let mut unknown = None;
        for Body { of: body, points: own, radius } in &self.bodies {
            let (body, own) = (*body, &points[own.clone()]);
            let moved = Chain::displacement(&axes, body.min(AXES), own, turns);
            let least = radius + self.clearance;
            let room = least + moved + ROUNDING;
            let Some(around) = Bounds::around(own) else { continue };
            for (part, (named, bounds)) in self.cell.parts.iter().zip(&self.bounds).enumerate() {
                // The base does not move: where it stands is the user's choice, unless nothing else stands there.
                // Users' words are about where the tool may be: around the base they would forbid the arm itself.
                let of_tool = matches!(named.region, Region::Words(_));
                if body == 0
                    || (of_tool && body != TOOL)
                    || bounds.is_some_and(|bounds| around.distance_to(&bounds) > room)
                {
                    continue;
                }
                *queries += 1;
                let refused = |undecided| Refusal::Collides { link: body, part, at, undecided };
                match held_against(&named.region, own, least, room) {
                    Held::Clear => {}
                    Held::Met => return Contact::Met(refused(false)),
                    Held::Open => unknown = unknown.or(Some(refused(true))),
                }
            }
        }
        for &(i, j) in &self.pairs {
            let [(low, a, r), (high, b, s)] = [i, j].map(|body| {
                let Body { of, points: own, radius } = &self.bodies[body];
                (*of, &points[own.clone()], *radius)
            });
            *queries += 1;
            // Seen from the lower body, only the joints between the two move the higher one.
            let between: Joints = std::array::from_fn(|k| if k < low { 0.0 } else { turns[k] });
            let room = r + s + Chain::displacement(&axes, high.min(AXES), b, &between) + ROUNDING;
            let gap = hulls_gap(a, b, [r + s, room]);
            if gap.least > room {
                continue;
            }
            let refused = |undecided| Refusal::SelfCollides { links: [low, high], at, undecided };
            if gap.most <= r + s {
                return Contact::Met(refused(false));
            }
            unknown = unknown.or(Some(refused(true)));
        }
        unknown.map_or(Contact::Clear, Contact::Unknown)
    }

    /// The points of all bodies in the base, m.
    fn placed(&self, frames: &Frames) -> Vec<Point3<f64>> {
        let of_body = |body: &'_ Body| {
            let frame: Isometry3<f64> = frames[body.of.min(AXES)];
            self.points[body.points.clone()].iter().map(move |p| frame * p)
        };
        self.bodies.iter().flat_map(of_body).collect()
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
    ///
    /// `corners` in the base, m. Words are asked as [`Region::is_clear`] asks them. The part is told by its index.
    pub fn corner(&self, corners: &[Vector3<f64>; 3], tool_radius: f64, deviation: f64) -> Option<usize> {
        let room = tool_radius + self.clearance + deviation;
        self.cell.parts.iter().position(|part| !triangle_clear(&part.region, corners, room, 0))
    }
}

/// Deepest halving of a triangle.
const DEEPEST: usize = 16;

/// Halved across its longest edge until each part lies so near to that edge that room around the edge proves it.
///
/// At most 2¹⁶ parts; what is not proven then counts as not clear.
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

impl Body {
    fn again(&self) -> Self {
        Self { of: self.of, points: self.points.clone(), radius: self.radius }
    }
}

/// No cell.
static NOTHING: Cell = Cell { parts: Vec::new() };

/// What is known of a hull of points beside a region.
enum Held {
    Clear,
    Met,
    Open,
}

/// Whether a hull of points (two of a capsule) is farther from a region than `room`, or as near as `least`.
///
/// `least` ≤ `room`, m; between the two nothing is said.
fn held_against(region: &Region, points: &[Point3<f64>], least: f64, room: f64) -> Held {
    if let [a, b] = points {
        return match region.is_clear(a, b, room) {
            true => Held::Clear,
            false if region.meets(a, b, least) => Held::Met,
            false => Held::Open,
        };
    }
    // Words are about the tool alone, which is a capsule.
    match region.hull_gap(points, [least, room]) {
        Some(gap) if gap.least > room => Held::Clear,
        Some(gap) if gap.most <= least => Held::Met,
        _ => Held::Open,
    }
}
