//! What a log came to, as one sentence.

use std::path::{Path, PathBuf};

use hairpin::campaign::missed::Missed;
use hairpin::campaign::scenario::Asked;
use hairpin::campaign::{Doubt, Exceeded, Flown, Setup, Why};
use hairpin::judgement::{
    AccelerationSource, SEEN_WITHIN_S, Verdict, Violation, finding, inconclusive, invalid, told_outward, unjudged,
    violated, within_spec,
};
use hairpin::math::decimals::that_differ;
use hairpin_formats::quote::shortened;

use super::cut::Cut;
use super::found::{Found, JudgedLog, Outcome};
use super::left_out::LeftOut;
use super::remedy::log_at;
use crate::missions::FENCE;
use crate::{Problem, copies};

/// A log that was judged.
pub(super) fn judged((file, name): (&Path, &str), found: Found, setup: &Setup) -> JudgedLog {
    let source = found.source.in_sentence();
    let how = ["flown", name, source.as_str()];
    let (outcome, verdict) = verdict(&found, &how, setup.scenario.asked());
    JudgedLog { file: file.into(), name: name.into(), verdict, outcome, found: Some(found), program: None, sheet: None }
}

/// A log of a folder that cannot be judged.
pub(super) fn unreadable((file, name): (&Path, &str), problem: &Problem) -> JudgedLog {
    let why = problem.to_string();
    let verdict = invalid("log", &["flown", name], &format!("not judged: {}", shortened(&why)));
    let outcome = Outcome::Invalid;
    JudgedLog { file: file.into(), name: name.into(), verdict, outcome, found: None, program: None, sheet: None }
}

/// The line with counts.
pub(super) fn count(folder: &Path, logs: &[JudgedLog], left: &[PathBuf], copies: &[Vec<PathBuf>]) -> Verdict {
    let of = |outcome: Outcome| logs.iter().filter(|log| log.outcome == outcome).count();
    let [pass, fail, open, invalid, unjudged] =
        [Outcome::Pass, Outcome::Fail, Outcome::Inconclusive, Outcome::Invalid, Outcome::Unjudged].map(of);
    let all = logs.len();
    let word = if logs.iter().any(|log| log.program.is_some()) { "hardware" } else { "flown" };
    let how = format!("({word}, {}, {all} logs)", file_name(folder));
    let counts = [(pass, "within spec"), (fail, "in violation"), (open, "inconclusive"), (invalid, "invalid")];
    let mut words: Vec<String> = counts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
    words.extend((unjudged > 0).then(|| format!("{unjudged} unjudged: spec = \"none\"")));
    let again = copies::told(copies, |file| name_in(folder, file));
    let words =
        [Some(words.join(", ")), again, left_out(folder, left)].into_iter().flatten().collect::<Vec<_>>().join("; ");
    let (start, code) = match (fail, open + invalid) {
        (1.., _) => (format!("FAIL {fail}/{all}"), 1),
        (0, 1..) => (format!("INCONCLUSIVE 0/{all}"), 5),
        (0, 0) if unjudged > 0 => (format!("UNJUDGED {all}"), 0),
        (0, 0) => (format!("PASS {pass}/{all}"), 0),
    };
    Verdict::of(&format!("{start} {how}: {words}"), code)
}

/// Names that are told of files that were left out.
const NAMED: usize = 3;

/// `left out, by their names planned: 0000.planned.csv, 0000.ref.tum; left out, folders of campaigns: out`; `None`
/// where nothing was left out of `folder`.
pub(super) fn left_out(folder: &Path, left: &[PathBuf]) -> Option<String> {
    let (campaigns, planned): (Vec<&PathBuf>, Vec<&PathBuf>) = left.iter().partition(|path| path.is_dir());
    let words = |what: &str, all: &[&PathBuf]| {
        let names: Vec<String> = all.iter().take(NAMED).map(|path| name_in(folder, path)).collect();
        let more = all.len() - names.len();
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        (!all.is_empty()).then(|| format!("left out, {what}: {}{more}", names.join(", ")))
    };
    let parts = [words("by their names planned", &planned), words("folders of campaigns", &campaigns)];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| parts.join("; "))
}

