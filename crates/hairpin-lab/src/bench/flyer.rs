//! The shipped quadrotors that benches fly.

use hairpin::campaign::Setup;
use hairpin::campaign::flight::FlightSetup;
use hairpin::robot::quadrotor::Quadrotor;
use hairpin_formats::scenario::setup_for;
use hairpin_jobs::Problem;

/// The shipped quadrotor called `name`.
pub(super) fn robot(name: &str) -> Result<Quadrotor, Problem> {
    Ok(flyer(&setup_for(name, &[])?)?.robot.as_ref().clone())
}

/// The part of `setup` that flights have.
pub(super) fn flyer(setup: &Setup) -> Result<&FlightSetup, Problem> {
    setup.own::<FlightSetup>().ok_or_else(|| Problem::input(format!("`{}` does not fly", setup.robot_name())))
}
