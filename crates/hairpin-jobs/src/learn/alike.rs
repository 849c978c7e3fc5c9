//! Campaigns that one model is learned from: of one robot, executed and measured alike.

use std::path::{Path, PathBuf};

use hairpin::campaign::Scenario;
use hairpin::campaign::scenario::shapes_the_plan;
use serde_json::{Value, json};

use crate::Problem;
use crate::differences::differences;
use crate::work::{Work, open_as_made};

/// What of `execute` does not change what a leg comes to: how often, by how many and how long is executed, and what is
/// kept. Recordings have names of their own in every folder.
const OF_NO_LEG: [&str; 9] =
    ["baseline", "flaky", "logs", "processes", "record", "repeat", "time_limit_s", "timeout_s", "workers"];
/// What of `world` acts on every leg, wherever it is.
const ACTS_EVERYWHERE: [&str; 4] = ["discrete_gust", "gusts", "tool", "wind_m_s"];

/// The campaigns in `folders`, which are of one robot, were executed by one controller or program under the same keys,
/// and whose deviations are from one reference.
pub(super) fn open_alike(folders: &[PathBuf]) -> Result<Vec<Work>, Problem> {
    let works = folders.iter().map(|folder| open_as_made(folder)).collect::<Result<Vec<_>, Problem>>()?;
    let real = |folder: &Path| folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    for (place, work) in works.iter().enumerate().skip(1) {
        if folders[..place].iter().any(|before| real(before) == real(&folders[place])) {
            return Err(Problem::of_file(&folders[place], "is given twice: what it says would count twice"));
        }
        let (ours, theirs) = (of_whom(&works[0]), of_whom(work));
        let differs = theirs.into_iter().zip(ours).find(|((_, a), (_, b))| a != b);
        let differs = differs.map(|((what, theirs), (_, ours))| (what.to_owned(), theirs, ours));
        let differs = differs.or_else(|| otherwise(&work.setup.scenario, &works[0].setup.scenario));
        if let Some((what, theirs, ours)) = differs {
            let why =
                format!("its {what} is {theirs}, and that of {} is {ours}: one model is of one", folders[0].display());
            return Err(Problem::of_file(&folders[place], why));
        }
    }
    Ok(works)
}

/// Whose legs a campaign has, and who executed them.
fn of_whom(work: &Work) -> [(&'static str, String); 6] {
    let subject = work.setup.scenario.subject();
    let command = work.setup.scenario.executor().command.map_or("none".into(), |command| format!("`{command}`"));
    let recorded = at(&values(&work.setup.scenario), "execute.logs").is_some_and(|logs| !logs.is_null());
    [
        ("robot", format!("`{}`", subject.robot)),
        ("robot's numbers (BLAKE3)", subject.robot_hash),
        ("meaning of speeds", format!("`{}`", subject.speeds)),
        ("controller", format!("`{}`", subject.controller)),
        ("`execute.command`", command),
        ("executor", if recorded { "recordings (`execute.logs`)" } else { "no recordings" }.into()),
    ]
}

/// The first key by which legs of `ours` come to another stress than the same ones of `theirs`, in words, with both
/// values.
fn otherwise(theirs: &Scenario, ours: &Scenario) -> Option<(String, String, String)> {
    let [a, b] = [theirs, ours].map(values);
    let keys = differences(theirs, ours).into_iter().filter(|key| acts_on_legs(key));
    let told = |value: &Value, key: &str| at(value, key).filter(|value| !value.is_null()).map(Value::to_string);
    let key = keys.map(|key| {
        let [a, b] = [&a, &b].map(|values| told(values, &key).unwrap_or_else(|| "not given".into()));
        (format!("`{key}`"), a, b)
    });
    // What deviations are from where no limit says so.
    let references = [
        ("spec.deviation.from", json!("leg")),
        ("spec.deviation.corner_m", json!(0.0)),
        ("spec.path.from", json!("blended")),
    ];
    let reference = references.into_iter().filter_map(|(key, without)| {
        let [a, b] = [&a, &b].map(|values| at(values, key).unwrap_or(&without));
        (a != b).then(|| (format!("`{key}`"), a.to_string(), b.to_string()))
    });
    key.chain(reference).next()
}

/// Whether what a leg comes to hangs on this key, whatever the leg: who executes, and what is drawn for runs. Where
/// trajectories are, and what they pass, differs as it may.
fn acts_on_legs(key: &str) -> bool {
    let (table, rest) = key.split_once('.').unwrap_or((key, ""));
    let name = rest.split('.').next().unwrap_or_default();
    match table {
        "execute" => !OF_NO_LEG.contains(&name),
        "world" => ACTS_EVERYWHERE.contains(&name),
        "vary" => !shapes_the_plan(rest),
        _ => false,
    }
}

fn values(scenario: &Scenario) -> Value {
    serde_json::to_value(scenario).unwrap_or_default()
}

/// The value of a dotted key, of which parts may have dots of their own.
fn at<'v>(values: &'v Value, key: &str) -> Option<&'v Value> {
    let of_table = || {
        let mut places = key.match_indices('.').map(|(place, _)| place);
        places.find_map(|place| at(values.get(&key[..place])?, &key[place + 1..]))
    };
    values.get(key).or_else(of_table)
}
