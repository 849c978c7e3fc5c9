//! Numbers that must be seen to differ.

/// Two numbers with as many decimals as it takes to see that they differ: at least `least`.
pub(super) fn apart(value: f64, limit: f64, least: usize) -> (String, String) {
    for decimals in least..12 {
        let pair = (format!("{value:.decimals$}"), format!("{limit:.decimals$}"));
        if pair.0 != pair.1 || value == limit {
            return pair;
        }
    }
    (value.to_string(), limit.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_show_the_difference() {
        assert_eq!(apart(0.500_04, 0.5, 2), ("0.50004".into(), "0.50000".into()));
        assert_eq!(apart(0.65, 0.5, 2), ("0.65".into(), "0.50".into()));
    }
}
