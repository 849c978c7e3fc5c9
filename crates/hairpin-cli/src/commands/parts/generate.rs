//! Part one: trajectories, their planned motion, and what the search did.

use std::path::Path;
use std::time::{Duration, Instant};

use hairpin::campaign::arm::graph_of;
use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, Kind, Stop, Tally, learn};
use hairpin::world::terrain::Terrain;
use hairpin_formats::atomic;
use hairpin_formats::scenario::model_text;
use hairpin_formats::waypoints::{Mission, environment_path};

use super::graph::keep_graph;
use super::keep::keep_cases;
use crate::console;
use crate::folder::Work;
use crate::interrupt::{self, Deadline};
use crate::problem::Problem;

/// Between checkpoints: what a kill may cost.
const CHECKPOINT: Duration = Duration::from_secs(30);

/// Finds the cases and writes them. An interrupted generation goes on where its last checkpoint was.
pub(crate) fn generate(work: &Work, deadline: Deadline) -> Result<(Vec<Case>, Tally), Problem> {
    let known = known(work)?;
    if known.tally.complete {
        tracing::info!("generation is complete already");
        return Ok((known.cases, known.tally));
    }
    let mut cases = known.cases.clone();
    let (mut saved, mut at) = (cases.len(), Instant::now());
    let mut trouble = None;
    let bar = console::progress("generate", 0);
    let begun = Instant::now();
    let user_score = work.setup.user_score();
    let score_trouble = || user_score.and_then(|user| user.trouble());
    let stop = Stop {
        cancelled: &|| interrupt::asked() || deadline.passed() || score_trouble().is_some(),
        progress: &|done, of| {
            bar.set_length(of as u64);
            bar.set_position(done as u64);
        },
        clock: &|| begun.elapsed().as_secs_f64(),
    };
    let tally = interrupt::not_waiting_for(user_score, deadline, || {
        hairpin::campaign::generate(&work.setup, &known, &stop, &mut |new, tally| {
            cases.extend_from_slice(new);
            if at.elapsed() > CHECKPOINT && trouble.is_none() {
                trouble = keep_cases(work, &cases, saved, &unfinished(tally)).err();
                (saved, at) = (cases.len(), Instant::now());
            }
        })
    });
    bar.finish_and_clear();
    if let Some(problem) = trouble {
        return Err(problem);
    }
    if let Some(trouble) = score_trouble() {
        return Err(Problem::input(format!("`{}` = {trouble}", work.setup.scenario.score_key())));
    }
    keep_cases(work, &cases, saved, &unfinished(&tally))?;
    work.folder.write_curves(work.setup.scenario.search().stress, &tally.curves)?;
    if let Some(model) = &tally.model {
        atomic::write(&work.folder.file(learn::NAME), model_text(model).as_bytes())?;
    }
    if let Some(arm) = work.setup.arm()
        && let Ok(graph) = graph_of(&arm)
    {
        keep_graph(work, &arm, &graph)?;
        // What is claimed is proven, however late it is.
        super::optimum::keep(work, &arm, &graph, &cases, &Stop { cancelled: &interrupt::asked, ..stop })?;
        // What a controller reads is what is executed and judged: numbers as the module has them.
        cases = work.folder.read_cases()?;
    }
    if interrupt::asked() {
        return Err(Problem::Interrupted(format!("stopped after {} cases; --resume goes on", cases.len())));
    }
    // The last of all files: with it there is nothing left to do.
    work.folder.write_tally(&tally)?;
    tracing::info!("{} cases from {} graphs", cases.len(), tally.graphs);
    Ok((cases, tally))
}

/// The tally of a generation that goes on: cases may come, and what is made of all of them is not there.
fn unfinished(tally: &Tally) -> Tally {
    Tally { complete: false, stopped: true, ..tally.clone() }
}

/// What an interrupted generation left: the tally, which is written last, and the cases that it counts. Cases beyond it
/// are of a checkpoint that a kill cut short; they are found again.
fn known(work: &Work) -> Result<Known, Problem> {
    let folder = &work.folder;
    if !folder.has_cases() || !folder.has_tally() {
        return Ok(Known::default());
    }
    let known = Known { cases: folder.read_cases()?, tally: folder.read_tally()? };
    let begun = !known.cases.is_empty();
    if !known.tally.missions.is_empty() {
        return Err(Problem::input(format!(
            "--resume: {} holds missions made elsewhere, not an interrupted generation; --force replaces them",
            folder.path().display()
        )));
    }
    let known = hairpin::campaign::generate::counted(&work.setup.scenario, known);
    if begun && known.cases.is_empty() {
        // Flights of what is generated anew would be taken for those of what is.
        folder.forget_cases()?;
    }
    Ok(known)
}

/// Puts waypoint lists that were made elsewhere in the place of the folder's cases, with the environments beside them. A list that equals a
/// case of the folder keeps that case's plan and evidence, and its environment where it comes without one.
pub(crate) fn adopt(work: &Work, missions: &[Mission]) -> Result<(), Problem> {
    let known = if work.folder.has_cases() { work.folder.read_cases()? } else { Vec::new() };
    let mut cases = Vec::with_capacity(missions.len());
    let outside = |p: &nalgebra::Point3<f64>| match work.setup.kind() {
        Kind::Flight(setup) => setup.world.wall_distance(p) < 0.0,
        Kind::Drive(setup) => setup.map.patch(p.x, p.y).is_err(),
        Kind::Arm(_) => false,
    };
    for (number, Mission { name, waypoints, environment }) in missions.iter().enumerate() {
        if waypoints.len() < 2 {
            return Err(Problem::input(format!(
                "{name}.csv: a mission needs at least 2 waypoints, this has {}",
                waypoints.len()
            )));
        }
        if let Some(outside) = waypoints.iter().position(outside) {
            console::warn(&format!("Warning: {name}.csv: waypoint {outside} lies outside the world"));
        }
        let seed = hairpin::math::random::case_seed(work.setup.scenario.seed(), number as u64);
        let same = known.iter().find(|case| case.waypoints == *waypoints);
        let mut case = match same {
            Some(case) => Case { number, seed, ..case.clone() },
            None => Case::bare(number, seed, waypoints.clone()),
        };
        if let Some(environment) = environment {
            let file = environment_path(Path::new(""), name);
            let refuse = |mistake| Problem::input(format!("{}: {mistake}", file.display()));
            work.setup.check_environment(environment).map_err(refuse)?;
            case.environment = Some(environment.clone());
        }
        cases.push(case);
    }
    let names = missions.iter().map(|mission| mission.name.clone());
    let tally = Tally { complete: true, missions: names.collect(), ..Tally::default() };
    work.folder.forget_cases()?;
    keep_cases(work, &cases, 0, &tally)
}
