//! The reach set: end points of 625 runs of 1 s, their error, and their hull.

use hairpin::feasibility::reach::{Hull, HullSettings, Polytope, sampling};
use hairpin::math::simd::Simd;
use hairpin_formats::library;
use hairpin_jobs::Problem;

use super::flyer::robot;
use super::row::Row;
use crate::clock::median_time;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::at_most("reach-625-runs", "ms", 0.6, |_| end_points()),
        Row::at_most("reach-error-worst-robot", "mm", 5.0, |_| error()),
        Row::at_most("reach-hull", "µs", 60.0, |_| hull()),
    ]
}

fn end_points() -> Result<f64, Problem> {
    let robot = robot("flightgoggles")?;
    let speeds = sampling::constant_speeds(&robot, 5);
    let steps = sampling::steps(&robot, 1.0);
    Ok(1e3 * median_time(9, || sampling::end_points(Simd::default(), &robot, &speeds, 1.0, steps)))
}

fn hull() -> Result<f64, Problem> {
    let hull = Hull::new(&robot("flightgoggles")?, &HullSettings::default()).map_err(Problem::input)?;
    // Many at once: asking the clock costs as much as one.
    let many = || (0..100).filter(|_| Polytope::hull(Simd::default(), hull.samples()).is_ok()).count();
    Ok(1e6 / 100.0 * median_time(9, many))
}

/// Largest distance of an end point from that of a tenth of the step, over all shipped quadrotors.
fn error() -> Result<f64, Problem> {
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
