//! Every witness integrated by independent code, and the planned motions that are kept held to the witnesses.

mod answer;
mod check;
mod tables;
#[cfg(test)]
mod tests;

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::Path;

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::arm::{GraphAgain, graph_of};
use hairpin::campaign::{self, Case, Setup, Tally};
use rayon::prelude::*;

pub use self::answer::Answer;
use self::check::check;
use crate::Problem;
use crate::optimum::{self, Optimum};
use crate::work::open_to_read;

/// What the check of a campaign came to.
#[derive(Debug)]
pub struct Verified {
    /// What came of each case.
    pub answers: Vec<Answer>,
    /// Of arms whose first program claims to be the heaviest.
    pub optimum: Option<Optimum>,
    /// Of arms, the moves of the graph that no program uses as well.
    pub graph: Option<GraphAgain>,
    /// What of the graph's tables in the folder is not that of the scenario's graph.
    pub tables: Vec<String>,
    /// Cases with something placed around them that were checked, and those of them that are clear of it.
    pub surrounded: [usize; 2],
    /// What of the robot the claims rest on that is not known, or leave out.
    pub unknown: Option<Cow<'static, str>>,
    /// Why there was nothing to verify, in a sentence's part; `None` where something was.
    pub nothing: Option<String>,
    /// What of the folder's scenario was edited since hairpin wrote it: what is proven is proven of what it is now.
    pub edited: Vec<String>,
}

/// Verifies every case of the campaign in `folder`.
///
/// # Errors
/// The folder is no campaign's, or its scenario, cases or tally are broken; a broken witness is a finding.
pub fn verify(folder: &Path) -> Result<Verified, Problem> {
    let work = open_to_read(folder)?;
    let cases = work.folder.read_cases_without_profiles()?;
    // A folder's cases are missions, or were searched for; without a tally a search has not yet come to one.
    let tally = if work.folder.has_tally() { work.folder.read_tally()? } else { Tally::default() };
    let hold = if tally.missions.is_empty() { campaign::verify } else { campaign::verify_mission };
    let arm = work.setup.own::<ArmSetup>();
    // Made once, before all threads ask for it.
    let of_arm = arm.and_then(|arm| Some((arm, graph_of(arm).ok()?)));
    let answers: Vec<Answer> = cases.par_iter().map(|case| check(&work, case, hold)).collect();
    let optimum = arm.and_then(|arm| optimum::verify(&work, arm, &cases));
    let tables = of_arm.as_ref().map_or_else(Vec::new, |(arm, graph)| tables::differing(&work, arm, graph));
    let graph = of_arm.map(|(arm, graph)| arm.graph_again(&graph)).filter(|graph| graph.moves > 0);
    let around = answers.iter().zip(&cases).filter(|(answer, case)| case.environment.is_some() && answer.is_checked());
    let clear = around.clone().filter(|(answer, _)| answer.fine()).count();
    let surrounded = [around.count(), clear];
    let unknown = work.setup.unknown_shapes();
    let is_nothing = optimum.is_none() && graph.is_none() && !answers.iter().any(Answer::is_checked);
    let nothing = is_nothing.then(|| nothing(&work.setup, &cases));
    let edited = work.folder.edited(&work.setup)?;
    Ok(Verified { answers, optimum, graph, tables, surrounded, unknown, nothing, edited })
}

/// Why nothing of `cases` is verified.
fn nothing(setup: &Setup, cases: &[Case]) -> String {
    let words: BTreeSet<&str> = cases.iter().map(|case| case.evidence.word()).collect();
    match cases.len() {
        0 => "the folder has no case".into(),
        count => format!(
            "none of {count} cases claims a witness: evidence {}, generate.reach = \"{}\"",
            words.into_iter().collect::<Vec<_>>().join(", "),
            setup.scenario.reach()
        ),
    }
}

impl Verified {
    /// Whether anything does not hold.
    pub fn has_findings(&self) -> bool {
        self.failed().next().is_some()
            || self.optimum.as_ref().is_some_and(|optimum| !optimum.findings.is_empty())
            || self.graph.as_ref().is_some_and(|graph| !graph.findings.is_empty())
            || !self.tables.is_empty()
    }

    /// Cases of which something does not hold.
    pub fn failed(&self) -> impl Iterator<Item = &Answer> {
        self.answers.iter().filter(|answer| answer.is_checked() && !answer.fine())
    }

    /// Cases that were checked.
    pub fn checked(&self) -> usize {
        self.answers.iter().filter(|answer| answer.is_checked()).count()
    }

    /// Cases whose witness could not be read, which no number is known of.
    pub fn unread(&self) -> usize {
        self.answers.iter().filter(|answer| matches!(answer, Answer::Checked { position_m: None, .. })).count()
    }

    /// The largest end error over the legs of all witnesses that could be read, m.
    pub fn largest_m(&self) -> Option<f64> {
        let of = |answer: &Answer| match answer {
            Answer::Checked { witness: true, position_m, .. } => *position_m,
            _ => None,
        };
        self.answers.iter().filter_map(of).max_by(f64::total_cmp)
    }

    /// Cases with a witness, and those of them that hold.
    pub fn witnesses(&self) -> [usize; 2] {
        let witnesses = self.answers.iter().filter(|answer| answer.is_witnessed());
        [witnesses.clone().count(), witnesses.filter(|answer| answer.fine()).count()]
    }

    /// Planned motions whose rows were held to a witness, and those of them that are its motion.
    pub fn planned(&self) -> [usize; 2] {
        let planned = self.answers.iter().filter(|answer| matches!(answer, Answer::Checked { planned: true, .. }));
        [planned.clone().count(), planned.filter(|answer| answer.fine()).count()]
    }

    /// The worst case that was checked: one with findings before one without, then the one that ends farthest from its
    /// waypoints.
    pub fn worst(&self) -> Option<&Answer> {
        let mut worst: Option<((bool, f64), &Answer)> = None;
        for answer in &self.answers {
            let Answer::Checked { position_m, findings, .. } = answer else { continue };
            let rank = (!findings.is_empty(), position_m.unwrap_or(f64::INFINITY));
            if worst.as_ref().is_none_or(|(before, _)| *before < rank) {
                worst = Some((rank, answer));
            }
        }
        worst.map(|(_, answer)| answer)
    }
}
