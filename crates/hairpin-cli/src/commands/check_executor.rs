//! `hairpin check-executor`: what a program says, and what is wrong with it.

use hairpin_formats::executor::{Said, Speaker, Transcript};
use hairpin_jobs::check_executor::{CheckExecutorSettings, Checked, Difference, Finding, Step, check_executor};
use hairpin_jobs::{Problem, Watch};
use serde_json::{Value, json};

use crate::args::CheckExecutor;
use crate::{console, settings};

/// Characters of a line that are shown.
const SHOWN: usize = 150;
/// Lines of a step that are shown at its beginning, and at its end.
const FIRST: usize = 6;
const LAST: usize = 3;

/// Runs the command: 0 where the program is sound, 4 where it is not.
pub(crate) fn run(asked: &CheckExecutor, watch: &dyn Watch) -> Result<u8, Problem> {
    let mut sets = settings::keys(&asked.keys, None)?;
    sets.extend(asked.timeout.map(|seconds| ("execute.timeout_s".to_owned(), format!("{seconds:?}"))));
    let settings = CheckExecutorSettings {
        command: asked.command.clone(),
        scenario: asked.scenario.clone(),
        sets,
        consent: settings::consent(&asked.commands),
        ..CheckExecutorSettings::default()
    };
    let checked = check_executor(&settings, watch)?;
    if asked.json {
        console::say(&object(asked, &checked).to_string());
    } else {
        checked.steps.iter().for_each(tell);
        console::say(&checked.verdict.sentence);
    }
    Ok(checked.verdict.exit_code)
}

fn object(asked: &CheckExecutor, checked: &Checked) -> Value {
    let difference = |one: &Option<Difference>| {
        one.map(|it| json!({ "same": it.same, "poses": it.poses, "position_m": it.position_m, "at_s": it.at_s, "time_s": it.time_s }))
    };
    let speed = checked.speed.map(|it| {
        json!({ "missions": it.missions, "executions_per_s": it.executions_per_s, "real_time": it.real_time, "poses": it.poses,
            "protocol_ms_per_mission": it.protocol_ms_per_mission, "protocol_us_per_pose": it.protocol_us_per_pose })
    });
    let [by_the_same, by_another] = &checked.again;
    json!({
        "command": asked.command,
        "program": checked.greeting,
        "steps": checked.steps.iter().map(step).collect::<Vec<_>>(),
        "again": { "same_process": difference(by_the_same), "new_process": difference(by_another) },
        "speed": speed,
        "verdict": checked.verdict.sentence,
        "exit_code": checked.verdict.exit_code,
    })
}

fn step(step: &Step) -> Value {
    let finding = |it: &Finding| json!({ "kind": it.word(), "sentence": it.sentence() });
    let begun = step.transcript.said.first().map(|said| said.at);
    let said = |it: &Said| {
        let at = begun.map(|begun| it.at.duration_since(begun).as_secs_f64());
        json!({ "by": by(it), "at_s": at, "line": it.line })
    };
    json!({
        "step": step.name,
        "result": step.word(),
        "findings": step.findings.iter().map(finding).collect::<Vec<_>>(),
        "said": step.transcript.said.iter().map(said).collect::<Vec<_>>(),
        "left_out": step.transcript.left_out,
        "stderr": step.stderr,
    })
}

fn by(said: &Said) -> &'static str {
    match said.by {
        Speaker::Hairpin => "hairpin",
        Speaker::Program => "program",
    }
}

/// What was found, what was said, and the end of stderr.
fn tell(step: &Step) {
    if step.findings.is_empty() {
        console::say(&format!("{}: not checked", step.name));
        return;
    }
    for (number, finding) in step.findings.iter().enumerate() {
        let name = if number == 0 { format!("{}: ", step.name) } else { "  ".into() };
        let word = match finding {
            Finding::Fact(_) => "",
            Finding::Remark(_) => "remark: ",
            Finding::Mistake(_) => "MISTAKE: ",
        };
        console::say(&format!("{name}{word}{}", finding.sentence()));
    }
    tell_lines(&step.transcript);
    let stderr: Vec<&str> = step.stderr.lines().filter(|line| !line.trim().is_empty()).collect();
    let last = &stderr[stderr.len().saturating_sub(LAST)..];
    last.iter().for_each(|line| console::say(&format!("    stderr: {}", cut(line))));
}

/// The first lines and the last ones, none longer than a screen is wide.
fn tell_lines(transcript: &Transcript) {
    let said = &transcript.said;
    let shown = |said: &Said| {
        let sign = if said.by == Speaker::Hairpin { '>' } else { '<' };
        console::say(&format!("    {sign} {}", cut(&said.line)));
    };
    let left = said.len().saturating_sub(FIRST + LAST);
    if left == 0 && transcript.left_out == 0 {
        said.iter().for_each(shown);
        return;
    }
    said[..FIRST.min(said.len())].iter().for_each(shown);
    console::say(&format!("    … {} more lines (--json has them)", left + transcript.left_out));
    said[(FIRST + left).min(said.len())..].iter().for_each(shown);
}

fn cut(line: &str) -> String {
    let more = line.chars().count().saturating_sub(SHOWN);
    let shown: String = line.chars().take(SHOWN).collect();
    if more == 0 { shown } else { format!("{shown} … ({more} more characters)") }
}
