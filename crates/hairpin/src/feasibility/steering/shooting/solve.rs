//! One question, one answer: the single arc where it does, and what does it where no arc can.
//!
//! Order of what is tried, by what it costs: a single arc that is short beside a lower bound (the way itself and the
//! turning of the heading; then, in one gear without turns in place, Dubins' length), turn–drive–turn where it may be
//! driven, in both gears if these may be, the words of clothoids, and the arc after all where the words are no shorter
//! by a quarter. So smoothness is bought with length up to a factor of 1.25 and no farther. Of drives of equal length
//! the one with the least turning in place is taken, then the one with the fewest stops.

use std::f64::consts::{PI, TAU};

use crate::math::fresnel::clothoid;
use crate::trajectory::drive::{Gear, Motion, Segment, SegmentList};

use super::cc::{self, Gears};
use super::families;
use super::flat;
use super::preference::Effort;
use super::query::{Curvatures, Goal, Query};

/// What may be driven, and how hard to look for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choices<'t> {
    /// The gear of drives without reversals, and of single arcs.
    pub gear: Gear,
    /// Whether the gear may change on the way.
    pub reversals: bool,
    /// Whether the vehicle may turn in place.
    pub turns: bool,
    /// Whether single arcs are tried at all.
    pub arcs: bool,
    /// For the single arc.
    pub flat: flat::Settings<'t>,
    /// For the families of controls that have a search of their own; the precision is the single arc's.
    pub families: families::Settings,
}

impl Default for Choices<'_> {
    /// Forward arcs, no reversals, no turns in place.
    fn default() -> Self {
        Self {
            gear: Gear::Forward,
            reversals: false,
            turns: false,
            arcs: true,
            flat: flat::Settings::default(),
            families: families::Settings::default(),
        }
    }
}

/// How an answer was found.
///
/// `Clothoids` is the closed form: there for every checked query, longer or sharper than need be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Curvature polynomials in one gear, by iteration.
    SingleArc,
    /// Turn, drive, turn.
    TurnDriveTurn,
    /// Lines, arcs and clothoids, in closed form.
    Clothoids,
}

/// How it ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The drive solves the query within the bounds.
    Solved,
    /// Stopped: the best so far.
    Stopped,
    /// No drive was found.
    NotConverged,
}

/// The answer to a query.
///
/// `segments` is a drive in every case; only `Solved` says that it ends at the goal within the bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution {
    /// How it ended.
    pub outcome: Outcome,
    /// The drive.
    pub segments: SegmentList,
    /// How it was found.
    pub method: Method,
    /// Steps of all iterations.
    ///
    /// A count of work, not of quality; closed forms add nothing.
    pub iterations: u32,
    /// What the single arc lacks where another drive had to do; `None` where none was tried.
    pub arc: Option<flat::Status>,
}

/// A smooth arc is worth this much more length than the shortest path that is known, or any that is thinkable.
const PATIENCE: f64 = 1.25;

/// Solves `query` within `bounds`: a single arc if it keeps them without a long way round; else, as allowed, turn,
/// drive, turn, or the shortest path of continuous curvature.
///
/// A cost is lowered along the single arc that is chosen so; by how much it may grow for that, does not decide. `stop`
/// is asked between the stages; stopped before the first, the answer is the single arc's start value.
///
/// Accepted is what the numbers handed out integrate to, not what the iteration believed.
///
/// Outcomes: `Solved`, of an arc where its own numbers meet the goal within `flat.precision` and both bounds;
/// `NotConverged` where neither an arc nor a closed form does; `Stopped` with what there was. Nothing is allocated.
///
/// ```
/// use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, solve};
/// use hairpin::feasibility::steering::shooting::{Curvatures, Goal, Query};
/// use hairpin::trajectory::drive::Segment;
///
/// // A car: |κ| ≤ 0.2 1/m, |κ′| ≤ 0.1 1/m². To a place 20 m ahead and 4 m to the left, heading as before.
/// let bounds = Curvatures { most: 0.2, most_rate: 0.1 };
/// let goal = Goal { x: 20.0, y: 4.0, yaw: 0.0, curvature: 0.0 };
/// let query = Query::new(0.0, goal, &bounds)?;
/// let answer = solve(&query, &bounds, &Choices::default(), || false);
/// assert_eq!(answer.outcome, Outcome::Solved);
/// let length: f64 = answer.segments.iter().map(Segment::length_m).sum();
/// assert!(length > 20.0_f64.hypot(4.0) && length < 22.0);
/// # Ok::<(), hairpin::feasibility::steering::shooting::Refusal>(())
/// ```
pub fn solve(query: &Query, bounds: &Curvatures, choices: &Choices, mut stop: impl FnMut() -> bool) -> Solution {
    let flat = flat::Settings { cost: flat::Cost::Any, ..choices.flat };
    let solution = plainly(query, bounds, &Choices { flat, ..*choices }, &mut stop);
    let arc = solution.outcome == Outcome::Solved && solution.method == Method::SingleArc;
    if choices.flat.cost == flat::Cost::Any || !arc || stop() {
        return solution;
    }
    let cheap = single_arc(query, bounds, choices.gear, &choices.flat);
    if cheap.status != flat::Status::Ok {
        return solution;
    }
    Solution { segments: cheap.segments, iterations: cheap.iterations, arc: Some(cheap.status), ..solution }
}

