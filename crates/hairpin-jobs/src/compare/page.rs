//! The page of two campaigns: the runs of B over those of A.

use std::path::Path;

use hairpin::campaign::report::{self, Beside, Drawn, OtherRun, Pieces, ReportData, Shown};
use hairpin::campaign::{Case, CaseNumber, CaseResult};
use hairpin::judgement::Verdict;
use hairpin_formats::folder::refuse_own;

use super::campaigns::{Compared, pairs};
use crate::Problem;
use crate::execute::{run_with_motion, why_lost};
use crate::work::{Work, open_as_made};

/// Cases of a comparison that are drawn at most.
const DRAWN: usize = 200;

/// Writes the page of two campaigns that were [`super::compare`]d into `file`: the runs of B over those of A, newly
/// failing first, then what got worse the most.
///
/// # Errors
/// Runs that are not to be had any more; a file that cannot be read or written.
pub fn write_page(a: &Path, b: &Path, found: &Compared, file: &Path) -> Result<(), Problem> {
    refuse_own(file)?;
    let Compared { comparison: compared, differences, told: versions } = found;
    let (before, after) = (open_as_made(a)?, open_as_made(b)?);
    let mut pairs = pairs((&before, a), (&after, b))?;
    let failing = |case: CaseNumber| compared.newly_failing.contains(&case.to_string());
    let deviation = |result: &CaseResult| result.measured().map_or(0.0, |m| m.max_deviation);
    let worse = |[was, new]: &[(Case, CaseResult); 2]| deviation(&new.1) - deviation(&was.1);
    pairs.sort_by(|x, y| {
        let (p, q) = (x[1].0.number, y[1].0.number);
        failing(q).cmp(&failing(p)).then(worse(y).total_cmp(&worse(x))).then(p.cmp(&q))
    });
    let order: Vec<CaseNumber> = pairs.iter().map(|[_, (case, _)]| case.number).collect();
    let mut in_full = Vec::new();
    for [(case_before, was), (case, result)] in pairs.iter().take(DRAWN) {
        let mut full = full(&after, case, result)?;
        let earlier = self::full(&before, case_before, was)?;
        let told = earlier.moment.as_ref().map_or(was.ended.as_str(), |moment| moment.told.as_str());
        full.environment.push(format!("A: {}, {told}", was.status.word()));
        full.others = (earlier.flown.map(|flown| OtherRun { run: was.run, flown, distances: earlier.distances }))
            .into_iter()
            .collect();
        in_full.push(full);
    }
    let (was, new): (Vec<_>, Vec<_>) = pairs.into_iter().map(|[was, new]| (was, new)).unzip();
    let (cases, results): (Vec<Case>, Vec<CaseResult>) = new.into_iter().unzip();
    let was: Vec<CaseResult> = was.into_iter().map(|(_, result)| result).collect();
    let told = after.told()?;
    let code = u8::from(!compared.newly_failing.is_empty());
    let sides = format!("(A {}, B {})", a.display(), b.display());
    let failing = format!("NEWLY FAILING {}/{}", compared.newly_failing.len(), compared.pairs);
    let verdict = Verdict::of(&format!("{failing} {sides}: {}", compared.sentence()), code);
    let data = report::assemble(Pieces {
        setup: &told,
        cases: &cases,
        results: &results,
        tally: None,
        verdict,
        assumptions: said(differences).into_iter().chain(versions.iter().map(|one| format!("{one}."))).collect(),
        shown: in_full,
        frame: Vec::new(),
        influences: Vec::new(),
        coverage: None,
        baseline: None,
        random: &was,
        asked: None,
    });
    let number = |label: &str, count: usize, note: String| [label.to_owned(), count.to_string(), note];
    let data = ReportData {
        beside: Beside { runs: "A, before", cases: "A, before", shown: "B, after" },
        folder: Some(b.display().to_string()),
        key_numbers: vec![
            number("newly failing", compared.newly_failing.len(), compared.newly_failing.join(", ")),
            number("worse", compared.worse, format!("of {} pairs", compared.pairs)),
            number("better", compared.better, format!("{} unchanged", compared.unchanged)),
            number("newly passing", compared.newly_passing.len(), compared.newly_passing.join(", ")),
        ]
        .into_iter()
        .chain((!differences.is_empty()).then(|| number("keys that differ", differences.len(), differences.join(", "))))
        .collect(),
        ..report::in_order(&data, &order)
    };
    Ok(hairpin_formats::report::write(file, &data)?)
}

/// A case with its worst run, where that is to be had.
fn full(work: &Work, case: &Case, result: &CaseResult) -> Result<Shown, Problem> {
    let mut case = case.clone();
    work.folder.read_witness(&mut case)?;
    let planned = work.folder.read_planned(case.number)?;
    let run = match why_lost(work, &case, result.run)? {
        Some(_) => None,
        None => run_with_motion(work, &case, result.run)?,
    };
    report::shown(&work.told()?, &case, result, planned, run.as_ref().map(Drawn::from), &[]).map_err(Problem::input)
}

/// What is told of two scenarios that differ in these keys, beside that each judges its own.
fn said(differences: &[String]) -> Vec<String> {
    let mut said = vec!["A and B are judged each by its own folder's spec.".to_owned()];
    if !differences.is_empty() {
        said.push(format!("The scenarios differ in {}.", differences.join(", ")));
    }
    said.extend(of_spec(differences).map(|warning| format!("{warning}.")));
    said
}

/// What has to be known where the specs of both sides are not the same; `None` where they are.
pub fn of_spec(differences: &[String]) -> Option<&'static str> {
    let differ = differences.iter().any(|key| key.starts_with("spec."));
    differ.then_some("The specs differ: what passes and fails is by each folder's own spec")
}
