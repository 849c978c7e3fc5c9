//! A track against the waypoints that were planned, and against limits.

use nalgebra::Point3;

use crate::held::Asked;
use crate::measures::{TrackLeg, TrackMeasures, TrackViolation};
use crate::memory::{Room, given, many, put, result};
use crate::refusal::{Code, Error, Refused, enter};
use crate::track::{HAIRPIN_FROM_PATH, JudgeSettings, Sample, hairpin_judge_defaults};

/// Measures a track against its waypoints and holds it to limits; a value equal to its limit keeps it. Nothing is
/// aligned: both are in one frame. Maxima are over samples. A track is within its limits where nothing is violated and
/// `measures->unmeasured` is 0. Takes memory.
///
/// @param waypoints_m the waypoints, x, y, z each, m
/// @param waypoints how many, at least 2
/// @param samples the track
/// @param count how many samples
/// @param settings how it is judged; NULL: hairpin_judge_defaults
/// @param measures what is measured
/// @param legs NULL, or room for waypoints - 1 legs
/// @param deviations_m NULL, or room for a deviation of each sample, NaN where it does not count
/// @param found where violations are written, the gravest first; NULL: nowhere
/// @param found_room how many there is room for
/// @param violated how many there are; HAIRPIN_TOO_SMALL where there is room, but too little
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_judge(
    waypoints_m: *const f64,
    waypoints: usize,
    samples: *const Sample,
    count: usize,
    settings: *const JudgeSettings,
    measures: *mut TrackMeasures,
    legs: *mut TrackLeg,
    deviations_m: *mut f64,
    found: *mut TrackViolation,
    found_room: usize,
    violated: *mut usize,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, with as many values or room for them, as the header has it.
    unsafe {
        enter(error, || {
            let usual = hairpin_judge_defaults();
            let settings = if settings.is_null() { usual } else { *given(settings, "settings")? };
            let path = match settings.reference {
                HAIRPIN_FROM_PATH => places(settings.path_m, settings.path_points, "path_m")?,
                _ => Vec::new(),
            };
            let times = |place: *const f64, name| match place.is_null() {
                true => Ok(None),
                false => many(place, waypoints, name).map(Some),
            };
            let (reached, planned) = (times(settings.reached_s, "reached_s")?, times(settings.planned_s, "planned_s")?);
            let (waypoints, samples) =
                (places(waypoints_m, waypoints, "waypoints_m")?, many(samples, count, "samples")?);
            let measures = result(measures, "measures")?;
            let one_each = |place: bool, many: usize| if place { many } else { 0 };
            let last = waypoints.len().saturating_sub(1);
            let mut legs = Room::new(legs, one_each(!legs.is_null(), last), "legs")?;
            let mut off = Room::new(deviations_m, one_each(!deviations_m.is_null(), count), "deviations_m")?;
            let listed = !found.is_null();
            let mut found = Room::new(found, one_each(listed, found_room), "found")?;
            let violated = result(violated, "violated")?;

            let asked = Asked { settings, waypoints, path, reached, planned };
            let judged = asked.judge(samples, off.is_wanted())?;
            put(measures, TrackMeasures::of(&judged.measures, &judged.limits, judged.missed))?;
            if legs.is_wanted() {
                legs.fill(judged.measures.legs.iter().map(TrackLeg::from))?;
            }
            off.fill(judged.off.iter().map(|off| off.unwrap_or(f64::NAN)))?;
            put(violated, judged.violations.len())?;
            if listed {
                found.fill(judged.violations.iter().map(TrackViolation::from))?;
            }
            Ok(())
        })
    }
}

/// `count` places of three numbers each.
///
/// # Safety
/// As many numbers lie there, where it is not NULL.
unsafe fn places(numbers: *const f64, count: usize, name: &str) -> Result<Vec<Point3<f64>>, Refused> {
    let all = count.saturating_mul(3);
    // SAFETY: handed on.
    let numbers = unsafe { many(numbers, all, name)? };
    Ok(numbers.as_chunks().0.iter().map(|[x, y, z]| Point3::new(*x, *y, *z)).collect())
}
