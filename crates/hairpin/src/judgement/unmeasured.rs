//! Limits of what was not measured: they are neither kept nor broken, whatever the others came to.

use super::{Limits, Measures};

impl Limits {
    /// What is limited and was not measured, as [`super::Violation::what`] calls it. Overshoot and duration always are.
    pub fn unmeasured(&self, measures: &Measures) -> Vec<&'static str> {
        let of = [
            ("deviation", self.deviation, measures.deviation()),
            ("acceleration", self.acceleration, measures.acceleration()),
            ("clearance", self.clearance, measures.min_clearance),
            ("tip-over-margin", self.tip_over_margin, measures.min_tip_over_margin),
            ("late", self.late, measures.latest.map(|late| late.by)),
        ];
        let missing = of.into_iter().filter(|(_, limit, measured)| limit.is_some() && measured.is_none());
        missing.map(|(what, ..)| what).collect()
    }

    /// Why a run that violates nothing is open all the same, with what was not measured of it by name; `None` where
    /// all was that has a limit.
    ///
    /// ```
    /// use hairpin::judgement::{Limits, Measures};
    ///
    /// let limits = Limits { deviation: Some(5.0), tip_over_margin: Some(10.0), ..Limits::default() };
    /// let told = limits.open(&Measures::default());
    /// assert_eq!(told.as_deref(), Some("not all that `spec` limits was measured: no tip-over margin"));
    /// assert_eq!(limits.open(&Measures { min_tip_over_margin: Some(12.0), ..Measures::default() }), None);
    /// ```
    pub fn open(&self, measures: &Measures) -> Option<String> {
        let missing = self.unmeasured(measures);
        let words = |what: &&'static str| match *what {
            "tip-over-margin" => "tip-over margin",
            "late" => "lateness",
            what => what,
        };
        let named = missing.iter().map(words).collect::<Vec<_>>().join(", no ");
        let first = match missing.len() {
            0 => return None,
            all if all == self.given() => "nothing that `spec` limits was measured",
            _ => "not all that `spec` limits was measured",
        };
        Some(format!("{first}: no {named}"))
    }
}
