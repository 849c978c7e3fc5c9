//! What a campaign's folder keeps of its missions beside their cases: where they are from, and what their check said.

use hairpin::campaign::{Case, CaseNumber, CaseResult, Run, Setup, Status};
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::missions::{Demands, Fences, Mission};
use hairpin_formats::repro::Repro;
use serde::{Deserialize, Serialize};

use super::fenced::{self, FENCE};
use super::leg::Leg;
use crate::Problem;
use crate::check::{certainty_word, frame_in_words};
use crate::work::Work;

/// All missions of a campaign, a row a case.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MissionsTold {
    /// In the order of cases.
    pub missions: Vec<MissionTold>,
    /// Why the search beside them came to nothing, where whoever executes failed in all of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub search_failed: Option<String>,
}

/// A mission.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MissionTold {
    /// The case's name for people: the file's.
    pub name: String,
    /// What its file is written in.
    pub format: String,
    /// How its places became metres.
    pub frame: String,
    /// Whether it is feasible; null where that was not found out, or not asked.
    pub feasible: Option<bool>,
    /// The waypoint, limit and excess of the first limit that breaks.
    pub waypoint: Option<usize>,
    /// Its name.
    pub limit: Option<String>,
    /// By how much, in its unit.
    pub excess: Option<f64>,
    /// `witnessed`, `proven`, `not found`, or `unchecked`.
    pub evidence: String,
    /// What the check came to, in words.
    pub check: String,
    /// What of the file changes nothing that is judged.
    pub notes: Vec<String>,
    /// What it asks of what is executed.
    #[serde(flatten)]
    pub demands: Demands,
}

impl MissionsTold {
    pub(super) fn of(legs: &[Leg]) -> Self {
        let one = |leg: &Leg| {
            let checked = leg.checked.as_ref();
            let broken = checked.and_then(|checked| checked.broken.as_ref());
            let evidence = match checked {
                Some(checked) if checked.feasible == Some(true) => "witnessed",
                Some(_) => broken.map_or("not found", |broken| certainty_word(broken.certainty)),
                None => "unchecked",
            };
            MissionTold {
                name: leg.name.clone(),
                format: leg.mission.format.into(),
                frame: frame_in_words(&leg.mission),
                feasible: checked.and_then(|checked| checked.feasible),
                waypoint: broken.map(|broken| broken.waypoint),
                limit: broken.map(|broken| broken.limit.into()),
                excess: broken.and_then(|broken| broken.excess),
                evidence: evidence.into(),
                check: checked.map_or("not checked".into(), |checked| checked.verdict.sentence.clone()),
                notes: leg.mission.notes.clone(),
                demands: Demands {
                    part: !leg.mission.stops.is_empty(),
                    unmet: leg.unmet.clone(),
                    fences: Fences::of(&leg.mission),
                },
            }
        };
        Self { missions: legs.iter().map(one).collect(), search_failed: None }
    }

    /// What a log of `mission`, the only case, is held against: however it is divided by its stops, it is all of it.
    pub(crate) fn of_log(mission: &Mission) -> Self {
        let demands = Demands { fences: Fences::of(mission), ..Demands::default() };
        let mission = MissionTold { name: mission.name.clone(), demands, ..MissionTold::default() };
        Self { missions: vec![mission], search_failed: None }
    }

    /// What is asked of `case` beside the spec; `None` where that is nothing.
    pub(crate) fn asked_of(&self, case: CaseNumber) -> Option<&Demands> {
        let demands = &self.missions.get(case.0)?.demands;
        (!demands.is_none()).then_some(demands)
    }

    /// The sentences of a report.
    pub(crate) fn said(&self) -> Vec<String> {
        let told = self.missions.iter().filter(|one| one.evidence != "unchecked");
        told.map(|one| format!("Mission {}: {}.", one.name, one.check)).collect()
    }
}

