//! The words of Reeds and Shepp, spelt with turns of continuous curvature.
//!
//! A turn ends where its circle's centre stands at a fixed place in the vehicle's frame (`Lead::center`), so two turns
//! that meet at a heading θ have centres Rot(θ)·D apart, with D known, and a straight of length L adds (±L, 0) to it.
//! Each word is then a triangle, or less, between the first and the last centre. At a cusp the vehicle stands: it may
//! come there at zero curvature, or at full curvature and swing its wheels over.
//!
//! Reeds and Shepp, "Optimal paths for a car that goes both forwards and backwards" (Pacific J. Math. 145, 1990): C S
//! C, C C C and, with cusps, C|C|C, C|CC, CC|C, CC|CC, C|CC|C, C|CSC, CSC|C, C|CSC|C. With clothoids none of these need
//! be optimal.
//!
//! Cost: 4 × 4 pairs of first and last turn (2 × 2 forward only), a handful of words each, of which most end at a
//! comparison of lengths before any angle is computed. A word that would be longer than the best, or that has a turn of
//! no length at its beginning or end, is refused by `offer`.

use std::f64::consts::FRAC_PI_2;

use super::turn::{Circle, Lead, Turn, WAYS, Way, index};

/// What may be driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Family {
    /// Forward only.
    Dubins,
    /// With cusps.
    ReedsShepp,
}

/// A pose in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pose {
    /// m.
    pub(super) x: f64,
    /// m.
    pub(super) y: f64,
    /// rad, not wrapped.
    pub(super) heading: f64,
}

impl Pose {
    /// Places a point of the pose's frame in the world.
    pub(super) fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (sin, cos) = libm::sincos(self.heading);
        (self.x + cos * x - sin * y, self.y + sin * x + cos * y)
    }
}

/// A straight before the turn `before`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Straight {
    /// Index of the turn that follows it.
    pub(super) before: usize,
    /// 1 forward, −1 in reverse.
    pub(super) gear: f64,
    /// m, ≥ 0.
    pub(super) length: f64,
}

/// A path that was found.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plan {
    /// Metres driven, turns and straight.
    pub(super) length: f64,
    /// In the order they are driven.
    pub(super) turns: [Option<Turn>; 4],
    /// At most one in a word.
    pub(super) straight: Option<Straight>,
}

/// Both ends' leads by the turn's way, and where their circles stand.
struct Ends {
    /// By the way's index: the lead onto its circle, and the circle's centre in the frame of the question, m.
    first: [(Lead, (f64, f64)); 4],
    /// The lead off its circle, and that centre.
    last: [(Lead, (f64, f64)); 4],
    /// Headings of both poses, rad, not wrapped.
    start: f64,
    end: f64,
}

/// One word being spelt: its turns' ways and leads, without angles.
#[derive(Clone, Copy)]
struct Word<'f> {
    /// Those beyond `count` repeat the first and mean nothing.
    ways: [Way; 4],
    entries: [&'f Lead; 4],
    exits: [&'f Lead; 4],
    count: usize,
}

/// Centres this close are one, and a single turn is the path, m.
const ON_ONE_CIRCLE: f64 = 1e-9;

/// Looks through the words for the shortest path.
pub(super) struct Finder<'c> {
    circle: &'c Circle,
    ends: &'c Ends,
    best: Option<Plan>,
    /// Metres that a plan must be shorter than; ∞ where all are wanted.
    shortest: f64,
    /// Where every plan goes, if not only the shortest is wanted.
    all: Option<&'c mut dyn FnMut(Plan)>,
}

/// The shortest path of `family` between two poses with these curvatures; `None` if all are longer than `below`.
///
/// `below` in m, leads of anchors not counted. O(1): no iteration anywhere.
pub(super) fn shortest(
    circle: &Circle,
    family: Family,
    from: (Pose, f64),
    to: (Pose, f64),
    below: f64,
) -> Option<Plan> {
    let ends = Ends::new(circle, from, to);
    let mut finder = Finder { circle, ends: &ends, best: None, shortest: below, all: None };
    finder.spell(family);
    finder.best
}

/// Every path of `family` between two poses with these curvatures.
pub(super) fn every(circle: &Circle, family: Family, from: (Pose, f64), to: (Pose, f64), take: &mut dyn FnMut(Plan)) {
    let ends = Ends::new(circle, from, to);
    Finder { circle, ends: &ends, best: None, shortest: f64::INFINITY, all: Some(take) }.spell(family);
}

