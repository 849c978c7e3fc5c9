//! A controller of one's own on our plant, stressed beside one of ours: `cargo run --example 02_own_controller`.

use std::error::Error;

use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, OwnSimulator, Setup, Stop, execute_run, generate, judge};
use hairpin::robot::quadrotor::Quadrotor;
use hairpin::simulation::{Controller, Fault, FlightCommand, FlightState, OwnController, Reference};
use hairpin_formats::scenario::setup_for;

/// A spring to the next waypoint, which pulls no harder than what 4 m/s balance, and a damper.
struct Pd(f64, f64);

impl Controller<Quadrotor> for Pd {
    fn control(&mut self, _dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let Pd(stiffness, damping) = *self;
        let pull = ((to.target() - now.position) * stiffness).cap_magnitude(4.0 * damping);
        Ok(FlightCommand::Acceleration(pull - now.velocity * damping))
    }
}

fn worst(setup: &Setup, cases: &[Case]) -> Result<f64, Box<dyn Error>> {
    cases.iter().try_fold(0.0, |worst, case| {
        let result = judge(setup, case, &[execute_run(setup, case, 0)])?;
        Ok(result.measures.ok_or(result.message.unwrap_or_default())?.max_deviation.max(worst))
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let ours = setup_for("demo-quadrotor", &[("generate.search.cases".into(), "5".into())])?;
    let own = ours.clone().with_controller(OwnController::new("pd", |_: &Quadrotor| Pd(2.0, 2.5)))?;
    let stop = Stop { cancelled: &|| false, progress: &|_, _| {}, clock: &|| 0.0 };
    let mut cases = Vec::new();
    generate(&ours, &Known::default(), &OwnSimulator, &stop, &mut |found, _| cases.extend_from_slice(found));
    for setup in [&own, &ours] {
        let name = setup.controller().unwrap_or("nobody");
        println!("{name}: worst deviation {:.2} m on {} trajectories", worst(setup, &cases)?, cases.len());
    }
    Ok(())
}
