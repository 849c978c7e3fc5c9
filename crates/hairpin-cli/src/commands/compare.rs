//! `hairpin compare`: two campaign folders, paired by case and seed.

use std::path::Path;

use hairpin::campaign::digits::number;
use hairpin::campaign::{Case, CaseResult, Comparison, compare};
use serde_json::json;

use crate::args::{Compare, FailOn};
use crate::folder::{self, Work};
use crate::problem::Problem;
use crate::{console, folder::look};

/// Exit code where pairs there are, and none of them could be compared.
const INCONCLUSIVE: u8 = 5;

/// Runs the command: 0, or 1 on newly failing cases and, where that was asked for, on regression; 5 where no pair could be compared.
pub(crate) fn run(asked: &Compare) -> Result<u8, Problem> {
    let (a, b) = (look(&asked.a)?, look(&asked.b)?);
    let differences = folder::differences(&a.setup.scenario, &b.setup.scenario);
    if std::mem::discriminant(&a.setup.scenario) != std::mem::discriminant(&b.setup.scenario) {
        return Err(Problem::input(format!(
            "{} and {} are of different kinds of robots ({} and {}): there is nothing to pair",
            asked.a.display(),
            asked.b.display(),
            a.setup.robot_name(),
            b.setup.robot_name()
        )));
    }
    let compared = compare(&judged(&a, &asked.a)?, &judged(&b, &asked.b)?, asked.tolerance_m);
    if compared.pairs == 0 {
        return Err(Problem::input(format!(
            "no case of {a} has a partner in {b} with the same number, seed, waypoints and environment ({}): fly the same trajectories in \
             both under one --seed, such as by hairpin export {a} --to waypoints and hairpin execute {b} --missions {a}/missions",
            reasons(&compared),
            a = asked.a.display(),
            b = asked.b.display(),
        )));
    }
    let regression = asked.fail_on == FailOn::Regression && compared.regresses();
    let worse = u8::from(!compared.newly_failing.is_empty() || regression);
    let code = if compared.inconclusive() { INCONCLUSIVE } else { worse };
    if asked.json {
        let mut object = json!(compared);
        object["verdict"] = json!(compared.sentence());
        object["exit_code"] = json!(code);
        object["regression"] = json!(compared.regresses());
        object["scenario_differences"] = json!(differences);
        console::say(&object.to_string());
    } else {
        tell(&compared, &differences);
    }
    Ok(code)
}

/// Every case with its result.
fn judged(work: &Work, path: &Path) -> Result<Vec<(Case, CaseResult)>, Problem> {
    let cases = work.folder.read_cases_without_profiles()?;
    let mut results = work.folder.read_results()?;
    if results.len() < cases.len() || cases.is_empty() {
        return Err(Problem::input(format!("not judged yet: hairpin judge {}", path.display())));
    }
    let pair = |case: Case| {
        let index = results.iter().position(|result| result.case == case.number)?;
        Some((case, results.swap_remove(index)))
    };
    Ok(cases.into_iter().filter_map(pair).collect())
}

fn tell(compared: &Comparison, differences: &[String]) {
    if !differences.is_empty() {
        console::warn(&format!("the scenarios differ in {}", console::some(differences)));
    }
    if differences.iter().any(|key| key.starts_with("spec.")) {
        console::warn("Warning: what passes and fails is by each folder's own spec");
    }
    let header =
        ["metric", "pairs", "median A", "median B", "B − A", "95 %", "rank biserial", "p", "p (Holm)", "change"];
    let rows = compared.metrics.iter().map(|metric| {
        let interval =
            metric.interval.map_or("–".into(), |[low, high]| format!("[{}, {}]", signed(low), signed(high)));
        vec![
            metric.metric.into(),
            metric.pairs.to_string(),
            number(Some(metric.median_a)),
            number(Some(metric.median_b)),
            signed(metric.median_difference),
            interval,
            format!("{:+.2}", metric.rank_biserial),
            probability(metric.p),
            probability(metric.p_holm),
            metric.change.into(),
        ]
    });
    let header = header.map(str::to_owned).to_vec();
    console::say(&console::table(&std::iter::once(header).chain(rows).collect::<Vec<_>>()));
    let exact = compared.metrics.iter().all(|metric| metric.test == "exact");
    let test = if exact { "exact, ties included" } else { "normal approximation where more than 50 pairs differ" };
    console::say(&format!(
        "B − A: median of the paired differences; effect size: matched-pairs rank biserial correlation; \
         p: Wilcoxon signed-rank test, two-sided, {test}\n"
    ));
    for (what, names) in [
        ("newly failing", &compared.newly_failing),
        ("newly passing", &compared.newly_passing),
        ("not compared (executor failed or inconclusive)", &compared.undecided),
    ] {
        if !names.is_empty() {
            console::say(&format!("{what}: {}", console::some(names)));
        }
    }
    if !compared.unpaired.is_empty() {
        console::say(&format!("not paired: {}", reasons(compared)));
    }
    console::say(&compared.sentence());
}

/// `0003, 0007 (only in A); 0009 (other waypoints)`.
fn reasons(compared: &Comparison) -> String {
    let whys = ["only in A", "only in B", "another seed", "other waypoints", "another environment"];
    let group = |why: &&str| {
        let names: Vec<String> =
            compared.unpaired.iter().filter(|one| one.why == *why).map(|one| one.case.clone()).collect();
        (!names.is_empty()).then(|| format!("{} ({why})", console::some(&names)))
    };
    whys.iter().filter_map(group).collect::<Vec<_>>().join("; ")
}

fn signed(value: f64) -> String {
    let size = number(Some(value));
    if value > 0.0 { format!("+{size}") } else { size }
}

fn probability(p: f64) -> String {
    if p < 1e-4 { "< 0.0001".into() } else { format!("{p:.4}") }
}
