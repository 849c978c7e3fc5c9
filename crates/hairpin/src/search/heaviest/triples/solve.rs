//! Which method answers, and what is known of the answer.

use std::collections::VecDeque;

use super::anneal::annealed;
use super::problem::{Question, Triples};
use super::subsets::{Subsets, table_bytes};
use super::walks::Prices;
use crate::math::random::named_seed;
use crate::search::heaviest::question::wanted;
use crate::search::heaviest::{Arcs, Heaviest, HeaviestMistake, HeaviestSettings, Method, Outcome, heaviest};

/// Up to so many points the heaviest path is searched exactly, if memory allows.
pub const MOST_EXACT_POINTS: usize = 20;
/// Annealing and prices take turns, each round twice as long as the one before: who stops them early has a path that
/// was cooled down, and a bound.
const ROUNDS: u32 = 5;
/// Kicks of the local search that finds the path without triples from which annealing starts.
const FIRST_KICKS: u64 = 200;

/// The path of maximal total cost in which no point comes twice and triples may stand for two arcs each; points may be
/// left out.
///
/// Costs of the answer's paths are with the triples that add most ([`Triples::best_on`] says which), its paths pairwise
/// different orders of points. Up to [`MOST_EXACT_POINTS`] points it is proven; of more, paths are the best that were
/// met, and the bound holds for the heaviest. Of `settings` count ends, the least cost, how many paths, the seed, and
/// the bytes a table may take.
///
/// max over orders p and their cuts of Σ_arcs c(p_k, p_{k+1}) + Σ_triples t(p_k, p_{k+1}, p_{k+2}). Exact: O(2ⁿ n³)
/// time, 2ⁿ · n · 8 bytes, 168 MB at 20 points. Else five rounds of annealing and prices; `stop` ends them early, with
/// a path and a bound all the same.
///
/// # Errors
/// Ends that are no points.
///
/// # Panics
/// If `triples` are of another number of points than `arcs`: a mistake of the caller's.
pub fn heaviest_with_triples(
    arcs: &Arcs,
    triples: &Triples,
    settings: &HeaviestSettings,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Heaviest, HeaviestMistake> {
    let (n, ends) = (arcs.points(), settings.ends);
    ends.check(n)?;
    assert!(triples.points() == n, "triples of the same points");
    let exact = n <= MOST_EXACT_POINTS && table_bytes(n) <= u128::from(settings.most_bytes);
    let exact = exact && matches!(settings.method, Method::Auto | Method::Subsets);
    let question = Question { arcs, triples, ends };
    let table = if exact { Subsets::new(question, stop) } else { None };
    let answer = |paths: Vec<(i64, Vec<usize>)>, bound, proven, method| Heaviest {
        outcome: if paths.is_empty() && proven { Outcome::Infeasible } else { Outcome::Found },
        ..Heaviest::found(paths, bound, proven, method)
    };
    if let Some(table) = table {
        let (paths, complete) = table.heaviest(settings.programs, stop);
        let bound = paths.first().map(|(cost, _)| *cost);
        return Ok(cut(arcs, triples, wanted(answer(paths, bound, complete, Method::Subsets), settings)));
    }
    let mut paths: Vec<(i64, Vec<usize>)> = Vec::new();
    if let Some(first) = first_order(arcs, triples, settings, stop)? {
        paths.extend(triples.best_on(arcs, &first).map(|(cost, _)| (cost, first)));
    }
    let mut prices = Prices::new(question);
    for round in 0..ROUNDS {
        let share = f64::from(1 << round) / f64::from(1 << (ROUNDS - 1));
        if let Some((_, best)) = paths.first().cloned() {
            let seed = named_seed(settings.seed, "round", u64::from(round));
            paths.extend(annealed(&question, &best, settings.programs, (share, seed), stop));
            paths.sort_by(|a, b| b.cmp(a));
            paths.dedup();
            paths.truncate(settings.programs);
        }
        prices.step(0.5 * share, paths.first().map_or(0, |(cost, _)| *cost), stop);
    }
    let reached = paths.first().map_or(0, |(cost, _)| *cost);
    let bound = prices.bound().max(reached);
    let proven = settings.programs == 1 && !paths.is_empty() && bound <= reached;
    Ok(cut(arcs, triples, wanted(answer(paths, Some(bound), proven, Method::Local), settings)))
}

/// With the points that the triples of each path pass.
fn cut(arcs: &Arcs, triples: &Triples, mut found: Heaviest) -> Heaviest {
    let passed = |order: &[usize]| -> Vec<usize> {
        let places = triples.best_on(arcs, order).map_or_else(Vec::new, |(_, places)| places);
        places.into_iter().map(|place| order[place]).collect()
    };
    found.passed = found.paths.iter().map(|(_, order)| passed(order)).collect();
    found
}

/// A path to begin with: the heaviest of arcs alone that local search finds, else one of few moves.
///
/// `None` where breadth-first search finds no way between the ends either, which proves nothing.
fn first_order(
    arcs: &Arcs,
    triples: &Triples,
    settings: &HeaviestSettings,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Vec<usize>>, HeaviestMistake> {
    let quick = HeaviestSettings {
        method: Method::Local,
        programs: 1,
        min_cost: None,
        kicks: Some(FIRST_KICKS),
        proof: false,
        ..settings.clone()
    };
    let straight = heaviest(arcs, &quick, stop)?.paths.into_iter().next().map(|(_, path)| path);
    Ok(straight.or_else(|| few_moves(arcs, triples, settings)))
}

/// A path of few moves between the ends, by breadth-first search over arcs and triples; points keep the first way that
/// came to them, so that there may be paths where it finds none.
fn few_moves(arcs: &Arcs, triples: &Triples, settings: &HeaviestSettings) -> Option<Vec<usize>> {
    let (n, ends) = (arcs.points(), settings.ends);
    let mut ways: Vec<Option<Vec<usize>>> = vec![None; n];
    let mut open: VecDeque<usize> = (0..n).filter(|point| ends.may_start(*point)).collect();
    open.iter().for_each(|start| ways[*start] = Some(vec![*start]));
    while let Some(at) = open.pop_front() {
        let way = ways[at].clone()?;
        if ends.may_end(at) {
            return Some(way);
        }
        for (to, known) in ways.iter_mut().enumerate().filter(|(_, known)| known.is_none()) {
            let straight = arcs.cost(at, to).is_some().then(Vec::new);
            let free = |via: &usize| !way.contains(via) && triples.cost(at, *via, to).is_some();
            if let Some(via) = straight.or_else(|| (0..n).find(free).map(|via| vec![via])) {
                *known = Some(way.iter().copied().chain(via).chain([to]).collect());
                open.push_back(to);
            }
        }
    }
    None
}
