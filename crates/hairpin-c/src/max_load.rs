//! The heaviest paths through a table of costs.

use std::ffi::c_void;
use std::time::{Duration, Instant};

use hairpin::search::heaviest::{
    Arcs, Ends, Heaviest, HeaviestSettings, Outcome, WalkSettings, heaviest, heaviest_walk,
};
use rayon::ThreadPoolBuilder;

use crate::memory::{Room, given, many, put, result};
use crate::refusal::{Code, Error, HAIRPIN_INVALID, HAIRPIN_SYSTEM, HAIRPIN_TOO_SMALL, Refused, enter};

/// A cost that says that there is no arc.
pub const HAIRPIN_NO_ARC: i64 = -1;
/// An end that may be any point.
pub const HAIRPIN_ANY_POINT: i64 = -1;

/// Asked now and then, from any thread, whether to stop: anything but 0 says so. It must not throw and may be asked by
/// several threads at once.
pub type Stop = Option<unsafe extern "C" fn(context: *mut c_void) -> i32>;

/// What is wanted of a path. hairpin_max_load_defaults fills it in.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MaxLoadSettings {
    /// First point; HAIRPIN_ANY_POINT: any.
    pub start: i64,
    /// Last point; HAIRPIN_ANY_POINT: any.
    pub end: i64,
    /// Paths that cost less are not wanted.
    pub min_cost: i64,
    /// How many different paths, the heaviest first.
    pub paths: usize,
    /// How often a point may come, 1 to 16; with more than 1 no arc is used twice.
    pub visits: usize,
    /// Seed of the local search.
    pub seed: u64,
    /// Problems that each part of branch and bound looks at, at most: the same on every machine; 0: no bound.
    pub most_nodes: u64,
    /// Seconds after which the best so far is the answer; 0: no bound.
    pub time_limit_s: f64,
    /// Threads; 0: one for each core. The answer is the same with any number.
    pub threads: usize,
    /// Says when to stop, or NULL.
    pub stop: Stop,
    /// What `stop` is called with.
    pub stop_context: *mut c_void,
}

/// One path: `count` points from place `first` of the order on.
#[repr(C)]
pub struct LoadPath {
    /// Its cost.
    pub cost: i64,
    /// Where it begins.
    pub first: usize,
    /// Points.
    pub count: usize,
}

/// There is a path.
pub const HAIRPIN_FOUND: i32 = 0;
/// The fixed end cannot be reached from the fixed start: proven.
pub const HAIRPIN_NO_PATH: i32 = 1;
/// No path costs as much as is wanted: proven.
pub const HAIRPIN_BELOW_MIN_COST: i32 = 2;
/// None was found yet.
pub const HAIRPIN_NOT_FOUND: i32 = 3;

/// What came of it.
#[repr(C)]
pub struct MaxLoad {
    /// HAIRPIN_FOUND, or why there is no path.
    pub status: i32,
    /// 1 where the first path is proven the heaviest (all the heaviest ones, where more are wanted).
    pub proven: i32,
    /// No path costs more; HAIRPIN_NO_ARC where there is none.
    pub bound: i64,
    /// Paths.
    pub paths: usize,
    /// Points of all paths together.
    pub points: usize,
    /// Problems that branch and bound looked at.
    pub nodes: u64,
}

/// One path between any points, each once, proven, on every core, for as long as it takes.
#[unsafe(no_mangle)]
pub extern "C" fn hairpin_max_load_defaults() -> MaxLoadSettings {
    MaxLoadSettings {
        start: HAIRPIN_ANY_POINT,
        end: HAIRPIN_ANY_POINT,
        min_cost: 0,
        paths: 1,
        visits: 1,
        seed: 0,
        most_nodes: 0,
        time_limit_s: 0.0,
        threads: 0,
        stop: None,
        stop_context: std::ptr::null_mut(),
    }
}

/// Looks for the path of maximal total cost in which no point comes twice; points may be left out. Takes memory.
///
/// @param costs points * points costs, row by row: from the row's point to the column's, whole numbers (um, us, counts)
///        so that every sum is exact; HAIRPIN_NO_ARC where there is no arc
/// @param points how many points
/// @param settings what is wanted; NULL: hairpin_max_load_defaults
/// @param paths where the paths are written, the heaviest first
/// @param paths_room how many there is room for
/// @param order where the points of all paths are written, one path after the other
/// @param order_room how many there is room for: paths * points * visits does for all
/// @param answer what came of it; with too little room no path is written, and this says how many there are
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_max_load(
    costs: *const i64,
    points: usize,
    settings: *const MaxLoadSettings,
    paths: *mut LoadPath,
    paths_room: usize,
    order: *mut usize,
    order_room: usize,
    answer: *mut MaxLoad,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, with as many values or room for them, as the header has it.
    unsafe {
        enter(error, || {
            let cells = points.saturating_mul(points);
            let costs = many(costs, cells, "costs")?;
            let usual = hairpin_max_load_defaults();
            let settings = if settings.is_null() { usual } else { *given(settings, "settings")? };
            let mut paths = Room::new(paths, paths_room, "paths")?;
            let mut order = Room::new(order, order_room, "order")?;
            let place = result(answer, "answer")?;
            let costs: Vec<Option<i64>> = costs.iter().map(|cost| (*cost != HAIRPIN_NO_ARC).then_some(*cost)).collect();
            let arcs = Arcs::new(points, &costs).map_err(Refused::invalid)?;
            let found = search(&arcs, &settings)?;
            let all: Vec<usize> = found.paths.iter().flat_map(|(_, path)| path.iter().copied()).collect();
            put(place, told(&found, all.len()))?;
            if found.paths.len() > paths_room {
                let sentence = format_args!("room for {paths_room} paths: there are {}", found.paths.len());
                return Err(Refused::new(HAIRPIN_TOO_SMALL, sentence));
            }
            order.fill(all.iter().copied())?;
            let mut first = 0;
            paths.fill(found.paths.iter().map(|(cost, path)| {
                let one = LoadPath { cost: *cost, first, count: path.len() };
                first += path.len();
                one
            }))
        })
    }
}

