//! The proof that an arm's first program is the heaviest: kept beside the graph, and checked against it by independent
//! code.
//!
//! `optimum.json` is a certificate as of `max-load --certificate`, of the graph in `graph.csv`, of its arcs in
//! `arcs.csv` where it has any, and, where home can be left for or reached from some points only, two points more:
//! `from_home` and `to_home` say which. `decimals` are those of the graph's unit that its whole numbers stand for.

use std::fs;

use hairpin::campaign::arm::{ArmGraph, ArmSetup, graph_of};
use hairpin::campaign::{Case, CaseNumber, Stop};
use hairpin_formats::folder::{ARCS, GRAPH, OPTIMUM, graph_decimals};
use hairpin_formats::{arcs, atomic, bounds, costs};
use serde::Serialize;
use serde_json::{Value, json};

use crate::work::Work;
use crate::{Problem, certificate};

/// What a check of the folder's came to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Optimum {
    /// Steps of the branching tree; `None` where the path was searched again.
    pub steps: Option<usize>,
    /// What does not hold.
    pub findings: Vec<String>,
}

/// Writes the proof, where the first case claims to be optimal; whether it is proven then, or claims nothing.
pub(crate) fn keep(
    work: &Work,
    arm: &ArmSetup,
    graph: &ArmGraph,
    cases: &[Case],
    stop: &Stop,
) -> Result<bool, Problem> {
    let path = work.folder.file(OPTIMUM);
    let claimed = cases.first().is_some_and(|case| case.gap().is_some_and(|gap| gap <= 1e-9));
    let found = if claimed { arm.optimum(graph, stop).map_err(Problem::input)? } else { None };
    let Some((question, found, walk)) = found else {
        return match fs::remove_file(&path) {
            Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => Err(Problem::of_file(&path, cause)),
            _ => Ok(!claimed),
        };
    };
    let Some(mut object) = certificate::object(question.points, question.ends, &found, walk.as_ref()) else {
        return Ok(true);
    };
    object["decimals"] = graph_decimals(graph).into();
    if question.points > graph.points() {
        let rows = |may: &dyn Fn(usize) -> bool| (0..graph.points()).filter(|row| may(*row)).collect::<Vec<_>>();
        object["from_home"] = json!(rows(&|row| question.costs[graph.points() * question.points + row].is_some()));
        object["to_home"] = json!(rows(&|row| question.costs[row * question.points + graph.points() + 1].is_some()));
    }
    atomic::write(&path, certificate::sealed(object).as_bytes())?;
    Ok(true)
}

/// Checks the folder's, if it has one: that it is of this graph and of the first program, and that no path is heavier.
/// Where the first case claims to be optimal and there is none, that is a finding.
pub(crate) fn verify(work: &Work, arm: &ArmSetup, cases: &[Case]) -> Option<Optimum> {
    // A choice of cases may have left it out.
    let first = cases.first().filter(|case| case.number == CaseNumber(0))?;
    let claimed = first.gap().is_some_and(|gap| gap <= 1e-9);
    let path = work.folder.file(OPTIMUM);
    if !path.is_file() {
        let missing = || Optimum {
            steps: None,
            findings: vec![format!("{OPTIMUM} is missing, and case {} claims to be optimal", first.id())],
        };
        return claimed.then(missing);
    }
    let checked = check(work, arm, first);
    Some(checked.unwrap_or_else(|what| Optimum { steps: None, findings: vec![what] }))
}

