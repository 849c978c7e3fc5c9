//! The graph of the tool's sphere alone: every pair of points against every part of the cell, proven or in plain
//! floating point.
//!
//! Most pairs are far from most parts, so that the order of the loops is points, parts, points: the filter judges a
//! whole row against one part in lanes, and only what it leaves open is asked alone.

use nalgebra::Point3;

use super::filter::{self, Filter};
use super::graph::ReachabilityGraph;
use super::refusal::Refusal;
use super::segment::Obstacle;
use super::verdict::Verdict;
use crate::math::simd::Simd;
use crate::world::cell::Cell;

/// How sure an answer must be.
///
/// `Fast` agrees with `Certified` away from contact, and claims nothing.
///
/// `Certified` says "free" of the real numbers; what floating point cannot tell is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Level {
    /// Free is proven; what is neither proven free nor met is refused and called undecided.
    #[default]
    Certified,
    /// Closed forms in floating point.
    Fast,
}

/// Settings of a Cartesian graph.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CartesianSettings {
    /// Radius of the tool's sphere plus what else it must stay away, m.
    ///
    /// ≥ 0; 0 makes the tool a point.
    pub radius: f64,
    /// How sure.
    pub level: Level,
    /// Which version of the kernels.
    pub simd: Simd,
}

/// For every pair of `points` (base frame, m), whether the straight move between them is free of every part of the
/// cell. Both directions are alike. Costs are distances in whole micrometres.
///
/// A pair's refusal names the first part that it meets, in the cell's order.
///
/// n²/2 segments times the parts of the cell, on one thread.
///
/// A move a–b is free if the capsule {a + t(b − a)} ⊕ ball(radius) meets no part. The point's own place is part of
/// every move from it, so that a point inside a part has none.
///
/// Memory: a reason (4 bytes) and a cost (8 bytes) for each ordered pair.
///
/// ```
/// use hairpin::feasibility::reachability::{CartesianSettings, Level, cartesian};
/// use hairpin::math::simd::Simd;
/// use hairpin::world::Shape;
/// use hairpin::world::cell::{Cell, Part, Region};
/// use nalgebra::Point3;
///
/// let ball = Part { name: "ball".into(), region: Region::Shape(Shape::sphere([0.0, 0.0, 0.0], 0.2)?) };
/// let points = [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.5, 0.0]].map(Point3::from);
/// let settings = CartesianSettings { radius: 0.05, level: Level::Certified, simd: Simd::default() };
/// let graph = cartesian(&points, &Cell { parts: vec![ball] }, &settings);
/// assert!(!graph.is_free(0, 1)); // through the ball
/// assert_eq!(graph.cost(0, 2), Some(707_107)); // µm
/// # Ok::<(), hairpin::world::WorldError>(())
/// ```
pub fn cartesian(points: &[Point3<f64>], cell: &Cell, settings: &CartesianSettings) -> ReachabilityGraph {
    let (n, parts) = (points.len(), cell.parts.len());
    // 0 free, 2k + 1 part k is met, 2k + 2 part k is undecided.
    let mut reasons = vec![0u32; n * n];
    let mut queries = 0;
    let obstacles: Vec<Obstacle> = cell.parts.iter().map(|part| Obstacle::new(part.region.clone())).collect();
    let filters: Vec<Option<Filter>> =
        cell.parts.iter().map(|part| Filter::new(&part.region, points, settings.radius)).collect();
    let mut told = vec![filter::OPEN; n];
    for i in 0..n {
        let row = &mut reasons[i * n..(i + 1) * n];
        for (k, (obstacle, filter)) in obstacles.iter().zip(&filters).enumerate() {
            let told = &mut told[..n - i - 1];
            if settings.level == Level::Certified
                && let Some(filter) = filter
            {
                filter.row(settings.simd, i, told);
            } else {
                told.fill(filter::OPEN);
            }
            for (j, told) in (i + 1..n).zip(told.iter()) {
                if row[j] != 0 {
                    continue;
                }
                queries += 1;
                let (met, undecided) = match (*told, settings.level) {
                    (filter::CLEAR, _) => continue,
                    (filter::HIT, _) => (true, false),
                    (_, Level::Certified) => match obstacle.certify(&points[i], &points[j], settings.radius) {
                        Verdict::Clear => (false, false),
                        Verdict::Hit { .. } => (true, false),
                        Verdict::Undecided { .. } => (true, true),
                    },
                    (_, Level::Fast) => (obstacle.region.meets(&points[i], &points[j], settings.radius), false),
                };
                if met {
                    row[j] = 2 * k as u32 + 1 + u32::from(undecided);
                }
            }
        }
    }
    mirror(&mut reasons, n);
    let refusals =
        (0..parts).flat_map(|part| [false, true].map(|undecided| Refusal::ToolMeets { part, undecided })).collect();
    ReachabilityGraph::new(n, reasons, refusals, 2 * queries)
        .with_costs("µm", |i, j| micrometres(&points[i], &points[j]))
}

/// Copies what lies above the diagonal below it, block by block, so that both stay in the cache.
fn mirror(square: &mut [u32], n: usize) {
    const BLOCK: usize = 32;
    for from in (0..n).step_by(BLOCK) {
        for to in (from..n).step_by(BLOCK) {
            for i in from..(from + BLOCK).min(n) {
                for j in (to.max(i + 1))..(to + BLOCK).min(n) {
                    square[j * n + i] = square[i * n + j];
                }
            }
        }
    }
}

/// Length of the straight move in whole micrometres, rounded to nearest.
///
/// NaN becomes 0, as casts do; distances beyond 9·10¹² m saturate.
pub fn micrometres(a: &Point3<f64>, b: &Point3<f64>) -> i64 {
    (1e6 * (b - a).norm()).round() as i64
}
