//! What an answer is of: protocol 2 has it say so, so that none counts for another mission.

use hairpin::campaign::Mission;
use serde_json::Value;

use super::heard::{FromExecutor, as_whole};

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
        if case.as_str() == Some(self.case.as_str()) && number(run) == Some(self.run as u64) {
            return Whose::This;
        }
        let run = number(run).map_or_else(|| plain(run), |run| run.to_string());
        Whose::Another { case: plain(case), run }
    }

    /// Whether a message that names `case` and `run` is of this mission.
    pub(super) fn is(&self, case: &str, run: &str) -> bool {
        self.case == case && self.run.to_string() == run
    }
}

/// The number of a run, be it told as `1` or as `1.0`.
fn number(run: &Value) -> Option<u64> {
    run.as_u64().or_else(|| as_whole(run.as_f64()?))
}

/// A stranger's value, in a few words.
fn plain(value: &Value) -> String {
    let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    super::failure::excerpt(&text, 40)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_whole_numbers_however_they_are_written() {
        let asked = Envelope { case: "0007".into(), run: 1 };
        let whose = |run: &str| {
            let end = format!(r#"{{"type":"end","reason":"done","case":"0007","run":{run}}}"#);
            asked.whose(&end.parse().unwrap())
        };
        assert_eq!([whose("1"), whose("1.0"), whose("1e0")], [Whose::This, Whose::This, Whose::This]);
        for (run, told) in [("0.0", "0"), ("2", "2"), ("1.5", "1.5"), ("\"1\"", "1")] {
            assert_eq!(whose(run), Whose::Another { case: "0007".into(), run: told.into() });
        }
    }
}
