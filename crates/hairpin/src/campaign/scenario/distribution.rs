//! A value of `[vary]`: the distribution of a key.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A distribution: exactly one of `uniform`, `normal`, `choice`. Numbers or arrays of numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Distribution {
    /// Low and high.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uniform: Option<[Value; 2]>,
    /// Mean and standard deviation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<[Value; 2]>,
    /// One of these, equally likely.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub choice: Option<Vec<Value>>,
    /// Draws below are drawn again (truncation).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Draws above are drawn again.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}

/// How many standard deviations from the mean a normal draw is drawn again (2 in 10⁹): every draw lies between
/// bounds that can be checked before anything flies.
pub(crate) const WIDEST_SIGMA: f64 = 6.0;

/// Whether a key of `[vary]` is drawn per case, when trajectories are generated, rather than per run.
pub fn shapes_the_plan(key: &str) -> bool {
    key.starts_with("task.") || key.starts_with("generate.")
}

/// Runs per case: those that are `given`, or else one, and two where `vary` draws anything for runs, as run 0 is
/// nominal. Where runs are `recorded` nothing is drawn for them.
pub(in crate::campaign) fn runs(given: Option<u64>, vary: &BTreeMap<String, Distribution>, recorded: bool) -> u64 {
    let drawn = !recorded && vary.keys().any(|key| !shapes_the_plan(key));
    given.unwrap_or(if drawn { 2 } else { 1 })
}

impl Distribution {
    /// The largest that may be drawn of a key of one number, or of the number `within` of what may be chosen.
    pub(in crate::campaign) fn largest(&self, within: &str) -> Option<f64> {
        let number = |value: &Value| value.as_f64().or_else(|| value.get(within)?.as_f64());
        match (&self.uniform, &self.normal, &self.choice) {
            (Some([_, high]), ..) => number(high),
            (_, Some([mean, deviation]), _) => Some(self.interval(number(mean)?, number(deviation)?).1),
            (_, _, Some(choice)) => choice.iter().filter_map(number).reduce(f64::max),
            (None, None, None) => None,
        }
    }

    /// Where draws of `normal` with this mean and deviation lie: within `min` and `max`, and six deviations.
    pub(crate) fn interval(&self, mean: f64, deviation: f64) -> (f64, f64) {
        let low = self.min.unwrap_or(f64::NEG_INFINITY).max(mean - WIDEST_SIGMA * deviation);
        let high = self.max.unwrap_or(f64::INFINITY).min(mean + WIDEST_SIGMA * deviation);
        (low, high)
    }
}

/// `leaf` of every pair of numbers at the same place in `a` and `b`, in their shape. `whole`, where it has the same
/// shape, says where whole numbers are wanted. `None` where the shapes differ or something is no number.
pub(crate) fn zip(
    a: &Value,
    b: &Value,
    whole: Option<&Value>,
    leaf: &mut impl FnMut(f64, f64, bool) -> f64,
) -> Option<Value> {
    if let (Value::Array(a), Value::Array(b)) = (a, b) {
        if a.len() != b.len() {
            return None;
        }
        let at = |i: usize| whole.and_then(|whole| whole.get(i));
        let items = a.iter().zip(b).enumerate().map(|(i, (a, b))| zip(a, b, at(i), leaf));
        return items.collect::<Option<Vec<_>>>().map(Value::Array);
    }
    let whole = whole.is_some_and(|value| value.is_u64() || value.is_i64());
    let x = leaf(a.as_f64()?, b.as_f64()?, whole);
    if whole { Some(Value::from(x.round() as i64)) } else { serde_json::Number::from_f64(x).map(Value::Number) }
}
