//! What an arm's log came to, as one sentence and as lines before it; mm and ms, as arms' users have them.

use std::path::Path;

use hairpin::campaign::{Setup, Status};
use hairpin::judgement::moves::offset_told;
use hairpin::judgement::{Measures, Verdict, Violation, inconclusive, unjudged, violated, within_spec};

use super::super::found::{JudgedLog, Outcome};
use super::super::matching::Matched;
use super::super::told::{hundredths, where_and_when};
use super::found::{FoundProgram, JointsTold};

/// A tool at its place may hang on another elbow or wrist.
const UNSHOWN: &str = "clearance of the links is not shown: the log tells poses and no joints";

/// A log that was judged.
pub(super) fn judged((file, name): (&Path, &str), found: FoundProgram, setup: &Setup) -> JudgedLog {
    let how = ["hardware", setup.robot_name(), name];
    let (outcome, verdict) = verdict(&found, &how, setup);
    JudgedLog { file: file.into(), name: name.into(), verdict, outcome, found: None, program: Some(found), sheet: None }
}

fn verdict(found: &FoundProgram, how: &[&str], setup: &Setup) -> (Outcome, Verdict) {
    let (case, result) = (&found.case, &found.result);
    let with =
        |sentence: String| [Some(sentence), found.offset_words()].into_iter().flatten().collect::<Vec<_>>().join("; ");
    // A log that ends early says nothing of how the arm went on.
    let counts = |violation: &&Violation| found.short.is_none() || !violation.is_unfinished();
    if let Some(violation) = result.violations.iter().find(counts) {
        return (Outcome::Fail, violated(case, how, &with(where_and_when(violation))));
    }
    if let Some(short) = &found.short {
        let ended = match found.to_s {
            Some(to) => format!("--to at t = {to:.2} s"),
            None => format!("the log ends at t = {:.2} s", short.ends),
        };
        let sentence = format!(
            "{ended}, on move {} of {} ({}): what was left of the program is not judged",
            short.reached + 1,
            short.moves,
            short.name
        );
        return (Outcome::Inconclusive, inconclusive(case, how, &with(sentence)));
    }
    let worst = result.measures.as_ref().map(|measures| worst(measures, setup));
    let why = || result.message.as_deref().map_or("it cannot be measured", |why| why.trim_start_matches("run 0: "));
    match (result.status, worst) {
        (Status::Pass, Some(worst)) => {
            let sentence = [Some(worst), found.unshown()].into_iter().flatten().collect::<Vec<_>>().join("; ");
            (Outcome::Pass, within_spec(case, how, &with(sentence)))
        }
        (Status::Unjudged, Some(worst)) => {
            let sentence = format!("{worst}; nothing was asked for: spec = \"none\"");
            (Outcome::Unjudged, unjudged(case, how, &with(sentence)))
        }
        _ => (Outcome::Inconclusive, inconclusive(case, how, &with(why().to_owned()))),
    }
}

/// `12.10 mm ≤ 20.00 mm, t = 3.20 s, leg 2→3; 35 ms late at most`.
fn worst(measures: &Measures, setup: &Setup) -> String {
    let limit = setup.scenario.deviation_limit().map_or(String::new(), |limit| format!(" ≤ {:.2} mm", 1e3 * limit));
    let (leg, off) = (measures.leg_worst, 1e3 * measures.max_deviation);
    let path = format!("{off:.2} mm{limit}, t = {:.2} s, leg {leg}→{}", measures.t_worst, leg + 1);
    match &measures.latest {
        Some(late) => format!("{path}; {:.0} ms late at most, leg {}→{}", 1e3 * late.by, late.leg, late.leg + 1),
        None => path,
    }
}

/// `mean 0.21 mm off; next best 0002 at 18.40 mm`.
fn in_millimetres(matched: &Matched) -> String {
    let next = matched
        .next
        .as_ref()
        .map_or(", the only case".to_owned(), |(case, far)| format!("; next best {case} at {:.2} mm", 1e3 * far));
    format!("mean {:.2} mm off{next}", 1e3 * matched.mean_m)
}

impl JointsTold {
    fn in_words(&self) -> String {
        let by = if self.by_name { "by their names" } else { "by their numbers" };
        let order = if self.order == self.names {
            String::new()
        } else {
            format!(", in the log's order {}", self.order.join(", "))
        };
        let others =
            if self.others.is_empty() { String::new() } else { format!("; not used: {}", self.others.join(", ")) };
        format!("{}; axes 1 to 6 {by}: {}{order}{others}", self.unit, self.names.join(", "))
    }
}

impl FoundProgram {
    fn offset_words(&self) -> Option<String> {
        offset_told(self.offset.into_iter())
    }

    /// What a log of poses alone does not show of a program that was proven clear in one posture.
    fn unshown(&self) -> Option<String> {
        (self.joints.is_none() && self.in_one_posture).then(|| UNSHOWN.to_owned())
    }

    /// What is told before the sentence, label and value.
    pub fn lines(&self) -> Vec<[String; 2]> {
        let mut lines = Vec::new();
        let mut line = |label: &str, value: String| lines.push([label.to_owned(), value]);
        let source = &self.source;
        let rate = (1e3 * source.rate_hz).round() / 1e3;
        line(
            "recorded",
            format!(
                "{}, {} ({}), {} samples at {rate:.4} Hz, stamps {}",
                source.format, source.topic, source.words, source.samples, source.clock
            ),
        );
        if let Some(joints) = &self.joints {
            line("joints", joints.in_words());
        }
        line(
            "program",
            format!(
                "taken to begin at t = {:.3} s of the log (--from S names another); not aligned in space",
                self.begins_s
            ),
        );
        line(
            "case",
            match &self.matched {
                Some(matched) => format!("matched to case {} ({})", self.case, in_millimetres(matched)),
                None => self.case.clone(),
            },
        );
        if let Some(measures) = &self.result.measures {
            let [most, mean] = [measures.max_deviation, measures.mean_deviation].map(|m| 1e3 * m);
            line("deviation", format!("max {most:.3} mm, mean {mean:.3} mm"));
            if let Some(late) = &measures.latest {
                let between = self.late_between.get(late.leg).copied().flatten();
                let between = between.map_or(String::new(), |[least, most]| {
                    format!(", between {:+.1} and {:+.1} ms by the samples about it", 1e3 * least, 1e3 * most)
                });
                line("latest", format!("{:+.1} ms, leg {}→{}{between}", 1e3 * late.by, late.leg, late.leg + 1));
            }
            if let Some(simulated) = self.simulated_m {
                let simulated = 1e3 * simulated;
                line(
                    "gap",
                    format!(
                        "hardware {most:.2} mm, simulated {simulated:.2} mm at worst: {:+.2} mm",
                        hundredths(most - simulated)
                    ),
                );
            }
        }
        if let Some(offset) = self.offset_words() {
            line("clock", offset);
        }
        self.notes.iter().for_each(|note| line("note", note.clone()));
        lines
    }
}
