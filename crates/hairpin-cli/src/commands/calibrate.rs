//! `hairpin calibrate`: limits that follow from what is ordinary.

use hairpin::campaign::calibrate::{Proposal, spec};
use hairpin::campaign::digits;
use hairpin_formats::scenario;
use hairpin_jobs::calibrate::{CalibrateSettings, Calibrated, calibrate};
use hairpin_jobs::{Problem, Watch};
use serde_json::{Value, json};

use crate::args::Calibrate;
use crate::exit::{DONE, INCONCLUSIVE, NOTHING_FEASIBLE};
use crate::{console, settings};

/// Runs the command.
pub(crate) fn run(asked: &Calibrate, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    let settings = CalibrateSettings {
        scenario: asked.scenario.clone(),
        sets: settings::keys(&asked.keys, asked.executor.as_deref())?,
        share: asked.share,
        cases: asked.cases,
        simd: settings::simd(&asked.kernels),
        consent: settings::consent(&asked.commands),
    };
    let found = calibrate(&settings, watch)?;
    let code = match (found.proposals.iter().any(|one| one.value.is_some()), found.flown) {
        (true, _) => DONE,
        (false, 0) => NOTHING_FEASIBLE,
        (false, _) => INCONCLUSIVE,
    };
    if asked.json {
        console::say(&object(asked, &found, code).to_string())
    } else {
        tell(&found)
    }
    Ok(code)
}

/// The first limit by the contract's names, and all of them.
fn object(asked: &Calibrate, found: &Calibrated, code: u8) -> Value {
    let one = |it: &Proposal| {
        json!({
            "field": it.field, "value": it.value, "interval": it.interval,
            "cases": it.cases, "broken_by": it.broken_by, "reason": it.reason,
        })
    };
    let mut object = found.proposals.first().map_or_else(|| json!({}), one);
    object["share"] = json!(asked.share);
    object["flown"] = json!(found.flown);
    object["lost"] = json!(found.lost);
    object["trouble"] = json!(found.trouble);
    object["left_world"] = json!(found.left_world);
    object["fewer"] = json!(found.reason);
    object["limits"] = found.proposals.iter().map(one).collect();
    object["spec"] = json!(lines(found));
    object["exit_code"] = json!(code);
    object
}

/// `[spec]` to paste, and what stands behind each limit; where there is none, why.
fn tell(found: &Calibrated) {
    if let Some(reason) = &found.reason {
        console::warn(&format!("{} random feasible cases were found: {reason}", found.flown));
    }
    if found.lost > 0 {
        let trouble = found.trouble.as_ref().map_or(String::new(), |first| format!(": {first}"));
        console::warn(&format!("{} of {} cases were not flown, or cannot be judged{trouble}", found.lost, found.flown));
    }
    if found.left_world > 0 {
        console::warn(&format!(
            "{} of {} cases leave the world, which is a violation whatever the limit",
            found.left_world, found.flown
        ));
    }
    for one in &found.proposals {
        let Some(reason) = &one.reason else { continue };
        console::say(&format!("{}: no limit: {reason}", one.field));
    }
    let given: Vec<&Proposal> = found.proposals.iter().filter(|one| one.value.is_some()).collect();
    if given.is_empty() {
        return;
    }
    console::say("[spec]");
    for one in given {
        let share = digits::percent(one.broken_by.map(|cases| cases as f64 / one.cases.max(1) as f64));
        let ends = one.interval.unwrap_or_default().map(|end| digits::with_digits(end, one.digits));
        console::say(&format!(
            "# {share} of {} random feasible cases break {}, which lies between {} and {} (95 %)",
            one.cases, one.field, ends[0], ends[1]
        ));
    }
    lines(found).iter().for_each(|line| console::say(line));
}

/// The keys of `[spec]`, a line each.
fn lines(found: &Calibrated) -> Vec<String> {
    if found.proposals.iter().all(|one| one.value.is_none()) {
        return Vec::new();
    }
    spec(&found.setup, &found.proposals).iter().map(|(key, value)| scenario::on_a_line(key, value)).collect()
}
