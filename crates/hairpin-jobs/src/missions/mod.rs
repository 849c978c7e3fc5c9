//! Missions that were made elsewhere, in the place of generated cases: checked by the robot's own claim, executed and
//! judged, and held beside what a search finds.

mod asked;
mod compared;
mod fenced;
mod leg;
mod told;

use std::path::Path;

use hairpin::campaign::{Case, CaseNumber, Evidence, Setup, Tally, planned};
use hairpin_formats::missions::{Mission, environment_path, read_all};
use nalgebra::Point3;
use rayon::prelude::*;

use crate::check::{Checked, check_in, same_vehicle};
use crate::generate::keep_cases;
use crate::work::Work;
use crate::{Problem, Watch};
pub use compared::{Compared, Ranked};
pub(crate) use compared::{compare, with_compared};
pub(crate) use fenced::{Beyond, FENCE, MayBe, Moved, READ_OTHERWISE, look};
pub(crate) use leg::Leg;
pub use told::{MissionTold, MissionsTold};
pub(crate) use told::{doubt_lost_fence, hold, keep_search_failed, read_told, takes_all_parts};

/// The missions of a folder or file, as cases of `setup` may be made of them. Asked before anything is written.
///
/// # Errors
/// An arm's campaign, whose cases are programs; a file that is no mission, or has something that changes the motion
/// and is not followed.
pub(crate) fn of_files(setup: &Setup, path: &Path) -> Result<Vec<Mission>, Problem> {
    if setup.has_programs() {
        return Err(Problem::of_file(
            path,
            "--missions: an arm's cases are programs, which waypoints are not; `hairpin import FILE --check --cell \
             SCENARIO` looks at programs made elsewhere",
        ));
    }
    let all = read_all(path, &setup.scenario, setup.handed().farthest).map_err(Problem::input)?;
    all.iter().try_for_each(|mission| followed(setup, mission))?;
    Ok(all)
}

/// Whether `mission` is one of the robot's class of vehicles, and all of it that changes the motion is followed.
///
/// # Errors
/// It is another's; the first thing that is not followed.
pub(crate) fn followed(setup: &Setup, mission: &Mission) -> Result<(), Problem> {
    same_vehicle(setup, mission)?;
    match mission.uncertain.first() {
        None => Ok(()),
        Some(one) => Err(Problem::of_file(
            &mission.path,
            format!(
                "{}: what would be judged is not the mission; take it out, or cut the mission before it",
                one.words
            ),
        )),
    }
}

/// Reads the missions of a folder or file for `setup`, and checks each.
///
/// # Errors
/// As of [`of_files`].
pub(crate) fn read(setup: &Setup, path: &Path, watch: &dyn Watch) -> Result<Vec<Leg>, Problem> {
    let all = of_files(setup, path)?;
    let mut legs = Vec::with_capacity(all.len());
    for mission in all {
        let file = mission.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if let Some(outside) = mission.waypoints.iter().position(|place| setup.is_outside(place)) {
            watch.warn(&format!("Warning: {file}: waypoint {outside} lies outside the world"));
        }
        for note in &mission.notes {
            watch.warn(&format!("{file}: {note}"));
        }
        // What stands in an environment of its own is not the claim's world.
        let asked = mission.environment.is_none();
        let check = |mission: &Mission| check_in(setup, mission.clone(), "the scenario's world".into()).ok();
        let checked = if asked { check(&mission) } else { None };
        if let Some(checked) = checked.as_ref().filter(|checked| checked.feasible != Some(true)) {
            watch.warn(&checked.verdict.sentence);
        }
        for mut leg in between_stops(mission, checked) {
            leg.unmet = asked::unmet(setup, &leg);
            let open = "what is executed is not this mission, and its case is INCONCLUSIVE";
            leg.unmet.iter().for_each(|words| watch.warn(&format!("Warning: {file}: {words}; {open}")));
            legs.push(leg);
        }
    }
    Ok(legs)
}

