//! From moves to sections of path: legs, the blends between them, and the joint angles along both.
//!
//! A zone of radius r adds the end of one move and the beginning of the next about their corner: u = 1 − (r/ℓ₁)(1 −
//! w)², v = (r/ℓ₂) w², p = p₁(u) + p₂(v) − C, w in [0, 1], a parabola between straight lines
//! (docs/virtual-controller.md). s grows by 2r, so that the path is C¹ in s.
//!
//! Data flow: orders → legs with their curves ([`Builder::leg`]) → along each to where its zone begins → blended with
//! the next, or stopped → sections of nodes with joint angles, whose slopes are laid at the end ([`Section::shape`]).
//! What cannot be followed ends the path with a [`Stop`]; what comes before it stays.

use nalgebra::Isometry3;

use super::curve::{Curve, METRES_PER_RADIAN, ToolCurve, between, largest_turn};
use super::follow::{Follower, Reason, Stop};
use super::grid::{Section, Span};
use super::order::{Order, Target, Zone};
use crate::math::rotation::rotation_vector;
use crate::robot::arm::{Branch, Configuration, Joints};

/// Longest step along a line, m.
/// Between nodes joints are cubics: at 10 mm a straight line is off by less than a micrometre.
const LINE_STEP: f64 = 0.01;
/// Longest step of a turn or an arc, rad, and of a joint that moves by itself.
const TURN_STEP: f64 = 0.035;
/// Where a joint turns more than this (rad) from node to node of a followed path, nodes are doubled.
const JOINT_STEP: f64 = 0.06;
/// Spans of a piece at most by doubling.
const MOST_SPANS: usize = 512;
/// Spans of a blend; even, as its middle is where the target is passed.
/// At least 8 on either side of the corner.
const BLEND_SPANS: usize = 16;
/// Shorter than this (in s, m) is no move.
const NOTHING: f64 = 1e-9;

/// A move with its curve.
///
/// The solver's branch is that of where it begins: a path of the tool never changes it.
///
/// `order` is its number; `wanted` the configuration that its end must have.
struct Leg<'a> {
    order: usize,
    given: &'a Order,
    curve: Curve,
    /// What its whole share adds to s: the longest of the tool's way, its turn and (of joint moves) the largest joint
    /// turn.
    length: f64,
    /// Metres of the tool's way and radians of its turn per unit of s.
    rates: [f64; 2],
    /// `tcp_from_flange`.
    flange: Isometry3<f64>,
    branch: Branch,
    wanted: Option<Configuration>,
}

/// The path of a program, as far as it can be followed.
///
/// A section is a motion from rest to rest: its law is laid by itself.
pub(super) struct Path {
    /// From stop to stop, at least one.
    pub(super) sections: Vec<Section>,
    /// Where it could not be followed any more; times are not known yet.
    pub(super) stop: Option<Stop>,
    /// Inverse kinematics iterations of each move.
    pub(super) iterations: Vec<u64>,
}

/// Lays the path of `orders` from the joint angles `start`.
///
/// Linear in the length of the path: a node every 10 mm, 2° of turning or of a joint, doubled until joints turn no more
/// than 0.06 rad a span; each node of a tool path is one inverse.
pub(super) fn lay(follower: Follower, start: &Joints, orders: &[Order]) -> Path {
    let pose = |tool: &Isometry3<f64>| follower.arm.forward(start) * tool;
    let first = Section::from(*start, orders.first().map_or_else(Isometry3::identity, |order| pose(&order.tool)));
    let path = Path { sections: vec![first], stop: None, iterations: vec![0; orders.len()] };
    let mut builder = Builder { follower, orders, path, joints: *start };
    let stopped = builder.all();
    let Builder { mut path, .. } = builder;
    if let Err(stop) = stopped {
        path.stop = Some(stop);
        if let Some(section) = path.sections.last_mut() {
            section.join();
        }
    }
    for section in &mut path.sections {
        section.shape();
    }
    path
}

/// Goes forward only; a blend looks ahead to the next leg's beginning.
struct Builder<'a> {
    follower: Follower<'a>,
    orders: &'a [Order],
    path: Path,
    /// Where the last node is, or where the corner lies that the next leg begins at.
    joints: Joints,
}

