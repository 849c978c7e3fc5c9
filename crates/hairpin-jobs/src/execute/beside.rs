//! A campaign's cases once more, in a folder of their own: two programs' runs of them stand side by side.

use std::path::Path;

use hairpin::campaign::{Failures, Tally};

use crate::Problem;
use crate::consent::{Consent, Wish};
use crate::sets::Set;
use crate::work::{IfThere, changed, make, open_to_read, same_place};

/// Makes `out` a campaign with the scenario and the cases of `folder`, of which nothing was executed yet. Marks of the
/// user's on what the scenario wishes to run hold there, too. What `sets` are to change there is changed later, and
/// looked at before anything is. Gives what of the scenario of `folder` was edited.
///
/// # Errors
/// The same folder, or one of recordings; keys that cannot be changed; `out` holds a campaign that is not to be
/// replaced; a file cannot be read or written.
pub(super) fn beside(
    (folder, sets): (&Path, &[Set]),
    out: &Path,
    if_there: IfThere,
    consent: &Consent,
) -> Result<Vec<String>, Problem> {
    if same_place(folder, out) {
        return Err(Problem::input("--out: must be another folder than OUT"));
    }
    let work = open_to_read(folder)?;
    let edited = work.folder.edited(&work.setup)?;
    if let Some(logs) = work.setup.recordings() {
        return Err(Problem::input(format!(
            "--out: {} has recordings (execute.logs = \"{logs}\"), which are of one controller",
            folder.display()
        )));
    }
    // Before a campaign makes room for it.
    changed(&work.folder, sets)?;
    let wishes = Wish::of_campaign(&work.setup);
    let marked = consent.has_marked(folder, &wishes);
    let new = make(out, work.setup.clone(), if_there)?;
    if marked {
        consent.mark(out, &wishes);
    }
    if !work.folder.has_cases() {
        return Ok(edited);
    }
    let cases = work.folder.read_cases()?;
    work.folder.copy_plans(&cases.iter().map(|case| case.number).collect::<Vec<_>>(), &new.folder)?;
    new.folder.write_new_cases(&cases, 0)?;
    if work.folder.has_tally() {
        // What the search executed it executed with another's controller: it is none of what is flown here.
        let tally = work.folder.read_tally()?;
        let of = (!tally.failures.is_none()).then(|| tally.executed());
        let failures = Failures { of, ..tally.failures.clone() };
        new.folder.write_tally(&Tally { curves: Vec::new(), failures, ..tally })?;
    }
    Ok(edited)
}