fn verdict(found: &Found, how: &[&str], asked: Asked) -> (Outcome, Verdict) {
    let case = &found.case;
    let cuts = Cut::all_in_words(&found.cuts);
    let with = |mut sentence: String, more: &[String]| {
        more.iter().for_each(|part| sentence.push_str(&format!("; {part}")));
        sentence
    };
    if let Some(modes) = &found.never_began {
        let why = format!("the mission never began: modes {modes}; what else was done is not judged");
        return (Outcome::Inconclusive, inconclusive(case, how, &why));
    }
    let Some(flown) = &found.flown else {
        let nothing = "nothing is left to judge".to_owned();
        let why: Vec<String> = cuts.into_iter().chain(found.ended.clone()).collect();
        return (Outcome::Invalid, invalid(case, how, &with(nothing, &why)));
    };
    if let Some(violation) = flown.violations.first() {
        return (Outcome::Fail, violated(case, how, &with(where_and_when(violation), &cuts)));
    }
    if let [first, rest @ ..] = &cuts[..] {
        return (Outcome::Invalid, invalid(case, how, &with(first.clone(), rest)));
    }
    if !found.finished {
        return (Outcome::Inconclusive, inconclusive(case, how, &unfinished(found, flown)));
    }
    if let [first, rest @ ..] = &flown.doubts[..] {
        let rest: Vec<String> = rest.iter().map(|doubt| in_words(doubt, found)).collect();
        return (Outcome::Inconclusive, inconclusive(case, how, &with(in_words(first, found), &rest)));
    }
    if let Some(why) = &found.asked {
        let best = nearest(flown).into_iter().collect::<Vec<_>>();
        return (Outcome::Inconclusive, inconclusive(case, how, &with(why.clone(), &best)));
    }
    if asked != Asked::Limits {
        let m = &flown.measures;
        let worst = format!(
            "deviation {:.2} m at worst, t = {:.2} s, leg {}→{}; nothing was asked for: spec = \"none\"",
            m.max_deviation,
            m.t_worst,
            m.leg_worst,
            m.leg_worst + 1
        );
        return (Outcome::Unjudged, unjudged(case, how, &worst));
    }
    if let Some(again_s) = found.again_s {
        let best = nearest(flown).into_iter().collect::<Vec<_>>();
        return (Outcome::Inconclusive, inconclusive(case, how, &with(again(again_s), &best)));
    }
    if let Some(why) = flown.limits.open(&flown.measures) {
        let why = format!("{why}; --set can ask a log for less (docs/judging-logs.md)");
        let best = nearest(flown).into_iter().collect::<Vec<_>>();
        return (Outcome::Inconclusive, inconclusive(case, how, &with(why, &best)));
    }
    let between = flown
        .limits
        .deviation
        .map(|limit| format!("at most {} m between samples", told_outward(flown.most_between, limit, "m", false)));
    let best = nearest(flown).unwrap_or_else(|| "within all limits".into());
    (Outcome::Pass, within_spec(case, how, &with(best, &between.into_iter().collect::<Vec<_>>())))
}

/// That `count` of `all` samples are none.
pub(super) fn repeated(count: usize, all: usize) -> Option<String> {
    (count > 0).then(|| {
        format!("{count} of {all} samples repeat the place before them while it moves on, and count as none: it is told more rarely")
    })
}

/// That a mission is flown once more.
pub(super) fn again(t_s: f64) -> String {
    format!(
        "the mission is flown again from t = {t_s:.1} s, which is not judged: --from S and --to S choose one flight"
    )
}

