//! The heaviest path by the method that is asked for, or by the one that suits.
//!
//! Which method suits is decided by the number of points and the memory allowed, never by a clock, so that one question
//! has one answer.

use super::arborescence::Arborescence;
use super::dfs::depth_first;
use super::forest::{Forest, ID_BITS};
use super::problem::Arcs;
use super::prove::prove;
use super::question::{Heaviest, HeaviestMistake, HeaviestSettings, Method, Outcome, wanted};
use super::record::{Proof, Recorder};
use super::root::scale_of;
use super::subsets::{MOST_SUBSET_POINTS, best_by_subsets, subset_bytes};

/// Up to so many points subsets are the quicker way.
const FEW: usize = 14;
/// Up to so many points subsets are the quicker way where branch and bound has to split more than [`QUICK_NODES`].
pub(super) const SOME: usize = 16;
/// Problems that each part of branch and bound looks at before subsets take over.
const QUICK_NODES: u64 = 4;

/// What one method finds; several paths only from branch and bound.
///
/// A start that is also the end is the path of that one point. With `Auto` between [`FEW`] and [`SOME`] points, branch
/// and bound is tried with few nodes first; its answer counts where it is a proof.
pub(super) fn one(
    arcs: &Arcs,
    settings: &HeaviestSettings,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Heaviest, HeaviestMistake> {
    let ends = settings.ends;
    ends.check(arcs.points())?;
    let method = choose(arcs, settings)?;
    if settings.method == Method::Auto && method == Method::Subsets && arcs.points() > FEW {
        let most_nodes = settings.most_nodes.map_or(QUICK_NODES, |most| most.min(QUICK_NODES));
        let quick = HeaviestSettings { method: Method::Branch, most_nodes: Some(most_nodes), ..settings.clone() };
        let found = one(arcs, &quick, stop)?;
        if found.proven || stop() {
            return Ok(found);
        }
    }
    let answer = |paths, bound, proven| Heaviest::found(paths, bound, proven, method);
    if let (Some(start), Some(end)) = (ends.start, ends.end)
        && start == end
    {
        return Ok(wanted(answer(vec![(0, vec![start])], Some(0), true), settings));
    }
    let Some(path) = ends.first_path(arcs) else {
        return Ok(Heaviest { outcome: Outcome::Infeasible, ..answer(Vec::new(), None, true) });
    };
    let exact = |path: Option<Vec<usize>>, proven| {
        let cost = path.as_ref().and_then(|path| arcs.total(path));
        let paths = cost.zip(path).into_iter().collect();
        answer(paths, cost.filter(|_| proven).or(Some(simple_bound(arcs))), proven)
    };
    let found = match method {
        Method::Subsets => exact(best_by_subsets(arcs, ends), true),
        Method::Dfs => {
            let (path, complete) = depth_first(arcs, ends, path, stop);
            exact(Some(path), complete)
        }
        Method::Branch | Method::Auto | Method::Local => {
            by_bounds(arcs, settings, &path, stop, answer(Vec::new(), None, false))
        }
    };
    Ok(wanted(found, settings))
}

/// The method that is meant, `Auto` resolved. Errors: subsets that do not fit into `most_bytes`; several paths from a
/// method that gives one.
fn choose(arcs: &Arcs, settings: &HeaviestSettings) -> Result<Method, HeaviestMistake> {
    let (points, bytes, bound) = (arcs.points(), subset_bytes(arcs), settings.most_bytes);
    let fits = points <= MOST_SUBSET_POINTS && bytes <= u128::from(bound);
    let several = settings.programs > 1;
    match settings.method {
        Method::Auto if points <= SOME && fits => Ok(Method::Subsets),
        Method::Auto => Ok(Method::Branch),
        method @ (Method::Subsets | Method::Dfs | Method::Local) if several => {
            Err(HeaviestMistake::Programs { programs: settings.programs, method: method.name() })
        }
        Method::Subsets if !fits => Err(HeaviestMistake::Memory { points, bytes, bound }),
        method => Ok(method),
    }
}

/// Each point's heaviest arc out.
pub(super) fn simple_bound(arcs: &Arcs) -> i64 {
    let n = arcs.points();
    (0..n).map(|from| (0..n).filter_map(|to| arcs.cost(from, to)).max().unwrap_or(0)).sum()
}

/// The relaxation that suits the table: spanning trees where it is symmetric, in 64 bits where weights and numbers of
/// choices fit into one word side by side, else in 128; arborescences where it is not. The bound of an open search is
/// that of its open branches over the scale, rounded down, as costs are whole.
fn by_bounds(
    arcs: &Arcs,
    settings: &HeaviestSettings,
    path: &[usize],
    stop: &(dyn Fn() -> bool + Sync),
    answer: Heaviest,
) -> Heaviest {
    let scale = scale_of(arcs);
    let n = arcs.points();
    let short = n * n / 2 + 3 * n < 1 << ID_BITS && arcs.largest() * scale < 1 << (61 - ID_BITS - 4);
    let record = Recorder::new(settings.proof);
    let (searched, root, record) = match (arcs.symmetric(), short) {
        (true, true) => prove::<Forest<i64>>(arcs, settings, path, record, stop),
        (true, false) => prove::<Forest<i128>>(arcs, settings, path, record, stop),
        (false, _) => prove::<Arborescence>(arcs, settings, path, record, stop),
    };
    let (best, below) = (searched.best.cost(), settings.min_cost.unwrap_or(0) - 1);
    let possible = searched.open.map(|open| open.min(root) / scale);
    let bound = possible.unwrap_or(best).max(best).max(below);
    let single = settings.programs <= 1;
    // The bound may have come down to the path while something was still to be looked at: a proof, but without the tree
    // that a certificate is of.
    let proven = possible.is_none_or(|possible| single && !settings.proof && possible <= best);
    let proof = (possible.is_none() && settings.proof && single).then(|| Proof {
        scale,
        directed: !arcs.symmetric(),
        steps: record.steps,
    });
    Heaviest { paths: searched.best.into_paths(), bound: Some(bound), proven, nodes: searched.nodes, proof, ..answer }
}
