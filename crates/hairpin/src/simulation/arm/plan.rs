//! What the controller intends: path, time law, and what it costs to compute.

use super::clock::Law;
use super::follow::{Follower, Stop};
use super::grid::Section;
use super::order::Order;
use super::path::lay;
use super::settings::PlanSettings;
use crate::robot::arm::{Arm, Joints};
use crate::simulation::SimulationError;

/// A section with its law and when it begins.
#[derive(Debug)]
pub(super) struct Timed {
    /// Where.
    pub(super) section: Section,
    /// How fast, since `begin`.
    pub(super) law: Law,
    /// When the arm sets out, s.
    pub(super) begin: f64,
}

/// What a controller computes for a move; the same on every machine.
///
/// Counts, so that a cost made of them (`controller-load`) is the same on every machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Load {
    /// Set points of its servos.
    pub interpolation_steps: u64,
    /// Inverse kinematics iterations.
    pub inverse_iterations: u64,
}

impl Load {
    /// Both together: the cost `controller-load`.
    pub fn total(&self) -> u64 {
        self.interpolation_steps + self.inverse_iterations
    }
}

/// A program's path and time law.
///
/// Borrowed orders, owned path: executing it again with other faults or seeds costs no planning.
#[derive(Debug)]
pub struct Plan<'a> {
    pub(super) arm: &'a Arm,
    pub(super) orders: &'a [Order],
    pub(super) timed: Vec<Timed>,
    pub(super) settings: PlanSettings,
    start: Joints,
    stop: Option<Stop>,
    iterations: Vec<u64>,
    passed: Vec<f64>,
}

impl<'a> Plan<'a> {
    /// The plan of `orders` for an arm that stands at `start`, rad. Where it cannot be followed it ends at
    /// [`Plan::stop`].
    ///
    /// Path first, law second: the law of a section knows nothing of the others, as the arm stands between them.
    ///
    /// # Errors
    /// Settings or orders out of their bounds; no order; a start outside the joints' bounds.
    pub fn new(
        arm: &'a Arm,
        start: &Joints,
        orders: &'a [Order],
        settings: &PlanSettings,
    ) -> Result<Self, SimulationError> {
        settings.check()?;
        if orders.is_empty() {
            return Err(SimulationError::new("orders", "none".into(), "at least one move"));
        }
        orders.iter().try_for_each(Order::check)?;
        if let Some((axis, _)) = arm.outside_limits(start) {
            let angle = format!("axis {} at {:.1}°", axis + 1, start[axis].to_degrees());
            return Err(SimulationError::new("start", angle, "within the joint's bounds"));
        }
        let path = lay(Follower { arm, settings, iterations: 0 }, start, orders);
        let (mut timed, mut clock) = (Vec::with_capacity(path.sections.len()), 0.0);
        let mut passed = Vec::with_capacity(orders.len());
        for section in path.sections {
            let law = Law::of(&section, &arm.limits, settings);
            passed.extend(section.marks.iter().map(|(_, node)| clock + law.when(section.s[*node])));
            let begin = clock;
            clock += law.duration() + if section.spans.is_empty() { 0.0 } else { settings.settle };
            timed.push(Timed { section, law, begin });
        }
        let still = timed.last().map_or(0.0, |last| last.begin + last.law.duration());
        let stop = path.stop.map(|stop| Stop { time: still, ..stop });
        Ok(Self { arm, orders, timed, settings: *settings, start: *start, stop, iterations: path.iterations, passed })
    }

    /// Where the program ends before its end, and why.
    pub fn stop(&self) -> Option<&Stop> {
        self.stop.as_ref()
    }

    /// When each move's target is passed, s: of a blended one the middle of its blend. Moves after a stop are missing.
    ///
    /// Rising; one entry a move.
    pub fn passed(&self) -> &[f64] {
        &self.passed
    }

    /// Until the arm stands still at the end, s.
    pub fn duration(&self) -> f64 {
        self.timed.last().map_or(0.0, |last| last.begin + last.law.duration())
    }

    /// The work of each move that was passed, with a set point every `interpolation` s.
    ///
    /// Steps are ⌈(t_k − t_(k−1))/interpolation⌉, t_k being when move k passes its target; iterations are those that
    /// laying its path took, looks ahead included. `interpolation` in s, above 0.
    pub fn load(&self, interpolation: f64) -> Vec<Load> {
        let mut before = 0.0;
        let steps = self.passed.iter().map(|time| {
            let steps = ((time - before) / interpolation).ceil().max(0.0) as u64;
            before = *time;
            steps
        });
        let both = steps.zip(&self.iterations);
        both.map(|(steps, inverse)| Load { interpolation_steps: steps, inverse_iterations: *inverse }).collect()
    }

    /// Joint angles at the start, rad.
    pub(super) fn start(&self) -> &Joints {
        &self.start
    }
}
