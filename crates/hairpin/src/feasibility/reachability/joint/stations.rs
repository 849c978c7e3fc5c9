//! The cloud's points as configurations of the arm, and the graph of moves between them.

use nalgebra::Isometry3;

use super::bodies::Bodies;
use super::costs::Cost;
use super::follow::{FollowSettings, Followed, follow};
use super::motion::Motion;
use crate::feasibility::reachability::Refusal;
use crate::feasibility::reachability::graph::ReachabilityGraph;

use crate::robot::arm::{AXES, Arm, Configuration, Joints, Kinematics, Tool};
use crate::world::cell::Cell;

/// A point of the cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// `base_from_tcp`.
    pub pose: Isometry3<f64>,
    /// The configuration that it must be met in, where one is given.
    pub configuration: Option<Configuration>,
}

/// How the arm moves between points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MoveKind {
    /// Straight: MoveL.
    #[default]
    Linear,
    /// In joints: MoveJ.
    Joint,
}

/// Settings of a joint-mode graph.
///
/// One posture a point: the given configuration, else the branch in which most points can be met, on the turns nearest
/// to home.
#[derive(Debug, Clone, PartialEq)]
pub struct JointSettings {
    /// How the arm moves.
    pub moves: MoveKind,
    /// What every link and the tool keep from the cell, m: clearance plus the deviation that is allowed.
    pub clearance: f64,
    /// How a move is followed.
    pub follow: FollowSettings,
    /// Where every program starts and ends, rad; turns and branch are chosen near it.
    pub home: Joints,
}

impl Default for JointSettings {
    fn default() -> Self {
        let home = [0.0, 0.0, 0.0, 0.0, 0.5235987755982988, 0.0];
        Self { moves: MoveKind::Linear, clearance: 0.0, follow: FollowSettings::default(), home }
    }
}

/// The graph, and the joint angles that it stands for.
///
/// `joints`, `from_home` and `to_home` have one entry a point.
#[derive(Debug, Clone, PartialEq)]
pub struct JointGraph {
    /// Moves between the points.
    pub graph: ReachabilityGraph,
    /// Joint angles of every point, or why it has none.
    pub joints: Vec<Result<Joints, Refusal>>,
    /// Why the move in joints from home to the point is refused.
    pub from_home: Vec<Option<Refusal>>,
    /// And the one back.
    pub to_home: Vec<Option<Refusal>>,
    /// Pieces that free moves took, together.
    pub pieces: u64,
}

/// A way in which a refused move would be possible.
///
/// For the straight move to the same point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alternative {
    /// Configuration of the first point.
    pub configuration: Configuration,
    /// Least distance of a joint from its bounds then, rad.
    pub margin: f64,
}

/// Every ordered pair of `stations`: whether `arm` with `tool` can move from one to the other in `cell`, by what reason
/// not, and what it costs. Both moves in joints between home and every point are checked as well.
///
/// n² moves followed, each from its start's posture; 2n more from home and back.
///
/// A station's angles stand for it in every move: a straight move that arrives at others of the same pose is refused
/// ([`Refusal::Configuration`]). Single-threaded, so that questions are counted in one order.
pub fn joint(
    arm: &Arm,
    tool: &Tool,
    cell: &Cell,
    stations: &[Station],
    settings: &JointSettings,
    cost: &Cost,
) -> JointGraph {
    let graph = joint_until((arm, tool, cell), stations, settings, cost, &|| false);
    graph.unwrap_or_else(|_| unreachable!("nothing stops it"))
}

