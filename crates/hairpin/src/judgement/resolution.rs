//! The step in which a recording tells places and velocities: what rounding makes of an acceleration nobody flew.

use crate::trajectory::Track;

/// What accelerations are differences of.
///
/// Differences of positions at stamps Δ apart carry noise of σ as √6 σ/Δ²: 1 mm at 100 Hz is 24 m/s². What the last
/// digit that is told does is known ([`Resolution`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AccelerationSource {
    /// The velocity channels.
    #[default]
    Velocity,
    /// Positions: no velocity was recorded, so noise weighs more.
    Position,
}

/// An acceleration is seen that lasts as long, s: a mean over more hides what a robot does in one turn.
pub const SEEN_WITHIN_S: f64 = 0.5;

/// Whether a mean over `span` s shows an acceleration; stamps are rounded.
pub fn is_seen(span: f64) -> bool {
    span <= SEEN_WITHIN_S + 1e-6
}

/// So many values tell in which step they are told.
pub const TELLING: usize = 20;
/// The finest step that is looked for, decimals: below it a double's own rounding begins.
const FINEST: i32 = 7;
/// How far, in steps, a value may be off a whole number of them.
const OFF: f64 = 1e-6;

/// The step in which numbers of three axes are told; 0: exactly.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Step {
    /// Of the axis whose numbers are the coarsest.
    pub each: f64,
    /// Length of the vector of all three.
    pub all: f64,
    /// How far rounding has moved a vector at most: half of that, where the numbers are those nearest to whole steps,
    /// as rounded ones are. Computed ones are a few bits off, and were moved by nothing.
    pub moved: f64,
}

/// The steps of a recording.
///
/// With rows t₀, t₁, t₂ that are h₁ and h₂ apart, and a step whose vector has the length q, an acceleration is off by
/// at most
///
/// ```text
/// 2 q/(h₁ h₂)     of the second divided difference of places
/// q/(h₁ + h₂)     of the difference of velocities
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Resolution {
    /// Of places, m.
    pub place: Step,
    /// Of velocities, m/s.
    pub velocity: Step,
}

impl Resolution {
    /// What the numbers of a track themselves show: they are whole numbers of a power of ten from 0.1 on, or of what a
    /// number of 32 bits resolves. Of less than twenty rows nothing is said.
    pub fn of(track: &Track) -> Self {
        let places = [0, 1, 2].map(|axis| track.poses().iter().map(|pose| pose.translation.vector[axis]).collect());
        let told = ["vx_m_s", "vy_m_s", "vz_m_s"].map(|name| track.channel(name));
        let velocity = match told {
            [Some(x), Some(y), Some(z)] => Step::of(&[x, y, z].map(<[f64]>::to_vec)),
            _ => Step::default(),
        };
        Self { place: Step::of(&places), velocity }
    }

    pub(super) fn of_source(&self, source: AccelerationSource) -> Step {
        match source {
            AccelerationSource::Velocity => self.velocity,
            AccelerationSource::Position => self.place,
        }
    }
}

impl Step {
    /// The same of numbers that a text has to `digit`, whose steps are never finer; of whole ones nothing is said, as
    /// they are somebody's grid.
    pub fn written_to(self, digit: f64) -> Self {
        Self { moved: if digit < 1.0 { 0.5 * 3_f64.sqrt() * digit } else { 0.0 }, ..self }
    }

    /// Of numbers that are rounded to these steps, along three axes at right angles.
    pub fn along(steps: [f64; 3]) -> Self {
        let all = steps.iter().map(|step| step * step).sum::<f64>().sqrt();
        Self { each: steps.into_iter().fold(0.0, f64::max), all, moved: 0.5 * all }
    }

