//! Hands an arm, its cell and a program to the verification room, as plain numbers.
//!
//! Poses in the base frame, m; angles in rad. Nothing of `feasibility` is called: frames, inverse kinematics and
//! distances are those of [`crate::verification`].

use nalgebra::{Isometry3, Point3};

use rayon::prelude::*;

use super::ArmSetup;
use super::arm_graph::ArmGraph;
use super::graph::allowed;
use super::written::{build_of, joints_of, moves_of};
use crate::campaign::scenario::MoveName;
use crate::campaign::{Case, Evidence};
use crate::robot::arm::{AXES, Configuration, Joints, Kinematics};
use crate::trajectory::program::Program;
use crate::verification::{
    ArmBodyClaim, ArmClaim, ArmMoveFinding, ArmProgramClaim, ArmProgramReplay, ArmSolidClaim, ArmSolidForm, ArmWay,
    ArmWayClaim, verify_arm_graph, verify_arm_program,
};
use crate::world::cell::{Region, Words};
use crate::world::{Shape, Solid};

/// Whether words hold at a point.
type Holds = Box<dyn Fn(&Point3<f64>) -> bool>;

/// Moves that are followed together.
const SHARE: usize = 32;

/// What following a graph's moves again came to.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct GraphAgain {
    /// Moves followed.
    pub moves: usize,
    /// What does not hold.
    pub findings: Vec<String>,
}

impl ArmSetup {
    /// Follows `program`, which must be one that a controller executes, by code of its own: frames, postures, bounds,
    /// targets, corners that are cut, and, where all links are claimed to be clear, the distance that links and tool
    /// keep from the cell.
    pub(super) fn followed_again(&self, case: &Case, program: &Program) -> ArmProgramReplay {
        // The angles at the end of a move in joints are claimed of arms alone of which a configuration does not tell
        // them.
        let told = |pose: &Isometry3<f64>, wanted: &Configuration| match self.station.arm.kinematics {
            Kinematics::Opw(_) => None,
            Kinematics::Chain => self.posture(pose, wanted),
        };
        let moves = moves_of(program, told);
        let claim = ArmProgramClaim {
            start: self.station.home,
            moves: &moves,
            waypoints: &case.waypoints,
            singularity: self.plan_settings().singularity,
            clear: case.evidence == Evidence::ClearAllLinks,
        };
        self.claimed(|arm| verify_arm_program(arm, &claim))
    }

    /// Follows every move that `graph` has, between points, from home and back, by code of its own; what does not hold,
    /// in words. In Cartesian mode, which knows no joints, there is nothing to follow.
    ///
    /// The n(n − 1) + 2n moves at most that the graph says are possible, 32 a thread. Moves that are refused
    /// are not looked at: a graph that lost one is still right of all that it has.
    pub fn graph_again(&self, graph: &ArmGraph) -> GraphAgain {
        let Some(postures) = &graph.postures else { return GraphAgain::default() };
        let (n, home) = (graph.points(), self.station.home);
        let known: Vec<usize> = (0..n).filter(|row| postures[*row].is_ok()).collect();
        let place = |row: usize| known.binary_search(&row).ok();
        let angles: Vec<Joints> = known.iter().filter_map(|row| postures[*row].as_ref().ok().copied()).collect();
        let poses: Vec<Isometry3<f64>> = known.iter().map(|row| self.station.points[*row].pose).collect();
        let kind = match self.scenario.generate.moves.kind {
            MoveName::Linear => ArmWay::Straight,
            MoveName::Joint => ArmWay::Joints,
        };
        let pairs = (0..n).flat_map(|from| (0..n).map(move |to| (from, to)));
        let free = pairs.filter(|(from, to)| from != to && graph.reachability.refusal(*from, *to).is_none());
        let between = free.filter_map(|(from, to)| Some(ArmWayClaim { from: place(from)?, to: place(to)?, way: kind }));
        let arcs = graph.arcs.iter().flat_map(|arcs| &arcs.free).filter_map(|([from, via, to], _)| {
            Some(ArmWayClaim { from: place(*from)?, to: place(*to)?, way: ArmWay::Through(place(*via)?) })
        });
        let home_is = known.len();
        let from_home = (0..n).filter(|row| graph.from_home[*row]).filter_map(place);
        let from_home = from_home.map(|to| ArmWayClaim { from: home_is, to, way: ArmWay::Joints });
        let to_home = (0..n).filter(|row| graph.to_home[*row]).filter_map(place);
        let to_home = to_home.map(|from| ArmWayClaim { from, to: home_is, way: ArmWay::Joints });
        let moves: Vec<ArmWayClaim> = between.chain(arcs).chain(from_home).chain(to_home).collect();
        let with_home = [&angles[..], &[home]].concat();
        let at_home = [&poses[..], &[self.station.tool_at(&home)]].concat();
        let name = |place: usize| known.get(place).map_or("home".into(), |row| self.point_name(*row));
        let told = |part: &[ArmWayClaim], finding: ArmMoveFinding| {
            let ArmWayClaim { from, to, way } = part[finding.index];
            let via = if let ArmWay::Through(via) = way { format!("{}→", name(via)) } else { String::new() };
            format!("{}→{via}{}: {} at {:.0} % of the move", name(from), name(to), finding.what, 100.0 * finding.at)
        };
        let look = |part: &[ArmWayClaim]| -> Vec<String> {
            let found = self.claimed(|claim| verify_arm_graph(claim, &with_home, &at_home, part));
            found.into_iter().map(|finding| told(part, finding)).collect()
        };
        let findings: Vec<Vec<String>> = moves.par_chunks(SHARE).map(look).collect();
        GraphAgain { moves: moves.len(), findings: findings.concat() }
    }

