//! Numbers that must be seen to differ.
//!
//! A verdict never says "0.50 m > 0.50 m".

use crate::math::decimals::that_differ;

/// What is nearer to nothing is nothing to whoever reads: 5 µm.
const NOTHING: f64 = 5e-6;
/// What is smaller has more zeros than anybody counts.
const LONGEST: f64 = 1e-6;

/// A number of `unit` as a verdict tells it: with the digits that `limit` was given with, two decimals at least (of
/// degrees one), and as many more as it takes to see that they differ.
///
/// A value without a limit has the unit's least decimals, or its first two digits where those would show zeros.
pub fn told(value: f64, limit: Option<f64>, unit: &str) -> String {
    apart(value, limit.unwrap_or(f64::NAN), limit.map_or(least(unit), |limit| decimals_of(limit, least(unit)))).0
}

/// A bound of `unit` as [`told`] beside `limit`, and none of whose digits makes it tighter than it is: rounded up, and
/// down of a lower bound, `below`.
///
/// What a double rounds is no digit.
pub fn told_outward(bound: f64, limit: f64, unit: &str, below: bool) -> String {
    let near = told(bound, Some(limit), unit);
    let decimals = near.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let (one, sign) = (libm::exp10(-(decimals as f64)), if below { -1.0 } else { 1.0 });
    match near.parse::<f64>() {
        Ok(number) if sign * (bound - number) > 1e-6 * one => format!("{:.decimals$}", number + sign * one + 0.0),
        _ => near,
    }
}

/// Decimals that every number of `unit` has.
pub(super) fn least(unit: &str) -> usize {
    if unit == "°" { 1 } else { 2 }
}

/// Two numbers with as many decimals as it takes to see that they differ, and that a value is not zero: at least
/// `least`.
///
/// At most 11 decimals, then all digits that the numbers have. Equal numbers are told alike. NaN is told as such. Below
/// a micrometre, where the limit shows without as many zeros, the value is told by its first two digits and a power of
/// ten.
pub(super) fn apart(value: f64, limit: f64, least: usize) -> (String, String) {
    // Of −0 too: what is nothing has no sign. How far below zero is always told, for a bound may be there.
    let value = if value.abs() < 1e-12 { 0.0 } else { value };
    let of_limit = least;
    let least = if value > -1e-12 && value < NOTHING { least } else { two_digits(value, least) };
    let shows = if limit == 0.0 { value != 0.0 } else { least > of_limit && limit.abs() >= NOTHING };
    if shows && value.abs() < LONGEST {
        return (format!("{value:.1e}"), format!("{limit:.of_limit$}"));
    }
    let decimals = if value == limit { least } else { that_differ(value, limit, least..=12) };
    if decimals < 12 {
        (format!("{value:.decimals$}"), format!("{limit:.decimals$}"))
    } else {
        (value.to_string(), limit.to_string())
    }
}

/// `least` decimals, or where these show nothing of `value` the first two digits that it has.
fn two_digits(value: f64, least: usize) -> usize {
    let shows = |decimals: usize| format!("{value:.decimals$}").bytes().any(|digit| (b'1'..=b'9').contains(&digit));
    (least..12).find(|decimals| shows(*decimals)).map_or(12, |first| if first == least { least } else { first + 1 })
}

/// Decimals that `limit` was given with, from `least` to four; `least` of one that was drawn or computed, and has more.
///
/// 10^k · limit is whole to 1e-7 for the answer k.
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

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn limits_keep_the_digits_that_they_were_given_with() {
        assert_eq!([0.5, 0.025, 10.0, 1e3 * 0.0101, 0.0004].map(|limit| decimals_of(limit, 2)), [2, 3, 2, 2, 4]);
        assert_eq!((decimals_of(0.483_726_15, 2), decimals_of(10.0, 1)), (2, 1));
    }

    #[test]
    fn bounds_are_rounded_outward() {
        let above = [0.403_94, 0.41, 0.400_1, 0.5, f64::INFINITY].map(|bound| told_outward(bound, 0.5, "m", false));
        assert_eq!(above, ["0.41", "0.41", "0.41", "0.50", "inf"]);
        assert_eq!(told_outward(0.500_94, 0.5, "m", false), "0.501");
        assert_eq!([-0.231, 0.239].map(|bound| told_outward(bound, 0.3, "m", true)), ["-0.24", "0.23"]);
    }

    #[test]
    fn digits_show_the_difference() {
        assert_eq!(apart(0.500_04, 0.5, 2), ("0.50004".into(), "0.50000".into()));
        assert_eq!(apart(-0.002, 0.25, 2), ("-0.0020".into(), "0.2500".into()));
        assert_eq!(apart(0.0042, 0.5, 2), ("0.0042".into(), "0.5000".into()));
        assert_eq!(apart(1e-9, 0.5, 2), ("0.00".into(), "0.50".into()));
        assert_eq!(apart(-9e-10, 0.0, 2), ("-9.0e-10".into(), "0.00".into()));
        assert_eq!(apart(3e-7, 0.0, 2), ("3.0e-7".into(), "0.00".into()));
        assert_eq!(apart(-0.000_02, 0.0, 2), ("-0.000020".into(), "0.000000".into()));
        assert_eq!(apart(-0.0, 0.25, 2), ("0.00".into(), "0.25".into()));
        assert_eq!(apart(0.65, 0.5, 2), ("0.65".into(), "0.50".into()));
    }

    #[test]
    fn numbers_have_the_digits_of_their_limit() {
        let of = |value: f64, limit: f64| told(value, Some(limit), "m");
        assert_eq!([of(0.0183, 0.025), of(0.5004, 0.5), of(650.0, 500.0)], ["0.018", "0.5004", "650.00"]);
        let free = |value: f64| told(value, None, "m");
        assert_eq!([free(0.654), free(0.004_21), free(0.0)], ["0.65", "0.0042", "0.00"]);
        assert_eq!([told(7.24, Some(10.0), "°"), told(7.24, None, "°")], ["7.2", "7.2"]);
    }
}
