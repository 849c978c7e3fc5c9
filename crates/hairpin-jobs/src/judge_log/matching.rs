//! Which case of a campaign a log flew: the one whose waypoints its mission names, or whose path its track follows
//! best, with the runner-up told; where two come near each other it is asked for, not guessed.

use hairpin::campaign::Case;
use hairpin::judgement::{Reference, Settings, measure};
use hairpin::trajectory::Track;
use hairpin_formats::logs::{Logged, Progress, Sample};
use nalgebra::{Isometry3, Point3};
use rayon::prelude::*;

use super::asks::Asks;
use super::legs::{LegsBy, course};
use crate::Problem;

/// Samples of a track that are compared at most.
const SAMPLES: usize = 256;
/// Another case must be so many times as far away as the best.
pub(super) const CLEAR: f64 = 2.0;

/// Cases that are smaller than this may be flown this far beside, m.
const LEAST_EXTENT_M: f64 = 10.0;

/// How a log was matched to a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Matched {
    /// Whether the mission's own targets say so, not the track.
    pub by_targets: bool,
    /// Mean distance of the track from the case's path, m.
    pub mean_m: f64,
    /// The case that follows, and its distance, m.
    pub next: Option<(String, f64)>,
}

impl Matched {
    /// `mean 0.21 m; next best 0042 at 3.9 m`.
    pub fn words(&self) -> String {
        let by = if self.by_targets { "by its waypoints' targets, " } else { "" };
        let next = self
            .next
            .as_ref()
            .map_or(", the only case".to_owned(), |(case, far)| format!("; next best {case} at {far:.2} m"));
        format!("{by}mean {:.2} m{next}", self.mean_m)
    }
}

/// The plan of a case, where deviations are measured from that, as the judge measures them; `None` where they are from
/// straight legs.
pub(crate) type PlanOf<'p> = &'p (dyn Fn(&Case) -> Result<Option<Track>, Problem> + Sync);

