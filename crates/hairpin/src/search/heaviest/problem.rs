//! What is asked: costs of arcs, which ends are fixed, and what kinds of graph come of it.

use thiserror::Error;

/// Stands for a missing arc inside the tables: below every cost.
pub(super) const NONE: i64 = i64::MIN;
/// More points than any table of costs can have in memory.
pub const MOST_POINTS: usize = 30_000;

/// A table that is no problem.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ArcsMistake {
    /// A table without a point.
    #[error("no point: a table of costs needs at least one")]
    Empty,
    /// More points than can be held.
    #[error("{points} points, must be at most {MOST_POINTS}")]
    TooMany {
        /// Points asked for.
        points: usize,
    },
    /// A table that is not square.
    #[error("{found} costs for {points} points, must be {points} × {points}")]
    Shape {
        /// Points.
        points: usize,
        /// Costs found.
        found: usize,
    },
    /// A negative cost.
    #[error("cost {cost} of the arc {from}→{to}, must be at least 0")]
    Negative {
        /// First point of the arc.
        from: usize,
        /// Second point of the arc.
        to: usize,
        /// Its cost.
        cost: i64,
    },
    /// Sums of costs could leave 64-bit integers.
    #[error("cost {cost} of the arc {from}→{to}, must be at most {bound} for sums over {points} points to be exact")]
    Overflow {
        /// First point of the arc.
        from: usize,
        /// Second point of the arc.
        to: usize,
        /// Its cost.
        cost: i64,
        /// The largest cost allowed.
        bound: i64,
        /// Points.
        points: usize,
    },
    /// A start or end that is no point.
    #[error("{field} is point {point}, must be less than {points}")]
    End {
        /// `start` or `end`.
        field: &'static str,
        /// The number given.
        point: usize,
        /// Points.
        points: usize,
    },
}

/// Costs of the arcs of a directed graph: c(i, j) ≥ 0, or no arc. The diagonal has no meaning.
///
/// Dense: n² numbers of 8 bytes. Symmetric tables get the sharper of the two relaxations by themselves.
///
/// ```
/// use hairpin::search::heaviest::{Arcs, HeaviestSettings, heaviest};
///
/// // Three points on a line at 0, 1 and 5: 0 to 5 and back to 1 is heavier than straight through.
/// let at = [0_i64, 1, 5];
/// let costs: Vec<Option<i64>> = at.iter().flat_map(|a| at.map(|b| (*a != b).then_some((a - b).abs()))).collect();
/// let answer = heaviest(&Arcs::new(3, &costs)?, &HeaviestSettings::default(), &|| false)?;
/// assert!(answer.proven && answer.bound == Some(9));
/// assert_eq!(answer.paths[0].0, 9); // 5 + 4
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Arcs {
    points: usize,
    costs: Vec<i64>,
    symmetric: bool,
    largest: i64,
}

