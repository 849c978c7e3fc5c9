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

use super::chosen::{Against, Chosen, Count, draws_sentence};
use super::spec::Violation;

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
        let plain = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
        Self { sentence: sentence.chars().map(plain).collect(), exit_code }
    }
}

/// How many cases stand on which evidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Claim<'a> {
    /// The evidence word: `witnessed`, `hull-feasible`, `unchecked`.
    pub word: &'a str,
    /// Cases.
    pub count: usize,
}

/// The worst of all runs: of the violations if there is one, else the value that came nearest to its limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst<'a> {
    /// The case's name, such as `0117`.
    pub case: &'a str,
    /// What was measured, where, and its limit (which need not be exceeded).
    pub value: &'a Violation,
    /// Share of rotor-time at a limit, 0 … 1, on that leg or run.
    pub saturation: Option<f64>,
}

/// Cases that nobody chose, for the worst to stand beside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Beside<'a> {
    /// What the worst is the worst of: `4 000 flown`.
    pub of: &'a str,
    /// What the others came to: `random feasible ones 1.22 m in the mean (1.05 to 1.40), 1.90 m at worst of 20`.
    pub by_chance: &'a str,
}

/// What a campaign came to.
///
/// Counts, not cases: what they rest on stays with the campaign.
#[derive(Debug, Clone, Copy)]
pub struct Judged<'a> {
    /// How obtained, in order: `["simulated", "anafi stand-in", "minimum-snap"]`.
    pub how: &'a [&'a str],
    /// Runs per case.
    pub runs: usize,
    /// Runs that came to no flight, of how many.
    pub unflown: [usize; 2],
    /// Cases in all.
    pub cases: usize,
    /// Whether runs were held against anything; where they were not, crashes and leaving the world alone are counted.
    pub limited: bool,
    /// Cases asked for, where fewer were found; told, not counted.
    pub asked: usize,
    /// Cases with a violation.
    pub failed: usize,
    /// Cases that the executor failed to fly.
    pub executor_failed: usize,
    /// Cases whose data allow no verdict.
    pub inconclusive: usize,
    /// Cases that were not executed or not judged for want of time.
    pub undone: usize,
    /// What was left undone of the campaign for want of time, in a sentence's part: it is no pass then.
    pub cut: Option<&'a str>,
    /// Executions of the search that failed, of how many: what it kept says nothing of the trajectories of these, so
    /// that it is no pass then.
    pub search_failed: [u64; 2],
    /// Why one of these did.
    pub search_trouble: &'a str,
    /// What the executor's failures were: `time-out 60 s, stderr kept`.
    pub trouble: &'a str,
    /// Why the data of the first case that allows no verdict allow none.
    pub doubt: &'a str,
    /// The worst of all runs; `None` where nothing is limited.
    pub worst: Option<Worst<'a>>,
    /// What the worst stands beside, where that is known.
    pub beside: Option<Beside<'a>>,
    /// Share of cases that may violate; `None` or 0: not one.
    pub share_limit: Option<f64>,
    /// Confidence of the share's interval.
    pub confidence: f64,
    /// How the cases were come by, which says whether their share has an interval.
    pub chosen: Chosen,
    /// Of the runs of an only case whose values were drawn: how many violate, of how many that were judged.
    pub draws: Option<[usize; 2]>,
    /// Evidence of the cases, those of count 0 left out.
    pub claims: &'a [Claim<'a>],
    /// How often violations come again, where they were run again.
    pub reruns: Option<&'a str>,
    /// What of the runs a limit was not held against: `2 of 20 legs within corner_m of their waypoints`.
    pub passed_over: &'a [String],
    /// What the claims rest on that is not known, or leave out: `link shapes estimated`.
    pub estimated: Option<&'a str>,
    /// How far from the best the cases' scores can be, where every case has a proof: `optimal`, `gap at most 3.1 %`.
    pub proof: Option<&'a str>,
}

