//! What legs of boats are scored by.

use super::BoatSetup;
use super::keys::ACROSS_CURRENT;
use crate::campaign::graph::{Looped, Named};
use crate::campaign::learn::AnyScore;
use crate::math::random::named_seed;
use crate::search::Score;

/// Scores that see nothing where nothing climbs.
const OF_HEIGHTS: [&str; 2] = ["cut-corner", "crest"];

/// Scores by hand that say something of boats.
///
/// `across-current` first; what is tried beside a learned score, or for want of one.
fn by_hand() -> impl Iterator<Item = &'static str> {
    std::iter::once(ACROSS_CURRENT).chain(Score::by_hand().filter(|name| !OF_HEIGHTS.contains(name)))
}

/// The score for graph number `graph`, the scenario's or the first model of a round, and those beside it; `top_speed`
/// (m/s) scores 1.
///
/// `across-current` is what the roadmap tells of a leg as its `ground`. The random score is seeded by the graph.
pub(super) fn scores<'a>(
    setup: &'a BoatSetup,
    graph: u64,
    top_speed: f64,
    looped: &Looped<'a>,
) -> (AnyScore<'a>, Vec<AnyScore<'a>>) {
    let generate = &setup.scenario.generate;
    let seed = named_seed(setup.scenario.seed, "score", graph);
    let score = |name: &str| match name {
        ACROSS_CURRENT => AnyScore::Named(Score::Ground),
        // The name was checked with the scenario, and top speeds are > 0 with the boat.
        _ => AnyScore::Named(Score::named(name, seed, top_speed).unwrap_or(Score::Random { seed })),
    };
    let named = Named { score: &score, by_hand: &|| by_hand().collect() };
    let own = named.own(looped, &setup.attachments, (&generate.score, generate.score_of_legs()));
    (own, named.beside(looped, &generate.score))
}
