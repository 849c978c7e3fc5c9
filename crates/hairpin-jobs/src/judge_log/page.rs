//! The page of judged logs: what was planned, simulated and flown over each other, opened where the verdict points.

use std::collections::BTreeSet;
use std::path::Path;

use hairpin::campaign::report::{self, Beside, Length, Pieces, ReportData, Shown, worst_first};
use hairpin::campaign::{Case, CaseNumber, CaseResult};
use hairpin::judgement::Verdict;
use nalgebra::{Point3, Vector3};

use super::against::{Of, Ready};
use super::arm::FoundProgram;
use super::found::{Found, JudgedLog, JudgedLogs};
use super::legs::LegsBy;
use super::sheet::Sheet;
use crate::Problem;

/// Logs that open at most; the worst do.
const OPEN: usize = hairpin_formats::report::SHOWN;

/// Writes the page of `judged` into `file`.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write(file: &Path, judged: &JudgedLogs, against: &Ready) -> Result<(), Problem> {
    let many = judged.count.is_some();
    let sheets = || judged.logs.iter().filter_map(|log| Some((log, log.sheet.as_deref()?)));
    // A log is called by its file; alone it is the case that it flew.
    let number = |place: usize, sheet: &Sheet| if many { CaseNumber(place) } else { sheet.case.number };
    let numbered = || sheets().enumerate().map(|(place, (log, sheet))| (number(place, sheet), log, sheet));
    let as_of = |result: &CaseResult, case: CaseNumber| CaseResult { case, ..result.clone() };
    let results: Vec<CaseResult> = numbered().map(|(case, _, sheet)| as_of(&sheet.shown.result, case)).collect();
    let random: Vec<CaseResult> =
        numbered().filter_map(|(case, _, sheet)| Some(as_of(sheet.simulated.as_ref()?, case))).collect();
    let cases: Vec<Case> = numbered().map(|(number, _, sheet)| Case { number, ..sheet.case.clone() }).collect();
    let worst: BTreeSet<CaseNumber> = worst_first(&results).iter().take(OPEN).map(|result| result.case).collect();
    let drawn = numbered().filter(|(case, ..)| worst.contains(case));
    let shown: Vec<Shown> = drawn.map(|(case, log, sheet)| on_page(case, log, sheet, many)).collect();
    let verdict = judged.count.as_ref().or(judged.logs.first().map(|log| &log.verdict));
    let data = report::assemble(Pieces {
        setup: &against.setup,
        cases: &cases,
        results: &results,
        tally: None,
        verdict: verdict.cloned().unwrap_or_else(|| Verdict::of("", 0)),
        assumptions: assumptions(judged, against),
        shown,
        frame: frame(judged),
        influences: Vec::new(),
        coverage: None,
        baseline: None,
        random: &random,
        asked: None,
    });
    let mut names = Names::default();
    let logs = numbered().map(|(case, log, _)| (case, if many { names.of(&log.name) } else { case.to_string() }));
    let evidence = numbered().map(|(case, log, _)| (case, log.evidence().to_owned()));
    let mut data = ReportData {
        logs: logs.collect(),
        claims: evidence.collect(),
        beside: Beside { runs: beside(against), cases: "the same cases in simulation", shown: "the log" },
        facts: facts(judged, against),
        ..data
    };
    for card in data.key_numbers.iter_mut().filter(|card| many && card[0] == "in case") {
        let named = data.logs.iter().find(|(number, _)| number.to_string() == card[1]);
        (card[0], card[1]) = ("in log".into(), named.map_or_else(String::new, |(_, name)| name.clone()));
    }
    data.key_numbers.extend(cards(judged, &data.length));
    if !many {
        // Of one there is no distribution.
        data.metrics.clear();
    }
    if !against.in_world {
        in_no_world(&mut data);
    }
    Ok(hairpin_formats::report::write(file, &data)?)
}

/// A log as it stands on the page, with what it was found to be where there are several.
fn on_page(case: CaseNumber, log: &JudgedLog, sheet: &Sheet, many: bool) -> Shown {
    let mut shown = sheet.shown.clone();
    shown.result.case = case;
    if many {
        let lines = lines(log).into_iter().filter(|[label, _]| label == "case" || label == "gap");
        shown.environment.extend(lines.map(|[label, value]| format!("{label}: {value}")));
    }
    shown
}

/// What stands before a log's sentence, line by line.
fn lines(log: &JudgedLog) -> Vec<[String; 2]> {
    let of_flight = log.found.as_ref().map(Found::lines);
    of_flight.or_else(|| log.program.as_ref().map(FoundProgram::lines)).unwrap_or_default()
}

/// Whose runs stand beside the log.
fn beside(against: &Ready) -> &'static str {
    match &against.of {
        Of::Campaign(work) if work.setup.recordings().is_some() => "the campaign’s recordings",
        Of::Campaign(work) if work.setup.program().is_some() => "the campaign’s runs",
        _ => "simulated",
    }
}

