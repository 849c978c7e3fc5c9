//! The reachability graph of a scenario: which moves are possible, in which posture each point is met, and what moves
//! cost.
//!
//! ```text
//! mode = cartesian   sphere of the tool, grown by clearance and spec, along straight lines        no postures
//! mode = joint       all links and the tool, along moves whose joint angles are followed          one posture a point
//! costs w(i, j)      distance, time, … of the move, a user's table, or a learned model's word    whole units
//! ```
//!
//! n points: n(n − 1) moves are looked at, and with arcs n(n − 1)(n − 2) triples. Nothing is random.

use std::sync::{Arc, OnceLock};

use nalgebra::{Isometry3, Point3};

use super::arm_graph::ArmGraph;
use super::points::DRAWS;
use super::{ArmSetup, Station};
use crate::campaign::Stop;
use crate::campaign::digits::grouped;
use crate::campaign::scenario::{ArmMode, ArmScenario, CostName, CostSection, MoveName};
use crate::feasibility::reachability::joint::{
    Bodies, Cost, FollowSettings, JointGraph, JointSettings, MoveKind, Station as Stand, arcs_until, joint, joint_until,
};
use crate::feasibility::reachability::{CartesianSettings, Level, Obstacle, Refusal, Verdict, cartesian};
use crate::robot::arm::{Branch, Configuration, Joints};

impl ArmGraph {
    /// In which configuration a point is met: the proven one; in Cartesian mode the cloud's, or one in which the arm
    /// can stand there.
    pub(super) fn configuration(&self, setup: &ArmSetup, row: usize) -> Option<Configuration> {
        let station = &setup.station;
        match &self.postures {
            Some(postures) => postures[row].as_ref().ok().map(|q| station.arm.configuration(q)),
            None => {
                let point = &station.points[row];
                let given = point.configuration.and_then(configuration);
                let near = || standing(station, &point.pose).map(|q| station.arm.configuration(&q));
                given.or_else(near)
            }
        }
    }

    /// Whether the corner at the `k`-th of `rows` may be cut by a zone of `zone` m: the triangle that a blend stays in
    /// is proven clear of the cell, grown by the tool and by what the spec allows. Joint moves stop everywhere: their
    /// blends lie in no such triangle.
    ///
    /// `k` is a place within `rows` that has one before and one after it: 1 … len − 2. The zone is cut to half of
    /// either segment.
    ///
    /// # Panics
    /// Where `k` is the first or the last place.
    pub(super) fn blends(&self, setup: &ArmSetup, rows: &[usize], k: usize, zone: f64) -> bool {
        let (station, scenario) = (&setup.station, &setup.scenario);
        if scenario.generate.moves.kind == MoveName::Joint {
            return false;
        }
        let place = |k: usize| station.points[rows[k]].pose.translation.vector;
        let corner = place(k);
        let towards = |other: usize| {
            let way = place(other) - corner;
            let length = way.norm();
            corner + way * (zone.min(0.5 * length) / length.max(f64::MIN_POSITIVE))
        };
        let clearance = scenario.generate.moves.clearance_mm * 1e-3;
        let bodies = Bodies::new(&station.arm, &station.tool, &station.cell, clearance);
        bodies.corner(&[towards(k - 1), corner, towards(k + 1)], station.tool.radius, allowed(scenario)).is_none()
    }
}

/// The deviation that the spec allows at most, m, whatever is drawn of it: moves are proven clear for whatever is
/// within spec.
pub(super) fn allowed(scenario: &ArmScenario) -> f64 {
    scenario.widest_mm().map_or(0.0, |most| most * 1e-3)
}

/// What is in `known`, or else made. Nobody waits for another thread, which might be waiting for this one's work: what
/// several make at once is the same.
///
/// Two threads may make the same at once, and one of both is thrown away: dear, but nothing can wait in a circle.
pub(super) fn once<T>(known: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    if known.get().is_none() {
        // Another's counts where there is one by now.
        known.set(make()).ok();
    }
    known.get_or_init(|| unreachable!("it was set"))
}

