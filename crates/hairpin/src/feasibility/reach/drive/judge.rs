//! Solves one leg: cheap necessary tests, the ways of driving in turn, the limits, the stress.

use super::settings::{DriveSettings, DriveSite};
use super::stress::Demands;
use super::tally::LegRefusal;
use super::watch::{curvature_change, refusal, watch};
use super::ways::{Way, ways};
use crate::feasibility::steering::shooting::rough::{self, Status, Steps};
use crate::feasibility::steering::shooting::{Curvatures, Goal, Query, flat};
use crate::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use crate::trajectory::{Direction, SpeedProfile, Timing};

/// A leg that is one.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    /// Commands.
    pub(super) segments: Box<[Segment]>,
    /// How they came about.
    pub(super) way: Way,
    /// Time they take with no legs before and after them, s.
    pub(super) duration: f64,
    /// The score of the settings.
    pub(super) stress: f64,
}

/// The commands of a leg that is solved.
#[derive(Debug, Clone)]
pub(super) struct Commands {
    /// How they came about.
    pub(super) way: Way,
    /// Themselves.
    pub(super) segments: Box<[Segment]>,
}

impl Solved {
    /// Without what they take and demand.
    pub(super) fn commands(&self) -> Commands {
        Commands { way: self.way, segments: self.segments.clone() }
    }
}

/// The ends of a leg.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends<'a> {
    /// Pose and curvature at the first waypoint.
    pub(super) from: &'a Planar,
    /// Pose and curvature at the last.
    pub(super) to: &'a Planar,
    /// Distance between them, m.
    pub(super) distance: f64,
    /// Speeds at them, m/s.
    pub(super) speeds: [f64; 2],
    /// Of travel in the body, from one to the other.
    pub(super) direction: Direction,
    /// The value of the term `random`.
    pub(super) random: f64,
}

/// The drive that joins `ends`, or why there is none; counts what it tries to solve.
///
/// `Err` has the reason that came farthest in the order of [`LegRefusal`]. Deterministic: ways in their order, the
/// first that keeps all limits.
///
/// `solves` counts the ways that were solved, not those whose length alone refused them.
pub(super) fn judge(
    site: &DriveSite,
    settings: &DriveSettings,
    ends: &Ends,
    solves: &mut u64,
) -> Result<Solved, LegRefusal> {
    let mut farthest = LegRefusal::Detour;
    for way in ways(settings) {
        if !may_be_short(settings, ends, way) {
            continue;
        }
        *solves += 1;
        match driven(site, settings, ends, way) {
            Ok(solved) => return Ok(solved),
            Err(reason) => farthest = farthest.max(reason),
        }
    }
    Err(farthest)
}

/// The drive that joins `ends` the given `way`, or why there is none.
///
/// No other way is tried.
pub(super) fn judge_by(
    site: &DriveSite,
    settings: &DriveSettings,
    ends: &Ends,
    way: Way,
) -> Result<Solved, LegRefusal> {
    if may_be_short(settings, ends, way) { driven(site, settings, ends, way) } else { Err(LegRefusal::Detour) }
}

/// Necessary for a drive in one gear to be no longer than the longest detour: Dubins' path is not. A direction that
/// turns by Δδ bends the way by Δδ/L more, L no less than the distance.
///
/// Conservative: what it refuses has no drive in one gear that is short enough; what it lets pass may still be too
/// long. Ways with more than one gear or with turns are not held to it.
fn may_be_short(settings: &DriveSettings, ends: &Ends, way: Way) -> bool {
    let Some(gear) = way.gear() else { return true };
    let (from, to) = (ends.from, ends.to);
    let (swing, bounds) = (ends.direction.swing(), &settings.bounds);
    let (sin, cos) = libm::sincos(from.yaw + ends.direction.start);
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let sign = gear.sign();
    // In reverse, the mirror image about the y axis.
    let goal = Goal {
        x: sign * (cos * dx + sin * dy),
        y: cos * dy - sin * dx,
        yaw: sign * (to.yaw - from.yaw + swing),
        curvature: to.curvature,
    };
    let query = Query { start_curvature: from.curvature, goal };
    let bent = Curvatures { most: bounds.most + swing.abs() / ends.distance, ..*bounds };
    flat::least_length(&query, &bent) <= settings.detour * ends.distance
}

