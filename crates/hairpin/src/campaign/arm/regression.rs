//! A campaign's runs against a baseline of an earlier release, move by move.

use thiserror::Error;

use super::ArmSetup;
use crate::campaign::baseline::{CaseMoves, Moves, RunUnseen};
use crate::campaign::{Case, CaseNumber, RunDeviation};
use crate::judgement::Verdict;
use crate::judgement::moves::{Band, MovesError, ProgramComparison, Regression, Release, compare, offset_told, trend};

/// Why a campaign cannot be held against its baseline.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RegressionError {
    /// The two have other programs.
    #[error("case {case} {what}")]
    Programs {
        /// Which.
        case: CaseNumber,
        /// In words, from `is` or `has` on.
        what: String,
    },
    /// What the oracle refuses.
    #[error("case {case}: {cause}")]
    Moves {
        /// Which.
        case: CaseNumber,
        /// Why.
        cause: MovesError,
    },
}

/// Names of moves that are told of a program that differs.
const DIFFERENT: usize = 3;

impl ArmSetup {
    /// What all runs did, from what judging them gave.
    /// Cases none of whose runs was measured are left out.
    pub fn moves(&self, cases: &[Case], runs: &[RunDeviation]) -> Moves {
        let of = |case: &Case| {
            let own: Vec<&RunDeviation> = runs.iter().filter(|run| run.case == case.number).collect();
            CaseMoves::of(case, case.program()?, &own)
        };
        Moves { cases: cases.iter().filter_map(of).collect() }
    }

    /// The comparison with the baseline, where the spec asks for one; `name` is what the new release is called.
    ///
    /// # Errors
    /// Programs that only one of the two has, or that differ, by name; too few runs.
    ///
    /// `None` too where the spec names no baseline. A trend is told from three releases of the same program on.
    pub fn regression(&self, moves: &Moves, name: &str) -> Result<Option<Regression>, RegressionError> {
        let Some(limit) = &self.scenario.spec.regression else { return Ok(None) };
        let Some(baseline) = self.attachments.baseline(limit) else { return Ok(None) };
        let Some((last, earlier)) = baseline.releases.split_last() else { return Ok(None) };
        same_programs(&last.name, &last.cases, &moves.cases)?;
        let band = Band { sigma: limit.band_sigma, ..Band::default() };
        let mut programs = Vec::with_capacity(moves.cases.len());
        for (old, new) in paired(&last.cases, &moves.cases) {
            let refuse = |cause| RegressionError::Moves { case: new.case, cause };
            let (before, now) = (old.measured(), new.measured());
            let (before, now) = (Release { name: &last.name, runs: &before }, Release { name, runs: &now });
            let comparison = compare(&before, &now, &band).map_err(refuse)?;
            // Earlier releases may have had another program under this number.
            let like: Vec<_> = (earlier.iter())
                .filter_map(|release| {
                    let same =
                        |one: &&CaseMoves| one.case == new.case && one.program == new.program && !one.runs.is_empty();
                    Some((release.name.as_str(), release.cases.iter().find(same)?.measured()))
                })
                .collect();
            let mut releases: Vec<Release> = like.iter().map(|(name, runs)| Release { name, runs }).collect();
            releases.extend([before, now]);
            let trends = if releases.len() < 3 { Vec::new() } else { trend(&releases).map_err(refuse)? };
            programs.push(ProgramComparison { program: new.case.to_string(), comparison, trends });
        }
        let names = baseline.releases.iter().map(|release| release.name.clone());
        Ok(Some(Regression { releases: names.chain([name.to_owned()]).collect(), programs }))
    }