/// Why what was flown is not the whole mission: where it begins or ends, or what it left out.
fn unfinished(found: &Found, flown: &Flown) -> String {
    let last = flown.measures.legs.iter().rposition(|leg| leg.time > 0.0).unwrap_or(0);
    let of = flown.measures.legs.len() + 1;
    let why = found.ended.as_deref().unwrap_or("the log ends");
    let missed = found.missed.as_ref().map(Missed::in_words);
    let first = match (&found.missed, &missed) {
        (Some(missed), Some(words)) if missed.waypoint <= last => format!("{words}; what was not flown is not judged"),
        _ => format!("{why}, on leg {last}→{} of {of} waypoints: what was left of the mission is not judged", last + 1),
    };
    let missed = missed.filter(|words| !first.starts_with(words.as_str()));
    let first = Some(first).filter(|_| !found.to_the_end);
    let before = found.left_out.as_ref().map(LeftOut::in_words);
    [before, first, missed, nearest(flown)].into_iter().flatten().collect::<Vec<_>>().join("; ")
}

/// `0.65 m > 0.50 m, t = 12.34 s, leg 4→5`.
pub(super) fn where_and_when(violation: &Violation) -> String {
    format!("{}, t = {:.2} s, leg {}→{}", finding(violation), violation.at, violation.leg, violation.leg + 1)
}

/// The value that is told where none is over its limit: the deviation, else the first that is limited.
fn nearest(flown: &Flown) -> Option<String> {
    let (m, limits) = (&flown.measures, &flown.limits);
    let value = |what: &str, value: f64, limit: f64, unit: &str, at: f64, leg: usize| Violation {
        what: what.into(),
        value,
        limit,
        unit: unit.into(),
        at,
        leg,
    };
    let worst_leg = |of: fn(&hairpin::judgement::LegMeasures) -> f64| {
        let legs = m.legs.iter().enumerate();
        legs.max_by(|a, b| of(a.1).total_cmp(&of(b.1))).map_or(0, |(leg, _)| leg)
    };
    let deviation = m.deviation().zip(limits.deviation);
    let deviation = deviation.map(|(off, limit)| value("deviation", off, limit, "m", m.t_worst, m.leg_worst));
    let clearance = || {
        let leg = worst_leg(|leg| leg.min_clearance.map_or(f64::NEG_INFINITY, |clearance| -clearance));
        Some(value("clearance", m.min_clearance?, limits.clearance?, "m", m.t_clearance, leg))
    };
    let overshoot = || {
        let leg = worst_leg(|leg| leg.overshoot);
        Some(value("overshoot", m.max_overshoot(), limits.overshoot?, "m", m.t_overshoot, leg))
    };
    let acceleration = || {
        let leg = worst_leg(|leg| leg.max_acceleration);
        Some(value("acceleration", m.acceleration()?, limits.acceleration?, "m/s²", m.t_acceleration, leg))
    };
    let last = m.legs.len().saturating_sub(1);
    let time = || Some(value("total-time", m.total_time, limits.total_time?, "s", m.total_time, last));
    let told = deviation.or_else(clearance).or_else(overshoot).or_else(acceleration).or_else(time)?;
    Some(where_and_when(&told))
}

/// Why a limit is open whose `value` may be another, as `why` says, and what `other` decides it; `met` of an obstacle
/// that may have been met, whose clearance nobody limits.
fn inexact(doubt: &Doubt, value: &str, met: bool, [why, other]: [&str; 2]) -> String {
    let Doubt { value: seen, .. } = doubt;
    let is_lower = seen.is_lower_limit();
    let (more, limit) = if is_lower { ("less", "lower") } else { ("more", "raise") };
    let kept = if is_lower { seen.value >= seen.limit } else { seen.value <= seen.limit };
    let may = if kept { format!(", so that it may be {more}") } else { String::new() };
    let own = format!("{value}, but {why}");
    // The world's edge is no limit that could be another.
    match seen.what.as_str() {
        "edge" if kept => format!("{own}, so that it may have left the world; {other}"),
        "edge" => format!("{own}; {other}"),
        FENCE if kept => format!("{own}, so that it may have been beyond one of the mission's; {other}"),
        FENCE => format!("{own}; {other}"),
        _ if met => format!("{own}; {other}"),
        _ => format!("{own}{may}; {other} or {limit} the limit"),
    }
}

