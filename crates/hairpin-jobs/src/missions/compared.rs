//! How stressful missions are, beside what a search finds in the same scenario and beside random feasible cases.

use hairpin::campaign::digits::number;
use hairpin::campaign::{Baseline, CaseNumber, CaseResult, Rank, Status, stresses};
use hairpin::judgement::Verdict;

use super::told::{MissionsTold, read_told};
use crate::Problem;
use crate::work::Work;

/// Missions beside what a search finds.
#[derive(Debug, Clone)]
pub struct Compared {
    /// The most stressful mission.
    pub worst: Ranked,
    /// All of them, in the order of cases.
    pub each: Vec<Ranked>,
    /// What the folder keeps of them.
    pub told: MissionsTold,
    /// In a part of a sentence.
    pub words: String,
}

/// A mission's stress among others.
#[derive(Debug, Clone)]
pub struct Ranked {
    /// Its case.
    pub case: CaseNumber,
    /// The stress that the search looks for, of its worst run, as it is measured.
    pub stress: f64,
    /// Among what a search found.
    pub searched: Option<Rank>,
    /// Among random feasible cases.
    pub random: Option<Rank>,
}

/// The missions of `work` beside what was searched and drawn; `None` where its cases are no missions, or nothing of
/// them was measured.
pub(crate) fn compare(work: &Work, results: &[CaseResult]) -> Result<Option<Compared>, Problem> {
    let Some(told) = read_told(&work.folder)? else { return Ok(None) };
    let (scenario, repeat) = (&work.setup.scenario, work.setup.scenario.executor().repeat);
    let sought = scenario.sought();
    let [searched, random] =
        [work.folder.read_searched()?, work.folder.read_baseline()?].map(Option::unwrap_or_default);
    let rank = |stress: f64, others: &[CaseResult]| Rank::of(sought, repeat, stress, others);
    let each: Vec<Ranked> = stresses(sought, results)
        .map(|(case, stress)| Ranked { case, stress, searched: rank(stress, &searched), random: rank(stress, &random) })
        .collect();
    let less_is_worse =
        each.iter().flat_map(|one| [&one.searched, &one.random]).flatten().any(|rank| rank.of.less_is_worse);
    let sign = if less_is_worse { -1.0 } else { 1.0 };
    let Some(worst) = each.iter().max_by(|a, b| (sign * a.stress).total_cmp(&(sign * b.stress))).cloned() else {
        return Ok(None);
    };
    let own = Baseline::of(sought, repeat, results);
    let stress = own.map_or_else(|| number(Some(worst.stress)), |own| own.told(&work.setup, worst.stress));
    let failed = if worst.searched.is_none() { failed(&told, &searched) } else { None };
    let words = in_words(work, (&told, &worst), &stress, failed);
    Ok(Some(Compared { worst, each, told, words }))
}

/// Why nothing of what was to be `searched` beside missions is there to compare with; `None` where nothing was to be,
/// or nothing was found.
fn failed(told: &MissionsTold, searched: &[CaseResult]) -> Option<String> {
    if let Some(why) = &told.search_failed {
        return Some(format!("the search beside it failed ({why})"));
    }
    let first = searched.iter().find(|result| result.status == Status::ExecutorFailed)?;
    let why = first.message.as_ref().map_or(String::new(), |why| format!(" ({why})"));
    Some(format!("none of {} that a search finds was executed{why}", searched.len()))
}

/// `the most stressful mission is up (0000), 0.42 m: above 12 of 20 that a search finds (0.65 of their worst, 0.65 m)
/// and above 20 of 20 random feasible ones (1.9 of their mean, 0.22 m)`.
///
/// Of a search that `failed` this is said behind it.
fn in_words(work: &Work, (told, worst): (&MissionsTold, &Ranked), stress: &str, failed: Option<String>) -> String {
    let name = told.missions.get(worst.case.0).map_or("", |one| one.name.as_str());
    let unit = |of: &Baseline, value: f64| of.told(&work.setup, value);
    let among = |rank: &Rank, who: &str, what: &str, value: f64, ratio: Option<f64>| {
        let ratio = ratio.map_or(String::new(), |ratio| format!("{} of ", number(Some(ratio))));
        format!("above {} of {} {who} ({ratio}{what}, {})", rank.below, rank.of.cases, unit(&rank.of, value))
    };
    let searched = worst
        .searched
        .as_ref()
        .map(|rank| among(rank, "that a search finds", "their worst", rank.of.worst, rank.to_worst));
    let random =
        worst.random.as_ref().map(|rank| among(rank, "random feasible ones", "their mean", rank.of.mean, rank.to_mean));
    let beside: Vec<String> = searched.into_iter().chain(random).collect();
    let beside = if beside.is_empty() { "nothing to compare with".into() } else { beside.join(" and ") };
    let failed = failed.map_or(String::new(), |failed| format!("; {failed}"));
    format!("the most stressful mission is {name} ({}), {stress}: {beside}{failed}", worst.case)
}

/// `verdict` with how stressful the missions are, and how many are not feasible.
pub(crate) fn with_compared(verdict: Verdict, compared: Option<&Compared>) -> Verdict {
    let Some(Compared { told, words, .. }) = compared else { return verdict };
    let broken = told.missions.iter().filter(|one| one.feasible == Some(false)).count();
    let open = told.missions.iter().filter(|one| one.evidence == "not found").count();
    let mut sentence = format!("{}; {words}", verdict.sentence);
    if broken > 0 {
        sentence += &format!("; {broken} proven not to be feasible");
    }
    if open > 0 {
        sentence += &format!("; of {open} no witness was found");
    }
    Verdict::of(&sentence, verdict.exit_code)
}
