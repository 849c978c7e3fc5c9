//! What of a log is no motion, or was not recorded: jumps of the estimate, gaps, spans without a valid pose. It is cut
//! out and told.

use hairpin::judgement::Swiftness;
use hairpin_formats::logs::{Reset, Sample, Span};

/// Room for noise in what is taken for a jump, m.
const ROOM_M: f64 = 0.1;
/// Announced jumps below this are none, m.
const LEAST_RESET_M: f64 = 1e-3;
/// An interval so many times longer than the middle one is a gap …
const GAP: f64 = 5.0;
/// … and where the logger says that it lost something, so many times.
const GAP_OF_DROPOUT: f64 = 1.5;

/// A topic's first message may be told with a stamp of before the log began, which others are not, s.
pub(super) const STALE_S: f64 = 1.0;

/// So many cuts are told one by one, at most.
const TOLD_EACH: usize = 5;
/// What is shorter is told in ms, s.
const SHORT_S: f64 = 0.05;

/// What was cut out of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// When, s of the log.
    pub t_s: f64,
    /// What was found: `position reset of 1.2 m`.
    pub words: String,
    /// How much is not judged for it, s.
    pub lost_s: f64,
    /// Whether nothing after it is judged.
    pub to_the_end: bool,
}

impl Cut {
    /// As it stands in the sentence.
    pub fn in_words(&self) -> String {
        let (t, lost) = (self.t_s, self.lost_s);
        match self.to_the_end {
            true => format!("{} at t = {t:.1} s; {lost:.1} s after it not judged", self.words),
            false if lost < SHORT_S => format!("{} at t = {t:.3} s not judged", self.words),
            false => format!("{} at t = {t:.1} s not judged", self.words),
        }
    }

    /// All of `cuts` as they stand in the sentence: where they are many, how many, the longest, and what ends it.
    pub fn all_in_words(cuts: &[Self]) -> Vec<String> {
        let (ends, parts): (Vec<&Self>, Vec<&Self>) = cuts.iter().partition(|cut| cut.to_the_end);
        let longest = parts.iter().max_by(|a, b| a.lost_s.total_cmp(&b.lost_s));
        match longest {
            Some(longest) if parts.len() > TOLD_EACH => {
                let lost_s = parts.iter().map(|cut| cut.lost_s).sum();
                let (count, lost) = (parts.len(), seconds(lost_s));
                let told = format!("{count} parts of {lost} in all not judged, the longest: {}", longest.in_words());
                [told].into_iter().chain(ends.iter().map(|cut| cut.in_words())).collect()
            }
            _ => cuts.iter().map(Self::in_words).collect(),
        }
    }
}

/// What is left of a log.
pub(crate) struct Left {
    pub(crate) samples: Vec<Sample>,
    /// Samples before which something was cut out.
    pub(crate) breaks: Vec<usize>,
    pub(crate) cuts: Vec<Cut>,
}

/// What a log says itself is no motion, or was not recorded.
#[derive(Clone, Copy)]
pub(crate) struct Unsound<'a> {
    /// Jumps of the estimate.
    pub(crate) resets: &'a [Reset],
    /// Spans without a valid pose.
    pub(crate) invalid: &'a [Span],
    /// Spans in which the logger lost something.
    pub(crate) dropouts: &'a [Span],
}