/// Why a limit is open, and what would decide it.
fn in_words(doubt: &Doubt, found: &Found) -> String {
    let value = finding(&doubt.value);
    // A clearance that nobody limits is that of what may have been met.
    let met = found.flown.as_ref().is_some_and(|flown| flown.limits.clearance.is_none());
    let met = met && doubt.value.what == "clearance";
    let value = if met { format!("it may have met an obstacle: {value}") } else { value };
    match doubt.why {
        Why::Accuracy { which, sigma } => {
            let other =
                if found.source.others.is_empty() { "judge motion capture" } else { "judge motion capture (--source)" };
            inexact(doubt, &value, met, [&format!("the log's own {which} is {} m", digits(sigma)), other])
        }
        Why::Digits(moved) => {
            let why = format!("its positions are told in steps that move them by up to {} m", digits(moved));
            inexact(doubt, &value, met, [&why, "log more digits"])
        }
        Why::Impossible(found) => found.in_words(),
        Why::Overturned(found) => found.in_words(),
        Why::Resolution(unresolved, source) => {
            format!("{value}, but its {}; log more digits, or velocities", unresolved.in_words(source))
        }
        Why::Mean(span) => {
            let rate = found.source.rate_hz;
            format!(
                "{value} in samples at {}, but as a mean over as much as {span:.2} s, and what is shorter was \
                 not seen; log at {:.0} Hz or faster, without pauses",
                hertz(rate),
                (2.0 / SEEN_WITHIN_S).ceil()
            )
        }
        Why::Between { most, rate_hz } if most.is_finite() => {
            let bounds = found.flown.as_ref().map_or(String::new(), bounds);
            let most = told_outward(most, doubt.value.limit, "m", doubt.value.is_lower_limit());
            format!(
                "{value} in samples at {}, but {most} m may hide between two of them{bounds}; {}",
                hertz(found.source.rate_hz),
                log_at(rate_hz, found.source.format)
            )
        }
        Why::Between { .. } => {
            let why = found.flown.as_ref().and_then(|flown| flown.exceeded).map_or_else(
                || ": of what is on wheels its file does with `limits.speed_m_s`, of a boat nothing does".to_owned(),
                |exceeded| format!(": {}", in_numbers(&exceeded)),
            );
            let rate = found.source.rate_hz;
            let nothing = "nothing bounds how fast the robot moves between two of them";
            format!("{value} in samples at {}, but {nothing}{why}", hertz(rate))
        }
        Why::Begin { before } => {
            let why = match before {
                Some(s) => format!("--from leaves out {s:.1} s before it"),
                None => "the log begins amid the motion away from waypoint 0".into(),
            };
            format!("{value} in what was judged, but when the mission began is not seen: {why}")
        }
        Why::End(after) => {
            format!(
                "{value} in what was judged, but when the mission ended is not seen: --to leaves out {after:.1} s after it"
            )
        }
    }
}

/// `10 Hz`, `0.02 Hz`.
fn hertz(rate: f64) -> String {
    let has_digit = |d: &usize| format!("{rate:.d$}", d = *d).contains(|c: char| ('1'..='9').contains(&c));
    let decimals = if rate >= 1.0 { 0 } else { (1..6).find(has_digit).unwrap_or(6) };
    format!("{rate:.decimals$} Hz")
}

/// `the log's own speed of 40.0 m/s is beyond the robot's 18.0 m/s`.
fn in_numbers(exceeded: &Exceeded) -> String {
    let Exceeded { what, seen, bound, unit } = *exceeded;
    let decimals = that_differ(seen, bound, 1..=6);
    format!("the log's own {what} of {seen:.decimals$} {unit} is beyond the robot's {bound:.decimals$} {unit}")
}

fn bounds(flown: &Flown) -> String {
    let speed = flown.swiftness.speed.map(|v| format!("speed ≤ {v:.1} m/s"));
    let acceleration = flown.swiftness.acceleration.map(|a| format!("acceleration ≤ {a:.1} m/s²"));
    let exceeded = flown.exceeded.as_ref().map(in_numbers);
    let parts: Vec<String> = speed.into_iter().chain(acceleration).chain(exceeded).collect();
    if parts.is_empty() { String::new() } else { format!(" ({})", parts.join(", ")) }
}

