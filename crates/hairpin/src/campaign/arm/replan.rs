//! Fewer points for a program, every move still proven by the graph.

use std::sync::Arc;

use nalgebra::Point3;

use super::ArmSetup;
use super::arm_graph::ArmGraph;
use super::graph::graph_of;
use crate::campaign::Case;
use crate::campaign::kind::{Replanner, Same};
use crate::trajectory::program::{Motion, Program, Zone};

/// A program, and the graph that it is a way through.
///
/// A subset of the waypoints is a program again where every move between neighbours of the subset is one of the
/// graph's: no search, O(points) a trial. Speeds stay, so what is shortened is the same program with points left out.
///
/// ```text
/// rows r_1 … r_m of the kept waypoints:  possible ⇔ w(r_k, r_(k+1)) in the graph for all k, home → r_1, r_m → home
/// score = Σ w(r_k, r_(k+1)) · unit
/// ```
pub(super) struct Shortened {
    graph: Arc<ArmGraph>,
    case: Case,
    program: Program,
    /// Row of the cloud at every waypoint but the home at both ends.
    rows: Vec<usize>,
}

impl Shortened {
    /// # Errors
    /// A case whose program is no way from home through the scenario's cloud and back, in a sentence's part.
    pub(super) fn new(setup: &ArmSetup, case: &Case) -> Result<Self, String> {
        let program = case.program().cloned().ok_or("the case has no program")?;
        let graph = graph_of(setup)?;
        let between = program.moves.get(1..program.moves.len().saturating_sub(1)).unwrap_or_default();
        let row = |name: &str| (0..graph.points()).find(|row| setup.point_name(*row) == name);
        let rows: Option<Vec<usize>> = between.iter().map(|m| row(m.motion.name()?)).collect();
        let rows = rows.ok_or("a move of the program leads to no point of the cloud")?;
        if rows.len() + 2 != case.waypoints.len() {
            return Err("the program has other points than the case".into());
        }
        Ok(Self { graph, case: case.clone(), program, rows })
    }
}

impl Replanner for Shortened {
    /// Home at both ends is included. Every move keeps its speed, and its zone where the corner may still be cut.
    fn plan(&self, setup: Same, indices: &[usize], _: &[Point3<f64>]) -> Option<Case> {
        let setup: &ArmSetup = setup.setup();
        let between = indices.get(1..indices.len().checked_sub(1)?)?;
        let rows: Vec<usize> = between.iter().map(|index| self.rows[index - 1]).collect();
        let (first, last) = (*rows.first()?, *rows.last()?);
        let possible = |from: usize, to: usize| self.graph.costs[from * self.graph.points() + to];
        let costs: Vec<i64> = rows.windows(2).map(|pair| possible(pair[0], pair[1])).collect::<Option<_>>()?;
        if !self.graph.from_home[first] || !self.graph.to_home[last] {
            return None;
        }
        let mut program = self.program.clone();
        program.moves = indices.iter().map(|index| self.program.moves[*index].clone()).collect();
        for k in 0..rows.len() {
            let zone = &program.moves[k + 1].zone;
            let cut = !zone.fine && k > 0 && k + 1 < rows.len() && self.graph.blends(setup, &rows, k, zone.tcp);
            if !cut {
                program.moves[k + 1].zone = Zone::stop();
            }
        }
        // Arcs are proven between the points that they had; the graph knows the straight way.
        for one in &mut program.moves {
            if let Motion::Circular { to, .. } = &one.motion {
                one.motion = Motion::Linear(to.clone());
            }
        }
        // The way from home is proven in joints.
        if let Motion::Linear(to) = &program.moves[1].motion {
            program.moves[1].motion = Motion::Joint(to.clone());
        }
        let leg_times = setup.leg_times(&program);
        Some(Case {
            waypoints: indices.iter().map(|index| self.case.waypoints[*index]).collect(),
            leg_times,
            score: costs.iter().sum::<i64>() as f64 * self.graph.unit,
            bound: None,
            witness: Some(program.into()),
            ..self.case.clone()
        })
    }
}
