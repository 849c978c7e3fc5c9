//! `hull` for vehicles in the plane: convex hulls of the end points of constant-input runs, in the frame of the body.
//!
//! A vehicle that drives carries its heading, speed and steering over a waypoint. Where it ends after one step of
//! constant input, seen from its body, depends on speed and steering alone, so each bin of these has one hull, turned
//! by the heading at hand. Heading, speed and steering at the next waypoint are those of the run that ended nearest to
//! it. Neither sound nor complete, as every hull of end points; headings and states are rounded to their bins.
//!
//! ```text
//! waypoint w follows (v, ψ, bin) if  R(−ψ)(w − v) ∈ conv {ends of the bin's runs}  and  |w − v| ≤ v_max Δt
//! next node: ψ + Δψ and bin of the run that ended nearest to R(−ψ)(w − v)
//! ```

use std::f64::consts::TAU;

use nalgebra::{Point3, Vector3};
use thiserror::Error;

use super::features::features;
use super::{Leg, Reach};
use crate::math::power::square;

/// A step-wise node with what the vehicle carries over its waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyNode {
    /// The waypoint before; equal to `current` at the start.
    pub previous: u32,
    /// The current waypoint.
    pub current: u32,
    /// Number of the heading: ψ = 2π · heading / [`BodyGrid::headings`].
    pub heading: u32,
    /// Number of the bin of speed and steering.
    pub bin: u32,
}

/// What is told apart, and what is tried.
///
/// inputs² runs for each of |speeds| · |steerings| bins. Each level 1 to 1000 finite numbers; `step` finite and above
/// 0.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyGrid {
    /// Speeds at which hulls are sampled, m/s; a state belongs to the nearest.
    pub speeds: Vec<f64>,
    /// Steering at which they are sampled: angles (rad), or yaw rates (rad/s).
    pub steerings: Vec<f64>,
    /// Constant inputs tried per input (Res), 2 to 64: their squares are the runs of a bin.
    pub inputs: usize,
    /// Headings told apart, 8 to 3600.
    pub headings: u32,
    /// Duration of a leg, s.
    pub step: f64,
    /// No leg is faster than this, m/s (leg ÷ step); +∞: no cap.
    pub max_speed: f64,
}

/// Why there is no hull.
///
/// Raised by [`BodyHull::sampled`], and by what samples with it.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum NoBodyHull {
    /// A setting out of bounds.
    #[error("{field} = {value}: must be {bound}")]
    Setting {
        /// Name of the setting.
        field: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// A run left the numbers.
    #[error("a run from speed {speed} m/s with steering {steering} ends nowhere")]
    NotFinite {
        /// Its first speed, m/s.
        speed: f64,
        /// Its first steering.
        steering: f64,
    },
    /// All runs of every bin end on a line.
    #[error("the runs of no bin span an area")]
    Flat,
}

/// The end of a run in the frame of its start.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// x forward, y left, m.
    end: [f64; 2],
    /// Change of heading, rad.
    yaw: f64,
    /// Bin of speed and steering at the end.
    bin: u32,
}

/// The runs of one bin.
#[derive(Debug, Clone)]
struct Bin {
    runs: Vec<Run>,
    /// Corners of their hull, counter-clockwise; none where they lie on a line, and then nothing is in reach.
    outline: Vec<[f64; 2]>,
}

/// The hulls of all bins.
///
/// Nodes are (previous, current, heading, bin): (points²) · headings · bins at most, of which a search meets few.
#[derive(Debug, Clone)]
pub struct BodyHull {
    grid: BodyGrid,
    bins: Vec<Bin>,
    farthest: f64,
}

/// Points so far outside of an edge count as on it, m.
const ON_EDGE: f64 = 1e-9;

