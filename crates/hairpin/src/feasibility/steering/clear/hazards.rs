//! Whether a drive stays clear, along all of it: no step between two looks can hide a place to keep out of.
//!
//! ```text
//! room(p) = distance(p) − radius        clear: room ≥ 0 all along
//! look at p with room d > 0     ⇒  every curve of length ≤ d from p is clear
//! chord from p to q, length ℓ   ⇒  the curve lies within ½ √(ℓ² − |q − p|²) of the chord
//! ```
//!
//! Both rules hold for any curve of that length, whatever its curvature does in between: positions at looks are
//! integrated to 10⁻¹⁰ m a step, and what lies between is bounded, not sampled. The bound errs towards too near, by
//! less than 1 cm where looks are 2 cm apart.

use crate::math::quadrature::Gauss;
use crate::robot::rover::Rover;
use crate::trajectory::drive::{Motion, Planar, Segment};
use crate::world::terrain::KeepOuts;

/// Places to keep out of, as a drive from some pose meets them.
///
/// One list serves drives in any frame: places stay in the map, drives bring their start.
///
/// The frame of drives: origin at `start`, x along its direction of travel.
#[derive(Debug, Clone, Copy)]
pub struct Hazards<'a> {
    /// The places, in the map.
    pub keep_outs: &'a KeepOuts,
    /// Where drives start, in the map.
    pub start: Planar,
    /// Direction of travel in the body, rad.
    pub direction: f64,
    /// What the vehicle's middle keeps from them, m, ≥ 0: see [`footprint`].
    pub radius: f64,
}

/// Where a drive comes too near, at its worst.
///
/// `place` indexes [`KeepOuts::list`]. `after_m` is measured along the drive, reversals included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intrusion {
    /// Which place: its index in the list.
    pub place: usize,
    /// What is missing to stay clear, m, > 0.
    pub depth: f64,
    /// Metres driven before.
    pub after_m: f64,
}

/// Looks in a row are this far apart where something is near, m: an arc of 1 1/m leaves its chord by less than 0.1 mm
/// there.
const NEAR: f64 = 0.02;
/// Longest step of the integration, m, and largest turn in one, rad.
const STEP: f64 = 0.25;
const TURN: f64 = 0.5;

/// Radius of the circle about the body's origin that all wheels and the underside stay within, whichever way it turns,
/// m; 0 for a vehicle that is a point.
///
/// max of ‖(|x| + r, y)‖ over wheels of radius r and of the underside's farthest corner.
///
/// Level, joints at 0: leaning and joints only bring wheels nearer to the axis as seen from above.
///
/// Wheels count with their radius ahead and behind, and without their width.
pub fn footprint(rover: &Rover) -> f64 {
    let (wheels, count, radius) = rover.suspension.wheels(&[0.0; 3]);
    let belly = &rover.body.belly;
    let corner = libm::hypot(belly.front.abs().max(belly.rear.abs()), belly.half_width);
    // A wheel reaches ahead and back of its axle; tilted, it is seen from above as no larger.
    wheels[..count].iter().map(|w| libm::hypot(w.x.abs() + radius, w.y)).fold(corner, f64::max)
}

impl Hazards<'_> {
    /// How far a place given in the frame of the flat solver (x along the direction of travel at the start) is from
    /// being too near, m.
    ///
    /// Signed: below 0 it is too near by so much.
    ///
    /// m; +∞ without places.
    pub fn room(&self, x: f64, y: f64) -> f64 {
        let [x, y] = self.in_map(x, y);
        self.keep_outs.distance(x, y) - self.radius
    }

    /// Where `segments`, driven in the plane, come too near, at their worst; `None` if they stay clear.
    ///
    /// A look that finds room d vouches for the next d metres; where d is small, chords do, widened by ½√(ℓ² − c²): no
    /// curve of length ℓ leaves its chord of length c by more.
    ///
    /// Turns in place turn the circle about its own middle and need no look.
    ///
    /// Deepest of all; the first of equals. Cost falls with room: far from everything a look vouches for metres.
    ///
    /// `depth` includes what the chord's rule adds, so a drive that just touches may be told as too near by some
    /// millimetres.
    pub fn intrusion(&self, segments: &[Segment]) -> Option<Intrusion> {
        self.worst(segments, f64::INFINITY)
    }

    /// The same, but content with any that is as deep as `enough`.
    ///
    /// `enough` in m: the walk ends as soon as something at least as deep is found, which is all that a comparison of
    /// drives needs. ∞ walks to the end.
    pub(super) fn worst(&self, segments: &[Segment], enough: f64) -> Option<Intrusion> {
        if self.keep_outs.is_empty() {
            return None;
        }
        let mut check = Check { keep_outs: self.keep_outs, radius: self.radius, worst: None };
        let (mut at, mut driven) = ([self.start.x, self.start.y], 0.0);
        let mut heading = self.start.yaw + self.direction;
        check.point(at, driven);
        for segment in segments {
            let Motion::Arc { length_m, curvature } = segment.motion else {
                if let Motion::Turn { angle_rad } = segment.motion {
                    heading += angle_rad;
                }
                continue;
            };
            let sign = segment.gear.sign();
            let mut s = 0.0;
            while s < length_m {
                let room = check.room(at);
                let step = room.max(NEAR).min(length_m - s);
                let (mut next, mut walked) = (at, 0.0);
                while walked < step {
                    let bend = segment.curvature_at(s + walked).abs();
                    let h = STEP.min(TURN / bend.max(TURN / STEP)).min(step - walked);
                    let (chord, turn) = advance(&curvature, s + walked, h);
                    let (sin, cos) = libm::sincos(heading);
                    next = [
                        next[0] + sign * (cos * chord[0] - sign * sin * chord[1]),
                        next[1] + sign * (sin * chord[0] + sign * cos * chord[1]),
                    ];
                    heading += sign * turn;
                    walked += h;
                    // What is left by rounding is no step.
                    if step - walked < 1e-12 {
                        break;
                    }
                }
                if room < step {
                    check.chord(at, next, step, driven + s);
                    if check.worst.is_some_and(|worst| worst.depth >= enough) {
                        return check.worst;
                    }
                }
                at = next;
                s += step;
            }
            driven += length_m;
        }
        check.worst
    }

    /// From the frame of the flat solver.
    ///
    /// (x, y) ↦ start + Rot(yaw + direction)(x, y), m.
    fn in_map(&self, x: f64, y: f64) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.start.yaw + self.direction);
        [self.start.x + cos * x - sin * y, self.start.y + sin * x + cos * y]
    }

    /// A place of the map in the frame of the flat solver.
    pub(super) fn seen_from_start(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.start.yaw + self.direction);
        let (dx, dy) = (x - self.start.x, y - self.start.y);
        [cos * dx + sin * dy, cos * dy - sin * dx]
    }
}

