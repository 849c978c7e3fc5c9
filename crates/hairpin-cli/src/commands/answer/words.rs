//! A campaign in words: the verdict, a table of the worst cases, the worst one's course, and what to do next.

use hairpin::campaign::digits::number;
use hairpin::campaign::report::{cells_in, columns_in, length, worst_first};
use hairpin_jobs::next::{next_commands, report_command};
use hairpin_jobs::report::worst_in_full;

use super::super::course::course;
use super::super::explained::point_to_explain;
use super::Answer;
use crate::console;

/// Rows of the table.
const WORST: usize = 5;

impl Answer<'_> {
    /// Says it, and gives the exit code.
    pub(in crate::commands) fn say(&self, json: bool) -> u8 {
        if json {
            console::say(&self.object().to_string());
        } else {
            // Who looks on reads the verdict first; who reads along in a log, at its end.
            let seen = console::width().is_some();
            let verdict = || console::say_verdict(&self.verdict.sentence, self.verdict.exit_code);
            if seen {
                verdict();
                console::say("");
            }
            self.say_details(seen);
            if !seen {
                verdict();
            }
            self.point_on();
        }
        self.verdict.exit_code
    }

    /// The table of the worst cases, the worst one's course, the frame, and which parameter did it. All that is said of
    /// the frame stands in a log, and at a terminal where it is asked for.
    fn say_details(&self, seen: bool) {
        if !self.judgement.results.is_empty() {
            console::say_lines(&self.table());
            console::say("");
        }
        if let Some(worst) = worst_in_full(self.work, self.cases, &self.judgement.results) {
            let lines = course(&worst, &length(&self.work.setup));
            lines.iter().for_each(|line| console::say(line));
        }
        let header = self.header();
        let lines: Vec<String> = header.lines().iter().map(|[label, value]| format!("{label}: {value}")).collect();
        if !seen {
            console::say(&format!("{}\n", lines.join("; ")));
        } else if console::is_verbose() {
            console::say_lines(&lines.join("\n"));
            console::say("");
        } else {
            console::say(&format!("{}\n", header.line()));
        }
        for found in &self.judgement.influences {
            console::say(&format!("{:+.2}  {}", found.rank_correlation, found.key));
        }
        if !self.judgement.influences.is_empty() {
            console::say("rank correlation of what was varied with the largest deviation, over all runs\n");
        }
    }

    /// What was left undone, where the report is, and what to do next.
    fn point_on(&self) {
        if let Some(spent) = self.spent.filter(|spent| !spent.cut.is_empty()) {
            console::warn(&format!(
                "the budget of {} s cut it short: {}; --resume without it goes on",
                number(Some(spent.seconds)),
                spent.cut.join(", ")
            ));
        }
        point_to_explain(self.work, self.judgement.verdict.exit_code);
        let report = self.work.folder.path().join("report.html");
        match (report.is_file(), self.reported) {
            (true, true) => console::warn(&format!("report: {}", report.display())),
            // To write one takes longer than to judge, and may execute runs again.
            (true, false) => console::warn(&format!(
                "{} is of an earlier judgement: {} writes it anew",
                report.display(),
                report_command(self.work.folder.path())
            )),
            (false, _) => {}
        }
        for command in next_commands(self.work, &self.judgement.results) {
            console::warn(&format!("next: {command}"));
        }
    }

    fn table(&self) -> String {
        // In the unit that the verdict has: of arms mm.
        let length = length(&self.work.setup);
        let header = columns_in(&length).into_iter().chain(["evidence".to_owned()]).collect();
        let worst = worst_first(&self.judgement.results).into_iter().take(WORST);
        let rows = worst.map(|result| cells_in(&length, result).into_iter().chain(self.claim(result)).collect());
        console::table(&std::iter::once(header).chain(rows).collect::<Vec<_>>())
    }
}
