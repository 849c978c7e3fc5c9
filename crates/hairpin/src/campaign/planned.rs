//! The planned motion of a case, as a track and as a timed reference.

use thiserror::Error;

use super::setup::Kind;
use super::{Case, Setup, Timed, arm, drive, flight};
use crate::simulation::SimulationError;
use crate::trajectory::{Track, TrackError};

/// Rate of the timed reference that executors get, Hz: of flights, and of drives, which are slow.
const REFERENCE_RATES: (f64, f64) = (50.0, 2.0);

/// Why a case has no planned motion.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlanError {
    /// Its numbers are no track.
    #[error(transparent)]
    Track(#[from] TrackError),
    /// The ground does not carry its commands.
    #[error("{0}")]
    Drive(#[from] SimulationError),
}

/// The planned motion with the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`: of flights at 100 Hz, of drives step by
/// step of its prediction on the ground.
///
/// # Errors
/// A case whose numbers are no track, as a folder that was edited may hold.
pub fn planned(setup: &Setup, case: &Case) -> Result<Track, PlanError> {
    match setup.kind() {
        Kind::Flight(setup) => Ok(flight::track(setup.robot, case)?),
        Kind::Drive(setup) => drive::track(&setup, case),
        Kind::Arm(setup) => arm::track(&setup, case),
    }
}

/// The timed reference of a mission; empty for a case without leg times.
pub(super) fn timed(setup: &Setup, case: &Case) -> Vec<Timed> {
    if case.leg_times.is_empty() {
        return Vec::new();
    }
    match setup.kind() {
        Kind::Flight(_) => flight::timed(case, REFERENCE_RATES.0),
        Kind::Drive(setup) => drive::timed(&setup, case, REFERENCE_RATES.1),
        // Arms get their program instead.
        Kind::Arm(_) => Vec::new(),
    }
}
