//! Progress along a section over time: constant acceleration between knots, averaged over a moving window for an
//! S-curve.
//!
//! A window T averages progress, never position: the path stays the path. Where the averaged law asks too much of a
//! joint, caps are lowered there and the passes repeated, at most eight times; then all of it is slowed down.
//!
//! ```text
//! x = ṡ² linear in s between knots  ⇒  s̈ = (x₁ − x₀)/2h constant,  Δt = 2h/(ṡ₀ + ṡ₁)
//! window T:  ṡ_f(t) = (s(t) − s(t − T))/T,   s̈_f(t) = (ṡ(t) − ṡ(t − T))/T,   |s⃛_f| ≤ 2 max|s̈|/T
//! ```

use super::grid::Section;
use super::profile::{Knots, Limits};
use super::settings::{PlanSettings, Shape};
use crate::math::power::square;
use crate::robot::arm::{AXES, JointLimit, Joints};

/// s(t) of a section from rest to rest. With a window T: s_f(t) = (1/T) ∫ s over (t − T, t).
///
/// Four numbers a knot; progress at a time is a binary search and a cubic.
#[derive(Debug, Clone)]
pub(super) struct Law {
    /// Times of the knots without the window, s.
    times: Vec<f64>,
    /// Rates ṡ there.
    rates: Vec<f64>,
    /// Parameter there.
    s: Vec<f64>,
    /// ∫ s dt up to there.
    area: Vec<f64>,
    /// Width of the window, s; 0 without one.
    window: f64,
}

/// Progress at a time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Progress {
    /// Parameter, m.
    pub(super) s: f64,
    /// ṡ, m/s.
    pub(super) rate: f64,
    /// s̈, m/s².
    pub(super) acceleration: f64,
}

/// Share of the joints' accelerations that a law uses without a window: between nodes curvatures differ a little from
/// those at nodes.
const USED: f64 = 0.985;
/// Share that an S-curve may use: between two looks there can be a little more.
const USED_AVERAGED: f64 = 0.97;
/// Share that the law below an S-curve uses. Its average asks no more of a joint that is only pushed; of one whose way
/// is bent too it can, and there it is lowered.
const USED_BELOW: f64 = 0.965;
/// How often an S-curve's caps are lowered where it exceeds a joint's limits, before all of it is slowed down.
const ROUNDS: usize = 8;
/// Looks per window at what an S-curve asks of the joints.
const LOOKS: f64 = 20.0;

impl Law {
    /// The law of `section`; of a section without a motion one that is over at once.
    ///
    /// A trapezoid is one pair of passes; an S-curve looks 20 times a window at what each joint is asked for, so that
    /// between looks a limit may be exceeded by what [`USED_AVERAGED`] leaves room for.
    pub(super) fn of(section: &Section, limits: &[JointLimit; AXES], settings: &PlanSettings) -> Self {
        let knots = Knots::of(section);
        if section.spans.is_empty() {
            return Self::new(&knots, &[0.0], 0.0);
        }
        let mut slower = vec![1.0; knots.s.len()];
        let window = match settings.shape {
            Shape::Trapezoid => {
                return Self::new(
                    &knots,
                    &Limits::of(section, &knots, limits, settings, USED).squared_rates(&slower),
                    0.0,
                );
            }
            Shape::SCurve(width) => width,
        };
        let below = Limits::of(section, &knots, limits, settings, USED_BELOW);
        let asked = Asked::of(limits);
        let mut law = Self::new(&knots, &below.squared_rates(&slower), window);
        for _ in 0..ROUNDS {
            if law.lower(section, &asked, &mut slower) <= 1.0 {
                return law;
            }
            law = Self::new(&knots, &below.squared_rates(&slower), window);
        }
        // Slower by a factor everywhere asks the square of it less of every acceleration.
        loop {
            let excess = law.lower(section, &asked, &mut slower);
            if excess <= 1.0 {
                return law;
            }
            let squared: Vec<f64> = law.rates.iter().map(|rate| square(*rate) / (1.02 * excess)).collect();
            law = Self::new(&knots, &squared, window);
        }
    }

