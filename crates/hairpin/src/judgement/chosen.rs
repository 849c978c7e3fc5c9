//! The share of violations, and what it says: of cases that were drawn at random it is an estimate of all that are
//! feasible, of any others it is a count.
//!
//! ```text
//! drawn at random      failed/N in [low, high] (Clopper and Pearson)     the interval decides
//! any other            failed of N                                       the count alone decides
//! ```

use super::statistics::{Share, rule_of_three, share};

/// How cases were come by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Chosen {
    /// At random, each by itself: what holds of them holds of all that are feasible, within an interval.
    AtRandom,
    /// At random, but several from each graph: those of one graph are alike, so that they say less than as many others.
    InGroups,
    /// For their stress: how many of them violate says nothing of how often others would.
    #[default]
    Searched,
    /// From a campaign, for what they are.
    Selected,
    /// Made elsewhere, nobody says how.
    Given,
}

impl Chosen {
    /// The word in JSON and JUnit.
    pub fn word(self) -> &'static str {
        match self {
            Self::AtRandom => "random",
            Self::InGroups => "random-in-groups",
            Self::Searched => "searched",
            Self::Selected => "selected",
            Self::Given => "given",
        }
    }

    /// The share `failed` / `counted` with its interval, where that is one of more than these cases; else `None`.
    pub fn share(self, failed: usize, counted: usize, confidence: f64) -> Option<Share> {
        if self == Self::AtRandom { share(failed, counted, confidence) } else { None }
    }

    /// `3 of 200 searched`: the count, and of what.
    pub fn counted(self, failed: usize, counted: usize) -> String {
        let of = match self {
            Self::AtRandom => "drawn",
            Self::InGroups => "drawn, several from each graph,",
            Self::Searched => "searched",
            Self::Selected => "selected",
            Self::Given => "given",
        };
        format!("{failed} of {counted} {of}")
    }
}

/// Where a share lies against the one that is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Against {
    /// More violate than may, beyond doubt where it is an estimate.
    Above,
    /// No more than may, beyond doubt where it is an estimate.
    Within,
    /// The interval has the limit in it, or there is nothing to count.
    Open,
}

/// What is counted.
///
/// `of` may be 0; `confidence` lies in [0.5, 1).
#[derive(Debug, Clone, Copy)]
pub(super) struct Count {
    pub(super) chosen: Chosen,
    /// Cases that violate …
    pub(super) failed: usize,
    /// … of so many that were judged.
    pub(super) of: usize,
    pub(super) confidence: f64,
}

impl Count {
    /// Of cases at random the interval decides, of any others their own share.
    ///
    /// A limit that is met exactly is not broken. `Open` without a case.
    pub(super) fn against(&self, limit: f64) -> Against {
        let Some(plain) = share(self.failed, self.of, self.confidence) else { return Against::Open };
        match self.chosen.share(self.failed, self.of, self.confidence) {
            Some(Share { low, .. }) if low > limit => Against::Above,
            Some(Share { high, .. }) if high > limit => Against::Open,
            Some(_) => Against::Within,
            None if plain.value > limit => Against::Above,
            None => Against::Within,
        }
    }

    /// `share 1.5 % [0.3, 4.3]` of cases at random, `3 of 200 searched violate` of others, and where it lies against
    /// `limit`; `None` where nothing was judged.
    pub(super) fn sentence(&self, limit: Option<f64>) -> Option<String> {
        if self.of == 0 {
            return None;
        }
        let interval = self.chosen.share(self.failed, self.of, self.confidence);
        let mut sentence = match interval {
            Some(share) => share_words(share, (self.failed, self.of), self.confidence, "cases"),
            None => format!("{} violate", self.chosen.counted(self.failed, self.of)),
        };
        if let Some(limit) = limit {
            let allowed = trimmed(100.0 * limit);
            // Whoever allows a share of cases that were not drawn at random allows it of these alone.
            let of = if interval.is_some() { "" } else { " of them" };
            sentence += &match self.against(limit) {
                Against::Above => format!(", above the {allowed} % allowed{of}"),
                Against::Within => format!(", within the {allowed} % allowed{of}"),
                Against::Open => {
                    let high = interval.filter(|_| self.failed == 0).map(|share| percent(share.high));
                    let ends = high.map_or(String::new(), |high| format!(" [0.0, {high}]"));
                    format!(", interval{ends} straddles the {allowed} % allowed")
                }
            };
        }
        Some(sentence)
    }
}

/// `7 of 199 draws of `[vary]` violate: share 3.5 % [1.4, 7.1]`: of the runs of one case, whose values were drawn at
/// random each; `None` without one.
pub(super) fn draws_sentence(failed: usize, of: usize, confidence: f64) -> Option<String> {
    let share = share(failed, of, confidence)?;
    let words = share_words(share, (failed, of), confidence, "draws of `[vary]`");
    Some(if failed == 0 { words } else { format!("{failed} of {of} draws of `[vary]` violate: {words}") })
}

