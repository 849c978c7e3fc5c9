//! Numbers as they are read: how many decimals show that two of them differ.

use std::ops::RangeInclusive;

/// The fewest decimals, of those in `within`, with which `a` and `b` are not written alike; the most of them where none
/// does.
///
/// ```
/// # use hairpin::math::decimals::that_differ;
/// assert_eq!(that_differ(0.5004, 0.5, 1..=9), 4);
/// assert_eq!(that_differ(0.5, 0.5, 1..=9), 9);
/// ```
pub fn that_differ(a: f64, b: f64, within: RangeInclusive<usize>) -> usize {
    let most = *within.end();
    within.into_iter().find(|d| format!("{a:.d$}", d = *d) != format!("{b:.d$}", d = *d)).unwrap_or(most)
}

/// What something is beyond its bound by: two decimals, or as many as tell it from nothing, nine at most.
///
/// ```
/// # use hairpin::math::decimals::beyond;
/// assert_eq!((beyond(1.234), beyond(0.000_012_3)), ("1.23".to_owned(), "0.00001".to_owned()));
/// ```
pub fn beyond(value: f64) -> String {
    format!("{value:.*}", that_differ(value, 0.0, 2..=9))
}
