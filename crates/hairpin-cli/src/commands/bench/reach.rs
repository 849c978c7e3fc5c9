//! The reach set: end points of 625 runs of 1 s, their error, and their hull.

use hairpin::feasibility::reach::{Hull, HullSettings, Polytope, sampling};
use hairpin::math::simd::Simd;
use hairpin_formats::library;

use super::clock::median_time;
use super::{Row, Target, robot};
use crate::args::Bench;
use crate::problem::Problem;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row { name: "reach-625-runs", unit: "ms", target: Some(Target::AtMost(0.6)), measure: end_points },
        Row { name: "reach-error-worst-robot", unit: "mm", target: Some(Target::AtMost(5.0)), measure: error },
        Row { name: "reach-hull", unit: "µs", target: Some(Target::AtMost(60.0)), measure: hull },
    ]
}

fn end_points(_: &Bench) -> Result<f64, Problem> {
    let robot = robot("flightgoggles")?;
    let speeds = sampling::constant_speeds(&robot, 5);
    let steps = sampling::steps(&robot, 1.0);
    Ok(1e3 * median_time(9, || sampling::end_points(Simd::default(), &robot, &speeds, 1.0, steps)))
}

fn hull(_: &Bench) -> Result<f64, Problem> {
    let hull = Hull::new(&robot("flightgoggles")?, &HullSettings::default()).map_err(Problem::input)?;
    // Many at once: asking the clock costs as much as one.
    let many = || (0..100).filter(|_| Polytope::hull(Simd::default(), hull.samples()).is_ok()).count();
    Ok(1e6 / 100.0 * median_time(9, many))
}

/// Largest distance of an end point from that of a tenth of the step, over all shipped quadrotors.
fn error(_: &Bench) -> Result<f64, Problem> {
    let mut worst: f64 = 0.0;
    for shipped in library::quadrotors() {
        let robot = robot(shipped.name)?;
        let speeds = sampling::constant_speeds(&robot, 5);
        let steps = sampling::steps(&robot, 1.0);
        let coarse = sampling::end_points(Simd::default(), &robot, &speeds, 1.0, steps);
        let fine = sampling::end_points(Simd::default(), &robot, &speeds, 1.0, 10 * steps);
        worst = coarse.iter().zip(&fine).map(|(a, b)| (a - b).norm()).fold(worst, f64::max);
    }
    Ok(1e3 * worst)
}