/// Looks along a motion that was predicted, step by step.
///
/// An observer of [`crate::feasibility::steering::shooting::rough::predict`]: no motion is stored for it.
#[derive(Debug, Clone, Copy)]
pub struct MotionCheck<'a> {
    check: Check<'a>,
    last: Option<Planar>,
    driven: f64,
}

impl<'a> MotionCheck<'a> {
    /// Nothing seen so far.
    pub fn new(keep_outs: &'a KeepOuts, radius: f64) -> Self {
        Self { check: Check { keep_outs, radius, worst: None }, last: None, driven: 0.0 }
    }

    /// Looks along the way from where the vehicle was seen last; steps are arcs, which leave their chord c by c Δψ/8.
    ///
    /// Places must come in the order of the motion.
    ///
    /// `at.yaw` must not be wrapped between steps, else the bulge is too large. To first order in the turn: an arc's
    /// true sagitta is c/2 · tan(Δψ/4), more by a share of Δψ²/48.
    pub fn see(&mut self, at: &Planar) {
        let here = [at.x, at.y];
        match self.last {
            None => self.check.point(here, 0.0),
            Some(last) => {
                let from = [last.x, last.y];
                let chord = libm::hypot(here[0] - from[0], here[1] - from[1]);
                let bulge = 0.125 * chord * (at.yaw - last.yaw).abs();
                self.check.line(from, here, bulge, self.driven);
                self.driven += chord;
            }
        }
        self.last = Some(*at);
    }

    /// Where it came too near, at its worst.
    pub fn worst(&self) -> Option<Intrusion> {
        self.check.worst
    }
}

/// Places, the distance to keep from them in m, and the deepest that was found.
#[derive(Debug, Clone, Copy)]
struct Check<'a> {
    keep_outs: &'a KeepOuts,
    radius: f64,
    worst: Option<Intrusion>,
}

impl Check<'_> {
    /// distance − radius, m.
    fn room(&self, [x, y]: [f64; 2]) -> f64 {
        self.keep_outs.distance(x, y) - self.radius
    }

    fn point(&mut self, at: [f64; 2], after_m: f64) {
        self.line(at, at, 0.0, after_m);
    }

    /// A curve of length `length` between two points.
    ///
    /// ½√(ℓ² − c²) is the half height of the ellipse with its foci at the ends and the string ℓ: no point of the curve
    /// leaves it. Rounding that makes ℓ < c counts as straight.
    fn chord(&mut self, from: [f64; 2], to: [f64; 2], length: f64, after_m: f64) {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let bulge = 0.5 * (length * length - dx * dx - dy * dy).max(0.0).sqrt();
        self.line(from, to, bulge, after_m);
    }

    /// Everything within `bulge` (m) of a segment.
    ///
    /// One query of the tree of places; `after_m` is told as it is given.
    fn line(&mut self, from: [f64; 2], to: [f64; 2], bulge: f64, after_m: f64) {
        let Some(nearest) = self.keep_outs.nearest_to_segment(from, to) else { return };
        let depth = self.radius + bulge - nearest.distance;
        if depth > 0.0 && self.worst.is_none_or(|worst| depth > worst.depth) {
            self.worst = Some(Intrusion { place: nearest.index, depth, after_m });
        }
    }
}

/// From `s` on by `h`: displacement in the frame at `s` of a drive forward, and turn.
///
/// `curvature` holds a₀ … a₅ of κ(s) = Σ aᵢ sⁱ, 1/m^(i+1). Five Gauss-Legendre points for a step of 0.25 m and half a
/// radian at most.
fn advance(curvature: &[f64; 6], s: f64, h: f64) -> ([f64; 2], f64) {
    // θ(s + t) − θ(s) as the integral of a polynomial, at Gauss's points; exact for the turn, to 10⁻¹⁰ for the place.
    let turned = |to: f64| curvature.iter().enumerate().rev().fold(0.0, |sum, (i, a)| (sum + a / (i + 1) as f64) * to);
    let before = turned(s);
    let rule = Gauss::<5>::RULE;
    let (mut x, mut y) = (0.0, 0.0);
    for i in 0..5 {
        let (sin, cos) = libm::sincos(turned(s + h * rule.nodes[i]) - before);
        x += h * rule.weights[i] * cos;
        y += h * rule.weights[i] * sin;
    }
    ([x, y], turned(s + h) - before)
}