/// A vehicle that stops begins anew: each part is a case of its own.
fn between_stops(mission: Mission, checked: Option<Checked>) -> Vec<Leg> {
    if mission.stops.is_empty() {
        let (name, waypoints) = (mission.name.clone(), mission.waypoints.clone());
        let ends = [0, waypoints.len() - 1];
        return vec![Leg { name, waypoints, ends, unmet: Vec::new(), checked, mission }];
    }
    let last = mission.waypoints.len() - 1;
    let ends: Vec<usize> =
        std::iter::once(0).chain(mission.stops.iter().map(|stop| stop.waypoint)).chain([last]).collect();
    let part = |pair: &[usize]| Leg {
        name: format!("{} {}-{}", mission.name, pair[0], pair[1]),
        waypoints: mission.waypoints[pair[0]..=pair[1]].to_vec(),
        ends: [pair[0], pair[1]],
        unmet: Vec::new(),
        checked: None,
        mission: mission.clone(),
    };
    let mut parts: Vec<Leg> = ends.windows(2).map(part).collect();
    if let Some(first) = parts.first_mut() {
        first.checked = checked;
    }
    parts
}

/// Puts missions in the place of the folder's cases, with the environments beside them. A list that equals a case of
/// the folder keeps that case's plan and evidence, and its environment where it comes without one; any other has the
/// witness that its check found.
pub(crate) fn adopt(work: &Work, legs: &[Leg]) -> Result<(), Problem> {
    let known = if work.folder.has_cases() { work.folder.read_cases()? } else { Vec::new() };
    let cases = cases_of(&work.setup, &known, legs)?;
    let tally =
        Tally { complete: true, missions: legs.iter().map(|leg| leg.name.clone()).collect(), ..Tally::default() };
    work.folder.forget_cases()?;
    keep_cases(work, &cases, 0, &tally)?;
    Ok(work.folder.write_missions(&MissionsTold::of(legs))?)
}

/// The cases that missions become, beside those that are `known`. All of them can be planned: what cannot be is found
/// before the cases that they replace are gone.
///
/// # Errors
/// An environment that `setup` has no room for; a case that cannot be planned.
pub(crate) fn cases_of(setup: &Setup, known: &[Case], legs: &[Leg]) -> Result<Vec<Case>, Problem> {
    let mut cases = Vec::with_capacity(legs.len());
    for (number, leg) in legs.iter().enumerate() {
        let Leg { name, waypoints, checked, mission, .. } = leg;
        let seed = hairpin::math::random::case_seed(setup.scenario.seed(), number as u64);
        let same = known.iter().find(|case| match mission.rounded {
            true => are_rounded(&case.waypoints, waypoints),
            false => case.waypoints == *waypoints,
        });
        // The plan of the case is not the one that holds the speeds of the mission.
        let same = same.filter(|_| !asked::takes_speeds_of_plan(setup, leg));
        let mut case = match same {
            Some(case) => Case { number: CaseNumber(number), seed, ..case.clone() },
            None => witnessed(Case::bare(CaseNumber(number), seed, waypoints.clone()), checked.as_ref()),
        };
        if let Some(environment) = &mission.environment {
            let file = environment_path(Path::new(""), name);
            let refuse = |mistake| Problem::input(format!("{}: {mistake}", file.display()));
            setup.check_environment(environment).map_err(refuse)?;
            case.environment = Some(environment.clone());
        }
        cases.push(case);
    }
    let plan = |(case, leg): (&Case, &Leg)| match planned(setup, case) {
        Ok(_) => Ok(()),
        Err(error) => Err(Problem::of_file(&leg.mission.path, format!("cannot be planned: {error}"))),
    };
    cases.par_iter().zip(legs).try_for_each(plan)?;
    Ok(cases)
}

/// `case` with the witness of all of the mission, where the check found one.
fn witnessed(case: Case, checked: Option<&Checked>) -> Case {
    let passed = checked.and_then(|checked| checked.passage.witness.as_ref());
    match passed.filter(|passed| passed.waypoints.len() == case.waypoints.len()) {
        Some(passed) => Case {
            waypoints: passed.waypoints.clone(),
            leg_times: passed.leg_times.clone(),
            evidence: Evidence::Witnessed,
            witness: Some(passed.witness.clone()),
            ..case
        },
        None => case,
    }
}

/// Waypoints in degrees are read back to within this, m.
const ROUNDING: f64 = 1e-4;

/// Whether `read` are `waypoints` but for the rounding of degrees.
fn are_rounded(waypoints: &[Point3<f64>], read: &[Point3<f64>]) -> bool {
    waypoints.len() == read.len() && waypoints.iter().zip(read).all(|(a, b)| (a - b).norm() <= ROUNDING)
}
