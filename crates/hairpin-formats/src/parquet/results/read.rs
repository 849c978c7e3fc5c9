//! `results.parquet` back into cases and results, every value checked.

use std::path::Path;

use hairpin::campaign::{Case, CaseResult, Draws, Environment, Evidence, Reruns, Status};
use hairpin::judgement::Violation;

use super::super::drawn;
use super::super::measures::{self, complete_lists, same_lengths};
use super::super::table::{Table, TableError};
use super::{ELSEWHERE, GENERATED, Row};

const CERTIFIED: [&str; 3] = ["yes", "no", "unknown"];

/// Reads the rows, in the file's order.
///
/// # Errors
/// Missing columns, values out of bounds, a case that is twice there.
pub fn read(path: &Path) -> Result<Vec<Row>, TableError> {
    rows_of(&Table::read(path)?)
}

/// [`read`] of what [`super::write_counted`] wrote.
///
/// # Errors
/// As of [`read`]; other rows than were written.
pub fn read_counted(path: &Path) -> Result<Vec<Row>, TableError> {
    let table = Table::read(path)?;
    table.check_rows()?;
    rows_of(&table)
}

fn rows_of(table: &Table) -> Result<Vec<Row>, TableError> {
    let cases = read_cases(table)?;
    let results = read_results(table, &cases)?;
    let lengths = table.counts("length")?;
    let rows = cases.into_iter().zip(lengths).zip(results);
    Ok(rows.map(|((case, length), result)| Row { case, length, result }).collect())
}

fn read_cases(table: &Table) -> Result<Vec<Case>, TableError> {
    let numbers = table.cases()?;
    let seeds = table.unsigned("seed")?;
    let graphs = table.unsigned("graph")?;
    let scores = table.numbers("score")?;
    let bounds = table.optional_numbers("bound")?;
    let evidence = table.texts("evidence")?;
    let certified = table.optional_texts("certified")?;
    let environments = read_environments(table)?;
    let mut seen = std::collections::BTreeSet::new();
    (0..table.rows())
        .map(|row| {
            if !seen.insert(numbers[row]) {
                return Err(table.refuse("case", row, numbers[row].to_string(), "there once"));
            }
            let word = |column: &str, text: &str, bound: &str| table.refuse(column, row, format!("`{text}`"), bound);
            let known = |text: &String| {
                let found = CERTIFIED.into_iter().find(|word| word == text);
                found.ok_or_else(|| word("certified", text, "yes, no or unknown"))
            };
            Ok(Case {
                number: numbers[row],
                seed: seeds[row],
                graph: graphs[row],
                waypoints: Vec::new(),
                leg_times: Vec::new(),
                seen: Vec::new(),
                score: scores[row],
                bound: bounds[row],
                evidence: Evidence::from_word(&evidence[row])
                    .ok_or_else(|| word("evidence", &evidence[row], "unchecked, hull-feasible or witnessed"))?,
                certified: certified[row].as_ref().map(known).transpose()?,
                witness: None,
                environment: environments[row].clone(),
            })
        })
        .collect()
}

/// What cases have beside their waypoints; tables without such cases do not say.
fn read_environments(table: &Table) -> Result<Vec<Option<Environment>>, TableError> {
    if !table.has("environment") {
        return Ok(vec![None; table.rows()]);
    }
    let texts = table.optional_texts("environment")?.into_iter().enumerate();
    let one = |(row, text): (usize, Option<String>)| {
        let read = text.as_ref().map(|text| serde_json::from_str(text)).transpose();
        read.map_err(|error| {
            let found = text.clone().unwrap_or_default();
            table.refuse("environment", row, found, format!("an environment as JSON: {error}"))
        })
    };
    texts.map(one).collect()
}

