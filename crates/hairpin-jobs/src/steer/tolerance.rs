//! Tolerances on both sides: a start within them is there already, and where the exact goal takes a long way round a
//! goal within them may be near. The exact goal goes first; what it is answered with, without a detour, stays.

use std::time::Instant;

use hairpin::feasibility::steering::shooting::flat::Status::Infeasible as Lacking;
use hairpin::feasibility::steering::shooting::nearest::direct_arc;
use hairpin::feasibility::steering::shooting::query::{Curvatures, Goal, Precision, Query};
use hairpin::feasibility::steering::shooting::solve::{Choices, Solution, least_length};
use hairpin::feasibility::steering::shooting::{Control, flat};
use hairpin::trajectory::SpeedProfile;
use hairpin::trajectory::drive::Segment;
use hairpin_formats::steering::{Asked, Status};

use super::answered::Answered;
use super::pace::direction;
use super::solver::Solver;
use super::vehicle::{Vehicle, query};

/// A drive longer than the way there, and than any would have to be, by this factor takes a detour.
const LONG: f64 = 1.5;
/// Shares of the tolerances by which goals are moved; what is left is for the solver and the replay.
const MOVED: [f64; 2] = [0.9, 0.45];
/// How exactly a moved goal is met, as a share of the tolerances.
const AIM: f64 = 0.05;
/// Moved goals of which an arc is asked for at most, those that bend least first …
const ASKED: usize = 6;
/// … and that are answered at most, the shortest first.
const ANSWERED: usize = 2;
/// Times the bounds that the cubic to a goal may bend: arcs with more parameters bend less.
const BENT: f64 = 2.0;
/// Angles from the straight way, rad, up to which the cubic tells.
const WIDE: f64 = 1.2;
/// Bends and their rates that it takes to come out by a metre, a radian or a 1/m elsewhere, in powers of the way's
/// length.
const BEND: f64 = 6.0;
const RATE: f64 = 36.0;

impl Vehicle {
    /// Answers a question: solved under the clock, then replayed without it.
    pub fn answer(&self, asked: &Asked) -> Answered {
        let (asked, solver) = (&self.near(asked), self.solver());
        let exact = self.answer_by(asked, &solver);
        match self.detour(asked, &exact, &solver) {
            Some((length, query)) => self.nearer(asked, exact, length, &query, &solver),
            None => exact,
        }
    }

    /// Whether the start of `asked` lies within all tolerances of its goal: nothing is driven then.
    pub(super) fn is_there(&self, asked: &Asked, profile: &SpeedProfile, precision: &Precision) -> bool {
        let [x, y, yaw] = asked.goal;
        let free_end = asked.free_end && self.pace.control == Control::VelocityPolynomial;
        libm::hypot(x, y) <= precision.position
            && wrapped(yaw).abs() <= precision.yaw
            && (free_end || (asked.k0 - asked.kf).abs() <= precision.curvature)
            && (profile.end() - profile.start()).abs() <= self.pace.speed_precision
            && direction(asked).swing() == 0.0
    }

    /// How long a good answer is, and its question in the frame of travel, if it takes a detour that a goal within the
    /// tolerances could spare.
    fn detour(&self, asked: &Asked, exact: &Answered, solver: &Solver<'_>) -> Option<(f64, Query)> {
        let (solution, replay) = exact.drive.as_ref().filter(|_| exact.status == Status::Ok)?;
        let [x, y, _] = asked.goal;
        let chord = libm::hypot(x, y);
        if replay.length <= LONG * chord || solver.time_limit.is_some_and(|limit| exact.solving >= limit) {
            return None;
        }
        let bounds = self.bounds(asked);
        let query = query(asked, &bounds).ok()?;
        let long = replay.length > LONG * least_length(&query, &bounds);
        (long && within_reach(solution, chord, &solver.precision(asked))).then_some((replay.length, query))
    }

    /// The shortest drive to a goal within the tolerances that the replay accepts; `exact`, which is `longest` m, where
    /// none is shorter.
    fn nearer(&self, asked: &Asked, exact: Answered, longest: f64, query: &Query, solver: &Solver<'_>) -> Answered {
        let (precision, bounds) = (solver.precision(asked), self.bounds(asked));
        let aim = precision.share(AIM);
        let begun = Instant::now();
        // What an arc is known to lack by little may be had at wide angles, too.
        let lacks = exact.drive.as_ref().is_some_and(|(exact, _)| matches!(exact.arc, Some(Lacking { .. })));
        let wide = if lacks { 1.0 } else { f64::INFINITY };
        let mut goals: Vec<(f64, Goal)> = moved(query, &precision, &bounds)
            .into_iter()
            .map(|goal| (bent(&Query { goal, ..*query }, &bounds).unwrap_or(wide), goal))
            .filter(|(bent, _)| *bent <= BENT)
            .collect();
        goals.sort_by(|a, b| a.0.total_cmp(&b.0));
        goals.truncate(ASKED);
        if let Some(choices) = self.arcs(aim, solver) {
            let arc = |(_, goal): (f64, Goal)| {
                let arc = direct_arc(&Query { goal, ..*query }, &bounds, &choices)?;
                Some((arc.iter().map(Segment::length_m).sum(), goal))
            };
            goals = goals.into_iter().filter_map(arc).filter(|(length, _)| *length < longest).collect();
            goals.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        let mut best = (longest, None);
        let mut solving = exact.solving + begun.elapsed();
        for (_, goal) in goals.into_iter().take(ANSWERED) {
            let Goal { x, y, yaw, curvature } = flat::crab(&Query { goal, ..*query }, -asked.direction).goal;
            let towards = Asked { goal: [x, y, yaw], kf: curvature, ..*asked };
            let answered = self.answer_towards(asked, &towards, aim, solver);
            solving += answered.solving;
            let length = answered.drive.as_ref().map(|(_, replay)| replay.length);
            if let Some(length) = length.filter(|length| answered.status == Status::Ok && *length < best.0) {
                best = (length, Some(answered));
            }
            if solver.time_limit.is_some_and(|limit| solving >= limit) {
                break;
            }
        }
        Answered { solving, ..best.1.unwrap_or(exact) }
    }

    /// How single arcs are asked for, which are the quickest to tell goals apart by; `None` for controls without them.
    fn arcs<'t>(&self, aim: Precision, solver: &Solver<'t>) -> Option<Choices<'t>> {
        let control = [Control::Cubic, Control::Quintic].into_iter().find(|control| *control == self.pace.control);
        let flat = flat::Settings { precision: aim, control: control?.flat()?, ..solver.choices.flat };
        Some(Choices { flat, ..solver.choices })
    }
}

