//! What a command came to, as an exit code; and why one gave no verdict, as a sentence for people and an object for
//! machines.
//!
//! | code | meaning |
//! | --- | --- |
//! | 0 | within spec |
//! | 1 | violation, a finding of `verify` or `import`, or what `compare` fails on |
//! | 2 | wrong input |
//! | 3 | nothing feasible |
//! | 4 | executor failed |
//! | 5 | inconclusive |
//! | 70 | a mistake of hairpin's own |
//! | 74 | a result could not be written: no space, I/O error |
//! | 130 | interrupted; `--resume` goes on |

use std::fmt::Write;

use hairpin_formats::quote::shortened;
use hairpin_jobs::Problem;
use serde_json::{Value, json};

use crate::console;

/// Within spec, or done.
pub(crate) const DONE: u8 = 0;
/// A violation, or a finding.
pub(crate) const FINDING: u8 = 1;
/// Wrong input.
pub(crate) const WRONG_INPUT: u8 = 2;
/// Nothing feasible.
pub(crate) const NOTHING_FEASIBLE: u8 = 3;
/// The user's program failed.
pub(crate) const EXECUTOR_FAILED: u8 = 4;
/// Open: not found within the budget, or not to be judged.
pub(crate) const INCONCLUSIVE: u8 = 5;
/// A mistake of hairpin's own (`EX_SOFTWARE` of sysexits.h).
pub(crate) const OUR_MISTAKE: u8 = 70;
/// A result could not be written (`EX_IOERR` of sysexits.h).
pub(crate) const LOST: u8 = 74;
/// Interrupted, as shells have it.
pub(crate) const INTERRUPTED: u8 = 130;

/// The one table: code, what it means, and what to do about it.
const EXPLAINED: &[(u8, &str, &str)] = &[
    (DONE, "within spec, or done", "UNJUDGED too: a scenario with spec = \"none\" asks for nothing"),
    (
        FINDING,
        "a violation, a regression or a finding",
        "the verdict names case, time and leg: hairpin replay OUT --case ID, hairpin shrink OUT --case ID.\n\
         verify and import --check give it for a finding, compare for newly failing cases, check for a mission\n\
         that is not feasible",
    ),
    (WRONG_INPUT, "wrong input", "the message names file, line, key, value and bound; nothing was executed"),
    (NOTHING_FEASIBLE, "nothing feasible", "hairpin explain SCENARIO tells why, and the smallest change that helps"),
    (
        EXECUTOR_FAILED,
        "your program failed",
        "what it said last is in the verdict, all of it in executor-CASE-RUN.log; hairpin check-executor 'COMMAND'\n\
         tells what is wrong with it. Runs that were not flown count neither as pass nor as fail",
    ),
    (
        INCONCLUSIVE,
        "inconclusive",
        "an interval straddles its limit, data allow no verdict, or --budget cut the campaign short: no pass.\n\
         More cases, better data or more time decide",
    ),
    (OUR_MISTAKE, "a mistake of hairpin's own", "please report it with the command and its files"),
    (LOST, "a result could not be written", "no space is left or the device failed; --resume goes on"),
    (INTERRUPTED, "interrupted", "what is done is kept; --resume goes on"),
];

/// What `hairpin help exit-codes` says.
pub(crate) fn explained() -> String {
    let mut text = "Exit codes of every command:\n".to_owned();
    for (code, meaning, remedy) in EXPLAINED {
        let _ = write!(text, "\n{code:>4}  {meaning}\n      {}\n", remedy.replace('\n', "\n      "));
    }
    text += "\nA violation is a fact whatever else went wrong, so 1 comes first; then 4, because what was not flown was\n\
             not judged; then 5. In JUnit 1 is a failure, 4 and 5 are errors, and what was not found is skipped.";
    text
}

/// Tells a problem, and gives the exit code.
pub(crate) fn tell(problem: &Problem, json: bool) -> u8 {
    match problem {
        Problem::Scenario(report) => {
            console::warn_in_colour(report.render(console::colour_on_stderr()).trim_end());
        }
        Problem::Input(sentence) | Problem::Entry { sentence, .. } | Problem::Lost(sentence) => {
            console::warn(&format!("Error: {sentence}"))
        }
        Problem::Executor(sentence) => console::warn(&format!("EXECUTOR FAILED: {sentence}")),
        Problem::Interrupted(sentence) => console::warn(sentence),
    }
    if json {
        console::say(&object(problem).to_string());
    }
    code(problem)
}

fn code(problem: &Problem) -> u8 {
    match problem {
        Problem::Scenario(_) | Problem::Input(_) | Problem::Entry { .. } => WRONG_INPUT,
        Problem::Lost(_) => LOST,
        Problem::Executor(_) => EXECUTOR_FAILED,
        Problem::Interrupted(_) => INTERRUPTED,
    }
}

/// What machines get on stdout.
pub(crate) fn object(problem: &Problem) -> Value {
    let code = code(problem);
    match problem {
        Problem::Scenario(report) => json!({ "exit_code": code, "mistakes": report.to_json() }),
        Problem::Input(sentence)
        | Problem::Entry { sentence, .. }
        | Problem::Lost(sentence)
        | Problem::Executor(sentence)
        | Problem::Interrupted(sentence) => {
            json!({ "exit_code": code, "error": shortened(sentence) })
        }
    }
}

/// The code of a command that came to `code`, unless some of its results did not get to stdout.
pub(crate) fn all_said(code: u8) -> u8 {
    match console::lost() {
        Some(why) => {
            console::warn(&format!("Error: cannot write the result to stdout: {why}"));
            LOST
        }
        None => code,
    }
}
