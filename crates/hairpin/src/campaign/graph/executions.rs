//! What searches that execute may do with a plan.
//!
//! How a search of one graph reaches a simulator or an executor: closures, made where the campaign knows who
//! executes.

use nalgebra::Point3;

use super::plan::Plan;
use crate::search::in_loop::{Ran, Rank, Trial};
use crate::simulation::Airborne;

/// Executions, each of which counts; `None` where one fails.
///
/// `None` of a closure may also mean that the caller stopped; the search then ends by its own budget.
#[derive(Clone, Copy)]
pub(in crate::campaign) struct Executions<'a> {
    /// Of a plan: once, and as often again as the search asks for if it came to the rank that is given.
    pub(in crate::campaign) execute: &'a dyn Fn(&Plan, Rank) -> Option<Trial>,
    /// How long a plan's takes, s.
    pub(in crate::campaign) duration: &'a dyn Fn(&Plan) -> Option<f64>,
    /// A plan with the obstacles that are asked for, executed twice: without them, to see where they belong, and among
    /// them.
    ///
    /// Costs two executions; `None` as well where no obstacle finds room.
    pub(in crate::campaign) furnish: &'a dyn Fn(&Plan) -> Option<(Plan, Trial)>,
    /// Of parts of trajectories, where these are to be scored by them.
    pub(in crate::campaign) partial: Option<Partials<'a>>,
}

impl Executions<'static> {
    /// For searches that execute nothing.
    pub(in crate::campaign) fn none() -> Self {
        Self { execute: &|_, _| None, duration: &|_| None, furnish: &|_| None, partial: None }
    }
}

/// Executes a part; where it fails it says how many legs it executed in vain.
type Part<'a> = &'a dyn Fn(&Plan, Option<&Airborne>, bool) -> Result<Ran<Airborne>, u64>;

/// Executions of parts of trajectories.
#[derive(Clone, Copy)]
pub(in crate::campaign) struct Partials<'a> {
    /// Executes a plan's waypoints as the first of a trajectory, from its start or from what was flown before; whether
    /// they are all.
    pub(in crate::campaign) execute: Part<'a>,
    /// Whether it can go on from what was flown before.
    pub(in crate::campaign) resumes: bool,
}

/// What surrounds a plan and is searched with it.
#[derive(Clone, Copy)]
pub(in crate::campaign) struct Surroundings<'a> {
    /// Numbers between −1 and 1 that say what disturbs the robot all along: the air, a force.
    ///
    /// 0: nothing disturbs it.
    pub(in crate::campaign) coordinates: usize,
    /// Puts numbers that are not allowed to the nearest that are.
    pub(in crate::campaign) bound: &'a dyn Fn(&mut [f64]),
    /// A plan disturbed as numbers say, carried out for so many seconds.
    pub(in crate::campaign) put: &'a dyn Fn(&Plan, &[f64], f64) -> Plan,
    /// Whether obstacles are to be placed.
    pub(in crate::campaign) obstacles: bool,
}

/// Puts other waypoints into a plan.
pub(super) type Move<'a> = &'a dyn Fn(&Plan, &[Point3<f64>]) -> Option<Plan>;

/// Takes `vector` back to length 1 where it is longer, along itself.
///
/// v / max(1, ‖v‖).
pub(in crate::campaign) fn into_unit_ball(vector: &mut [f64]) {
    let norm = vector.iter().map(|x| x * x).sum::<f64>().sqrt().max(1.0);
    vector.iter_mut().for_each(|x| *x /= norm);
}