/// Whether what a single arc to the goal exceeds is of the size of what moving the goal within the tolerances changes:
/// over a way of `chord` m a metre aside bends by so many times 1/chord², and so on. Where no arc tells, it may be.
fn within_reach(solution: &Solution, chord: f64, precision: &Precision) -> bool {
    let Some(Lacking { limit, excess }) = solution.arc else { return true };
    let Precision { position, yaw, curvature } = *precision;
    let bend = position / (chord * chord) + yaw / chord + curvature;
    match limit {
        flat::Limit::Curvature => excess <= BEND * bend,
        flat::Limit::CurvatureRate => excess <= RATE * bend / chord,
        flat::Limit::Yaw | flat::Limit::EndCurvature => true,
    }
}

/// How many times the bounds the drive to the goal of `query` bends whose curvature is a cubic of the way along its
/// chord: κ = κ₀ + b t + c t² + d t³, t = 0 … 1, with the goal's curvature at its end, the heading ψ as its integral,
/// and no way aside of the chord, whose direction is θ. For small angles; `None` where they are wide.
fn bent(query: &Query, bounds: &Curvatures) -> Option<f64> {
    let Goal { x, y, yaw, curvature } = query.goal;
    let (length, direction) = (libm::hypot(x, y), libm::atan2(y, x));
    let yaw = wrapped(yaw);
    if direction.abs() > WIDE || (yaw - direction).abs() > WIDE {
        return None;
    }
    let start = query.start_curvature;
    let (end, turn, aside) = (curvature - start, yaw / length - start, direction / length - 0.5 * start);
    let b = 60.0 * aside - 24.0 * turn + 3.0 * end;
    let c = 12.0 * turn - 3.0 * end - 3.0 * b;
    let d = end - b - c;
    Some((0..=8).map(|i| f64::from(i) / 8.0).fold(0.0, |most: f64, t| {
        let bend = start + t * (b + t * (c + t * d));
        let rate = (b + t * (2.0 * c + 3.0 * t * d)) / length;
        most.max(bend.abs() / bounds.most).max(rate.abs() / bounds.most_rate)
    }))
}

/// Goals within the tolerances of that of `query`, in the directions in which goals come nearer to what is driven
/// without bending to and fro: straight on, or along one arc, y = x tan(ψ/2).
fn moved(query: &Query, precision: &Precision, bounds: &Curvatures) -> Vec<Goal> {
    let Goal { x, y, yaw, curvature } = query.goal;
    let mut goals: Vec<Goal> = Vec::new();
    for share in MOVED {
        let Precision { position, yaw: turned, curvature: bent } = precision.share(share);
        let aside = |to: f64| toward(y, to, position);
        let turn = |to: f64| yaw + wrapped(to - yaw).clamp(-turned, turned);
        let (beside, along) = (|yaw: f64| x * libm::tan(0.5 * wrapped(yaw)), |y: f64| 2.0 * libm::atan2(y, x));
        let (to_arc, straight) = (aside(beside(yaw)), aside(0.0));
        let places = [
            (x, straight, turn(0.0)),
            (x, y, turn(0.0)),
            (x, y, turn(along(y))),
            (x, to_arc, yaw),
            (x, to_arc, turn(along(to_arc))),
            (x, straight, turn(along(straight))),
            (x + position, y, turn(along(y))),
            (x - position, y, turn(along(y))),
        ];
        let bends = [curvature, toward(curvature, query.start_curvature, bent), toward(curvature, 0.0, bent)];
        for (x, y, yaw) in places {
            for bend in bends {
                let goal = Goal { x, y, yaw, curvature: bend.clamp(-bounds.most, bounds.most) };
                if x.is_finite() && y.is_finite() && goal != query.goal && !goals.contains(&goal) {
                    goals.push(goal);
                }
            }
        }
    }
    goals
}

/// `from`, moved towards `to` by `most` at most.
fn toward(from: f64, to: f64, most: f64) -> f64 {
    from + (to - from).clamp(-most, most)
}

/// −π … π.
fn wrapped(angle: f64) -> f64 {
    libm::atan2(libm::sin(angle), libm::cos(angle))
}
