//! Where to ask on, where nothing was feasible.

use hairpin_jobs::work::Work;

use crate::console;
use crate::exit::NOTHING_FEASIBLE;

/// Says where to ask on, where nothing was feasible.
pub(super) fn point_to_explain(work: &Work, exit_code: u8) {
    if exit_code == NOTHING_FEASIBLE {
        let scenario = work.folder.file("scenario.toml");
        console::warn(&format!("why, and the smallest change that helps: hairpin explain {}", scenario.display()));
    }
}
