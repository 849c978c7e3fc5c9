//! The search: one descent after another, from the nearest start values, until one keeps goal and bounds.
//!
//! In units of the least radius, so that weights and tolerances are the same for a toy and a truck. Start values say
//! which way around the goal is gone and how often the heading turns; a descent keeps that, for the turn is one of its
//! constraints and not modulo 2π.

use std::f64::consts::TAU;

use super::basis::{Basis, Row};
use super::clock::Clock;
use super::descend::{Free, Task, descend};
use super::found::{Found, cost, judge};
use super::grid::Grid;
use super::landing::landing;
use super::parameters::{Parameters, named};
use super::pieces;
use super::problem::{Among, Answer, Iteration, Problem};
use super::settings::Settings;
use super::start::{nearest, word};
use crate::feasibility::steering::shooting::control::Control;
use crate::feasibility::steering::shooting::flat::{self, Cost, Status, forward, ways};
use crate::feasibility::steering::shooting::{Curvatures, Goal, Query};
use crate::math::power::power;
use crate::trajectory::SpeedProfile;
use crate::trajectory::drive::{Motion, Segment, SegmentList};

/// The descents' tolerance as a share of the precision.
/// So that what fitting commands to the family loses does not count.
const TOLERANCE: f64 = 1e-3;
/// A drive no longer than the shortest way around by this factor is short enough.
const SHORT: f64 = 1.25;
/// Rounds in which length and speeds are made to agree.
const ROUNDS: u32 = 12;
/// What a drive of less cost may be longer by than its start value, as a factor.
const LONGEST: f64 = 1.5;
/// Factors on the radius of Dubins' words as start values.
const RADII: [f64; 4] = [1.0, 1.5, 2.5, 0.8];

/// Drives forward from the origin to the goal of `problem` within `bounds`, the curvature being of the family
/// `control`.
///
/// ```text
/// x′ = cos(ψ + δ)   y′ = sin(ψ + δ)   ψ′ = κ   δ = swing · s/L   κ = Σ pᵢ Bᵢ   |κ| ≤ most   |κ′| ≤ most_rate
/// ```
/// Metres and radians. Mirrored problems have mirrored answers, to the bit. `stop` is asked before each descent;
/// `observe` sees every step. The single arc and turns in place are not of these families: they are answered as the
/// quintic.
///
/// Up to `starts` descents of up to `iterations` steps; a step is one pass over the grid and one dense solve of 16
/// equations.
///
/// Deterministic for a given `stop`. Status as of the flat solver: `Ok`, `Infeasible` by the limit that is exceeded by
/// most, or `NotConverged` with the distance in m.
pub fn solve(
    problem: &Problem,
    control: Control,
    bounds: &Curvatures,
    settings: &Settings,
    stop: &mut dyn FnMut() -> bool,
    observe: &mut dyn FnMut(&Iteration),
) -> Answer {
    let Problem { query, swing, .. } = problem;
    let Goal { y, yaw, curvature, .. } = query.goal;
    let leans = [y, yaw, query.start_curvature, curvature, *swing].into_iter().find(|value| *value != 0.0);
    let open = Among { guides: &[], depth: &|_| 0.0 };
    if leans.is_some_and(|first| first < 0.0) {
        return mirrored(search(&mirror(problem), control, bounds, settings, &open, stop, observe));
    }
    search(problem, control, bounds, settings, &open, stop, observe)
}

/// The same among what is in the way: of the drives that meet goal and bounds the one that comes least deep into it,
/// begun with the guides, too.
///
/// Not mirrored: what is in the way has no mirror image.
///
/// `among.depth` is asked about commands that meet the goal and the bounds only. The search does not end at a good
/// drive that is not clear.
pub fn solve_among(
    problem: &Problem,
    control: Control,
    bounds: &Curvatures,
    settings: &Settings,
    among: &Among<'_>,
    stop: &mut dyn FnMut() -> bool,
    observe: &mut dyn FnMut(&Iteration),
) -> Answer {
    search(problem, control, bounds, settings, among, stop, observe)
}

