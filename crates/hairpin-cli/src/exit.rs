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

/// Tells a problem, and gives the exit code.
pub(crate) fn tell(problem: &Problem, json: bool) -> u8 {
    match problem {
        Problem::Scenario(report) => {
            console::warn_in_colour(report.render(console::colour_on_stderr()).trim_end());
        }
        Problem::Input(sentence) | Problem::Lost(sentence) => console::warn(&format!("Error: {sentence}")),
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
        Problem::Scenario(_) | Problem::Input(_) => WRONG_INPUT,
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
