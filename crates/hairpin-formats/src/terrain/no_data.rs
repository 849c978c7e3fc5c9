//! The value that means no data, as tools write it.

/// Heights farther than this from 0 are the ±3.4e38 and 1.7e38 (Surfer) of tools that forget to say so.
const FARTHEST: f64 = 1e30;

/// Whether a value is no height, whatever else the file says of it.
pub(super) fn is_none(value: f64) -> bool {
    !value.is_finite() || value.abs() > FARTHEST
}

/// A number in any spelling: `-9999`, `nan`, `NaN`, `-nan`, `-1.#QNAN` of older Windows.
pub(super) fn parse(text: &str) -> Option<f64> {
    let text = text.trim();
    if text.contains("#QNAN") || text.contains("#IND") || text.contains("#SNAN") {
        return Some(f64::NAN);
    }
    text.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_far_from_all_ground_is_no_height() {
        assert!([f64::NAN, f64::INFINITY, -3.4e38, -1.1e30, 1.70141e38, 3.4e38].into_iter().all(is_none));
        assert!(![-11_000.0, 0.0, -9999.0, 9e5].into_iter().any(is_none));
    }

    #[test]
    fn nan_in_any_spelling() {
        for text in ["nan", "NaN", "NAN", "-nan", " nan ", "-1.#QNAN", "1.#IND"] {
            assert!(parse(text).unwrap().is_nan(), "{text}");
        }
        assert_eq!((parse("-3.4028234663852886e+38"), parse("none")), (Some(-3.402_823_466_385_288_6e38), None));
    }
}
