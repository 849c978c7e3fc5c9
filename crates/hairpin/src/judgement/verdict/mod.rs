//! The verdict: one sentence with outcome, how obtained, worst, where, share with interval, and evidence; and the
//! exit code that goes with it.
//!
//! Exit codes: 0 within spec, 1 violation, 3 nothing feasible, 4 executor failed, 5 inconclusive or invalid data
//! (2, wrong input, is no verdict). A violation is a fact whatever else went wrong, so it comes first; then a failed
//! executor, because what was not flown was not judged, be it a case or what a search for cases tried; then data or an
//! interval that allow no verdict.
//!
//! One sentence, whatever the robot: outcome, how obtained, worst and where, share of violations (with its interval
//! where cases were drawn at random), evidence. What was not counted is said, what was derived has its word, and an
//! interval that straddles a limit is INCONCLUSIVE, not a pass.

mod judged;
#[cfg(feature = "unit-tests")]
mod tests;

pub use self::judged::{Beside, Claim, Judged, Worst};
use super::chosen::{Against, Count, draws_sentence};
use super::spec::Violation;

/// Whether `c` is no part of a text but commands whoever shows it: control characters, what ends a line, and what turns
/// the direction of writing (Unicode's `Bidi_Control`), by which a name reads as another one, or a sentence as its
/// reverse.
pub fn is_command(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// One sentence and its exit code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// Starts with PASS, FAIL k/n, UNJUDGED n, INCONCLUSIVE, INVALID, NOTHING FEASIBLE or EXECUTOR FAILED.
    pub sentence: String,
    /// 0, 1, 3, 4 or 5.
    pub exit_code: u8,
}

impl Verdict {
    /// A sentence is one line, whatever the names in it are: what would begin another, or command a terminal, is
    /// written out (`\n`, `\u{1b}`).
    pub fn of(sentence: &str, exit_code: u8) -> Self {
        let plain = |c: char| if is_command(c) { c.escape_default().to_string() } else { c.to_string() };
        Self { sentence: sentence.chars().map(plain).collect(), exit_code }
    }
}

/// The verdict on executed cases.
///
/// Cases that the executor failed to fly, whose data are inconclusive or that were left undone for want of time count
/// neither as pass nor as fail: the share is of the others. What was cut short is no PASS. Without a share limit one
/// violating case is a FAIL. With one, of cases that were drawn at random the Clopper-Pearson interval of the share
/// decides: FAIL if it lies above the limit, PASS if below, INCONCLUSIVE if it straddles it; of any others, searched
/// ones above all, the plain count does, for it is of nothing but them. Where nothing was asked for, what is no FAIL is
/// UNJUDGED.
///
/// ```
/// use hairpin::judgement::{Chosen, Judged, verdict};
///
/// let searched = Judged { how: &["simulated"], cases: 200, asked: 200, ..Judged::default() };
/// let at_random = Judged { chosen: Chosen::AtRandom, ..searched };
/// let none = verdict(&at_random);
/// assert_eq!(none.exit_code, 0);
/// assert!(none.sentence.contains("share at most 1.5 % (3/N, 95 %)"));
/// let some = verdict(&Judged { failed: 3, ..searched });
/// assert!(some.exit_code == 1 && some.sentence.starts_with("FAIL 3/200"));
/// assert!(some.sentence.contains("3 of 200 searched violate"));
/// ```
pub fn verdict(judged: &Judged) -> Verdict {
    let counted = judged.cases.saturating_sub(judged.executor_failed + judged.inconclusive + judged.undone);
    let count = Count { chosen: judged.chosen, failed: judged.failed, of: counted, confidence: judged.confidence };
    let limit = judged.share_limit.filter(|limit| *limit > 0.0);
    let against = limit.map(|limit| count.against(limit));
    let fails = against.map_or(judged.failed > 0, |against| against == Against::Above);
    let open = against == Some(Against::Open);
    let (k, n) = (judged.failed, judged.cases);
    let (start, exit_code) = if fails {
        (format!("FAIL {k}/{n} {}", how(judged)), 1)
    } else if judged.executor_failed > 0 || judged.search_failed[0] > 0 {
        let start = executor_failed(judged);
        if counted == 0 {
            return Verdict::of(&start, 4);
        }
        let what = if judged.limited { "judged" } else { "unjudged" };
        (format!("{start}; {counted} {what} {}", how(judged)), 4)
    } else if judged.inconclusive > 0 || judged.cut.is_some() || open || counted == 0 {
        (format!("INCONCLUSIVE {k}/{n} {}", how(judged)), 5)
    } else if !judged.limited {
        (format!("UNJUDGED {n} {}", how(judged)), 0)
    } else {
        (format!("PASS {}/{n} {}", n - k, how(judged)), 0)
    };
    Verdict::of(&format!("{start}: {}", findings(judged, &count, limit).join("; ")), exit_code)
}