fn digits(sigma: f64) -> String {
    if sigma >= 0.095 { format!("{sigma:.1}") } else { format!("{sigma:.3}") }
}

/// What the log in `file` is called where `asked`, a log or a folder of them, is judged: by its path within the folder.
pub(super) fn name_in(asked: &Path, file: &Path) -> String {
    let within = file.strip_prefix(asked).ok().filter(|path| path.file_name().is_some());
    let parts = within.map(|path| path.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/"));
    parts.unwrap_or_else(|| file_name(file))
}

pub(super) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

impl Found {
    /// What is told before the sentence, label and value.
    pub fn lines(&self) -> Vec<[String; 2]> {
        let mut lines = Vec::new();
        let mut line = |label: &str, value: String| lines.push([label.to_owned(), value]);
        let source = &self.source;
        let others =
            if source.others.is_empty() { String::new() } else { format!("; not used: {}", source.others.join(", ")) };
        line(
            "poses",
            format!(
                "{}, {} ({}), {} samples at {:.4} Hz, stamps {}{others}",
                source.format,
                source.topic,
                source.in_sentence(),
                source.samples,
                (1e3 * source.rate_hz).round() / 1e3,
                source.clock
            ),
        );
        let frame = &self.frame;
        let more = [frame.altitude(), frame.named()].into_iter().flatten();
        let frame: Vec<String> = [format!("{}, {}", frame.log, frame.how)].into_iter().chain(more).collect();
        line("frame", format!("{}; not aligned, in space or in time", frame.join("; ")));
        line(
            "case",
            match &self.matched {
                Some(matched) => format!("matched to case {} ({})", self.case, matched.words()),
                None => self.case.clone(),
            },
        );
        let span = self.span_s.map_or("nothing".into(), |[from, to]| format!("t = {from:.1} … {to:.1} s"));
        let ended = self.ended.as_ref().map_or(String::new(), |ended| format!("; ended by {ended}"));
        line("judged", format!("{span}{ended}; legs by {}", self.legs_by.words()));
        Cut::all_in_words(&self.cuts).into_iter().for_each(|cut| line("cut out", cut));
        if let Some(flown) = &self.flown {
            if let Some(s) = flown.statistics {
                line(
                    "deviation",
                    format!(
                        "max {:.3} m, mean {:.3} m, median {:.3} m, min {:.3} m, rmse {:.3} m, sse {:.3} m², std {:.3} m",
                        s.max, s.mean, s.median, s.min, s.rmse, s.sse, s.std
                    ),
                );
            }
            if let Some(simulated) = self.simulated_m {
                let flown = flown.measures.max_deviation;
                line(
                    "gap",
                    format!(
                        "flown {flown:.2} m, simulated {simulated:.2} m at worst: {:+.2} m",
                        hundredths(flown - simulated)
                    ),
                );
            }
            if flown.measures.acceleration_source == AccelerationSource::Position && flown.limits.acceleration.is_some()
            {
                line("note", "accelerations are second differences of positions".into());
            }
        }
        self.notes.iter().for_each(|note| line("note", note.clone()));
        lines
    }
}

/// What is said of a limit that the case keeps in simulation by legs that are assigned, and not by those that it was
/// told to fly: with the least distance in view, assigned ones are the kinder.
pub(super) fn told_otherwise([assigned, told]: [Option<f64>; 2], limit: Option<f64>) -> Option<String> {
    let (assigned, told, limit) = (assigned?, told?, limit?);
    (assigned <= limit && limit < told).then(|| {
        format!(
            "the log tells no legs: by assigned ones the case in simulation is {assigned:.2} m off, by those that its executor told {told:.2} m, \
             and the limit of {limit:.2} m lies between"
        )
    })
}

/// `value` to its second decimal, nothing without a sign of less.
pub(super) fn hundredths(value: f64) -> f64 {
    (100.0 * value).round() / 100.0 + 0.0
}
