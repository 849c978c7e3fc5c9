//! Numbers as people read them: the one place that rounds, so that table, report, JUnit and verdict agree.
//!
//! Rounding is for people only: files and JSON have all digits.

/// `value` with two decimals below 100, one below 1000, none above, five below a hundredth; `–` for nothing. Nothing is
/// never less than nothing: what these digits do not show has no sign.
pub fn number(value: Option<f64>) -> String {
    match value {
        None => "–".into(),
        Some(v) if v.abs() < 0.000_005 => "0.00".into(),
        Some(v) if v != 0.0 && v.abs() < 0.00995 => format!("{v:.5}"),
        Some(v) if v.abs() < 99.995 => format!("{v:.2}"),
        Some(v) if v.abs() < 999.95 => format!("{v:.1}"),
        Some(v) => format!("{v:.0}"),
    }
}

/// Digits that numbers are told with where no more are needed, and that tell any.
const FEW: usize = 3;
const ALL: usize = 17;

/// `value` ≥ 0 with its first three digits.
pub fn three_digits(value: f64) -> String {
    first_digits(value, FEW)
}

/// `value` with its sign and its first three digits.
pub fn signed_digits(value: f64) -> String {
    with_digits(value, FEW)
}

/// `value` with its sign and its first `digits` digits.
pub fn with_digits(value: f64, digits: usize) -> String {
    let sign = if value < 0.0 { "-" } else { "" };
    sign.to_owned() + &first_digits(value.abs(), digits)
}

/// `value` rounded up to as few digits as leave it at most `high`, three at least, and how many these are.
///
/// Up to the next of its last digit's places: never below `value`.
pub fn rounded_up(value: f64, high: f64) -> (f64, usize) {
    let up = |digits: usize| {
        let decimals = decimals_for(value.abs(), digits);
        let told = |value: f64| format!("{value:.decimals$}").parse::<f64>().ok();
        let nearest = told(value)?;
        let up = if nearest >= value { nearest } else { told(nearest + libm::pow(10.0, -(decimals as f64)))? };
        (up >= value && up <= high).then_some((up, digits))
    };
    (FEW..ALL).find_map(up).unwrap_or((value, ALL))
}

fn first_digits(value: f64, digits: usize) -> String {
    format!("{value:.decimals$}", decimals = decimals_for(value, digits))
}

/// How many decimals show the first `digits` digits of `value` ≥ 0.
fn decimals_for(value: f64, digits: usize) -> usize {
    let first = if value > 0.0 { libm::log10(value).floor() } else { digits as f64 };
    (digits as f64 - 1.0 - first).clamp(0.0, 9.0 + digits as f64) as usize
}

/// A share from 0 to 1 as `31 %`; below 10 % with one decimal.
pub fn percent(share: Option<f64>) -> String {
    match share {
        None => "–".into(),
        Some(share) if share != 0.0 && share.abs() < 0.0995 => format!("{:.1} %", 100.0 * share),
        Some(share) => format!("{:.0} %", 100.0 * share),
    }
}

/// A share in percent with two digits, but at most one decimal from 1 % on: `5.0`, `0.050`.
pub(super) fn percent_digits(share: f64) -> String {
    let percent = 100.0 * share;
    let (mut decimals, mut shown) = (1, 1.0);
    while decimals < 8 && percent < shown {
        (decimals, shown) = (decimals + 1, 0.1 * shown);
    }
    format!("{percent:.decimals$}")
}

/// `1000000` as `1 000 000`, which can be read.
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_what_a_screen_shows() {
        assert_eq!(number(Some(0.654)), "0.65");
        assert_eq!((number(Some(-0.0)), number(Some(-1e-12))), ("0.00".into(), "0.00".into()));
        assert_eq!(number(Some(-0.004)), "-0.00400");
        assert_eq!(number(Some(123.44)), "123.4");
        assert_eq!(number(Some(1234.4)), "1234");
        assert_eq!(number(None), "–");
        assert_eq!(
            (grouped(4000), grouped(999), grouped(1_000_000)),
            ("4 000".into(), "999".into(), "1 000 000".into())
        );
        assert_eq!(percent(Some(0.31)), "31 %");
        assert_eq!([0.0, 0.012345, 3.3333, -98765.4].map(signed_digits), ["0", "0.0123", "3.33", "-98765"]);
        assert_eq!(with_digits(9.893_779_44, 8), "9.8937794");
        assert_eq!(rounded_up(2.0737, 2.2), (2.08, 3));
        assert_eq!((rounded_up(1.89, 1.96), rounded_up(-2.0737, -1.9)), ((1.89, 3), (-2.07, 3)));
        // Three digits would be beyond the interval.
        assert_eq!(rounded_up(9.893_779_44, 9.893_779_6), (9.893_779_5, 8));
        assert_eq!(rounded_up(2.0737, 2.0739), (2.0737, 5));
        assert_eq!(percent(Some(0.015)), "1.5 %");
    }
}