/// The graph of `setup`, made when it is first asked for.
///
/// # Errors
/// No point can be met, or a table of costs of another size, in a sentence's part.
pub fn graph_of(setup: &ArmSetup) -> Result<Arc<ArmGraph>, String> {
    graph_until(setup, &Stop::never())
}

/// The same, made until `stop` says so: then this setup has none, whoever asks, and one that is built anew may.
///
/// # Errors
/// As of [`graph_of`]; how much of it was looked at when it was stopped.
pub fn graph_until(setup: &ArmSetup, stop: &Stop) -> Result<Arc<ArmGraph>, String> {
    once(&setup.graph, || made(setup, stop).map(Arc::new)).clone()
}

/// Beyond a graph it asks for a way: some point met, some way out from home and some way back. Whether the two belong
/// to one path is the search's to find out.
fn made(setup: &ArmSetup, stop: &Stop) -> Result<ArmGraph, String> {
    let graph = whole_graph(setup, stop)?;
    let met = graph.postures.as_ref().is_none_or(|postures| postures.iter().any(Result::is_ok));
    let joined = graph.from_home.contains(&true) && graph.to_home.contains(&true);
    match (met, joined) {
        (false, _) => Err(format!("no point of the cloud can be met: {}", setup.first_reason(&graph))),
        (true, false) => {
            let home = setup.home_meets().into_iter().next();
            let home = home.map_or(String::new(), |meets| format!(": at home {meets}"));
            Err(format!("no move from home to a point of the cloud, or back, is possible{home}"))
        }
        (true, true) => Ok(graph),
    }
}

/// The graph of `setup`, whether or not it has a way.
///
/// # Errors
/// No point could be drawn, or a table of costs of another size, in a sentence's part.
pub(super) fn whole_graph(setup: &ArmSetup, stop: &Stop) -> Result<ArmGraph, String> {
    let (station, scenario) = (&setup.station, &setup.scenario);
    if station.points.is_empty() {
        return Err(nowhere(setup));
    }
    let cost = cost_of(setup)?;
    let learned = matches!(scenario.generate.cost, CostSection::Learned(_));
    if scenario.generate.mode == ArmMode::Cartesian && (learned || !matches!(cost, Cost::Distance | Cost::Table(_))) {
        return Err(format!("cost `{}` needs joints: mode = \"joint\"", scenario.generate.cost.word()));
    }
    match scenario.generate.mode {
        ArmMode::Cartesian => Ok(in_space(setup, &cost)),
        ArmMode::Joint => in_joints(setup, &cost, stop),
    }
}

impl ArmSetup {
    /// What the scenario's table of costs says of a move, where costs come from one.
    /// The outer `None`: they come from elsewhere; the inner one: the table has no such move.
    pub(super) fn measured_cost(&self, from: usize, to: usize) -> Option<Option<i64>> {
        let CostSection::Table(table) = &self.scenario.generate.cost else { return None };
        let matrix = self.attachments.costs(table)?;
        matrix.costs.get(from * matrix.points + to).copied()
    }

    /// Names of the cell's parts, as refusals count them.
    pub fn part_names(&self) -> Vec<String> {
        self.station.cell.parts.iter().map(|part| part.name.clone()).collect()
    }

    fn first_reason(&self, graph: &ArmGraph) -> String {
        let names = self.part_names();
        let postures = graph.postures.iter().flatten().enumerate();
        let mut refused = postures.filter_map(|(row, posture)| posture.as_ref().err().map(|refusal| (row, refusal)));
        refused.next().map_or_else(String::new, |(row, refusal)| {
            format!("{}: {}", self.point_name(row), refusal.in_words(&names))
        })
    }
}

