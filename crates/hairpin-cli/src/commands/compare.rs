//! `hairpin compare`: two campaign folders, paired by case and seed.

use hairpin::campaign::Comparison;
use hairpin::campaign::digits::number;
use hairpin_jobs::Problem;
use hairpin_jobs::compare::{Compared, compare, junit_text, of_spec, unpaired, write_page};
use hairpin_jobs::names::listed;
use serde_json::json;

use super::junit;
use crate::args::{Compare, FailOn};
use crate::console;
use crate::exit::{DONE, FINDING, INCONCLUSIVE};

/// Runs the command: 0, or 1 on newly failing cases and, where that was asked for, on regression; 5 where no pair could
/// be compared.
pub(crate) fn run(asked: &Compare) -> Result<u8, Problem> {
    junit::check(asked.junit.as_deref())?;
    let found = compare(&asked.a, &asked.b, asked.tolerance_m)?;
    let Compared { comparison: compared, differences, told } = &found;
    told.iter().for_each(|line| console::warn(&format!("Note: {line}")));
    let of_metrics = asked.fail_on == FailOn::Regression;
    let regression = of_metrics && compared.regresses();
    let code = match (compared.inconclusive(), !compared.newly_failing.is_empty() || regression) {
        (true, _) => INCONCLUSIVE,
        (false, true) => FINDING,
        (false, false) => DONE,
    };
    if let Some(file) = &asked.page {
        write_page(&asked.a, &asked.b, &found, file)?;
    }
    if let Some(file) = &asked.junit {
        junit::write(file, junit_text(&asked.a, &asked.b, &found, of_metrics)?.as_bytes())?;
    }
    if asked.json {
        let mut object = json!(compared);
        object["verdict"] = json!(compared.sentence());
        object["exit_code"] = json!(code);
        object["regression"] = json!(compared.regresses());
        object["scenario_differences"] = json!(differences);
        object["notes"] = json!(told);
        console::say(&object.to_string());
    } else {
        in_words(compared, differences);
    }
    Ok(code)
}

fn in_words(compared: &Comparison, differences: &[String]) {
    if !differences.is_empty() {
        console::warn(&format!("the scenarios differ in {}", listed(differences)));
    }
    if let Some(warning) = of_spec(differences) {
        console::warn(&format!("Warning: {warning}"));
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
    console::say_lines(&console::table(&std::iter::once(header).chain(rows).collect::<Vec<_>>()));
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
            console::say(&format!("{what}: {}", listed(names)));
        }
    }
    if !compared.unpaired.is_empty() {
        console::say(&format!("not paired: {}", unpaired(compared)));
    }
    console::say(&compared.sentence());
}

fn signed(value: f64) -> String {
    let size = number(Some(value));
    if value > 0.0 { format!("+{size}") } else { size }
}

fn probability(p: f64) -> String {
    if p < 1e-4 { "< 0.0001".into() } else { format!("{p:.4}") }
}
