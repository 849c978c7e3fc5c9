//! What flights are searched with: the judge of legs, and the score.

use super::FlightSetup;
use crate::feasibility::Limits;
use crate::feasibility::steering::{LegJudge, ProofSettings};
use crate::math::random::named_seed;
use crate::search::Score;

/// The judge of legs under the scenario's limits.
///
/// # Errors
/// A rotor layout without a flatness map, in a sentence's part.
pub(super) fn judge(setup: &FlightSetup) -> Result<LegJudge, String> {
    let given = &setup.scenario.generate.limits;
    let limits = Limits {
        max_speed: given.max_speed_m_s.unwrap_or(f64::INFINITY),
        max_tilt: given.max_tilt_deg.map_or(Limits::default().max_tilt, f64::to_radians),
    };
    LegJudge::new(setup.robot, setup.world, limits, ProofSettings::default()).map_err(|error| error.to_string())
}

/// The scenario's score for graph number `graph`; `top_speed` (m/s) scores 1.
pub(super) fn score(setup: &FlightSetup, graph: u64, top_speed: f64) -> Score {
    let seed = named_seed(setup.scenario.seed, "score", graph);
    // The name was checked with the scenario, and top speeds are > 0 with the robot.
    Score::named(&setup.scenario.generate.score, seed, top_speed).unwrap_or(Score::Random { seed })
}
