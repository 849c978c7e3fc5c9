//! What is searched: plans that are feasible, how one becomes another, and what carries them out.
//!
//! The seam of this room: campaigns of flights, drives, arms and boats implement [`Field`] and keep what a plan is to
//! themselves; the search sees waypoints, stresses and a fingerprint.

use nalgebra::Point3;
use rayon::prelude::*;

use crate::math::random::Stream;
use crate::search::in_loop::Trial;

/// What an execution came to.
///
/// Stresses are numbers of which larger is worse, each target's in its own unit: only their order within one target
/// counts.
#[derive(Debug, Clone, PartialEq)]
pub struct Ran {
    /// Its stress by each target, and the leg that it is owed to; NaN where that was not measured. What fails
    /// has an archive of its own, and is kept for each target by its stress beside that.
    /// [`WorstSettings::targets`](super::WorstSettings::targets) entries. An infinite stress counts as not measured.
    /// `executions` of all is that of the one with the most, as they share their runs.
    pub trials: Vec<Trial>,
    /// What tells it from others beside its way: measures, as many of each.
    ///
    /// In fixed order, each in its own unit; the scale divides each by its range over the first executions. Empty
    /// where nothing else is known; if one trajectory of the first has none, ways alone are compared.
    pub behaviour: Vec<f64>,
}

/// Feasible plans. Each answer is a plan of its own that is proven as the first was; what is asked twice is answered
/// alike.
///
/// Called from several threads at once and in no order that could be relied upon: an answer may depend on the
/// arguments alone, on `random` included, which is the caller's place's own. `None` of a change means that it is not
/// feasible or not possible; the search then tries another or gives the place up, without an execution.
pub trait Field: Sync {
    /// A plan.
    type Plan: Clone + Send + Sync;

    /// Plan number `number` of those that are drawn at random.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part; `None` where it was stopped, which is no reason.
    ///
    /// Numbers are asked from 0 on, each at most once, several at a time; 50 draws for each that is wanted are asked
    /// for before a field counts as empty.
    /// Numbers that places of other changes were given are passed over.
    fn draw(&self, number: u64) -> Result<Self::Plan, Option<String>>;

    /// Plans that other searches know of, to begin with beside draws.
    /// Optima of scores, say. They are executed first, within the budget, and not counted as drawn. May be empty.
    fn seeds(&self) -> Vec<Self::Plan>;

    /// Waypoints, both ends included.
    ///
    /// In order, m, in the world's frame. Changes address them by index, and legs by that of their first waypoint.
    fn points<'p>(&self, plan: &'p Self::Plan) -> &'p [Point3<f64>];

    /// What tells plans apart; equal plans are executed once.
    /// A hash of all that decides an execution, times and speeds as well as waypoints; 128 bits, so that a collision,
    /// which would lose one plan unexecuted, does not occur.
    fn fingerprint(&self, plan: &Self::Plan) -> [u8; 16];

    /// Whether waypoints may be put anywhere.
    /// If not, changes are those that take waypoints from the field's own: draw, elsewhere, cross, alter.
    fn moves(&self) -> bool;

    /// `plan` over other `points`, as many as its own.
    ///
    /// `points` are in m, both ends included, and may lie anywhere: it is here that world, obstacles, reach and the
    /// task's ends are asked. `None` where no such plan is feasible.
    fn over(&self, plan: &Self::Plan, points: &[Point3<f64>]) -> Option<Self::Plan>;

    /// A place among those that `plan` was drawn from, which it may pass in the place of one of its waypoints.
    ///
    /// m; drawn by `random`. It need not be feasible: [`Field::over`] is asked next. `None` where there is no other
    /// place.
    fn elsewhere(&self, plan: &Self::Plan, random: &mut Stream) -> Option<Point3<f64>>;

    /// The beginning of `plan` up to leg `leg`, and the rest of `other`.
    ///
    /// `leg` counts the legs of `plan` from 0. `None` where the parts cannot be joined.
    fn crossed(&self, plan: &Self::Plan, other: &Self::Plan, leg: usize, random: &mut Stream) -> Option<Self::Plan>;

    /// `plan` with something else than its waypoints changed, at leg `leg` if it can.
    ///
    /// Leg times, speeds, zones, wind: what is searched beside waypoints. `None` where there is nothing else.
    fn altered(&self, plan: &Self::Plan, leg: usize, random: &mut Stream) -> Option<Self::Plan>;

    /// Carries `plan` out. `None` where that fails; what comes to the stress `least` of its target may be carried out
    /// more often.
    ///
    /// `least` has one stress for each target: that of the last case that would be in the answer, −∞ while there are
    /// too few. With noise, what comes to it is worth repeating: a mean of several takes the luck out. The most
    /// expensive call by far; made in parallel.
    fn run(&self, plan: &Self::Plan, least: &[f64]) -> Option<Ran>;

    /// The same of plans that do not depend on each other, on any threads; `None` of those that were not begun before
    /// the search was `stopped`.
    fn run_all(
        &self,
        plans: &[&Self::Plan],
        least: &[f64],
        stopped: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Option<Option<Ran>>> {
        plans.par_iter().map(|plan| (!stopped()).then(|| self.run(plan, least))).collect()
    }
}
