//! Before anything is written for hardware: whether a case stays inside, as planned and as its runs predict, take-off
//! and way home included.

use hairpin::campaign::kind::{Room, Wall};
use hairpin::campaign::{Case, CaseResult};
use hairpin::trajectory::Track;
use nalgebra::Point3;

use super::way::Way;
use crate::Problem;
use crate::execute::runs_with_motion;
use crate::work::Work;

/// Rounding of places, m.
const ROUNDING: f64 = 1e-9;

/// A case that was looked at.
#[derive(Debug)]
pub(super) struct Cleared {
    /// How the vehicle comes there and back.
    pub(super) way: Way,
    /// What is beyond the margin, a sentence each; empty if nothing is.
    pub(super) beyond: Vec<String>,
    /// What has to be known of how it was looked at.
    pub(super) told: Vec<String>,
}

/// Looks at `case` in `room`.
pub(super) fn look_at(work: &Work, room: &Room, case: &Case) -> Result<Cleared, Problem> {
    let way = Way::of(&work.setup, room, case)?;
    let id = case.id();
    let (mut beyond, mut told) = (Vec::new(), Vec::new());
    let outside = |place: &Point3<f64>, floor: bool| -> Option<Wall> {
        let wall = room.nearest_wall(place, floor);
        let near = wall.inside < room.margin - ROUNDING || wall.inside.is_nan();
        let out = near || (!room.flies && work.setup.is_outside(place));
        out.then_some(wall)
    };
    let sentence = |what: String, place: &Point3<f64>, wall: &Wall| {
        let ([x, y, z], margin) = ([place.x, place.y, place.z], room.margin);
        let at = if wall.inside < 0.0 { "beyond" } else { "inside" };
        format!(
            "case {id}: {what} ({x:.2}, {y:.2}, {z:.2}) m is {:.3} m {at} {}, must be {margin} m inside at least \
             (world.keep_in_margin_m)",
            wall.inside.abs(),
            wall.name
        )
    };
    for (number, place) in case.waypoints.iter().enumerate() {
        beyond.extend(outside(place, true).map(|wall| sentence(format!("waypoint {number}"), place, &wall)));
    }
    for (what, place) in way.places() {
        let floor = what == "the way home";
        beyond.extend(outside(&place, floor).map(|wall| sentence(format!("{what}, at"), &place, &wall)));
    }
    beyond.extend(way.blocked.map(|why| format!("case {id}: {why}")));
    let worst = |what: &str, track: &Track| {
        let places = track.poses().iter().map(|pose| Point3::from(pose.translation.vector));
        let found = track.times().iter().zip(places).filter_map(|(t, place)| Some((t, place, outside(&place, true)?)));
        let worst = found.min_by(|a, b| a.2.inside.total_cmp(&b.2.inside));
        worst.map(|(t, place, wall)| sentence(format!("{what} at t = {t:.2} s,"), &place, &wall))
    };
    beyond.extend(worst("planned", &work.folder.read_planned(case.number)?));
    let runs = runs_with_motion(work, case)?;
    if runs.is_empty() {
        told.push(format!("case {id}: not executed, so no excursion is predicted: its plan alone was looked at"));
    }
    for run in &runs {
        match &run.outcome {
            Ok(flight) => beyond.extend(worst(&format!("run {}, predicted", run.run), &flight.track)),
            Err(_) => told
                .push(format!("case {id}, run {}: the executor failed, so no excursion is predicted by it", run.run)),
        }
    }
    Ok(Cleared { way, beyond, told })
}

/// What a case's worst run says of obstacles, which no autopilot knows.
pub(super) fn obstacle_met(result: Option<&CaseResult>) -> Option<String> {
    let result = result?;
    let clearance = result.measures.as_ref()?.min_clearance.filter(|clearance| *clearance < 0.0)?;
    Some(format!("case {}: its worst run meets an obstacle, {:.2} m deep", result.case, -clearance))
}

/// Refuses what is beyond the margin, unless that was accepted by name.
pub(super) fn refuse(cleared: &[Cleared]) -> Result<(), Problem> {
    let mut beyond = cleared.iter().flat_map(|case| &case.beyond);
    let Some(first) = beyond.next() else { return Ok(()) };
    let cases = cleared.iter().filter(|case| !case.beyond.is_empty()).count();
    let more = match beyond.count() {
        0 => String::new(),
        more => format!(" ({more} more of {cases} of {} cases)", cleared.len()),
    };
    Err(Problem::input(format!(
        "preflight: {first}{more}; --case ID or --worst N leaves cases out, --accept-excursion writes them all the same and says so in the \
         files"
    )))
}