    /// Hands arm, tool and cell to `look`.
    ///
    /// What `look` gets, base frame and SI: six joints with their bounds; one body for each capsule (two points) and
    /// hull (all its points) of links 1 … 6, in the link's own frame, each a convex set of points grown by a radius;
    /// the tool as a capsule of link 6 from the flange to its point; the cell's solids. The base (link 0) is left out,
    /// since it does not move. The clearance is the scenario's plus the deviation that the spec allows.
    fn claimed<T>(&self, look: impl FnOnce(&ArmClaim) -> T) -> T {
        let station = &self.station;
        let chain = &station.arm.chain;
        let joints = joints_of(&station.arm);
        let mut bodies: Vec<ArmBodyClaim> = Vec::new();
        let mut add = |link: usize, points: Vec<Point3<f64>>, radius: f64, tool: bool| {
            let name = if tool { "the tool".into() } else { format!("link {link}") };
            bodies.push(ArmBodyClaim { link, name, tool, points, radius });
        };
        for (link, body) in station.arm.links.iter().enumerate().skip(1) {
            body.capsules.iter().for_each(|capsule| add(link, vec![capsule.a, capsule.b], capsule.radius, false));
            body.hulls.iter().for_each(|hull| add(link, hull.points.clone(), hull.radius, false));
        }
        let in_link = |p: Point3<f64>| chain.flange * p;
        let tip: Point3<f64> = station.tool.tcp.translation.vector.into();
        add(AXES, vec![in_link(Point3::origin()), in_link(tip)], station.tool.radius, true);
        // Words are not grown: they are held against the tool's line itself.
        let words: Vec<Option<Holds>> = station.cell.parts.iter().map(|part| within(&part.region)).collect();
        let parts = station.cell.parts.iter().zip(&words);
        let solids: Vec<ArmSolidClaim> = parts
            .filter_map(|(part, words)| {
                let form = match words {
                    Some(words) => ArmSolidForm::Where(words.as_ref()),
                    None => form_of(&part.region)?,
                };
                Some(ArmSolidClaim { name: &part.name, tool_only: words.is_some(), form })
            })
            .collect();
        look(&ArmClaim {
            joints: &joints,
            build: build_of(&station.arm),
            flange: chain.flange,
            tool: station.tool.tcp,
            bodies: &bodies,
            solids: &solids,
            clearance: self.scenario.generate.moves.clearance_mm * 1e-3 + allowed(&self.scenario),
        })
    }
}

/// Of words where they hold.
fn within(region: &Region) -> Option<Holds> {
    let Region::Words(words) = region else { return None };
    let words: Words = words.clone();
    Some(Box::new(move |p: &Point3<f64>| words.holds([p.x, p.y, p.z])))
}

/// The plain numbers of a region; words have none, and what is beyond a sphere is no part of a cell.
fn form_of(region: &Region) -> Option<ArmSolidForm<'static>> {
    let triangles = |solid: &Solid| {
        let vertices = solid.vertices();
        let corners = solid.triangles().iter().map(|triangle| triangle.map(|vertex| vertices[vertex as usize]));
        ArmSolidForm::Triangles(corners.collect())
    };
    Some(match region {
        Region::Shape(Shape::Sphere { center, radius }) => ArmSolidForm::Ball(*center, *radius),
        Region::Shape(Shape::Box { center, half_extents }) => ArmSolidForm::Box(*center, *half_extents),
        Region::Shape(Shape::Capsule { a, b, radius }) => ArmSolidForm::Capsule([*a, *b], *radius),
        Region::Shape(Shape::Hull(solid) | Shape::Mesh(solid)) => triangles(solid),
        Region::Cylinder { a, b, radius } => ArmSolidForm::Cylinder([*a, *b], *radius),
        Region::HalfSpace { normal, offset } => ArmSolidForm::HalfSpace(*normal, *offset),
        Region::Beyond { .. } | Region::Words(_) => return None,
    })
}