impl Default for Judged<'_> {
    fn default() -> Self {
        Self {
            how: &[],
            runs: 1,
            unflown: [0, 0],
            cases: 0,
            limited: true,
            asked: 0,
            failed: 0,
            executor_failed: 0,
            inconclusive: 0,
            undone: 0,
            cut: None,
            search_failed: [0, 0],
            search_trouble: "",
            trouble: "",
            doubt: "",
            worst: None,
            beside: None,
            share_limit: None,
            confidence: 0.95,
            chosen: Chosen::default(),
            draws: None,
            claims: &[],
            reruns: None,
            passed_over: &[],
            estimated: None,
            proof: None,
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn violation(what: &str, value: f64, limit: f64) -> Violation {
        Violation { what: what.into(), value, limit, unit: "m".into(), at: 12.34, leg: 4 }
    }

    const HOW: &[&str] = &["simulated", "anafi stand-in", "minimum-snap"];
    const WITNESSED: &[Claim] = &[Claim { word: "witnessed", count: 200 }];

    fn with<'a>(failed: usize, value: &'a Violation) -> Judged<'a> {
        let worst = Some(Worst { case: "0117", value, saturation: Some(0.31) });
        let chosen = Chosen::AtRandom;
        Judged { how: HOW, runs: 5, cases: 200, failed, worst, chosen, claims: WITNESSED, ..Judged::default() }
    }

    /// A violation is one whatever was not flown, and what was not is told.
    #[test]
    fn runs_that_were_not_flown_are_told_beside_a_violation() {
        let far = violation("deviation", 0.65, 0.5);
        let told = |failed| verdict(&Judged { unflown: [3, 1000], ..with(failed, &far) }).sentence;
        assert!(told(3).contains("; 3 of 1000 runs not flown; all 200 witnessed"), "{}", told(3));
        assert!(!told(0).contains("not flown"), "{}", told(0));
        assert!(!verdict(&with(3, &far)).sentence.contains("not flown"));
    }

    #[test]
    fn a_search_whose_executions_failed_is_no_pass() {
        let value = violation("deviation", 0.3, 0.5);
        let searched = Judged { search_failed: [31, 80], search_trouble: "boom", ..with(0, &value) };
        let told = verdict(&searched);
        let words = "EXECUTOR FAILED 31/80 executions of the search (boom): not counted as pass or fail; 200 judged (";
        assert!(told.exit_code == 4 && told.sentence.starts_with(words), "{told:?}");
        // Cases come before what was tried for them, and violations before both; what is left is told beside them.
        let cases = verdict(&Judged { executor_failed: 4, ..searched });
        assert!(cases.exit_code == 4 && cases.sentence.starts_with("EXECUTOR FAILED 4/200: "), "{cases:?}");
        let fails = verdict(&Judged { failed: 3, ..searched });
        assert!(fails.exit_code == 1 && fails.sentence.starts_with("FAIL 3/200 "), "{fails:?}");
        for told in [cases, fails] {
            assert!(told.sentence.contains("; executor failed in 31/80 executions of the search"), "{told:?}");
        }
    }

    #[test]
    fn what_was_cut_short_fails_or_decides_nothing() {
        let near = violation("deviation", 0.41, 0.5);
        let cut = Judged { undone: 12, cut: Some("cut short: 12 of 200 cases not executed"), ..with(0, &near) };
        let open = verdict(&cut);
        assert_eq!(open.exit_code, 5);
        assert!(open.sentence.starts_with("INCONCLUSIVE 0/200 "), "{open:?}");
        assert!(open.sentence.contains("no violation in 188 cases"), "{open:?}");
        assert!(open.sentence.contains("; cut short: 12 of 200 cases not executed; "), "{open:?}");
        let far = violation("deviation", 0.65, 0.5);
        let failed = verdict(&Judged { failed: 1, worst: with(1, &far).worst, ..cut });
        assert!(failed.exit_code == 1 && failed.sentence.starts_with("FAIL 1/200 "), "{failed:?}");
        assert!(failed.sentence.contains("12 of 200 cases not executed"), "{failed:?}");
        // Nobody asked for anything, and not all of it was done.
        assert_eq!(verdict(&Judged { limited: false, ..cut }).exit_code, 5);
    }

    #[test]
    fn fail_reads_as_designed() {
        let verdict = verdict(&with(3, &violation("deviation", 0.65, 0.5)));
        assert_eq!(
            verdict.sentence,
            "FAIL 3/200 (simulated, anafi stand-in, minimum-snap, 5 runs each): worst 0.65 m > 0.50 m, case 0117, \
             t = 12.34 s, leg 4→5, rotors saturated 31 %; share 1.5 % [0.3, 4.3]; all 200 witnessed"
        );
        assert_eq!(verdict.exit_code, 1);
    }

    #[test]
    fn pass_states_the_upper_bound() {
        let verdict = verdict(&with(0, &violation("deviation", 0.4999, 0.5)));
        assert_eq!(
            verdict.sentence,
            "PASS 200/200 (simulated, anafi stand-in, minimum-snap, 5 runs each): worst 0.4999 m ≤ 0.5000 m, \
             case 0117, t = 12.34 s, leg 4→5, rotors saturated 31 %; no violation in 200 cases: share at most 1.5 % \
             (3/N, 95 %); all 200 witnessed"
        );
        assert_eq!(verdict.exit_code, 0);
    }

    #[test]
    fn drives_read_as_well() {
        let how: &[&str] = &["simulated", "rocky8 stand-in", "predictive"];
        let of = |value: &Violation| {
            let worst = Some(Worst { case: "0003", value, saturation: None });
            let verdict = verdict(&Judged { how, cases: 20, failed: 1, worst, ..Judged::default() });
            verdict.sentence.split("each): ").nth(1).unwrap().split("; 1 of 20").next().unwrap().to_owned()
        };
        let at = |what: &str, value, limit, unit: &str| Violation {
            what: what.into(),
            value,
            limit,
            unit: unit.into(),
            at: 41.2,
            leg: 2,
        };
        let place = "case 0003, t = 41.20 s, leg 2→3";
        for (value, words) in [
            (at("deviation", 0.31, 0.25, "m"), "worst 0.31 m > 0.25 m"),
            (at("tip-over-margin", 7.2, 10.0, "°"), "worst tip-over margin 7.2° < 10.0°"),
            (at("tip-over-margin", 9.996, 10.0, "°"), "worst tip-over margin 9.996° < 10.000°"),
            (at("tip-over", 41.2, 0.0, "s"), "worst tipped over"),
            (at("belly-contact", 41.2, 0.0, "s"), "worst set its underside on the ground"),
            (at("stuck", 41.2, 0.0, "s"), "worst got stuck"),
            (at("off-map", 41.2, 0.0, "s"), "worst left the map"),
        ] {
            assert_eq!(of(&value), format!("{words}, {place}"));
        }
    }

    #[test]
    fn cases_that_were_not_found_are_told() {
        let value = violation("deviation", 0.65, 0.5);
        let of = |asked| verdict(&Judged { asked, ..with(3, &value) }).sentence;
        assert!(of(250).contains("; 200 of 250 cases asked for were found; all 200 witnessed"), "{}", of(250));
        assert_eq!(of(200), verdict(&with(3, &value)).sentence);
    }

    #[test]
    fn the_interval_decides_against_a_share_limit() {
        let value = violation("clearance", 0.1, 0.3);
        let of = |failed, limit| verdict(&Judged { share_limit: Some(limit), ..with(failed, &value) });
        let straddles = of(3, 0.02);
        assert_eq!(straddles.exit_code, 5);
        assert!(straddles.sentence.starts_with("INCONCLUSIVE 3/200 (simulated"), "{}", straddles.sentence);
        assert!(straddles.sentence.contains("worst clearance 0.10 m < 0.30 m"), "{}", straddles.sentence);
        assert!(straddles.sentence.contains("share 1.5 % [0.3, 4.3], interval straddles the 2 % allowed"));
        let passes = of(3, 0.05);
        assert_eq!(passes.exit_code, 0);
        assert!(passes.sentence.starts_with("PASS 197/200 (") && passes.sentence.contains("within the 5 % allowed"));
        let fails = of(30, 0.05);
        assert_eq!(fails.exit_code, 1);
        assert!(fails.sentence.starts_with("FAIL 30/200 (") && fails.sentence.contains("above the 5 % allowed"));
        // No violation at all, but too few cases to say so of one in a thousand.
        assert_eq!(of(0, 0.001).exit_code, 5);
        assert_eq!((of(1, 0.0).exit_code, of(0, 0.0).exit_code), (1, 0));
    }

    #[test]
    fn of_cases_that_were_searched_the_count_is_told_and_decides() {
        let value = violation("deviation", 0.65, 0.5);
        let of =
            |failed, share_limit| verdict(&Judged { chosen: Chosen::Searched, share_limit, ..with(failed, &value) });
        let fails = of(3, None);
        assert_eq!(
            fails.sentence,
            "FAIL 3/200 (simulated, anafi stand-in, minimum-snap, 5 runs each): worst 0.65 m > 0.50 m, case 0117, \
             t = 12.34 s, leg 4→5, rotors saturated 31 %; 3 of 200 searched violate; all 200 witnessed"
        );
        let within = of(3, Some(0.02));
        assert!(within.exit_code == 0 && within.sentence.starts_with("PASS 197/200 ("), "{}", within.sentence);
        assert!(within.sentence.contains("3 of 200 searched violate, within the 2 % allowed of them"));
        assert_eq!((of(0, Some(0.001)).exit_code, of(5, Some(0.02)).exit_code), (0, 1));
        for told in [fails, within] {
            assert!(!told.sentence.contains("3/N") && !told.sentence.contains('['), "{}", told.sentence);
        }
        // What was not judged is open, whatever was allowed.
        assert_eq!(verdict(&Judged { inconclusive: 200, ..with(0, &value) }).exit_code, 5);
    }

    #[test]
    fn the_worst_stands_beside_what_nobody_chose() {
        let value = violation("deviation", 3.91, 0.5);
        let by_chance = "random feasible ones 1.22 m in the mean (1.05 to 1.40), 1.90 m at worst of 20";
        let beside = Some(Beside { of: "4 000 flown", by_chance });
        let told = verdict(&Judged { beside, chosen: Chosen::Searched, ..with(3, &value) }).sentence;
        let expected = "worst 3.91 m > 0.50 m, case 0117, t = 12.34 s, leg 4→5, rotors saturated 31 %, of 4 000 flown; random \
                        feasible ones 1.22 m in the mean (1.05 to 1.40), 1.90 m at worst of 20; 3 of 200 searched violate; \
                        all 200 witnessed";
        assert!(told.ends_with(expected), "{told}");
    }

    #[test]
    fn what_a_limit_was_not_held_against_is_told_beside_a_pass() {
        let value = violation("deviation", 0.09, 0.1);
        let passed_over = &["14 of 20 legs within corner_m of their waypoints: no deviation judged there".to_owned()];
        let told = verdict(&Judged { passed_over, chosen: Chosen::Searched, ..with(0, &value) });
        let expected = "14 of 20 legs within corner_m of their waypoints: no deviation judged there; all 200 witnessed";
        assert!(told.exit_code == 0 && told.sentence.ends_with(expected), "{}", told.sentence);
    }

    #[test]
    fn draws_of_an_only_case_have_their_share() {
        let value = violation("deviation", 0.65, 0.5);
        let one = Judged { chosen: Chosen::Searched, cases: 1, draws: Some([7, 199]), claims: &[], ..with(1, &value) };
        let told = verdict(&one).sentence;
        let share = "; 1 of 1 searched violate; 7 of 199 draws of `[vary]` violate: share 3.5 % [1.4, 7.1]";
        assert!(told.ends_with(share), "{told}");
    }

    #[test]
    fn a_violation_outranks_a_failed_executor_which_outranks_doubt() {
        let value = violation("deviation", 0.65, 0.5);
        let trouble = "time-out 60 s, stderr kept";
        let base = Judged { executor_failed: 4, trouble, ..with(3, &value) };
        let failed = verdict(&base);
        assert_eq!(failed.exit_code, 1);
        assert!(failed.sentence.contains("; executor failed in 4/200, not counted; all 200 witnessed"));
        let within = Judged { failed: 0, inconclusive: 2, worst: None, ..base };
        let broken = verdict(&within);
        assert_eq!(broken.exit_code, 4);
        assert!(
            broken.sentence.starts_with(
                "EXECUTOR FAILED 4/200 (time-out 60 s, stderr kept): not counted as pass or fail; 194 judged (simulated"
            ),
            "{}",
            broken.sentence
        );
        assert_eq!(verdict(&Judged { executor_failed: 0, ..within }).exit_code, 5);
        let all = verdict(&Judged { executor_failed: 200, failed: 0, trouble, ..with(0, &value) });
        assert_eq!(all.sentence, "EXECUTOR FAILED 200/200 (time-out 60 s, stderr kept): not counted as pass or fail");
        assert_eq!(verdict(&Judged::default()).exit_code, 5);
    }

    #[test]
    fn the_other_sentences() {
        let none = nothing_feasible(
            &["proof", "hull"],
            "no chain of 10 waypoints from start to end",
            Some("length 12, or max_speed 8.0 → 9.3 m/s"),
        );
        assert_eq!(
            none.sentence,
            "NOTHING FEASIBLE (proof, hull): no chain of 10 waypoints from start to end; smallest change: length 12, \
             or max_speed 8.0 → 9.3 m/s"
        );
        assert_eq!(none.exit_code, 3);
        let reset = invalid("0118", &["flown", "log_25.ulg"], "position reset of 1.2 m at t = 8.1 s");
        assert_eq!(reset.sentence, "INVALID 0118 (flown, log_25.ulg): position reset of 1.2 m at t = 8.1 s");
        assert_eq!(reset.exit_code, 5);
        assert_eq!(inconclusive("0117", &["flown"], "x").sentence, "INCONCLUSIVE 0117 (flown): x");
    }

    #[test]
    fn what_nothing_was_asked_of_does_not_pass() {
        let value = violation("crash", 12.34, 0.0);
        let none = Judged { limited: false, worst: None, ..with(0, &value) };
        let unjudged = verdict(&none);
        assert_eq!(
            (unjudged.sentence.as_str(), unjudged.exit_code),
            (
                "UNJUDGED 200 (simulated, anafi stand-in, minimum-snap, 5 runs each): nothing crashed or left the world, no \
                 more was asked for: spec = \"none\"; all 200 witnessed",
                0
            )
        );
        let crashed = verdict(&Judged { limited: false, ..with(3, &value) });
        assert!(crashed.exit_code == 1 && crashed.sentence.starts_with("FAIL 3/200 ("), "{}", crashed.sentence);
        assert!(crashed.sentence.contains("worst crash") && crashed.sentence.contains("nothing else was asked for"));
        let broken = verdict(&Judged { executor_failed: 4, ..none });
        assert!(broken.exit_code == 4 && broken.sentence.contains("196 unjudged (simulated"), "{}", broken.sentence);
        assert_eq!(verdict(&Judged { inconclusive: 1, ..none }).exit_code, 5);
    }

    #[test]
    fn a_proof_of_the_best_stands_with_the_evidence() {
        let value = violation("deviation", 0.65, 0.5);
        let proven = verdict(&Judged { proof: Some("optimal"), ..with(3, &value) });
        assert!(proven.sentence.ends_with("; all 200 witnessed, optimal"), "{}", proven.sentence);
    }
}