/// Solve, follow, time, score, in the order of what they cost. The duration is that of the speed profile of this leg
/// alone, turns in place added at their rate; demands are shares of what the limits allow.
///
/// ```text
/// duration = T(L) + Σ |turned| / ω      T of the speed profile, L the metres driven
/// ```
///
/// `Steering` where the direction of travel would have to turn faster than the wheels: v · |dδ/ds| > rate.
fn driven(site: &DriveSite, settings: &DriveSettings, ends: &Ends, way: Way) -> Result<Solved, LegRefusal> {
    let segments = solved(site, settings, ends, way, &settings.speed.into())?;
    let turning = settings.speed * ends.direction.rate(metres(&segments)).abs();
    if turning > site.rover.response.steering_rate.min(site.rover.wheels.steer_rate) {
        return Err(LegRefusal::Steering);
    }
    let moved = as_moved(site, settings, ends.from, &segments);
    let met = watch(site, settings, ends.from, &moved, &settings.speed.into(), ends.direction)?;
    let turned: f64 = segments.iter().map(|segment| segment.turn_rad().abs()).sum();
    let profiles = settings.pace.over(settings.speed, &ends.speeds, &[&segments], &site.rover.response);
    let driving: f64 =
        profiles.iter().map(|profile| Timing::new(profile, &segments)).map(|t| t.time_at(t.length())).sum();
    let duration = driving + turned / settings.turn_rate;
    let full = settings.full_tilt();
    let stress = settings.score.of(&Demands {
        slope: met.slope / full,
        roll: met.roll / full,
        curvature_change: curvature_change(ends.from.curvature, &segments) / (2.0 * settings.bounds.most),
        slip: met.slip,
        speed: ends.distance / (duration * settings.speed),
        reversals: reversals(&segments),
        random: ends.random,
    });
    Ok(Solved { segments: segments.as_ref().into(), way, duration, stress })
}

/// Commands that come to the same end the same `way` at the speeds of `profile`; `None`: `segments` do so already, as
/// they do wherever a lag of the steering makes no difference.
///
/// # Errors
/// As of [`judge_by`], at the speeds of the profile.
pub(super) fn refitted(
    site: &DriveSite,
    settings: &DriveSettings,
    ends: &Ends,
    way: Way,
    segments: &[Segment],
    profile: &SpeedProfile,
) -> Result<Option<Box<[Segment]>>, LegRefusal> {
    let course = settings.course(site, Steps::default(), *profile, ends.direction);
    let again = rough::predict(&course, ends.from, segments, |_| {});
    if again.is_ok_and(|again| settings.solver.met(ends.to, &again.end)) {
        return Ok(None);
    }
    let segments = solved(site, settings, ends, way, profile)?;
    watch(site, settings, ends.from, &segments, profile, ends.direction)?;
    Ok(Some(segments.as_ref().into()))
}

/// Commands whose predicted motion ends where it should, no longer than the longest detour.
///
/// # Errors
/// `Detour` for what is longer than allowed, in the plane or on the ground; `Tilt`, or what blocked the way;
/// `Unsolved` where the goal was not met.
fn solved(
    site: &DriveSite,
    settings: &DriveSettings,
    ends: &Ends,
    way: Way,
    speed: &SpeedProfile,
) -> Result<SegmentList, LegRefusal> {
    let longest = settings.detour * ends.distance;
    let mut too_long = false;
    let mut steer = |query: &Query| -> Option<SegmentList> {
        let found = way.steer(settings, query, ends.direction.swing())?;
        too_long = metres(&found) > longest;
        (!too_long).then_some(found)
    };
    let course = settings.course(site, Steps::default(), *speed, ends.direction);
    let answer = rough::solve(&course, ends.from, ends.to, &settings.bounds, &settings.solver, &mut steer);
    match answer.status {
        Status::Ok if metres(&answer.segments) > longest => Err(LegRefusal::Detour),
        // What is plain already need not be looked at more closely.
        Status::Ok if answer.prediction.is_some_and(|p| p.tilt.0 > settings.limits.tilt) => Err(LegRefusal::Tilt),
        Status::Ok => Ok(answer.segments),
        Status::Blocked(blocked) => Err(refusal(&blocked)),
        Status::Unreachable if too_long => Err(LegRefusal::Detour),
        Status::Unreachable | Status::NotConverged { .. } => Err(LegRefusal::Unsolved),
    }
}

/// What the vehicle does under `segments`: it goes on as it was until the first one acts, and the last stretch, which
/// only waits for the commands before it, is not driven.
fn as_moved(site: &DriveSite, settings: &DriveSettings, from: &Planar, segments: &SegmentList) -> Vec<Segment> {
    let wait = site.rover.response.latency * settings.speed;
    let mut motion = segments.to_vec();
    if wait > 0.0 {
        motion.pop();
        motion.insert(0, Segment::clothoid(wait, from.curvature, from.curvature, Gear::Forward));
    }
    motion
}

/// Length driven, turns in place none.
fn metres(segments: &[Segment]) -> f64 {
    segments.iter().map(Segment::length_m).sum()
}

/// Changes of gear on the way.
///
/// Arcs without length have no gear.
fn reversals(segments: &[Segment]) -> f64 {
    let mut gears = segments.iter().filter(|s| matches!(s.motion, Motion::Arc { .. }) && s.length_m() > 0.0);
    let Some(first) = gears.next() else { return 0.0 };
    let (_, changes) = gears.fold((first.gear, 0.0), |(gear, n), s| (s.gear, if s.gear == gear { n } else { n + 1.0 }));
    changes
}
