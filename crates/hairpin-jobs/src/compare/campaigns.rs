//! Two judged campaigns, paired by case and seed.

use std::collections::HashMap;
use std::path::Path;

use hairpin::campaign::scenario::DeviationFrom;
use hairpin::campaign::{self, Case, CaseResult, Comparison};

use crate::Problem;
use crate::differences::differences;
use crate::names::listed;
use crate::work::{Work, no_contradiction, of_another_version, open_as_made};

/// Two campaigns beside each other.
#[derive(Debug)]
pub struct Compared {
    /// Their cases.
    pub comparison: Comparison,
    /// Keys in which their scenarios differ.
    pub differences: Vec<String>,
    /// Which of them another version of hairpin made, a sentence each.
    pub told: Vec<String>,
}

/// Compares the judged campaigns in the folders `a` and `b` over the same cases. Deviations that differ by no more than
/// `tolerance_m` are unchanged.
///
/// # Errors
/// Folders that are no judged campaigns, of different kinds of robots, whose deviations are from different references,
/// or without a case in common.
pub fn compare(a: &Path, b: &Path, tolerance_m: f64) -> Result<Compared, Problem> {
    let (before, after) = (open_as_made(a)?, open_as_made(b)?);
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
    same_reference((&before, a), (&after, b))?;
    let comparison = campaign::compare(&judged(&before, a)?, &judged(&after, b)?, tolerance_m);
    if comparison.pairs == 0 {
        let (a, b) = (a.display(), b.display());
        // An arm's cases are programs: waypoints cannot take their place.
        let how = match before.setup.has_programs() {
            true => format!("run the same programs in both, such as by hairpin execute {a} --out DIR"),
            false => format!(
                "fly the same trajectories in both under one --seed, such as by hairpin export {a} --to waypoints and hairpin \
                 execute {b} --missions {a}/export"
            ),
        };
        return Err(Problem::input(format!(
            "no case of {a} has a partner in {b} with the same number, seed, waypoints and environment ({}): {how}",
            unpaired(&comparison),
        )));
    }
    let versions = [of_another_version(&before.folder)?, of_another_version(&after.folder)?];
    Ok(Compared { comparison, differences, told: versions.into_iter().flatten().collect() })
}

/// The pairs of two campaigns, A first, in the order of B's cases.
pub(super) fn pairs(
    (before, a): (&Work, &Path),
    (after, b): (&Work, &Path),
) -> Result<Vec<[(Case, CaseResult); 2]>, Problem> {
    same_reference((before, a), (after, b))?;
    let mut old: HashMap<_, _> = judged(before, a)?.into_iter().map(|pair| (pair.0.number, pair)).collect();
    let mut found = Vec::new();
    for new in judged(after, b)? {
        let case = &new.0;
        let same = |(was, _): &(Case, CaseResult)| {
            was.seed == case.seed && was.waypoints == case.waypoints && was.environment == case.environment
        };
        if let Some(was) = old.remove(&case.number).filter(same) {
            found.push([was, new]);
        }
    }
    Ok(found)
}

/// That deviations of both are distances from the same: a leg, the nearest leg (either but for the corners), or a path.
fn same_reference((before, a): (&Work, &Path), (after, b): (&Work, &Path)) -> Result<(), Problem> {
    let reference = |work: &Work| {
        let terms = work.setup.scenario.head().terms;
        // A path is judged everywhere.
        let corner = if terms.from == DeviationFrom::Path { 0.0 } else { terms.corner };
        (terms.from, corner)
    };
    let (old, new) = (reference(before), reference(after));
    if old == new {
        return Ok(());
    }
    let told = |(from, corner): (DeviationFrom, f64)| match from {
        DeviationFrom::Path => "the path".to_owned(),
        DeviationFrom::Leg => format!("the leg, beyond {corner} m about waypoints"),
        DeviationFrom::NearestLeg => format!("the nearest leg, beyond {corner} m about waypoints"),
    };
    Err(Problem::input(format!(
        "deviations of {} are from {}, those of {} from {}: they are not one measure. Judge both alike, by hairpin judge \
         --set of `from` and `corner_m`",
        a.display(),
        told(old),
        b.display(),
        told(new)
    )))
}

/// Every case with its result.
fn judged(work: &Work, path: &Path) -> Result<Vec<(Case, CaseResult)>, Problem> {
    let cases = work.folder.read_cases_without_profiles()?;
    let results = work.folder.read_results()?;
    if results.len() < cases.len() {
        return Err(Problem::input(format!("not judged yet: hairpin judge {}", path.display())));
    }
    if cases.is_empty() {
        return Err(Problem::input(format!("{} has no case: there is nothing to compare", path.display())));
    }
    no_contradiction(&work.folder, &work.setup, &results)?;
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
    use crate::judge::judge;
    use crate::testing::executed;

    /// A distance from a leg and one from a path are two measures: none of them is the better.
    #[test]
    fn deviations_from_different_references_are_not_compared() {
        let ((_a, a), (_b, b)) = (executed(), executed());
        let judged = |folder: &Path, from: &str, corner: &str| {
            let spec = format!("{{ max_m = 50, from = \"{from}\", corner_m = {corner} }}");
            judge(folder, &[("spec.deviation".to_owned(), spec)]).unwrap();
        };
        judged(&a, "leg", "1.0");
        for (from, corner, told) in [("path", "1.0", "from the path"), ("leg", "0.25", "beyond 0.25 m about waypoints")]
        {
            judged(&b, from, corner);
            let refused = compare(&a, &b, 0.0).map(drop).unwrap_err().to_string();
            assert!(refused.contains("beyond 1 m about waypoints") && refused.contains(told), "{refused}");
        }
        judged(&b, "leg", "1.0");
        assert_eq!(compare(&a, &b, 0.0).unwrap().comparison.unchanged, 2);
    }
}