impl BodyHull {
    /// Samples every bin: `run(state, shares)` drives for one step from the origin, heading along x with (speed,
    /// steering) = `state`, under the constant inputs at `shares` (0 … 1) between their limits, and tells (x, y, ψ) and
    /// (speed, steering) at the end.
    ///
    /// Bins of which all runs end on a line reach nothing, and are no error while others span an area.
    ///
    /// # Errors
    /// [`NoBodyHull`].
    pub fn sampled(
        grid: &BodyGrid,
        run: impl Fn([f64; 2], [f64; 2]) -> ([f64; 3], [f64; 2]),
    ) -> Result<Self, NoBodyHull> {
        check(grid)?;
        let share = |i: usize| i as f64 / (grid.inputs - 1) as f64;
        let mut bins = Vec::with_capacity(grid.speeds.len() * grid.steerings.len());
        for speed in &grid.speeds {
            for steering in &grid.steerings {
                let mut runs = Vec::with_capacity(grid.inputs * grid.inputs);
                for i in 0..grid.inputs * grid.inputs {
                    let shares = [share(i / grid.inputs), share(i % grid.inputs)];
                    let ([x, y, yaw], state) = run([*speed, *steering], shares);
                    if ![x, y, yaw, state[0], state[1]].iter().all(|value| value.is_finite()) {
                        return Err(NoBodyHull::NotFinite { speed: *speed, steering: *steering });
                    }
                    runs.push(Run { end: [x, y], yaw, bin: nearest_bin(grid, state) });
                }
                let outline = outline(runs.iter().map(|run| run.end).collect());
                bins.push(Bin { runs, outline });
            }
        }
        if bins.iter().all(|bin| bin.outline.is_empty()) {
            return Err(NoBodyHull::Flat);
        }
        let ends = bins.iter().flat_map(|bin| &bin.runs).map(|run| libm::hypot(run.end[0], run.end[1]));
        let farthest = ends.fold(0.0, f64::max);
        Ok(Self { grid: grid.clone(), bins, farthest })
    }

    /// The node at the start: `yaw` (rad) and (speed, steering) = `state`, each at the nearest that is told apart.
    pub fn start(&self, yaw: f64, state: [f64; 2]) -> BodyNode {
        BodyNode { previous: 0, current: 0, heading: self.heading(yaw), bin: nearest_bin(&self.grid, state) }
    }

    /// Heading of a node, rad in [0, 2π).
    pub fn yaw(&self, node: &BodyNode) -> f64 {
        TAU * f64::from(node.heading) / f64::from(self.grid.headings)
    }

    /// Distance of the farthest end of a run, m.
    pub fn farthest(&self) -> f64 {
        self.farthest
    }

    /// A necessary test for searches: false only if no `steps` legs lead from `node` to the last of `points`.
    ///
    /// |end − here| ≤ steps · farthest: triangle inequality, whatever is carried.
    pub fn may_arrive(&self, points: &[Point3<f64>], node: &BodyNode, steps: usize) -> bool {
        let way = points[points.len() - 1] - points[node.current as usize];
        way.norm() <= steps as f64 * (self.farthest + 2.0 * ON_EDGE)
    }

    /// The nearest of the headings told apart, modulo a turn.
    fn heading(&self, yaw: f64) -> u32 {
        let headings = f64::from(self.grid.headings);
        ((yaw / TAU).rem_euclid(1.0) * headings).round() as u32 % self.grid.headings
    }
}

impl Reach<BodyNode> for BodyHull {
    /// Waypoints within the outline of the state's bin, seen from its body, and no farther than the top speed goes in
    /// one step or the farthest run ended. Each takes heading and bin from the run that ended nearest to it.
    fn legs(&self, from: &BodyNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<BodyNode>>) {
        let bin = &self.bins[from.bin as usize];
        let here = candidates[from.current as usize];
        let before = here - candidates[from.previous as usize];
        let yaw = self.yaw(from);
        let (sin, cos) = libm::sincos(yaw);
        let longest = (self.grid.max_speed * self.grid.step).min(self.farthest + ON_EDGE);
        for (waypoint, there) in (0u32..).zip(candidates) {
            let way: Vector3<f64> = there - here;
            if waypoint == from.current || way.norm_squared() > longest * longest {
                continue;
            }
            let seen = [cos * way.x + sin * way.y, cos * way.y - sin * way.x];
            if !contains(&bin.outline, seen) {
                continue;
            }
            let apart = |run: &Run| square(run.end[0] - seen[0]) + square(run.end[1] - seen[1]);
            let Some(nearest) = bin.runs.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))) else { continue };
            let heading = self.heading(yaw + nearest.yaw);
            let to = BodyNode { previous: from.current, current: waypoint, heading, bin: nearest.bin };
            out.push(Leg { to, waypoint, duration: self.grid.step, features: features(&before, &way, self.grid.step) });
        }
    }
}

/// The first setting out of bounds, by name.
fn check(grid: &BodyGrid) -> Result<(), NoBodyHull> {
    let levels = |values: &[f64]| values.iter().find(|value| !value.is_finite()).copied();
    let bounds = [
        ("inputs", grid.inputs as f64, (2..=64).contains(&grid.inputs), "2 to 64"),
        ("headings", f64::from(grid.headings), (8..=3600).contains(&grid.headings), "8 to 3600"),
        ("step_s", grid.step, grid.step.is_finite() && grid.step > 0.0, "finite and above 0 s"),
        ("max_speed_m_s", grid.max_speed, grid.max_speed > 0.0, "above 0 m/s"),
        ("speeds", grid.speeds.len() as f64, (1..=1000).contains(&grid.speeds.len()), "1 to 1000 speeds"),
        ("steerings", grid.steerings.len() as f64, (1..=1000).contains(&grid.steerings.len()), "1 to 1000 steerings"),
        ("speeds", levels(&grid.speeds).unwrap_or(0.0), levels(&grid.speeds).is_none(), "finite"),
        ("steerings", levels(&grid.steerings).unwrap_or(0.0), levels(&grid.steerings).is_none(), "finite"),
    ];
    match bounds.into_iter().find(|(_, _, holds, _)| !holds) {
        Some((field, value, _, bound)) => Err(NoBodyHull::Setting { field, value, bound }),
        None => Ok(()),
    }
}