/// The case of `cases` that `samples` flew.
///
/// A case is as far away as the mean, over the time, of the track's distance from its path, samples assigned to legs in
/// order: from its plan where the judge measures from that (`plan`), else from straight legs. Where others are less
/// than twice as far, the mean distance of their path from the track counts too: a longer path that goes on elsewhere
/// is then told from one that does not.
///
/// # Errors
/// Two cases are as near, or none is anywhere near; a plan cannot be read.
pub(crate) fn matched<'a>(
    cases: &'a [Case],
    samples: &[Sample],
    (logged, progress, accept): (&Logged, &[Progress], f64),
    (plan, asks): (PlanOf, &Asks),
) -> Result<(&'a Case, Matched), Problem> {
    // All are judged alike: where the first has none nobody measures from one.
    let first = cases.first().map(plan).transpose()?.flatten();
    let plans: Vec<Option<Track>> = match first {
        Some(_) => cases.par_iter().map(plan).collect::<Result<_, _>>()?,
        None => vec![None; cases.len()],
    };
    let plan_of = |case: &Case| {
        let place = cases.iter().position(|other| other.number == case.number)?;
        plans[place].as_ref()
    };
    let ways: Vec<Point3<f64>> = thinned(samples);
    let flown = track(&ways, samples);
    let mut by_distance: Vec<(f64, &Case)> =
        cases.par_iter().zip(&plans).map(|(case, plan)| (mean(&flown, &case.waypoints, plan.as_ref()), case)).collect();
    by_distance.sort_by(|a, b| a.0.total_cmp(&b.0));
    let named = |case: &&Case| {
        course(logged, progress, &case.waypoints, accept)
            .is_some_and(|course| course.by == LegsBy::Targets && course.is_whole(case.waypoints.len(), f64::INFINITY))
    };
    let named: Vec<&Case> = cases.iter().filter(named).collect();
    let told = |best: &Case, mean_m: f64, by_targets: bool, ranked: &[(f64, &Case)]| {
        let next = ranked.iter().find(|(_, case)| case.number != best.number).map(|(far, case)| (case.id(), *far));
        Matched { by_targets, mean_m, next }
    };
    if let [case] = named[..] {
        let mean_m = by_distance.iter().find(|(_, other)| other.number == case.number).map_or(0.0, |(far, _)| *far);
        return Ok((case, told(case, mean_m, true, &by_distance)));
    }
    if let Some((nearest, case)) = by_distance.first().copied() {
        let across = extent(&case.waypoints);
        if nearest > across.max(LEAST_EXTENT_M) {
            return Err(Problem::input(format!(
                "flew none of the {} cases: the nearest, {}, is {} away in the mean, and no more than {} across; usual \
                 causes are another unit (mm for m), another frame or origin (a map's coordinates, heights above the sea), \
                 another campaign. Where it is one of these cases all the same, {}",
                cases.len(),
                case.id(),
                far_words(nearest),
                far_words(across),
                asks.case
            )));
        }
        let near = by_distance.iter().take_while(|(far, _)| *far <= CLEAR * nearest).count();
        let both = |(far, case): &(f64, &'a Case)| (far.max(covered(case, plan_of(case), &ways)), *case);
        let mut near: Vec<(f64, &Case)> = match near {
            1 => by_distance.clone(),
            near => by_distance[..near].iter().map(both).collect(),
        };
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        match near[..] {
            [(best, case), (next, other), ..] if next <= CLEAR * best => {
                return Err(Problem::input(format!(
                    "flew case {} (mean {best:.2} m) or {} (mean {next:.2} m), which come too near each other to tell: \
                     {}",
                    case.id(),
                    other.id(),
                    asks.case
                )));
            }
            [(best, case), ..] => {
                let ranked = if near.len() > 1 { &near } else { &by_distance };
                return Ok((case, told(case, best, false, ranked)));
            }
            [] => {}
        }
    }
    Err(Problem::input("the campaign has no case"))
}

/// The diagonal of what `waypoints` lie in, m: who is farther from all of them in the mean flew something else.
fn extent(waypoints: &[Point3<f64>]) -> f64 {
    let first = waypoints.first().copied().unwrap_or_default();
    let corners = waypoints.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    (corners.1 - corners.0).norm()
}

/// `24.9 km`, `47.1 m`.
pub(super) fn far_words(metres: f64) -> String {
    if metres >= 1000.0 { format!("{:.1} km", metres / 1000.0) } else { format!("{metres:.1} m") }
}

fn thinned(samples: &[Sample]) -> Vec<Point3<f64>> {
    let stride = samples.len().div_ceil(SAMPLES).max(1);
    samples.iter().step_by(stride).map(|sample| sample.p_m).collect()
}

fn track(ways: &[Point3<f64>], samples: &[Sample]) -> Track {
    let stride = samples.len().div_ceil(SAMPLES).max(1);
    let times = samples.iter().step_by(stride).map(|sample| sample.t_s).collect();
    let poses = ways.iter().map(|p| Isometry3::translation(p.x, p.y, p.z)).collect();
    Track::new(times, poses, Vec::new()).unwrap_or_default()
}

/// Mean distance of `track` from the path through `waypoints`, or from the `plan` of it, m.
fn mean(track: &Track, waypoints: &[Point3<f64>], plan: Option<&Track>) -> f64 {
    let reference = plan.map_or(Reference::Leg, Reference::Path);
    let settings = Settings { reference, ..Settings::default() };
    measure(track, waypoints, &settings).map_or(f64::INFINITY, |measures| measures.mean_deviation)
}

/// Mean distance of the case's path, its `plan` where there is one, from what was flown, m.
fn covered(case: &Case, plan: Option<&Track>, ways: &[Point3<f64>]) -> f64 {
    if let Some(plan) = plan {
        let stride = plan.len().div_ceil(SAMPLES).max(1);
        let thinned = (0..plan.len()).step_by(stride).map(|i| plan.position(i)).collect();
        return far_of(thinned, ways);
    }
    let total: f64 = case.waypoints.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
    let mut along = Vec::new();
    for leg in case.waypoints.windows(2) {
        let way = leg[1] - leg[0];
        let parts = (SAMPLES as f64 * way.norm() / total).ceil().max(1.0);
        along.extend((0..parts as usize).map(|k| leg[0] + way * (k as f64 / parts)));
    }
    along.extend(case.waypoints.last());
    far_of(along, ways)
}

/// Mean distance of places, one after the other, from a way, m.
fn far_of(along: Vec<Point3<f64>>, ways: &[Point3<f64>]) -> f64 {
    let poses = along.iter().map(|p| Isometry3::translation(p.x, p.y, p.z)).collect();
    let times = (0..along.len()).map(|i| i as f64).collect();
    mean(&Track::new(times, poses, Vec::new()).unwrap_or_default(), ways, None)
}
