//! A campaign's programs against those of an earlier release: what is told of all of them together.
//!
//! Many moves, two metrics: at 3 σ a few of a thousand lie outside by chance, and how many is said
//! ([`Regression::expected_by_chance`]).

use super::compare::{Comparison, Metric, MoveComparison, Outcome};
use super::trend::Trend;
use crate::judgement::Verdict;

/// One program of a campaign.
///
/// Of the same program in both releases, by its digest.
#[derive(Debug, Clone, PartialEq)]
pub struct ProgramComparison {
    /// As verdicts call it: `0003`.
    pub program: String,
    /// Its moves against the baseline's.
    pub comparison: Comparison,
    /// Its moves over all releases that are known, the new one last; empty where there are fewer than three.
    pub trends: Vec<Trend>,
}

/// All programs of a campaign against a baseline. There is one at least.
///
/// Every program has the same two releases.
#[derive(Debug, Clone, PartialEq)]
pub struct Regression {
    /// Releases that are known, oldest first: the last but one is the baseline, the last the new one.
    pub releases: Vec<String>,
    /// In the order of the campaign.
    pub programs: Vec<ProgramComparison>,
}

impl Regression {
    /// Moves of all programs with an outcome.
    pub fn count(&self, outcome: Outcome) -> usize {
        self.programs.iter().map(|one| one.comparison.count(outcome)).sum()
    }

    /// Moves of all programs.
    pub fn moves(&self) -> usize {
        self.programs.iter().map(|one| one.comparison.moves).sum()
    }

    /// Comparisons that chance alone puts outside their bands at this many standard deviations, were all releases
    /// equal: both sides, every metric of every move. Floors of the bands make it fewer.
    ///
    /// N erfc(σ/√2), N the number of comparisons: 0.27 % of them at 3 σ.
    pub fn expected_by_chance(&self, sigma: f64) -> f64 {
        let compared: usize = self.programs.iter().map(|one| one.comparison.compared.len()).sum();
        compared as f64 * libm::erfc(sigma / std::f64::consts::SQRT_2)
    }

    /// `3/48 moves outside the baseline's band, worst p17→p09 +41 ms (band ±6 ms)`; of several programs with the worst
    /// one's name.
    ///
    /// A move that is no longer completed is graver than any difference.
    pub fn outside(&self) -> String {
        let count = format!("{}/{} moves outside the baseline's band", self.count(Outcome::Worse), self.moves());
        let of = |one: &ProgramComparison| match self.programs.len() {
            1 => String::new(),
            _ => format!(", case {}", one.program),
        };
        let lost = self.programs.iter().find_map(|one| Some((one, *one.comparison.lost.first()?)));
        if let Some((one, lost)) = lost {
            return format!("{count}, move {lost} no longer completed in every run{}", of(one));
        }
        let worst = self.programs.iter().filter_map(|one| Some((one, one.comparison.worst()?)));
        match worst.max_by(|a, b| beyond(a.1).total_cmp(&beyond(b.1))) {
            Some((one, worst)) => format!("{count}, worst {}{}", worst.in_words(), of(one)),
            None => count,
        }
    }

    /// `REGRESSION 7.15 against 7.14 (5 + 5 runs)`.
    pub fn head(&self) -> String {
        let first = &self.programs[0].comparison;
        let [before, now] = first.runs;
        format!("REGRESSION {} against {} ({now} + {before} runs)", first.new, first.baseline)
    }

    /// `verdict`, which was given by the limits alone (`limited`: there are some), with what the baseline says: a
    /// violation stays one, else a move that is worse makes a regression (1), and moves that are better are told.
    ///
    /// Exit code 1 stays 1; 0 becomes 1 where a move is worse; an inconclusive verdict becomes a regression too, with
    /// its own sentence behind.
    pub fn join(&self, verdict: Verdict, limited: bool) -> Verdict {
        let (worse, better) = (self.count(Outcome::Worse), self.count(Outcome::Better));
        let baseline = &self.programs[0].comparison.baseline;
        let better = if better > 0 { format!("; {better} better than the band") } else { String::new() };
        let Verdict { sentence, exit_code } = verdict;
        if worse == 0 {
            let said = format!("against {baseline}: no move outside the baseline's band{better}");
            return Verdict::of(&format!("{sentence}; {said}"), exit_code);
        }
        if exit_code == 1 {
            let said = format!("against {baseline}: {}{better}", self.outside());
            return Verdict::of(&format!("{sentence}; {said}"), exit_code);
        }
        let spec = match (exit_code, limited) {
            (0, true) => "all still within spec".to_owned(),
            (0, false) => "no spec was given".to_owned(),
            _ => sentence,
        };
        Verdict::of(&format!("{}: {}{better}; {spec}", self.head(), self.outside()), 1)
    }
}

impl MoveComparison {
    /// `p17→p09 +41 ms (band ±6 ms)`, with as many decimals as it takes.
    pub fn in_words(&self) -> String {
        let (difference, band, unit) = match self.metric {
            Metric::Duration => (1e3 * self.difference(), 1e3 * self.band, "ms"),
            Metric::Deviation => (1e3 * self.difference(), 1e3 * self.band, "mm"),
        };
        let decimals = match self.metric {
            Metric::Duration if difference.abs() >= 10.0 => 0,
            Metric::Duration => 1,
            Metric::Deviation => 2,
        };
        // A band is never printed as wide as what lies outside it.
        let apart = |d: usize| format!("{:.d$}", difference.abs()) != format!("{band:.d$}");
        let decimals = (decimals..12).find(|d| apart(*d)).unwrap_or(12);
        format!("{} {difference:+.decimals$} {unit} (band ±{band:.decimals$} {unit})", self.name)
    }
}

/// In bands.
fn beyond(one: &MoveComparison) -> f64 {
    one.difference() / one.band
}
