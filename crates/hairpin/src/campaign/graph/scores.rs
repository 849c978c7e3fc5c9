//! What legs are scored by, whatever has the legs.

use super::question::{Looped, Wanted};
use crate::campaign::attachments::Attachments;
use crate::campaign::learn::AnyScore;

/// What was learned of legs, by rounds before this one or by the scenario's model, or what the user's own program says
/// of them; `None` where `score` is one of those that have names.
pub(in crate::campaign) fn learned<'a>(
    looped: &Looped<'a>,
    files: &'a Attachments,
    score: &str,
) -> Option<AnyScore<'a>> {
    let model = files.model(score).map(|model| &*model.read);
    let learned = looped.models().first().or(model).map(AnyScore::Learned);
    learned.or(files.user_score(score).map(|user| AnyScore::User(&*user.read)))
}

/// Scores by their names, for one graph.
#[derive(Clone, Copy)]
pub(in crate::campaign) struct Named<'a, 'n> {
    /// The score of a name.
    pub(in crate::campaign) score: &'n dyn Fn(&str) -> AnyScore<'a>,
    /// Those by hand that say something of these legs.
    pub(in crate::campaign) by_hand: &'n dyn Fn() -> Vec<&'static str>,
}

impl<'a> Named<'a, '_> {
    /// The score of a graph: the one whose optimum is wanted, or what was learned of `given`, or `of_legs` by its name.
    pub(in crate::campaign) fn own(
        &self,
        looped: &Looped<'a>,
        files: &'a Attachments,
        (given, of_legs): (&str, &str),
    ) -> AnyScore<'a> {
        match looped.wanted {
            Wanted::Optima([name, ..]) => (self.score)(name),
            _ => learned(looped, files, given).unwrap_or_else(|| (self.score)(of_legs)),
        }
    }

    /// The scores beside it: a round's other models, the others whose optima are wanted, or those by hand that a search
    /// in the loop starts from.
    pub(in crate::campaign) fn beside(&self, looped: &Looped<'a>, given: &str) -> Vec<AnyScore<'a>> {
        let by_hand = || (self.by_hand)().into_iter();
        match looped.wanted {
            Wanted::Round(round) => {
                let models = round.models.iter().skip(1).map(AnyScore::Learned);
                models.chain(by_hand().map(self.score)).collect()
            }
            Wanted::Optima(names) => names.iter().skip(1).map(|name| (self.score)(name)).collect(),
            Wanted::Cases => by_hand().filter(|name| *name != given).map(self.score).collect(),
        }
    }
}
