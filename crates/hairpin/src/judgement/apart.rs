//! Numbers that must be seen to differ.
//!
//! A verdict never says "0.50 m > 0.50 m".

/// Two numbers with as many decimals as it takes to see that they differ, and how far a value below zero is below it:
/// at least `least`.
pub(super) fn apart(value: f64, limit: f64, least: usize) -> (String, String) {
    // Of −0 too: what is nothing has no sign.
    let value = if value.abs() < 1e-12 { 0.0 } else { value };
    for decimals in least..12 {
        let pair = (format!("{value:.decimals$}"), format!("{limit:.decimals$}"));
        let shown = value >= 0.0 || pair.0.bytes().any(|digit| (b'1'..=b'9').contains(&digit));
        if shown && (pair.0 != pair.1 || value == limit) {
            return pair;
        }
    }
    (value.to_string(), limit.to_string())
}

/// Decimals that `limit` was given with, from `least` to four; `least` of one that was drawn or computed, and has more.
pub fn decimals_of(limit: f64, least: usize) -> usize {
    let mut scaled = limit;
    for decimals in 0..=4 {
        if decimals >= least && (scaled - scaled.round()).abs() < 1e-7 {
            return decimals;
        }
        scaled *= 10.0;
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_keep_the_digits_that_they_were_given_with() {
        assert_eq!([0.5, 0.025, 10.0, 1e3 * 0.0101, 0.0004].map(|limit| decimals_of(limit, 2)), [2, 3, 2, 2, 4]);
        assert_eq!((decimals_of(0.483_726_15, 2), decimals_of(10.0, 1)), (2, 1));
    }

    #[test]
    fn digits_show_the_difference() {
        assert_eq!(apart(0.500_04, 0.5, 2), ("0.50004".into(), "0.50000".into()));
        assert_eq!(apart(-0.002, 0.25, 2), ("-0.002".into(), "0.250".into()));
        assert_eq!(apart(-0.0, 0.25, 2), ("0.00".into(), "0.25".into()));
        assert_eq!(apart(0.65, 0.5, 2), ("0.65".into(), "0.50".into()));
    }
}