/// Why no point could be drawn.
fn nowhere(setup: &ArmSetup) -> String {
    let scenario = &setup.scenario;
    let home = setup.home_meets().into_iter().next().map_or(String::new(), |meets| format!("; at home {meets}"));
    let clearance = scenario.generate.moves.clearance_mm;
    let beside = scenario.widest_mm().map_or(String::new(), |most| format!(" and the {most} mm of spec.path.max_mm"));
    format!(
        "no point can be drawn: of {DRAWS} places within reach the arm can stand at none, and come to it from home, with \
         generate.moves.clearance_mm = {clearance}{beside} kept from all that is in the cell{home}"
    )
}

/// The tool's sphere alone is proven along n(n − 1) segments, against the cell and the ball of reach; home can be left
/// for every point and reached from every point, which nobody looked at.
fn in_space(setup: &ArmSetup, cost: &Cost) -> ArmGraph {
    let (station, scenario) = (&setup.station, &setup.scenario);
    let points: Vec<Point3<f64>> = station.points.iter().map(|point| point.pose.translation.vector.into()).collect();
    let settings = CartesianSettings { radius: sphere(station, scenario), level: Level::Certified, simd: setup.simd };
    let ball = station.cell.parts.len();
    let reachability =
        cartesian(&points, &station.cell_within_reach(), &settings).with_reasons(|reason| match reason {
            Refusal::ToolMeets { part, undecided } if part == ball => Refusal::BeyondReach { undecided },
            other => other,
        });
    let costs = masked(reachability.matrix(), setup);
    let (unit, unit_name) = unit_of(cost, setup);
    let anywhere = vec![true; points.len()];
    ArmGraph {
        reachability,
        postures: None,
        costs,
        from_home: anywhere.clone(),
        to_home: anywhere,
        arcs: None,
        unit,
        unit_name,
    }
}

/// What stands in place of a graph that was stopped.
fn cut(looked_at: usize, all: usize, what: &str) -> String {
    let (looked_at, all) = (grouped(looked_at as u64), grouped(all as u64));
    format!("its graph was stopped after {looked_at} of {all} {what}")
}

fn in_joints(setup: &ArmSetup, cost: &Cost, stop: &Stop) -> Result<ArmGraph, String> {
    let (station, scenario) = (&setup.station, &setup.scenario);
    let stands: Vec<Stand> = (station.points.iter())
        .map(|point| Stand { pose: point.pose, configuration: point.configuration.and_then(configuration) })
        .collect();
    let (within, settings) = ((&station.arm, &station.tool, &station.cell), joint_settings(station, scenario));
    let (n, over) = (stands.len(), stop.cancelled);
    let graph = joint_until(within, &stands, &settings, cost, over);
    let graph = with_learned(setup, graph.map_err(|done| cut(done, n * (n - 1), "moves"))?);
    let arcs = || arcs_until(within, &stands, &graph.joints, (&settings, cost), over);
    let arcs = scenario.generate.moves.arcs.then(arcs).transpose();
    let arcs = arcs.map_err(|done| cut(done, n * (n - 1) * n.saturating_sub(2), "arcs"))?;
    let costs = masked(graph.graph.matrix(), setup);
    let free = |refusals: &[Option<Refusal>]| refusals.iter().map(Option::is_none).collect();
    let (from_home, to_home) = (free(&graph.from_home), free(&graph.to_home));
    let (unit, unit_name) = unit_of(cost, setup);
    let (reachability, postures) = (graph.graph, Some(graph.joints));
    Ok(ArmGraph { reachability, postures, costs, from_home, to_home, arcs, unit, unit_name })
}

/// With what a learned model expects in place of the costs, where one is asked for.
fn with_learned(setup: &ArmSetup, graph: JointGraph) -> JointGraph {
    let CostSection::Learned(learned) = &setup.scenario.generate.cost else { return graph };
    let Some(model) = setup.attachments.model(&learned.score) else { return graph };
    let JointGraph { graph: reachability, joints, .. } = graph;
    let reachability =
        reachability.with_costs("1e-6 of the model's unit", |from, to| match (&joints[from], &joints[to]) {
            (Ok(start), Ok(end)) => setup.expected(&model.read, [from, to], [start, end]),
            _ => 0,
        });
    JointGraph { graph: reachability, joints, ..graph }
}