/// The same until `over` says so, which is asked before every move.
///
/// Asked on one thread; the moves from and to home are followed after all others and are not stopped.
///
/// # Errors
/// How many of the n(n − 1) moves were looked at by then: a graph of some of the moves is none.
pub fn joint_until(
    (arm, tool, cell): (&Arm, &Tool, &Cell),
    stations: &[Station],
    settings: &JointSettings,
    cost: &Cost,
    over: &dyn Fn() -> bool,
) -> Result<JointGraph, usize> {
    let bodies = Bodies::new(arm, tool, cell, settings.clearance);
    let joints = configurations(arm, tool, &bodies, stations, settings);
    let n = stations.len();
    let (mut reasons, mut refusals) = (vec![0u32; n * n], Vec::new());
    let mut costs = vec![0i64; n * n];
    let (mut queries, mut pieces) = (0, 0u64);
    for i in 0..n {
        for j in (0..n).filter(|&j| j != i) {
            if over() {
                return Err(i * (n - 1) + j - usize::from(j > i));
            }
            let outcome = match (&joints[i], &joints[j]) {
                (Err(refusal), _) => Err(*refusal),
                // A point that cannot be stood at cannot be arrived at.
                (_, Err(refusal)) => Err(refusal.shifted(1.0)),
                (Ok(from), Ok(to)) => {
                    let motion = match settings.moves {
                        MoveKind::Linear => Motion::linear(&stations[i].pose, &stations[j].pose),
                        MoveKind::Joint => Motion::Joint { start: *from, end: *to },
                    };
                    moved(arm, tool, &bodies, &motion, [from, to], &settings.follow, &mut queries)
                        .map(|followed| (motion, followed, *from))
                }
            };
            match outcome {
                Ok((motion, followed, from)) => {
                    pieces += u64::from(followed.pieces);
                    costs[i * n + j] = cost.of_move(arm, tool, &motion, &from, i * n + j);
                }
                Err(refusal) => {
                    refusals.push(refusal);
                    reasons[i * n + j] = refusals.len() as u32;
                }
            }
        }
    }
    let mut home = |start: &Joints, end: &Joints| {
        let motion = Motion::Joint { start: *start, end: *end };
        follow(arm, tool, Some(&bodies), &motion, start, &settings.follow, &mut queries).err()
    };
    let from_home = joints.iter().map(|q| q.as_ref().map_or_else(|e| Some(*e), |q| home(&settings.home, q))).collect();
    let to_home = joints.iter().map(|q| q.as_ref().map_or_else(|e| Some(*e), |q| home(q, &settings.home))).collect();
    let graph = ReachabilityGraph::new(n, reasons, refusals, queries);
    let graph = graph.with_costs(cost.unit(), |i, j| costs[i * n + j]);
    Ok(JointGraph { graph, joints, from_home, to_home, pieces })
}

/// Follows `motion` between the angles of its ends, clear of `bodies`; `queries` counts as [`follow`] does.
///
/// # Errors
/// What refuses it.
pub fn moved(
    arm: &Arm,
    tool: &Tool,
    bodies: &Bodies,
    motion: &Motion,
    [from, to]: [&Joints; 2],
    settings: &FollowSettings,
    queries: &mut u64,
) -> Result<Followed, Refusal> {
    let followed = follow(arm, tool, Some(bodies), motion, from, settings, queries)?;
    arrives(&followed.end, to).map(|()| followed)
}

/// A move must arrive at the angles of its end point, not at others of the same pose.
///
/// Within 10⁻³ rad on every axis.
fn arrives(end: &Joints, wanted: &Joints) -> Result<(), Refusal> {
    match (0..AXES).find(|&k| (end[k] - wanted[k]).abs() > 1e-3) {
        Some(axis) => Err(Refusal::Configuration { axis, arrives: end[axis], wanted: wanted[axis] }),
        None => Ok(()),
    }
}

/// Every posture that `station` can be met in, one for each branch that has any: on the turns nearest to home, in the
/// configuration that is given where one is; in the order of their cfx.
pub fn postures(
    arm: &Arm,
    tool: &Tool,
    bodies: &Bodies,
    station: &Station,
    settings: &JointSettings,
) -> Vec<(u8, Joints)> {
    let (best, _) = candidates(arm, tool, bodies, station, settings);
    (0..8).zip(best).filter_map(|(cfx, q)| Some((cfx, q?))).collect()
}

/// The best angles of every cfx, and the reason that came farthest where there are none.
///
/// Nearest to home by Σ |q_k − home_k|, rad, over whole turns within the limits.
fn candidates(
    arm: &Arm,
    tool: &Tool,
    bodies: &Bodies,
    station: &Station,
    settings: &JointSettings,
) -> ([Option<Joints>; 8], Refusal) {
    let near = |q: &Joints| -> f64 { (0..AXES).map(|k| (q[k] - settings.home[k]).abs()).sum() };
    let flange = station.pose * tool.tcp.inverse();
    let (mut best, mut why) = ([None::<Joints>; 8], Refusal::unmet(arm, &flange, 0.0));
    for solution in arm.inverse(&flange, &settings.home) {
        let turned = arm.turns_of(&solution);
        // Of a chain other postures may be there.
        if turned.is_empty() && arm.has_closed_inverse() {
            why = why.or_nearer(beyond(arm, &solution));
        }
        for q in turned {
            let own = arm.configuration(&q);
            if station.configuration.is_some_and(|asked| asked != own) {
                continue;
            }
            let margin = arm.margin(&q);
            let refusal = if margin.value < settings.follow.margin && settings.moves == MoveKind::Linear {
                Some(Refusal::Singular { margin, least: settings.follow.margin, at: 0.0 })
            } else {
                bodies.standing(&q, 0.0)
            };
            match refusal {
                Some(refusal) => why = why.or_nearer(refusal),
                None => {
                    let kept = &mut best[usize::from(own.cfx)];
                    if kept.is_none_or(|kept| near(&q) < near(&kept)) {
                        *kept = Some(q);
                    }
                }
            }
        }
    }
    (best, why)
}