/// About the x axis.
fn mirror(problem: &Problem) -> Problem {
    let Goal { x, y, yaw, curvature } = problem.query.goal;
    let goal = Goal { x, y: -y, yaw: -yaw, curvature: -curvature };
    let query = Query { start_curvature: -problem.query.start_curvature, goal };
    Problem { query, swing: -problem.swing, ..*problem }
}

/// About the x axis: curvatures change their signs.
fn mirrored(mut answer: Answer) -> Answer {
    for segment in answer.segments.iter_mut() {
        if let Motion::Arc { curvature, .. } = &mut segment.motion {
            curvature.iter_mut().for_each(|a| *a = -*a);
        }
    }
    answer.parameters = answer.parameters.mirrored();
    answer
}

/// A search under way, in units of the least radius.
///
/// Scaled by 1/most: lengths in least radii, curvatures over the bound, so that tolerances and weights serve all
/// vehicles.
///
/// `best` holds metres in its segments and radii in its fit.
struct Search<'a> {
    problem: &'a Problem,
    control: Control,
    bounds: &'a Curvatures,
    settings: &'a Settings,
    among: &'a Among<'a>,
    /// What descents lower beside what is missing.
    lowering: Cost,
    best: Option<Found>,
    iterations: u32,
    started: u32,
    /// What drives of less cost may be at the longest, m: so much more than the first start value.
    longest: f64,
}

/// Starts from the flat solver's curve, then the given guides, then words of arcs and lines of one and more radii,
/// shortest first; each a descent. Ends with a drive that keeps everything and is hardly longer than the least length
/// of any, when starts are used up, or at `stop`. With a cost, further descents begin at the best found and at the flat
/// curve.
fn search(
    problem: &Problem,
    control: Control,
    bounds: &Curvatures,
    settings: &Settings,
    among: &Among<'_>,
    stop: &mut dyn FnMut() -> bool,
    observe: &mut dyn FnMut(&Iteration),
) -> Answer {
    let mut search = Search {
        problem,
        control,
        bounds,
        settings,
        among,
        lowering: Cost::Any,
        best: None,
        iterations: 0,
        started: 0,
        longest: 0.0,
    };
    let (path, most) = (problem.path(bounds), bounds.most);
    let flat = forward(&path, bounds, &flat::Settings { precision: settings.precision, ..flat::Settings::default() });
    let shortest = flat::least_length(&path, bounds);
    for (index, known) in std::iter::once(&flat.segments).chain(among.guides).enumerate() {
        // The first is always tried: without time there is still an answer.
        if index == 0 || !(search.done(shortest) || stop()) {
            search.along(known, 0.0, observe);
        }
    }
    for radius in RADII {
        let wide = Curvatures { most: most / radius, ..*bounds };
        for (signs, metres) in ways(&path, &wide) {
            let whole: f64 = metres.iter().sum();
            if !whole.is_finite()
                || whole <= 0.0
                || search.done(shortest)
                || search.started >= settings.starts
                || stop()
            {
                continue;
            }
            let turn: f64 = signs.iter().zip(metres).map(|(sign, piece)| sign * piece * wide.most).sum();
            let curvature = |share: f64| word(signs, metres, wide.most, share);
            search.from(&curvature, whole + 0.3 * most / bounds.most_rate, turn, observe);
        }
    }
    // What costs less is looked for from what is there: an answer is never dearer than without a cost.
    search.lowering = settings.cost;
    if settings.cost != Cost::Any
        && let Some(best) = search.best.as_ref().map(|best| best.segments)
    {
        // Its curvature is that of the body; starts are paths of travel, which turn by the direction, too.
        search.along(&best, problem.swing, observe);
        if !stop() {
            search.along(&flat.segments, 0.0, observe);
        }
    }
    search.answer()
}

/// κ of `segments` after `s` metres.
fn curvature_along(segments: &[Segment], mut s: f64) -> f64 {
    for segment in segments {
        let length = segment.length_m();
        if s <= length {
            return segment.curvature_at(s);
        }
        s -= length;
    }
    segments.last().map_or(0.0, |last| last.curvature_at(last.length_m()))
}

