//! The K heaviest paths, pairwise different, by partition of what is left: every problem of it is a heaviest path
//! again.
//!
//! After E. L. Lawler, A procedure for computing the K best solutions to discrete optimization problems and its
//! application to the shortest path problem, Management Science 18 (1972): of the paths that begin with v₀ … v_k, the
//! best one P = v₀ … v_m is taken out by parting the others by how long they go with it: with v₀ … v_j, but not on to
//! v_{j+1}, for j = k … m.
//!
//! Each of K paths splits into at most as many parts as it has points, each a smaller question of the same kind; the
//! heaviest part is split next.

use super::parts::in_parts;
use super::problem::{Arcs, Ends};
use super::question::{Heaviest, HeaviestMistake, HeaviestSettings, Outcome};

/// Paths that begin in one way and do not go on in some others.
struct Part {
    /// How they begin; empty: anywhere.
    prefix: Vec<usize>,
    /// Points that do not come next.
    barred: Vec<usize>,
    /// Whether the beginning alone is none of them.
    goes_on: bool,
    /// The heaviest of them, with its cost.
    best: Option<(i64, Vec<usize>)>,
    /// None of them costs more.
    bound: i64,
    proven: bool,
}

/// The `settings.programs` heaviest paths of `arcs`, the heaviest first, given the heaviest itself.
///
/// At most programs · n questions to [`in_parts`]. `proven` holds for the list as a whole: that no path outside it is
/// heavier than its last. Ties come in the order in which parts were made.
pub(super) fn several(
    arcs: &Arcs,
    settings: &HeaviestSettings,
    first: Heaviest,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Heaviest, HeaviestMistake> {
    let Some((cost, path)) = first.paths.first().cloned() else { return Ok(first) };
    // Backwards is the same path.
    let turns = arcs.symmetric() && settings.ends == Ends::default();
    let mut answer = Heaviest { paths: Vec::new(), ..first };
    let whole = Part {
        prefix: Vec::new(),
        barred: Vec::new(),
        goes_on: true,
        best: Some((cost, path)),
        bound: answer.bound.unwrap_or(cost),
        proven: answer.proven,
    };
    let mut open = vec![whole];
    while answer.paths.len() < settings.programs {
        let heaviest = (0..open.len()).max_by_key(|&i| (open[i].best.as_ref().map(|(cost, _)| *cost), usize::MAX - i));
        let Some(part) = heaviest.map(|i| open.swap_remove(i)) else { break };
        let Some((cost, path)) = part.best.clone() else { break };
        // A path is the next one for sure if nothing that is open can cost more.
        answer.proven &= part.proven && open.iter().all(|other| other.bound <= cost);
        let mut taken = path.clone();
        if turns && taken.first() > taken.last() {
            taken.reverse();
        }
        if !answer.paths.iter().any(|(_, known)| *known == taken) {
            answer.paths.push((cost, taken));
        }
        if stop() {
            answer.proven &= answer.paths.len() == settings.programs;
            break;
        }
        if answer.paths.len() < settings.programs {
            split(arcs, settings, &part, &path, stop, &mut open, &mut answer.nodes)?;
        }
    }
    Ok(answer)
}

/// The parts of `part` without its best path.
fn split(
    arcs: &Arcs,
    settings: &HeaviestSettings,
    part: &Part,
    path: &[usize],
    stop: &(dyn Fn() -> bool + Sync),
    open: &mut Vec<Part>,
    nodes: &mut u64,
) -> Result<(), HeaviestMistake> {
    for kept in part.prefix.len()..=path.len() {
        let inherits = kept == part.prefix.len();
        let mut barred = if inherits { part.barred.clone() } else { Vec::new() };
        barred.extend(path.get(kept));
        let mut new = Part {
            prefix: path[..kept].to_vec(),
            barred,
            // The whole path itself is taken; of the part's own beginning the part knows.
            goes_on: kept == 0 || kept == path.len() || (inherits && part.goes_on),
            best: None,
            bound: 0,
            proven: true,
        };
        solve(arcs, settings, &mut new, stop, nodes)?;
        if new.best.is_some() || !new.proven {
            open.push(new);
        }
    }
    Ok(())
}

/// Finds the heaviest path of `part`, as a heaviest path from its last point through the points that are left.
///
/// The smaller problem has the last point of the beginning as its point 0, or a place before all, and the points that
/// are left behind it; barred points have no arc from 0. Every arc from 0 has one unit more than it costs, so that
/// going on at no cost is preferred to staying; the unit is taken off the answer and off the bound again. O(n²) beside
/// the search.
fn solve(
    arcs: &Arcs,
    settings: &HeaviestSettings,
    part: &mut Part,
    stop: &(dyn Fn() -> bool + Sync),
    nodes: &mut u64,
) -> Result<(), HeaviestMistake> {
    let ends = settings.ends;
    let last = part.prefix.last().copied();
    let closed = last.is_some() && last == ends.end;
    if closed && part.goes_on {
        return Ok(());
    }
    let done = arcs.total(&part.prefix).unwrap_or(0);
    if closed {
        (part.best, part.bound) = (Some((done, part.prefix.clone())), done);
        return Ok(());
    }
    let left: Vec<usize> = (0..arcs.points()).filter(|point| !part.prefix.contains(point)).collect();
    // Point 0 of the smaller problem is the last of the beginning, or where none is, a place before all.
    let n = left.len() + 1;
    // One more for going on makes arcs without cost better than staying.
    let first = |to: usize| match last {
        Some(last) => arcs.cost(last, to),
        None => ends.may_start(to).then_some(0),
    };
    let arc = |from: usize, to: usize| match (from, to) {
        (_, 0) => None,
        (0, to) if part.barred.contains(&left[to - 1]) => None,
        (0, to) => first(left[to - 1]).map(|cost| cost + 1),
        (from, to) => arcs.cost(left[from - 1], left[to - 1]),
    };
    let costs: Vec<Option<i64>> = (0..n * n).map(|index| arc(index / n, index % n)).collect();
    let end = ends.end.and_then(|end| left.iter().position(|point| *point == end)).map(|index| index + 1);
    let smaller = Arcs::new(n, &costs)?;
    let settings = HeaviestSettings {
        ends: Ends { start: Some(0), end },
        min_cost: None,
        programs: 1,
        proof: false,
        ..settings.clone()
    };
    let found = in_parts(&smaller, &settings, stop)?;
    *nodes += found.nodes;
    part.proven = found.proven;
    part.bound = done + (found.bound.unwrap_or(0) - 1).max(0);
    let Some((cost, rest)) = found.paths.first().filter(|_| found.outcome == Outcome::Found) else { return Ok(()) };
    if rest.len() > 1 || !part.goes_on {
        let path = part.prefix.iter().copied().chain(rest[1..].iter().map(|point| left[point - 1])).collect();
        let went_on = i64::from(rest.len() > 1);
        part.best = Some((done + cost - went_on, path));
    }
    Ok(())
}
