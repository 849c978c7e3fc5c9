//! Hands the written witnesses to the verification room.
//!
//! Verification shares no code with what made the claim; this file only says with which scenario a case was searched.

use super::kind::{Made, PlannedRows, Verified};
use super::{Case, Setup, vary};
use crate::verification::{EndError, Finding, Proof};

/// Integrates the witness of `case`, which was searched for, by independent code, to the default tolerances of flights
/// and the scenario's of drives.
///
/// Deterministic, and independent of any execution. A case without a witness gives no proof; that is no failure. Where
/// `[vary]` draws what shapes plans, a case is held to what was drawn for it, or to what is nominal: missions made
/// elsewhere are planned by that.
///
/// It is held to `[task]` as well, also where its waypoints were moved after a search saw them; what was not searched
/// for is for [`verify_mission`].
pub fn verify(setup: &Setup, case: &Case) -> Verified {
    held(setup, case, Made::Searched)
}

/// The same for a case that was made elsewhere: it has a task of its own, and of drives a speed of its own where the
/// scenario limits none.
pub fn verify_mission(setup: &Setup, case: &Case) -> Verified {
    held(setup, case, Made::Elsewhere)
}

fn held(setup: &Setup, case: &Case, made: Made) -> Verified {
    let draws = vary::draw_for_case(&setup.scenario, case.seed, case.number);
    // Bounds that vary are those that the case was searched with; draws that do not fit, as another scenario's, bound
    // nothing.
    let drawn = vary::apply(&setup.scenario, &draws).ok().filter(|_| !draws.is_empty());
    let asked = drawn.as_ref().unwrap_or(&setup.scenario);
    let holds = |(proof, _): &(Option<Proof>, Option<EndError>)| proof.as_ref().is_none_or(Proof::ok);
    let own = drawn.clone().and_then(|drawn| setup.of_draw(drawn).ok());
    let as_drawn = own.map(|own| own.kind().verify(case, asked, made)).filter(holds);
    let (proof, with_lag) = as_drawn.unwrap_or_else(|| setup.kind().verify(case, asked, made));
    Verified { case: case.number, proof, with_lag }
}

/// What does not hold of the rows that are kept of the planned motion of `case`, whose witness holds ([`verify`]): of
/// each quantity that is off the row that is off the most. Nothing for a case without a witness.
pub fn verify_planned(setup: &Setup, case: &Case, kept: &PlannedRows) -> Vec<Finding> {
    setup.kind().verify_planned(case, kept)
}
