//! What the test plan found, in words and as an object: requirements, tests, and the source's example.

use hairpin_jobs::Problem;
use serde_json::{Value, json};

use super::check::{Check, Test};
use super::plan::{Measured, Requirement};
use super::subject::RequirementsSettings;
use crate::findings::{Findings, Words};

/// Measures every requirement and every test; met are [`Findings`] of which every one passed.
///
/// # Errors
/// A map that cannot be read, or without room for the drives that are asked for.
pub fn check(settings: &RequirementsSettings) -> Result<Findings, Problem> {
    let measured = Measured::now(settings)?;
    Ok(Findings { words: words(&measured), object: object(&measured), met: measured.met() })
}

/// A judged line: its name, what it asks, and what was measured against which bound.
fn line(name: &str, asked: &str, check: &Check) -> Words {
    let word = if check.passed { "PASS" } else { "FAIL" };
    Words::Text(format!("{word} {name} {asked}\n           {}; must be {}", check.measured, check.bound))
}

fn words(measured: &Measured) -> Vec<Words> {
    let Measured { notes, requirements, tests, example, .. } = measured;
    let heading = |text: &str| Words::Text(format!("\n{text}"));
    let mut words: Vec<Words> = Words::lines(notes.iter().cloned()).collect();
    words.push(heading("Requirements"));
    words.extend(requirements.iter().map(|((id, text, _), check)| line(&format!("{id:5}"), text, check)));
    words.push(heading("Tests of the results document"));
    let test = |Test { id, requirement, what, check }: &Test| line(&format!("{id:4} ({requirement})"), what, check);
    words.extend(tests.iter().map(test));
    words.push(heading("The source's example program"));
    words.extend(example.words());
    words.push(heading(&measured.counted()));
    words
}

fn object(measured: &Measured) -> Value {
    let Measured { notes, requirements, tests, example, .. } = measured;
    let judged = |Check { measured, bound, passed }: &Check, own: [(&str, Value); 3]| {
        let mut row = json!({ "measured": measured, "bound": bound, "passed": passed });
        own.into_iter().for_each(|(key, value)| row[key] = value);
        row
    };
    let requirement = |((id, text, covered), check): &(Requirement, Check)| {
        judged(check, [("id", (*id).into()), ("requirement", (*text).into()), ("tests", (*covered).into())])
    };
    let test = |Test { id, requirement, what, check }: &Test| {
        judged(check, [("id", (*id).into()), ("requirement", (*requirement).into()), ("what", what.as_str().into())])
    };
    json!({
        "subject": notes,
        "requirements": requirements.iter().map(requirement).collect::<Vec<_>>(),
        "tests": tests.iter().map(test).collect::<Vec<_>>(),
        "example": example.object(),
        "exit_code": u8::from(!measured.met()),
    })
}
