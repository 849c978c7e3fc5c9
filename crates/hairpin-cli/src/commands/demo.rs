//! `hairpin demo`: a small campaign that needs nothing but the binary.

use std::path::Path;

use hairpin_formats::scenario::setup_for;

use super::{new, stress};
use crate::args::{Demo, Kind};
use crate::folder::{self, Work};
use crate::interrupt::Deadline;
use crate::problem::Problem;

/// Runs the command.
pub(crate) fn run(demo: &Demo) -> Result<u8, Problem> {
    let scenario = match demo.kind {
        Kind::Quadrotor => "demo-quadrotor",
        Kind::Rover => "demo-rover",
        Kind::Car | Kind::DifferentialDrive => {
            return Err(Problem::input(format!(
                "{0} has no demo of its own: hairpin stress {0}",
                new::word(demo.kind)
            )));
        }
        Kind::Arm => "demo-arm",
    };
    folder::take_threads(&demo.threads);
    let setup = setup_for(scenario, &[])?.with_simd(folder::simd(&demo.kernels));
    let replaceable = demo.force || demo.out == Path::new("hairpin-demo");
    let work = Work { folder: folder::make(&demo.out, &setup, false, replaceable)?, setup };
    stress::campaign(&work, Deadline::after(None), &[], demo.json)
}