/// Holds what was executed of `case`, `runs` with their motion, against what its mission asks beside the spec: `result`
/// is no more than that leaves of it. Where nothing is asked runs are not read.
///
/// # Errors
/// Of reading the runs.
pub(crate) fn hold(
    asked: Option<&Demands>,
    (setup, case): (&Setup, &Case),
    runs: impl FnOnce() -> Result<Vec<Run>, Problem>,
    result: &mut CaseResult,
) -> Result<(), Problem> {
    let Some(asked) = asked else { return Ok(()) };
    doubt(asked, setup.scenario.head().terms.limits.total_time, result);
    // One that was executed otherwise than it asks is doubted for it, whatever its fences.
    if asked.unmet.is_empty() && !asked.fences.is_empty() {
        fenced::hold(&asked.fences, setup, case, &runs()?, result);
    }
    Ok(())
}

/// A case whose mission asks for something else than what was executed says nothing of it, neither way; one between two
/// stops does not say that the mission keeps a limit of `total_time` s: it takes all of its parts, and stands between
/// them.
fn doubt(one: &Demands, total_time: Option<f64>, result: &mut CaseResult) {
    let open = |result: &mut CaseResult, why: String| {
        result.status = Status::Inconclusive;
        result.violations.clear();
        result.elsewhere.clear();
        result.message = Some(why);
    };
    if !one.unmet.is_empty() && matches!(result.status, Status::Pass | Status::Fail | Status::Unjudged) {
        open(result, one.unmet.join("; "));
    } else if let Some(most) = total_time.filter(|_| one.part && result.status == Status::Pass) {
        open(result, takes_all_parts(most));
    }
}

/// What lies between two stops keeps no limit of `total_time` s of the mission.
pub(crate) fn takes_all_parts(total_time: f64) -> String {
    format!("total-time: {total_time} s are for all of the mission, and this is what lies between two stops")
}

/// What broke a fence of its mission passes by nothing else where `repro` does not know that fence, as those of earlier
/// versions do not.
pub(crate) fn doubt_lost_fence(repro: &Repro, result: &mut CaseResult) {
    let broke = || repro.expected.violations.iter().any(|one| one.starts_with(FENCE));
    if repro.mission.is_none() && result.status == Status::Pass && broke() {
        result.status = Status::Inconclusive;
        result.message = Some("it broke a fence of its mission, which its campaign's folder keeps".into());
    }
}

/// What `folder` keeps of its missions; `None` where its cases are none.
pub(crate) fn read_told(folder: &CampaignFolder) -> Result<Option<MissionsTold>, Problem> {
    Ok(folder.read_missions()?)
}

/// Keeps in the folder of `work` why the search beside its missions came to nothing, or that it no longer does.
///
/// # Errors
/// A file that is broken or cannot be written.
pub(crate) fn keep_search_failed(work: &Work, why: Option<String>) -> Result<(), Problem> {
    let Some(told) = read_told(&work.folder)?.filter(|told| told.search_failed != why) else { return Ok(()) };
    Ok(work.folder.write_missions(&MissionsTold { search_failed: why, ..told })?)
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::Undone;

    use super::*;

    #[test]
    fn what_was_not_executed_as_asked_says_nothing() {
        let of = |unmet: &[&str], part: bool| {
            let unmet = unmet.iter().map(|words| (*words).to_owned()).collect();
            Demands { unmet, part, ..Demands::default() }
        };
        let told = |unmet: &[&str]| of(unmet, false);
        let within = |total_time: Option<f64>, status: Status, told: &Demands| {
            let mut result =
                CaseResult { status, message: None, ..CaseResult::undone(CaseNumber(0), Undone::NotJudged) };
            doubt(told, total_time, &mut result);
            (result.status, result.message)
        };
        let judged = |status: Status, told: &Demands| within(Some(15.0), status, told);
        for status in [Status::Pass, Status::Fail, Status::Unjudged] {
            assert_eq!(judged(status, &told(&[])), (status, None));
            assert_eq!(judged(status, &told(&["a", "b"])), (Status::Inconclusive, Some("a; b".into())));
        }
        assert_eq!(judged(Status::ExecutorFailed, &told(&["a"])), (Status::ExecutorFailed, None));
        // A part that takes too long does so of the whole, and one that does not says nothing.
        let part = of(&[], true);
        assert_eq!(judged(Status::Fail, &part), (Status::Fail, None));
        assert_eq!(within(None, Status::Pass, &part), (Status::Pass, None));
        let why = "total-time: 15 s are for all of the mission, and this is what lies between two stops";
        assert_eq!(judged(Status::Pass, &part), (Status::Inconclusive, Some(why.into())));
    }
}