impl Ends {
    /// Curvatures in 1/m, as the vehicle drives them.
    fn new(circle: &Circle, (start, k0): (Pose, f64), (end, kf): (Pose, f64)) -> Self {
        Self {
            first: WAYS.map(|way| {
                let lead = circle.entry_from(way, k0);
                (lead, start.place(lead.center))
            }),
            last: WAYS.map(|way| {
                let lead = circle.exit_to(way, kf);
                (lead, end.place(lead.center))
            }),
            start: start.heading,
            end: end.heading,
        }
    }
}

impl<'c> Finder<'c> {
    /// All words of a family.
    fn spell(&mut self, family: Family) {
        let ways = if family == Family::Dubins { &WAYS[..2] } else { &WAYS[..] };
        for &first in ways {
            for &last in ways {
                self.pair(family, first, last);
            }
        }
    }

    /// All words that begin and end with these turns.
    fn pair(&mut self, family: Family, first: Way, last: Way) {
        let (from, to) = (self.ends.first[index(first)].1, self.ends.last[index(last)].1);
        let between = Span::new(to.0 - from.0, to.1 - from.1);
        let cusps = family == Family::ReedsShepp;
        if first == last
            && between.distance < ON_ONE_CIRCLE
            && let Some(word) = self.word(&[first], &[])
        {
            self.offer(&word, &[], None);
        }
        self.turn_straight_turn(between, first, last, 1.0);
        if first.sense == last.sense {
            self.three_turns(between, first, last, 1.0);
        }
        if !cusps {
            return;
        }
        self.turn_straight_turn(between, first, last, -1.0);
        if first.sense == last.sense {
            self.three_turns(between, first, last, -1.0);
        }
        for swing in [true, false] {
            if first.sense != last.sense {
                self.four_turns(between, first, last, swing);
            }
            self.quarter_turns(between, first, last, swing);
        }
    }

    /// C S C, with a cusp wherever the gear changes.
    ///
    /// Rot(θ)·(step.x ± L, step.y) = span gives the heading θ of the straight and L in closed form; no solution where
    /// the centres are nearer than the step's offset across.
    fn turn_straight_turn(&mut self, between: Span, first: Way, last: Way, gear: f64) {
        let Some(word) = self.word(&[first, last], &[false]) else { return };
        let step = word.step(0);
        if let Some((heading, length)) = straight(between, step, gear) {
            self.offer(&word, &[heading], Some(Straight { before: 1, gear, length }));
        }
    }

    /// C C C with the middle turn in `gear`.
    ///
    /// Two headings by the triangle of the two steps and the span, on both of its sides. The middle turn goes the other
    /// way round in either gear; at a cusp the wheels may swing or be at zero.
    fn three_turns(&mut self, between: Span, first: Way, last: Way, gear: f64) {
        let middle = Way { sense: -first.sense, gear };
        let swings = |a: Way, b: Way| if a.gear == b.gear { &[false][..] } else { &[true, false] };
        for &before in swings(first, middle) {
            for &after in swings(middle, last) {
                let Some(word) = self.word(&[first, middle, last], &[before, after]) else { continue };
                for [a, b] in triangle(between, word.step(0), word.step(1)).into_iter().flatten() {
                    self.offer(&word, &[a, b], None);
                }
            }
        }
    }

    /// C Cu | Cu C and C | Cu Cu | C, whose two middle turns are equal.
    ///
    /// With equal outer gears both middle turns are driven in the other one (C|CC|C); with different ones each pair
    /// shares its gear (CC|CC).
    fn four_turns(&mut self, between: Span, first: Way, last: Way, swing: bool) {
        let second = Way { sense: -first.sense, gear: if first.gear == last.gear { -first.gear } else { first.gear } };
        let third = Way { sense: first.sense, gear: if first.gear == last.gear { second.gear } else { last.gear } };
        let cusp = |a: Way, b: Way| swing && a.gear != b.gear;
        let joints = [cusp(first, second), cusp(second, third), cusp(third, last)];
        let Some(word) = self.word(&[first, second, third, last], &joints) else { return };
        let (d1, d2, d3) = (word.step(0), word.step(1), word.step(2));
        if first.gear == last.gear {
            // The middle turns cancel: both cusps have the same heading.
            for [a, b] in triangle(between, (d1.0 + d3.0, d1.1 + d3.1), d2).into_iter().flatten() {
                self.offer(&word, &[a, b, a], None);
            }
            return;
        }
        // The headings rise evenly, θ − u, θ, θ + u, and D1, D3 are mirror images about y, so that what they add up to
        // lies along the y axis of the cusp: D2y + 2 (D1y cos u − D1x sin u) = ± distance.
        let reach = libm::hypot(d1.0, d1.1);
        let phase = libm::atan2(d1.0, d1.1);
        for signed in [between.distance, -between.distance] {
            let cosine = (signed - d2.1) / (2.0 * reach);
            if cosine.abs() > 1.0 {
                continue;
            }
            let heading = between.angle - if signed < 0.0 { -FRAC_PI_2 } else { FRAC_PI_2 };
            for u in [libm::acos(cosine) - phase, -libm::acos(cosine) - phase] {
                self.offer(&word, &[heading - u, heading, heading + u], None);
            }
        }
    }

