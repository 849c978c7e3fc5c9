//! Hands the written witnesses to the verification room.
//!
//! Verification shares no code with what made the claim; this file only says with which scenario a case was searched.

use super::kind::{PlannedRows, Verified};
use super::{Case, Setup, vary};
use crate::verification::Finding;

/// Integrates the witness of `case` by independent code, to the default tolerances of flights and the scenario's of
/// drives.
///
/// Deterministic, and independent of any execution. A case without a witness gives no proof; that is no failure.
pub fn verify(setup: &Setup, case: &Case) -> Verified {
    let drawn = case.environment.as_ref().and_then(|_| {
        // Bounds that vary are those that the case was searched with; draws that do not fit, as another scenario's,
        // bound nothing.
        vary::apply(&setup.scenario, &vary::draw_for_case(&setup.scenario, case.seed, case.number)).ok()
    });
    let (proof, with_lag) = setup.kind().verify(case, drawn.as_ref().unwrap_or(&setup.scenario));
    Verified { case: case.number, proof, with_lag }
}

/// What does not hold of the rows that are kept of the planned motion of `case`, whose witness holds ([`verify`]): of
/// each quantity that is off the row that is off the most. Nothing for a case without a witness.
pub fn verify_planned(setup: &Setup, case: &Case, kept: &PlannedRows) -> Vec<Finding> {
    setup.kind().verify_planned(case, kept)
}