impl Arcs {
    /// The table in rows: `costs[i·points + j]` is the cost from i to j.
    ///
    /// The largest cost allowed is (2⁶³ − 1)/(32 (n + 2)): 2n multipliers of a few times a cost still sum within 64
    /// bits.
    ///
    /// # Errors
    /// A table that is empty or not square, a negative cost, a cost whose sums could overflow.
    pub fn new(points: usize, costs: &[Option<i64>]) -> Result<Self, ArcsMistake> {
        if points == 0 {
            return Err(ArcsMistake::Empty);
        }
        if points > MOST_POINTS {
            return Err(ArcsMistake::TooMany { points });
        }
        if costs.len() != points * points {
            return Err(ArcsMistake::Shape { points, found: costs.len() });
        }
        // Bounds sum up to 2n multipliers, each at most a few times the largest cost.
        let bound = i64::MAX / (32 * (points as i64 + 2));
        let mut table = vec![NONE; points * points];
        let mut largest = 0;
        for (index, cost) in costs.iter().enumerate() {
            let (from, to) = (index / points, index % points);
            let Some(cost) = *cost else { continue };
            if from == to {
                continue;
            }
            if cost < 0 {
                return Err(ArcsMistake::Negative { from, to, cost });
            }
            if cost > bound {
                return Err(ArcsMistake::Overflow { from, to, cost, bound, points });
            }
            table[index] = cost;
            largest = largest.max(cost);
        }
        let symmetric = (0..points).all(|i| (0..i).all(|j| table[i * points + j] == table[j * points + i]));
        Ok(Self { points, costs: table, symmetric, largest })
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Cost from `from` to `to`.
    pub fn cost(&self, from: usize, to: usize) -> Option<i64> {
        let cost = self.raw(from, to);
        (cost != NONE).then_some(cost)
    }

    /// Whether c(i, j) = c(j, i) everywhere.
    ///
    /// Missing arcs must be missing both ways. It decides between trees and arborescences, and whether backwards is
    /// another path.
    pub fn symmetric(&self) -> bool {
        self.symmetric
    }

    /// Σ c along `path`; `None` if an arc is missing or a point does not exist.
    ///
    /// 0 for a single point and for no point. That no point comes twice is not looked at.
    pub fn total(&self, path: &[usize]) -> Option<i64> {
        if path.iter().any(|point| *point >= self.points) {
            return None;
        }
        path.windows(2).map(|leg| self.cost(leg[0], leg[1])).sum()
    }

    /// Share of the ordered pairs that are arcs.
    ///
    /// m/(n(n − 1)), in 0 … 1; 0 for a single point.
    pub fn density(&self) -> f64 {
        let arcs = self.costs.iter().filter(|cost| **cost != NONE).count();
        arcs as f64 / (self.points * (self.points - 1)).max(1) as f64
    }

    /// Cost from `from` to `to`, [`NONE`] without an arc.
    pub(super) fn raw(&self, from: usize, to: usize) -> i64 {
        self.costs[from * self.points + to]
    }

    /// The largest cost, 0 without arcs.
    pub(super) fn largest(&self) -> i64 {
        self.largest
    }
}

/// Which ends of the path are fixed.
///
/// A free end costs nothing: of n points there are n starts and n ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Ends {
    /// First point; any if not given.
    pub start: Option<usize>,
    /// Last point; any if not given.
    pub end: Option<usize>,
}

impl Ends {
    /// # Errors
    /// An end that is not among `points` points.
    pub(super) fn check(self, points: usize) -> Result<(), ArcsMistake> {
        for (field, point) in [("start", self.start), ("end", self.end)] {
            if let Some(point) = point.filter(|point| *point >= points) {
                return Err(ArcsMistake::End { field, point, points });
            }
        }
        Ok(())
    }

    /// Whether a path may begin at `point`.
    pub(super) fn may_start(self, point: usize) -> bool {
        self.start.is_none_or(|start| start == point)
    }

    /// Whether a path may end at `point`.
    pub(super) fn may_end(self, point: usize) -> bool {
        self.end.is_none_or(|end| end == point)
    }

    /// A path that meets the ends, as a beginning: the heaviest arc that may be a path, or the fewest arcs by
    /// breadth-first search if both ends are fixed; `None` if there is none.
    ///
    /// O(n²). Only two fixed ends can leave none: a single point is a path.
    pub(super) fn first_path(self, arcs: &Arcs) -> Option<Vec<usize>> {
        let n = arcs.points();
        let (Some(start), Some(end)) = (self.start, self.end) else {
            let pairs = (0..n).flat_map(|from| (0..n).map(move |to| (from, to)));
            let allowed = pairs.filter(|(from, to)| self.may_start(*from) && self.may_end(*to));
            let heaviest = allowed.max_by_key(|(from, to)| arcs.raw(*from, *to));
            return Some(match heaviest.filter(|(from, to)| arcs.raw(*from, *to) != NONE) {
                Some((from, to)) => vec![from, to],
                None => vec![self.start.or(self.end).unwrap_or(0)],
            });
        };
        let mut before = vec![usize::MAX; arcs.points()];
        before[start] = start;
        let mut open = std::collections::VecDeque::from([start]);
        while let Some(at) = open.pop_front() {
            if at == end {
                let mut path = vec![end];
                while path[path.len() - 1] != start {
                    path.push(before[path[path.len() - 1]]);
                }
                path.reverse();
                return Some(path);
            }
            for (next, before) in before.iter_mut().enumerate() {
                if *before == usize::MAX && arcs.raw(at, next) != NONE {
                    *before = at;
                    open.push_back(next);
                }
            }
        }
        None
    }
}
