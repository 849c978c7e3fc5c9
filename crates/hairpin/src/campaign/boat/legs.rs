//! What legs of boats are scored by.

use super::BoatSetup;
use super::keys::ACROSS_CURRENT;
use crate::campaign::graph::{Looped, Wanted};
use crate::campaign::learn::AnyScore;
use crate::math::random::named_seed;
use crate::search::Score;

/// Scores that see nothing where nothing climbs.
const OF_HEIGHTS: [&str; 2] = ["cut-corner", "crest"];

/// Scores by hand that say something of boats.
fn by_hand() -> impl Iterator<Item = &'static str> {
    std::iter::once(ACROSS_CURRENT).chain(Score::by_hand().filter(|name| !OF_HEIGHTS.contains(name)))
}

/// The score for graph number `graph`, the scenario's or the first model of a round; `top_speed` (m/s) scores 1.
pub(super) fn score<'a>(setup: &'a BoatSetup, graph: u64, top_speed: f64, looped: &Looped<'a>) -> AnyScore<'a> {
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
pub(super) fn beside<'a>(setup: &'a BoatSetup, graph: u64, top_speed: f64, looped: &Looped<'a>) -> Vec<AnyScore<'a>> {
    let named = |name: &&str| named(setup, name, graph, top_speed);
    match looped.wanted {
        Wanted::Round(round) => {
            let models = round.models.iter().skip(1).map(AnyScore::Learned);
            models.chain(by_hand().map(|name| named(&name))).collect()
        }
        Wanted::Optima(names) => names.iter().skip(1).map(named).collect(),
        Wanted::Cases => {
            let own = &setup.scenario.generate.score;
            by_hand().filter(|name| name != own).map(|name| named(&name)).collect()
        }
    }
}

fn named<'a>(setup: &'a BoatSetup, name: &str, graph: u64, top_speed: f64) -> AnyScore<'a> {
    if name == ACROSS_CURRENT {
        return AnyScore::Named(Score::Ground);
    }
    let seed = named_seed(setup.scenario.seed, "score", graph);
    // The name was checked with the scenario, and top speeds are > 0 with the boat.
    AnyScore::Named(Score::named(name, seed, top_speed).unwrap_or(Score::Random { seed }))
}
