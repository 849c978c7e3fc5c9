//! The fastest time law along a section that its limits allow, from rest to rest: squared rates at its knots.

use super::grid::{Jet, Section};
use super::settings::PlanSettings;
use crate::math::power::square;
use crate::robot::arm::{AXES, JointLimit};

/// One limit of an interval: |before·x₀ + after·x₁| ≤ most, x = ṡ² at its ends.
#[derive(Clone, Copy)]
struct Bound {
    before: f64,
    after: f64,
    most: f64,
}

/// Limits of an interval: every joint's acceleration at both ends, and the tool's along the path.
const BOUNDS: usize = 2 * AXES + 1;

/// Where x = ṡ² is computed: the nodes of a section, and finer ones where it sets out and stops, as slow moves reach
/// their speed within a part of a span.
pub(super) struct Knots {
    /// Parameter of each.
    pub(super) s: Vec<f64>,
    /// Span of each interval, one less than knots, and the shares of the span that it begins and ends at.
    intervals: Vec<(usize, [f64; 2])>,
}

/// The first and the last span are halved this often.
const HALVINGS: i32 = 6;

impl Knots {
    /// One interval a span, 12 of a section's only one, else 7 of the first and of the last: their first or last half
    /// is halved again and again.
    pub(super) fn of(section: &Section) -> Self {
        let mut knots =
            Self { s: vec![0.0], intervals: Vec::with_capacity(section.spans.len() + 4 * HALVINGS as usize) };
        let fine = |k: i32| libm::ldexp(1.0, -k);
        let last = section.spans.len().saturating_sub(1);
        for span in 0..section.spans.len() {
            let mut shares = vec![0.0];
            if span == 0 {
                shares.extend((1..=HALVINGS).rev().map(fine));
            }
            if span == last {
                shares.extend((1..=HALVINGS).map(|k| 1.0 - fine(k)).filter(|share| span != 0 || *share > 0.5));
            }
            shares.push(1.0);
            for pair in shares.windows(2) {
                let (from, to) = (section.s[span], section.s[span + 1]);
                // Knots at nodes are the nodes' own numbers.
                knots.s.push(if pair[1] == 1.0 { to } else { from + pair[1] * (to - from) });
                knots.intervals.push((span, [pair[0], pair[1]]));
            }
        }
        knots
    }
}

/// Joint speeds are used up to this share: between nodes slopes differ a little from those at nodes.
const USED: f64 = 0.985;

/// What limits x = ṡ² along a section, whatever the caps are lowered to.
pub(super) struct Limits {
    /// Largest x at every knot by the speeds and by |q″|x ≤ q̈_max.
    caps: Vec<f64>,
    /// Of every interval.
    bounds: Vec<[Bound; BOUNDS]>,
}