    /// The verdict by the limits, with what is known beside them: the baseline, and how the recordings' clocks differ
    /// from the plan's.
    pub fn verdict_with(&self, verdict: Verdict, moves: &Moves, regression: Option<&Regression>) -> Verdict {
        let spec = &self.scenario.spec;
        let limited = spec.path.is_some() || spec.arrival.is_some();
        let mut verdict = match regression {
            Some(regression) => regression.join(verdict, limited),
            None => verdict,
        };
        let runs = moves.cases.iter().flat_map(|case| &case.runs);
        if let Some(offset) = offset_told(runs.clone().filter_map(|run| Some((run.offset()?, run.sample_s)))) {
            verdict.sentence += &format!("; {offset}");
        }
        let unseen: Vec<&RunUnseen> = runs.filter_map(|run| run.unseen.as_ref()).collect();
        if let Some(longest) = unseen.iter().max_by(|a, b| a.longest_gap_s.total_cmp(&b.longest_gap_s)) {
            let [first, last] = &longest.moves;
            let hides = if first == last { first.clone() } else { format!("{first} … {last}") };
            verdict.sentence += &format!("; longest gap of the logs {:.3} s ({hides})", longest.longest_gap_s);
        }
        verdict
    }

    /// What must be said of a comparison, and of the recordings' clocks, in sentences.
    pub fn said_of_moves(&self, moves: &Moves, regression: Option<&Regression>) -> Vec<String> {
        let mut said = Vec::new();
        let mut offsets: Vec<f64> =
            moves.cases.iter().flat_map(|case| &case.runs).filter_map(|run| run.offset_s).collect();
        offsets.sort_unstable_by(f64::total_cmp);
        if let [first, .., last] | [first @ last] = offsets.as_slice() {
            let removed = moves.cases.iter().flat_map(|case| &case.runs).any(|run| run.offset_removed);
            said.push(format!(
                "Clocks: arrivals of {} runs are by {:+.1} … {:+.1} ms later than planned in the median of each run, which is the estimated \
                 offset between the recording's clock and the plan's; it was {}.",
                offsets.len(),
                1e3 * first,
                1e3 * last,
                if removed { "taken off the times, as asked (execute.log_clock)" } else { "told and not taken off the times" }
            ));
        }
        if let (Some(regression), Some(limit)) = (regression, &self.scenario.spec.regression) {
            said.push(format!(
                "Against {}: bands of {} standard deviations of the repeats on both sides (Student's quantile for so few runs), at least half a \
                 sample in time and 0.02 mm in place; were nothing different, chance alone would put {:.2} of the comparisons outside theirs.",
                regression.programs[0].comparison.baseline,
                limit.band_sigma,
                regression.expected_by_chance(limit.band_sigma)
            ));
        }
        said
    }
}

/// Told in this order: a case too many, a case too few, moves of other names, other numbers under the same names (by
/// the digest that a baseline keeps).
fn same_programs(release: &str, old: &[CaseMoves], new: &[CaseMoves]) -> Result<(), RegressionError> {
    let refuse = |case, what| Err(RegressionError::Programs { case, what });
    if let Some(extra) = new.iter().find(|one| old.iter().all(|other| other.case != one.case)) {
        return refuse(extra.case, format!("is not in the baseline `{release}`, which has {}", numbers(old)));
    }
    if let Some(missing) = old.iter().find(|one| new.iter().all(|other| other.case != one.case)) {
        return refuse(missing.case, format!("of the baseline `{release}` was not run: there are {}", numbers(new)));
    }
    for (before, now) in paired(old, new) {
        if before.moves != now.moves {
            let most = before.moves.len().max(now.moves.len());
            let name = |moves: &[String], i: usize| moves.get(i).map_or("none".to_owned(), |name| format!("`{name}`"));
            let differ: Vec<String> = (0..most)
                .filter(|i| before.moves.get(*i) != now.moves.get(*i))
                .map(|i| format!("move {i} is {}, was {}", name(&now.moves, i), name(&before.moves, i)))
                .collect();
            let more = differ.len().saturating_sub(DIFFERENT);
            let more = if more > 0 { format!("; and {more} more") } else { String::new() };
            let told = differ[..differ.len().min(DIFFERENT)].join("; ");
            return refuse(now.case, format!("has another program than in the baseline `{release}`: {told}{more}"));
        }
        if before.program != now.program {
            let what = "has the moves of the baseline `{}` by name, but with other targets, speeds, zones, tool or work object ({} instead of {})";
            let what =
                what.replacen("{}", release, 1).replacen("{}", &now.program, 1).replacen("{}", &before.program, 1);
            return refuse(now.case, what);
        }
    }
    Ok(())
}