    /// C | C½π S C, C S C½π | C and C | C½π S C½π | C: after a quarter turn the step over the cusp lies along the
    /// straight.
    fn quarter_turns(&mut self, between: Span, first: Way, last: Way, swing: bool) {
        if first.gear == last.gear {
            let second = Way { sense: -first.sense, gear: -first.gear };
            let third = Way { sense: -last.sense, gear: -last.gear };
            let Some(word) = self.word(&[first, second, third, last], &[swing, false, swing]) else { return };
            let (before, step, after) = (word.step(0), word.step(1), word.step(2));
            let gear = second.gear;
            let along = step.0 + second.sense * gear * before.1 - third.sense * gear * after.1;
            if let Some((heading, length)) = straight(between, (along, step.1), gear) {
                let headings =
                    [heading - second.sense * gear * FRAC_PI_2, heading, heading + third.sense * gear * FRAC_PI_2];
                self.offer(&word, &headings, Some(Straight { before: 2, gear, length }));
            }
            return;
        }
        let second = Way { sense: -first.sense, gear: last.gear };
        if let Some(word) = self.word(&[first, second, last], &[swing, false]) {
            let (before, step, gear) = (word.step(0), word.step(1), second.gear);
            let along = step.0 + second.sense * gear * before.1;
            if let Some((heading, length)) = straight(between, (along, step.1), gear) {
                let headings = [heading - second.sense * gear * FRAC_PI_2, heading];
                self.offer(&word, &headings, Some(Straight { before: 2, gear, length }));
            }
        }
        let second = Way { sense: -last.sense, gear: first.gear };
        let Some(word) = self.word(&[first, second, last], &[false, swing]) else { return };
        let (step, after, gear) = (word.step(0), word.step(1), second.gear);
        let along = step.0 - second.sense * gear * after.1;
        if let Some((heading, length)) = straight(between, (along, step.1), gear) {
            let headings = [heading, heading + second.sense * gear * FRAC_PI_2];
            self.offer(&word, &headings, Some(Straight { before: 1, gear, length }));
        }
    }

    /// Ways with their leads; `swings[i]`: full curvature between the turns i and i + 1. `None` if the leads alone are
    /// too long, before any triangle is solved.
    ///
    /// `ways` holds 2 to 4 turns, `swings` one entry fewer; false: the turns meet at zero curvature, clothoids between.
    fn word(&self, ways: &[Way], swings: &[bool]) -> Option<Word<'c>> {
        let last = ways.len() - 1;
        let (first_way, last_way) = (ways[0], ways[last]);
        let mut word = Word {
            ways: [first_way; 4],
            entries: [&self.ends.first[index(first_way)].0; 4],
            exits: [&self.ends.last[index(last_way)].0; 4],
            count: ways.len(),
        };
        for (i, &way) in ways.iter().enumerate() {
            word.ways[i] = way;
            if i > 0 {
                word.entries[i] = if swings[i - 1] { self.circle.standing(way) } else { self.circle.entry(way) };
            }
            if i < last {
                word.exits[i] = if swings[i] { self.circle.standing(way) } else { self.circle.exit(way) };
            }
        }
        let least: f64 = (0..word.count).map(|i| self.circle.leads(word.entries[i], word.exits[i])).sum();
        (least < self.shortest).then_some(word)
    }

    /// Takes the path with these headings between the turns if it is the shortest so far.
    ///
    /// `headings` in rad at each meeting of two turns; a turn's angle is the difference of its neighbours, modulo 2π.
    /// NaN in any length refuses. With `all`, every plan is handed over and none is kept.
    fn offer(&mut self, word: &Word, headings: &[f64], straight: Option<Straight>) {
        let angle = |i: usize| {
            let before = if i == 0 { self.ends.start } else { headings[i - 1] };
            let after = if i + 1 == word.count { self.ends.end } else { headings[i] };
            after - before
        };
        // Most words are too long: see that before anything is computed for good.
        let metres = straight.map_or(0.0, |straight| straight.length);
        let mut least = metres;
        for i in 0..word.count {
            least += self.circle.at_least(word.ways[i], word.entries[i], word.exits[i], angle(i));
            // Lengths that are no numbers are refused as well.
            if least.total_cmp(&self.shortest).is_ge() {
                return;
            }
        }
        let mut length = metres;
        let mut turns = [None; 4];
        for (i, slot) in turns.iter_mut().enumerate().take(word.count) {
            let (turn, metres) = self.circle.turn(word.ways[i], word.entries[i], word.exits[i], angle(i));
            length += metres;
            // A turn of nothing at an end would swing the wheels before the start or after the goal.
            let at_end = i == 0 || i + 1 == word.count;
            if (at_end && metres == 0.0) || length >= self.shortest {
                return;
            }
            *slot = Some(turn);
        }
        let plan = Plan { length, turns, straight };
        match &mut self.all {
            Some(take) => take(plan),
            None => (self.shortest, self.best) = (length, Some(plan)),
        }
    }
}

