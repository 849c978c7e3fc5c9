//! Which leg is flown when, and which part of a log is the mission: by the log's own mission state where it has one,
//! else by monotone assignment along the path.

use hairpin_formats::logs::{Event, EventKind, Logged, Progress, Sample};
use nalgebra::Point3;

/// Who tells the leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LegsBy {
    /// The log's mission state, whose items have the waypoints' places.
    Targets,
    /// The log's mission state, by the number of its items.
    Count,
    /// Monotone assignment along the path.
    Assigned,
}

impl LegsBy {
    /// The word in JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Targets => "targets",
            Self::Count => "count",
            Self::Assigned => "assigned",
        }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Targets => "the log's mission state (its items' targets are the waypoints)",
            Self::Count => "the log's mission state (its items counted)",
            Self::Assigned => "monotone assignment along the path",
        }
    }
}

/// The part of a log in which its robot may have been at its mission.
pub(super) struct Mission {
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    /// When its mode says that it began, s.
    pub(super) begins_s: Option<f64>,
    /// When the flight before it ended, of a mission that is flown more than once, s.
    pub(super) since_s: Option<f64>,
    /// What ended it.
    pub(super) ended: Option<String>,
    /// Whether the log itself says when it began.
    pub(super) is_told: bool,
    /// The modes that it was in where the log tells these and none is a mission's.
    pub(super) never_began: Option<String>,
}

/// So many modes are named, at most.
const MODES_NAMED: usize = 4;

/// The modes of a log that tells them, none of which flies a mission.
fn never_began(logged: &Logged) -> Option<String> {
    if logged.events.iter().any(|event| event.kind == EventKind::MissionBegins) {
        return None;
    }
    let mut modes: Vec<&str> = Vec::new();
    for event in logged.events.iter().filter(|event| event.kind == EventKind::OtherMode) {
        if !modes.contains(&event.words.as_str()) {
            modes.push(&event.words);
        }
    }
    let more = modes.len().checked_sub(MODES_NAMED + 1).map(|more| format!("{} more", more + 1));
    modes.truncate(MODES_NAMED);
    let named: Vec<&str> = modes.into_iter().chain(more.as_deref()).collect();
    (!named.is_empty()).then(|| named.join(", "))
}

fn times(logged: &Logged, kind: EventKind) -> impl Iterator<Item = f64> {
    logged.events.iter().filter(move |event| event.kind == kind).map(|event| event.t_s)
}

/// When the flight of the mission begins that is judged from `asked` to `to`: the one that is under way by then, else
/// the next.
fn begins(logged: &Logged, asked: f64, to: f64) -> Option<f64> {
    let under_way = times(logged, EventKind::MissionBegins).take_while(|t| *t <= asked).last();
    let next = times(logged, EventKind::MissionBegins).find(|t| *t > asked && *t < to);
    let is_over = |begun: f64| times(logged, EventKind::MissionEnds).any(|t| t > begun && t <= asked);
    if under_way.is_none_or(is_over) { next.or(under_way) } else { under_way }
}

/// From where on the autopilot flies the mission until it no longer does: return, hold, landing, a pilot, a failsafe, a
/// fence. What comes after the first end is another matter, even where the mission is taken up again.
pub(super) fn mission(logged: &Logged, [from_s, to_s]: [Option<f64>; 2]) -> Mission {
    let asked = from_s.unwrap_or(f64::NEG_INFINITY);
    let begins = begins(logged, asked, to_s.unwrap_or(f64::INFINITY));
    let first = times(logged, EventKind::MissionBegins).next();
    let again = begins.filter(|_| begins != first);
    let before = again.and_then(|begins| times(logged, EventKind::MissionEnds).take_while(|t| *t <= begins).last());
    let from = begins.unwrap_or(f64::NEG_INFINITY).max(asked);
    let takes_off = |after: f64| logged.events.iter().any(|e| e.kind == EventKind::TookOff && e.t_s >= after);
    let flew = |before: f64| logged.events.iter().any(|e| e.kind == EventKind::TookOff && e.t_s < before);
    let ends = |event: &&Event| match event.kind {
        EventKind::MissionEnds | EventKind::Failsafe | EventKind::Geofence => event.t_s > from,
        // Standing on the ground before it takes off is no landing.
        EventKind::Landed => event.t_s > from && (flew(event.t_s) || !takes_off(event.t_s)),
        EventKind::MissionBegins | EventKind::TookOff | EventKind::OtherMode => false,
    };
    let end = logged.events.iter().filter(ends).min_by(|a, b| a.t_s.total_cmp(&b.t_s));
    let end = end.filter(|end| to_s.is_none_or(|to| end.t_s <= to));
    Mission {
        from_s: from,
        begins_s: begins,
        since_s: before,
        to_s: end.map_or(to_s.unwrap_or(f64::INFINITY), |end| end.t_s),
        ended: end.map(|end| format!("{} at t = {:.1} s", end.words, end.t_s)),
        is_told: begins.is_some() || !logged.progress.is_empty(),
        never_began: never_began(logged),
    }
}