/// Cases of one number, whatever order a baseline has them in.
fn paired<'a>(old: &'a [CaseMoves], new: &'a [CaseMoves]) -> impl Iterator<Item = (&'a CaseMoves, &'a CaseMoves)> {
    new.iter().filter_map(|now| Some((old.iter().find(|before| before.case == now.case)?, now)))
}

fn numbers(cases: &[CaseMoves]) -> String {
    let names: Vec<String> = cases.iter().map(|one| one.case.to_string()).collect();
    names.join(", ")
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::campaign::baseline::{Baseline, ReleaseMoves, RunMoves};

    fn case(number: usize, moves: &[&str], runs: usize) -> CaseMoves {
        let run = |run| RunMoves {
            run,
            sample_s: 0.01,
            offset_s: None,
            offset_spread_s: None,
            offset_removed: false,
            duration_s: moves.iter().map(|_| Some(1.0)).collect(),
            deviation_m: moves.iter().map(|_| Some(1e-4)).collect(),
            unseen: None,
        };
        let moves = moves.iter().map(|name| (*name).to_owned()).collect();
        CaseMoves { case: CaseNumber(number), program: "a".into(), moves, runs: (0..runs).map(run).collect() }
    }

    #[test]
    fn programs_that_differ_are_named() {
        let old = [case(0, &["h→p1", "p1→p2"], 2), case(1, &["h→p3"], 2)];
        let told = |new: &[CaseMoves]| same_programs("7.14", &old, new).unwrap_err().to_string();
        assert!(same_programs("7.14", &old, &old.clone()).is_ok());
        let turned = [old[1].clone(), old[0].clone()];
        assert!(same_programs("7.14", &turned, &old).is_ok(), "a baseline may have its cases in another order");
        assert_eq!(told(&old[..1]), "case 0001 of the baseline `7.14` was not run: there are 0000");
        let more = [old[0].clone(), old[1].clone(), case(2, &["h→p3"], 2)];
        assert_eq!(told(&more), "case 0002 is not in the baseline `7.14`, which has 0000, 0001");
        let other = [case(0, &["h→p1", "p1→p4", "p4→p5"], 2), old[1].clone()];
        assert_eq!(
            told(&other),
            "case 0000 has another program than in the baseline `7.14`: move 1 is `p1→p4`, was `p1→p2`; move 2 is `p4→p5`, was none"
        );
        let faster = [old[0].clone(), CaseMoves { program: "b".into(), ..old[1].clone() }];
        assert!(
            told(&faster).starts_with("case 0001 has the moves of the baseline `7.14` by name, but with other targets")
        );
    }

    #[test]
    fn a_baseline_needs_repeats_and_numbers() {
        let of = |cases: Vec<CaseMoves>| Baseline::of(None, "7.14", Moves { cases }).map_err(|error| error.to_string());
        assert!(of(vec![case(0, &["a"], 2)]).is_ok());
        let few = of(vec![case(0, &["a"], 2), case(3, &["a"], 1)]).unwrap_err();
        assert!(few.starts_with("release `7.14`, case 0003: 1 run: must be at least 2"), "{few}");
        let mut ragged = case(0, &["a", "b"], 2);
        ragged.runs[1].duration_s.pop();
        assert!(of(vec![ragged]).unwrap_err().contains("run 1: 1 values of duration_s, must be 2"));
        let mut negative = case(0, &["a"], 2);
        negative.runs[0].deviation_m[0] = Some(-1.0);
        assert!(of(vec![negative]).unwrap_err().contains("deviation_m[0] = -1"));
        assert!(of(Vec::new()).is_err() && Baseline { releases: Vec::new() }.checked().is_err());
        // What was a baseline of the baseline's own is carried on.
        let first = of(vec![case(0, &["a"], 2)]).unwrap();
        let second = Baseline::of(Some(first), "7.15", Moves { cases: vec![case(0, &["a"], 3)] }).unwrap();
        let names: Vec<&str> = second.releases.iter().map(|ReleaseMoves { name, .. }| name.as_str()).collect();
        assert_eq!(names, ["7.14", "7.15"]);
    }
}
