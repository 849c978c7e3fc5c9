//! What an answer is of: protocol 2 has it say so, so that none counts for another mission.

use hairpin::campaign::Mission;
use serde_json::Value;

use super::heard::FromExecutor;

/// The name of a mission.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Envelope {
    pub(super) case: String,
    pub(super) run: usize,
}

/// What a message says about whose it is.
#[derive(Debug, PartialEq)]
pub(super) enum Whose {
    /// Of the mission that is asked.
    This,
    /// Of another one, as the message names it.
    Another { case: String, run: String },
    /// It does not say.
    Nobodys,
}

impl Envelope {
    /// That of `mission`.
    pub(super) fn of(mission: &Mission) -> Self {
        Self { case: mission.case.clone(), run: mission.run }
    }

    /// Whose `message` is, where this is what was asked.
    pub(super) fn whose(&self, message: &FromExecutor) -> Whose {
        let [case, run] = message.envelope();
        let (Some(case), Some(run)) = (case, run) else { return Whose::Nobodys };
        if case.as_str() == Some(self.case.as_str()) && run.as_u64() == Some(self.run as u64) {
            return Whose::This;
        }
        Whose::Another { case: plain(case), run: plain(run) }
    }

    /// Whether a message that names `case` and `run` is of this mission.
    pub(super) fn is(&self, case: &str, run: &str) -> bool {
        self.case == case && self.run.to_string() == run
    }
}

/// A stranger's value, in a few words.
fn plain(value: &Value) -> String {
    let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    super::failure::excerpt(&text, 40)
}
