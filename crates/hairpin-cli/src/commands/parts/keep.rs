//! What parts write of the cases that they found.

use hairpin::campaign::{Case, Tally, planned};

use crate::folder::Work;
use crate::problem::Problem;

/// Writes the cases from number `from` of the list on, the tables of all, and the tally that belongs to them. Each file
/// says no more than those before it: a kill in between leaves cases too many, never too few.
pub(super) fn keep_cases(work: &Work, cases: &[Case], from: usize, tally: &Tally) -> Result<(), Problem> {
    for case in &cases[from..] {
        let planned = planned(&work.setup, case);
        let planned = planned.map_err(|error| Problem::input(format!("case {}: {error}", case.id())))?;
        work.folder.write_planned(case.number, &planned)?;
    }
    work.folder.write_new_cases(cases, from)?;
    Ok(work.folder.write_tally(tally)?)
}
