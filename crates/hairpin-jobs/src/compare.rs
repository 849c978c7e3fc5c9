//! Two judged campaigns, paired by case and seed.

use std::collections::HashMap;
use std::path::Path;

use hairpin::campaign::report::{self, Beside, OtherRun, Pieces, ReportData, Shown};
use hairpin::campaign::{self, Case, CaseNumber, CaseResult, Comparison};
use hairpin::judgement::Verdict;

use crate::Problem;
use crate::differences::differences;
use crate::execute::{run_with_motion, why_lost};
use crate::names::listed;
use crate::work::{Work, open_to_read};

/// Two campaigns beside each other.
#[derive(Debug)]
pub struct Compared {
    /// Their cases.
    pub comparison: Comparison,
    /// Keys in which their scenarios differ.
    pub differences: Vec<String>,
}

/// Compares the judged campaigns in the folders `a` and `b` over the same cases. Deviations that differ by no more than
/// `tolerance_m` are unchanged.
///
/// # Errors
/// Folders that are no judged campaigns, of different kinds of robots, or without a case in common.
pub fn compare(a: &Path, b: &Path, tolerance_m: f64) -> Result<Compared, Problem> {
    let (before, after) = (open_to_read(a)?, open_to_read(b)?);
    let scenarios = [&before.setup.scenario, &after.setup.scenario];
    let differences = differences(scenarios[0], scenarios[1]);
    if std::mem::discriminant(scenarios[0]) != std::mem::discriminant(scenarios[1]) {
        return Err(Problem::input(format!(
            "{} and {} are of different kinds of robots ({} and {}): there is nothing to pair",
            a.display(),
            b.display(),
            before.setup.robot_name(),
            after.setup.robot_name()
        )));
    }
    let comparison = campaign::compare(&judged(&before, a)?, &judged(&after, b)?, tolerance_m);
    if comparison.pairs == 0 {
        return Err(Problem::input(format!(
            "no case of {a} has a partner in {b} with the same number, seed, waypoints and environment ({}): fly the same trajectories in \
             both under one --seed, such as by hairpin export {a} --to waypoints and hairpin execute {b} --missions {a}/missions",
            unpaired(&comparison),
            a = a.display(),
            b = b.display(),
        )));
    }
    Ok(Compared { comparison, differences })
}

/// Cases of a comparison that are drawn at most.
const DRAWN: usize = 200;

