//! What the search saw of the moves of a program, and what a learned model expects of those of a graph.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use nalgebra::Isometry3;

use super::ArmSetup;
use crate::campaign::learn::{MoveFeatures, ScoreModel};
use crate::robot::arm::{Configuration, Joints};
use crate::simulation::arm::{Order, Target};
use crate::trajectory::program::Speed;

/// Angles so near (rad) to a border of quadrants are on both sides of it.
const BORDER: f64 = 1e-6;

impl ArmSetup {
    /// The features of move number `index` of a program; `None` of those from and to home, on arcs, and between points
    /// of unknown posture.
    ///
    /// Number 0 leads from home to the first point.
    pub(super) fn seen_of(&self, orders: &[Order], index: usize) -> Option<MoveFeatures> {
        let (before, order) = (orders.get(index.checked_sub(1)?)?, &orders[index]);
        let ((start, from), (end, to)) = (self.stand(before)?, self.stand(order)?);
        match order.target {
            Target::Joint(..) | Target::Line(..) => {
                Some(MoveFeatures::of(&self.station.arm, [&start, &end], &from, &to, order.speed.tcp))
            }
            Target::Joints(_) | Target::Arc(..) => None,
        }
    }

    /// Pose and angles at the end of a move to a point.
    fn stand(&self, order: &Order) -> Option<(Isometry3<f64>, Joints)> {
        let (pose, configuration) = match &order.target {
            Target::Joint(pose, configuration) | Target::Line(pose, configuration) => (pose, configuration),
            Target::Arc(_, pose, configuration) => (pose, configuration),
            Target::Joints(_) => return None,
        };
        Some((*pose, self.posture(pose, configuration.as_ref()?)?))
    }

    /// Angles with the tool at `pose` in a configuration.
    ///
    /// Those nearest to home by Σ |q_k − home_k|, among all turns of all axes within the bounds, as the graph's are: a
    /// configuration does not tell the turns of axes 2, 3 and 5. `None` where the arm cannot stand so. For arms without
    /// a closed inverse the search begins at home.
    pub(super) fn posture(&self, pose: &Isometry3<f64>, wanted: &Configuration) -> Option<Joints> {
        let (station, flange) = (&self.station, self.station.flange(pose));
        let turned = station.arm.inverse(&flange, &station.home).into_iter().flat_map(|q| station.arm.turns_of(&q));
        // An angle on the border of two quadrants is in both: rounding decides which it is said to be in.
        let within =
            |angle: f64, quadrant: i32| (angle - (f64::from(quadrant) + 0.5) * FRAC_PI_2).abs() <= FRAC_PI_4 + BORDER;
        let fitting = turned.filter(|q| {
            let quadrants = within(q[0], wanted.cf1) && within(q[3], wanted.cf4) && within(q[5], wanted.cf6);
            quadrants && station.arm.configuration(q).cfx == wanted.cfx
        });
        let distance = |q: &Joints| -> f64 { q.iter().zip(&station.home).map(|(a, b)| (a - b).abs()).sum() };
        fitting.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// What `model` expects of the move from row to row with these angles at both ends, in millionths of its unit: the
    /// mean over the scenario's speeds, of which one is drawn later; at least 0. Not what it expects at their mean, a
    /// speed that nothing was executed at.
    ///
    /// round(min(10⁶ · mean over speeds v of f(x(v)), 10¹⁵)), f the model and x the move's features.
    pub(super) fn expected(&self, model: &ScoreModel, [from, to]: [usize; 2], angles: [&Joints; 2]) -> i64 {
        let place = |row: usize| &self.station.points[row].pose;
        let speeds = &self.scenario.generate.moves.speeds;
        let at = |speed| MoveFeatures::of(&self.station.arm, [place(from), place(to)], angles[0], angles[1], speed);
        let named = speeds.iter().filter_map(|name| Speed::predefined(name));
        let sum: f64 = named.map(|speed| model.expected_of_move(&at(MoveFeatures::speed_of(speed.tcp)))).sum();
        let mean = sum / speeds.len().max(1) as f64;
        // Whole numbers without limit are no costs; nothing that is measured of a move is as large.
        (1e6 * mean).clamp(0.0, 1e15).round() as i64
    }
}
