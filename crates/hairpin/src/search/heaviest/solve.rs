//! The question, the answer, and which method gives it.

use thiserror::Error;

use super::arborescence::Arborescence;
use super::dfs::depth_first;
use super::forest::{Forest, ID_BITS};
use super::problem::{Arcs, ArcsMistake, Ends};
use super::record::{Proof, Recorder};
use super::root::{prove, scale_of};
use super::several::several;
use super::subsets::{MOST_SUBSET_POINTS, best_by_subsets, subset_bytes};

/// How a path is searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// Subsets for few points, else branch and bound; between the two, subsets where that is not proven at once.
    #[default]
    Auto,
    /// Dynamic programming over subsets.
    Subsets,
    /// Branch and bound.
    Branch,
    /// Local search under a bound, without branching.
    Local,
    /// Depth-first search over all paths, cut only by the number of arcs left: the published baseline.
    Dfs,
}

impl Method {
    /// As it is typed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Subsets => "subsets",
            Self::Branch => "branch",
            Self::Local => "local",
            Self::Dfs => "dfs",
        }
    }
}

/// Up to so many points subsets are the quicker way.
const FEW: usize = 14;
/// Up to so many points subsets are the quicker way where branch and bound has to split more than [`QUICK_NODES`].
const SOME: usize = 16;
/// Problems that each part of branch and bound looks at before subsets take over.
const QUICK_NODES: u64 = 4;

/// What is wanted.
#[derive(Debug, Clone)]
pub struct HeaviestSettings {
    /// Fixed ends.
    pub ends: Ends,
    /// Paths below this cost are not wanted.
    pub min_cost: Option<i64>,
    /// How to search.
    pub method: Method,
    /// How many pairwise different paths are wanted, the heaviest first.
    pub programs: usize,
    /// Root seed of the local search.
    pub seed: u64,
    /// Kicks of the local search in each round; as many as points if not given.
    pub kicks: Option<u64>,
    /// Problems that each part of branch and bound looks at, at most: a limit that gives the same answer on any machine.
    pub most_nodes: Option<u64>,
    /// Bytes that the table of subsets may take.
    pub most_bytes: u64,
    /// Whether to keep the proof.
    pub proof: bool,
}

impl Default for HeaviestSettings {
    fn default() -> Self {
        Self {
            ends: Ends::default(),
            min_cost: None,
            method: Method::Auto,
            programs: 1,
            seed: 0,
            kicks: None,
            most_nodes: None,
            most_bytes: 1 << 30,
            proof: false,
        }
    }
}

/// Why a question has no answer.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum HeaviestMistake {
    /// The table or the ends.
    #[error(transparent)]
    Arcs(#[from] ArcsMistake),
    /// The table of subsets would not fit.
    #[error("dynamic programming over subsets of {points} points takes {bytes} bytes, must be at most {bound}")]
    Memory {
        /// Points.
        points: usize,
        /// Bytes that it takes.
        bytes: u128,
        /// Bytes allowed.
        bound: u64,
    },
    /// Only branch and bound ranks paths.
    #[error("{programs} different paths by method {method}, must be 1: only branch gives more")]
    Programs {
        /// Paths asked for.
        programs: usize,
        /// The method asked for.
        method: &'static str,
    },
}

/// What came of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// A path.
    Found,
    /// The fixed end cannot be reached from the fixed start.
    Infeasible,
    /// No path costs as much as was asked for: proven, and the bound says what is possible.
    BelowMinCost,
    /// None of the wanted cost was found yet.
    NotFound,
}

/// The heaviest path.
#[derive(Debug, Clone)]
pub struct Heaviest {
    /// What came of it.
    pub outcome: Outcome,
    /// Paths with their costs, the heaviest first: pairwise different.
    pub paths: Vec<(i64, Vec<usize>)>,
    /// Of each path the points that its triples pass, in order; nothing where there are no triples.
    pub passed: Vec<Vec<usize>>,
    /// No path costs more; `None` if there is no path.
    pub bound: Option<i64>,
    /// Whether the first path is proven the heaviest (all paths the heaviest ones, where more were asked for).
    pub proven: bool,
    /// The method that was used.
    pub method: Method,
    /// Problems that branch and bound looked at.
    pub nodes: u64,
    /// The proof by branch and bound, if it was to be kept and is complete.
    pub proof: Option<Proof>,
}

impl Heaviest {
    /// Of paths of arcs, found without branching.
    pub(super) fn found(paths: Vec<(i64, Vec<usize>)>, bound: Option<i64>, proven: bool, method: Method) -> Self {
        let passed = Vec::new();
        Self { outcome: Outcome::Found, paths, passed, bound, proven, method, nodes: 0, proof: None }
    }

    /// 100 (bound − cost) / cost; 0 where both are 0, infinite where only the cost is.
    pub fn gap_percent(&self) -> Option<f64> {
        let (cost, bound) = (self.paths.first()?.0, self.bound?);
        Some(if bound == cost { 0.0 } else { 100.0 * (bound - cost) as f64 / cost as f64 })
    }
}

/// The path of maximal total cost in which no point comes twice; points may be left out.
///
/// `stop` is asked often and from any thread; then the best so far is the answer. The same seed gives the same answer on
/// any number of threads unless `stop` ends it.
///
/// # Errors
/// Ends that are no points; a table of subsets that would not fit; several paths from a method that gives one.
pub fn heaviest(
    arcs: &Arcs,
    settings: &HeaviestSettings,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Heaviest, HeaviestMistake> {
    let ends = settings.ends;
    ends.check(arcs.points())?;
    if settings.programs > 1 && settings.method == Method::Auto {
        let first = heaviest(arcs, &HeaviestSettings { programs: 1, ..settings.clone() }, stop)?;
        return Ok(wanted(several(arcs, settings, first, stop)?, settings));
    }
    let method = choose(arcs, settings)?;
    if settings.method == Method::Auto && method == Method::Subsets && arcs.points() > FEW {
        let most_nodes = settings.most_nodes.map_or(QUICK_NODES, |most| most.min(QUICK_NODES));
        let quick = HeaviestSettings { method: Method::Branch, most_nodes: Some(most_nodes), ..settings.clone() };
        let found = heaviest(arcs, &quick, stop)?;
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
fn simple_bound(arcs: &Arcs) -> i64 {
    let n = arcs.points();
    (0..n).map(|from| (0..n).filter_map(|to| arcs.cost(from, to)).max().unwrap_or(0)).sum()
}

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
    let proven = searched.open.is_none();
    let (best, below) = (searched.best.cost(), settings.min_cost.unwrap_or(0) - 1);
    let bound = match searched.open {
        None => best.max(below),
        Some(open) => (open.min(root) / scale).max(best).max(below),
    };
    let proof = (proven && settings.proof && settings.programs <= 1).then(|| Proof {
        scale,
        directed: !arcs.symmetric(),
        steps: record.steps,
    });
    Heaviest { paths: searched.best.into_paths(), bound: Some(bound), proven, nodes: searched.nodes, proof, ..answer }
}

/// Holds the answer to the cost that was asked for.
pub(super) fn wanted(mut found: Heaviest, settings: &HeaviestSettings) -> Heaviest {
    let least = settings.min_cost.unwrap_or(0);
    if found.outcome == Outcome::Found && found.paths.first().is_none_or(|(cost, _)| *cost < least) {
        let impossible = found.proven || found.bound.is_some_and(|bound| bound < least);
        found.outcome = if impossible { Outcome::BelowMinCost } else { Outcome::NotFound };
        found.paths.clear();
    }
    found.paths.retain(|(cost, _)| *cost >= least);
    found
}
