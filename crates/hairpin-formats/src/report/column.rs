//! Numbers as the page's script reads them: 16 bits each, over the range that they have.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// Steps over a range; the code above them is nothing.
const STEPS: f64 = 65534.0;
const NOTHING: u16 = 65535;

/// `[offset, scale, base64]`, low byte first; what is not finite is nothing. Exact to a 131 068th of the range.
pub(super) fn column(values: impl IntoIterator<Item = f64>) -> Value {
    let values: Vec<f64> = values.into_iter().collect();
    let known = || values.iter().copied().filter(|value| value.is_finite());
    let (low, high) = known().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let (low, scale) =
        if low < high { (low, (high - low) / STEPS) } else { (if low.is_finite() { low } else { 0.0 }, 1.0) };
    packed(low, scale, values.iter().map(|v| if v.is_finite() { ((v - low) / scale).round() as u16 } else { NOTHING }))
}

/// Whole numbers below 65535, exact.
pub(super) fn counts(values: impl IntoIterator<Item = u32>) -> Value {
    packed(0.0, 1.0, values.into_iter().map(|value| u16::try_from(value).unwrap_or(NOTHING)))
}

/// To so many decimals, without minus zeros.
pub(super) fn round(value: f64, digits: i32) -> f64 {
    let scale = 10_f64.powi(digits);
    let rounded = (value * scale).round() / scale;
    if rounded == 0.0 { 0.0 } else { rounded }
}

fn packed(offset: f64, scale: f64, codes: impl Iterator<Item = u16>) -> Value {
    let bytes: Vec<u8> = codes.flat_map(u16::to_le_bytes).collect();
    json!([offset, scale, STANDARD.encode(bytes)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers again.
    fn unpacked(column: &Value) -> Vec<f64> {
        let (offset, scale) = (column[0].as_f64().unwrap(), column[1].as_f64().unwrap());
        let bytes = STANDARD.decode(column[2].as_str().unwrap()).unwrap();
        let code = |pair: &[u8]| u16::from_le_bytes([pair[0], pair[1]]);
        bytes
            .chunks(2)
            .map(|pair| if code(pair) == NOTHING { f64::NAN } else { offset + scale * f64::from(code(pair)) })
            .collect()
    }

    #[test]
    fn columns_keep_their_ends_and_holes() {
        let values = [0.5, f64::NAN, -3.25, 12.0, 0.123_456];
        let again = unpacked(&column(values));
        assert!(again[1].is_nan() && again[2] == -3.25 && (again[3] - 12.0).abs() < 1e-12);
        assert!((again[4] - values[4]).abs() <= 15.25 / 131_068.0 + 1e-12);
        assert_eq!(unpacked(&column([7.0, 7.0])), [7.0, 7.0]);
        assert!(unpacked(&column([f64::NAN]))[0].is_nan() && unpacked(&column([])).is_empty());
        assert_eq!(unpacked(&counts([0, 3, 65534])), [0.0, 3.0, 65534.0]);
    }
}
