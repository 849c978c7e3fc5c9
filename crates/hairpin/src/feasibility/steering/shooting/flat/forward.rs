//! The search: ways around, shortest first; an arc along each, or a chain where no arc keeps the bounds.
//!
//! Grades order curves: good ones by length, broken ones by how far over a bound, missed ones by distance. What ends
//! the search is a good curve no longer than 1.25 times the next way around.
//!
//! Costs: an arc is given 8 steps where a chain may follow, for descents that converge do so by then; the chain has the
//! whole limit. Where what is handed out ends is judged again, from its own coefficients.

use super::arc::{self, Free};
use super::chain::{self, Chain};
use super::dubins::{Word, words};
use super::ends::{Bends, Ends, tame};
use super::miss::miss;
use super::settings::{Answer, Control, Cost, Limit, Settings, Status};
use super::task::{Freedoms, Task};
use crate::feasibility::steering::shooting::query::{Curvatures, Query};
use crate::trajectory::drive::{Gear, Motion, Segment, SegmentList};

/// A curve no longer than the next way around by this factor is short enough.
/// A longer one may be a loop: the next way around is tried as well.
const SHORT: f64 = 1.25;
/// Steps of an arc after which a chain is the better bet.
const ARC_STEPS: u32 = 8;
/// The descents' tolerance as a share of the precision.
const TOLERANCE: f64 = 1e-3;

/// What a descent ended in; made into segments only if it is answered.
#[derive(Clone, Copy)]
pub(super) enum Curve {
    Arc(Ends, Free),
    Chain(Chain),
}

/// How good a curve is; less is better.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Grade {
    /// Meets goal and bounds; its length, m.
    Good(f64),
    /// Meets the goal; by what factor it exceeds a bound.
    Broken(f64),
    /// How far it ends from the goal, m.
    Missed(f64),
}

/// The best curve so far, with the steps of all.
///
/// Steps of all descents count against [`Settings::most_steps`].
struct Search<'a> {
    query: &'a Query,
    settings: &'a Settings<'a>,
    task: Task,
    /// By grade; the first of equals stays.
    best: Option<(Grade, Curve)>,
    iterations: u32,
}

/// Curvature as a polynomial or a chain, from the origin to the goal.
///
/// Statuses: `Ok` where goal and bounds are met; `Infeasible` where only a bound is not; else `NotConverged`.
pub(super) fn search(query: &Query, bounds: &Curvatures, settings: &Settings) -> Answer {
    let bounds = tame(bounds);
    let mut search = Search::new(query, &bounds, settings);
    if miss(settings.simd, &[], query).within(&settings.precision.share(TOLERANCE)) {
        return Answer { status: Status::Ok, segments: SegmentList::EMPTY, iterations: 0 };
    }
    search.ways();
    search.answer()
}

/// The curve that is answered where it meets its goal within the bounds.
///
/// For tables: no costs are lowered and nothing is judged again.
pub(super) fn best(query: &Query, bounds: &Curvatures, settings: &Settings) -> Option<Curve> {
    let mut search = Search::new(query, &tame(bounds), settings);
    search.ways();
    search.best.and_then(|(grade, curve)| matches!(grade, Grade::Good(_)).then_some(curve))
}

/// The answer along every way around by itself, shortest first.
///
/// Arcs and chains alike; unlike [`search`] it does not stop at a short one.
///
/// Each way has the steps of a whole search.
pub(super) fn every(query: &Query, bounds: &Curvatures, settings: &Settings, mut take: impl FnMut(Answer)) {
    let bounds = tame(bounds);
    let goal = &query.goal;
    for word in words(goal.x * bounds.most, goal.y * bounds.most, goal.yaw) {
        if word.length().is_finite() {
            let mut search = Search::new(query, &bounds, settings);
            search.along(&word);
            take(search.answer());
        }
    }
}

impl<'a> Search<'a> {
    fn new(query: &'a Query, bounds: &Curvatures, settings: &'a Settings) -> Self {
        let freedoms = if settings.control == Control::Cubic { Freedoms::One } else { Freedoms::Three };
        let tolerance = TOLERANCE * settings.precision.position;
        let Settings { step_scale, simd, .. } = *settings;
        let task = Task { bounds: *bounds, freedoms, tolerance, step_scale, simd };
        Self { query, settings, task, best: None, iterations: 0 }
    }

    /// Looks along the ways around, shortest first, until one is short enough; at first from the table's start value.
    ///
    /// Ends as well when `starts` ways were looked along or the steps are spent and there is something to answer. A
    /// table's arc counts like any other, so that a bad start value costs 8 steps and no answer.
    fn ways(&mut self) {
        let Task { bounds, .. } = self.task;
        if let Some((ends, start)) = self.settings.table.and_then(|table| table.start(self.query, &bounds)) {
            // A cubic has no more shape than this.
            let [c0, ..] = start.shape;
            let cubic = self.task.freedoms == Freedoms::One;
            let start = if cubic { Free { shape: [c0, 0.0, 0.0], ..start } } else { start };
            let fit = arc::descend(&self.task, &ends, start, self.left(ARC_STEPS));
            self.iterations += fit.iterations;
            if fit.good {
                self.keep(Grade::Good(fit.free.length), Curve::Arc(ends, fit.free));
            }
        }
        let goal = &self.query.goal;
        let words = words(goal.x * bounds.most, goal.y * bounds.most, goal.yaw);
        for word in words.iter().take(self.settings.starts as usize) {
            let shortest = word.length() / bounds.most;
            let short = matches!(self.best, Some((Grade::Good(length), _)) if length < SHORT * shortest);
            let spent = self.best.is_some() && self.left(1) == 0;
            if short || spent || !shortest.is_finite() {
                break;
            }
            self.along(word);
        }
    }