/// No failure at all is told by the rule of three at 95 %, 3/N, and by −ln(1 − c)/N at any other confidence c.
fn share_words(share: Share, (failed, of): (usize, usize), confidence: f64, what: &str) -> String {
    if failed == 0 {
        let no = format!("no violation in {of} {what}: share at most");
        if confidence == 0.95 {
            return format!("{no} {} % (3/N, 95 %)", percent(rule_of_three(of)));
        }
        let (three, at) = (-libm::log1p(-confidence), trimmed(100.0 * confidence));
        return format!("{no} {} % ({three:.1}/N, {at} %)", percent((three / of as f64).min(1.0)));
    }
    let confidence = if confidence == 0.95 { String::new() } else { format!(" at {} %", trimmed(100.0 * confidence)) };
    let (value, low, high) = (percent(share.value), percent(share.low), percent(share.high));
    format!("share {value} % [{low}, {high}]{confidence}")
}

/// A share in percent: one decimal, or two digits where it is below 0.1 %.
///
/// Up to 12 decimals.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent == 0.0 || percent >= 0.1 {
        return format!("{percent:.1}");
    }
    let decimals = (1.0 - libm::log10(percent).floor()).clamp(1.0, 12.0) as usize;
    format!("{percent:.decimals$}")
}

/// A number without trailing zeros, rounded to what percentages need.
fn trimmed(number: f64) -> String {
    ((number * 1e6).round() / 1e6).to_string()
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    fn count(chosen: Chosen, failed: usize, of: usize) -> Count {
        Count { chosen, failed, of, confidence: 0.95 }
    }

    #[test]
    fn an_interval_is_of_cases_at_random_alone() {
        let words = |chosen, failed| count(chosen, failed, 200).sentence(None).unwrap();
        assert_eq!(words(Chosen::AtRandom, 3), "share 1.5 % [0.3, 4.3]");
        assert_eq!(words(Chosen::AtRandom, 0), "no violation in 200 cases: share at most 1.5 % (3/N, 95 %)");
        assert_eq!(words(Chosen::Searched, 3), "3 of 200 searched violate");
        assert_eq!(words(Chosen::Searched, 0), "0 of 200 searched violate");
        assert_eq!(words(Chosen::InGroups, 3), "3 of 200 drawn, several from each graph, violate");
        assert_eq!(words(Chosen::Given, 200), "200 of 200 given violate");
        assert_eq!(words(Chosen::Selected, 1), "1 of 200 selected violate");
        assert_eq!(count(Chosen::Searched, 0, 0).sentence(Some(0.1)), None);
    }

    #[test]
    fn no_failure_is_told_at_the_confidence_that_was_asked_for() {
        let words = |confidence| Count { confidence, ..count(Chosen::AtRandom, 0, 200) }.sentence(None).unwrap();
        assert_eq!(words(0.99), "no violation in 200 cases: share at most 2.3 % (4.6/N, 99 %)");
        assert_eq!(words(0.5), "no violation in 200 cases: share at most 0.3 % (0.7/N, 50 %)");
        let draws = "no violation in 2 draws of `[vary]`: share at most 100.0 % (4.6/N, 99 %)";
        assert_eq!(draws_sentence(0, 2, 0.99).as_deref(), Some(draws));
    }

    #[test]
    fn of_others_the_count_decides() {
        let against = |chosen, failed| count(chosen, failed, 200).against(0.02);
        // 3 of 200 at random may be 4.3 %, and 4 of them are 2 %.
        let at_random = [0, 3, 4, 30].map(|failed| against(Chosen::AtRandom, failed));
        assert_eq!(at_random, [Against::Within, Against::Open, Against::Open, Against::Above]);
        let searched = [0, 4, 5].map(|failed| against(Chosen::Searched, failed));
        assert_eq!(searched, [Against::Within, Against::Within, Against::Above]);
        assert_eq!(count(Chosen::Searched, 0, 0).against(0.02), Against::Open);
        let words = |failed| count(Chosen::Searched, failed, 200).sentence(Some(0.02)).unwrap();
        assert_eq!(words(4), "4 of 200 searched violate, within the 2 % allowed of them");
        assert_eq!(words(5), "5 of 200 searched violate, above the 2 % allowed of them");
    }

    #[test]
    fn draws_of_one_case_are_at_random() {
        let some = "7 of 199 draws of `[vary]` violate: share 3.5 % [1.4, 7.1]";
        assert_eq!(draws_sentence(7, 199, 0.95).as_deref(), Some(some));
        let none = "no violation in 200 draws of `[vary]`: share at most 1.5 % (3/N, 95 %)";
        assert_eq!(draws_sentence(0, 200, 0.95).as_deref(), Some(none));
        assert_eq!(draws_sentence(0, 0, 0.95), None);
    }

    #[test]
    fn digits_show_the_difference() {
        assert_eq!((percent(0.015), percent(0.0), percent(0.000_031)), ("1.5".into(), "0.0".into(), "0.0031".into()));
    }
}
