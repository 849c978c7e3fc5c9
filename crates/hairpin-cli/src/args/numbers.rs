//! Numbers as they are typed, each refused with what it must be.

use hairpin_jobs::bounds::LONGEST;

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds.is_finite() && seconds >= 0.0 => Ok(seconds),
        _ => Err("must be a number of seconds ≥ 0".into()),
    }
}

/// A time with its unit, s.
pub(super) fn duration(text: &str) -> Result<f64, String> {
    let unit = |ending: char| match ending {
        's' => Some(1.0),
        'm' => Some(60.0),
        'h' => Some(3600.0),
        _ => None,
    };
    let parsed = text.chars().last().and_then(|ending| {
        let number = text[..text.len() - ending.len_utf8()].parse::<f64>().ok()?;
        Some(number * unit(ending)?)
    });
    parsed
        .filter(|seconds| *seconds > 0.0 && *seconds <= LONGEST)
        .ok_or_else(|| "must be a time > 0 with its unit, s, m or h, such as 90s, 5m or 1h".into())
}

pub(super) fn milliseconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(ms) if (0.0..=LONGEST).contains(&ms) => Ok(ms),
        _ => Err("must be a number of milliseconds, 0 … 1e9".into()),
    }
}

pub(super) fn finite(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|number| number.is_finite()).ok_or_else(|| "must be a finite number".into())
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|number| *number > 0.0).ok_or_else(|| "must be a finite number > 0".into())
}

/// Two finite numbers with a comma between them.
pub(super) fn pair(text: &str) -> Result<[f64; 2], String> {
    let refuse = || "must be two finite numbers, such as -1.5,2".to_owned();
    let (first, second) = text.split_once(',').ok_or_else(refuse)?;
    Ok([finite(first.trim()).map_err(|_| refuse())?, finite(second.trim()).map_err(|_| refuse())?])
}

/// Three finite numbers.
pub(super) fn vector(text: &str) -> Result<[f64; 3], String> {
    match list(text)[..] {
        [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
        _ => Err("must be three finite numbers, such as -1.5,2,0.4".into()),
    }
}

/// Three finite numbers, the last more than 0.
pub(super) fn triple(text: &str) -> Result<[f64; 3], String> {
    match list(text)[..] {
        [Some(x), Some(y), Some(radius)] if radius > 0.0 => Ok([x, y, radius]),
        _ => Err("must be three finite numbers, the last more than 0, such as -1.5,2,0.4".into()),
    }
}

/// Three pairs of finite numbers or more.
pub(super) fn corners(text: &str) -> Result<Vec<[f64; 2]>, String> {
    let numbers: Option<Vec<f64>> = list(text).into_iter().collect();
    match numbers {
        Some(numbers) if numbers.len() >= 6 && numbers.len().is_multiple_of(2) => {
            Ok(numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
        }
        _ => Err("must be three pairs of finite numbers or more, such as 0,0,2,0,2,1.5".into()),
    }
}

fn list(text: &str) -> Vec<Option<f64>> {
    text.split(',').map(|part| finite(part.trim()).ok()).collect()
}

/// Steps of a search.
pub(super) fn count(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|count| *count <= 100_000).ok_or_else(|| "must be a number from 0 to 100000".into())
}

/// Share of a step.
pub(super) fn share(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|share| (0.01..=1.0).contains(share)).ok_or_else(|| "must be from 0.01 to 1".into())
}

/// Share of cases.
pub(super) fn small_share(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|share| (0.001..=0.5).contains(share)).ok_or_else(|| "must be from 0.001 to 0.5".into())
}

pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|number| *number >= 0.0).ok_or_else(|| "must be a finite number >= 0".into())
}

/// Steps of a simulation: few enough to be held in memory.
pub(super) fn steps(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|steps| (16..=10_000_000).contains(steps))
        .ok_or_else(|| "must be a number from 16 to 1e7".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_units() {
        assert_eq!(["90s", "5m", "1h", "0.5m"].map(duration), [90.0, 300.0, 3600.0, 30.0].map(Ok));
        for wrong in ["", "5", "m", "0s", "-1m", "5min", "nans", "infh", "5µ"] {
            assert!(duration(wrong).is_err(), "{wrong}");
        }
    }
}
