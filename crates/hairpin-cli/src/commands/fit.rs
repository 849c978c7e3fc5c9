//! `hairpin fit`: numbers from logs, and what the logs do not show.

use hairpin::campaign::digits::{number, signed_digits};
use hairpin::campaign::fit::{Confounded, Deviation, Estimate, Gap, Reading};
use hairpin_jobs::fit::{FitSettings, Fitted, fit};
use hairpin_jobs::{Problem, Watch};
use serde_json::{Value, json};

use crate::args::Fit;
use crate::exit::{DONE, INCONCLUSIVE};
use crate::{console, settings};

/// Runs the command.
pub(crate) fn run(asked: &Fit, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    let settings = FitSettings {
        logs: asked.logs.clone(),
        robot: asked.robot.clone(),
        out: asked.out.clone(),
        mission: asked.mission.clone(),
        campaign: asked.campaign.clone(),
        sets: settings::keys(&asked.keys, None)?,
        hold_out: asked.holdout,
        simd: settings::simd(&asked.kernels),
    };
    let found = fit(&settings, watch)?;
    let code = if told(&found) == 0 || improves(&found) == Some(false) { INCONCLUSIVE } else { DONE };
    match asked.json {
        true => console::say(&object(asked, &found, code).to_string()),
        false => tell(asked, &found, code),
    }
    Ok(code)
}

fn told(found: &Fitted) -> usize {
    found.fit.estimates.iter().filter(|estimate| estimate.is_told()).count()
}

/// Whether the fit is nearer to logs that it has not seen than the robot as given; `None` where there are none.
fn improves(found: &Fitted) -> Option<bool> {
    found.fit.unseen.map(|[before, after]| after < before)
}

/// Why a number is not identifiable.
fn why(estimate: &Estimate) -> Option<String> {
    let reason = match estimate.reading {
        Reading::Told => return None,
        Reading::NoEffect => "nothing that was logged depends on it".to_owned(),
        Reading::Open => "the logs contradict no value up to a bound of it".to_owned(),
        Reading::Wide => "its interval is wider than 25 % on a side".to_owned(),
        Reading::Unlike => "simulations do not show what the logs do, whatever it is".to_owned(),
        Reading::Doubted => estimate.number.doubt.unwrap_or_default().to_owned(),
    };
    let given = estimate.number.value;
    let outside = estimate.interval.is_some_and(|[low, high]| !(low..=high).contains(&given));
    Some(if outside { format!("{reason}; the value as given lies outside of it") } else { reason })
}

fn object(asked: &Fit, found: &Fitted, code: u8) -> Value {
    let fit = &found.fit;
    let parameter = |estimate: &Estimate| {
        json!({
            "name": estimate.number.field, "unit": estimate.number.unit, "before": estimate.number.value,
            "value": estimate.value, "best": estimate.best, "interval": estimate.interval,
            "identifiable": estimate.is_told(), "reason": why(estimate),
            "evidence": if estimate.is_told() { "estimated" } else { "as given" },
            "interval_tried": fit.untried.is_none(),
        })
    };
    let deviation = |it: Deviation| json!({ "rmse_m": it.rmse_m, "max_m": it.max_m });
    let gap = |gap: &Gap| {
        json!({
            "log": gap.log, "mission": gap.mission, "before": deviation(gap.before), "after": deviation(gap.after),
            "unseen": gap.unseen.map(deviation),
        })
    };
    let confounded = fit.confounded.as_ref().map(|it| {
        let direction: serde_json::Map<_, _> =
            it.direction.iter().map(|(field, share)| ((*field).to_owned(), json!(share))).collect();
        json!({ "direction": direction, "relative_deviation": it.deviation })
    });
    json!({
        "robot": asked.out, "logs": found.logs, "logged_s": found.logged_s,
        "parameters": fit.estimates.iter().map(parameter).collect::<Vec<_>>(),
        "intervals_tried_on": fit.tried, "intervals_never_tried_with": fit.untried, "confounded": confounded, "execute": found.execute,
        "residual_m": fit.residual_m, "scatter_m": fit.scatter_m, "inflation": fit.inflation, "stretches": fit.stretches, "samples": fit.samples,
        "gap": fit.gaps.iter().map(gap).collect::<Vec<_>>(),
        "unseen": fit.unseen.map(|[before, after]| json!({ "before_rmse_m": before, "after_rmse_m": after, "improves": after < before })),
        "exit_code": code,
    })
}