    /// `squared` is x = ṡ² at every knot.
    ///
    /// Times by Δt = 2h/(ṡ₀ + ṡ₁), areas by the integral of each interval's cubic. O(knots).
    fn new(knots: &Knots, squared: &[f64], window: f64) -> Self {
        let nodes = squared.len();
        let rates: Vec<f64> = squared.iter().map(|x| x.sqrt()).collect();
        let (mut times, mut area) = (vec![0.0; nodes], vec![0.0; nodes]);
        for i in 1..nodes {
            let h = knots.s[i] - knots.s[i - 1];
            // Two knots at rest one after the other cannot be: every cap is above 0.
            let step = 2.0 * h / (rates[i - 1] + rates[i]).max(1e-12);
            times[i] = times[i - 1] + step;
            let push = (rates[i] - rates[i - 1]) / step;
            area[i] = area[i - 1] + step * (knots.s[i - 1] + step * (0.5 * rates[i - 1] + step * push / 6.0));
        }
        Self { times, rates, s: knots.s.clone(), area, window }
    }

    /// From the first motion to standing still, s.
    pub(super) fn duration(&self) -> f64 {
        let last = self.times[self.times.len() - 1];
        if last > 0.0 { last + self.window } else { 0.0 }
    }

    /// The parameters that the law is computed at: all nodes, and more near rest.
    pub(super) fn knots(&self) -> &[f64] {
        &self.s
    }

    /// Number of the interval between knots that `t` lies in, clamped to those that there are.
    fn interval(&self, t: f64) -> usize {
        (self.times.partition_point(|time| *time <= t).max(1) - 1).min(self.times.len().saturating_sub(2))
    }

    /// The interval of a `t` that is not below what `from` was found for.
    fn interval_from(&self, t: f64, from: usize) -> usize {
        let mut i = from;
        while i + 2 < self.times.len() && self.times[i + 1] <= t {
            i += 1;
        }
        i
    }

    /// s, ṡ, s̈ and ∫ s dt without the window.
    fn raw(&self, t: f64) -> [f64; 4] {
        self.raw_in(t, self.interval(t))
    }

    /// The same, where `t` is known to lie in the interval `i`, or before or behind all.
    ///
    /// Within an interval the push a = (ṡ₁ − ṡ₀)/Δt is constant:
    ///
    /// ```text
    /// s = s₀ + ṡ₀ dt + ½ a dt²,   ∫ s = A₀ + s₀ dt + ½ ṡ₀ dt² + a dt³/6
    /// ```
    ///
    /// Before 0 all are 0; behind the end s stays and its integral grows on, which is what the window needs.
    fn raw_in(&self, t: f64, i: usize) -> [f64; 4] {
        let last = self.times.len() - 1;
        if last == 0 || t <= 0.0 {
            return [0.0; 4];
        }
        if t >= self.times[last] {
            return [self.s[last], 0.0, 0.0, self.area[last] + self.s[last] * (t - self.times[last])];
        }
        let step = self.times[i + 1] - self.times[i];
        let (dt, push) = (t - self.times[i], (self.rates[i + 1] - self.rates[i]) / step);
        let s = self.s[i] + dt * (self.rates[i] + 0.5 * push * dt);
        let area = self.area[i] + dt * (self.s[i] + dt * (0.5 * self.rates[i] + dt * push / 6.0));
        [s, self.rates[i] + push * dt, push, area]
    }

    /// Progress at `t` s after the section's start.
    ///
    /// Before 0 at rest at the beginning, after [`Law::duration`] at rest at the end.
    pub(super) fn at(&self, t: f64) -> Progress {
        self.averaged(self.raw(t), || self.raw(t - self.window))
    }

    /// Progress where the law without the window is `now`, and `before` as long before as the window is wide.
    ///
    /// s is clipped to the section's length: differences of two areas may round beyond it.
    fn averaged(&self, now: [f64; 4], before: impl FnOnce() -> [f64; 4]) -> Progress {
        let [s, rate, acceleration, area] = now;
        if self.window == 0.0 {
            return Progress { s, rate, acceleration };
        }
        let [before, rate_before, _, area_before] = before();
        let by = 1.0 / self.window;
        Progress {
            s: ((area - area_before) * by).min(self.s[self.s.len() - 1]),
            rate: (s - before) * by,
            acceleration: (rate - rate_before) * by,
        }
    }