impl Word<'_> {
    /// From the centre of turn `i` to that of turn `i` + 1, in the frame of the vehicle between them.
    fn step(&self, i: usize) -> (f64, f64) {
        let (from, to) = (self.exits[i].center, self.entries[i + 1].center);
        (to.0 - from.0, to.1 - from.1)
    }
}

/// From the first centre to the last: distance in m, direction in rad.
#[derive(Debug, Clone, Copy)]
struct Span {
    /// ≥ 0.
    distance: f64,
    angle: f64,
}

impl Span {
    fn new(x: f64, y: f64) -> Self {
        Self { distance: libm::hypot(x, y), angle: libm::atan2(y, x) }
    }
}

/// Heading and length L ≥ 0 of a straight in `gear` with Rot(heading)·(step.x + gear·L, step.y) = span.
///
/// `step` in the frame of the straight, m. Lengths down to −10⁻¹⁰ m are rounding and become 0.
fn straight(span: Span, step: (f64, f64), gear: f64) -> Option<(f64, f64)> {
    let square = span.distance * span.distance - step.1 * step.1;
    if square < 0.0 {
        return None;
    }
    let along = gear * square.sqrt();
    let length = gear * (along - step.0);
    // A straight of nothing, but for rounding, is one.
    (length > -1e-10).then(|| (span.angle - libm::atan2(step.1, along), length.max(0.0)))
}

/// Headings (a, b) with Rot(a)·first + Rot(b)·second = span, both ways round.
///
/// `None` where |p − q| ≤ d ≤ p + q fails by more than rounding, for sides p, q and d; the two answers are mirror
/// images about the span and coincide where it is flat.
fn triangle(span: Span, first: (f64, f64), second: (f64, f64)) -> Option<[[f64; 2]; 2]> {
    let (p, q, d) = (norm(first), norm(second), span.distance);
    // Most triangles do not close: no need of angles to see that.
    if d > (p + q) * (1.0 + 1e-12) || d < (p - q).abs() * (1.0 - 1e-12) {
        return None;
    }
    let (alpha, beta) = if d + (p - q).abs() < 1e-12 * (p + q) {
        // Centres on top of each other leave the direction free: any will do.
        (FRAC_PI_2, FRAC_PI_2)
    } else {
        (angle(p * p + d * d - q * q, 2.0 * p * d), angle(q * q + d * d - p * p, 2.0 * q * d))
    };
    let (to_first, to_second) = (direction(first), direction(second));
    Some([1.0, -1.0].map(|side| [span.angle + side * alpha - to_first, span.angle - side * beta - to_second]))
}

/// The angle with this cosine, which exceeds 1 by rounding only.
fn angle(adjacent: f64, hypotenuse: f64) -> f64 {
    libm::acos((adjacent / hypotenuse).clamp(-1.0, 1.0))
}

/// √(x² + y²).
fn norm((x, y): (f64, f64)) -> f64 {
    (x * x + y * y).sqrt()
}

/// Steps over cusps lie along y: nothing to compute for them.
///
/// rad.
fn direction((x, y): (f64, f64)) -> f64 {
    if x == 0.0 { FRAC_PI_2.copysign(y) } else { libm::atan2(y, x) }
}
