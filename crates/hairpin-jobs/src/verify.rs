//! Every witness integrated by independent code.

use std::path::Path;

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::arm::{GraphAgain, graph_of};
use hairpin::campaign::{self, Case, CaseNumber, Evidence};
use hairpin::verification::Finding;
use rayon::prelude::*;

use crate::Problem;
use crate::optimum::{self, Optimum};
use crate::work::{Work, open_to_read};

/// What the check of a campaign came to.
#[derive(Debug)]
pub struct Verified {
    /// What came of each case.
    pub answers: Vec<Answer>,
    /// Of arms whose first program claims to be the heaviest.
    pub optimum: Option<Optimum>,
    /// Of arms, the moves of the graph that no program uses as well.
    pub graph: Option<GraphAgain>,
    /// Cases with something placed around them that were checked, and those of them that are clear of it.
    pub surrounded: [usize; 2],
    /// What of the robot the claims rest on that is not known, or leave out.
    pub unknown: Option<&'static str>,
}

/// What came of one case.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// It claims no witness.
    NothingClaimed,
    /// It was checked.
    Checked {
        /// Number of the case.
        case: CaseNumber,
        /// Whether it has a witness.
        witness: bool,
        /// The largest end error over its legs, m.
        position_m: f64,
        /// What does not hold.
        findings: Vec<String>,
    },
}

impl Answer {
    /// Whether all that was checked holds.
    fn fine(&self) -> bool {
        matches!(self, Self::Checked { findings, .. } if findings.is_empty())
    }

    fn is_checked(&self) -> bool {
        matches!(self, Self::Checked { .. })
    }

    /// Whether it was checked and has a witness.
    pub fn is_witnessed(&self) -> bool {
        matches!(self, Self::Checked { witness: true, .. })
    }
}

/// Verifies every case of the campaign in `folder`.
///
/// # Errors
/// The folder is no campaign's, or broken; a broken witness is a finding.
pub fn verify(folder: &Path) -> Result<Verified, Problem> {
    let work = open_to_read(folder)?;
    let cases = work.folder.read_cases_without_profiles()?;
    let answers: Vec<Answer> = cases.par_iter().map(|case| check(&work, case)).collect();
    let optimum = work.setup.own::<ArmSetup>().and_then(|arm| optimum::verify(&work, arm, &cases));
    let graph = work
        .setup
        .own::<ArmSetup>()
        .and_then(|arm| graph_of(arm).ok().map(|graph| arm.graph_again(&graph)))
        .filter(|graph| graph.moves > 0);
    let around = answers.iter().zip(&cases).filter(|(answer, case)| case.environment.is_some() && answer.is_checked());
    let clear = around.clone().filter(|(answer, _)| answer.fine()).count();
    let surrounded = [around.count(), clear];
    let unknown = work.setup.unknown_shapes();
    Ok(Verified { answers, optimum, graph, surrounded, unknown })
}

impl Verified {
    /// Whether anything does not hold.
    pub fn has_findings(&self) -> bool {
        self.failed().next().is_some()
            || self.optimum.as_ref().is_some_and(|optimum| !optimum.findings.is_empty())
            || self.graph.as_ref().is_some_and(|graph| !graph.findings.is_empty())
    }

    /// Cases of which something does not hold.
    pub fn failed(&self) -> impl Iterator<Item = &Answer> {
        self.answers.iter().filter(|answer| answer.is_checked() && !answer.fine())
    }

    /// Cases that were checked.
    pub fn checked(&self) -> usize {
        self.answers.iter().filter(|answer| answer.is_checked()).count()
    }

    /// Cases with a witness, and those of them that hold.
    pub fn witnesses(&self) -> [usize; 2] {
        let witnesses = self.answers.iter().filter(|answer| answer.is_witnessed());
        [witnesses.clone().count(), witnesses.filter(|answer| answer.fine()).count()]
    }

    /// The worst case that was checked: one with findings before one without, then the one that ends farthest from its
    /// waypoints.
    pub fn worst(&self) -> Option<&Answer> {
        let mut worst: Option<((bool, f64), &Answer)> = None;
        for answer in &self.answers {
            let Answer::Checked { position_m, findings, .. } = answer else { continue };
            let rank = (!findings.is_empty(), *position_m);
            if worst.as_ref().is_none_or(|(before, _)| *before < rank) {
                worst = Some((rank, answer));
            }
        }
        worst.map(|(_, answer)| answer)
    }
}

fn check(work: &Work, case: &Case) -> Answer {
    let finding =
        |what: String| Answer::Checked { case: case.number, witness: true, position_m: f64::MAX, findings: vec![what] };
    let mut case = case.clone();
    if let Err(error) = work.folder.read_witness(&mut case) {
        return finding(error.to_string());
    }
    let claims = matches!(case.evidence, Evidence::Witnessed | Evidence::ClearAllLinks | Evidence::ClearToolSphere);
    let witness = case.witness.is_some();
    if case.environment.is_none() && !witness && !claims {
        return Answer::NothingClaimed;
    }
    let verified = campaign::verify(&work.setup, &case);
    match verified.proof {
        Some(proof) if witness || !claims => Answer::Checked {
            case: case.number,
            witness,
            position_m: proof.position.value,
            findings: proof.findings.iter().map(words).collect(),
        },
        _ => finding("its profile is missing".into()),
    }
}

fn words(finding: &Finding) -> String {
    let Finding { field, value, bound, unit, at, leg } = finding;
    // What is refused in words alone has neither.
    let numbers = match bound.is_nan() {
        true => String::new(),
        false => format!(" = {value:.6e} {unit}, bound {bound:.6e} {unit}"),
    };
    format!("{field}{numbers}, leg {leg}→{}, t = {at:.3} s", leg + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::generated;

    #[test]
    fn what_has_no_number_is_told_in_words() {
        let finding = Finding { field: "it stops".into(), value: f64::NAN, bound: f64::NAN, unit: "", leg: 1, at: 0.5 };
        assert_eq!(words(&finding), "it stops, leg 1→2, t = 0.500 s");
        let finding = Finding { field: "end".into(), value: 2.0, bound: 1.0, unit: "m", ..finding };
        assert_eq!(words(&finding), "end = 2.000000e0 m, bound 1.000000e0 m, leg 1→2, t = 0.500 s");
    }

    #[test]
    fn witnesses_hold_and_broken_ones_are_findings() {
        let (_place, folder) = generated();
        let verified = verify(&folder).unwrap();
        assert_eq!((verified.witnesses(), verified.has_findings()), ([2, 2], false));
        std::fs::write(folder.join("profiles/part-00000.parquet"), "broken").unwrap();
        let broken = verify(&folder).unwrap();
        assert_eq!((broken.checked(), broken.failed().count(), broken.witnesses()), (2, 2, [2, 0]));
        assert_eq!(broken.worst(), broken.failed().next());
    }
}
