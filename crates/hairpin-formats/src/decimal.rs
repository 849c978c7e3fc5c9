//! Numbers for programs that people read: fixed decimals without trailing zeros.

/// `value` rounded to `decimals`, without trailing zeros, never `-0`, never with an exponent.
pub fn decimal(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::decimal;

    #[test]
    fn zeros_and_signs_are_dropped() {
        for (value, decimals, text) in [
            (1.0, 6, "1"),
            (-0.000_000_4, 6, "0"),
            (0.1 + 0.2, 6, "0.3"),
            (100.0, 0, "100"),
            (-12.345_678_9, 6, "-12.345679"),
            (1e9, 3, "1000000000"),
        ] {
            assert_eq!(decimal(value, decimals), text);
        }
    }
}
