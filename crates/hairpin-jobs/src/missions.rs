//! Missions that were made elsewhere, in the place of generated cases.

use std::path::Path;

use hairpin::campaign::{Case, CaseNumber, Tally};
use hairpin_formats::waypoints::{Mission, environment_path};
use nalgebra::Point3;

use crate::generate::keep_cases;
use crate::work::Work;
use crate::{Problem, Watch};

/// Puts waypoint lists that were made elsewhere in the place of the folder's cases, with the environments beside them.
/// A list that equals a case of the folder keeps that case's plan and evidence, and its environment where it comes
/// without one.
pub(crate) fn adopt(work: &Work, missions: &[Mission], watch: &dyn Watch) -> Result<(), Problem> {
    let known = if work.folder.has_cases() { work.folder.read_cases()? } else { Vec::new() };
    let mut cases = Vec::with_capacity(missions.len());
    for (number, Mission { name, waypoints, rounded, environment }) in missions.iter().enumerate() {
        if waypoints.len() < 2 {
            return Err(Problem::input(format!(
                "{name}.csv: a mission needs at least 2 waypoints, this has {}",
                waypoints.len()
            )));
        }
        if let Some(outside) = waypoints.iter().position(|place| work.setup.is_outside(place)) {
            watch.warn(&format!("Warning: {name}.csv: waypoint {outside} lies outside the world"));
        }
        let seed = hairpin::math::random::case_seed(work.setup.scenario.seed(), number as u64);
        let same = known.iter().find(|case| match rounded {
            true => are_rounded(&case.waypoints, waypoints),
            false => case.waypoints == *waypoints,
        });
        let mut case = match same {
            Some(case) => Case { number: CaseNumber(number), seed, ..case.clone() },
            None => Case::bare(CaseNumber(number), seed, waypoints.clone()),
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

/// Waypoints in degrees are read back to within this, m.
const ROUNDING: f64 = 1e-4;

/// Whether `read` are `waypoints` but for the rounding of degrees.
fn are_rounded(waypoints: &[Point3<f64>], read: &[Point3<f64>]) -> bool {
    waypoints.len() == read.len() && waypoints.iter().zip(read).all(|(a, b)| (a - b).norm() <= ROUNDING)
}
