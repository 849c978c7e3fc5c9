//! One HTML file from a judged campaign.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::baseline::Moves;
use hairpin::campaign::coverage::Coverage;
use hairpin::campaign::report::{ReportData, Shown, shown, worst_first};
use hairpin::campaign::{self, Case, CaseNumber, CaseResult, Run, Setup, Tally};
use hairpin::judgement::Verdict;
use hairpin::judgement::moves::Regression;
use hairpin::trajectory::ATTITUDE_UNKNOWN;
use hairpin_formats::atomic;
use hairpin_formats::folder::refuse_own;
use hairpin_formats::report::Motions;

use crate::Problem;
use crate::baseline::{missing, read_baseline};
use crate::execute::{count_flown, run_with_motion, why_lost};
use crate::judge::with_moves;
use crate::missions::{compare, read_told, with_compared};
use crate::work::{Work, no_contradiction, of_another_version, open_as_made};

/// A report that was written.
#[derive(Debug)]
pub struct Reported {
    /// The file.
    pub path: PathBuf,
    /// The verdict in it.
    pub verdict: Verdict,
    /// Which cells of the grid of motion were met.
    pub coverage: Option<Coverage>,
    /// What its user has to know beside that, in sentences.
    pub told: Vec<String>,
}

/// Writes the `report.html` of the judged campaign in `folder`, with the cases of the numbers `asked` among those that
/// open, and opened at the first of them; and into the file `picture` top and side view of the case that it opens with.
///
/// # Errors
/// A campaign that is not judged, that has not such a case, or of whose worst case the run is not to be had any more; a
/// file that cannot be read or written.
pub fn report(folder: &Path, asked: &[usize], picture: Option<&Path>) -> Result<Reported, Problem> {
    if let Some(file) = picture {
        refuse_own(file)?;
        if !file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg")) {
            return Err(Problem::input(format!(
                "--picture {}: it is an SVG; name it so, as in case.svg",
                file.display()
            )));
        }
    }
    let work = open_as_made(folder)?;
    let cases = work.folder.read_cases_without_profiles()?;
    let tally = work.folder.read_tally()?;
    let results = work.folder.read_results()?;
    if results.len() < cases.len() {
        return Err(Problem::input(format!("not judged yet: hairpin judge {}", folder.display())));
    }
    no_contradiction(&work.folder, &work.setup, &results)?;
    let asked: Vec<CaseNumber> = asked.iter().copied().map(CaseNumber).collect();
    if let Some(missing) = asked.iter().find(|case| !results.iter().any(|result| result.case == **case)) {
        return Err(Problem::input(format!("{} has no case {missing}: it has {}", folder.display(), results.len())));
    }
    if let Some(worst) = worst_first(&results).first()
        && let Some(case) = cases.iter().find(|case| case.number == worst.case)
        && let Some(lost) = why_lost(&work, case, worst.run)?
    {
        return Err(lost);
    }
    let baseline = read_baseline(&work)?;
    let lost = missing(&work, &tally, &results)?.into_iter().chain(of_another_version(&work.folder)?).collect();
    let told = work.told()?;
    let verdict = campaign::verdict(&told, &cases, (&results, baseline.as_ref()), &tally);
    let moves = work.folder.read_moves()?;
    let (verdict, regression) = with_moves(&work, &moves, verdict)?;
    let verdict = with_compared(verdict, compare(&work, &results)?.as_ref());
    let assumptions = assumptions((&work, &told), &cases, &tally, (&moves, regression.as_ref()))?;
    // They are read again for what is shown of them.
    drop((cases, results));
    let data = write((&work, &told), &verdict, assumptions, regression.as_ref(), &asked)?;
    if let Some(file) = picture {
        let drawn = hairpin_formats::report::picture(&data);
        let drawn = drawn.ok_or_else(|| Problem::input("--picture: no case is there to be drawn"))?;
        atomic::write(file, drawn.as_bytes())?;
    }
    let (path, coverage) = (work.folder.file("report.html"), work.folder.read_coverage()?);
    Ok(Reported { path, verdict, coverage, told: lost })
}

/// The worst case of a judged campaign in full, as the report shows it; `None` where none was flown, or its motion is
/// not to be had.
pub fn worst_in_full(work: &Work, cases: &[Case], results: &[CaseResult]) -> Option<Shown> {
    let worst = worst_first(results).into_iter().find(|result| result.measures.is_some())?;
    let case = cases.iter().find(|case| case.number == worst.case)?;
    let run = run_with_motion(work, case, worst.run).ok().flatten()?;
    let planned = work.folder.read_planned(case.number).ok()?;
    shown(&work.setup, case, worst, planned, Some((&run).into()), &[]).ok()
}

/// Writes `report.html`.
pub(crate) fn write_report(
    work: &Work,
    cases: &[Case],
    tally: &Tally,
    verdict: &Verdict,
    (moves, regression): (&Moves, Option<&Regression>),
) -> Result<(), Problem> {
    let told = work.told()?;
    let assumptions = assumptions((work, &told), cases, tally, (moves, regression))?;
    write((work, &told), verdict, assumptions, regression, &[]).map(drop)
}

