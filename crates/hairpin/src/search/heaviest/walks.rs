//! The question of paths that may come back to points, its answer, and several different ones.

use thiserror::Error;

use super::problem::{Arcs, ArcsMistake, Ends};
use super::question::{Heaviest, Method, Outcome};
use super::walk::{Region, Search, WalkProof};

/// More often no point is let come: sums of costs must stay in 64 bits.
pub const MOST_VISITS: usize = 16;

/// What is wanted.
///
/// With `visits` = 1 the answer is that of [`super::heaviest`], usually later.
#[derive(Debug, Clone)]
pub struct WalkSettings {
    /// Fixed ends.
    pub ends: Ends,
    /// How often a point may come.
    ///
    /// 1 … [`MOST_VISITS`].
    pub visits: usize,
    /// Paths below this cost are not wanted.
    pub min_cost: Option<i64>,
    /// How many different paths are wanted, the heaviest first: each lacks an arc (or an end) of every one before it.
    pub programs: usize,
    /// Problems looked at at most for each of them.
    ///
    /// A node is one circulation, O(n³ · visits).
    pub most_nodes: Option<u64>,
    /// Whether to keep the proof of the heaviest.
    pub proof: bool,
}

/// Why a question has no answer.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum WalkMistake {
    /// The table or the ends.
    #[error(transparent)]
    Arcs(#[from] ArcsMistake),
    /// Never, or too often.
    #[error("{visits} visits, must be 1 to {MOST_VISITS}")]
    Visits {
        /// As asked.
        visits: usize,
    },
}

/// The path of maximal total cost in which no point comes more than `visits` times and no arc is used twice, i→j and
/// j→i being two; points may be left out. Exact: branch and bound on circulations; stopped before its end it gives the
/// best so far under a bound. The same answer on any machine unless `stop` ends it.
///
/// Exponential in the worst case; on instances of the published kind one look is mostly enough up to 50 points
/// (docs/heaviest-paths.md).
///
/// The proof is there if it was asked for (`proof`, one path) and the search came to its end.
///
/// ```
/// use hairpin::search::heaviest::{Arcs, Ends, WalkSettings, heaviest_walk};
///
/// // Two points and both arcs between them: with two visits each the path goes there and back again.
/// let arcs = Arcs::new(2, &[None, Some(3), Some(2), None])?;
/// let settings =
///     WalkSettings { ends: Ends::default(), visits: 2, min_cost: None, programs: 1, most_nodes: None, proof: false };
/// let (answer, _) = heaviest_walk(&arcs, &settings, &|| false)?;
/// assert!(answer.proven && answer.paths[0].0 == 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Ends that are no points, visits out of bounds, costs whose sums could overflow.
pub fn heaviest_walk(
    arcs: &Arcs,
    settings: &WalkSettings,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<(Heaviest, Option<WalkProof>), WalkMistake> {
    let WalkSettings { ends, visits, .. } = *settings;
    ends.check(arcs.points())?;
    if !(1..=MOST_VISITS).contains(&visits) {
        return Err(WalkMistake::Visits { visits });
    }
    fits(arcs, visits)?;
    let nothing =
        |outcome, bound, proven| Heaviest { outcome, ..Heaviest::found(Vec::new(), bound, proven, Method::Branch) };
    if ends.first_path(arcs).is_none() {
        return Ok((nothing(Outcome::Infeasible, None, true), None));
    }
    let least = settings.min_cost.unwrap_or(0).max(0);
    let keep = settings.proof && settings.programs <= 1;
    let search = Search { arcs, ends, visits, above: least - 1, most_nodes: settings.most_nodes, keep, stop };
    let first = search.run(&Region::default());
    let bound = first.bound.max(least - 1);
    let Some(best) = first.best else {
        let outcome = if first.proven { Outcome::BelowMinCost } else { Outcome::NotFound };
        return Ok((Heaviest { nodes: first.nodes, ..nothing(outcome, Some(bound), first.proven) }, None));
    };
    let proof = (keep && first.proven).then_some(WalkProof { visits, steps: first.steps });
    let mut answer = Heaviest { nodes: first.nodes, ..nothing(Outcome::Found, Some(bound), first.proven) };
    let search = Search { keep: false, ..search };
    let mut open = vec![Part { region: Region::default(), best, bound, proven: first.proven }];
    while answer.paths.len() < settings.programs.max(1) {
        let heaviest = (0..open.len()).max_by_key(|i| (open[*i].best.0, usize::MAX - *i));
        let Some(part) = heaviest.map(|i| open.swap_remove(i)) else { break };
        // A path is the next one for sure if nothing that is open can cost more.
        answer.proven &= part.proven && open.iter().all(|other| other.bound <= part.best.0);
        answer.paths.push(part.best.clone());
        if answer.paths.len() == settings.programs.max(1) {
            break;
        }
        if stop() {
            answer.proven = false;
            break;
        }
        answer.proven &= split(&search, part, &mut open, &mut answer.nodes);
    }
    Ok((answer, proof))
}

/// Paths that use some arcs and lack others, and the heaviest of them.
struct Part {
    region: Region,
    best: (i64, Vec<usize>),
    bound: i64,
    proven: bool,
}

/// The parts of `part` that lack an arc of its best path each, the dummy's two among them (Lawler 1972); whether every
/// part without a path has none.
fn split(search: &Search<'_>, part: Part, open: &mut Vec<Part>, nodes: &mut u64) -> bool {
    let dummy = search.arcs.points();
    let path = &part.best.1;
    let around: Vec<usize> = std::iter::once(dummy).chain(path.iter().copied()).chain([dummy]).collect();
    let mut region = part.region;
    let mut complete = true;
    for leg in around.windows(2) {
        let arc = (leg[0], leg[1]);
        if region.within.contains(&arc) {
            continue;
        }
        let mut lacking = region.clone();
        lacking.without.push(arc);
        let found = search.run(&lacking);
        *nodes += found.nodes;
        match found.best {
            Some(best) => open.push(Part { region: lacking, best, bound: found.bound, proven: found.proven }),
            None => complete &= found.proven,
        }
        region.within.push(arc);
    }
    complete
}

/// Prices and bounds are sums over at most `visits` arcs a point.
fn fits(arcs: &Arcs, visits: usize) -> Result<(), ArcsMistake> {
    let n = arcs.points();
    let bound = i64::MAX / (32 * (n as i64 + 2) * visits as i64);
    if arcs.largest() <= bound {
        return Ok(());
    }
    let pairs = (0..n).flat_map(|from| (0..n).map(move |to| (from, to)));
    let (from, to) = pairs.max_by_key(|(from, to)| arcs.raw(*from, *to)).unwrap_or_default();
    Err(ArcsMistake::Overflow { from, to, cost: arcs.largest(), bound, points: n })
}