/// `EXECUTOR FAILED 4/200 (time-out 60 s, stderr kept): not counted as pass or fail`: of the cases, or of what the
/// search for them executed.
fn executor_failed(judged: &Judged) -> String {
    let (failed, trouble) = match judged.executor_failed {
        0 => (search_failed(judged.search_failed), judged.search_trouble),
        failed => (format!("{failed}/{}", judged.cases), judged.trouble),
    };
    let trouble = if trouble.is_empty() { String::new() } else { format!(" ({trouble})") };
    format!("EXECUTOR FAILED {failed}{trouble}: not counted as pass or fail")
}

/// `31/80 executions of the search`.
fn search_failed([failed, of]: [u64; 2]) -> String {
    format!("{failed}/{of} executions of the search")
}

/// `EXECUTOR FAILED 12/12 executions of the search (why): what`, of one that found nothing; exit 4.
pub fn search_in_vain(failed: [u64; 2], trouble: &str, what: &str) -> Verdict {
    let trouble = if trouble.is_empty() { String::new() } else { format!(" ({trouble})") };
    Verdict::of(&format!("EXECUTOR FAILED {}{trouble}: {what}", search_failed(failed)), 4)
}

/// `NOTHING FEASIBLE (proof, hull): no chain of 10 waypoints from start to end; smallest change: …`; exit 3.
/// `how` says what the answer rests on, such as `["proof", "hull"]` or `["2000 graphs searched", "witness"]`.
pub fn nothing_feasible(how: &[&str], what: &str, smallest_change: Option<&str>) -> Verdict {
    let change = smallest_change.map_or(String::new(), |change| format!("; smallest change: {change}"));
    Verdict::of(&format!("NOTHING FEASIBLE ({}): {what}{change}", how.join(", ")), 3)
}

/// `INVALID 0118 (flown, log_25.ulg): position reset of 1.2 m at t = 8.1 s; …`; exit 5.
pub fn invalid(case: &str, how: &[&str], reason: &str) -> Verdict {
    Verdict::of(&format!("INVALID {case} ({}): {reason}", how.join(", ")), 5)
}

/// `INCONCLUSIVE 0117 (flown, log_24.ulg, EKF2 estimate): 0.65 m > 0.50 m, but …`; exit 5.
pub fn inconclusive(case: &str, how: &[&str], reason: &str) -> Verdict {
    Verdict::of(&format!("INCONCLUSIVE {case} ({}): {reason}", how.join(", ")), 5)
}

/// `PASS 0117 (flown, log_23.ulg, motion capture): 0.41 m ≤ 0.50 m, …`; exit 0.
pub fn within_spec(case: &str, how: &[&str], finding: &str) -> Verdict {
    Verdict::of(&format!("PASS {case} ({}): {finding}", how.join(", ")), 0)
}

/// `FAIL 0117 (flown, log_23.ulg, motion capture): 0.65 m > 0.50 m, …`; exit 1.
pub fn violated(case: &str, how: &[&str], finding: &str) -> Verdict {
    Verdict::of(&format!("FAIL {case} ({}): {finding}", how.join(", ")), 1)
}

/// `UNJUDGED 0117 (flown, log_23.ulg, motion capture): …`; exit 0: nothing was asked for.
pub fn unjudged(case: &str, how: &[&str], finding: &str) -> Verdict {
    Verdict::of(&format!("UNJUDGED {case} ({}): {finding}", how.join(", ")), 0)
}