/// The bin whose speed and steering are nearest to `state`, the first of equals.
fn nearest_bin(grid: &BodyGrid, state: [f64; 2]) -> u32 {
    let nearest = |levels: &[f64], value: f64| {
        let apart = |i: &usize| (levels[*i] - value).abs();
        (0..levels.len()).min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(0)
    };
    (nearest(&grid.speeds, state[0]) * grid.steerings.len() + nearest(&grid.steerings, state[1])) as u32
}

/// Twice the area of the triangle (a, b, c), positive if it turns left.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Corners of the convex hull, counter-clockwise: Andrew's monotone chains (1979). Empty if all lie on a line.
fn outline(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let chain = |points: &mut dyn Iterator<Item = &[f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..] {
                // A corner that stands out by less than this is none.
                if turn(a, b, *point) > ON_EDGE * libm::hypot(point[0] - a[0], point[1] - a[1]) {
                    break;
                }
                chain.pop();
            }
            chain.push(*point);
        }
        // Its last corner is the first of the other chain.
        chain.pop();
        chain
    };
    let mut corners = chain(&mut points.iter());
    corners.extend(chain(&mut points.iter().rev()));
    if corners.len() < 3 { Vec::new() } else { corners }
}

/// Whether `point` lies in the polygon or on its edge.
fn contains(outline: &[[f64; 2]], point: [f64; 2]) -> bool {
    let inside = |i: usize| {
        let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
        turn(a, b, point) >= -ON_EDGE * libm::hypot(b[0] - a[0], b[1] - a[1])
    };
    !outline.is_empty() && (0..outline.len()).all(inside)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::hashed_unit;

    /// A unicycle whose speed and yaw rate follow their inputs at once: arcs in closed form.
    fn arc(_: [f64; 2], shares: [f64; 2]) -> ([f64; 3], [f64; 2]) {
        let (v, w) = (2.0 * shares[0], 2.0 * shares[1] - 1.0);
        let (sin, cos) = libm::sincos(w);
        let end = if w.abs() < 1e-9 { [v, 0.0, 0.0] } else { [v * sin / w, v * (1.0 - cos) / w, w] };
        (end, [v, w])
    }

    fn grid() -> BodyGrid {
        BodyGrid {
            speeds: vec![0.0, 1.0, 2.0],
            steerings: vec![-1.0, 0.0, 1.0],
            inputs: 9,
            headings: 72,
            step: 1.0,
            max_speed: f64::INFINITY,
        }
    }

    fn points(seed: u64, count: u64, size: f64) -> Vec<Point3<f64>> {
        let at = |i: u64, k: u64| size * (hashed_unit(seed, &[i, k]) - 0.5);
        let drawn = (0..count).map(|i| Point3::new(at(i, 0), at(i, 1), 0.0));
        std::iter::once(Point3::origin()).chain(drawn).collect()
    }

    fn legs(hull: &BodyHull, node: &BodyNode, points: &[Point3<f64>]) -> Vec<Leg<BodyNode>> {
        let mut out = Vec::new();
        hull.legs(node, points, &mut out);
        out
    }

    #[test]
    fn what_is_in_reach_is_in_every_half_plane_that_holds_all_ends() {
        let hull = BodyHull::sampled(&grid(), arc).unwrap();
        let node = hull.start(0.0, [1.0, 0.0]);
        let ends: Vec<[f64; 2]> = (0..81)
            .map(|i| arc([0.0; 2], [f64::from(i / 9) / 8.0, f64::from(i % 9) / 8.0]).0)
            .map(|e| [e[0], e[1]])
            .collect();
        let outside = |p: [f64; 2]| {
            ends.iter().any(|a| {
                ends.iter().any(|b| ends.iter().all(|c| turn(*a, *b, *c) >= -1e-12) && turn(*a, *b, p) < -1e-12)
            })
        };
        let points = points(4, 400, 5.0);
        let found: Vec<u32> = legs(&hull, &node, &points).iter().map(|leg| leg.waypoint).collect();
        let expected: Vec<u32> =
            (1..points.len()).filter(|i| !outside([points[*i].x, points[*i].y])).map(|i| i as u32).collect();
        assert_eq!(found, expected);
        assert!(found.len() > 20 && found.len() < 300, "{}", found.len());
        assert!((hull.farthest() - 2.0).abs() < 1e-12);
    }

    #[test]
    fn the_end_of_a_run_carries_its_heading_speed_and_steering() {
        let hull = BodyHull::sampled(&grid(), arc).unwrap();
        for (shares, bin) in [([1.0, 1.0], 8), ([0.5, 0.5], 4), ([0.5, 0.0], 3)] {
            let ([x, y, yaw], _) = arc([0.0; 2], shares);
            for turned in [0.0, 1.0, 4.0] {
                let start = hull.start(turned, [0.0, 0.0]);
                let (sin, cos) = libm::sincos(hull.yaw(&start));
                let points = [Point3::origin(), Point3::new(cos * x - sin * y, sin * x + cos * y, 0.0)];
                let legs = legs(&hull, &start, &points);
                let [leg] = legs[..] else { panic!("{legs:?}") };
                let off = (hull.yaw(&leg.to) - hull.yaw(&start) - yaw + 1.0).rem_euclid(TAU) - 1.0;
                assert!(off.abs() <= TAU / 144.0 + 1e-12, "{shares:?}: {off}");
                assert_eq!((leg.to.previous, leg.to.current, leg.to.bin), (0, 1, bin));
                assert_eq!((leg.duration, leg.features.v_in, leg.features.turn), (1.0, 0.0, 0.0));
            }
        }
    }

    #[test]
    fn the_world_turned_by_a_heading_has_the_same_legs() {
        let hull = BodyHull::sampled(&grid(), arc).unwrap();
        let points = points(9, 400, 5.0);
        let (sin, cos) = libm::sincos(TAU / 4.0);
        let turned: Vec<_> =
            points.iter().map(|p| Point3::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y, 0.0)).collect();
        let node = hull.start(0.0, [1.0, 0.0]);
        let quarter = BodyNode { heading: 18, ..node };
        let back = |leg: &Leg<BodyNode>| (leg.waypoint, (leg.to.heading + 72 - 18) % 72, leg.to.bin);
        let plain: Vec<_> =
            legs(&hull, &node, &points).iter().map(|leg| (leg.waypoint, leg.to.heading, leg.to.bin)).collect();
        assert_eq!(legs(&hull, &quarter, &turned).iter().map(back).collect::<Vec<_>>(), plain);
        assert!(plain.len() > 3);
    }

    #[test]
    fn slow_ones_reach_less_and_numbers_out_of_bounds_are_named() {
        // Speed changes by at most 1 m/s, so that bins differ.
        let limited = |state: [f64; 2], shares: [f64; 2]| {
            let v = (state[0] + 2.0 * shares[0] - 1.0).clamp(0.0, 2.0);
            let (end, [_, w]) = arc(state, [0.5 * v, shares[1]]);
            (end, [v, w])
        };
        let hull = BodyHull::sampled(&grid(), limited).unwrap();
        let points = points(2, 200, 5.0);
        let count = |v: f64| legs(&hull, &hull.start(0.0, [v, 0.0]), &points).len();
        assert!(count(0.0) < count(1.0), "{} {}", count(0.0), count(1.0));
        let capped = BodyGrid { max_speed: 0.5, ..grid() };
        let hull = BodyHull::sampled(&capped, arc).unwrap();
        assert!(legs(&hull, &hull.start(0.0, [0.0; 2]), &points).iter().all(|leg| leg.features.v_out <= 0.5));
        for (grid, field) in [
            (BodyGrid { inputs: 1, ..grid() }, "inputs = 1"),
            (BodyGrid { headings: 4, ..grid() }, "headings = 4"),
            (BodyGrid { step: f64::NAN, ..grid() }, "step_s = NaN"),
            (BodyGrid { speeds: vec![], ..grid() }, "speeds = 0"),
            (BodyGrid { steerings: vec![f64::INFINITY], ..grid() }, "steerings = inf"),
        ] {
            let error = BodyHull::sampled(&grid, arc).unwrap_err().to_string();
            assert!(error.contains(field), "{error}");
        }
        let line = BodyHull::sampled(&grid(), |_, shares| ([shares[0], 0.0, 0.0], [0.0; 2]));
        assert_eq!(line.unwrap_err(), NoBodyHull::Flat);
        let lost = BodyHull::sampled(&grid(), |_, _| ([f64::NAN, 0.0, 0.0], [0.0; 2]));
        assert!(matches!(lost, Err(NoBodyHull::NotFinite { .. })));
    }
}
