//! Why a job gave no result, as the exceptions of the package.

use hairpin_jobs::Problem;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// Where the exceptions are.
const ERRORS: &str = "hairpin._errors";

/// The exception that `problem` is.
pub(crate) fn raised(py: Python<'_>, problem: &Problem) -> PyErr {
    let sentence = problem.to_string();
    match problem {
        Problem::Scenario(report) => {
            let sentence = sentence.strip_prefix("Error: ").unwrap_or(&sentence);
            match report.complaints().first() {
                Some(first) => {
                    let said = (sentence, &*first.field, &*first.value, bare(&first.bound), (first.line, first.column));
                    built(py, "InputError", said)
                }
                None => wrong(py, sentence, "", "", ""),
            }
        }
        Problem::Input(_) => {
            let (field, value, bound) = parts(&sentence);
            wrong(py, &sentence, &field, value, bound)
        }
        Problem::Entry { at: [line, column], bound, .. } => {
            built(py, "InputError", (&*sentence, "", "", bound, (*line, *column)))
        }
        Problem::Lost(_) => made(py, "WriteError", &sentence),
        Problem::Executor(_) => made(py, "ExecutorError", &sentence),
        Problem::Interrupted(_) => made(py, "Interrupted", &sentence),
    }
}

/// Wrong input: the whole sentence, and of it the field, the value and what it must be, as far as they are known.
pub(crate) fn wrong(py: Python<'_>, sentence: &str, field: &str, value: &str, bound: &str) -> PyErr {
    built(py, "InputError", (sentence, field, value, bound))
}

fn made(py: Python<'_>, name: &str, sentence: &str) -> PyErr {
    built(py, name, (sentence,))
}

fn built<'py>(py: Python<'py>, name: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let error = py.import(ERRORS).and_then(|errors| errors.getattr(name)?.call1(arguments));
    match error {
        Ok(error) => PyErr::from_value(error),
        Err(error) => PyRuntimeError::new_err(format!("{ERRORS}.{name} cannot be raised: {error}")),
    }
}

/// Field, value and bound of a sentence as mistakes in keys are told: "`key` = value: must be bound".
fn parts(sentence: &str) -> (String, &str, &str) {
    if let Some(typed) = sentence.strip_prefix("--") {
        return of_flag(typed);
    }
    let none = (String::new(), "", "");
    let Some((field, rest)) = sentence.strip_prefix('`').and_then(|rest| rest.split_once('`')) else { return none };
    let field = field.to_owned();
    let Some(rest) = rest.strip_prefix(" = ") else { return (field, "", "") };
    // A value may hold marks of its own; what must be is what stands last.
    match rest.split_once(": must be ").or_else(|| rest.split_once(", must be ")).or_else(|| rest.split_once(": ")) {
        Some((value, bound)) => (field, value, bound),
        None => (field, rest, ""),
    }
}

/// The same of what the command says of a flag, "--key value: bound", whose name the keyword has.
fn of_flag(typed: &str) -> (String, &str, &str) {
    let (head, bound) = typed.split_once(": ").or_else(|| typed.split_once(", ")).unwrap_or((typed, ""));
    let (flag, value) = head.split_once(' ').unwrap_or((head, ""));
    match (flag, bound) {
        ("set", _) => (value.to_owned(), "", bound),
        (_, "") => (flag.replace('-', "_"), "", ""),
        _ => (flag.replace('-', "_"), value.trim_matches('`'), bare(bound)),
    }
}

/// What something must be, without saying that it must.
fn bare(bound: &str) -> &str {
    bound.strip_prefix("must be ").unwrap_or(bound)
}
