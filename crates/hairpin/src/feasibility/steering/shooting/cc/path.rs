//! Paths between states of any curvature: words between the states themselves, and between poses at zero curvature that
//! clothoids lead to and from.

use crate::math::fresnel::clothoid;
use crate::trajectory::drive::{Gear, Segment};

use super::super::query::{Curvatures, Query};
use super::turn::{Circle, gear_of};
use super::words::{self, Family, Plan, Pose, Straight};

/// What may be driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gears {
    /// One gear all the way.
    Only(Gear),
    /// With cusps.
    Both,
}

/// A path of continuous curvature: straights, arcs and clothoids. Curvature may jump at cusps, where the vehicle
/// stands.
///
/// Cusps cost no length here and time elsewhere: the vehicle stands there.
///
/// At most fifteen segments: a lead, four turns of up to three, a straight between, a lead; all in the frame of the
/// start.
#[derive(Debug, Clone, Copy)]
pub struct Path {
    /// Metres driven, leads included.
    length_m: f64,
    /// Curvature of its arcs, 1/m.
    most: f64,
    /// From the start's curvature to 0.
    lead_in: Option<Lead>,
    core: Plan,
    /// From 0 to the goal's curvature.
    lead_out: Option<Lead>,
    /// +1: as found; −1: found forward, to be driven in reverse, as its mirror image.
    gear: f64,
}

/// A clothoid to or from zero curvature before or after the words.
///
/// `from` and `to` are curvatures in 1/m, of which one is 0; `gear` is ±1, `length` = |from − to|/rate in m.
#[derive(Debug, Clone, Copy)]
struct Lead {
    length: f64,
    from: f64,
    to: f64,
    gear: f64,
}

/// A state that words may begin or end in.
///
/// A start is left by its `lead`, a goal is come to by it; without one the state itself begins or ends the words, with
/// its own curvature.
#[derive(Debug, Clone, Copy)]
struct Anchor {
    pose: Pose,
    curvature: f64,
    lead: Option<Lead>,
}

/// Shares of the largest curvature that are tried: gentler circles have shorter clothoids, and small moves want those.
const SHARES: [f64; 2] = [1.0, 0.5];
/// Lateral offset (m) and heading (rad) that count as straight ahead.
const STRAIGHT: f64 = 1e-10;

/// The shortest path of these words that solves `query` within `bounds`; there is one for every checked query.
///
/// With [`Gears::Both`] the words of Reeds and Shepp (Pacific J. Math. 145, 1990), else of Dubins, with turns of
/// clothoid, arc, clothoid (Fraichard and Scheuer, IEEE T-RO 20, 2004) that may stand at cusps with their wheels at the
/// stop (Banzhaf et al., IEEE ITSC 2017). Each is the shortest of its family, not of all paths. `None` only where
/// `query` or `bounds` hold numbers that [`Query::new`] refuses.
///
/// Words at the largest curvature and at half of it, from each anchor of the start to each of the goal; a word is given
/// up as soon as it is longer than the best.
pub fn steer(query: &Query, bounds: &Curvatures, gears: Gears) -> Option<Path> {
    let mut best: Option<Path> = None;
    for_each_anchoring(query, bounds, gears, |circle, family, from, to, gear| {
        let leads = from.length() + to.length();
        let below = best.map_or(f64::INFINITY, |path| path.length_m) - leads;
        if libm::hypot(to.pose.x - from.pose.x, to.pose.y - from.pose.y) >= below {
            return;
        }
        if let Some(core) = between(circle, family, from, to, below) {
            best = Some(Path::new(circle, from, core, to, gear));
        }
    });
    best
}

/// Hands over every path of these words that solves `query` within `bounds`, in no order.
///
/// A few hundred at most.
///
/// For a caller who judges drives by more than their length.
pub fn every(query: &Query, bounds: &Curvatures, gears: Gears, mut take: impl FnMut(Path)) {
    for_each_anchoring(query, bounds, gears, |circle, family, from, to, gear| {
        if let Some(straight) = straight_ahead(family, from, to) {
            take(Path::new(circle, from, straight, to, gear));
        }
        let ends = ((from.pose, from.curvature), (to.pose, to.curvature));
        words::every(circle, family, ends.0, ends.1, &mut |core| take(Path::new(circle, from, core, to, gear)));
    });
}

/// The states that words may lie between, with the circle that they are spelt with, and the gear of what is found.
///
/// Anchors of the start times anchors of the goal times two circles: at most 18 pairs. With one gear in reverse
/// everything is mirrored about the y axis, driven forward and told with `gear` −1.
fn for_each_anchoring(
    query: &Query,
    bounds: &Curvatures,
    gears: Gears,
    mut take: impl FnMut(&Circle, Family, &Anchor, &Anchor, f64),
) {
    let reverse = gears == Gears::Only(Gear::Reverse);
    // In reverse: the mirror image about the y axis is driven forward.
    let mirror = if reverse { -1.0 } else { 1.0 };
    let goal = query.goal;
    let end = Pose { x: mirror * goal.x, y: goal.y, heading: mirror * goal.yaw };
    let start = Pose { x: 0.0, y: 0.0, heading: 0.0 };
    let family = if gears == Gears::Both { Family::ReedsShepp } else { Family::Dubins };
    for share in SHARES {
        let circle = Circle::new(bounds, share);
        let starts = anchors(start, query.start_curvature, &circle, family, 1.0);
        let ends = anchors(end, goal.curvature, &circle, family, -1.0);
        for from in starts.iter().flatten() {
            for to in ends.iter().flatten() {
                take(&circle, family, from, to, mirror);
            }
        }
    }
}