/// One set of joint angles a point: where its configuration is given, in that; else all in the branch in which most
/// points can be met (of equals home's, then the least), on the turns nearest to home.
fn configurations(
    arm: &Arm,
    tool: &Tool,
    bodies: &Bodies,
    stations: &[Station],
    settings: &JointSettings,
) -> Vec<Result<Joints, Refusal>> {
    let candidates: Vec<([Option<Joints>; 8], Refusal)> =
        stations.iter().map(|station| candidates(arm, tool, bodies, station, settings)).collect();
    let count = |cfx: usize| candidates.iter().filter(|(best, _)| best[cfx].is_some()).count();
    let home = usize::from(arm.branch(&settings.home).cfx());
    let chosen = (0..8).max_by_key(|&cfx| (count(cfx), cfx == home, 8 - cfx)).unwrap_or(home);
    let any = matches!(arm.kinematics, Kinematics::Chain);
    let one = |(station, (best, why)): (&Station, &([Option<Joints>; 8], Refusal))| {
        let asked = station.configuration.map_or(chosen, |asked| usize::from(asked.cfx));
        let found = best[asked].or_else(|| best.iter().flatten().next().filter(|_| any).copied());
        found.ok_or_else(|| {
            if best.iter().any(Option::is_some) { Refusal::OtherBranch { cfx: chosen as u8 } } else { *why }
        })
    };
    stations.iter().zip(&candidates).map(one).collect()
}

/// The axis that is farthest beyond its bounds on every turn.
fn beyond(arm: &Arm, q: &Joints) -> Refusal {
    let worst =
        (0..AXES).min_by(|&a, &b| arm.limits[a].margin(q[a]).total_cmp(&arm.limits[b].margin(q[b]))).unwrap_or(0);
    let limit = &arm.limits[worst];
    let bound = if q[worst] < limit.lower { limit.lower } else { limit.upper };
    Refusal::JointLimit { axis: worst, angle: q[worst], bound, at: 0.0 }
}

impl Alternative {
    /// What to write instead of a configuration, and by how much the move then fits: `with cf4 = -1 it fits by 9.4°`.
    pub fn in_words(&self, instead_of: &Configuration) -> String {
        let names =
            ["cf1", "cf4", "cf6", "cfx"].into_iter().zip(self.configuration.numbers()).zip(instead_of.numbers());
        let changed: Vec<String> =
            names.filter(|((_, new), old)| new != old).map(|((name, new), _)| format!("{name} = {new}")).collect();
        let changed = if changed.is_empty() { "the same configuration".to_owned() } else { changed.join(", ") };
        format!("with {changed} it fits by {:.1}°", self.margin.to_degrees())
    }
}

impl JointGraph {
    /// Among all configurations of the first point, the one in which the straight move `from` → `to` stays farthest
    /// inside the joints' bounds, obstacles included; `None` if there is none.
    pub fn alternative(
        arm: &Arm,
        tool: &Tool,
        cell: &Cell,
        from: &Station,
        to: &Station,
        settings: &JointSettings,
    ) -> Option<Alternative> {
        let bodies = Bodies::new(arm, tool, cell, settings.clearance);
        let motion = Motion::linear(&from.pose, &to.pose);
        let flange = from.pose * tool.tcp.inverse();
        let starts = arm.inverse(&flange, &settings.home).into_iter().flat_map(|q| arm.turns_of(&q));
        let ways = starts.filter_map(|start| {
            let followed = follow(arm, tool, Some(&bodies), &motion, &start, &settings.follow, &mut 0).ok()?;
            Some(Alternative { configuration: arm.configuration(&start), margin: followed.limit_margin })
        });
        ways.max_by(|a, b| a.margin.total_cmp(&b.margin))
    }
}