    /// Steps that the next descent may take, `wanted` at most.
    fn left(&self, wanted: u32) -> u32 {
        let Settings { iterations, most_steps, .. } = *self.settings;
        wanted.min(iterations).min(most_steps.saturating_sub(self.iterations))
    }

    /// Looks for a curve that turns like `word`.
    ///
    /// A descent to an arc first; a chain where that does not keep the bounds.
    fn along(&mut self, word: &Word) {
        let ends = Ends::along(self.query, word);
        let chains = self.settings.control == Control::Quintic;
        let steps = self.left(if chains { ARC_STEPS } else { u32::MAX });
        let start = Free::along(&ends, word, &self.task.bounds);
        let fit = arc::descend(&self.task, &ends, start, steps);
        self.iterations += fit.iterations;
        let arc = Curve::Arc(ends, fit.free);
        if fit.good {
            return self.keep(Grade::Good(fit.free.length), arc);
        }
        if chains {
            let start = Chain::along(&ends, word, &self.task.bounds);
            let fit = chain::descend(&self.task, &ends, start, self.left(u32::MAX));
            self.iterations += fit.iterations;
            self.keep(grade(fit.miss, self.task.tolerance, fit.chain.length, || fit.bends), Curve::Chain(fit.chain));
        }
        if !matches!(self.best, Some((Grade::Good(_), _))) {
            let bends = || arc::bends(&ends, &fit.free, &self.task.bounds);
            self.keep(grade(fit.miss, self.task.tolerance, fit.free.length, bends), arc);
        }
    }

    fn keep(&mut self, grade: Grade, curve: Curve) {
        if self.best.is_none_or(|(best, _)| grade < best) {
            self.best = Some((grade, curve));
        }
    }

    /// A cost is lowered along good arcs only. `Infeasible` names the bound that is exceeded by the larger factor.
    fn answer(mut self) -> Answer {
        if let Some((Grade::Good(_), Curve::Arc(ends, free))) = &mut self.best
            && self.settings.cost != Cost::Any
        {
            let left = self.settings.iterations.min(self.settings.most_steps.saturating_sub(self.iterations));
            let (refined, taken) = arc::refine(&self.task, ends, *free, self.settings.cost, left);
            *free = refined;
            self.iterations += taken;
        }
        let mut segments = SegmentList::EMPTY;
        let mut bends = Bends { curvature: 0.0, rate: 0.0 };
        if let Some((grade, curve)) = self.best {
            segments = curve.segments();
            if !matches!(grade, Grade::Good(_)) {
                bends = curve.bends(&self.task.bounds);
            }
        }
        // Judged by the numbers that are handed out, not by those that made them.
        let missed = miss(self.task.simd, &segments, self.query);
        let status = if !missed.within(&self.settings.precision) {
            Status::NotConverged { residual: missed.position }
        } else if bends.within() {
            Status::Ok
        } else if bends.curvature >= bends.rate {
            Status::Infeasible { limit: Limit::Curvature, excess: (bends.curvature - 1.0) * self.task.bounds.most }
        } else {
            Status::Infeasible { limit: Limit::CurvatureRate, excess: (bends.rate - 1.0) * self.task.bounds.most_rate }
        };
        Answer { status, segments, iterations: self.iterations }
    }
}

/// `length` in m; `bends` is asked only where the goal is met.
///
/// `miss` in m (of chains rad as well), good below `tolerance`; NaN counts as infinitely far.
fn grade(miss: f64, tolerance: f64, length: f64, bends: impl FnOnce() -> Bends) -> Grade {
    if miss.is_nan() || miss >= tolerance {
        return Grade::Missed(if miss.is_nan() { f64::INFINITY } else { miss });
    }
    let bends = bends();
    if bends.within() { Grade::Good(length) } else { Grade::Broken(bends.worst()) }
}

impl Curve {
    fn bends(&self, bounds: &Curvatures) -> Bends {
        match self {
            Self::Arc(ends, free) => arc::bends(ends, free, bounds),
            Self::Chain(chain) => chain.bends(bounds),
        }
    }

    fn segments(&self) -> SegmentList {
        let mut list = SegmentList::EMPTY;
        match self {
            Self::Arc(ends, free) => {
                let motion = Motion::Arc { length_m: free.length, curvature: ends.curvature(free) };
                list.add(Segment { motion, gear: Gear::Forward });
            }
            Self::Chain(chain) => {
                let pieces = chain.pieces();
                pieces.for_each(|(length, from, to)| list.add(Segment::clothoid(length, from, to, Gear::Forward)));
            }
        }
        list
    }
}
