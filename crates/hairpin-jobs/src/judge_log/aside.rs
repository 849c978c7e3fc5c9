//! What stands beside a log on its page: the plan that it was to carry out, and what our plant makes of it.

use hairpin::campaign::{Case, CaseResult, Evidence, Run, Setup, execute_run, judge, passes, planned};
use hairpin::campaign::{Demands, Mistake};
use hairpin::trajectory::{Flight, Track};
use nalgebra::{Translation3, Vector3};

use super::against::{Of, Ready};
use crate::Problem;
use crate::check::open_around;
use crate::execute::{comes_again, run_with_motion, why_lost};
use crate::work::Work;

/// The plan of a case and its runs in simulation.
#[derive(Debug, Clone)]
pub(super) struct Aside {
    pub(super) planned: Track,
    pub(super) runs: Vec<Run>,
    /// What the worst of them came to.
    pub(super) simulated: Option<CaseResult>,
    /// What is not there, and why.
    pub(super) notes: Vec<String>,
}

/// What stands beside logs of `case`.
///
/// # Errors
/// The folder's files are broken; a mission that is no motion.
pub(super) fn aside(against: &Ready, case: &Case) -> Result<Aside, Problem> {
    match &against.of {
        Of::Campaign(work) => of_campaign(work, case, against),
        Of::Mission(_) => of_mission(&against.setup, against.in_world, case),
    }
}

/// The runs whose motion was kept, with the worst one executed again where its was not.
fn of_campaign(work: &Work, case: &Case, against: &Ready) -> Result<Aside, Problem> {
    let simulated = against.simulated.iter().find(|result| result.case == case.number).cloned();
    let worst = simulated.as_ref().map_or(0, |result| result.run);
    let (mut runs, mut notes) = (Vec::new(), Vec::new());
    match why_lost(work, case, worst)? {
        Some(why) => notes.push(format!("what was simulated is not drawn: {why}")),
        None => runs.extend(run_with_motion(work, case, worst)?),
    }
    if runs.is_empty() && notes.is_empty() && comes_again(&work.setup) {
        runs.push(execute_run(&work.setup, case, worst));
    }
    let kept = work.folder.facts_of(case.number)?.into_iter().filter(|facts| facts.is_kept() && facts.run != worst);
    for facts in kept {
        runs.extend(work.folder.read_run(case.number, facts.run)?);
    }
    Ok(Aside { planned: work.folder.read_planned(case.number)?, runs, simulated, notes })
}

/// The mission with the witness that a check finds, executed nominally; without a world in the open.
fn of_mission(setup: &Setup, in_world: bool, case: &Case) -> Result<Aside, Problem> {
    let refuse = |mistake: Option<Mistake>| match mistake {
        Some(mistake) => Problem::input(mistake),
        None => Problem::input(format!("missions of {} are not simulated", setup.robot_name())),
    };
    let (there, shift) = match in_world {
        true => (setup.clone(), Vector3::zeros()),
        false => open_around(setup, &case.waypoints).map_err(refuse)?,
    };
    let mut moved = case.clone();
    moved.waypoints.iter_mut().for_each(|place| *place += shift);
    let asked =
        Demands { waypoints: &moved.waypoints, speeds: &vec![None; moved.waypoints.len()], stops: &[], hold: 0.0 };
    let passed = passes(&there, &asked).ok().and_then(|passage| passage.witness);
    let mut notes = Vec::new();
    match passed.filter(|passed| passed.waypoints.len() == moved.waypoints.len()) {
        Some(passed) => {
            (moved.waypoints, moved.leg_times) = (passed.waypoints, passed.leg_times);
            (moved.evidence, moved.witness) = (Evidence::Witnessed, Some(passed.witness));
        }
        None => notes.push(
            "no motion that keeps all limits was found for the mission: what is drawn as planned is its straight way"
                .into(),
        ),
    }
    let planned = planned(&there, &moved).map_err(Problem::input)?;
    let mut run = execute_run(&there, &moved, 0);
    let simulated = judge(&there, &moved, std::slice::from_ref(&run)).ok();
    match &mut run.outcome {
        Ok(flight) => *flight = Flight { track: placed(&flight.track, -shift, 0.0)?, ..flight.clone() },
        Err(why) => notes.push(format!("what our simulator makes of it is not drawn: {why}")),
    }
    Ok(Aside { planned: placed(&planned, -shift, 0.0)?, runs: vec![run], simulated, notes })
}

/// `track` moved by `by` (m), and later by `later` (s).
pub(super) fn placed(track: &Track, by: Vector3<f64>, later: f64) -> Result<Track, Problem> {
    let times = track.times().iter().map(|t| t + later).collect();
    let poses = track.poses().iter().map(|pose| Translation3::from(by) * pose).collect();
    Track::new(times, poses, track.channels().to_vec()).map_err(Problem::input)
}
