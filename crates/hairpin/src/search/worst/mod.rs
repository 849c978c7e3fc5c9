//! The worst that there is to find: one pool of executions for all cases that are asked for.
//!
//! | file | does |
//! | --- | --- |
//! | `field` | what is searched: plans, changes and executions come in as a trait |
//! | `scale` | how far two trajectories are apart |
//! | `archive` | the worst that differ, of all that was executed |
//! | `change` | how a plan becomes another |
//! | `portfolio` | which change is tried next |
//! | `rounds` | executes draws, then changes of what stands, round by round |
//!
//! Data flow: draws and seeds are executed and fix the scale → rounds: a change each from what stands in the archive →
//! what is feasible is executed → the archive takes it over, in order → the first that stand are the answer. A round
//! has a fixed size and each of its places a stream of its own, so that the answer is the same on any number of
//! threads.
//!
//! No gradient, no model of the robot: only the order of stresses is used, but for the least distance that keeps near
//! copies of one trajectory from being many cases.

mod archive;
mod change;
mod crowd;
mod field;
mod lanes;
mod portfolio;
mod rounds;
mod scale;
mod settings;
#[cfg(test)]
mod tests;

use self::archive::{Archive, Member};
pub use self::crowd::Crowd;
pub use self::field::{Field, Ran};
use self::rounds::{Search, offer};
pub use self::scale::{Placed, Scale, Trace};
pub use self::settings::WorstSettings;
use super::in_loop::Trial;

/// Pairs of draws that may be nearer than two that stand.
const QUANTILE: f64 = 0.1;
/// Parents at least.
const PARENTS: usize = 12;

/// A trajectory that was found.
#[derive(Debug, Clone)]
pub struct Found<P> {
    /// The plan.
    pub plan: P,
    /// The target that it was kept for.
    pub target: usize,
    /// Its execution, by that target.
    pub trial: Trial,
}

/// The answer.
#[derive(Debug, Clone)]
pub struct Worst<P> {
    /// In turns for each target, the most stressful first, no two nearer than `apart`.
    pub found: Vec<Found<P>>,
    /// The stresses of each execution, one for each target, in order; `None` of those that failed.
    pub stresses: Vec<Option<Vec<f64>>>,
    /// Executions before anything was changed: of seeds and draws, which fix the scale.
    pub first: u64,
    /// Executions of all trajectories that were drawn at random.
    pub drawn: u64,
    /// The least distance of two that are found: the 10 % quantile of the distances of those drawn first.
    pub apart: f64,
    /// Why nothing was found, in a sentence's part.
    pub nothing: Option<String>,
}

/// Searches `field` until the executions are used up, nothing new is found, or `stopped`; `told` hears of the number of
/// executions after each round.
///
/// Where there are several targets each has an archive of its own, every execution is offered to all, and a portfolio
/// says for which one a round is made: one plain sum or minimum of them would let one hide the others. Source: Zhang,
/// Hasuo, Arcaini, Multi-armed bandits for Boolean connectives in hybrid system falsification, CAV 2019.
pub fn worst<F: Field>(
    field: &F,
    settings: &WorstSettings,
    stopped: &(dyn Fn() -> bool + Sync),
    told: &dyn Fn(u64),
) -> Worst<F::Plan> {
    let mut search = Search::new(field, settings, stopped);
    let executed = search.first(told);
    let first = search.executions();
    let traces: Vec<Trace> = executed.iter().map(|executed| executed.trace.clone()).collect();
    let scale = Scale::of(&traces);
    let apart = scale.quantile(&traces, QUANTILE);
    let most = PARENTS.max(settings.cases + settings.cases / 4);
    let mut archives: Vec<_> = (0..settings.targets.max(1)).map(|_| Archive::new(scale.clone(), apart, most)).collect();
    offer(&mut archives, executed);
    search.evolve(&mut archives, told);
    let found = dealt(&archives, settings.cases);
    let Search { stresses, drawn, nothing, .. } = search;
    let nothing = nothing.filter(|_| found.is_empty());
    Worst { found, stresses, first, drawn, apart, nothing }
}

/// `count` of what stands, from each archive in turn, that differ also from each other.
fn dealt<P: Clone>(archives: &[Archive<P>], count: usize) -> Vec<Found<P>> {
    let mut standing: Vec<_> = archives.iter().map(Archive::standing).collect();
    let mut chosen: Vec<(usize, &Member<P>)> = Vec::with_capacity(count);
    let mut passed = 0;
    while chosen.len() < count && passed < standing.len() {
        passed = 0;
        for (target, standing) in standing.iter_mut().enumerate() {
            let differs = |member: &&Member<P>| {
                chosen.iter().all(|(_, other)| archives[target].differ(&member.placed, &other.placed))
            };
            match standing.find(differs) {
                Some(member) if chosen.len() < count => chosen.push((target, member)),
                _ => passed += 1,
            }
        }
    }
    let found = chosen.into_iter();
    found.map(|(target, member)| Found { plan: member.plan.clone(), target, trial: member.trial }).collect()
}