    /// Of the values of three axes. One that never changes does not show its own, and counts as the coarsest that does.
    ///
    /// O(values).
    pub fn of(axes: &[Vec<f64>; 3]) -> Self {
        let changes = |axis: &Vec<f64>| axis.windows(2).any(|pair| pair[0] != pair[1]);
        let steps = [0, 1, 2].map(|axis| changes(&axes[axis]).then(|| step(&axes[axis])));
        let each = steps.iter().flatten().copied().fold(0.0, f64::max);
        let all = steps.iter().map(|step| step.unwrap_or(each)).map(|step| step * step).sum::<f64>().sqrt();
        let per_unit = (1.0 / each).round();
        let nearest = |value: &f64| *value == (value * per_unit).round() / per_unit;
        let moved = if each > 0.0 && axes.iter().flatten().all(nearest) { 0.5 * all } else { 0.0 };
        Self { each, all, moved }
    }
}

/// 0 of values that are told exactly, or of too few.
fn step(values: &[f64]) -> f64 {
    if values.len() < TELLING {
        return 0.0;
    }
    let of = |decimals: i32| {
        let scale = libm::exp10(f64::from(decimals));
        values.iter().all(|value| (value * scale - (value * scale).round()).abs() <= OFF).then(|| 1.0 / scale)
    };
    // Whole metres are somebody's grid.
    if of(0).is_some() {
        return 0.0;
    }
    if let Some(step) = (1..=FINEST).find_map(of) {
        return step;
    }
    let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let is_single = values.iter().all(|value| f64::from(*value as f32) == *value);
    if is_single { largest * f64::from(f32::EPSILON) } else { 0.0 }
}

/// What the step in which a recording is told leaves open of its largest acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unresolved {
    /// It may be as much more or less, m/s².
    pub by: f64,
    /// The step, m or m/s, of the axis whose numbers are the coarsest.
    pub step: f64,
    /// The time between the rows that it is a difference of, s.
    pub over: f64,
}

impl Unresolved {
    /// Whether that decides a `limit` of an acceleration that was measured as `value`, m/s².
    pub fn decides(&self, value: f64, limit: f64) -> bool {
        value - self.by <= limit && limit < value + self.by
    }

    /// `positions are told in steps of 0.001 m: 0.25 s apart that can make 0.06 m/s²`.
    pub fn in_words(&self, source: AccelerationSource) -> String {
        let (what, unit) = match source {
            AccelerationSource::Position => ("positions", "m"),
            AccelerationSource::Velocity => ("velocities", "m/s"),
        };
        let digits = |value: f64| {
            let decimals = (1.0 - libm::floor(libm::log10(value))).clamp(0.0, 9.0) as usize;
            format!("{value:.decimals$}")
        };
        let step = (1e10 * self.step).round() / 1e10;
        format!(
            "{what} are told in steps of {step} {unit}: {} s apart that can make {} m/s²",
            digits(self.over),
            digits(self.by)
        )
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    fn axis(count: usize, of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..count).map(|i| of(0.37 * i as f64)).collect()
    }

    #[test]
    fn steps_are_seen_in_the_numbers() {
        let rounded = |decimals: i32| move |t: f64| (t.sin() * 10_f64.powi(decimals)).round() / 10_f64.powi(decimals);
        for decimals in 1..=7 {
            let found = step(&axis(50, rounded(decimals)));
            assert!((found / 10_f64.powi(-decimals) - 1.0).abs() < 1e-9, "{decimals}: {found}");
        }
        assert_eq!(
            (step(&axis(50, f64::sin)), step(&axis(19, rounded(2))), step(&axis(50, f64::round))),
            (0.0, 0.0, 0.0)
        );
        let single = step(&axis(50, |t| f64::from((20.0 * t.sin()) as f32)));
        assert!((1e-6..3e-6).contains(&single), "{single}");
        // Far from the origin, and in millimetres that were divided.
        let far = step(&axis(50, |t| 5000.0 + (t.sin() * 1000.0).round() / 1000.0));
        assert!((far / 1e-3 - 1.0).abs() < 1e-9, "{far}");
        // One axis that stands still is told no better than the others.
        let of = Step::of(&[axis(50, rounded(3)), axis(50, f64::sin), axis(50, |_| 5.0)]);
        assert!((of.each - 1e-3).abs() < 1e-12 && (of.all - 2_f64.sqrt() * 1e-3).abs() < 1e-12, "{of:?}");
    }
}