fn how(judged: &Judged) -> String {
    let runs = if judged.runs == 1 { "1 run each".into() } else { format!("{} runs each", judged.runs) };
    let parts: Vec<&str> = judged.how.iter().copied().chain([runs.as_str()]).collect();
    format!("({})", parts.join(", "))
}

/// Worst and where, share, evidence, and what was not counted.
fn findings(judged: &Judged, count: &Count, limit: Option<f64>) -> Vec<String> {
    let mut parts = Vec::new();
    let of = judged.beside.map_or(String::new(), |beside| format!(", of {}", beside.of));
    parts.extend(judged.worst.as_ref().map(|worst| worst_and_where(worst) + &of));
    parts.extend(judged.beside.map(|beside| beside.by_chance.to_owned()));
    if !judged.limited {
        let nothing =
            if judged.failed > 0 { "nothing else was" } else { "nothing crashed or left the world, no more was" };
        parts.push(format!("{nothing} asked for: spec = \"none\""));
    }
    if judged.limited || judged.failed > 0 {
        parts.extend(count.sentence(limit));
        parts.extend(judged.draws.and_then(|[failed, of]| draws_sentence(failed, of, judged.confidence)));
    }
    parts.extend(judged.reruns.map(str::to_owned));
    if judged.executor_failed > 0 && judged.failed > 0 {
        parts.push(format!("executor failed in {}/{}, not counted", judged.executor_failed, judged.cases));
    }
    if judged.search_failed[0] > 0 && judged.failed + judged.executor_failed > 0 {
        parts.push(format!("executor failed in {}", search_failed(judged.search_failed)));
    }
    // Else the outcome is that they were not.
    let [lost, of] = judged.unflown;
    if lost > 0 && judged.failed > 0 {
        parts.push(format!("{lost} of {of} runs not flown"));
    }
    if judged.inconclusive > 0 {
        let doubt = if judged.doubt.is_empty() { String::new() } else { format!(" ({})", judged.doubt) };
        parts.push(format!("data of {}/{} inconclusive, not counted{doubt}", judged.inconclusive, judged.cases));
    }
    parts.extend(judged.cut.map(str::to_owned));
    if judged.cases < judged.asked {
        parts.push(format!("{} of {} cases asked for were found", judged.cases, judged.asked));
    }
    parts.extend(judged.passed_over.iter().cloned());
    parts.extend(judged.estimated.map(str::to_owned));
    let proof = judged.proof.map_or(String::new(), |proof| format!(", {proof}"));
    match judged.claims {
        [] => {}
        [claim] if claim.count == judged.cases => parts.push(format!("all {} {}{proof}", claim.count, claim.word)),
        claims => {
            let counts: Vec<String> = claims.iter().map(|claim| format!("{} {}", claim.count, claim.word)).collect();
            parts.push(format!("{}{proof}", counts.join(", ")));
        }
    }
    if parts.is_empty() { vec!["nothing to judge".into()] } else { parts }
}

/// What was measured and its limit, as `0.65 m > 0.50 m`, or what happened.
pub fn finding(violation: &Violation) -> String {
    violation.event().unwrap_or_else(|| {
        let (value, limit) = violation.printed();
        let relation = match (violation.is_lower_limit(), violation.value.total_cmp(&violation.limit)) {
            (false, std::cmp::Ordering::Greater) => ">",
            (false, _) => "≤",
            (true, std::cmp::Ordering::Less) => "<",
            (true, _) => "≥",
        };
        let name = match violation.what.as_str() {
            "deviation" => "",
            "tip-over-margin" => "tip-over margin ",
            "edge" => "distance to the world's edge ",
            what => &format!("{what} "),
        };
        format!("{name}{value} {relation} {limit}")
    })
}

fn worst_and_where(worst: &Worst) -> String {
    let violation = worst.value;
    let finding = finding(violation);
    let mut sentence = format!(
        "worst {finding}, case {}, t = {:.2} s, leg {}→{}",
        worst.case,
        violation.at,
        violation.leg,
        violation.leg + 1
    );
    if let Some(saturation) = worst.saturation {
        sentence += &format!(", rotors saturated {:.0} %", 100.0 * saturation);
    }
    sentence
}