impl Limits {
    /// Of joints that may use the share `used` of their accelerations.
    ///
    /// ```text
    /// caps    x ≤ limit²,  x ≤ (q̇_max/q′)²,  x ≤ q̈_max/|q″|      at both ends of an interval, speeds in its middle
    /// bounds  |q″ x_end + q′ (x₁ − x₀)/2h| ≤ q̈_max                of each joint at either end
    ///         |x₁ − x₀|/2h ≤ min(a_tool/way, α_tool/turn)
    /// ```
    ///
    /// Speeds go to 98.5 % and accelerations to the share `used`: that is the room for what lies between knots, an
    /// estimate and no proof.
    pub(super) fn of(
        section: &Section,
        knots: &Knots,
        joints: &[JointLimit; AXES],
        settings: &PlanSettings,
        used: f64,
    ) -> Self {
        let joints = joints.map(|joint| JointLimit {
            speed: USED * joint.speed,
            acceleration: used * joint.acceleration,
            ..joint
        });
        let spans = knots.intervals.len();
        let mut caps = vec![f64::INFINITY; spans + 1];
        let mut bounds: Vec<[Bound; BOUNDS]> = Vec::with_capacity(spans);
        for (i, (number, shares)) in knots.intervals.iter().enumerate() {
            let (h, span) = (knots.s[i + 1] - knots.s[i], &section.spans[*number]);
            let ends = shares.map(|share| section.jet(*number, share));
            let cap = ends.iter().fold(square(span.limit), |cap, end| cap.min(joints_allow(end, &joints)));
            // Between its ends a slope can be steeper than at both.
            let cap = cap.min(speeds_allow(&section.jet(*number, 0.5 * (shares[0] + shares[1])), &joints));
            caps[i] = caps[i].min(cap);
            caps[i + 1] = caps[i + 1].min(cap);
            let push = (settings.acceleration / span.way).min(settings.turn_acceleration / span.turn);
            bounds.push(std::array::from_fn(|k| {
                let Some(axis) = (k < 2 * AXES).then_some(k / 2) else {
                    return Bound { before: -0.5 / h, after: 0.5 / h, most: push };
                };
                let (end, last) = (&ends[k % 2], k % 2 == 1);
                let (rate, most) = (end.slope[axis] * 0.5 / h, joints[axis].acceleration);
                let (bent, straight) = (end.bend[axis], 0.0);
                let (b0, b1) = if last { (straight, bent) } else { (bent, straight) };
                Bound { before: b0 - rate, after: b1 + rate, most }
            }));
        }
        Self { caps, bounds }
    }

    /// x = ṡ² at every knot, m²/s², its caps multiplied by `slower`.
    ///
    /// Between knots x is linear in s, so s̈ = (x₁ − x₀)/2h is constant and q̈ = q″x + q′s̈. At each end of an interval
    /// this is linear in x₀ and x₁. First every x is capped by the speeds and by |q″|x ≤ q̈_max, so that going on at
    /// the same rate is always allowed; then one pass backward from rest and one forward take the largest values that
    /// their neighbours allow (as Pham, Pham: "A new approach to time-optimal path parameterization based on
    /// reachability analysis", 2018, with the cap in place of its linear programs).
    pub(super) fn squared_rates(&self, slower: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = self.caps.iter().zip(slower).map(|(cap, slower)| cap * slower).collect();
        let spans = self.bounds.len();
        x[0] = 0.0;
        x[spans] = 0.0;
        for (i, bounds) in self.bounds.iter().enumerate().rev() {
            let after = x[i + 1];
            x[i] = bounds.iter().fold(x[i], |x, b| x.min(largest(b.before, b.after, after, b.most)));
        }
        for (i, bounds) in self.bounds.iter().enumerate() {
            let before = x[i];
            x[i + 1] = bounds.iter().fold(x[i + 1], |x, b| x.min(largest(b.after, b.before, before, b.most)));
        }
        x
    }
}

/// The largest y ≥ 0 with |a·y + b·other| ≤ most.
///
/// 0 where `other` alone is beyond, which the caps exclude but for rounding; infinite where y has no share in the
/// bound.
fn largest(a: f64, b: f64, other: f64, most: f64) -> f64 {
    if a == 0.0 { f64::INFINITY } else { ((most - a.signum() * b * other) / a.abs()).max(0.0) }
}

/// The largest x at which no joint is too fast, nor bent too hard by the path alone.
fn joints_allow(at: &Jet, limits: &[JointLimit; AXES]) -> f64 {
    let bends = limits.iter().zip(&at.bend).map(|(limit, bend)| limit.acceleration / bend.abs());
    bends.fold(speeds_allow(at, limits), f64::min)
}

/// x ≤ (q̇_max/q′)² of every joint.
fn speeds_allow(at: &Jet, limits: &[JointLimit; AXES]) -> f64 {
    let speeds = limits.iter().zip(&at.slope).map(|(limit, slope)| square(limit.speed / slope));
    speeds.fold(f64::INFINITY, f64::min)
}