impl Search<'_> {
    /// The functions of the family and what they are functions of, for a drive of about `length` metres.
    ///
    /// `length` in m; it decides only what trapezoids look like.
    fn family(&self, length: f64) -> (Basis, Clock) {
        let speed = &self.problem.speed;
        match self.control {
            Control::Cubic => (Basis::Polynomial(3), Clock::Metres),
            Control::Knots => (Basis::Knots, Clock::Metres),
            Control::TimePolynomial if !speed.is_constant() => {
                (Basis::Polynomial(5), Clock::seconds(speed.over(length)))
            }
            Control::VelocityPolynomial => {
                let shape = speed_polynomial(speed, length);
                let clock = Clock::Polynomial(shape);
                (Basis::ratio(timed_order(&clock), shape), clock)
            }
            _ => (Basis::Polynomial(5), Clock::Metres),
        }
    }

    /// Whether a drive was found that is good and not a long way round.
    ///
    /// `shortest` in m: no longer than 1.25 times that.
    fn done(&self, shortest: f64) -> bool {
        let short = |found: &Found| found.fit.free.length <= SHORT * shortest * self.bounds.most;
        self.best.as_ref().is_some_and(|found| found.status == Status::Ok && found.depth == 0.0 && short(found))
    }

    /// Descends from a known path, turned by `swing` more along its way.
    ///
    /// `known` in m; a list without length is passed over.
    fn along(&mut self, known: &SegmentList, swing: f64, observe: &mut dyn FnMut(&Iteration)) {
        let length: f64 = known.iter().map(Segment::length_m).sum();
        if length > 0.0 {
            let curvature = |share: f64| curvature_along(known, share * length) + swing / length;
            self.from(&curvature, length, landing(known, 0.0)[2] + swing, observe);
        }
    }

    /// Descends from a curve of the path of travel; its whole turn says how often the goal's heading is gone around.
    ///
    /// `curvature` of the share of the metres, 1/m; `turn` in rad is that of the whole path of travel. The length that
    /// comes out is fed back as the length of the speeds until both agree to 10⁻⁹, in at most twelve rounds; where they
    /// do not settle nothing is kept of this start.
    fn from(&mut self, curvature: &dyn Fn(f64) -> f64, length: f64, turn: f64, observe: &mut dyn FnMut(&Iteration)) {
        let Problem { query, swing, free_end, .. } = *self.problem;
        let most = self.bounds.most;
        if self.started == 0 {
            self.longest = LONGEST * length;
        }
        let whole = ((turn - swing - query.goal.yaw) / TAU).round();
        let task = Task {
            place: [query.goal.x * most, query.goal.y * most],
            turn: query.goal.yaw + whole * TAU,
            swing,
            start: query.start_curvature / most,
            end: (!(free_end && self.control == Control::VelocityPolynomial)).then_some(query.goal.curvature / most),
            bounds: Curvatures { most: 1.0, most_rate: self.bounds.most_rate / (most * most) },
            cost: self.lowering,
            longest: self.longest * most,
            tolerance: TOLERANCE * self.settings.precision.position * most.min(1.0),
        };
        let start = self.started;
        self.started += 1;
        let mut metres = length;
        let mut free: Option<Free> = None;
        for _ in 0..ROUNDS {
            let (basis, clock) = self.family(metres);
            let grid = Grid::new(&basis, &clock);
            let begun = free.unwrap_or_else(|| Free {
                parameters: nearest(
                    &grid,
                    &|share| (curvature(share) - swing / length) / most,
                    [Some(task.start), task.end],
                ),
                length: length * most,
            });
            let mut seen = |step, free: &Free, miss, bends| {
                observe(&Iteration { start, step, length: free.length / most, miss, bends });
            };
            let fit = descend(&grid, &task, begun, self.settings, &mut seen);
            self.iterations += fit.iterations;
            let found = fit.free.length / most;
            let settled = (found - metres).abs() <= 1e-9 * metres || !self.shape_depends_on_length();
            if settled || fit.miss > task.tolerance {
                let parameters: Row = fit.free.parameters.map(|p| p * most);
                let (segments, fit_error) = pieces::segments(&basis, &clock, &parameters, found);
                let status = judge(&segments, &task, &query, swing, self.bounds, &self.settings.precision);
                // What does not arrive is not compared by what is in its way.
                let depth = if status == Status::Ok { (self.among.depth)(&segments) } else { 0.0 };
                let cost = cost(&segments, self.settings.cost);
                let found = Found { fit, depth, cost, task, basis, clock, segments, fit_error, status };
                if self.best.as_ref().is_none_or(|best| found.better(best, self.lowering)) {
                    self.best = Some(found);
                }
                return;
            }
            (metres, free) = (found, Some(fit.free));
        }
    }

    /// Trapezoids are other functions of σ for every length.
    ///
    /// Then length and speeds are made to agree in up to 12 rounds.
    fn shape_depends_on_length(&self) -> bool {
        let timed = matches!(self.control, Control::TimePolynomial | Control::VelocityPolynomial);
        timed && matches!(self.problem.speed, SpeedProfile::Trapezoid { .. }) && !self.problem.speed.is_constant()
    }

    /// The best that was found, in metres.
    fn answer(self) -> Answer {
        let Problem { query, speed, .. } = self.problem;
        let Some(Found { fit, basis, clock, segments, fit_error, status, .. }) = self.best else {
            // Nothing to drive: the goal is where the drive begins, or no way around exists.
            let missed = libm::hypot(query.goal.x, query.goal.y);
            let parameters = Parameters::ArcLength { curvature: [0.0; 6], length: 0.0 };
            let status = Status::NotConverged { residual: missed };
            return Answer {
                status,
                segments: SegmentList::EMPTY,
                parameters,
                fit_error: 0.0,
                iterations: self.iterations,
            };
        };
        let most = self.bounds.most;
        let length = fit.free.length / most;
        let parameters: Row = fit.free.parameters.map(|p| p * most);
        let duration = match clock {
            Clock::Polynomial([a, b, c]) => length / (a + b / 2.0 + c / 3.0),
            Clock::Metres | Clock::Seconds { .. } => speed.over(length).duration(),
        };
        let mut named = named(&basis, &clock, &parameters, length, duration);
        if let (Parameters::ArcLength { curvature, .. }, Control::TimePolynomial) = (named, self.control) {
            // At a constant speed time and arc length are one.
            named = Parameters::Time { curvature: in_time(&curvature, speed.start()), duration };
        }
        Answer { status, segments, parameters: named, fit_error, iterations: self.iterations }
    }
}