/// The singularity margin goes in as sin of `singularity_margin_deg`; the clearance grown by what the spec allows.
pub(super) fn joint_settings(station: &Station, scenario: &ArmScenario) -> JointSettings {
    let moves = &scenario.generate.moves;
    JointSettings {
        moves: match moves.kind {
            MoveName::Linear => MoveKind::Linear,
            MoveName::Joint => MoveKind::Joint,
        },
        clearance: moves.clearance_mm * 1e-3 + allowed(scenario),
        follow: FollowSettings {
            margin: libm::sin(moves.singularity_margin_deg.to_radians()),
            ..FollowSettings::default()
        },
        home: station.home,
    }
}

/// Radius of the tool's sphere with all that it is grown by, m.
///
/// r = r_tool + clearance + what the spec allows.
fn sphere(station: &Station, scenario: &ArmScenario) -> f64 {
    station.tool.radius + scenario.generate.moves.clearance_mm * 1e-3 + allowed(scenario)
}

/// Whether the arm can stand with its tool at `pose`, as far as the scenario's mode looks.
///
/// In joint mode this is a graph of one point, moves from home and back included: as dear as that. Of an arm without a
/// closed inverse only places are taken that Newton's steps find from home: of thousands it is not searched for each.
pub(super) fn stands(station: &Station, scenario: &ArmScenario, pose: &Isometry3<f64>) -> bool {
    if !is_met_from_home(station, pose) {
        return false;
    }
    match scenario.generate.mode {
        ArmMode::Cartesian => {
            let place: Point3<f64> = pose.translation.vector.into();
            let radius = sphere(station, scenario);
            let clear = |region| matches!(Obstacle::new(region).certify(&place, &place, radius), Verdict::Clear);
            standing(station, pose).is_some() && station.cell.parts.iter().all(|part| clear(part.region.clone()))
        }
        ArmMode::Joint => {
            let stand = Stand { pose: *pose, configuration: None };
            let settings = joint_settings(station, scenario);
            let graph = joint(&station.arm, &station.tool, &station.cell, &[stand], &settings, &Cost::Distance);
            graph.joints[0].is_ok() && graph.from_home[0].is_none() && graph.to_home[0].is_none()
        }
    }
}

/// Whether home is seed enough for a posture with the tool at `pose`; where all postures are known nothing is asked.
fn is_met_from_home(station: &Station, pose: &Isometry3<f64>) -> bool {
    let (arm, flange) = (&station.arm, station.flange(pose));
    arm.has_closed_inverse()
        || (arm.chain.inverse_near(&flange, &station.home)).is_some_and(|found| !arm.turns_of(&found.joints).is_empty())
}

