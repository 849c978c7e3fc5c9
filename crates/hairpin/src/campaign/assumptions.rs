//! "Assumptions and limits of this run", said from the run's own settings and numbers.

use super::scenario::{DeviationFrom, EstimatedAttitude, EstimatedVelocity, ReachName, SearchMethod, Timing};
use super::{Case, Setup, Tally};

/// The sentences of the section, in the order of the pipeline: robot, claim, search, act, verdict.
pub fn assumptions(setup: &Setup, cases: &[Case], tally: &Tally) -> Vec<String> {
    let mut said = Vec::new();
    robot(setup, &mut said);
    claim(setup, cases, &mut said);
    search(setup, cases, tally, &mut said);
    act(setup, &mut said);
    verdict(setup, &mut said);
    said.push("This is a test generator: what it writes is stressful by design and is no safety certificate.".into());
    said
}

fn robot(setup: &Setup, said: &mut Vec<String>) {
    let robot = &setup.robot;
    if !robot.caveat.is_empty() {
        said.push(format!("Robot `{}`: {}.", robot.name, robot.caveat.trim_end_matches('.')));
    }
    if !robot.estimated.is_empty() {
        said.push(format!("Estimated, not given, for robot `{}`: {}.", robot.name, robot.estimated.join(", ")));
    }
}

fn claim(setup: &Setup, cases: &[Case], said: &mut Vec<String>) {
    let generate = &setup.scenario.generate;
    said.push(match generate.reach {
        ReachName::None => "Reach `none`: every waypoint counts as reachable; nothing is claimed.".into(),
        ReachName::Sphere => format!(
            "Reach `sphere`: a ball of radius top speed ({} m/s) times step; a necessary condition at best, nothing is \
             claimed.",
            setup.robot.max_speed
        ),
        ReachName::Hull => "Reach `hull`: `hull-feasible` is a geometric filter, neither sound nor complete: a convex \
                            hull of sampled end points is not a set of reachable points; drag and rotor lag are off in it."
            .into(),
        ReachName::Published => "Reach `published`: one Euler step, as the paper's program has it, for comparison only; \
                                 its angles alias."
            .into(),
        ReachName::Witness => "Reach `witness`: each leg starts and ends level and has rotor speeds within limits all \
                               along, with drag, for the model; rotor lag and wind are outside the claim; no flips are \
                               found."
            .into(),
    });
    if !matches!(generate.reach, ReachName::Witness) {
        let velocity = match generate.estimate.velocity {
            EstimatedVelocity::Average => "leg over step",
            EstimatedVelocity::Zero => "zero",
        };
        let attitude = match generate.estimate.attitude {
            EstimatedAttitude::Level => "level",
            EstimatedAttitude::Keep => "kept from the nearest sample",
        };
        said.push(format!("State assumed at a waypoint: velocity {velocity}, attitude {attitude}."));
        if generate.limits.max_tilt_deg.is_some() {
            said.push(format!("`max_tilt_deg` is not checked by reach `{}`.", generate.reach.word()));
        }
    }
    if let Some(Timing { step_s: Some(step), .. }) = generate.timing {
        said.push(format!("Every leg is planned to take {step} s."));
    }
    let certified: Vec<_> = cases.iter().filter_map(|case| case.certified).collect();
    if !certified.is_empty() {
        let count = |answer: &str| certified.iter().filter(|found| **found == answer).count();
        said.push(format!(
            "Certified afterwards: {} yes, with leg times of the witness, {} no, {} unknown of {}.",
            count("yes"),
            count("no"),
            count("unknown"),
            certified.len()
        ));
    }
}

fn search(setup: &Setup, cases: &[Case], tally: &Tally, said: &mut Vec<String>) {
    let generate = &setup.scenario.generate;
    let search = &generate.search;
    if !tally.missions.is_empty() {
        said.push(format!("Missions: {} waypoint files made elsewhere; nothing was searched.", tally.missions.len()));
        return;
    }
    let method = match search.method {
        SearchMethod::Beam => "best-first with a beam: no optimum is claimed",
        SearchMethod::Exact => "exact in each sampled graph, over its waypoints only",
        SearchMethod::Uniform => "uniform over the feasible trajectories of each sampled graph",
    };
    said.push(format!(
        "Search: {method}; score `{}`; {} of {} cases asked for, from {} sampled graphs of {} waypoints.",
        generate.score,
        cases.len(),
        search.cases,
        tally.graphs.max(cases.last().map_or(0, |case| case.graph + 1)),
        search.waypoints
    ));
    if tally.dropped > 0 {
        said.push(format!(
            "The frontier was full: {} partial trajectories of least score were dropped.",
            tally.dropped
        ));
    }
    said.push(format!(
        "Length counts waypoints, start and end included: {}. Waypoints are numbered from 0 = start.",
        setup.scenario.task.length
    ));
}

fn act(setup: &Setup, said: &mut Vec<String>) {
    let execute = &setup.scenario.execute;
    if let (Some(command), None) = (&execute.command, execute.controller_in_force()) {
        said.push(format!("Executed by `{command}`; legs are those that it reported."));
    } else if let Some(controller) = execute.controller_in_force() {
        said.push(format!(
            "Simulated: rigid body with rotor lag and drag at {} s, controller `{}` with hairpin's own gains, fixed by \
             step responses; noise {}.",
            execute.step_s,
            controller.word(),
            if execute.noise { "on" } else { "off" }
        ));
    }
    let varied: Vec<&str> = setup.scenario.vary.keys().map(String::as_str).collect();
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
    said.push(format!("A waypoint counts as reached within {} m.", execute.accept_m));
}

fn verdict(setup: &Setup, said: &mut Vec<String>) {
    match setup.scenario.spec.deviation {
        Some(deviation) => {
            let from = match deviation.from {
                DeviationFrom::Leg => "the straight leg being flown",
                DeviationFrom::NearestLeg => "the nearer of the previous and the current leg",
                DeviationFrom::Path => "the programmed path",
            };
            let corner = if deviation.corner_m > 0.0 {
                format!("; within {} m of the leg's own waypoints overshoot is judged instead", deviation.corner_m)
            } else {
                String::new()
            };
            said.push(format!("Deviation is the distance from {from}{corner}. Tracks are not aligned."));
        }
        None => {
            said.push("No deviation limit is given: deviations are told, not judged. Tracks are not aligned.".into())
        }
    }
    said.push("Leaving the world and a crash are violations whatever the spec says.".into());
}
