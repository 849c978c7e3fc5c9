//! Drives a mission in our own simulator.

use super::DriveSetup;
use crate::campaign::Mission;
use crate::simulation::SimulationError;
use crate::trajectory::Flight;
