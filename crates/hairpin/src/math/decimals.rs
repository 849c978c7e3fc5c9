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