fn assumptions(
    (work, told): (&Work, &Setup),
    cases: &[Case],
    tally: &Tally,
    (moves, regression): (&Moves, Option<&Regression>),
) -> Result<Vec<String>, Problem> {
    let mut assumptions = campaign::assumptions(told, cases, tally);
    if let Some(arm) = work.setup.own::<ArmSetup>() {
        assumptions.extend(arm.said_of_moves(moves, regression));
    }
    assumptions.extend(count_flown(work, cases)?.left_out());
    if let Some(baseline) = read_baseline(work)? {
        assumptions.push(baseline.said(&work.setup));
    }
    if let Some(told) = read_told(&work.folder)? {
        assumptions.extend(told.said());
        if work.folder.read_searched()?.is_some() {
            assumptions.push(
                "What a search of the same scenario finds, run alike, is what missions are compared with (searched.parquet); measured, not \
                 judged, and counted nowhere."
                    .into(),
            );
        }
    }
    Ok(assumptions)
}

/// Runs of a folder; of those whose motion was not kept the worst are executed again.
struct Recorded<'a> {
    work: &'a Work,
    /// Asked for by number: executed again, however many they are.
    asked: &'a [CaseNumber],
    /// Not to be had.
    lost: Cell<usize>,
}

/// So many of those that are shown are executed again at most, the worst: what takes longer is asked for by `--case`.
const AGAIN: usize = 20;

impl Motions for Recorded<'_> {
    fn run(&self, case: &Case, run: usize, place: usize) -> Result<Option<Run>, String> {
        let said = |problem: Problem| problem.to_string();
        let facts = self.work.folder.facts_of(case.number).map_err(|error| error.to_string())?;
        let left_out = facts.iter().any(|facts| facts.run == run && !facts.is_kept());
        let too_many = place >= AGAIN && !self.asked.contains(&case.number);
        if left_out && (too_many || why_lost(self.work, case, run).map_err(said)?.is_some()) {
            self.lost.set(self.lost.get() + 1);
            return Ok(None);
        }
        run_with_motion(self.work, case, run).map_err(said)
    }

    fn kept(&self, case: CaseNumber) -> Result<Vec<Run>, String> {
        let folder = &self.work.folder;
        let facts = folder.facts_of(case).map_err(|error| error.to_string())?;
        let runs = facts.iter().filter(|facts| facts.is_kept()).map(|facts| folder.read_run(case, facts.run));
        runs.filter_map(Result::transpose).collect::<Result<_, _>>().map_err(|error| error.to_string())
    }
}

fn write(
    (work, told): (&Work, &Setup),
    verdict: &Verdict,
    assumptions: Vec<String>,
    regression: Option<&Regression>,
    asked: &[CaseNumber],
) -> Result<ReportData, Problem> {
    let recorded = Recorded { work, asked, lost: Cell::new(0) };
    let mut data =
        hairpin_formats::report::from_folder(&work.folder, told, verdict.clone(), assumptions, &recorded, asked)
            .map_err(Problem::input)?;
    if recorded.lost.get() > 0 {
        data.assumptions.push(format!(
            "Of {} of {} cases that open the motion was not kept (execute.record = \"{}\"): what was planned is drawn alone, unless \
             `hairpin report OUT --case ID` executes it again, which no program of the user's does.",
            recorded.lost.get(),
            data.shown.len(),
            work.setup.scenario.executor().record.word()
        ));
    }
    data.regression = regression.cloned();
    let level = |shown: &Shown| shown.flown.as_ref().is_some_and(|track| track.channel(ATTITUDE_UNKNOWN).is_some());
    if data.shown.iter().any(level) {
        data.assumptions.push("The executor sent no attitudes: they are unknown, and drawn level.".into());
    }
    hairpin_formats::report::write(&work.folder.file("report.html"), &data)?;
    Ok(data)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::judge;
    use crate::testing::executed;

    #[test]
    fn what_is_not_judged_has_no_report() {
        let (_place, folder) = executed();
        let refused = report(&folder, &[], None).unwrap_err().to_string();
        assert!(refused.starts_with("not judged yet"), "{refused}");
        let judged = judge(&folder, &[]).unwrap();
        let picture = folder.with_file_name("drawn.svg");
        let reported = report(&folder, &[], Some(&picture)).unwrap();
        let drawn = std::fs::read_to_string(picture).unwrap();
        assert!(drawn.starts_with("<svg xmlns=") && drawn.contains("top view") && drawn.contains("deviation"));
        assert!(report(&folder, &[4711], None).unwrap_err().to_string().contains("has no case 4711"));
        assert_eq!(reported.verdict, judged.judgement.verdict);
        assert!(reported.path.is_file() && reported.coverage.is_some());
    }
}
