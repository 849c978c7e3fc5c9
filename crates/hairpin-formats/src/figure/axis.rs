//! An axis for the drawing library: values to places, and where its ticks stand.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use super::marks::Scale;
use super::table::three_digits;

/// A range of values with a way to place them.
#[derive(Debug, Clone)]
pub(super) struct Ticked {
    low: f64,
    high: f64,
    scale: Scale,
}

impl Ticked {
    /// An axis of `scale` that shows all of `values`; with `from_zero` a linear one shows 0 as well.
    pub(super) fn over(scale: &Scale, values: impl Iterator<Item = f64>, from_zero: bool) -> Self {
        let logarithmic = *scale == Scale::Logarithmic;
        let seen = values.filter(|value| value.is_finite() && (!logarithmic || *value > 0.0));
        let (mut low, mut high) =
            seen.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        match scale {
            Scale::Range(from, to) => (low, high) = (from.min(*to), from.max(*to)),
            Scale::Names(names) => (low, high) = (-0.5, names.len().max(1) as f64 - 0.5),
            Scale::Logarithmic if low > high => (low, high) = (1.0, 10.0),
            Scale::Logarithmic => (low, high) = (0.7 * low, 1.4 * high),
            Scale::Linear => {
                if low > high {
                    (low, high) = (0.0, 1.0);
                }
                if from_zero {
                    (low, high) = (low.min(0.0), high.max(0.0));
                }
                let room = if high > low { 0.06 * (high - low) } else { 0.5 };
                (low, high) = (if from_zero && low == 0.0 { 0.0 } else { low - room }, high + room);
            }
        }
        if high <= low {
            high = low + 1.0;
        }
        Self { low, high, scale: scale.clone() }
    }

    /// Where bars stand.
    pub(super) fn floor(&self) -> f64 {
        if self.scale == Scale::Logarithmic { self.low } else { self.low.max(0.0).min(self.high) }
    }

    /// Whether the value can be placed.
    pub(super) fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale != Scale::Logarithmic || value > 0.0)
    }

    /// Place of `value`: 0 at the lower end, 1 at the upper.
    fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Logarithmic => libm::log(value / self.low) / libm::log(self.high / self.low),
            _ => (value - self.low) / (self.high - self.low),
        }
    }

    /// 1, 2, 5 times powers of ten, about `most` of them.
    fn ticks(&self, most: usize) -> Vec<f64> {
        match &self.scale {
            Scale::Names(names) => (0..names.len()).map(|index| index as f64).collect(),
            Scale::Logarithmic => {
                let (first, last) = (libm::floor(libm::log10(self.low)), libm::ceil(libm::log10(self.high)));
                let factors: &[f64] = if last - first <= 2.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
                let decades = (first as i32..=last as i32).map(|power| libm::exp10(power.into()));
                let all = decades.flat_map(|decade| factors.iter().map(move |factor| factor * decade));
                all.filter(|tick| (self.low..=self.high).contains(tick)).collect()
            }
            Scale::Linear | Scale::Range(..) => {
                let rough = (self.high - self.low) / most.max(1) as f64;
                let decade = libm::exp10(libm::floor(libm::log10(rough)));
                let step = [1.0, 2.0, 5.0, 10.0].map(|f| f * decade).into_iter().find(|step| *step >= rough);
                let step = step.unwrap_or(10.0 * decade);
                let (first, last) = (libm::ceil(self.low / step) as i64, libm::floor(self.high / step) as i64);
                (first..=last).map(|k| k as f64 * step).collect()
            }
        }
    }
}

impl Ranged for Ticked {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        // Far outside is as good as outside, and has room in whole numbers.
        let place = self.place(*value).clamp(-10.0, 10.0);
        from + libm::round(f64::from(to - from) * place) as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        self.ticks(hint.max_num_points().min(8))
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Ticked {
    fn format_ext(&self, value: &f64) -> String {
        if let Scale::Names(names) = &self.scale {
            return names.get(*value as usize).cloned().unwrap_or_default();
        }
        let text = three_digits(*value);
        match text.split_once('e') {
            Some((digits, power)) => format!("{}e{power}", trimmed(digits)),
            None => trimmed(&text).to_owned(),
        }
    }
}

/// Without the zeros behind the point.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}
