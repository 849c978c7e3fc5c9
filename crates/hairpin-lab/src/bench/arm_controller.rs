//! The virtual controller: seconds of an arm's program per second, from its moves to the recording.

use hairpin::robot::arm::Arm;
use hairpin::simulation::arm::{Noise, Order, Plan, PlanSettings, RunSettings, Shape, Speed, Target, Zone};
use hairpin_formats::scenario::arm_for;
use hairpin_jobs::Problem;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use super::row::Row;
use crate::clock::median_time;

/// Moves of the program.
const MOVES: usize = 48;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::at_least("arm-controller", "× real time", 2000.0, |_| run(Shape::Trapezoid)),
        Row::at_least("arm-controller-s-curve", "× real time", 2000.0, |_| run(Shape::SCurve(0.04))),
    ]
}

/// Straight moves at three speeds, every other one blended, all planned and executed with noise.
fn run(shape: Shape) -> Result<f64, Problem> {
    let arm = arm_for("irb120")?;
    let start = [0.0, 0.2, 0.3, 0.0, 1.0, 0.0];
    let orders = program(&arm, &start);
    let planned = PlanSettings { shape, ..PlanSettings::default() };
    let noise = Noise { position: 1e-5, orientation: 1e-4, joints: 1e-5, pause: 0.002 };
    let settings = RunSettings { noise, ..RunSettings::default() };
    let plan = || Plan::new(&arm, &start, &orders, &planned).map_err(Problem::input);
    let first = plan()?;
    if let Some(stop) = first.stop() {
        return Err(Problem::input(format!("the bench's move {} stops: {}", stop.order, stop.reason)));
    }
    first.execute(&settings, &[], 1).map_err(Problem::input)?;
    let once = || plan().map(|plan| plan.execute(&settings, &[], 1).map(|run| run.recording.len()));
    Ok(first.duration() / median_time(9, once))
}

fn program(arm: &Arm, start: &[f64; 6]) -> Vec<Order> {
    let from = arm.forward(start);
    let wave = |i: usize, every: f64| (i as f64 * every).sin();
    let order = |i: usize| {
        let shift = Translation3::new(0.05 * wave(i, 2.1), 0.15 * wave(i, 1.3), 0.05 * wave(i, 0.7) - 0.05);
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(1.0, 0.0, 0.0, 0.1 * wave(i, 0.9)));
        let to = Isometry3::from_parts(shift * from.translation, turn * from.rotation);
        Order {
            name: i.to_string(),
            target: Target::Line(to, None),
            speed: Speed { tcp: [0.2, 1.0, f64::INFINITY][i % 3], turn: 8.0 },
            duration: None,
            zone: if i.is_multiple_of(2) { Zone::Fine } else { Zone::Radius(0.01) },
            tool: Isometry3::identity(),
        }
    };
    (1..=MOVES).map(order).collect()
}