    /// When progress reaches `s`.
    ///
    /// s since the section's start, by 50 bisections; progress never falls, so that there is one answer.
    pub(super) fn when(&self, s: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.duration());
        if s <= 0.0 {
            return low;
        }
        if self.window == 0.0 {
            let i = self.s.partition_point(|node| *node < s).clamp(1, self.s.len() - 1);
            (low, high) = (self.times[i - 1], self.times[i]);
            if s >= self.s[i] {
                return high;
            }
        }
        if s >= self.s[self.s.len() - 1] {
            return high;
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if self.at(middle).s < s { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// The largest excess of a joint's speed (squared) or acceleration over its limit, as a ratio; `slower` is
    /// multiplied where there is one.
    ///
    /// At most 1: the law keeps every limit at every look. `slower` are factors of x, one a knot.
    ///
    /// A limit that is exceeded by a ratio multiplies the caps of all knots that the window holds at that look by
    /// 0.97/ratio: a rate's square goes with x, and so does what an acceleration is made of. O(looks · joints), 20
    /// looks a window.
    fn lower(&self, section: &Section, asked: &Asked, slower: &mut [f64]) -> f64 {
        let step = self.window / LOOKS;
        let (mut worst, mut span, mut head, mut tail) = (0.0f64, 0, 0, 0);
        let mut before = Progress { s: 0.0, rate: 0.0, acceleration: 0.0 };
        let mut allowed = vec![1.0f64; slower.len()];
        for look in 0..(self.duration() / step).ceil() as usize {
            let t = (look as f64 + 0.5) * step;
            let left = tail;
            head = self.interval_from(t, head);
            tail = self.interval_from(t - self.window, tail);
            let now = self.averaged(self.raw_in(t, head), || self.raw_in(t - self.window, tail));
            let entered = span;
            span = section.span(now.s, span);
            let mut ratio = asked.ratio(section, span, section.share(span, now.s), &now);
            // Curvature jumps at nodes: those that were passed since the last look are looked at from both sides.
            for node in entered + 1..=span {
                let there = before.towards(&now, section.s[node]);
                ratio = ratio.max(asked.ratio(section, node - 1, 1.0, &there));
                ratio = ratio.max(asked.ratio(section, node, 0.0, &there));
            }
            worst = worst.max(ratio);
            if ratio > 1.0 {
                for allowed in &mut allowed[left..=(head + 1).min(slower.len() - 1)] {
                    *allowed = allowed.min(0.97 / ratio);
                }
            }
            before = now;
        }
        for (slower, allowed) in slower.iter_mut().zip(allowed) {
            *slower *= allowed;
        }
        worst
    }
}

impl Progress {
    /// Progress at `s` between this one and a later one, on a straight line.
    fn towards(&self, later: &Self, s: f64) -> Self {
        let part = ((s - self.s) / (later.s - self.s)).clamp(0.0, 1.0);
        let between = |from: f64, to: f64| from + part * (to - from);
        Self { s, rate: between(self.rate, later.rate), acceleration: between(self.acceleration, later.acceleration) }
    }
}

/// What progress asks of joints, measured in what they can.
struct Asked {
    /// 1 / limit.
    speed: Joints,
    /// 1 / (share · limit).
    acceleration: Joints,
}

impl Asked {
    fn of(limits: &[JointLimit; AXES]) -> Self {
        Self {
            speed: limits.map(|limit| 1.0 / limit.speed),
            acceleration: limits.map(|limit| 1.0 / (USED_AVERAGED * limit.acceleration)),
        }
    }

    /// The largest ratio of a joint's speed (squared) or acceleration to what it can, at a share of a span.
    ///
    /// ```text
    /// max over joints of  (q′ ṡ/q̇_max)²  and  |q″ ṡ² + q′ s̈| / (0.97 q̈_max)
    /// ```
    fn ratio(&self, section: &Section, span: usize, share: f64, now: &Progress) -> f64 {
        let jet = section.jet(span, share);
        let squared = square(now.rate);
        let mut most = 0.0f64;
        for k in 0..AXES {
            let acceleration = jet.bend[k] * squared + jet.slope[k] * now.acceleration;
            let speed = square(jet.slope[k] * now.rate * self.speed[k]);
            most = most.max(speed).max((acceleration * self.acceleration[k]).abs());
        }
        most
    }
}
