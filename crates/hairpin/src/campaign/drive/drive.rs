//! Drives a mission in our own simulator.

use super::DriveSetup;
use crate::campaign::{Case, Mission};
use crate::simulation::SimulationError;
use crate::trajectory::Flight;

pub(in crate::campaign) fn drive(
    _n: &DriveSetup,
    _s: &DriveSetup,
    _m: &Mission,
    _c: &Case,
) -> Result<Flight, SimulationError> {
    unimplemented!()
}