/// The straight if that is all there is to do, else the shortest word of less than `below` metres.
fn between(circle: &Circle, family: Family, from: &Anchor, to: &Anchor, below: f64) -> Option<Plan> {
    if let Some(plan) = straight_ahead(family, from, to) {
        return (plan.length < below).then_some(plan);
    }
    words::shortest(circle, family, (from.pose, from.curvature), (to.pose, to.curvature), below)
}

/// Straight on, where that is all there is to do.
///
/// Offsets below 10⁻¹⁰ m and rad are taken for none. Backwards only with cusps.
fn straight_ahead(family: Family, from: &Anchor, to: &Anchor) -> Option<Plan> {
    if from.curvature != 0.0 || to.curvature != 0.0 {
        return None;
    }
    let (sin, cos) = libm::sincos(from.pose.heading);
    let (dx, dy) = (to.pose.x - from.pose.x, to.pose.y - from.pose.y);
    let (ahead, aside) = (cos * dx + sin * dy, cos * dy - sin * dx);
    let turn = to.pose.heading - from.pose.heading;
    let turned = libm::sin(turn).abs().max(1.0 - libm::cos(turn));
    let drivable = ahead >= 0.0 || family == Family::ReedsShepp;
    if aside.abs() >= STRAIGHT || turned >= STRAIGHT || !drivable {
        return None;
    }
    let straight = Straight { before: 0, gear: 1f64.copysign(ahead), length: ahead.abs() };
    Some(Plan { length: straight.length, turns: [None; 4], straight: Some(straight) })
}

/// The states that stand for a start (`along` = 1) or an end (`along` = −1): itself, where the circle can be reached
/// from it, and those at zero curvature that a clothoid joins to it.
///
/// At most three: the state, the one reached by a clothoid forward, the one by a clothoid in reverse. A clothoid of
/// |κ|/rate metres in the gear ±1 turns the heading by ±κ|κ|/(2 rate) as it is driven. Curvatures beyond the circle's
/// own are left by a clothoid only.
fn anchors(pose: Pose, curvature: f64, circle: &Circle, family: Family, along: f64) -> [Option<Anchor>; 3] {
    if curvature == 0.0 {
        return [Some(Anchor { pose, curvature, lead: None }), None, None];
    }
    let direct = curvature.abs() <= circle.curvature * (1.0 + 1e-9);
    let lead = |gear: f64| {
        let length = curvature.abs() / circle.rate;
        // Away from the state: at a start in the gear, at an end against it.
        let way = gear * along;
        let (x, y) = clothoid(curvature, 0.0, circle.rate);
        let (px, py) = pose.place((way * x, y));
        let heading = pose.heading + way * 0.5 * curvature * length;
        let (from, to) = if along > 0.0 { (curvature, 0.0) } else { (0.0, curvature) };
        Anchor { pose: Pose { x: px, y: py, heading }, curvature: 0.0, lead: Some(Lead { length, from, to, gear }) }
    };
    [
        direct.then_some(Anchor { pose, curvature, lead: None }),
        Some(lead(1.0)),
        (family == Family::ReedsShepp).then(|| lead(-1.0)),
    ]
}

impl Anchor {
    /// Of its lead, m.
    fn length(&self) -> f64 {
        self.lead.map_or(0.0, |lead| lead.length)
    }
}

impl Path {
    fn new(circle: &Circle, from: &Anchor, core: Plan, to: &Anchor, gear: f64) -> Self {
        let length_m = core.length + from.length() + to.length();
        Self { length_m, most: circle.curvature, lead_in: from.lead, core, lead_out: to.lead, gear }
    }

    /// Metres driven.
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// Hands over its segments in order, none of them empty; a path of nothing is one straight of 0 m.
    pub fn segments(&self, mut take: impl FnMut(Segment)) {
        let mut taken = 0;
        let mut push = |segment: Segment| {
            if segment.length_m() > 0.0 {
                let gear = if self.gear < 0.0 { segment.gear.opposite() } else { segment.gear };
                take(Segment { gear, ..segment });
                taken += 1;
            }
        };
        let lead = |lead: &Lead| Segment::clothoid(lead.length, lead.from, lead.to, gear_of(lead.gear));
        self.lead_in.iter().for_each(|on| push(lead(on)));
        for (i, turn) in self.core.turns.iter().enumerate() {
            if let Some(straight) = self.core.straight.filter(|straight| straight.before == i) {
                push(Segment::straight(straight.length, gear_of(straight.gear)));
            }
            turn.iter().for_each(|turn| turn.segments(self.most, &mut push));
        }
        self.lead_out.iter().for_each(|off| push(lead(off)));
        if taken == 0 {
            take(Segment::straight(0.0, gear_of(self.gear)));
        }
    }
}
