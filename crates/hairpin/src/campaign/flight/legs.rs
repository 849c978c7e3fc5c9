//! What flights are searched with: the judge of legs, and the score.

use super::FlightSetup;
use crate::campaign::graph::{Looped, Wanted};
use crate::campaign::learn::AnyScore;
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
    LegJudge::new(&setup.robot, &setup.world, limits, ProofSettings::default()).map_err(|error| error.to_string())
}

/// The score for graph number `graph`, the scenario's or the first model of a round; `top_speed` (m/s) scores 1.
pub(super) fn score<'a>(setup: &'a FlightSetup, graph: u64, top_speed: f64, looped: &Looped<'a>) -> AnyScore<'a> {
    let generate = &setup.scenario.generate;
    if let Wanted::Optima([name, ..]) = looped.wanted {
        return named(setup, name, graph, top_speed);
    }
    let (model, user) = (setup.attachments.model(&generate.score), setup.attachments.user_score(&generate.score));
    match (looped.models(), model, user) {
        ([model, ..], ..) => AnyScore::Learned(model),
        ([], Some(model), _) => AnyScore::Learned(&model.read),
        ([], None, Some(user)) => AnyScore::User(&*user.read),
        ([], None, None) => named(setup, generate.score_of_legs(), graph, top_speed),
    }
}

/// The scores beside it: a round's other models, the others whose optima are wanted, or those by hand that a search in
/// the loop starts from.
pub(super) fn beside<'a>(setup: &'a FlightSetup, graph: u64, top_speed: f64, looped: &Looped<'a>) -> Vec<AnyScore<'a>> {
    let named = |name: &&str| named(setup, name, graph, top_speed);
    match looped.wanted {
        Wanted::Round(round) => {
            let models = round.models.iter().skip(1).map(AnyScore::Learned);
            models.chain(Score::by_hand().map(|name| named(&name))).collect()
        }
        Wanted::Optima(names) => names.iter().skip(1).map(named).collect(),
        Wanted::Cases => {
            let own = &setup.scenario.generate.score;
            Score::by_hand().filter(|name| *name != own).map(|name| named(&name)).collect()
        }
    }
}

fn named<'a>(setup: &'a FlightSetup, name: &str, graph: u64, top_speed: f64) -> AnyScore<'a> {
    let seed = named_seed(setup.scenario.seed, "score", graph);
    // The name was checked with the scenario, and top speeds are > 0 with the robot.
    AnyScore::Named(Score::named(name, seed, top_speed).unwrap_or(Score::Random { seed }))
}
