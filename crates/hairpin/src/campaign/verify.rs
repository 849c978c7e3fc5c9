//! Hands the written witnesses to the verification room.

use super::setup::Kind;
use super::{Case, CaseNumber, Scenario, Setup, arm, drive, flight, vary};
use crate::verification::{EndError, Proof};

/// What verification says of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Verified {
    /// Number of the case.
    pub case: CaseNumber,
    /// The proof, and what was found of its environment; `None` for a case that claims no witness and has none.
    pub proof: Option<Proof>,
    /// End error of a whole flight, open loop, with rotor lag: what the claim leaves out.
    pub with_lag: Option<EndError>,
}

/// Integrates the witness of `case` by independent code, to the default tolerances of flights and the scenario's of
/// drives.
pub fn verify(setup: &Setup, case: &Case) -> Verified {
    let (mut proof, with_lag) = match setup.kind() {
        Kind::Flight(setup) => {
            flight::verify(setup.robot, case).map_or((None, None), |(proof, lag)| (Some(proof), lag))
        }
        Kind::Drive(setup) => (drive::verify(&setup, case), None),
        Kind::Arm(setup) => (arm::verify(&setup, case), None),
    };
    if case.environment.is_some() {
        // Bounds that vary are those that the case was searched with; draws that do not fit, as another scenario's,
        // bound nothing.
        let drawn = vary::draw_for_case(&setup.scenario, case.seed, case.number);
        let drawn = vary::apply(&setup.scenario, &drawn).unwrap_or_else(|_| setup.scenario.clone());
        let findings = match (setup.kind(), &drawn) {
            (Kind::Flight(setup), Scenario::Flight(drawn)) => {
                flight::verify_environment(&setup, drawn.generate.environment, case)
            }
            (Kind::Drive(setup), Scenario::Drive(drawn)) => {
                drive::verify_environment(&setup, drawn.generate.environment, case)
            }
            _ => Vec::new(),
        };
        proof.get_or_insert_default().findings.extend(findings);
    }
    Verified { case: case.number, proof, with_lag }
}
