//! "Assumptions and limits of this run", said from the run's own settings and numbers.

use super::kind::Assumptions;
use super::scenario::{SearchMethod, shapes_the_plan};
use super::{Case, Setup, Tally};

/// The sentences of the section, in the order of the pipeline: robot, claim, search, act, verdict.
pub fn assumptions(setup: &Setup, cases: &[Case], tally: &Tally) -> Vec<String> {
    let mut said = Vec::new();
    robot(setup, &mut said);
    let Assumptions { claim, search: own_search, beside, act, verdict } = setup.kind().assumptions(cases, tally);
    said.extend(claim);
    match own_search {
        Some(own) => said.extend(own),
        None => search(setup, cases, tally, beside, &mut said),
    }
    if let (Some(program), None) = (setup.program(), setup.controller()) {
        said.push(format!("Executed by {program}; legs are those that it reported."));
    }
    said.extend(act);
    runs(setup, &mut said);
    said.extend(tally.cut.iter().map(|cut| format!("The budget of time cut this campaign short: {cut}.")));
    said.extend(verdict);
    said.push("Leaving the world and a crash are violations whatever the spec says.".into());
    said.push("This is a test generator: what it writes is stressful by design and is no safety certificate.".into());
    said
}

fn robot(setup: &Setup, said: &mut Vec<String>) {
    let name = setup.robot_name();
    if !setup.caveat().is_empty() {
        said.push(format!("Robot `{name}`: {}.", setup.caveat().trim_end_matches('.')));
    }
    if !setup.estimated().is_empty() {
        said.push(format!("Estimated, not given, for robot `{name}`: {}.", setup.estimated().join(", ")));
    }
}

fn search(setup: &Setup, cases: &[Case], tally: &Tally, beside: Option<String>, said: &mut Vec<String>) {
    let search = setup.scenario.search();
    if !tally.missions.is_empty() {
        said.push(format!("Missions: {} waypoint files made elsewhere; nothing was searched.", tally.missions.len()));
        return;
    }
    let graphs = tally.graphs.max(cases.last().map_or(0, |case| case.graph + 1));
    let found = format!("{} of {} cases asked for", cases.len(), search.cases);
    if search.method == SearchMethod::Worst {
        let run = match tally.run {
            0 => "a nominal run".to_owned(),
            run => {
                format!("with the draws of one run (number {run}), which of the first ones stressed random cases most")
            }
        };
        said.push(format!(
            "Search: one pool of executions for all cases, each {}: what was executed decides what is tried next, and the worst \
             that differ are kept; no optimum is claimed; {found}, of {} executions, {} of them of trajectories drawn at random ({}).",
            run,
            tally.expansions,
            tally.drawn,
            tally.sampler.as_deref().unwrap_or("none"),
        ));
        if let Some(seconds) = search.seconds {
            said.push(format!(
                "The search had {seconds} s: what it found depends on the clock and is not reproducible."
            ));
        }
    } else {
        said.push(format!(
            "Search: {}; score `{}`; {found}, from {graphs} sampled graphs of {} waypoints.",
            in_graphs(setup, search.method),
            setup.scenario.score(),
            search.waypoints
        ));
    }
    if let Some(time) = search.time_s {
        said.push(format!(
            "The search had {time} s beside its {} executions: what it found depends on the clock and is not reproducible.",
            search.executions
        ));
    }
    if let Some(program) = setup.program().filter(|_| setup.scenario.executes()) {
        said.push(format!(
            "What the search executed was flown by {program}, each mission once; the judgement's runs were flown anew."
        ));
    }
    said.extend(beside);
    said.extend(tally.failures_in_words().map(|failed| {
        let since = if tally.failures.is_past { " Another executor has flown the cases since." } else { "" };
        format!("{failed}: no trajectory of these is among the cases, and what stress they have is not known.{since}")
    }));
    let made: u64 = tally.rounds.iter().map(|round| round.executions).sum();
    if search.method == SearchMethod::Adaptive && made < search.executions && search.time_s.is_none() && !tally.stopped
    {
        said.push(format!(
            "{made} of the search's {} executions were made: its graphs gave no further trajectories.",
            search.executions
        ));
    }
    for (number, round) in tally.rounds.iter().enumerate() {
        if let Some(reason) = &round.unlearned {
            said.push(format!("Round {number} of the search learned nothing and drew uniformly: {reason}."));
        }
    }
    if tally.dropped > 0 {
        said.push(format!(
            "The frontier was full: {} partial trajectories of least score were dropped.",
            tally.dropped
        ));
    }
    if let Some(length) = setup.scenario.length() {
        said.push(format!(
            "Length counts waypoints, start and end included: {length}. Waypoints are numbered from 0 = start."
        ));
    }
}

/// How graphs are searched by `method`, in a sentence's part.
fn in_graphs(setup: &Setup, method: SearchMethod) -> &'static str {
    match method {
        SearchMethod::Beam if setup.scenario.executes() => {
            "best-first with a beam that executes partial trajectories: scores are the stress of a nominal run, no optimum is claimed"
        }
        SearchMethod::Beam => "best-first with a beam: no optimum is claimed",
        SearchMethod::Exact => "exact in each sampled graph, over its waypoints only",
        SearchMethod::Uniform => "uniform over the feasible trajectories of each sampled graph",
        SearchMethod::InLoop => {
            "by executions in the loop: scores are the stress of a nominal run, no optimum is claimed"
        }
        SearchMethod::Adaptive | SearchMethod::Worst => {
            "in rounds of executing and learning: scores are the stress of a nominal run, no optimum is claimed"
        }
    }
}

fn runs(setup: &Setup, said: &mut Vec<String>) {
    let execute = setup.scenario.executor();
    let of_runs = setup.scenario.vary().keys().filter(|key| !shapes_the_plan(key));
    let varied: Vec<&str> = of_runs.map(String::as_str).collect();
    match (varied.is_empty(), execute.repeat) {
        (true, _) => {}
        (false, 1) => said.push(format!(
            "`[vary]` ({}) was not drawn: run 0 is nominal and `execute.repeat` is 1.",
            varied.join(", ")
        )),
        (false, repeat) => said.push(format!(
            "Run 0 of each case is nominal; {} drawn for the other {}.",
            varied.join(", "),
            repeat - 1
        )),
    }
}
