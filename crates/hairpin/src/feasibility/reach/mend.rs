//! A witness over changed waypoints: legs whose ends stay are kept, and of what changed velocities and leg times are
//! chosen anew.
//!
//! A dynamic program over the waypoints in order: one state where a waypoint's velocity is kept, a few where it is to
//! be chosen; each leg takes the time that it had if it is proven for that, else the shortest for which it is. Of all
//! choices the fastest whole is taken.

use nalgebra::{Point3, Vector3};

use super::proven_legs::ProveLegs;
use crate::feasibility::steering::LegTiming;
use crate::trajectory::{Profile, ProfileLeg};

/// Speeds that are tried where one is to be chosen, as shares of the top speed.
const SPEEDS: [f64; 3] = [0.6, 0.3, 0.0];

/// How a waypoint is passed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MendedWaypoint {
    /// m.
    pub(crate) place: Point3<f64>,
    /// m/s.
    pub(crate) velocity: Vector3<f64>,
    /// Whether this velocity is kept; else others are tried as well.
    pub(crate) kept: bool,
}

/// Which velocities are chosen anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Chosen {
    /// None: waypoints are passed as those were whose places they have.
    None,
    /// Those of waypoints that are others.
    Changed,
    /// And those beside them.
    Beside,
}

impl Chosen {
    /// In the order in which they are tried: what a trajectory is stressful by stays as long as it can.
    pub(crate) const ALL: [Chosen; 3] = [Chosen::None, Chosen::Changed, Chosen::Beside];
}

/// The waypoints of `profile`, with other `points` in their places; both ends are passed as they were.
///
/// `before` are the profile's own waypoints; as many as `points`.
pub(crate) fn mended(
    profile: &Profile,
    before: &[Point3<f64>],
    points: &[Point3<f64>],
    chosen: Chosen,
) -> Vec<MendedWaypoint> {
    let changed = |k: usize| before.get(k) != points.get(k);
    let last = points.len().saturating_sub(1);
    let waypoint = |(k, place): (usize, &Point3<f64>)| {
        let near = || changed(k.saturating_sub(1)) || changed((k + 1).min(last));
        let kept = match chosen {
            _ if k == 0 || k == last => true,
            Chosen::None => true,
            Chosen::Changed => !changed(k),
            Chosen::Beside => !(changed(k) || near()),
        };
        MendedWaypoint { place: *place, velocity: passed(profile, k), kept }
    };
    points.iter().enumerate().map(waypoint).collect()
}

/// What a leg was before.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum OldLeg<'a> {
    /// Known to be proven: its ends are as they were.
    Same(&'a ProfileLeg),
    /// Of other ends, in so many seconds.
    Took(f64),
    /// There was none.
    None,
}

/// What leg number `leg` of `profile` was, whose waypoints were `before` and are `points` now.
fn old_leg<'a>(profile: &'a Profile, before: &[Point3<f64>], points: &[Point3<f64>], leg: usize) -> OldLeg<'a> {
    match profile.legs.get(leg) {
        Some(old) if before.get(leg..=leg + 1) == points.get(leg..=leg + 1) => OldLeg::Same(old),
        Some(old) => OldLeg::Took(old.duration),
        None => OldLeg::None,
    }
}

/// The witness over other `points` in the places of `before`, the waypoints of `profile`: what did not change is kept,
/// and where velocities are in the way other ones are chosen at what changed, and then beside it. `None` where no
/// choice is proven.
pub(crate) fn mend_over<J: ProveLegs>(
    judge: &J,
    timing: &LegTiming,
    profile: &Profile,
    before: &[Point3<f64>],
    points: &[Point3<f64>],
) -> Option<Profile> {
    Chosen::ALL.into_iter().find_map(|chosen| {
        let waypoints = mended(profile, before, points, chosen);
        mend(judge, timing, &waypoints, |leg| old_leg(profile, before, points, leg))
    })
}

