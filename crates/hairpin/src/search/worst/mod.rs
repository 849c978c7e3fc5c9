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
mod pairs;
mod portfolio;
mod rounds;
mod scale;
mod settings;
#[cfg(feature = "unit-tests")]
mod tests;

use self::archive::{Aim, Archive, Member};
pub use self::crowd::Crowd;
pub use self::field::{Field, Ran};
use self::rounds::{Search, offer};
pub use self::scale::{Placed, Scale, Trace};
pub use self::settings::WorstSettings;
use super::in_loop::Trial;

/// Pairs of draws that may be nearer than two that stand.
/// Small enough that a hard place may hold several cases, large enough that near copies of one trajectory are one.
const QUANTILE: f64 = 0.1;
/// Parents at least.
/// Where few cases are asked for: a search that changes only one or two parents is caught at the next peak.
const PARENTS: usize = 12;

/// A trajectory that was found.
///
/// One of [`Worst::found`]. `trial.stress` is finite, or −∞ of what fails without a measured one: what else is not is
/// held as not measured before any archive sees it.
#[derive(Debug, Clone)]
pub struct Found<P> {
    /// The plan.
    /// Feasible, as all plans of a [`Field`] are; cloned from the archive.
    pub plan: P,
    /// The target that it was kept for; of what was kept because it fails, the first.
    ///
    /// An index into [`Ran::trials`], below [`WorstSettings::targets`].
    pub target: usize,
    /// Its execution, by that target.
    /// As it was measured in the search: a maximum over many noisy executions is biased upwards, so that what is
    /// reported is better executed anew.
    pub trial: Trial,
}

/// The answer.
///
/// Everything that statistics of the search need is in it: a caller who compares with random testing takes the
/// executions of draws, not all of them, for the baseline.
#[derive(Debug, Clone)]
pub struct Worst<P> {
    /// In turns what fails and for each target, the most stressful first, no two nearer than `apart`.
    ///
    /// At most [`WorstSettings::cases`]; fewer where fewer differ, or where the executions do not suffice for as
    /// many.
    pub found: Vec<Found<P>>,
    /// The stresses of each execution, one for each target, in order; `None` of those that failed.
    ///
    /// A trial of several executions has as many equal entries, so that an index is a number of executions. NaN where
    /// a target was not measured.
    pub stresses: Vec<Option<Vec<f64>>>,
    /// Executions before anything was changed: of seeds and draws, which fix the scale.
    ///
    /// An index into `stresses`: everything behind it is due to changes.
    pub first: u64,
    /// Executions of all trajectories that were drawn at random.
    pub drawn: u64,
    /// The least distance of two that are found: the 10 % quantile of the distances of those drawn first.
    ///
    /// On the scale of [`Scale`], without unit, 0 … about 1. 0 where fewer than two draws were executed; then only
    /// what is not equal on the scale counts as different.
    pub apart: f64,
    /// Why nothing was found, in a sentence's part.
    ///
    /// The reason of the last draw that gave no plan; `None` as soon as one trajectory was found.
    pub nothing: Option<String>,
}

/// Searches `field` until the executions are used up, nothing new is found, or `stopped`; `told` hears of the number of
/// executions after each round.
///
/// Each target has an archive of its own, and so has what fails; every execution is offered to all, and a portfolio
/// says for which one a round is made: one plain sum or minimum of them would let one hide the others. Source: Zhang,
/// Hasuo, Arcaini, Multi-armed bandits for Boolean connectives in hybrid system falsification, CAV 2019.
///
/// Three stages. *First* executes seeds and draws: a tenth of the executions, and 20 where at least 40 are paid for.
/// Their traces fix the scale and `apart`. *Evolve* makes rounds: one archive (drawn by its success), a change for
/// each place of the round (drawn by its success for that archive), children made in parallel and without execution,
/// then what is new executed in parallel, then taken over in the order of places. *Deal* takes the most stressful of
/// each archive in turn, beginning with what fails.
///
/// It ends after the last execution that is paid for, after 20 rounds in a row that execute nothing new, when no
/// archive has a member, or when `stopped` says so; what was executed until then is the answer in each case.
/// `stopped` is asked before every execution, from any thread; `told` is called on the caller's.
///
/// Deterministic in `field` and `settings` on any number of threads, as long as `stopped` does not end it: each place
/// of a round has a stream of its own (`named_seed(seed, "worst", place)`), each round's target likewise.
///
/// Cost beside executions: O(n²) distances of the first traces, and for each taken trajectory as many distances as
/// there are standing ones, at most max(12, 5/4 cases).
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
    let aims = Aim::all(settings.targets.max(1));
    let mut archives: Vec<_> = aims.map(|aim| Archive::new(aim, scale.clone(), apart, most)).collect();
    offer(&mut archives, executed);
    search.evolve(&mut archives, told);
    let found = dealt(&archives, settings.cases);
    let Search { stresses, drawn, nothing, .. } = search;
    let nothing = nothing.filter(|_| found.is_empty());
    Worst { found, stresses, first, drawn, apart, nothing }
}

/// `count` of what stands, from each archive in turn, that differ also from each other.
///
/// A trajectory is kept once, for the first archive that takes it: what another archive took is nearer than `apart` to
/// itself.
fn dealt<P: Clone>(archives: &[Archive<P>], count: usize) -> Vec<Found<P>> {
    let mut standing: Vec<_> = archives.iter().map(Archive::standing).collect();
    let mut chosen: Vec<(Aim, &Member<P>)> = Vec::with_capacity(count);
    let mut passed = 0;
    while chosen.len() < count && passed < standing.len() {
        passed = 0;
        for (archive, standing) in archives.iter().zip(&mut standing) {
            let differs =
                |member: &&Member<P>| chosen.iter().all(|(_, other)| archive.differ(&member.placed, &other.placed));
            match standing.find(differs) {
                Some(member) if chosen.len() < count => chosen.push((archive.aim, member)),
                _ => passed += 1,
            }
        }
    }
    let found = chosen.into_iter();
    found.map(|(aim, member)| Found { plan: member.plan.clone(), target: aim.target(), trial: member.trial }).collect()
}