fn check(work: &Work, arm: &ArmSetup, first: &Case) -> Result<Optimum, String> {
    let text = bounds::read_json_text(&work.folder.file(OPTIMUM))
        .map_err(|cause| format!("{OPTIMUM} cannot be read: {cause}"))?;
    let object: Value = serde_json::from_str(&text).map_err(|error| format!("{OPTIMUM} is no JSON: {error}"))?;
    let decimals = object["decimals"].as_u64().map_or(0, |decimals| decimals.min(18) as usize);
    let table = costs::read_in(&work.folder.file(GRAPH), decimals).map_err(|error| error.to_string())?;
    let n = table.points;
    let arcs = work.folder.file(ARCS);
    let arcs = arcs.is_file().then(|| arcs::read(&arcs, decimals)).transpose().map_err(|error| error.to_string())?;
    let rows = |key: &str| -> Option<Vec<usize>> {
        let rows = object.get(key)?.as_array()?;
        rows.iter().map(|row| usize::try_from(row.as_u64()?).ok()).collect()
    };
    let costs = match (rows("from_home"), rows("to_home")) {
        (Some(from_home), Some(to_home)) => {
            let arc = |from: usize, to: usize| match (from, to) {
                (from, to) if from < n && to < n => table.costs[from * n + to],
                (from, to) if from == n && from_home.contains(&to) => Some(0),
                (from, to) if to == n + 1 && to_home.contains(&from) => Some(0),
                _ => None,
            };
            (0..(n + 2) * (n + 2)).map(|index| arc(index / (n + 2), index % (n + 2))).collect()
        }
        _ => table.costs.clone(),
    };
    let asked = of_scenario(arm, &object, decimals, &costs);
    let checked =
        certificate::check(&object, costs, arcs).ok_or_else(|| format!("{OPTIMUM} is no certificate of this graph"))?;
    let mut findings: Vec<String> = checked.findings.iter().map(|what| format!("{OPTIMUM}: {what}")).collect();
    findings.extend(asked);
    let visits = arm.scenario.generate.search.visits;
    if checked.visits as u64 != visits {
        let said = checked.visits;
        findings.push(format!("{OPTIMUM}: points come {said} times at most, generate.search.visits = {visits}"));
    }
    let names = |row: &Value| row.as_u64().filter(|row| (*row as usize) < n).map(|row| arm.point_name(row as usize));
    let proven: Vec<String> = object["path"].as_array().into_iter().flatten().filter_map(names).collect();
    let mut first = first.clone();
    work.folder.read_witness(&mut first).map_err(|error| error.to_string())?;
    let moves = first.program().map_or(&[][..], |program| &program.moves);
    let written: Vec<String> =
        moves.iter().flat_map(|m| m.motion.poses()).filter_map(|target| target.name.clone()).collect();
    if proven != written {
        findings.push(format!(
            "{OPTIMUM}: its path is {}, that of the program {}",
            proven.join(" "),
            written.join(" ")
        ));
    }
    let told = checked.cost as f64 / table.scale() as f64;
    if (told - first.score).abs() > 1e-6 * first.score.abs().max(1.0) {
        findings.push(format!("{OPTIMUM}: its path costs {told}, the case says {}", first.score));
    }
    Ok(Optimum { steps: checked.steps, findings })
}

/// What of the question that the object answers is not what the scenario asks now: the graph with its moves from and to
/// home, and the ends.
fn of_scenario(arm: &ArmSetup, object: &Value, decimals: usize, costs: &[Option<i64>]) -> Vec<String> {
    // Without a graph no program holds, and each says so.
    let Ok(graph) = graph_of(arm) else { return Vec::new() };
    let question = arm.question(&graph);
    let mut findings = Vec::new();
    if decimals != graph_decimals(&graph) || costs != question.costs {
        findings.push(format!("{OPTIMUM}: it is of another graph than the scenario's"));
    }
    for (key, asked) in [("start", question.ends.start), ("end", question.ends.end)] {
        let said = object[key].as_u64();
        if said != asked.map(|row| row as u64) {
            let told = |row: Option<u64>| row.map_or("any point".into(), |row| format!("row {row}"));
            let (said, asked) = (told(said), told(asked.map(|row| row as u64)));
            findings.push(format!("{OPTIMUM}: its {key} is {said}, the scenario's {asked} (generate.search.{key})"));
        }
    }
    findings
}