/// Velocity at waypoint number `waypoint`, m/s.
pub(crate) fn passed(profile: &Profile, waypoint: usize) -> Vector3<f64> {
    match waypoint.checked_sub(1).map(|before| profile.legs.get(before)) {
        Some(Some(leg)) => leg.derivative(leg.duration, 1),
        _ => profile.legs.first().map_or_else(Vector3::zeros, |leg| leg.derivative(0.0, 1)),
    }
}

/// The fastest witness over `waypoints` with leg times of `timing`; `old` is what a leg was before. `None` where no
/// choice is proven.
pub(crate) fn mend<'o, J: ProveLegs>(
    judge: &J,
    timing: &LegTiming,
    waypoints: &[MendedWaypoint],
    old: impl Fn(usize) -> OldLeg<'o>,
) -> Option<Profile> {
    struct Reached<E> {
        end: E,
        time: f64,
        /// Number of the state before, and the leg from it.
        from: Option<(usize, ProfileLeg)>,
    }
    let rungs = timing.rungs();
    let mut layers: Vec<Vec<Reached<J::End>>> = Vec::with_capacity(waypoints.len());
    for (k, waypoint) in waypoints.iter().enumerate() {
        let choices = choices(judge, waypoints, k);
        let Some(before) = layers.last() else {
            layers.push(vec![Reached { end: judge.state(&waypoint.place, &waypoint.velocity), time: 0.0, from: None }]);
            continue;
        };
        let (known, took) = match old(k - 1) {
            OldLeg::Same(leg) if waypoint.kept && waypoints[k - 1].kept => (Some(leg.clone()), None),
            OldLeg::Same(leg) => (None, Some(leg.duration)),
            OldLeg::Took(time) => (None, Some(time)),
            OldLeg::None => (None, None),
        };
        let times = || took.iter().chain(&rungs);
        let mut layer = Vec::with_capacity(choices.len());
        for velocity in choices {
            let goes_on = k + 1 < waypoints.len();
            let passed = || judge.passing(&waypoint.place, &velocity);
            let state = if goes_on { passed() } else { Some(judge.state(&waypoint.place, &velocity)) };
            let Some(there) = state else { continue };
            let mut best: Option<(f64, usize, ProfileLeg)> = None;
            for (number, here) in before.iter().enumerate() {
                let leg = known.clone().or_else(|| times().find_map(|time| judge.leg(&here.end, &there, *time).ok()));
                let Some(leg) = leg else { continue };
                let time = here.time + leg.duration;
                if best.as_ref().is_none_or(|(least, ..)| time < *least) {
                    best = Some((time, number, leg));
                }
            }
            layer.extend(best.map(|(time, number, leg)| Reached { end: there, time, from: Some((number, leg)) }));
        }
        layers.push(layer);
    }
    let mut number = 0;
    let mut legs = Vec::with_capacity(waypoints.len());
    for layer in layers.iter_mut().skip(1).rev() {
        let (before, leg) = (number < layer.len()).then(|| layer.swap_remove(number).from).flatten()?;
        legs.push(leg);
        number = before;
    }
    legs.reverse();
    Some(Profile { legs })
}

/// Velocities that waypoint `k` may be passed with: its own, and where it is to be chosen also along the line between
/// its neighbours, at its own speed and at shares of the top speed, and at rest.
fn choices<J: ProveLegs>(judge: &J, waypoints: &[MendedWaypoint], k: usize) -> Vec<Vector3<f64>> {
    let MendedWaypoint { velocity, kept, .. } = waypoints[k];
    if kept || k == 0 || k + 1 == waypoints.len() {
        return vec![velocity];
    }
    let way = waypoints[k + 1].place - waypoints[k - 1].place;
    let way = way.try_normalize(1e-9).unwrap_or_else(Vector3::zeros);
    let speeds = std::iter::once(velocity.norm()).chain(SPEEDS.map(|share| share * judge.top_speed()));
    std::iter::once(velocity).chain(speeds.map(|speed| way * speed)).collect()
}