/// Joint angles within their bounds with the tool at `pose`, those nearest to home.
fn standing(station: &Station, pose: &Isometry3<f64>) -> Option<Joints> {
    let distance = |q: &Joints| -> f64 { q.iter().zip(&station.home).map(|(a, b)| (a - b).abs()).sum() };
    let solutions = station.arm.inverse(&station.flange(pose), &station.home).into_iter();
    let turned = solutions.flat_map(|q| station.arm.turns_of(&q));
    turned.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// cf1, cf4, cf6, cfx as a configuration, if cfx is one.
pub(super) fn configuration([cf1, cf4, cf6, cfx]: [i32; 4]) -> Option<Configuration> {
    let cfx = u8::try_from(cfx).ok().filter(|cfx| *cfx < 8)?;
    Some(Configuration { cf1, cf4, cf6, cfx: Branch::from_cfx(cfx).cfx() })
}

/// What the scenario asks to count.
///
/// A sum counts in millionths of the weights' units: ways in µm and times in µs are so already for weights of m and
/// s, the other two are multiplied by 10⁶. A table's missing entries go in as 0 and are taken out of the graph
/// afterwards (`masked`); a learned cost stands as distance until its model is asked (`with_learned`).
///
/// # Errors
/// A table of another size than the cloud, in a sentence's part.
fn cost_of(setup: &ArmSetup) -> Result<Cost, String> {
    let points = setup.station.points.len();
    match &setup.scenario.generate.cost {
        CostSection::Named(name) => Ok(by_name(*name)),
        // What a model expects takes the place of these once the graph is known.
        CostSection::Learned(_) => Ok(Cost::Distance),
        CostSection::Table(table) => {
            let matrix = setup.attachments.costs(table).ok_or_else(|| format!("`{}` was not read", table.table))?;
            if matrix.points != points {
                return Err(format!("the table of costs is for {} points, the cloud has {points}", matrix.points));
            }
            Ok(Cost::Table(matrix.costs.iter().map(|cost| cost.unwrap_or(0)).collect()))
        }
        CostSection::Weighted(weights) => {
            // Ways and times are in millionths of the weights' units, so all of the sum is.
            let terms = [
                (weights.distance, Cost::Distance),
                (weights.time, Cost::Time),
                (1e6 * weights.controller_load, Cost::ControllerLoad),
                (1e6 * weights.joint_effort, Cost::JointEffort),
            ];
            Ok(Cost::Sum(terms.into_iter().filter(|(weight, _)| *weight > 0.0).collect()))
        }
    }
}

fn by_name(name: CostName) -> Cost {
    match name {
        CostName::Distance => Cost::Distance,
        CostName::Time => Cost::Time,
        CostName::ControllerLoad => Cost::ControllerLoad,
        CostName::JointEffort => Cost::JointEffort,
    }
}

/// What one unit of a cost is, and in which unit users are told.
///
/// One factor turns whole units into what is told: micrometres into mm, microseconds into s, millionths of a model's
/// unit or of a weighted sum into that; loads and efforts are told as they are.
fn unit_of(cost: &Cost, setup: &ArmSetup) -> (f64, String) {
    let files = &setup.attachments;
    if let CostSection::Learned(learned) = &setup.scenario.generate.cost {
        return (1e-6, files.model(&learned.score).map_or_else(String::new, |model| model.read.unit.clone()));
    }
    match cost {
        Cost::Distance => (1e-3, "mm".into()),
        Cost::Time => (1e-6, "s".into()),
        Cost::ControllerLoad => (1.0, cost.unit().into()),
        // As squared torques and squared accelerations are scaled to whole numbers.
        Cost::JointEffort if setup.station.arm.has_masses() => (1.0, "effort of torques (10⁻⁶ N² m² s)".into()),
        Cost::JointEffort => (1.0, "effort of accelerations (10⁻³ rad²/s³; not all links have masses)".into()),
        Cost::Sum(_) => (1e-6, "weighted".into()),
        Cost::Table(_) => match &setup.scenario.generate.cost {
            CostSection::Table(table) => {
                (files.costs(table).map_or(1.0, |matrix| matrix.unit), "the table's unit".into())
            }
            _ => (1.0, String::new()),
        },
    }
}

/// The costs of a graph's moves as a table has them, and without those that it leaves out.
///
/// A move is there only where it is possible and the table has it; its cost is then the table's. n² entries, row =
/// from.
fn masked(costs: Vec<Option<i64>>, setup: &ArmSetup) -> Vec<Option<i64>> {
    let CostSection::Table(table) = &setup.scenario.generate.cost else { return costs };
    let Some(matrix) = setup.attachments.costs(table) else { return costs };
    costs.into_iter().zip(&matrix.costs).map(|(cost, given)| cost.and(*given)).collect()
}
