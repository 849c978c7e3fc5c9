//! What flights are searched with: the judge of legs, and the score.

use super::FlightSetup;
use crate::campaign::graph::{Looped, Named};
use crate::campaign::learn::AnyScore;
use crate::feasibility::Limits;
use crate::feasibility::steering::{LegJudge, ProofSettings};
use crate::math::random::named_seed;
use crate::search::Score;

/// The judge of legs under the scenario's limits.
///
/// Speeds without a limit are infinite in it; tilts are in rad.
///
/// # Errors
/// A rotor layout without a flatness map, in a sentence's part.
///
/// The judge holds the free space and the flatness map; it is made once and asked for every leg. Proofs are taken with
/// the default settings.
pub(super) fn judge(setup: &FlightSetup) -> Result<LegJudge, String> {
    judge_up_to(setup, f64::INFINITY)
}

/// The scenario's limits of speed and tilt.
pub(super) fn limits(setup: &FlightSetup) -> Limits {
    let given = &setup.scenario.generate.limits;
    Limits {
        max_speed: given.max_speed_m_s.unwrap_or(f64::INFINITY),
        max_tilt: given.max_tilt_deg.map_or(Limits::default().max_tilt, f64::to_radians),
    }
}

/// The same, no faster than `most` (m/s).
///
/// # Errors
/// As [`judge`].
///
/// For missions of others, which are held to the robot's top speed too.
pub(super) fn judge_up_to(setup: &FlightSetup, most: f64) -> Result<LegJudge, String> {
    let given = limits(setup);
    let limits = Limits { max_speed: given.max_speed.min(most), ..given };
    LegJudge::new(&setup.robot, &setup.world, limits, ProofSettings::default()).map_err(|error| error.to_string())
}

/// The score for graph number `graph`, the scenario's or the first model of a round, and those beside it; `top_speed`
/// (m/s) scores 1.
///
/// The random score is seeded by the graph: each has its own.
///
/// A score by a name that is none would be random: it cannot come here, as names are checked with the scenario.
pub(super) fn scores<'a>(
    setup: &'a FlightSetup,
    graph: u64,
    top_speed: f64,
    looped: &Looped<'a>,
) -> (AnyScore<'a>, Vec<AnyScore<'a>>) {
    let generate = &setup.scenario.generate;
    let seed = named_seed(setup.scenario.seed, "score", graph);
    // The name was checked with the scenario, and top speeds are > 0 with the robot.
    let score = |name: &str| AnyScore::Named(Score::named(name, seed, top_speed).unwrap_or(Score::Random { seed }));
    let named = Named { score: &score, by_hand: &|| Score::by_hand().collect() };
    let own = named.own(looped, &setup.attachments, (&generate.score, generate.score_of_legs()));
    (own, named.beside(looped, &generate.score))
}
