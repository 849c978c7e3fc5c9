//! A module that clocks every arc of a graph on the real controller, and what it logs as a table of costs.

use std::collections::{BTreeMap, VecDeque};

use hairpin::campaign::bounds::MOST_POINTS;
use hairpin::trajectory::program::{
    JointTarget, Motion, Move, PoseTarget, Program, ProgramError, Speed, Tool, WorkObject, Zone,
};
use thiserror::Error;

use super::write::{RapidError, Writer};
use crate::decimal::decimal;
use crate::delimited::{Cut, Table};

/// The file that the module writes on the controller, in HOME.
const LOG_FILE: &str = "arc_ms.log";
/// First word of the log.
const LOG_MARK: &str = "arc_ms";

/// What is clocked.
#[derive(Debug, Clone)]
pub struct Clocking<'a> {
    /// Name of the module; its procedure is `clock_arcs`.
    pub name: &'a str,
    /// Tool of all moves.
    pub tool: &'a Tool,
    /// Work object of all moves.
    pub work_object: &'a WorkObject,
    /// The points; they are named p0, p1, ….
    pub points: &'a [PoseTarget],
    /// Arcs that are known to be free, from and to. Only these are driven.
    pub arcs: &'a [(usize, usize)],
    /// Where the program begins and ends.
    pub home: &'a JointTarget,
    /// The point that is driven to from home and from which home is driven to.
    pub start: usize,
    /// Whether configurations of points are demanded.
    pub configured: bool,
    /// Joint angles that the start is driven to from home with, in the place of its pose.
    pub at_start: Option<&'a JointTarget>,
    /// Speed of the arcs.
    pub speed: &'a Speed,
    /// Comments at its head.
    pub header: &'a [String],
}

/// A clocking module.
#[derive(Debug, Clone, PartialEq)]
pub struct Clocked {
    /// Its text.
    pub text: String,
    /// Points in the order in which they are passed.
    pub walk: Vec<usize>,
    /// Arcs that no walk from the start along arcs reaches and returns from.
    pub left_out: Vec<(usize, usize)>,
}

