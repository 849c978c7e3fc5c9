//! A case's deviation in two lines: evo's statistics, and its course as a row of bars.

use hairpin::campaign::digits::number;
use hairpin::campaign::report::{Length, Shown};

/// From nothing to the largest.
const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
/// Bars of a row.
const WIDTH: usize = 48;

/// `case 0117, run 3: max 0.65 m, mean …` in evo's names and order, and the course of the deviation up to its limit, in
/// the unit and with the digits that the verdict has.
pub(super) fn course(shown: &Shown, length: &Length) -> Vec<String> {
    let mut lines = Vec::new();
    let Length { unit, in_metre, .. } = *length;
    let result = &shown.result;
    if let Some(told) = &shown.statistics {
        let value = |name: &str, value: f64| format!("{name} {}", length.told(value));
        let values = [
            value("max", told.max),
            value("mean", told.mean),
            value("median", told.median),
            value("min", told.min),
            value("rmse", told.rmse),
            format!("sse {} {unit}²", number(Some(in_metre * in_metre * told.sse))),
            value("std", told.std),
        ];
        lines.push(format!("case {}, run {}: {} (deviation, not aligned)", result.case, result.run, values.join(", ")));
    }
    let times = shown.flown.as_ref().map_or(&[][..], |track| track.times());
    if let (Some(row), [first, .., last]) = (bars(times, &shown.distances), times) {
        let span = format!("{} … {} s", number(Some(*first)), number(Some(*last)));
        let most = shown.distances.iter().copied().fold(0.0, f64::max);
        let limit = length.limit_beside(most).map_or(String::new(), |limit| format!(", limit {limit}"));
        lines.push(format!("{row}  {span}, at most {}{limit}", length.told(most)));
    }
    lines
}

/// The largest of `values` in each of equal stretches of time, against the largest of all.
fn bars(times: &[f64], values: &[f64]) -> Option<String> {
    let (first, last) = (times.first()?, times.last()?);
    let most = values.iter().copied().fold(0.0, f64::max);
    if most <= 0.0 || last <= first {
        return None;
    }
    // Motions keep the rows where they bend: a stretch may have none, and goes evenly from the one before to the next.
    let between = |t: f64| {
        let after = times.partition_point(|time| *time < t).clamp(1, times.len() - 1);
        let share = (t - times[after - 1]) / (times[after] - times[after - 1]);
        values[after - 1] + share.clamp(0.0, 1.0) * (values[after] - values[after - 1])
    };
    let middle = |stretch: usize| first + (last - first) * (stretch as f64 + 0.5) / WIDTH as f64;
    let mut stretches: Vec<f64> = (0..WIDTH).map(|stretch| between(middle(stretch))).collect();
    for (t, value) in times.iter().zip(values) {
        let at = ((t - first) / (last - first) * WIDTH as f64) as usize;
        let stretch = &mut stretches[at.min(WIDTH - 1)];
        *stretch = stretch.max(*value);
    }
    let bar = |value: &f64| BARS[((value / most * BARS.len() as f64) as usize).min(BARS.len() - 1)];
    Some(stretches.iter().map(bar).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_rise_with_what_they_show() {
        let times: Vec<f64> = (0..=480).map(|i| f64::from(i) / 10.0).collect();
        let row: Vec<char> = bars(&times, &times).unwrap().chars().collect();
        assert_eq!((row.len(), row[0], row[WIDTH - 1]), (WIDTH, '▁', '█'));
        assert!(row.is_sorted(), "{row:?}");
        // A peak is seen however short it is, and where no row was kept it goes evenly.
        let peak: Vec<char> = bars(&[0.0, 23.9, 24.0, 48.0], &[0.0, 0.0, 2.0, 0.0]).unwrap().chars().collect();
        assert_eq!((peak[10], peak[24], peak[36], peak[47]), ('▁', '█', '▄', '▁'));
        assert_eq!(bars(&times, &vec![0.0; times.len()]), None);
        assert_eq!(bars(&[], &[]), None);
    }
}