/// Cuts `samples`, a part of a motion in the world's frame that rises in time and is `due` from when to when.
pub(crate) fn cut(
    samples: &[Sample],
    Unsound { resets, invalid, dropouts }: Unsound,
    due: Span,
    swiftness: &Swiftness,
) -> Left {
    let mut cuts = Vec::new();
    let (start, end) = match (samples.first(), samples.last()) {
        (Some(first), Some(last)) => (first.t_s, last.t_s),
        _ => return Left { samples: Vec::new(), breaks: Vec::new(), cuts },
    };
    let announced = resets.iter().filter(|reset| reset.t_s > start && reset.t_s <= end);
    let announced = announced.filter_map(|reset| match reset.by_m.map(|by| by.norm()) {
        Some(by) if by < LEAST_RESET_M => None,
        Some(by) => Some((reset.t_s, format!("position reset of {}", length(by)))),
        None => Some((reset.t_s, "position reset of unknown size".to_owned())),
    });
    let jump = jumps(samples, swiftness).map(|(t, by)| (t, format!("position jump of {}", length(by))));
    let first = announced.chain(jump).min_by(|a, b| a.0.total_cmp(&b.0));
    let until = first.as_ref().map_or(f64::INFINITY, |(t, _)| *t);
    let is_invalid = |t: f64| invalid.iter().any(|span| (span.from_s..=span.to_s).contains(&t));
    let middle = middle_interval(samples);
    let mut left = Left { samples: Vec::new(), breaks: Vec::new(), cuts: Vec::new() };
    let gap = |from: f64, to: f64, which: &str| {
        let lost_s = to - from;
        Cut { t_s: from, words: format!("gap ({which}) of {}", seconds(lost_s)), lost_s, to_the_end: false }
    };
    if due.from_s.is_finite() && start - due.from_s > (GAP * middle).max(STALE_S) {
        cuts.push(gap(due.from_s, start, "the mission begins before the positions do"));
    }
    let mut broken: Option<(f64, &str)> = None;
    for sample in samples.iter().filter(|sample| sample.t_s < until) {
        if is_invalid(sample.t_s) {
            broken
                .get_or_insert((left.samples.last().map_or(start, |before: &Sample| before.t_s), "no valid position"));
            continue;
        }
        let span = left.samples.last().map(|before| (before.t_s, sample.t_s - before.t_s));
        let lost = |from: f64| dropouts.iter().any(|gap| gap.from_s < sample.t_s && gap.to_s > from);
        let gap = span.and_then(|(from, span)| match span / middle {
            times if times > GAP_OF_DROPOUT && lost(from) => Some((from, "gap (the logger dropped messages)")),
            times if times > GAP => Some((from, "gap")),
            _ => None,
        });
        if let Some((from, words)) = broken.take().or(gap) {
            let lost_s = sample.t_s - from;
            cuts.push(Cut { t_s: from, words: format!("{words} of {}", seconds(lost_s)), lost_s, to_the_end: false });
            if !left.samples.is_empty() {
                left.breaks.push(left.samples.len());
            }
        }
        left.samples.push(*sample);
    }
    if let Some((from, words)) = broken {
        let lost_s = end.min(until) - from;
        cuts.push(Cut { t_s: from, words: format!("{words} of {}", seconds(lost_s)), lost_s, to_the_end: false });
    }
    if first.is_none() && due.to_s.is_finite() && due.to_s - end > GAP * middle {
        cuts.push(gap(end, due.to_s, "the positions end before the mission does"));
    }
    if let Some((t_s, words)) = first {
        cuts.push(Cut { t_s, words, lost_s: end - t_s, to_the_end: true });
    }
    Left { cuts, ..left }
}

/// The first step that no limit of the robot explains, and its length, m.
///
/// A step of c m within h s is a jump where c > v̂ h + 0.1 m. With velocities logged v̂ = ½ (‖v₀‖ + ‖v₁‖) + ¼ a h,
/// which no motion exceeds in the mean; else the top speed. Without either, where the mean velocities of two intervals
/// differ by more than ½ a (h₀ + h₁) and 0.1 m of way.
fn jumps(samples: &[Sample], swiftness: &Swiftness) -> Option<(f64, f64)> {
    let speeds = |i: usize| Some(0.5 * (samples[i].v_m_s?.norm() + samples[i - 1].v_m_s?.norm()));
    for i in 1..samples.len() {
        let (span, way) = (samples[i].t_s - samples[i - 1].t_s, samples[i].p_m - samples[i - 1].p_m);
        let by_velocity = speeds(i).zip(swiftness.acceleration).map(|(mean, a)| mean + 0.25 * a * span);
        let fastest = match (by_velocity, swiftness.speed) {
            (Some(a), Some(b)) if samples[i].v_m_s.is_some_and(|v| v.norm() <= b) => Some(a.min(b)),
            (Some(a), _) => Some(a),
            (None, speed) => speed,
        };
        let explained = match fastest {
            Some(fastest) => way.norm() <= fastest * span + ROOM_M,
            None => match (swiftness.acceleration, i > 1) {
                (Some(most), true) => {
                    let before = samples[i - 1].t_s - samples[i - 2].t_s;
                    let expected = (samples[i - 1].p_m - samples[i - 2].p_m) * (span / before);
                    (way - expected).norm() <= 0.5 * most * (span + before) * span + ROOM_M
                }
                _ => true,
            },
        };
        if !explained {
            return Some((samples[i].t_s, way.norm()));
        }
    }
    None
}

fn middle_interval(samples: &[Sample]) -> f64 {
    let mut spans: Vec<f64> = samples.windows(2).map(|pair| pair[1].t_s - pair[0].t_s).collect();
    spans.sort_unstable_by(f64::total_cmp);
    spans.get(spans.len() / 2).copied().unwrap_or(f64::INFINITY)
}

/// `0.7 s`, `12 ms`.
fn seconds(s: f64) -> String {
    let decimals = usize::from(s < 0.01);
    if s < SHORT_S { format!("{:.decimals$} ms", 1e3 * s) } else { format!("{s:.1} s") }
}

fn length(metres: f64) -> String {
    if metres < 0.1 { format!("{metres:.3} m") } else { format!("{metres:.1} m") }
}