/// The module: from home to the start, along every arc that can be reached at least once, back to the start and home.
/// Every arc ends in a stop, is clocked from standstill to standstill, and logged as `from;to;ms` into
/// `HOME:/arc_ms.log`.
///
/// # Errors
/// An arc or the start beyond the points; names and numbers as in [`super::module`].
pub fn arc_clock(clocking: &Clocking<'_>) -> Result<Clocked, RapidError> {
    const PROCEDURE: &str = "clock_arcs";
    let named = |index: usize| clocking.points[index].clone().named(&format!("p{index}"));
    let count = clocking.points.len();
    let beyond = clocking.arcs.iter().flat_map(|(a, b)| [*a, *b]).chain([clocking.start]).find(|point| *point >= count);
    if let Some(index) = beyond {
        return Err(RapidError::Point { index, count });
    }
    let (walk, left_out) = walk(count, clocking.arcs, clocking.start);
    let approach = Speed::predefined("v200").unwrap_or_else(|| clocking.speed.clone());
    let mut program = Program::new(clocking.name, PROCEDURE, clocking.tool.clone(), clocking.work_object.clone());
    let home = |speed: &Speed| Move::new(Motion::AbsoluteJoint(clocking.home.clone()), speed.clone(), Zone::stop());
    let start = match clocking.at_start {
        Some(joints) => Motion::AbsoluteJoint(joints.clone()),
        None => Motion::Joint(named(clocking.start)),
    };
    let to_start = Move::new(start, approach.clone(), Zone::stop());
    program.moves = vec![home(&approach), to_start, home(&approach)];
    let arcs = walk.iter().map(|point| Move::new(Motion::Linear(named(*point)), clocking.speed.clone(), Zone::stop()));
    let all = Program { moves: program.moves.iter().cloned().chain(arcs).collect(), ..program.clone() };
    if let Some(problem) = all.problems().into_iter().next() {
        return Err(ProgramError::into(problem));
    }
    let mut writer = Writer::new(clocking.name, PROCEDURE)?;
    writer.reserve("procedure", "clock_arc")?;
    for name in ["arc_log", "arc_clk"] {
        writer.reserve("variable", name)?;
    }
    writer.data.extend(["LOCAL VAR iodev arc_log;".into(), "LOCAL VAR clock arc_clk;".into()]);
    if !clocking.configured {
        writer.lines.extend(["ConfJ \\Off;".into(), "ConfL \\Off;".into()]);
    }
    writer.go(&program, 0, &program.moves[0])?;
    writer.go(&program, 1, &program.moves[1])?;
    writer.lines.push(format!("Open \"HOME:\" \\File:=\"{LOG_FILE}\", arc_log \\Write;"));
    writer.lines.push(format!("Write arc_log, \"{LOG_MARK};{count}\";"));
    for pair in walk.windows(2) {
        let there = writer.pose(&named(pair[1]))?;
        writer.lines.push(format!("clock_arc {},{},{there};", pair[0], pair[1]));
    }
    writer.lines.push("Close arc_log;".into());
    writer.go(&program, 2, &program.moves[2])?;
    // The one move of the arcs as the writer spells it, with the routine's parameter in the target's place.
    let linear = Move::new(Motion::Linear(named(clocking.start)), clocking.speed.clone(), Zone::stop());
    writer.go(&program, 0, &linear)?;
    let spelt = writer.lines.pop().unwrap_or_default().replacen(&format!("p{}", clocking.start), "there", 1);
    let routine = [
        "LOCAL PROC clock_arc(num a,num b,robtarget there)",
        "  ClkReset arc_clk;",
        "  ClkStart arc_clk;",
        &format!("  {spelt}"),
        "  ClkStop arc_clk;",
        "  Write arc_log, NumToStr(a,0)+\";\"+NumToStr(b,0)+\";\"+NumToStr(1000*ClkRead(arc_clk),3);",
        "ENDPROC",
    ];
    let text = writer.assemble(clocking.name, PROCEDURE, clocking.header, &routine.map(Into::into));
    Ok(Clocked { text, walk, left_out })
}

/// A walk from `start` and back along all arcs from which `start` can be reached again; always the lowest arc that is
/// left, else the way of fewest arcs to one.
fn walk(count: usize, arcs: &[(usize, usize)], start: usize) -> (Vec<usize>, Vec<(usize, usize)>) {
    let mut next = vec![Vec::new(); count];
    let mut previous = vec![Vec::new(); count];
    for &(a, b) in arcs.iter().filter(|(a, b)| a != b) {
        next[a].push(b);
        previous[b].push(a);
    }
    next.iter_mut().for_each(|ends| {
        ends.sort_unstable();
        ends.dedup();
    });
    let (from, back) = (reached(&next, start), reached(&previous, start));
    let useful = |point: usize| from[point].is_some() && back[point].is_some();
    let mut left: Vec<Vec<usize>> =
        (0..count).map(|a| next[a].iter().rev().copied().filter(|b| useful(a) && useful(*b)).collect()).collect();
    let left_out = (0..count).flat_map(|a| next[a].iter().map(move |b| (a, *b)));
    let left_out = left_out.filter(|(a, b)| !(useful(*a) && useful(*b))).collect();
    let mut walk = vec![start];
    let mut here = start;
    loop {
        if let Some(there) = left[here].pop() {
            walk.push(there);
            here = there;
            continue;
        }
        let parents = reached(&next, here);
        let goal =
            (0..count).filter(|point| !left[*point].is_empty()).min_by_key(|point| depth(&parents, here, *point));
        let goal = goal.unwrap_or(start);
        let mut way = Vec::new();
        let mut point = goal;
        while point != here {
            way.push(point);
            point = parents[point].unwrap_or(here);
        }
        walk.extend(way.into_iter().rev());
        if goal == start && left[start].is_empty() {
            return (walk, left_out);
        }
        here = goal;
    }
}