/// Writes the page of two campaigns that were [`compare`]d into `file`: the runs of B over those of A, newly failing
/// first, then what got worse the most.
///
/// # Errors
/// Runs that are not to be had any more; a file that cannot be read or written.
pub fn write_page(a: &Path, b: &Path, compared: &Comparison, file: &Path) -> Result<(), Problem> {
    let (before, after) = (open_to_read(a)?, open_to_read(b)?);
    let old: HashMap<CaseNumber, (Case, CaseResult)> =
        judged(&before, a)?.into_iter().map(|pair| (pair.0.number, pair)).collect();
    let mut new = judged(&after, b)?;
    new.retain(|(case, _)| {
        let same = |was: &Case| was.waypoints == case.waypoints && was.environment == case.environment;
        old.get(&case.number).is_some_and(|(was, _)| was.seed == case.seed && same(was))
    });
    let failing = |case: CaseNumber| compared.newly_failing.contains(&case.to_string());
    let deviation = |result: &CaseResult| result.measures.as_ref().map_or(0.0, |m| m.max_deviation);
    let worse = |result: &CaseResult| deviation(result) - old.get(&result.case).map_or(0.0, |(_, was)| deviation(was));
    new.sort_by(|(_, x), (_, y)| {
        failing(y.case).cmp(&failing(x.case)).then(worse(y).total_cmp(&worse(x))).then(x.case.cmp(&y.case))
    });
    let order: Vec<CaseNumber> = new.iter().map(|(case, _)| case.number).collect();
    let mut in_full = Vec::new();
    for (case, result) in new.iter().take(DRAWN) {
        let Some((case_before, was)) = old.get(&case.number) else { continue };
        let mut full = full(&after, case, result)?;
        let earlier = self::full(&before, case_before, was)?;
        let told = earlier.moment.as_ref().map_or(was.ended.as_str(), |moment| moment.told.as_str());
        full.environment.push(format!("A: {}, {told}", was.status.word()));
        full.others = (earlier.flown.map(|flown| OtherRun { run: was.run, flown, distances: earlier.distances }))
            .into_iter()
            .collect();
        in_full.push(full);
    }
    let (cases, results): (Vec<Case>, Vec<CaseResult>) = new.into_iter().unzip();
    let was: Vec<CaseResult> = order.iter().filter_map(|case| Some(old.get(case)?.1.clone())).collect();
    let told = after.told()?;
    let code = u8::from(!compared.newly_failing.is_empty());
    let sides = format!("(A {}, B {})", a.display(), b.display());
    let failing = format!("NEWLY FAILING {}/{}", compared.newly_failing.len(), compared.pairs);
    let verdict = Verdict::of(&format!("{failing} {sides}: {}", compared.sentence()), code);
    let data = report::assemble(Pieces {
        setup: &told,
        cases: &cases,
        results: &results,
        tally: &after.folder.read_tally()?,
        verdict,
        assumptions: vec!["A and B are judged each by its own folder's spec.".into()],
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
        beside: Beside { runs: "A, before", cases: "A, before" },
        key_numbers: vec![
            number("newly failing", compared.newly_failing.len(), compared.newly_failing.join(", ")),
            number("worse", compared.worse, format!("of {} pairs", compared.pairs)),
            number("better", compared.better, format!("{} unchanged", compared.unchanged)),
            number("newly passing", compared.newly_passing.len(), compared.newly_passing.join(", ")),
        ],
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
    report::shown(&work.told()?, &case, result, planned, run.as_ref(), &[]).map_err(Problem::input)
}

/// Every case with its result.
fn judged(work: &Work, path: &Path) -> Result<Vec<(Case, CaseResult)>, Problem> {
    let cases = work.folder.read_cases_without_profiles()?;
    let results = work.folder.read_results()?;
    if results.len() < cases.len() || cases.is_empty() {
        return Err(Problem::input(format!("not judged yet: hairpin judge {}", path.display())));
    }
    let mut results: HashMap<_, _> = results.into_iter().map(|result| (result.case, result)).collect();
    let pair = |case: Case| results.remove(&case.number).map(|result| (case, result));
    Ok(cases.into_iter().filter_map(pair).collect())
}

/// The cases without a partner, by why: `0003, 0007 (only in A); 0009 (other waypoints)`.
pub fn unpaired(compared: &Comparison) -> String {
    let whys = ["only in A", "only in B", "another seed", "other waypoints", "another environment"];
    let group = |why: &&str| {
        let names: Vec<String> =
            compared.unpaired.iter().filter(|one| one.why == *why).map(|one| one.case.clone()).collect();
        (!names.is_empty()).then(|| format!("{} ({why})", listed(&names)))
    };
    whys.iter().filter_map(group).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{executed, violating};

    #[test]
    fn a_campaign_is_equal_to_itself() {
        let (_place, folder) = violating();
        let compared = compare(&folder, &folder, 1e-6).unwrap();
        assert_eq!((compared.comparison.pairs, compared.differences.len()), (2, 0));
        assert!(!compared.comparison.regresses() && compared.comparison.newly_failing.is_empty());
        let file = folder.with_file_name("compared.html");
        write_page(&folder, &folder, &compared.comparison, &file).unwrap();
        let page = std::fs::read_to_string(file).unwrap();
        assert!(page.contains("A, before") && page.contains("A: fail, "), "both runs of each case");
    }

    #[test]
    fn what_is_not_judged_is_refused() {
        let (_place, folder) = executed();
        let refused = compare(&folder, &folder, 0.0).unwrap_err();
        assert!(refused.to_string().starts_with("not judged yet"), "{refused}");
    }
}