/// The arc if it is solved and within [`PATIENCE`] of a lower bound on any answer's length, asked in the order of what
/// the bounds cost; else turns and a line where turns in place are chosen; else the clothoid path, unless the arc is
/// within [`PATIENCE`] of that. Stopped early it hands out the arc it has, or the start of one.
fn plainly(query: &Query, bounds: &Curvatures, choices: &Choices, mut stop: impl FnMut() -> bool) -> Solution {
    let mut solution = Solution {
        outcome: Outcome::Stopped,
        segments: SegmentList::EMPTY,
        method: Method::SingleArc,
        iterations: 0,
        arc: None,
    };
    if stop() {
        let start = flat::Settings { iterations: 0, ..choices.flat };
        solution.segments = single_arc(query, bounds, choices.gear, &start).segments;
        return solution;
    }
    if choices.arcs {
        let arc = single_arc(query, bounds, choices.gear, &choices.flat);
        solution = Solution { segments: arc.segments, iterations: arc.iterations, arc: Some(arc.status), ..solution };
    }
    let arc = (solution.arc == Some(flat::Status::Ok)).then(|| length(&solution.segments));
    let arc_within = |metres: f64| arc.is_some_and(|arc| arc <= PATIENCE * metres);
    // Asked in the order of what they cost: most arcs are plainly short.
    if arc_within(least_length(query, bounds))
        || (!choices.reversals
            && !choices.turns
            && arc.is_some()
            && arc_within(flat::least_length(&mirrored(query, choices.gear), bounds)))
    {
        return Solution { outcome: Outcome::Solved, ..solution };
    }
    if stop() {
        let outcome = if arc.is_some() { Outcome::Solved } else { Outcome::Stopped };
        return Solution { outcome, ..solution };
    }
    if choices.turns {
        let (segments, method) = with_turns(query, bounds, choices);
        return Solution { outcome: Outcome::Solved, segments, method, ..solution };
    }
    let gears = if choices.reversals { Gears::Both } else { Gears::Only(choices.gear) };
    match cc::steer(query, bounds, gears) {
        Some(path) if !arc_within(path.length_m()) => {
            let segments = listed(&path);
            Solution { outcome: Outcome::Solved, segments, method: Method::Clothoids, ..solution }
        }
        _ if arc.is_some() => Solution { outcome: Outcome::Solved, ..solution },
        _ => Solution { outcome: Outcome::NotConverged, ..solution },
    }
}

/// Metres below which no path of these bounds solves the query, in any gears: the way itself, and the heading to be
/// turned, where arriving backwards is no turn saved.
///
/// √(x² + y²) and |ψ|/κ_max, whichever is larger, ψ in (−π, π]; m. Valid in both gears and with cusps, since |ψ′| ≤
/// κ_max in each; turns in place would undercut the second.
pub fn least_length(query: &Query, bounds: &Curvatures) -> f64 {
    libm::hypot(query.goal.x, query.goal.y).max(wrapped(query.goal.yaw).abs() / bounds.most)
}

fn length(segments: &[Segment]) -> f64 {
    segments.iter().map(Segment::length_m).sum()
}

/// The single arc in `gear`; in reverse it is the mirror image, about the y axis, of one that is driven forward.
pub(super) fn single_arc(query: &Query, bounds: &Curvatures, gear: Gear, settings: &flat::Settings) -> flat::Answer {
    let mut answer = flat::forward(&mirrored(query, gear), bounds, settings);
    if gear == Gear::Reverse {
        for segment in answer.segments.iter_mut() {
            segment.gear = segment.gear.opposite();
        }
    }
    answer
}

/// Hands over the single arc along every way around for which there is one.
///
/// At most six, each solved for itself without the search's early end.
pub(in crate::feasibility::steering) fn single_arcs(
    query: &Query,
    bounds: &Curvatures,
    choices: &Choices,
    mut take: impl FnMut(SegmentList),
) {
    flat::every(&mirrored(query, choices.gear), bounds, &choices.flat, |mut segments| {
        if choices.gear == Gear::Reverse {
            segments.iter_mut().for_each(|segment| segment.gear = segment.gear.opposite());
        }
        take(segments);
    });
}