/// Breadth first from `start`: for each point the one before it, for the start itself.
fn reached(next: &[Vec<usize>], start: usize) -> Vec<Option<usize>> {
    let mut parents = vec![None; next.len()];
    parents[start] = Some(start);
    let mut open = VecDeque::from([start]);
    while let Some(point) = open.pop_front() {
        for &there in &next[point] {
            if parents[there].is_none() {
                parents[there] = Some(point);
                open.push_back(there);
            }
        }
    }
    parents
}

/// Arcs from `start` to `point`.
fn depth(parents: &[Option<usize>], start: usize, mut point: usize) -> usize {
    let mut arcs = 0;
    while point != start {
        match parents[point] {
            Some(parent) => point = parent,
            None => return usize::MAX,
        }
        arcs += 1;
    }
    arcs
}

/// Why a log is none.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum LogError {
    /// Its first line says something else.
    #[error("line 1: `{found}`: must be `{LOG_MARK};` and the number of points, {MOST_POINTS} at most")]
    Head {
        /// The line.
        found: String,
    },
    /// A line that is no reading.
    #[error("line {line}: `{found}`: must be `from;to;ms`, points from 0 to {last}, ms more than 0")]
    Line {
        /// Which, from 1.
        line: usize,
        /// The line.
        found: String,
        /// Number of the last point.
        last: usize,
    },
    /// Nothing was clocked.
    #[error("no arc was clocked")]
    Empty,
}

/// What was clocked.
#[derive(Debug, Clone, PartialEq)]
pub struct ArcTimes {
    /// Points.
    pub points: usize,
    /// Mean time of each arc, ms, and how often it was driven.
    pub arcs: BTreeMap<(usize, usize), (f64, usize)>,
}

impl ArcTimes {
    /// The table of costs: one line a point to come from, one cell a point to go to, ms; empty where nothing was
    /// clocked.
    pub fn csv(&self) -> String {
        let cell = |a, b| self.arcs.get(&(a, b)).map_or(String::new(), |(ms, _)| decimal(*ms, 3));
        let row = |a| (0..self.points).map(|b| cell(a, b)).collect::<Vec<_>>().join(",");
        (0..self.points).map(|a| row(a) + "\n").collect()
    }
}

/// Whether a file begins as such a log does.
pub fn is_log(bytes: &[u8]) -> bool {
    bytes.strip_prefix(LOG_MARK.as_bytes()).is_some_and(|rest| rest.starts_with(b";"))
}

/// Reads what a clocking module logged. Arcs that were driven more than once get the mean.
///
/// # Errors
/// [`LogError`].
pub fn read_log(bytes: &[u8]) -> Result<ArcTimes, LogError> {
    let text = crate::listing::decode(bytes);
    let Table { header, names, rows } = Table::of(&text, Cut { delimiter: b';', comment: None });
    let head = header.trim();
    let points = (names.len() == 2 && names.cell(0) == LOG_MARK).then(|| names.cell(1).parse().ok()).flatten();
    let points = points.filter(|n| (1..=MOST_POINTS).contains(n));
    let points: usize = points.ok_or_else(|| LogError::Head { found: head.into() })?;
    let mut arcs: BTreeMap<(usize, usize), (f64, usize)> = BTreeMap::new();
    for row in rows {
        let cells: Vec<&str> = row.cells().collect();
        let refuse = || LogError::Line { line: row.line, found: cells.join(";"), last: points - 1 };
        let [a, b, ms] = cells[..] else { return Err(refuse()) };
        let point = |cell: &str| cell.parse::<usize>().ok().filter(|point| *point < points);
        let ms = ms.parse::<f64>().ok().filter(|ms| ms.is_finite() && *ms > 0.0);
        let (a, b, ms) = (point(a).ok_or_else(refuse)?, point(b).ok_or_else(refuse)?, ms.ok_or_else(refuse)?);
        let (mean, count) = arcs.entry((a, b)).or_default();
        *count += 1;
        *mean += (ms - *mean) / *count as f64;
    }
    if arcs.is_empty() { Err(LogError::Empty) } else { Ok(ArcTimes { points, arcs }) }
}
