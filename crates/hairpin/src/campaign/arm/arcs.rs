//! Arcs in the place of two straight moves, where they load the arm more: MoveC through a point of the cloud.
//!
//! The graph and its proof know straight moves only. On a path that was found, every point with its two neighbours gives one arc at most; those that are
//! proven clear and cost more than the two moves they stand for are chosen so that no two share a move and together they add most, which is exact for this
//! path: with w_k the gain of the arc through the k-th point, best_k = max(best_{k−1}, best_{k−2} + w_k).

use nalgebra::Isometry3;

use super::ArmSetup;
use super::graph::{ArmGraph, cost_of, joint_settings};
use crate::feasibility::reachability::joint::{Bodies, Circle, Cost, FollowSettings, Motion, moved};
use crate::math::rotation::rotation_vector;

/// Arcs of a path, and what they cost more than what they stand for.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Arcs {
    /// Places on the path of the points that arcs pass, rising; no two beside each other.
    pub(super) through: Vec<usize>,
    /// In the graph's whole units.
    pub(super) gain: i64,
}

/// Points of an arc have one orientation, within this, rad: what a controller does with that of the point on the way is its own affair.
const SAME_TURN: f64 = 1e-9;

/// What arcs are held against.
struct Held<'a> {
    bodies: Bodies<'a>,
    follow: FollowSettings,
    cost: Cost,
}

impl ArmSetup<'_> {
    /// The arcs that add most to the path along `rows`; none where they are not asked for.
    pub(super) fn arcs(&self, graph: &ArmGraph, rows: &[usize]) -> Arcs {
        if !self.scenario.generate.moves.arcs {
            return Arcs::default();
        }
        let (station, settings) = (self.station, joint_settings(self.station, self.scenario));
        let Ok(cost) = cost_of(self.scenario, station.points.len()) else { return Arcs::default() };
        let bodies = Bodies::new(&station.arm, &station.tool, &station.cell, settings.clearance);
        let held = Held { bodies, follow: settings.follow, cost };
        let gains: Vec<Option<i64>> = (1..rows.len().saturating_sub(1))
            .map(|k| {
                let [p, q, r] = [rows[k - 1], rows[k], rows[k + 1]];
                let straight = |from: usize, to: usize| graph.costs[from * graph.points() + to];
                Some(self.arc(graph, &held, [p, q, r])? - straight(p, q)? - straight(q, r)?).filter(|gain| *gain > 0)
            })
            .collect();
        chosen(&gains)
    }

    /// What the arc over three rows costs; `None` if it is none, or not proven to be possible.
    fn arc(&self, graph: &ArmGraph, held: &Held, rows: [usize; 3]) -> Option<i64> {
        let station = self.station;
        let [start, via, end] = rows.map(|row| &station.points[row].pose);
        let turned = |pose: &Isometry3<f64>| rotation_vector(&(start.rotation.inverse() * pose.rotation)).norm();
        if turned(via) > SAME_TURN || turned(end) > SAME_TURN {
            return None;
        }
        let [a, b, c] = [start, via, end].map(|pose| pose.translation.vector);
        let circle = Circle::through(&a, &b, &c).ok()?;
        let motion = Motion::circular(start, circle, &end.rotation);
        let postures = graph.postures.as_ref()?;
        let (from, to) = (postures[rows[0]].as_ref().ok()?, postures[rows[2]].as_ref().ok()?);
        moved(&station.arm, &station.tool, &held.bodies, &motion, [from, to], &held.follow, &mut 0).ok()?;
        Some(held.cost.of_move(&station.arm, &station.tool, &motion, from, 0))
    }
}

/// The arcs of largest gain together, no two beside each other; `gains[k]` is that of the arc through place k + 1.
fn chosen(gains: &[Option<i64>]) -> Arcs {
    // The best of the first places, with and without regard to the last: whether it is taken.
    let mut best = vec![0i64; gains.len() + 2];
    for (k, gain) in gains.iter().enumerate() {
        best[k + 2] = best[k + 1].max(best[k] + gain.unwrap_or(0));
    }
    let (mut through, mut k) = (Vec::new(), gains.len());
    while k > 0 {
        if best[k + 1] > best[k] {
            through.push(k);
            k = k.saturating_sub(2);
        } else {
            k -= 1;
        }
    }
    through.reverse();
    Arcs { through, gain: best[gains.len() + 1] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};

    #[test]
    fn no_other_choice_of_arcs_adds_more() {
        let mut random = stream(4);
        for _ in 0..300 {
            let count = (unit(&mut random) * 9.0) as usize;
            let gains: Vec<Option<i64>> =
                (0..count).map(|_| (unit(&mut random) < 0.7).then(|| 1 + (unit(&mut random) * 9.0) as i64)).collect();
            let found = chosen(&gains);
            let sum: Option<i64> = found.through.iter().map(|k| gains[k - 1]).sum();
            assert_eq!(sum, Some(found.gain));
            assert!(found.through.windows(2).all(|pair| pair[1] > pair[0] + 1), "{found:?}");
            let of = |set: u32| -> Option<i64> {
                let taken = (0..count).filter(|k| set >> k & 1 == 1);
                if set & (set << 1) == 0 { taken.map(|k| gains[k]).sum() } else { None }
            };
            assert_eq!((0..1u32 << count).filter_map(of).max(), Some(found.gain), "{gains:?}");
        }
    }
}
