//! The value that means no data, as tools write it.

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
    fn nan_in_any_spelling() {
        for text in ["nan", "NaN", "NAN", "-nan", " nan ", "-1.#QNAN", "1.#IND"] {
            assert!(parse(text).unwrap().is_nan(), "{text}");
        }
        assert_eq!((parse("-3.4028234663852886e+38"), parse("none")), (Some(-3.402_823_466_385_288_6e38), None));
    }
}