fn read_results(table: &Table, cases: &[Case]) -> Result<Vec<Option<CaseResult>>, TableError> {
    let status = table.texts("status")?;
    let runs = table.optional_counts("run")?;
    let ended = table.optional_texts("ended")?;
    let left = table.optional_numbers("left_world_s")?;
    let messages = table.optional_texts("message")?;
    let measures = measures::read(table)?;
    let of_runs = measures::read_of_runs(table, &measures)?;
    let reruns = read_counts(table, ["reruns", "rerun_violations"])?;
    let draws = read_counts(table, ["draws", "draw_violations"])?;
    let violations = read_violations(table)?;
    let elsewhere = read_elsewhere(table)?;
    let drawn = drawn::read(table)?;
    let measured = measures.into_iter().zip(of_runs);
    let violated = violations.into_iter().zip(elsewhere);
    let rows = measured.zip(violated).zip(messages).zip(drawn).enumerate();
    rows.map(|(row, ((((measures, of_runs), (violations, elsewhere)), message), drawn))| {
        if status[row] == GENERATED {
            return Ok(None);
        }
        let bound = "generated, pass, fail, executor-failed or inconclusive";
        let status = Status::from_word(&status[row])
            .ok_or_else(|| table.refuse("status", row, format!("`{}`", status[row]), bound))?;
        // What violates is a fail, whatever else came of the case, and nothing else is one.
        if (status == Status::Fail) == violations.is_empty() {
            let bound = match violations.first() {
                Some(first) => format!("fail, as `violation_what` has {}", first.what),
                None => "another, as `violation_what` has nothing".into(),
            };
            return Err(table.refuse("status", row, format!("`{}`", status.word()), bound));
        }
        let run = runs[row].ok_or_else(|| table.refuse("run", row, "empty", "the number of the worst run"))?;
        let ended = ended[row].clone().unwrap_or_default();
        Ok(Some(CaseResult {
            case: cases[row].number,
            status,
            run,
            measures,
            of_runs,
            ended,
            left_world: left[row],
            violations,
            elsewhere,
            drawn,
            message,
            reruns: reruns[row].map(|[violated, of]| Reruns { violated, of }),
            draws: draws[row].map(|[violated, of]| Draws { violated, of }),
        }))
    })
    .collect()
}

/// How many runs violated, and of how many, from the columns of all and of those; tables without such runs, or of older
/// versions, do not say.
fn read_counts(table: &Table, [all, those]: [&str; 2]) -> Result<Vec<Option<[usize; 2]>>, TableError> {
    if !table.has(all) {
        return Ok(vec![None; table.rows()]);
    }
    let (of, violated) = (table.optional_counts(all)?, table.optional_counts(those)?);
    let both = |(row, (of, violated)): (usize, (Option<usize>, Option<usize>))| match (of, violated) {
        (Some(of), Some(violated)) if violated <= of => Ok(Some([violated, of])),
        (None, None) => Ok(None),
        (of, violated) => {
            let found = violated.map_or("empty".into(), |violated| violated.to_string());
            Err(table.refuse(those, row, found, format!("at most {}", of.unwrap_or(0))))
        }
    };
    of.into_iter().zip(violated).enumerate().map(both).collect()
}

/// What other runs than the worst violate; tables without such, or of older versions, do not say.
fn read_elsewhere(table: &Table) -> Result<Vec<Vec<String>>, TableError> {
    match table.has(ELSEWHERE) {
        true => Ok(table.text_lists(ELSEWHERE)?.into_iter().map(Option::unwrap_or_default).collect()),
        false => Ok(vec![Vec::new(); table.rows()]),
    }
}

fn read_violations(table: &Table) -> Result<Vec<Vec<Violation>>, TableError> {
    let texts = |column| Ok(table.text_lists(column)?.into_iter().map(Option::unwrap_or_default).collect());
    let what: Vec<Vec<String>> = texts("violation_what")?;
    let unit: Vec<Vec<String>> = texts("violation_unit")?;
    let value = complete_lists(table, "violation_value")?;
    let limit = complete_lists(table, "violation_limit")?;
    let at = complete_lists(table, "violation_t_s")?;
    let leg = complete_lists(table, "violation_leg")?;
    same_lengths(table, "violation_unit", &unit, &what)?;
    for (column, lists) in
        [("violation_value", &value), ("violation_limit", &limit), ("violation_t_s", &at), ("violation_leg", &leg)]
    {
        same_lengths(table, column, lists, &what)?;
    }
    let violation = |row: usize, i: usize| Violation {
        what: what[row][i].clone(),
        value: value[row][i],
        limit: limit[row][i],
        unit: unit[row][i].clone(),
        at: at[row][i],
        leg: leg[row][i].max(0.0) as usize,
    };
    Ok((0..table.rows()).map(|row| (0..what[row].len()).map(|i| violation(row, i)).collect()).collect())
}
