//! Which cases of a campaign are exported.

use hairpin::campaign::report::worst_first;
use hairpin::campaign::{Case, CaseNumber};

use crate::Problem;
use crate::names::named;
use crate::work::Work;

/// Cases of a campaign.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum Which {
    /// Every one.
    #[default]
    All,
    /// Those of these numbers.
    Named(Vec<CaseNumber>),
    /// So many of the worst; where nothing was judged those of the largest score.
    Worst(usize),
}

impl Which {
    /// Those of `cases`, in their order.
    ///
    /// # Errors
    /// A case that the campaign has not, or more than it has.
    pub(super) fn of(&self, work: &Work, mut cases: Vec<Case>) -> Result<Vec<Case>, Problem> {
        let there = || named(&cases.iter().map(Case::id).collect::<Vec<_>>(), "case");
        let chosen: Vec<CaseNumber> = match self {
            Self::All => return Ok(cases),
            Self::Named(numbers) => {
                if let Some(missing) = numbers.iter().find(|number| !cases.iter().any(|case| case.number == **number)) {
                    let folder = work.folder.path().display();
                    return Err(Problem::input(format!("--case {missing}: {folder} has {}", there())));
                }
                numbers.clone()
            }
            Self::Worst(count) if *count > cases.len() => {
                let folder = work.folder.path().display();
                return Err(Problem::input(format!(
                    "--worst {count}: must be at most {}, {folder} has {}",
                    cases.len(),
                    there()
                )));
            }
            Self::Worst(count) => worst(work, &cases)?.into_iter().take(*count).collect(),
        };
        cases.retain(|case| chosen.contains(&case.number));
        Ok(cases)
    }
}

/// The numbers of `cases`, the worst first.
fn worst(work: &Work, cases: &[Case]) -> Result<Vec<CaseNumber>, Problem> {
    let results = work.folder.read_results()?;
    let judged = worst_first(&results).into_iter().map(|result| result.case);
    let mut by_score: Vec<&Case> = cases.iter().collect();
    by_score.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut numbers: Vec<CaseNumber> = judged.collect();
    numbers.extend(
        by_score.into_iter().map(|case| case.number).filter(|number| !results.iter().any(|r| r.case == *number)),
    );
    Ok(numbers)
}