/// Fifth, and one more for each end at rest: there κ̇ must vanish for κ′ to be finite.
fn timed_order(clock: &Clock) -> usize {
    5 + clock.rests().iter().filter(|rests| **rests).count()
}

/// κ(s) as a polynomial of t = s/v.
fn in_time(curvature: &[f64; 6], speed: f64) -> Row {
    std::array::from_fn(|k| curvature.get(k).map_or(0.0, |a| a * power(speed, k)))
}

/// The quadratic speed, m/s over the share of the time, that a profile stands for: with its ends, and of a trapezoid as
/// much of its top as it comes to in the middle of its time.
///
/// Coefficients of u⁰, u¹, u²; exact for constant speeds and for ramps in time.
fn speed_polynomial(speed: &SpeedProfile, length: f64) -> [f64; 3] {
    let (start, end) = (speed.start(), speed.end());
    let middle = match speed {
        SpeedProfile::Constant { speed } => *speed,
        SpeedProfile::Ramp { .. } => 0.5 * (start + end),
        SpeedProfile::Trapezoid { .. } => {
            let speeds = speed.over(length);
            speeds.speed_at(speeds.place_at(0.5 * speeds.duration()))
        }
    };
    match Clock::through(start, middle, end) {
        Clock::Polynomial(shape) => shape,
        Clock::Metres | Clock::Seconds { .. } => [middle, 0.0, 0.0],
    }
}