/// The question that a drive in `gear` answers if it is driven forward.
fn mirrored(query: &Query, gear: Gear) -> Query {
    match gear {
        Gear::Forward => *query,
        Gear::Reverse => Query { goal: Goal { x: -query.goal.x, yaw: -query.goal.yaw, ..query.goal }, ..*query },
    }
}

/// The shortest closed form where turns in place are allowed: turn–drive–turn, in both gears with `choices.reversals`.
///
/// Of lengths within 10⁻⁹ m, or that share of them, the least turning in place, then the fewest stops, then the
/// preferred gear: straight back is driven in reverse, not between two half turns. Where an end is bent, and arcs are
/// tried, words of clothoids with cusps may be shorter than the ways to straight wheels.
pub(in crate::feasibility::steering) fn with_turns(
    query: &Query,
    bounds: &Curvatures,
    choices: &Choices,
) -> (SegmentList, Method) {
    let mut best = (turn_drive_turn(query, bounds, choices.gear), Method::TurnDriveTurn);
    if !choices.reversals {
        return best;
    }
    let mut effort = Effort::of(&best.0);
    let mut offer = |segments: SegmentList, method: Method| {
        let found = Effort::of(&segments);
        if found.against(&effort).is_lt() {
            (best, effort) = ((segments, method), found);
        }
    };
    offer(turn_drive_turn(query, bounds, choices.gear.opposite()), Method::TurnDriveTurn);
    let bent = query.start_curvature != 0.0 || query.goal.curvature != 0.0;
    if choices.arcs
        && bent
        && let Some(path) = cc::steer(query, bounds, Gears::Both)
    {
        offer(listed(&path), Method::Clothoids);
    }
    best
}

/// A path as segments.
pub(in crate::feasibility::steering) fn listed(path: &cc::Path) -> SegmentList {
    let mut segments = SegmentList::EMPTY;
    path.segments(|segment| segments.add(segment));
    segments
}

/// Clothoid to zero curvature, turn, straight, turn, clothoid from zero curvature; what there is no need of is left
/// out.
///
/// Clothoids at both ends take |κ|/κ′_max metres and turn by κ|κ|/(2κ′_max), so that the wheels stand straight where
/// the vehicle turns in place. Always an answer: at most two clothoids, two turns and a straight, or a straight of 0 m
/// where there is nothing to do. Turns by the smaller angle each.
pub(in crate::feasibility::steering) fn turn_drive_turn(query: &Query, bounds: &Curvatures, gear: Gear) -> SegmentList {
    let sign = gear.sign();
    let rate = bounds.most_rate * (1.0 - 1e-12);
    let (k0, kf) = (query.start_curvature, query.goal.curvature);
    // Displacement and change of heading over a clothoid between `k` and zero, driven away from the end it belongs to.
    let away = |k: f64, sign: f64| {
        let (x, y) = clothoid(k, 0.0, rate);
        (sign * x, y, sign * 0.5 * k * k.abs() / rate)
    };
    let (x0, y0, yaw0) = away(k0, sign);
    let (x1, y1, yaw1) = away(kf, -sign);
    // From the end of the first clothoid to the beginning of the last; in reverse, as its mirror image.
    let (sin, cos) = libm::sincos(query.goal.yaw);
    let (dx, dy) = (query.goal.x + cos * x1 - sin * y1 - x0, query.goal.y + sin * x1 + cos * y1 - y0);
    let (sin, cos) = libm::sincos(yaw0);
    let yaw = sign * (query.goal.yaw + yaw1 - yaw0);
    let between = Goal { x: sign * (cos * dx + sin * dy), y: cos * dy - sin * dx, yaw, curvature: 0.0 };
    let mut segments = SegmentList::EMPTY;
    let mut push = |segment: Segment| {
        if segment.length_m() > 0.0 || matches!(segment.motion, Motion::Turn { .. }) {
            segments.add(segment);
        }
    };
    push(Segment::clothoid(k0.abs() / rate, k0, 0.0, gear));
    for segment in flat::turn_drive_turn(&between).iter() {
        push(match segment.motion {
            Motion::Arc { .. } => Segment { gear, ..*segment },
            Motion::Turn { angle_rad } => Segment { motion: Motion::Turn { angle_rad: sign * angle_rad }, ..*segment },
        });
    }
    push(Segment::clothoid(kf.abs() / rate, 0.0, kf, gear));
    if segments.is_empty() {
        segments.add(Segment::straight(0.0, gear));
    }
    segments
}

/// `angle` in (−π, π].
fn wrapped(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}
