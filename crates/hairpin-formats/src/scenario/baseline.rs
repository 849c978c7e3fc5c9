//! The baseline that an arm's campaign is held against: what an earlier release's folder keeps of its moves.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use hairpin::campaign::Attached;
use hairpin::campaign::baseline::{Baseline, Moves};
use hairpin::campaign::scenario::RegressionLimit;
use serde::Deserialize;

use super::attached::{Wrong, attached};
use super::whole::read_file;
use crate::atomic::json_text;
use crate::checksum::sha256;
use crate::folder::{BASELINE, MOVES};

/// Either file that a campaign folder keeps.
#[derive(Deserialize)]
#[serde(untagged)]
enum Kept {
    Releases(Baseline),
    Runs(Moves),
}

/// Reads the baseline of `spec.regression`. A resolved scenario's is `baseline.json`, which a campaign folder holds.
pub(super) fn attach(limit: &mut RegressionLimit, find: &dyn Fn(&str) -> PathBuf) -> Result<Attached<Baseline>, Wrong> {
    let given = limit.baseline.clone();
    let key = "spec.regression.baseline";
    let wrong = |bound: String| Wrong { key: key.into(), value: given.clone(), bound, at: None };
    let (baseline, bytes) = read(&find(&given)).map_err(wrong)?;
    let checksum = sha256(&bytes);
    if let Some(other) = limit.checksum.as_ref().filter(|other| **other != checksum) {
        let bound = format!("the checksum of `{given}`, which is {checksum}: it is another baseline");
        return Err(Wrong { key: "spec.regression.checksum".into(), value: other.clone(), bound, at: None });
    }
    limit.baseline = BASELINE.into();
    limit.checksum = Some(checksum);
    Ok(attached(Arc::new(baseline), bytes, BASELINE, &given))
}

/// Reads the baseline at `path`: a judged campaign folder, on top of the baseline that it has itself; its `moves.json`;
/// or a `baseline.json`. Gives it, and the text that another campaign keeps of it.
///
/// # Errors
/// Nothing there, a folder that was not judged, another JSON, fewer than two runs of a program: in a sentence's part.
fn read(path: &Path) -> Result<(Baseline, Vec<u8>), String> {
    if path.is_file() {
        let bytes = read_file(path)?;
        return match parse(&bytes, path)? {
            // Read back from a campaign's folder, it stays the same bytes.
            Kept::Releases(baseline) => Ok((baseline.checked().map_err(|error| error.to_string())?, bytes)),
            Kept::Runs(moves) => written(Baseline::of(None, &name_of_file(path), moves)),
        };
    }
    let kept = path.join(MOVES);
    if !kept.is_file() {
        let why = if path.is_dir() {
            format!("it has no {MOVES}: hairpin judge it first")
        } else {
            "there is no such folder".into()
        };
        return Err(format!("must be the folder of a judged campaign of arms, or its {MOVES}: {why}"));
    }
    let Kept::Runs(moves) = parse(&read_file(&kept)?, &kept)? else {
        return Err(format!("{}: holds releases, not runs", kept.display()));
    };
    let older = path.join(BASELINE);
    let earlier = match older.is_file().then(|| parse(&read_file(&older)?, &older)).transpose()? {
        Some(Kept::Releases(earlier)) => Some(earlier),
        Some(Kept::Runs(_)) => return Err(format!("{}: holds runs, not releases", older.display())),
        None => None,
    };
    written(Baseline::of(earlier, &name_of(path), moves))
}

fn written(baseline: Result<Baseline, impl ToString>) -> Result<(Baseline, Vec<u8>), String> {
    let baseline = baseline.map_err(|error| error.to_string())?;
    let text = json_text(&baseline).map_err(|error| error.to_string())?;
    Ok((baseline, text.into_bytes()))
}

fn parse(bytes: &[u8], path: &Path) -> Result<Kept, String> {
    serde_json::from_slice(bytes)
        .map_err(|_| format!("{}: is neither a {MOVES} nor a {BASELINE} of hairpin's", path.display()))
}

/// The name of a folder; of one given as `.` or `..` the name that it has where it stands.
fn name_of(folder: &Path) -> String {
    let whole = || fs::canonicalize(folder).ok();
    let name =
        folder.file_name().map(|name| name.to_owned()).or_else(|| whole()?.file_name().map(|name| name.to_owned()));
    name.map_or_else(|| "baseline".into(), |name| name.to_string_lossy().into_owned())
}

/// Of `7.14/moves.json` that of its folder, else the file's own without its ending.
fn name_of_file(path: &Path) -> String {
    match (path.file_name().is_some_and(|name| name == MOVES), path.parent()) {
        (true, Some(parent)) => name_of(if parent.as_os_str().is_empty() { Path::new(".") } else { parent }),
        _ => path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
    }
}
