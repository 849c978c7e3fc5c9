//! Missions that a log flies more than once: one flight of them is judged, and the others are told.

use hairpin::campaign::Case;
use hairpin_formats::logs::{EventKind, Logged, LoggedMotion, Progress, Sample};
use nalgebra::Point3;

use super::frame::IntoWorld;
use super::legs::{Mission, course};
use super::reached::missed;
use crate::Problem;

/// What of `progress` is of the flight in `span`: where an earlier one ended before it, what was told since, if that
/// begins one of `cases` anew; one that is taken up again goes on where it was.
pub(super) fn of_flight(
    progress: Vec<Progress>,
    span: &Mission,
    (logged, cases, accept): (&Logged, &[Case], f64),
) -> Vec<Progress> {
    let Some(since) = span.since_s else { return progress };
    let flight: Vec<Progress> = progress.iter().filter(|step| step.t_s >= since).copied().collect();
    let is_anew = cases.iter().any(|case| course(logged, &flight, &case.waypoints, accept).is_some());
    if is_anew { flight } else { progress }
}

/// When the mission is flown once more behind the end of `span`, s: its mode is on again, and it comes within `near_m`
/// m of the first of `waypoints` and of the second.
///
/// # Errors
/// The motion is not to be had in the world's frame.
pub(super) fn again(
    logged: &Logged,
    span: &Mission,
    (frame, motion): (&IntoWorld, &LoggedMotion),
    (waypoints, near_m): (&[Point3<f64>], f64),
) -> Result<Option<f64>, Problem> {
    if span.ended.is_none() {
        return Ok(None);
    }
    let of = |kind| logged.events.iter().filter(move |event| event.kind == kind).map(|event| event.t_s);
    for begins in of(EventKind::MissionBegins).filter(|t| *t > span.to_s) {
        let ends = of(EventKind::MissionEnds).find(|t| *t > begins).unwrap_or(f64::INFINITY);
        let flown = motion.samples.iter().filter(|sample| (begins..=ends).contains(&sample.t_s));
        let flown = flown.map(|sample| frame.sample(sample)).collect::<Result<Vec<Sample>, Problem>>()?;
        if !flown.is_empty() && missed(&flown, waypoints, near_m).is_none_or(|missed| missed.waypoint > 1) {
            return Ok(Some(begins));
        }
    }
    Ok(None)
}
