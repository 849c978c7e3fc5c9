//! Test instances: an octahedron of second differences as reach set, seeded graphs, and brute force over them.

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::objective::{Aggregate, LegView, Objective};
use super::task::Task;
use crate::feasibility::reach::{Leg, LegFeatures, Reach, StepNode};
use crate::math::random::stream;
use crate::math::rotation::angle_between;

/// Second differences with |d − centre| ≤ 1 in the octahedron's norm, step 1 s.
#[derive(Debug, Clone, Copy)]
pub(super) struct Octahedron {
    pub(super) centre: Vector3<f64>,
    pub(super) half: Vector3<f64>,
}

impl Octahedron {
    /// About 80 000 feasible triples in 252 points of a 30 m cube.
    pub(super) const QUADROTOR: Self = Self { centre: Vector3::new(0.0, 0.0, 2.0), half: Vector3::new(9.4, 9.4, 9.25) };

    /// Wide enough that a dozen points in a cube of 11 m have many trajectories.
    pub(super) const WIDE: Self = Self { centre: Vector3::new(0.0, 0.0, 2.0), half: Vector3::new(12.0, 12.0, 11.0) };

    /// Whether `d` lies in the octahedron grown `scale` times.
    fn holds(&self, d: Vector3<f64>, scale: f64) -> bool {
        (d - self.centre * scale).component_div(&self.half).abs().sum() <= scale
    }

    /// Necessary: with s steps left the end lies in w + s (w − v) + s (s + 1)/2 K, K convex.
    pub(super) fn may_arrive(&self, points: &[Point3<f64>], node: &StepNode, steps: usize) -> bool {
        let (before, now) = (points[node.previous as usize], points[node.current as usize]);
        let s = steps as f64;
        self.holds(points[points.len() - 1] - now - (now - before) * s, s * (s + 1.0) / 2.0)
    }
}

impl Reach<StepNode> for Octahedron {
    fn legs(&self, from: &StepNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<StepNode>>) {
        let (before, now) = (candidates[from.previous as usize], candidates[from.current as usize]);
        let arriving = now - before;
        let expected = now + arriving;
        for (i, point) in candidates.iter().enumerate() {
            if i as u32 != from.current && self.holds(point - expected, 1.0) {
                let leaving = point - now;
                let v_in = arriving.norm();
                let turn = if v_in > 0.0 { angle_between(&arriving, &leaving) } else { 0.0 };
                let length = leaving.norm();
                let climb = leaving.z;
                let features = LegFeatures { v_in, v_out: length, turn, length, climb, ..LegFeatures::default() };
                let to = StepNode { previous: from.current, current: i as u32 };
                out.push(Leg { to, waypoint: i as u32, duration: 1.0, features });
            }
        }
    }
}

/// [`Octahedron::WIDE`], of which more legs may be than there are, and none takes as long as it does.
pub(super) struct Loose<'a> {
    may_be: Octahedron,
    points: &'a [Point3<f64>],
}

impl<'a> Loose<'a> {
    /// By an octahedron grown `share` times.
    pub(super) fn of(share: f64, points: &'a [Point3<f64>]) -> Self {
        Self { may_be: Octahedron { half: Octahedron::WIDE.half * share, ..Octahedron::WIDE }, points }
    }
}

impl Reach<StepNode> for Loose<'_> {
    fn legs(&self, from: &StepNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<StepNode>>) {
        Octahedron::WIDE.legs(from, candidates, out);
    }

    fn possible(&self, from: &StepNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<StepNode>>) {
        self.may_be.legs(from, candidates, out);
        out.iter_mut().for_each(|leg| leg.duration = 0.5);
    }

    fn proven(&self, from: &StepNode, to: &StepNode, duration: f64) -> Option<f64> {
        assert_eq!(duration, 0.5);
        let mut legs = Vec::new();
        Octahedron::WIDE.legs(from, self.points, &mut legs);
        Some(legs.iter().find(|leg| leg.to == *to)?.duration)
    }
}

/// Start, `count` seeded points in a cube of `size`, end.
pub(super) fn points(seed: u64, count: usize, size: f64) -> Vec<Point3<f64>> {
    let mut rng = stream(seed);
    let mut points = vec![Point3::from(Vector3::repeat(size / 3.0))];
    points.extend((0..count).map(|_| Point3::from_slice(&[(); 3].map(|()| size * rng.random::<f64>()))));
    points.push(Point3::from(Vector3::repeat(size * 2.0 / 3.0)));
    points
}

/// The start's node.
pub(super) const START: StepNode = StepNode { previous: 0, current: 0 };

/// Every trajectory of `length` waypoints to the end with its score, best first, ties by waypoint index.
pub(super) fn enumerate<O: Objective, R: Reach<StepNode>>(
    task: &Task<'_, StepNode, R>,
    objective: &O,
    kind: (usize, bool, Aggregate),
) -> Vec<(Vec<u32>, f64)> {
    let mut all = enumerate_open(task, objective, kind);
    all.retain(|(waypoints, _)| waypoints.last() == Some(&task.end()));
    all
}

/// The same to any waypoint: plain recursion.
pub(super) fn enumerate_open<O: Objective, R: Reach<StepNode>>(
    task: &Task<'_, StepNode, R>,
    objective: &O,
    kind: (usize, bool, Aggregate),
) -> Vec<(Vec<u32>, f64)> {
    fn walk<O: Objective, R: Reach<StepNode>>(
        task: &Task<'_, StepNode, R>,
        objective: &O,
        (length, revisits, aggregate): (usize, bool, Aggregate),
        (node, path, score, memory): (StepNode, &mut Vec<u32>, f64, O::Memory),
        all: &mut Vec<(Vec<u32>, f64)>,
    ) {
        if path.len() == length {
            all.push((path.clone(), score));
            return;
        }
        let mut legs = Vec::new();
        task.reach.legs(&node, task.candidates, &mut legs);
        for leg in legs {
            if revisits || !path.contains(&leg.waypoint) {
                let Leg { to, waypoint, duration, features } = leg;
                let from = node.current;
                let view = LegView { candidates: task.candidates, from, to: waypoint, duration, features };
                let (own, memory) = objective.extend(&memory, &view);
                let score = aggregate.add(score, own);
                path.push(waypoint);
                walk(task, objective, (length, revisits, aggregate), (to, path, score, memory), all);
                path.pop();
            }
        }
    }
    let mut all = Vec::new();
    let first = (task.start, &mut vec![0], kind.2.neutral(), objective.start());
    walk(task, objective, kind, first, &mut all);
    all.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    all
}
