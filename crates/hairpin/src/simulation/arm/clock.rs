//! Progress along a section over time: constant acceleration between knots, averaged over a moving window for an S-curve.

use super::grid::Section;
use super::profile::{Knots, squared_rates};
use super::settings::{PlanSettings, Shape};
use crate::math::power::square;
use crate::robot::arm::{AXES, JointLimit};

/// s(t) of a section from rest to rest. With a window T: s_f(t) = (1/T) ∫ s over (t − T, t).
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
    pub(super) s: f64,
    pub(super) rate: f64,
    pub(super) acceleration: f64,
}

/// How often an S-curve's caps are lowered where it exceeds a joint's limits, before all of it is slowed down.
const ROUNDS: usize = 8;
/// Looks per window at what an S-curve asks of the joints.
const LOOKS: f64 = 20.0;
/// Excess is counted from this share of a limit on: between two looks there can be a little more.
const USED: f64 = 0.97;

impl Law {
    /// The law of `section`; of a section without a motion one that is over at once.
    pub(super) fn of(section: &Section, limits: &[JointLimit; AXES], settings: &PlanSettings) -> Self {
        let spans = section.spans.len();
        let knots = Knots::of(section);
        let mut slower = vec![1.0; knots.s.len()];
        let rates = |slower: &[f64]| squared_rates(section, &knots, limits, settings, slower);
        let window = match settings.shape {
            Shape::Trapezoid => 0.0,
            Shape::SCurve(width) => width,
        };
        if spans == 0 || window == 0.0 {
            return Self::new(&knots, &if spans == 0 { vec![0.0] } else { rates(&slower) }, 0.0);
        }
        let mut law = Self::new(&knots, &rates(&slower), window);
        for _ in 0..ROUNDS {
            if law.lower(section, limits, &mut slower) <= 1.0 {
                return law;
            }
            law = Self::new(&knots, &rates(&slower), window);
        }
        // Slower by a factor everywhere asks the square of it less of every acceleration.
        loop {
            let excess = law.lower(section, limits, &mut slower);
            if excess <= 1.0 {
                return law;
            }
            let squared: Vec<f64> = law.rates.iter().map(|rate| square(*rate) / (1.02 * excess)).collect();
            law = Self::new(&knots, &squared, window);
        }
    }

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

    fn interval(&self, t: f64) -> usize {
        self.times.partition_point(|time| *time <= t).clamp(1, self.times.len() - 1) - 1
    }

    /// s, ṡ, s̈ and ∫ s dt without the window.
    fn raw(&self, t: f64) -> [f64; 4] {
        let last = self.times.len() - 1;
        if last == 0 || t <= 0.0 {
            return [0.0; 4];
        }
        if t >= self.times[last] {
            return [self.s[last], 0.0, 0.0, self.area[last] + self.s[last] * (t - self.times[last])];
        }
        let i = self.interval(t);
        let step = self.times[i + 1] - self.times[i];
        let (dt, push) = (t - self.times[i], (self.rates[i + 1] - self.rates[i]) / step);
        let s = self.s[i] + dt * (self.rates[i] + 0.5 * push * dt);
        let area = self.area[i] + dt * (self.s[i] + dt * (0.5 * self.rates[i] + dt * push / 6.0));
        [s, self.rates[i] + push * dt, push, area]
    }

    /// Progress at `t` s after the section's start.
    pub(super) fn at(&self, t: f64) -> Progress {
        let [s, rate, acceleration, area] = self.raw(t);
        if self.window == 0.0 {
            return Progress { s, rate, acceleration };
        }
        let [before, rate_before, _, area_before] = self.raw(t - self.window);
        let by = 1.0 / self.window;
        Progress {
            s: ((area - area_before) * by).min(self.s[self.s.len() - 1]),
            rate: (s - before) * by,
            acceleration: (rate - rate_before) * by,
        }
    }

    /// When progress reaches `s`.
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

    /// The largest excess of a joint's speed (squared) or acceleration over its limit, as a ratio; `slower` is multiplied where
    /// there is one.
    fn lower(&self, section: &Section, limits: &[JointLimit; AXES], slower: &mut [f64]) -> f64 {
        let step = self.window / LOOKS;
        let (mut worst, mut span) = (0.0f64, 0);
        let mut allowed = vec![1.0f64; slower.len()];
        for look in 0..(self.duration() / step).ceil() as usize {
            let t = (look as f64 + 0.5) * step;
            let now = self.at(t);
            span = section.span(now.s, span);
            let u = (now.s - section.s[span]) / (section.s[span + 1] - section.s[span]);
            let jet = section.jet(span, u);
            let ratio = (0..AXES).map(|k| {
                let acceleration = jet.bend[k] * square(now.rate) + jet.slope[k] * now.acceleration;
                let speed = USED * square(jet.slope[k] * now.rate / limits[k].speed);
                speed.max(acceleration.abs() / limits[k].acceleration)
            });
            let ratio = ratio.fold(0.0, f64::max);
            let ratio = ratio / USED;
            worst = worst.max(ratio);
            if ratio > 1.0 {
                let (first, last) = (self.interval(t - self.window), self.interval(t) + 1);
                for allowed in &mut allowed[first..=last.min(slower.len() - 1)] {
                    *allowed = allowed.min(0.97 / ratio);
                }
            }
        }
        for (slower, allowed) in slower.iter_mut().zip(allowed) {
            *slower *= allowed;
        }
        worst
    }
}