/// When the mission flew to which waypoint: rising in both.
pub(crate) struct Course {
    pub(crate) by: LegsBy,
    /// From when on (s) to which waypoint.
    steps: Vec<(f64, usize)>,
    /// When it went on behind the last one, s.
    done_s: Option<f64>,
}

impl Course {
    /// The leg that is flown at `t`: `None` before it left the first waypoint, and after the last one.
    pub(crate) fn leg_at(&self, t: f64) -> Option<usize> {
        if self.done_s.is_some_and(|done| t >= done) {
            return None;
        }
        let step = self.steps.partition_point(|(from, _)| *from <= t).checked_sub(1)?;
        self.steps[step].1.checked_sub(1)
    }

    /// When it left the first waypoint, s.
    pub(super) fn begins_s(&self) -> Option<f64> {
        self.steps.iter().find(|(_, waypoint)| *waypoint > 0).map(|(t_s, _)| *t_s)
    }

    /// When it began to fly the leg `leg`, s.
    pub(super) fn flies_s(&self, leg: usize) -> Option<f64> {
        self.steps.iter().find(|(_, waypoint)| *waypoint > leg).map(|(t_s, _)| *t_s)
    }

    /// When it went on behind the last waypoint, s.
    pub(super) fn done_s(&self) -> Option<f64> {
        self.done_s
    }

    /// Whether by `t` it had flown to all of `waypoints`: what the log tells later is another matter.
    pub(super) fn is_whole(&self, waypoints: usize, t: f64) -> bool {
        let step = self.steps.partition_point(|(from, _)| *from <= t).checked_sub(1);
        step.is_some_and(|step| self.steps[step].1 + 1 == waypoints)
    }

    /// Whether by `t` it had gone on behind the last waypoint.
    pub(super) fn is_done(&self, t: f64) -> bool {
        self.done_s.is_some_and(|done| done <= t)
    }
}

/// The course that the log's mission state tells over `waypoints`, which count as met within `accept` m; `None` where
/// it has none, or its items are not the waypoints.
pub(crate) fn course(logged: &Logged, progress: &[Progress], waypoints: &[Point3<f64>], accept: f64) -> Option<Course> {
    if progress.is_empty() {
        return None;
    }
    if progress.iter().any(|step| step.target_m.is_some()) {
        return by_targets(progress, waypoints, accept);
    }
    let last = waypoints.len() - 1;
    // Our own column `leg`, as the reader of CSV hands it on, numbers waypoints; behind the last one it says so.
    if logged.format == "CSV" {
        let steps: Vec<_> = progress.iter().map(|step| (step.t_s, (step.item as usize).min(last))).collect();
        let rises = steps.windows(2).all(|pair| pair[0].1 <= pair[1].1);
        return rises.then_some(Course { by: LegsBy::Count, steps, done_s: None });
    }
    let waypoint = counted(progress, waypoints.len())?;
    let told = progress.iter().filter_map(|step| Some((step.t_s, waypoint(step.item)?)));
    let (steps, behind): (Vec<_>, Vec<_>) = told.partition(|(_, waypoint)| *waypoint <= last);
    Some(Course { by: LegsBy::Count, steps, done_s: behind.first().map(|(t, _)| *t) })
}