impl<'a> Builder<'a> {
    /// Leg after leg: along each from where the blend before it ended to where the next one begins, then the blend. A
    /// zone's radius is at most half of both of its legs; zones of no size stop in the corner.
    fn all(&mut self) -> Result<(), Stop> {
        let Some(first) = self.orders.first() else { return Ok(()) };
        let mut corner = self.follower.arm.forward(&self.joints) * first.tool;
        let mut leg = self.leg(0, &self.joints.clone(), &corner)?;
        let mut entry = 0.0;
        loop {
            let next = leg.order + 1;
            let radius = match leg.given.zone {
                Zone::Radius(radius) if next < self.orders.len() => radius.min(0.5 * leg.length),
                _ => 0.0,
            };
            let exit = if leg.length < NOTHING { 1.0 } else { 1.0 - radius / leg.length };
            if radius < NOTHING {
                self.along(&leg, entry, 1.0)?;
                self.met(&leg, 1.0)?;
                if next == self.orders.len() {
                    self.mark(leg.order);
                    return Ok(());
                }
                self.stop_at(&leg);
                corner = self.corner(&leg, next);
                (leg, entry) = (self.leg(next, &self.joints.clone(), &corner)?, 0.0);
                continue;
            }
            // The next leg begins at the corner, wherever this one is left. What cannot be met is still approached.
            let (at_corner, pose) = match self.ahead(&leg, exit) {
                Ok(corner) => corner,
                Err(stop) => return self.along(&leg, entry, 1.0).and(Err(stop)),
            };
            corner = if self.orders[next].tool == leg.given.tool {
                pose
            } else {
                self.follower.arm.forward(&at_corner) * self.orders[next].tool
            };
            let following = match self.leg(next, &at_corner, &corner) {
                Ok(following) => following,
                Err(stop) => {
                    self.along(&leg, entry, 1.0)?;
                    self.mark(leg.order);
                    return Err(stop);
                }
            };
            let radius = radius.min(0.5 * following.length);
            if radius < NOTHING {
                self.along(&leg, entry, 1.0)?;
                self.met(&leg, 1.0)?;
                self.stop_at(&leg);
                (leg, entry) = (following, 0.0);
                continue;
            }
            let exit = 1.0 - radius / leg.length;
            self.along(&leg, entry, exit)?;
            entry = radius / following.length;
            self.blend(&leg, &following, radius, &at_corner)?;
            leg = following;
        }
    }

    /// Where the tool of move `next` is, now that `leg` has ended.
    fn corner(&self, leg: &Leg, next: usize) -> Isometry3<f64> {
        match &leg.curve {
            Curve::Tool(curve) if self.orders[next].tool == leg.given.tool => curve.at(1.0),
            _ => self.follower.arm.forward(&self.joints) * self.orders[next].tool,
        }
    }

