//! Graphs that do not hang together: a path lies in one part of its graph, and all other points are left out.
//!
//! Bounds of the whole see that only through cuts, one for every point of every part, whose prices stall far from their
//! best. Parts by themselves are smaller questions, and all but one mostly end with a no as soon as their bound is
//! below the best path.

use super::one::{SOME, one, simple_bound};
use super::problem::{Arcs, Ends};
use super::question::{Heaviest, HeaviestMistake, HeaviestSettings, Method, wanted};

/// All points that hang together, whatever the directions of arcs.
struct Part {
    /// In rising order; the part's own numbers are places in it.
    points: Vec<usize>,
    arcs: Arcs,
    ends: Ends,
    /// No path of it costs more.
    bound: i64,
    /// Whether it is proven that no path of it is heavier than the best of all.
    closed: bool,
}

/// What [`one`] finds, part by part where the graph has several.
///
/// Every part is bounded first, under the best path of those before; what is left is then searched to the end, the
/// largest bound first. A proof is one tree of the whole, and the second heaviest path may lie in another part: where
/// one of these is wanted of `settings.method`, and where subsets are quick, the graph is taken as it is.
///
/// # Errors
/// As [`one`].
pub(super) fn in_parts(
    arcs: &Arcs,
    settings: &HeaviestSettings,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Heaviest, HeaviestMistake> {
    let method = match settings.method {
        Method::Auto if arcs.points() <= SOME => return one(arcs, settings, stop),
        Method::Auto => Method::Branch,
        Method::Branch | Method::Local => settings.method,
        Method::Subsets | Method::Dfs => return one(arcs, settings, stop),
    };
    settings.ends.check(arcs.points())?;
    if settings.proof || settings.programs > 1 {
        return one(arcs, settings, stop);
    }
    let mut parts = parts_of(arcs, settings.ends)?;
    let path = settings.ends.first_path(arcs).filter(|_| parts.iter().any(|part| part.points.len() < arcs.points()));
    let Some(path) = path else { return one(arcs, settings, stop) };
    let below = settings.min_cost.unwrap_or(0) - 1;
    let mut best = (arcs.total(&path).unwrap_or(0), path);
    let mut nodes = 0;
    let methods = [Method::Local, settings.method];
    for method in &methods[..if method == Method::Local { 1 } else { 2 }] {
        parts.sort_by_key(|part| (-part.bound, part.points[0]));
        for part in &mut parts {
            let least = best.0.max(below) + 1;
            part.closed |= part.bound < least;
            if part.closed {
                continue;
            }
            let asked =
                HeaviestSettings { ends: part.ends, min_cost: Some(least), method: *method, ..settings.clone() };
            let found = one(&part.arcs, &asked, stop)?;
            nodes += found.nodes;
            part.closed = found.proven;
            part.bound = found.bound.map_or(part.bound, |bound| bound.min(part.bound));
            if let Some((cost, path)) = found.paths.into_iter().next() {
                best = (cost, path.into_iter().map(|point| part.points[point]).collect());
            }
        }
    }
    let open = parts.iter().filter(|part| !part.closed).map(|part| part.bound).max();
    let bound = open.unwrap_or(below).max(best.0).max(below);
    let proven = open.is_none_or(|open| open <= best.0);
    let found = Heaviest { nodes, ..Heaviest::found(vec![best], Some(bound), proven, method) };
    Ok(wanted(found, settings))
}

/// The parts in which there is a path of two points or more between the ends.
fn parts_of(arcs: &Arcs, ends: Ends) -> Result<Vec<Part>, HeaviestMistake> {
    let n = arcs.points();
    let mut part_of = vec![usize::MAX; n];
    let mut parts = Vec::new();
    for first in 0..n {
        if part_of[first] != usize::MAX {
            continue;
        }
        let mut points = vec![first];
        part_of[first] = first;
        let mut at = 0;
        while let Some(point) = points.get(at).copied() {
            at += 1;
            for (other, part) in part_of.iter_mut().enumerate() {
                if *part == usize::MAX && (arcs.cost(point, other).is_some() || arcs.cost(other, point).is_some()) {
                    *part = first;
                    points.push(other);
                }
            }
        }
        points.sort_unstable();
        let within = |end: Option<usize>| end.map(|end| points.binary_search(&end).ok());
        let (start, end) = (within(ends.start), within(ends.end));
        if points.len() < 2 || start == Some(None) || end == Some(None) {
            continue;
        }
        let costs = points.iter().flat_map(|from| points.iter().map(|to| arcs.cost(*from, *to))).collect::<Vec<_>>();
        let arcs = Arcs::new(points.len(), &costs)?;
        let ends = Ends { start: start.flatten(), end: end.flatten() };
        parts.push(Part { bound: simple_bound(&arcs), points, arcs, ends, closed: false });
    }
    Ok(parts)
}