/// When to stop, as the caller says.
struct Ending {
    until: Option<Instant>,
    stop: Stop,
    context: *mut c_void,
}

// SAFETY: `stop` may be called from any thread, and its context with it, as the header has it; nothing else of it is
// looked at through the pointer.
unsafe impl Sync for Ending {}

impl Ending {
    fn has_come(&self) -> bool {
        if self.until.is_some_and(|until| Instant::now() >= until) {
            return true;
        }
        // SAFETY: it is a function of this type by the caller's word, and is called with what it came with.
        self.stop.is_some_and(|stop| unsafe { stop(self.context) } != 0)
    }
}

/// Threads at most.
const MOST_THREADS: usize = 1024;
/// Paths at most.
const MOST_PATHS: usize = 100_000;

fn search(arcs: &Arcs, settings: &MaxLoadSettings) -> Result<Heaviest, Refused> {
    let MaxLoadSettings { paths, visits, threads, time_limit_s, .. } = *settings;
    for (field, value, bound) in [("threads", threads, MOST_THREADS), ("paths", paths, MOST_PATHS)] {
        if value > bound {
            return Err(Refused::new(HAIRPIN_INVALID, format_args!("`{field}` = {value}: must be at most {bound}")));
        }
    }
    if paths == 0 {
        return Err(Refused::new(HAIRPIN_INVALID, format_args!("`paths` = 0: must be at least 1")));
    }
    let limit = match time_limit_s {
        0.0 => None,
        seconds => Some(Duration::try_from_secs_f64(seconds).map_err(|_| {
            Refused::new(HAIRPIN_INVALID, format_args!("`time_limit_s` = {seconds}: must be finite and >= 0"))
        })?),
    };
    let until = limit.and_then(|limit| Instant::now().checked_add(limit));
    let ending = Ending { until, stop: settings.stop, context: settings.stop_context };
    let MaxLoadSettings { start, end, min_cost, seed, most_nodes, .. } = *settings;
    let point = |field: &str, point: i64| match usize::try_from(point) {
        Ok(point) => Ok(Some(point)),
        Err(_) if point == HAIRPIN_ANY_POINT => Ok(None),
        Err(_) => {
            Err(Refused::new(HAIRPIN_INVALID, format_args!("`{field}` = {point}: must be a point, or -1 for any")))
        }
    };
    let ends = Ends { start: point("start", start)?, end: point("end", end)? };
    let (min_cost, most_nodes) = (Some(min_cost.max(0)), (most_nodes != 0).then_some(most_nodes));
    let ask = || {
        let stop = || ending.has_come();
        if visits == 1 {
            let one =
                HeaviestSettings { ends, min_cost, programs: paths, seed, most_nodes, ..HeaviestSettings::default() };
            return heaviest(arcs, &one, &stop).map_err(Refused::invalid);
        }
        let walk = WalkSettings { ends, visits, min_cost, programs: paths, most_nodes, proof: false };
        heaviest_walk(arcs, &walk, &stop).map(|(found, _)| found).map_err(Refused::invalid)
    };
    // A pool of this call's own, whose threads end with it: nothing of it is left to the caller's process.
    let pool = ThreadPoolBuilder::new().num_threads(threads);
    let done = pool.build_scoped(|thread| thread.run(), |pool| pool.install(ask));
    done.map_err(|error| Refused::new(HAIRPIN_SYSTEM, format_args!("no threads to search with: {error}")))?
}

fn told(found: &Heaviest, points: usize) -> MaxLoad {
    MaxLoad {
        status: match found.outcome {
            Outcome::Found => HAIRPIN_FOUND,
            Outcome::Infeasible => HAIRPIN_NO_PATH,
            Outcome::BelowMinCost => HAIRPIN_BELOW_MIN_COST,
            Outcome::NotFound => HAIRPIN_NOT_FOUND,
        },
        proven: found.proven.into(),
        bound: found.bound.unwrap_or(HAIRPIN_NO_ARC),
        paths: found.paths.len(),
        points,
        nodes: found.nodes,
    }
}