fn tell(asked: &Fit, found: &Fitted, code: u8) {
    let fit = &found.fit;
    let all = fit.estimates.len();
    let (unit, per_m) = fit.unit;
    let unseen = fit.unseen.map(|unseen| unseen.map(|off| per_m * off));
    let words = match (code, unseen) {
        (DONE, Some([before, after])) => {
            format!(
                "FITTED {} of {all} numbers (estimated): {before:.3} {unit} from logs that the fit has not seen becomes {after:.3} {unit}",
                told(found)
            )
        }
        (DONE, None) => format!(
            "FITTED {} of {all} numbers (estimated): whether it helps on another log is not shown by one",
            told(found)
        ),
        (_, Some([before, after])) if told(found) > 0 => {
            format!(
                "INCONCLUSIVE: {} of {all} numbers are told, but {before:.3} {unit} from logs that the fit has not seen becomes {after:.3} {unit}",
                told(found)
            )
        }
        _ => format!("INCONCLUSIVE: none of {all} numbers is identifiable from these logs"),
    };
    console::say(&format!("{words}; {} logs, {:.0} s", found.logs, found.logged_s));
    let mut rows = vec![["number", "unit", "as given", "fitted", "95 %", ""].map(str::to_owned).to_vec()];
    for estimate in &fit.estimates {
        let interval = estimate.interval.map_or("–".into(), |ends| ends.map(signed_digits).join(" to "));
        let fitted = if estimate.is_told() { signed_digits(estimate.value) } else { "–".into() };
        let said = match (why(estimate), fit.untried) {
            (Some(why), _) => format!("not identifiable: {why}; kept"),
            (None, Some(who)) => format!("such intervals were never tried with `{who}`"),
            (None, None) => String::new(),
        };
        let number = &estimate.number;
        rows.push(vec![number.name.into(), number.unit.into(), signed_digits(number.value), fitted, interval, said]);
    }
    console::say_lines(&console::table(&rows));
    if told(found) > 0 {
        let others = fit.untried.map_or("of others it".into(), |who| format!("of `{who}`, which steers here, that"));
        console::say(&format!("Such intervals held on {}; {others} is not shown", fit.tried));
    }
    if let Some(scatter_m) = fit.scatter_m {
        let [left, scatter] = [fit.residual_m, scatter_m].map(|off| number(Some(per_m * off)));
        console::say(&format!(
            "The fit leaves {left} {unit} (rmse), the logs' scatter from sample to sample is {scatter} {unit}: whether {}, the \
             intervals do not tell",
            fit.undescribed
        ));
    }
    if let Some(Confounded { direction, deviation }) = &fit.confounded {
        let parts: Vec<String> = direction.iter().map(|(field, share)| format!("{share:+.2} {field}")).collect();
        console::say(&format!(
            "The logs tell least of {} together, in shares of each: ± {:.0} %",
            parts.join(" "),
            196.0 * deviation
        ));
    }
    let of = |it: Deviation| [it.rmse_m, it.max_m].map(|off| number(Some(per_m * off))).join(" / ");
    let given = format!("as given, {unit} (rmse / max)");
    let mut rows = vec![["log", given.as_str(), "fitted", "by a fit that has not seen it"].map(str::to_owned).to_vec()];
    for gap in &fit.gaps {
        rows.push(vec![gap.log.clone(), of(gap.before), of(gap.after), gap.unseen.map_or("–".into(), of)]);
    }
    console::say_lines(&console::table(&rows));
    console::say(&format!("{} written", asked.out.display()));
    if !found.execute.is_empty() {
        console::say("[execute]");
        found.execute.iter().for_each(|line| console::say(line));
    }
}
