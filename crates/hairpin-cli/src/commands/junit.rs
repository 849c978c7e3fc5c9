//! `--junit PATH`: the file that a build server takes, where it looks for it.

use std::path::Path;

use hairpin_formats::folder::refuse_own;
use hairpin_formats::{atomic, bounds};
use hairpin_jobs::Problem;
use hairpin_jobs::work::Work;

/// Of a campaign's own file, bytes: a test case a line, for more cases than a campaign has.
const MOST: u64 = 1 << 32;

/// Refuses what cannot be a file, before anything is executed.
pub(super) fn check(path: Option<&Path>) -> Result<(), Problem> {
    match path {
        Some(path) if path.is_dir() => {
            Err(Problem::input(format!("--junit {}: this is a folder; name a file", path.display())))
        }
        Some(path) => Ok(refuse_own(path)?),
        None => Ok(()),
    }
}

/// Writes the campaign's file to `path` as well.
pub(super) fn keep(path: Option<&Path>, work: &Work) -> Result<(), Problem> {
    let Some(path) = path else { return Ok(()) };
    let own = work.folder.file("junit.xml");
    let text = bounds::read(&own, MOST).map_err(|cause| Problem::of_file(&own, cause))?;
    write(path, &text)
}

/// Writes `text` to `path`, in a folder that is made where there is none.
pub(super) fn write(path: &Path, text: &[u8]) -> Result<(), Problem> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        atomic::make_folder(folder)?;
    }
    Ok(atomic::write(path, text)?)
}