    /// Move `order` from the joint angles `from`, where its tool is at `pose`.
    ///
    /// The length in s is max(way, 0.01 m/1.5° · max(turn, largest joint turn)): m, whatever the move does.
    ///
    /// # Errors
    /// A target out of reach or bounds, a configuration that is not there, points that give no arc: the program stops
    /// before this move.
    fn leg(&mut self, order: usize, from: &Joints, pose: &Isometry3<f64>) -> Result<Leg<'a>, Stop> {
        let given: &'a Order = &self.orders[order];
        let flange = given.tool.inverse();
        let before = self.follower.iterations;
        let fail = |reason| Stop { order, share: 0.0, time: 0.0, reason };
        let (curve, wanted) = match &given.target {
            Target::Joints(to) => (Curve::Joints { from: *from, to: *to }, None),
            Target::Joint(to, wanted) => {
                let to = self.follower.end(&(to * flange), *wanted, from).map_err(fail)?;
                (Curve::Joints { from: *from, to }, None)
            }
            Target::Line(to, wanted) => (Curve::Tool(ToolCurve::line(*pose, to)), *wanted),
            Target::Arc(via, to, wanted) => {
                let curve = ToolCurve::arc(*pose, via, to).ok_or_else(|| fail(Reason::NoArc))?;
                (Curve::Tool(curve), *wanted)
            }
        };
        let (way, turn, joints) = match &curve {
            Curve::Tool(curve) => (curve.length, curve.turned(), 0.0),
            Curve::Joints { from, to } => {
                let (way, turn) = self.swept(from, to, &given.tool);
                (way, turn, largest_turn(from, to))
            }
        };
        let length = way.max(METRES_PER_RADIAN * turn.max(joints));
        let rates = if length < NOTHING { [0.0; 2] } else { [way / length, turn / length] };
        self.path.iterations[order] += self.follower.iterations - before;
        Ok(Leg { order, given, curve, length, rates, flange, branch: self.follower.arm.branch(from), wanted })
    }

    /// Way (m) and turn (rad) of the tool in a joint move, from a few chords.
    ///
    /// Eight chords: an estimate of the path's parameter, not of a limit.
    fn swept(&self, from: &Joints, to: &Joints, tool: &Isometry3<f64>) -> (f64, f64) {
        const CHORDS: usize = 8;
        let pose = |i: usize| self.follower.arm.forward(&between(from, to, i as f64 / CHORDS as f64)) * tool;
        let (mut sums, mut last) = ((0.0, 0.0), pose(0));
        for i in 1..=CHORDS {
            let next = pose(i);
            sums.0 += (next.translation.vector - last.translation.vector).norm();
            sums.1 += rotation_vector(&(last.rotation.inverse() * next.rotation)).norm();
            last = next;
        }
        sums
    }

    /// The one that is being laid.
    fn section(&mut self) -> &mut Section {
        // There is one from the first moment on.
        let last = self.path.sections.len() - 1;
        &mut self.path.sections[last]
    }

    /// The last node is where `order` passes its target.
    fn mark(&mut self, order: usize) {
        let section = self.section();
        section.join();
        let node = section.last();
        section.marks.push((order, node));
    }

    /// The arm stops at the end of `leg`; without a motion before it there is nothing to stop.
    fn stop_at(&mut self, leg: &Leg) {
        self.mark(leg.order);
        if self.section().spans.is_empty() {
            return;
        }
        let pose = self.corner(leg, leg.order + 1);
        let next = Section::from(self.joints, pose);
        self.path.sections.push(next);
    }

    /// Joint angles and tool of `leg` at the share `u`.
    ///
    /// `near` picks the turns of the axes; the branch is the leg's.
    fn at(&mut self, leg: &Leg, u: f64, near: &Joints) -> Result<(Joints, Isometry3<f64>), Reason> {
        match &leg.curve {
            Curve::Joints { from, to } => {
                let joints = between(from, to, u);
                self.follower.within(&joints)?;
                Ok((joints, self.follower.arm.forward(&joints) * leg.given.tool))
            }
            Curve::Tool(curve) => {
                let pose = curve.at(u);
                Ok((self.follower.solve(&(pose * leg.flange), leg.branch, near)?, pose))
            }
        }
    }

    /// The end of `leg` from the share `from` on, in a few steps, without going there.
    ///
    /// Four steps, so that the branch is kept; counted as work of the move.
    fn ahead(&mut self, leg: &Leg, from: f64) -> Result<(Joints, Isometry3<f64>), Stop> {
        const STEPS: usize = 4;
        let before = self.follower.iterations;
        let mut found = (self.joints, Isometry3::identity());
        if let Curve::Joints { .. } = leg.curve {
            found = self.at(leg, 1.0, &found.0).map_err(|reason| stop(leg, 1.0, reason))?;
        } else {
            for i in 0..=STEPS {
                let share = from + (1.0 - from) * i as f64 / STEPS as f64;
                found = self.at(leg, share, &found.0).map_err(|reason| stop(leg, share, reason))?;
            }
        }
        self.path.iterations[leg.order] += self.follower.iterations - before;
        if let Some(wanted) = leg.wanted {
            self.follower.meets(&found.0, wanted).map_err(|reason| stop(leg, 1.0, reason))?;
        }
        Ok(found)
    }

    /// Where the configuration at the end is prescribed, it must be met.
    fn met(&self, leg: &Leg, share: f64) -> Result<(), Stop> {
        leg.wanted.map_or(Ok(()), |wanted| {
            self.follower.meets(&self.joints, wanted).map_err(|reason| stop(leg, share, reason))
        })
    }

    /// The share `from` … `to` of a leg.
    ///
    /// At least 8 spans, 512 at most: of a tool's way one every 10 mm and every 0.035 rad of its turn or its arc, of
    /// a joint move every 0.035 rad of the joint that turns most.
    fn along(&mut self, leg: &Leg, from: f64, to: f64) -> Result<(), Stop> {
        let way = leg.length * (to - from);
        if way < NOTHING {
            return Ok(());
        }
        let finest = match &leg.curve {
            Curve::Joints { from: a, to: b } => largest_turn(a, b) * (to - from) / TURN_STEP,
            Curve::Tool(curve) => {
                (curve.length / LINE_STEP).max(curve.turned().max(curve.bent()) / TURN_STEP) * (to - from)
            }
        };
        let spans = (finest.ceil() as usize).clamp(8, MOST_SPANS);
        let rates = leg.rates;
        let place = |w: f64| from + (to - from) * w;
        self.piece(way, spans, [leg, leg], rates, |builder, w, near| {
            builder.at(leg, place(w), near).map_err(|reason| stop(leg, place(w), reason))
        })
    }

    /// From `leg` to `next` about their corner: the end of one and the beginning of the other, added, as s grows by
    /// 2·`radius`.
    ///
    /// Two tool paths with one tool are added as poses; otherwise joint angles are added.
    ///
    /// The two shares run over u = 1 − f(1 − w)² and v = g w², f and g being the radius over either length; s grows
    /// evenly with w. The first half of its spans belongs to the move before, and the node in the middle is where that
    /// passes its target.
    fn blend(&mut self, leg: &Leg, next: &Leg, radius: f64, corner: &Joints) -> Result<(), Stop> {
        let (f, g) = (radius / leg.length, radius / next.length);
        let rates = [leg.rates[0].max(next.rates[0]), leg.rates[1].max(next.rates[1])];
        let shares = |w: f64| (1.0 - f * (1.0 - w) * (1.0 - w), g * w * w);
        let fail = |w: f64, reason| {
            let (u, v) = shares(w);
            if w < 0.5 { stop(leg, u, reason) } else { stop(next, v, reason) }
        };
        let way = 2.0 * radius;
        if let (Curve::Tool(a), Curve::Tool(b)) = (&leg.curve, &next.curve)
            && leg.given.tool == next.given.tool
        {
            return self.piece(way, BLEND_SPANS, [leg, next], rates, |builder, w, near| {
                let (u, v) = shares(w);
                let pose = a.blend(u, b, v);
                let solved = builder.follower.solve(&(pose * leg.flange), leg.branch, near);
                Ok((solved.map_err(|reason| fail(w, reason))?, pose))
            });
        }
        // Joints add up where one of both is a joint move; each part is followed by itself.
        let exit = self.joints;
        let (mut near_end, mut near_begin, mut last) = (exit, *corner, 0.0);
        self.piece(way, BLEND_SPANS, [leg, next], rates, |builder, w, _| {
            let (u, v) = shares(w);
            if w <= last {
                // Again from the beginning, in finer steps.
                (near_end, near_begin) = (exit, *corner);
            }
            last = w;
            near_end = builder.at(leg, u, &near_end).map_err(|reason| fail(w, reason))?.0;
            near_begin = builder.at(next, v, &near_begin).map_err(|reason| fail(w, reason))?.0;
            let joints = std::array::from_fn(|k| near_end[k] + near_begin[k] - corner[k]);
            builder.follower.within(&joints).map_err(|reason| fail(w, reason))?;
            let tool = if w <= 0.5 { &leg.given.tool } else { &next.given.tool };
            Ok((joints, builder.follower.arm.forward(&joints) * tool))
        })
    }

    /// A smooth piece of `way` in s from the last node on, in at least `spans` equal steps. `at` gives what is at the
    /// share w.
    ///
    /// Spans are doubled, to [`MOST_SPANS`] at most, where joints turn more than [`JOINT_STEP`] from node to node.
    /// What was found before a stop is kept.
    fn piece(
        &mut self,
        way: f64,
        spans: usize,
        legs: [&Leg; 2],
        rates: [f64; 2],
        mut at: impl FnMut(&mut Self, f64, &Joints) -> Result<(Joints, Isometry3<f64>), Stop>,
    ) -> Result<(), Stop> {
        let before = self.follower.iterations;
        let followed = legs.iter().any(|leg| matches!(leg.curve, Curve::Tool(_)));
        let by_chords = legs.iter().any(|leg| matches!(leg.curve, Curve::Joints { .. }));
        let (mut spans, start) = (spans, self.joints);
        let (found, stopped) = loop {
            let (mut found, mut near, mut largest, mut stopped) = (Vec::with_capacity(spans), start, 0.0f64, None);
            for i in 1..=spans {
                match at(self, i as f64 / spans as f64, &near) {
                    Ok(node) => {
                        largest = largest.max(largest_turn(&near, &node.0));
                        near = node.0;
                        found.push(node);
                    }
                    Err(stop) => {
                        stopped = Some(stop);
                        break;
                    }
                }
            }
            let coarse = largest > JOINT_STEP || (stopped.is_some() && spans < 64);
            if !(followed && coarse) || 2 * spans > MOST_SPANS {
                break (found, stopped);
            }
            spans *= 2;
        };
        let step = way / spans as f64;
        let halves = legs[0].order != legs[1].order;
        for (i, (joints, pose)) in found.into_iter().enumerate() {
            let leg = legs[usize::from(halves && 2 * i >= spans)];
            let rates = if by_chords { self.chord(&pose, step) } else { rates };
            let span = span(leg.order, legs, rates);
            self.joints = joints;
            self.section().push(step, joints, pose, span);
            if halves && 2 * (i + 1) == spans {
                let (order, section) = (legs[0].order, self.section());
                let node = section.last();
                section.marks.push((order, node));
            }
        }
        self.section().join();
        self.path.iterations[legs[0].order] += self.follower.iterations - before;
        stopped.map_or(Ok(()), Err)
    }

    /// Metres and radians of the tool per unit of s from the last node to `pose`, with room for the arc over the chord.
    ///
    /// Rates of joint moves by the chord between nodes, 0.05 % longer to cover the arc: a way per unit of s that is
    /// too long only makes the arm slower.
    fn chord(&mut self, pose: &Isometry3<f64>, step: f64) -> [f64; 2] {
        const ROOM: f64 = 1.0005;
        let section = self.section();
        let last = &section.poses[section.last()];
        let way = (pose.translation.vector - last.translation.vector).norm();
        let turn = rotation_vector(&(last.rotation.inverse() * pose.rotation)).norm();
        [ROOM * way / step, ROOM * turn / step]
    }
}

/// On `leg` at this share of it; when, the clock says later.
fn stop(leg: &Leg, share: f64, reason: Reason) -> Stop {
    Stop { order: leg.order, share, time: 0.0, reason }
}

/// What the programmed speeds of both moves leave; accelerations follow with the plan's settings.
///
/// Rates of s, m/s: the slower of both moves' speeds rules in a blend.
///
/// ```text
/// ṡ ≤ min over both moves of  min(v_tcp/way, ω/turn)     or, of a move that is timed, min(length/duration, ω/turn)
/// ```
///
/// A duration replaces the speed of the tool's point, not that of its turning. Whether joints can go as fast is the
/// law's to see.
fn span(order: usize, legs: [&Leg; 2], rates: [f64; 2]) -> Span {
    let [way, turn] = rates.map(|rate| rate.max(1e-12));
    let limit = legs.iter().map(|leg| {
        let speed = &leg.given.speed;
        let timed = leg.given.duration.map_or(speed.tcp / way, |duration| leg.length / duration);
        timed.min(speed.turn / turn)
    });
    Span { order, limit: limit.fold(f64::INFINITY, f64::min), way, turn }
}