/// Which of so many waypoints an item flies to, where it flies to one: what lies behind the last counts on. `None`: the
/// items' numbers do not tell.
///
/// What a log shows need not be all that was uploaded: it may begin amid the mission, or end there. Only where it says
/// how many items there are do their numbers tell where they stand.
fn counted(progress: &[Progress], waypoints: usize) -> Option<impl Fn(u32) -> Option<usize>> {
    let total = progress[0].of?;
    let mut items: Vec<u32> = progress.iter().map(|step| step.item).collect();
    items.dedup();
    let follow = items.windows(2).all(|pair| pair[0] < pair[1]) && items.iter().all(|item| *item < total);
    if !follow || progress.iter().any(|step| step.of != Some(total)) {
        return None;
    }
    // Take-off before and landing behind, or neither.
    let skipped = |count: usize| match count.checked_sub(waypoints)? {
        0 => Some(0),
        2 => Some(1),
        _ => None,
    };
    // Commands that take no time are items as well, and nobody sees them: then only those that are seen count, and only
    // if they are all.
    let all_seen = items.windows(2).all(|pair| pair[1] == pair[0] + 1);
    if let Some(skipped) = skipped(total as usize).filter(|_| all_seen) {
        return Some(place_of((0..total).collect(), skipped));
    }
    let is_whole = items.first() == Some(&0) && items.last() == Some(&(total - 1));
    let skipped = skipped(items.len()).filter(|_| is_whole)?;
    Some(place_of(items, skipped))
}

fn place_of(items: Vec<u32>, skipped: usize) -> impl Fn(u32) -> Option<usize> {
    move |item| items.iter().position(|known| *known == item)?.checked_sub(skipped)
}

/// Refuses a table's column `leg` that numbers other legs than those between `waypoints`, of 0 to the last; behind the
/// last waypoint it may go on by one, which says that all are reached.
pub(super) fn check_column(logged: &Logged, waypoints: usize) -> Result<(), String> {
    let steps = || logged.progress.iter().filter(|_| logged.format == "CSV");
    // Leg 4 flies to item 5.
    let leg = |step: &Progress| step.item.saturating_sub(1) as usize;
    let legs = waypoints.saturating_sub(1);
    let wrong = |step: &Progress, why: &str| {
        let last = legs.saturating_sub(1);
        Err(format!("column `leg` is {} at t = {} s, must be 0 … {last}{why}", leg(step), step.t_s))
    };
    if let Some(step) = steps().find(|step| leg(step) > legs) {
        return wrong(step, "");
    }
    match steps().find(|step| leg(step) == legs) {
        Some(step) if steps().all(|step| leg(step) > 0) => wrong(step, ": it seems to number legs from 1"),
        _ => Ok(()),
    }
}

/// Each target is the next waypoint, or a later one, that lies within `accept` of it; targets before the first and
/// behind the last are take-off and landing. Waypoints may be passed over only where the mission never says that it
/// flies there: then it is no mission over these. A log that begins amid the mission, on the way to one of the others,
/// does not tell which of them were flown to before.
fn by_targets(progress: &[Progress], waypoints: &[Point3<f64>], accept: f64) -> Option<Course> {
    let last = waypoints.len() - 1;
    let (mut steps, mut next, mut done_s): (Vec<(f64, usize)>, usize, Option<f64>) = (Vec::new(), 0, None);
    for step in progress {
        let Some(target) = step.target_m else { continue };
        let near = |waypoint: &Point3<f64>| (target - waypoint).norm() <= accept;
        if steps.last().is_some_and(|(_, current)| near(&waypoints[*current])) {
            continue;
        }
        if next <= last && near(&waypoints[next]) {
            steps.push((step.t_s, next));
            next += 1;
        } else if next > last {
            done_s = done_s.or(Some(step.t_s));
        } else if next > 0 || (step.item > 0 && waypoints.iter().any(near)) {
            return None;
        }
    }
    (next >= 2).then_some(Course { by: LegsBy::Targets, steps, done_s })
}

/// The first sample within `accept` m of `place`, or how near (m) the nearest comes.
pub(super) fn first_near(samples: &[Sample], place: &Point3<f64>, accept: f64) -> Result<usize, f64> {
    let far = |sample: &Sample| (sample.p_m - place).norm();
    let found = samples.iter().position(|sample| far(sample) <= accept);
    found.ok_or_else(|| samples.iter().map(far).fold(f64::INFINITY, f64::min))
}
