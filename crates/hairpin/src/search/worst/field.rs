//! What is searched: plans that are feasible, how one becomes another, and what carries them out.

use nalgebra::Point3;
use rayon::prelude::*;

use crate::math::random::Stream;
use crate::search::in_loop::Trial;

/// What an execution came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Ran {
    /// Its stress by each target, and the leg that it is owed to; NaN where that was not measured.
    pub trials: Vec<Trial>,
    /// What tells it from others beside its way: measures, as many of each.
    pub behaviour: Vec<f64>,
}

/// Feasible plans. Each answer is a plan of its own that is proven as the first was; what is asked twice is answered
/// alike.
pub trait Field: Sync {
    /// A plan.
    type Plan: Clone + Send + Sync;

    /// Plan number `number` of those that are drawn at random.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part.
    fn draw(&self, number: u64) -> Result<Self::Plan, String>;

    /// Plans that other searches know of, to begin with beside draws.
    fn seeds(&self) -> Vec<Self::Plan>;

    /// Waypoints, both ends included.
    fn points<'p>(&self, plan: &'p Self::Plan) -> &'p [Point3<f64>];

    /// What tells plans apart; equal plans are executed once.
    fn fingerprint(&self, plan: &Self::Plan) -> [u8; 16];

    /// Whether waypoints may be put anywhere.
    fn moves(&self) -> bool;

    /// `plan` over other `points`, as many as its own.
    fn over(&self, plan: &Self::Plan, points: &[Point3<f64>]) -> Option<Self::Plan>;

    /// A place among those that `plan` was drawn from, which it may pass in the place of one of its waypoints.
    fn elsewhere(&self, plan: &Self::Plan, random: &mut Stream) -> Option<Point3<f64>>;

    /// The beginning of `plan` up to leg `leg`, and the rest of `other`.
    fn crossed(&self, plan: &Self::Plan, other: &Self::Plan, leg: usize, random: &mut Stream) -> Option<Self::Plan>;

    /// `plan` with something else than its waypoints changed, at leg `leg` if it can.
    fn altered(&self, plan: &Self::Plan, leg: usize, random: &mut Stream) -> Option<Self::Plan>;

    /// Carries `plan` out. `None` where that fails; what comes to the stress `least` of its target may be carried out
    /// more often.
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