fn frame(judged: &JudgedLogs) -> Vec<[String; 2]> {
    match &judged.logs[..] {
        [only] => lines(only).into_iter().filter(|[label, _]| label == "frame" || label == "case").collect(),
        _ => vec![["frame".into(), "as each log tells it; not aligned, in space or in time".into()]],
    }
}

fn facts(judged: &JudgedLogs, against: &Ready) -> Vec<[String; 2]> {
    let fact = |label: &str, value: String| [label.to_owned(), value];
    let caveat = against.setup.caveat();
    let caveat = if caveat.is_empty() { String::new() } else { format!(" ({caveat})") };
    let mut facts = vec![fact("robot", format!("{}{caveat}", against.setup.robot_name()))];
    facts.push(match &against.of {
        Of::Campaign(work) => fact("against", work.folder.path().display().to_string()),
        Of::Mission(name) => fact("against", format!("mission {name}")),
    });
    match &judged.logs[..] {
        [only] => {
            facts.push(fact("log", only.name.clone()));
            facts.extend(lines(only));
        }
        all => facts.push(fact("logs", all.len().to_string())),
    }
    facts
}

/// What a log says of the simulation, or how many came to what.
fn cards(judged: &JudgedLogs, length: &Length) -> Vec<[String; 3]> {
    let card = |label: &str, value: String, note: String| [label.to_owned(), value, note];
    let [only] = &judged.logs[..] else {
        let of = |word: &str| judged.logs.iter().filter(|log| log.outcome.word() == word).count();
        let note =
            format!("{} in violation, {} inconclusive, {} invalid", of("fail"), of("inconclusive"), of("invalid"));
        return vec![card("logs within spec", format!("{} of {}", of("pass"), judged.logs.len()), note)];
    };
    let flown = only.sheet.as_ref().and_then(|sheet| sheet.shown.result.measures.as_ref());
    let simulated = only.sheet.as_ref().and_then(|sheet| sheet.simulated.as_ref()?.measured());
    let simulated = simulated.map(|simulated| simulated.max_deviation);
    // Told legs and assigned ones are not to be compared.
    let simulated = match &only.found {
        Some(found) if found.legs_by == LegsBy::Assigned => found.simulated_m,
        _ => simulated,
    };
    let (Some(flown), Some(simulated)) = (flown, simulated) else { return Vec::new() };
    let gap = flown.max_deviation - simulated;
    // The numbers of a file's last digit are none: a flight judged against itself has no gap.
    let gap = if gap.abs() < 5e-6 { 0.0 } else { gap };
    let gap = format!("{}{}", if gap > 0.0 { "+" } else { "" }, length.told(gap));
    vec![
        card(
            "largest deviation, simulated",
            length.told(simulated),
            format!("flown {}", length.told(flown.max_deviation)),
        ),
        card("gap", gap, "flown less simulated, at worst".into()),
    ]
}

fn assumptions(judged: &JudgedLogs, against: &Ready) -> Vec<String> {
    let mut all = vec![
        "Nothing is aligned. In space all stands where log and campaign say; in time the plan and what was simulated of it have clocks of \
         their own, and are drawn from the first judged moment of the log on."
            .to_owned(),
    ];
    let runs = match &against.of {
        Of::Campaign(_) => "What stands beside the log is what the campaign has of the case, in its own conditions.",
        Of::Mission(_) => {
            "What stands beside the log is one nominal run of the mission in our simulator, planned by us."
        }
    };
    all.push(runs.into());
    all.extend(against.notes.iter().cloned());
    for log in &judged.logs {
        let notes = log.found.as_ref().map(|found| &found.notes).or(log.program.as_ref().map(|found| &found.notes));
        let notes = notes.into_iter().flatten().chain(log.sheet.iter().flat_map(|sheet| &sheet.notes));
        all.extend(notes.map(|note| format!("{}: {note}", log.name)));
        if log.sheet.is_none() {
            all.push(log.verdict.sentence.clone());
        }
    }
    all
}

/// Where nobody knows which world it was, none is drawn: what is shown is the room that the tracks take.
fn in_no_world(data: &mut ReportData) {
    let (mut low, mut high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    for shown in &data.shown {
        for place in shown.places() {
            (low, high) = (low.inf(&place.coords), high.sup(&place.coords));
        }
    }
    if low.x > high.x {
        return;
    }
    let margin = Vector3::repeat(0.05 * (high - low).max() + 0.5);
    (data.drawing.low, data.drawing.size) = (Point3::from(low - margin), high - low + 2.0 * margin);
    data.drawing.obstacles.clear();
    data.drawing.relief = None;
}

/// Names of logs that are addresses on a page, each another.
#[derive(Default)]
struct Names(BTreeSet<String>);

impl Names {
    fn of(&mut self, name: &str) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '_' };
        let name: String = name.chars().map(plain).collect();
        let other = || (2..).map(|i| format!("{name}-{i}")).find(|name| !self.0.contains(name));
        let own = if self.0.contains(&name) { other().unwrap_or_default() } else { name.clone() };
        self.0.insert(own.clone());
        own
    }
}
